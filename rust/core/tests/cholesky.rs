//! The sparse Cholesky factorization against the library's, on matrices of every shape.
#![allow(clippy::unwrap_used, missing_docs)]

use faer::linalg::solvers::Solve;
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};
use ridgeform_core::error::SolveError;
use ridgeform_core::linear::cholesky::{Cholesky, Precision};
use ridgeform_core::linear::pattern::LowerPattern;
use ridgeform_core::operators::{Dual, HessianPattern};
use ridgeform_core::shapes;
use ridgeform_core::solve::normal_matrix::NormalMatrix;
use ridgeform_core::{Error, Progress};

/// Numbers without a pattern, the same every time (splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
}

struct Matrix {
    pattern: LowerPattern,
    values: Vec<f64>,
}

impl Matrix {
    /// The matrix with these pairs of rows, and a diagonal that makes it positive definite.
    fn of_pairs(n: usize, pairs: &[(usize, usize)], random: &mut Random) -> Self {
        let mut columns: Vec<Vec<usize>> = (0..n).map(|j| vec![j]).collect();
        for &(i, j) in pairs {
            columns[i.min(j)].push(i.max(j));
        }
        let mut pattern = LowerPattern { n, starts: vec![0], rows: Vec::new() };
        let (mut values, mut sums) = (Vec::new(), vec![0.0; n]);
        for (j, mut column) in columns.into_iter().enumerate() {
            column.sort_unstable();
            column.dedup();
            for i in column {
                let value = random.unit() - 0.6;
                sums[i] += value.abs();
                sums[j] += value.abs();
                pattern.rows.push(i);
                values.push(value);
            }
            pattern.starts.push(pattern.rows.len());
        }
        for j in 0..n {
            values[pattern.starts[j]] = sums[j] + 0.01;
        }
        Self { pattern, values }
    }

    /// `HᵀH` and a small diagonal, of a torus.
    fn of_torus(around: usize, along: usize) -> Self {
        let mesh = shapes::torus(around, along, 3.0, 1.0).noisy(0.01, 1).mesh().unwrap();
        let (connectivity, lengths) = (mesh.connectivity(), mesh.edge_lengths());
        let operator = HessianPattern::new(connectivity)
            .unwrap()
            .assemble(connectivity, lengths, Dual::Barycentric)
            .unwrap();
        let normal = NormalMatrix::new(&operator).unwrap();
        let mut values = Vec::new();
        let diagonal = vec![0.1; operator.n_columns];
        normal.assemble(&operator, &vec![1.0; operator.n_blocks()], &diagonal, &mut values);
        Self { pattern: normal.pattern().clone(), values }
    }

    fn right(&self) -> Vec<[f64; 1]> {
        (0..self.pattern.n).map(|i| [(0.7 * i as f64).sin()]).collect()
    }

    fn solution(&self) -> Vec<[f64; 1]> {
        self.solution_in(Precision::Double)
    }

    fn solution_in(&self, precision: Precision) -> Vec<[f64; 1]> {
        let mut cholesky = Cholesky::analyze_in(precision, &self.pattern, None, &Progress::new()).unwrap();
        cholesky.factorize(&self.values, &Progress::new()).unwrap();
        let mut x = self.right();
        cholesky.solve(&mut x).unwrap();
        x
    }

    /// What the library's own factorization gives.
    fn reference(&self) -> Vec<[f64; 1]> {
        let p = &self.pattern;
        let entries: Vec<Triplet<usize, usize, f64>> = (0..p.n)
            .flat_map(|j| (p.starts[j]..p.starts[j + 1]).map(move |e| (e, j)))
            .map(|(e, j)| Triplet::new(p.rows[e], j, self.values[e]))
            .collect();
        let matrix = SparseColMat::try_new_from_triplets(p.n, p.n, &entries).unwrap();
        let right = self.right();
        let mut x = Mat::from_fn(p.n, 1, |i, _| right[i][0]);
        matrix.sp_cholesky(Side::Lower).unwrap().solve_in_place(&mut x);
        (0..p.n).map(|i| [x[(i, 0)]]).collect()
    }

    /// The same matrix with row `i` in place `place[i]`.
    fn permuted(&self, place: &[usize]) -> Self {
        let p = &self.pattern;
        let mut columns: Vec<Vec<(usize, f64)>> = vec![Vec::new(); p.n];
        for j in 0..p.n {
            for e in p.starts[j]..p.starts[j + 1] {
                let (a, b) = (place[p.rows[e]], place[j]);
                columns[a.min(b)].push((a.max(b), self.values[e]));
            }
        }
        let mut pattern = LowerPattern { n: p.n, starts: vec![0], rows: Vec::new() };
        let mut values = Vec::new();
        for mut column in columns {
            column.sort_unstable_by_key(|&(row, _)| row);
            pattern.rows.extend(column.iter().map(|&(row, _)| row));
            values.extend(column.iter().map(|&(_, value)| value));
            pattern.starts.push(pattern.rows.len());
        }
        Self { pattern, values }
    }
}

