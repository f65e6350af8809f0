//! Convex quadratics between bounds, `min ½ xᵀ A x − bᵀ x` with `least ≤ x ≤ most`, for an `A` known by its
//! products: modified proportioning with reduced gradient projections (Dostál and Schöberl 2005).
//!
//! Conjugate gradients on what is strictly between its bounds; where they would leave them, a step to the
//! bound and one of projected gradients; and where bounds hold more than they should, a step away from them.
//! One product a step.

use super::Columns;
use crate::limits::Limits;
use crate::Result;

/// Products to estimate the norm of `A`, by power iteration from the first gradient; the estimate is from
/// below, so the fixed step is half of the longest that surely descends.
const NORM_STEPS: usize = 10;

/// What one column does next, and so which vector it wants multiplied.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    /// A conjugate gradient step along the direction.
    Conjugate,
    /// A step away from bounds along the chopped gradient.
    Proportion,
    /// The gradient has to follow a projected step that was taken.
    Follow,
    /// Nothing: the column is done.
    Done,
}

/// One column of the problem.
struct Column {
    x: Vec<f64>,
    gradient: Vec<f64>,
    vector: Vec<f64>,
    bounds: [f64; 2],
    step: Step,
    enough: f64,
}

/// Minimizes every column between its own bounds `[least, most]`.
///
/// `x` is the start and the result, `descent` is `b − A x` at the start, 0 in rows that are not to move;
/// `multiply` replaces columns by `A` times them and is only given columns that are 0 in those rows. The
/// objective never rises. A step is a product; it rests where the projected gradient of every column has
/// fallen to that part of its first length, and where that `is_enough`, which is asked before every product.
///
/// # Errors
/// Those of `multiply`.
pub fn minimize(
    x: &mut Columns,
    descent: &Columns,
    bounds: &[[f64; 2]],
    limits: Limits,
    is_enough: impl Fn() -> bool,
    mut multiply: impl FnMut(&mut Columns) -> Result<()>,
) -> Result<()> {
    let fixed_step = 1.0 / norm(descent, &is_enough, &mut multiply)?.max(f64::MIN_POSITIVE);
    let mut columns: Vec<Column> = (0..x.n_columns)
        .map(|c| {
            let gradient = descent.column(c).iter().map(|d| -d).collect();
            Column::new(x.column(c).to_vec(), gradient, bounds[c], limits.rest)
        })
        .collect();
    for _ in 0..limits.steps {
        if is_enough() || columns.iter().all(|column| column.step == Step::Done) {
            break;
        }
        let data: Vec<f64> = columns.iter().flat_map(|column| column.vector.iter().copied()).collect();
        let mut product = Columns { data, ..*x };
        multiply(&mut product)?;
        columns.iter_mut().enumerate().for_each(|(c, column)| column.advance(product.column(c), fixed_step));
    }
    for (c, column) in columns.iter().enumerate() {
        x.column_mut(c).copy_from_slice(&column.x);
    }
    Ok(())
}

/// The largest stretch of a column under `A` after some products, or 0.
fn norm(
    start: &Columns,
    is_enough: &impl Fn() -> bool,
    multiply: &mut impl FnMut(&mut Columns) -> Result<()>,
) -> Result<f64> {
    let mut vectors = start.clone();
    let mut largest = 0.0_f64;
    for _ in 0..NORM_STEPS {
        if is_enough() {
            break;
        }
        for c in 0..vectors.n_columns {
            let length = dot(vectors.column(c), vectors.column(c)).sqrt();
            let scale = if length > 0.0 { 1.0 / length } else { 0.0 };
            vectors.column_mut(c).iter_mut().for_each(|x| *x *= scale);
        }
        multiply(&mut vectors)?;
        let lengths = (0..vectors.n_columns).map(|c| dot(vectors.column(c), vectors.column(c)).sqrt());
        largest = lengths.fold(largest, f64::max);
    }
    Ok(2.0 * largest)
}

impl Column {
    fn new(mut x: Vec<f64>, gradient: Vec<f64>, bounds: [f64; 2], fall: f64) -> Self {
        // Rows that do not move may lie where they like.
        x.iter_mut()
            .zip(&gradient)
            .filter(|(_, g)| **g != 0.0)
            .for_each(|(x, _)| *x = x.clamp(bounds[0], bounds[1]));
        let mut column = Self { vector: Vec::new(), x, gradient, bounds, step: Step::Done, enough: 0.0 };
        let [free, chopped] = column.split();
        column.enough = fall * fall * (dot(&free, &free) + dot(&chopped, &chopped));
        column.restart();
        column
    }

    /// The gradient of what lies strictly between the bounds, and what of the rest leads away from them.
    fn split(&self) -> [Vec<f64>; 2] {
        let [least, most] = self.bounds;
        let part = |(&x, &g): (&f64, &f64)| {
            if x <= least {
                [0.0, g.min(0.0)]
            } else if x >= most {
                [0.0, g.max(0.0)]
            } else {
                [g, 0.0]
            }
        };
        let parts: Vec<[f64; 2]> = self.x.iter().zip(&self.gradient).map(part).collect();
        [0, 1].map(|i| parts.iter().map(|p| p[i]).collect())
    }

    /// Chooses the next step without a direction to be conjugate to.
    fn restart(&mut self) {
        self.vector.clear();
        self.choose(None);
    }

