//! What a step of the flow is made of, on a mesh with 10k vertices and on one thread: three columns, joint norms.
#![allow(clippy::unwrap_used, missing_docs)]

use criterion::{criterion_group, criterion_main, BatchSize, Criterion};
use ridgeform_core::block_rows::BLOCK;
use ridgeform_core::operators::{voronoi_mass, Dual, HessianPattern};
use ridgeform_core::progress::Progress;
use ridgeform_core::shapes;
use ridgeform_core::solve::cholesky::Cholesky;
use ridgeform_core::solve::cones::{shrink, Block};
use ridgeform_core::solve::normal_matrix::NormalMatrix;
use ridgeform_core::solve::{Columns, Coupling, FreeOperator, Problem, Reduced, Transposed};
use ridgeform_core::tools::{stylize, SolveOptions, StylizeOptions};

fn solver(criterion: &mut Criterion) {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().unwrap();
    let shape = shapes::torus(125, 80, 3.0, 1.0).noisy(0.01, 1);
    let mesh = shape.mesh().unwrap();
    let (connectivity, lengths) = (mesh.connectivity(), mesh.edge_lengths());
    let operator = HessianPattern::new(connectivity).assemble(connectivity, lengths, Dual::Barycentric).unwrap();
    let fidelity: Vec<f64> = voronoi_mass(connectivity, lengths).iter().map(|m| 2e4 * m).collect();
    let normal = NormalMatrix::new(&operator);
    let (ones, mut entries) = (vec![1.0; operator.n_blocks()], Vec::new());

    let mut group = criterion.benchmark_group("10k vertices");
    group.sample_size(20);
    group.bench_function("normal matrix, pattern", |bencher| bencher.iter(|| NormalMatrix::new(&operator)));
    group.bench_function("normal matrix, values", |bencher| {
        bencher.iter(|| normal.assemble(&operator, &ones, &fidelity, &mut entries));
    });
    group.bench_function("factorisation, symbolic", |bencher| {
        bencher.iter_batched(
            || normal.pattern().clone(),
            |pattern| Cholesky::analyse(pattern, 3),
            BatchSize::PerIteration,
        );
    });
    let mut cholesky = Cholesky::analyse(normal.pattern().clone(), 3).unwrap();
    group.bench_function("factorisation, numeric", |bencher| bencher.iter(|| cholesky.factorise(&entries)));
    let points = Columns::from_points(&shape.vertices);
    for (name, k) in [("triangular solves, one column", 1), ("triangular solves, three columns", 3)] {
        let right = &points.data[..k * points.n_rows];
        group.bench_function(name, |bencher| {
            bencher.iter_batched(|| right.to_vec(), |mut right| cholesky.solve(&mut right, k), BatchSize::PerIteration);
        });
    }

    let problem = Problem {
        operator: &operator,
        weights: ones,
        fidelity,
        target: points,
        fixed: vec![false; operator.n_columns],
        linear_constraints: None,
        coupling: Coupling::Joint,
    };
    let free = FreeOperator::new(&operator, &problem.fixed);
    let transposed = Transposed::new(&operator);
    let reduced = Reduced::<3>::new(&problem, &free, &transposed, &[0, 1, 2]).unwrap();
    let (mut h, mut g): (Vec<Block<3>>, Vec<[f64; 3]>) = (Vec::new(), Vec::new());
    group.bench_function("product with H", |bencher| bencher.iter(|| reduced.apply(&reduced.target, &mut h)));
    group.bench_function("product with the transpose", |bencher| bencher.iter(|| reduced.apply_transposed(&h, &mut g)));
    let mut z = vec![[[0.0; 3]; BLOCK]; h.len()];
    group.bench_function("shrinkage", |bencher| {
        bencher.iter(|| z.iter_mut().zip(&h).for_each(|(z, h)| *z = shrink(h, 0.01)));
    });

    let options = StylizeOptions {
        iterations: 1,
        solve: SolveOptions { tolerance: Some(1e-3), ..SolveOptions::default() },
        ..StylizeOptions::default()
    };
    group.sample_size(10);
    group.bench_function("a step of the flow, from nothing to a gap of 1e-3", |bencher| {
        bencher.iter(|| stylize(&mesh, &options, &Progress::new()));
    });
    group.finish();
}

criterion_group!(benches, solver);
criterion_main!(benches);
