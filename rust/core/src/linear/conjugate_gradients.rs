//! Preconditioned conjugate gradients, for `K` columns that take the same steps.

use crate::{memory, Result};

/// A convex quadratic `½ xᵀ A x − bᵀ x` by its products, and where a run is on it.
pub trait Quadratic<const K: usize> {
    /// `A x`.
    ///
    /// # Errors
    /// What ends the run.
    fn times(&mut self, x: &[[f64; K]]) -> Result<Vec<[f64; K]>>;

    /// The preconditioner times the residual, out of which what constraints hold may be taken.
    ///
    /// # Errors
    /// What ends the run.
    fn precondition(&mut self, residual: &mut [[f64; K]]) -> Result<Vec<[f64; K]>>;

    /// Makes a step and brings the residual up to date; `false` if it leads up, and is taken back.
    ///
    /// # Errors
    /// What ends the run.
    fn go(&mut self, step: &Step<'_, K>, residual: &mut [[f64; K]]) -> Result<bool>;
}

/// A step of a run.
#[derive(Debug)]
pub struct Step<'a, const K: usize> {
    /// How many times the direction it goes.
    pub far: f64,
    /// Where to.
    pub direction: &'a [[f64; K]],
    /// `A` times the direction.
    pub product: &'a [[f64; K]],
}

/// How a run ended.
#[derive(Debug)]
pub struct Descent {
    /// The squared norm of the last residual in the metric of the preconditioner:
    /// twice what a step with it would gain.
    pub length: f64,
    /// Iterations made.
    pub iterations: usize,
    /// The cosine between the last direction and its product with `A` where that was not positive.
    pub flat: Option<f64>,
}

/// Goes down on `quadratic`, where the residual is `residual`, until its squared norm in the metric of the
/// preconditioner is no more than `enough` gives for its first, or for `most` iterations (Hestenes and
/// Stiefel 1952). A preconditioner that keeps to a linear subspace keeps the run there.
///
/// # Errors
/// Those of [`Quadratic`].
pub fn descend<const K: usize>(
    quadratic: &mut impl Quadratic<K>,
    mut residual: Vec<[f64; K]>,
    enough: impl FnOnce(f64) -> f64,
    most: usize,
) -> Result<Descent> {
    let mut direction = quadratic.precondition(&mut residual)?;
    let mut run = Descent { length: dot(&residual, &direction), iterations: 0, flat: None };
    let enough = enough(run.length);
    while run.iterations < most && run.length > enough {
        let product = quadratic.times(&direction)?;
        let curvature = dot(&direction, &product);
        let far = run.length / curvature;
        if curvature <= 0.0 || !far.is_finite() {
            run.flat =
                Some(curvature / (dot(&direction, &direction).sqrt() * dot(&product, &product).sqrt()));
            break;
        }
        run.iterations += 1;
        if !quadratic.go(&Step { far, direction: &direction, product: &product }, &mut residual)? {
            break;
        }
        let step = quadratic.precondition(&mut residual)?;
        let before = std::mem::replace(&mut run.length, dot(&residual, &step));
        for (d, s) in direction.iter_mut().flatten().zip(step.iter().flatten()) {
            *d = s + run.length / before * *d;
        }
    }
    Ok(run)
}

/// What a run found.
#[derive(Debug)]
pub struct Approximation<const K: usize> {
    /// The approximate solution.
    pub solution: Vec<[f64; K]>,
    /// Iterations made.
    pub iterations: usize,
}

/// Solves `matrix · x = right` from zero until the residual, in the norm of the preconditioner, is `goal`
/// times what it was, or for `most` iterations: [`descend`] where nothing is to be looked after.
///
/// # Errors
/// Those of `matrix` and `precondition`.
pub fn conjugate_gradients<const K: usize>(
    matrix: impl FnMut(&[[f64; K]]) -> Result<Vec<[f64; K]>>,
    precondition: impl FnMut(&mut [[f64; K]]) -> Result<()>,
    right: Vec<[f64; K]>,
    goal: f64,
    most: usize,
) -> Result<Approximation<K>> {
    let mut system = System { matrix, precondition, solution: memory::repeated([0.0; K], right.len())? };
    let iterations = descend(&mut system, right, |length| goal * goal * length, most)?.iterations;
    Ok(Approximation { solution: system.solution, iterations })
}

