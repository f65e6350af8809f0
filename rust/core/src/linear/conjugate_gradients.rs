//! Conjugate gradients with a factored matrix near the one of the system as preconditioner.

/// What a run found.
#[derive(Debug)]
pub struct Approximation<const K: usize> {
    /// The approximate solution.
    pub solution: Vec<[f64; K]>,
    /// Iterations made.
    pub iterations: usize,
}

/// Solves `matrix · x = right` until the residual, in the norm of the preconditioner, is `goal` times what it was, or for
/// `most` iterations (Hestenes and Stiefel 1952). A preconditioner that keeps to a linear subspace keeps the solution there.
pub fn conjugate_gradients<const K: usize>(
    mut matrix: impl FnMut(&[[f64; K]], &mut Vec<[f64; K]>),
    mut precondition: impl FnMut(&mut [[f64; K]]),
    right: Vec<[f64; K]>,
    goal: f64,
    most: usize,
) -> Approximation<K> {
    let mut residual = right;
    let mut solution = vec![[0.0; K]; residual.len()];
    let mut step = residual.clone();
    precondition(&mut step);
    let mut direction = step.clone();
    let mut length = dot(&residual, &step);
    let enough = goal * goal * length;
    let mut product = Vec::new();
    let mut iterations = 0;
    while iterations < most && length > enough {
        matrix(&direction, &mut product);
        let far = length / dot(&direction, &product);
        if !far.is_finite() {
            break;
        }
        iterations += 1;
        add(far, &direction, &mut solution);
        add(-far, &product, &mut residual);
        step.clone_from(&residual);
        precondition(&mut step);
        let before = std::mem::replace(&mut length, dot(&residual, &step));
        for (d, s) in direction.iter_mut().flatten().zip(step.iter().flatten()) {
            *d = s + length / before * *d;
        }
    }
    Approximation { solution, iterations }
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
    use super::*;

    /// `2 x_i − x_{i−1} − x_{i+1} + x_i / 2`: definite, with many eigenvalues.
    fn matrix(x: &[[f64; 1]], out: &mut Vec<[f64; 1]>) {
        let at = |i: Option<usize>| i.and_then(|i| x.get(i)).map_or(0.0, |x| x[0]);
        *out = (0..x.len()).map(|i| [2.5 * x[i][0] - at(i.checked_sub(1)) - at(Some(i + 1))]).collect();
    }

    #[test]
    fn the_residual_falls_to_the_goal() {
        let right: Vec<[f64; 1]> = (0..50).map(|i| [(i as f64).sin()]).collect();
        let found = conjugate_gradients(matrix, |_| {}, right.clone(), 1e-10, 200);
        let mut rest = Vec::new();
        matrix(&found.solution, &mut rest);
        add(-1.0, &right, &mut rest);
        assert!(dot(&rest, &rest) <= 1.1e-20 * dot(&right, &right));
        assert!((10..50).contains(&found.iterations), "{} iterations", found.iterations);
    }

    #[test]
    fn with_the_matrix_itself_as_preconditioner_one_iteration_is_enough() {
        let scale = |x: &[[f64; 1]], out: &mut Vec<[f64; 1]>| *out = x.iter().map(|x| [7.0 * x[0]]).collect();
        let precondition = |x: &mut [[f64; 1]]| x.iter_mut().for_each(|x| x[0] /= 7.0);
        let found = conjugate_gradients(scale, precondition, vec![[14.0], [-7.0]], 1e-12, 20);
        assert_eq!((found.solution, found.iterations), (vec![[2.0], [-1.0]], 1));
    }

    #[test]
    fn nothing_to_solve_and_no_iterations_left_give_zero() {
        let zero = conjugate_gradients(matrix, |_| {}, vec![[0.0]; 3], 1e-2, 10);
        assert_eq!((zero.solution, zero.iterations), (vec![[0.0]; 3], 0));
        let none = conjugate_gradients(matrix, |_| {}, vec![[1.0]; 3], 1e-2, 0);
        assert_eq!((none.solution, none.iterations), (vec![[0.0]; 3], 0));
    }
}