fn assert_near(x: &[[f64; 1]], y: &[[f64; 1]], tolerance: f64, what: &str) {
    assert_eq!(x.len(), y.len());
    let largest = y.iter().fold(0.0f64, |most, [y]| most.max(y.abs()));
    for (i, ([x], [y])) in x.iter().zip(y).enumerate() {
        assert!((x - y).abs() <= tolerance * largest, "{what}: row {i} is {x}, not {y}");
    }
}

#[test]
fn agrees_with_the_library_on_matrices_of_every_shape() {
    let mut random = Random(1);
    let path = |n: usize| (1..n).map(|i| (i - 1, i)).collect::<Vec<_>>();
    let mut shapes = vec![
        ("no rows", 0, vec![]),
        ("one row", 1, vec![]),
        ("diagonal", 50, vec![]),
        ("path", 3000, path(3000)),
        (
            "two paths and lone rows",
            90,
            (1..40).map(|i| (i - 1, i)).chain((51..80).map(|i| (i - 1, i))).collect(),
        ),
        ("arrow", 400, (0..399).map(|i| (i, 399)).collect()),
        ("arrow the other way", 400, (1..400).map(|i| (0, i)).collect()),
        ("full", 150, (0..150).flat_map(|i| (0..i).map(move |j| (i, j))).collect()),
        ("caterpillar", 900, (1..300).map(|i| (i - 1, i)).chain((300..900).map(|i| (i % 300, i))).collect()),
    ];
    for n in [2, 3, 5, 9, 17, 33, 65, 200, 700] {
        for degree in [1, 2, 4, 9] {
            let pairs =
                (0..n * degree).map(|_| (random.below(n), random.below(n))).filter(|(i, j)| i != j).collect();
            shapes.push(("random", n, pairs));
        }
    }
    for (name, n, pairs) in shapes {
        let matrix = Matrix::of_pairs(n, &pairs, &mut random);
        let what = format!("{name}, {n} rows");
        assert_near(&matrix.solution(), &matrix.reference(), 1e-12, &what);
        assert_near(&matrix.solution_in(Precision::Single), &matrix.reference(), 1e-3, &what);
    }
    for (around, along) in [(12, 8), (60, 30), (200, 150)] {
        let matrix = Matrix::of_torus(around, along);
        let what = format!("torus of {around} by {along}");
        assert_near(&matrix.solution(), &matrix.reference(), 1e-9, &what);
        assert_near(&matrix.solution_in(Precision::Single), &matrix.reference(), 0.1, &what);
    }
}

/// Large enough for nested dissection, for subtrees on threads and for shared fronts.
fn large() -> Matrix {
    Matrix::of_torus(220, 120)
}

#[test]
fn gives_the_same_bits_on_any_number_of_threads_and_each_time() {
    let matrix = large();
    let run = |threads: usize, precision: Precision| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut cholesky =
                Cholesky::analyze_in(precision, &matrix.pattern, None, &Progress::new()).unwrap();
            let mut solve = || {
                cholesky.factorize(&matrix.values, &Progress::new()).unwrap();
                let right = matrix.right();
                let (mut one, mut three) =
                    (right.clone(), right.iter().map(|[x]| [*x, 1.0, -x]).collect::<Vec<_>>());
                cholesky.solve(&mut one).unwrap();
                cholesky.solve(&mut three).unwrap();
                one.into_iter()
                    .flatten()
                    .chain(three.into_iter().flatten())
                    .map(f64::to_bits)
                    .collect::<Vec<_>>()
            };
            let (first, second) = (solve(), solve());
            assert_eq!(first, second, "the second factorization differs on {threads} threads");
            first
        })
    };
    for precision in [Precision::Double, Precision::Single] {
        let one = run(1, precision);
        for threads in [2, 3, 5] {
            assert_eq!(run(threads, precision), one, "{threads} threads");
        }
    }
}

#[test]
fn another_precision_is_that_of_a_factor_made_in_it_and_takes_half_the_memory() {
    let matrix = large();
    let mut cholesky = Cholesky::analyze(&matrix.pattern, None, &Progress::new()).unwrap();
    for precision in [Precision::Single, Precision::Double, Precision::Single] {
        cholesky.set_precision(precision).unwrap();
        assert_eq!(cholesky.precision(), precision);
        cholesky.factorize(&matrix.values, &Progress::new()).unwrap();
        let mut x = matrix.right();
        cholesky.solve(&mut x).unwrap();
        assert_eq!(x, matrix.solution_in(precision));
    }
    let needed = |precision| {
        let refused =
            Cholesky::analyze_in(precision, &matrix.pattern, Some(1000), &Progress::new()).unwrap_err();
        let Error::Solve(SolveError::Memory { needed, .. }) = refused else { unreachable!("{refused}") };
        needed
    };
    assert_eq!(2 * needed(Precision::Single), needed(Precision::Double));
    // What fits in single precision only is refused in double, and the factor that was is not lost silently.
    let limit = Some(needed(Precision::Single));
    let mut tight =
        Cholesky::analyze_in(Precision::Single, &matrix.pattern, limit, &Progress::new()).unwrap();
    assert!(matches!(tight.set_precision(Precision::Double), Err(SolveError::Memory { .. })));
}

