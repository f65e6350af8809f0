//! What a step of the flow is made of, on a mesh with 10k vertices and on one thread: three columns,
//! joint norms.
#![allow(clippy::unwrap_used, missing_docs)]

use criterion::{criterion_group, criterion_main, BatchSize, Criterion};
use ridgeform_core::block_rows::BLOCK;
use ridgeform_core::linear::cholesky::Cholesky;
use ridgeform_core::linear::Columns;
use ridgeform_core::progress::Progress;
use ridgeform_core::solve::fast::Sweep;
use ridgeform_core::solve::normal_matrix::NormalMatrix;
use ridgeform_core::solve::{Coupling, FreeOperator, Problem, Reduced};
use ridgeform_core::tools::{stylize, SolveOptions, StylizeOptions};
use torus::{torus, Torus};

mod torus;

fn solver(criterion: &mut Criterion) {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().unwrap();
    let Torus { shape, operator, fidelity, normal } = torus(125, 80);
    let (ones, mut entries) = (vec![1.0; operator.n_blocks()], Vec::new());

    let mut group = criterion.benchmark_group("10k vertices");
    group.sample_size(20);
    group.bench_function("normal matrix, pattern", |bencher| bencher.iter(|| NormalMatrix::new(&operator)));
    group.bench_function("normal matrix, values", |bencher| {
        bencher.iter(|| normal.assemble(&operator, &ones, &fidelity, &mut entries));
    });
    group.bench_function("factorization, symbolic", |bencher| {
        bencher.iter(|| Cholesky::analyze(normal.pattern(), None, &Progress::new()));
    });
    let mut cholesky = Cholesky::analyze(normal.pattern(), None, &Progress::new()).unwrap();
    group.bench_function("factorization, numeric", |bencher| {
        bencher.iter(|| cholesky.factorize(&entries, &Progress::new()))
    });
    let points = Columns::from_points(&shape.vertices).unwrap();
    let one: Vec<[f64; 1]> = shape.vertices.iter().map(|x| [x[0]]).collect();
    group.bench_function("triangular solves, one column", |bencher| {
        bencher.iter_batched(|| one.clone(), |mut right| cholesky.solve(&mut right), BatchSize::PerIteration);
    });
    group.bench_function("triangular solves, three columns", |bencher| {
        let right = || shape.vertices.clone();
        bencher.iter_batched(right, |mut right| cholesky.solve(&mut right), BatchSize::PerIteration);
    });

    let problem = Problem {
        operator: &operator,
        weights: ones,
        fidelity,
        target: points,
        fixed: vec![false; operator.n_columns],
        linear_constraints: None,
        coupling: Coupling::Joint,
    };
    let free = FreeOperator::new(&operator, &problem.fixed).unwrap();
    let reduced = Reduced::<4>::new(&problem, &free, &[0, 1, 2]).unwrap();
    let r = vec![100.0; operator.n_blocks()];
    for (name, check) in [("pass over the blocks", false), ("pass over the blocks, with a check", true)] {
        let mut sweep =
            Sweep::new(&reduced, &r, &reduced.target, |_| ([[0.0; 4]; BLOCK], [[0.0; 4]; BLOCK])).unwrap();
        group.bench_function(name, |bencher| {
            bencher.iter(|| sweep.advance(&reduced, &r, &reduced.target, check));
        });
    }

    let options = StylizeOptions {
        iterations: 1,
        solve: SolveOptions { tolerance: Some(1e-3), ..SolveOptions::default() },
        ..StylizeOptions::default()
    };
    group.sample_size(10);
    group.bench_function("a step of the flow, from nothing to a gap of 1e-3", |bencher| {
        let mesh = shape.mesh().unwrap();
        bencher.iter(|| stylize(&mesh, &options, &Progress::new()));
    });
    group.finish();
}

criterion_group!(benches, solver);
criterion_main!(benches);