    /// Chooses the next step; `conjugate` has the last direction's product and curvature.
    fn choose(&mut self, conjugate: Option<(&[f64], f64)>) {
        let [free, chopped] = self.split();
        let sizes = [dot(&free, &free), dot(&chopped, &chopped)];
        if sizes[0] + sizes[1] <= self.enough {
            self.step = Step::Done;
            self.vector = vec![0.0; self.x.len()];
        } else if sizes[1] > sizes[0] {
            self.step = Step::Proportion;
            self.vector = chopped;
        } else {
            self.step = Step::Conjugate;
            self.vector = match conjugate {
                Some((product, curvature)) => {
                    let back = dot(&free, product) / curvature;
                    free.iter().zip(&self.vector).map(|(g, p)| g - back * p).collect()
                }
                None => free,
            };
        }
    }

    /// Does the step whose product with `A` is now known, and chooses the next one.
    fn advance(&mut self, product: &[f64], fixed_step: f64) {
        match self.step {
            Step::Done => {}
            Step::Follow => {
                self.gradient.iter_mut().zip(product).for_each(|(g, p)| *g += p);
                self.restart();
            }
            Step::Conjugate | Step::Proportion => {
                let curvature = dot(&self.vector, product);
                let best = if curvature > 0.0 {
                    dot(&self.gradient, &self.vector) / curvature
                } else {
                    f64::INFINITY
                };
                let most = self.longest();
                let length = best.min(most);
                if !length.is_finite() {
                    // No curvature and no bound: nothing is to be won but by rounding.
                    self.enough = f64::INFINITY;
                    return self.restart();
                }
                let bounds = self.bounds;
                for (x, p) in self.x.iter_mut().zip(&self.vector).filter(|(_, p)| **p != 0.0) {
                    *x = (*x - length * p).clamp(bounds[0], bounds[1]);
                }
                self.gradient.iter_mut().zip(product).for_each(|(g, p)| *g -= length * p);
                if self.step == Step::Proportion {
                    self.restart();
                } else if best <= most {
                    let product = product.to_vec();
                    self.choose(Some((&product, curvature)));
                } else {
                    self.project(fixed_step);
                }
            }
        }
    }

    /// How far the vector can be gone against until a bound.
    fn longest(&self) -> f64 {
        let [least, most] = self.bounds;
        let room = |(x, p): (&f64, &f64)| {
            if *p > 0.0 {
                (x - least) / p
            } else if *p < 0.0 {
                (x - most) / p
            } else {
                f64::INFINITY
            }
        };
        self.x.iter().zip(&self.vector).map(room).fold(f64::INFINITY, f64::min)
    }

    /// A step of projected gradients, which the gradient follows next.
    fn project(&mut self, fixed_step: f64) {
        let [free, _] = self.split();
        let bounds = self.bounds;
        self.vector = self.x.clone();
        for (x, g) in self.x.iter_mut().zip(&free).filter(|(_, g)| **g != 0.0) {
            *x = (*x - fixed_step * g).clamp(bounds[0], bounds[1]);
        }
        self.vector.iter_mut().zip(&self.x).for_each(|(before, x)| *before = x - *before);
        self.step = Step::Follow;
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::shapes::Random;

    /// `BᵀB` for a random `B`, dense.
    fn matrix(n: usize, random: &mut Random) -> Vec<Vec<f64>> {
        let b: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| random.symmetric()).collect()).collect();
        (0..n).map(|i| (0..n).map(|j| (0..n).map(|k| b[k][i] * b[k][j]).sum()).collect()).collect()
    }

    fn times(a: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
        a.iter().map(|row| dot(row, x)).collect()
    }

    #[test]
    fn meets_the_conditions_of_the_optimum() {
        let mut random = Random::new(3);
        for n in [1, 2, 5, 20] {
            let a = matrix(n, &mut random);
            let b: Vec<f64> = (0..2 * n).map(|_| 3.0 * random.symmetric()).collect();
            let bounds = [[-0.5, 0.5], [-100.0, 100.0]];
            let mut x = Columns::zeros(n, 2);
            let descent = Columns { data: b.clone(), ..x };
            let limits = Limits { steps: 2000, rest: 1e-9 };
            minimize(
                &mut x,
                &descent,
                &bounds,
                limits,
                || false,
                |columns| {
                    (0..2).for_each(|c| {
                        let product = times(&a, columns.column(c));
                        columns.column_mut(c).copy_from_slice(&product);
                    });
                    Ok(())
                },
            )
            .unwrap();
            let mut held = 0;
            for (c, [least, most]) in bounds.into_iter().enumerate() {
                let product = times(&a, x.column(c));
                for i in 0..n {
                    let (x, gradient) = (x.column(c)[i], product[i] - b[c * n + i]);
                    assert!(x >= least && x <= most);
                    let at_least = x <= least && gradient > -1e-6;
                    let at_most = x >= most && gradient < 1e-6;
                    held += usize::from(at_least || at_most);
                    assert!(at_least || at_most || gradient.abs() < 1e-6, "{n} rows, column {c}: {gradient}");
                }
            }
            assert!(n < 5 || held > 0, "no bound holds");
        }
    }

    #[test]
    fn leaves_rows_without_descent_alone() {
        let mut x = Columns::from_column(vec![7.0, 0.0]);
        let descent = Columns::from_column(vec![0.0, 1.0]);
        let limits = Limits { steps: 10, rest: 1e-9 };
        minimize(
            &mut x,
            &descent,
            &[[0.0, 0.25]],
            limits,
            || false,
            |columns| {
                assert!(columns.data[0] == 0.0);
                Ok(())
            },
        )
        .unwrap();
        assert_eq!(x.data, [7.0, 0.25]);
    }
}