/// A linear system and what is solved of it.
struct System<A, P, const K: usize> {
    matrix: A,
    precondition: P,
    solution: Vec<[f64; K]>,
}

impl<A, P, const K: usize> Quadratic<K> for System<A, P, K>
where
    A: FnMut(&[[f64; K]]) -> Result<Vec<[f64; K]>>,
    P: FnMut(&mut [[f64; K]]) -> Result<()>,
{
    fn times(&mut self, x: &[[f64; K]]) -> Result<Vec<[f64; K]>> {
        (self.matrix)(x)
    }

    fn precondition(&mut self, residual: &mut [[f64; K]]) -> Result<Vec<[f64; K]>> {
        let mut step = memory::twin(residual)?;
        (self.precondition)(&mut step)?;
        Ok(step)
    }

    fn go(&mut self, step: &Step<'_, K>, residual: &mut [[f64; K]]) -> Result<bool> {
        add(step.far, step.direction, &mut self.solution);
        add(-step.far, step.product, residual);
        Ok(true)
    }
}

/// The inner product of all columns.
#[must_use]
pub fn dot<const K: usize>(x: &[[f64; K]], y: &[[f64; K]]) -> f64 {
    x.iter().flatten().zip(y.iter().flatten()).map(|(x, y)| x * y).sum()
}

/// `y += a x`.
pub fn add<const K: usize>(a: f64, x: &[[f64; K]], y: &mut [[f64; K]]) {
    y.iter_mut().flatten().zip(x.iter().flatten()).for_each(|(y, x)| *y += a * x);
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// `2 x_i − x_{i−1} − x_{i+1} + x_i / 2`: definite, with many eigenvalues.
    fn matrix(x: &[[f64; 1]]) -> Result<Vec<[f64; 1]>> {
        let at = |i: Option<usize>| i.and_then(|i| x.get(i)).map_or(0.0, |x| x[0]);
        Ok((0..x.len()).map(|i| [2.5 * x[i][0] - at(i.checked_sub(1)) - at(Some(i + 1))]).collect())
    }

    #[test]
    fn the_residual_falls_to_the_goal() {
        let right: Vec<[f64; 1]> = (0..50).map(|i| [(i as f64).sin()]).collect();
        let found = conjugate_gradients(matrix, |_| Ok(()), right.clone(), 1e-10, 200).unwrap();
        let mut rest = matrix(&found.solution).unwrap();
        add(-1.0, &right, &mut rest);
        assert!(dot(&rest, &rest) <= 1.1e-20 * dot(&right, &right));
        assert!((10..50).contains(&found.iterations), "{} iterations", found.iterations);
    }

    #[test]
    fn with_the_matrix_itself_as_preconditioner_one_iteration_is_enough() {
        let scale = |x: &[[f64; 1]]| Ok(x.iter().map(|x| [7.0 * x[0]]).collect());
        let precondition = |x: &mut [[f64; 1]]| {
            x.iter_mut().for_each(|x| x[0] /= 7.0);
            Ok(())
        };
        let found = conjugate_gradients(scale, precondition, vec![[14.0], [-7.0]], 1e-12, 20).unwrap();
        assert_eq!((found.solution, found.iterations), (vec![[2.0], [-1.0]], 1));
    }

    #[test]
    fn where_the_matrix_is_not_definite_the_run_ends_and_says_so() {
        let mut saddle = System {
            matrix: |x: &[[f64; 1]]| Ok(vec![x[0], [-x[1][0]]]),
            precondition: |_: &mut [[f64; 1]]| Ok(()),
            solution: vec![[0.0]; 2],
        };
        let run = descend(&mut saddle, vec![[0.0], [1.0]], |_| 0.0, 9).unwrap();
        assert_eq!((run.flat, run.iterations, saddle.solution), (Some(-1.0), 0, vec![[0.0]; 2]));
    }

    #[test]
    fn nothing_to_solve_and_no_iterations_left_give_zero() {
        let zero = conjugate_gradients(matrix, |_| Ok(()), vec![[0.0]; 3], 1e-2, 10).unwrap();
        assert_eq!((zero.solution, zero.iterations), (vec![[0.0]; 3], 0));
        let none = conjugate_gradients(matrix, |_| Ok(()), vec![[1.0]; 3], 1e-2, 0).unwrap();
        assert_eq!((none.solution, none.iterations), (vec![[0.0]; 3], 0));
    }
}
