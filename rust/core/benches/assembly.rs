//! How fast a mesh with 400k faces becomes a matrix, on one thread.
#![allow(clippy::unwrap_used, missing_docs)]

use criterion::{criterion_group, criterion_main, Criterion};
use ridgeform_core::intrinsic::delaunay_flips;
use ridgeform_core::mesh::{report, Connectivity};
use ridgeform_core::operators::{voronoi_mass, Dual, HessianPattern};
use ridgeform_core::shapes;

fn assembly(criterion: &mut Criterion) {
    let shape = shapes::torus(640, 312, 3.0, 1.0).noisy(0.002, 1);
    let mesh = shape.mesh().unwrap();
    let (connectivity, lengths) = (mesh.connectivity(), mesh.edge_lengths());
    let pattern = HessianPattern::new(connectivity).unwrap();
    let mut rows = pattern.assemble(connectivity, lengths, Dual::Barycentric).unwrap();
    let mut group = criterion.benchmark_group("400k faces");
    group.sample_size(10);
    group.bench_function("connectivity", |bencher| {
        bencher.iter(|| Connectivity::new(shape.faces.clone(), shape.vertices.len()));
    });
    group.bench_function("report", |bencher| bencher.iter(|| report(&mesh).unwrap()));
    group.bench_function("pattern", |bencher| bencher.iter(|| HessianPattern::new(connectivity).unwrap()));
    group.bench_function("assemble, barycentric", |bencher| {
        bencher.iter(|| pattern.assemble_into(connectivity, lengths, Dual::Barycentric, &mut rows));
    });
    group.bench_function("assemble, circumcentric", |bencher| {
        bencher.iter(|| pattern.assemble_into(connectivity, lengths, Dual::Circumcentric, &mut rows));
    });
    group.bench_function("voronoi mass", |bencher| {
        bencher.iter(|| voronoi_mass(connectivity, lengths).unwrap())
    });
    group.bench_function("delaunay flips", |bencher| bencher.iter(|| delaunay_flips(connectivity, lengths)));
    group.finish();
}

criterion_group!(benches, assembly);
criterion_main!(benches);
