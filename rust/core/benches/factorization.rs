//! The parts of a linear solution with 40k rows, on one thread and on two: analysis,
//! factorization, triangular solves.
#![allow(clippy::unwrap_used, missing_docs)]

use criterion::{criterion_group, criterion_main, BatchSize, Criterion};
use ridgeform_core::linear::cholesky::{Cholesky, Precision};
use ridgeform_core::Progress;
use torus::{torus, Torus};

mod torus;

fn factorization(criterion: &mut Criterion) {
    let Torus { shape, operator, fidelity, normal, .. } = torus(250, 160);
    let mut entries = Vec::new();
    normal.assemble(&operator, &vec![1.0; operator.n_blocks()], &fidelity, &mut entries);
    let one: Vec<[f64; 1]> = shape.vertices.iter().map(|x| [x[0]]).collect();

    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut group = criterion.benchmark_group(format!("40k rows, threads: {threads}"));
        group.sample_size(10);
        group.bench_function("analysis", |bencher| {
            bencher.iter(|| pool.install(|| Cholesky::analyze(normal.pattern(), None, &Progress::new())));
        });
        for (name, precision) in [("", Precision::Double), (", single precision", Precision::Single)] {
            let analyzed = || Cholesky::analyze_in(precision, normal.pattern(), None, &Progress::new());
            let mut cholesky = pool.install(analyzed).unwrap();
            group.bench_function(format!("factorization{name}"), |bencher| {
                bencher.iter(|| pool.install(|| cholesky.factorize(&entries, &Progress::new())));
            });
            group.bench_function(format!("triangular solves, one column{name}"), |bencher| {
                let solve = |mut right: Vec<[f64; 1]>| pool.install(|| cholesky.solve(&mut right));
                bencher.iter_batched(|| one.clone(), solve, BatchSize::PerIteration);
            });
            group.bench_function(format!("triangular solves, three columns{name}"), |bencher| {
                let solve = |mut right: Vec<[f64; 3]>| pool.install(|| cholesky.solve(&mut right));
                bencher.iter_batched(|| shape.vertices.clone(), solve, BatchSize::PerIteration);
            });
        }
        group.finish();
    }
}

criterion_group!(benches, factorization);
criterion_main!(benches);