#[test]
fn a_permuted_matrix_has_the_permuted_solution() {
    let mut random = Random(5);
    let matrix = Matrix::of_torus(90, 50);
    let n = matrix.pattern.n;
    let mut place: Vec<usize> = (0..n).collect();
    for i in (1..n).rev() {
        place.swap(i, random.below(i + 1));
    }
    let right = matrix.right();
    let mut permuted = vec![[0.0]; n];
    for i in 0..n {
        permuted[place[i]] = right[i];
    }
    let other = matrix.permuted(&place);
    let mut cholesky = Cholesky::analyze(&other.pattern, None, &Progress::new()).unwrap();
    cholesky.factorize(&other.values, &Progress::new()).unwrap();
    cholesky.solve(&mut permuted).unwrap();
    let back: Vec<[f64; 1]> = place.iter().map(|&p| permuted[p]).collect();
    assert_near(&back, &matrix.solution(), 1e-9, "permuted");
}

#[test]
fn a_bad_pivot_anywhere_is_an_error_and_the_next_factorization_is_right() {
    let matrix = large();
    let right = matrix.solution();
    let mut cholesky = Cholesky::analyze(&matrix.pattern, None, &Progress::new()).unwrap();
    let mut random = Random(9);
    for bad in [-1.0, 0.0, f64::NAN, f64::INFINITY] {
        let mut values = matrix.values.clone();
        values[matrix.pattern.starts[random.below(matrix.pattern.n)]] = bad;
        let error = cholesky.factorize(&values, &Progress::new()).unwrap_err();
        assert!(
            matches!(
                &error,
                Error::Solve(SolveError::Factorization { reason }) if reason.contains("not positive definite")
            ),
            "{error}"
        );
        cholesky.factorize(&matrix.values, &Progress::new()).unwrap();
        let mut x = matrix.right();
        cholesky.solve(&mut x).unwrap();
        assert_eq!(x, right);
    }
}

/// How often the analysis of the torus and its factorization ask whether to stop.
fn asked(around: usize, along: usize) -> [u64; 2] {
    let matrix = Matrix::of_torus(around, along);
    let progress = Progress::new();
    let mut cholesky = Cholesky::analyze(&matrix.pattern, None, &progress).unwrap();
    let of_analysis = progress.n_asked();
    cholesky.factorize(&matrix.values, &progress).unwrap();
    [of_analysis, progress.n_asked() - of_analysis]
}

/// Counted, not timed: 2.25 times as many rows, and 3.4 times as many multiplications.
#[test]
fn questions_whether_to_stop_are_as_many_as_the_work_is_much() {
    let ([analysis, factorization], [more_analysis, more_factorization]) = (asked(200, 130), asked(300, 195));
    assert!(more_analysis >= 2 * analysis, "{analysis} and {more_analysis}");
    assert!(4 * more_factorization >= 9 * factorization, "{factorization} and {more_factorization}");
    assert!(analysis > 100 && factorization > 20, "{analysis} and {factorization}");
}

#[test]
fn stopped_anywhere_it_says_so_and_the_next_factorization_is_right() {
    /// Places of the work where it is stopped, and questions of what had begun beside it.
    const PLACES: u64 = 7;
    const BESIDE: u64 = 64;
    let matrix = Matrix::of_torus(200, 130);
    let progress = Progress::new();
    let mut cholesky = Cholesky::analyze(&matrix.pattern, None, &progress).unwrap();
    let of_analysis = progress.n_asked();
    cholesky.factorize(&matrix.values, &progress).unwrap();
    let of_factorization = progress.n_asked() - of_analysis;
    let mut right = matrix.right();
    cholesky.solve(&mut right).unwrap();
    for place in 0..PLACES {
        let progress = Progress::new();
        let at = 1 + place * (of_analysis - 1) / PLACES;
        progress.stop_when_asked(at, false);
        assert_eq!(Cholesky::analyze(&matrix.pattern, None, &progress).unwrap_err(), Error::Cancelled);
        assert!(progress.n_asked() <= at + BESIDE, "{} after {at}", progress.n_asked());

        let progress = Progress::new();
        let at = 1 + place * (of_factorization - 1) / PLACES;
        progress.stop_when_asked(at, place % 2 == 1);
        assert_eq!(cholesky.factorize(&matrix.values, &progress.hasty()).unwrap_err(), Error::Cancelled);
        assert!(progress.n_asked() <= at + BESIDE, "{} after {at}", progress.n_asked());
        cholesky.factorize(&matrix.values, &Progress::new()).unwrap();
        let mut x = matrix.right();
        cholesky.solve(&mut x).unwrap();
        assert_eq!(x, right);
    }
}
