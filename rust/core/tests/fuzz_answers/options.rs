//! Arguments of every tool, drawn from end to end, and now and then a wrong one.

use ridgeform_core::linear::Columns;
use ridgeform_core::mesh::Mesh;
use ridgeform_core::operators::{Dual, Energy};
use ridgeform_core::remesh::RemeshOptions;
use ridgeform_core::shapes::Random;
use ridgeform_core::solve::{Coupling, Solver};
use ridgeform_core::tools::{
    DenoiseOptions, DiffusionCurvesOptions, EnergyOptions, FacetOptions, FillHolesOptions, Fillets, Levels,
    LoopChoice, ModeOptions, PartsOptions, PatchShape, RestoreOptions, ScalarOptions, Scale, SegmentMethod,
    SegmentOptions, Sharpness, SolveOptions, StylizeOptions, Symmetric,
};
use sprs::TriMat;

use super::{any, below, faces_of};

/// What no argument should be.
const WRONG: [f64; 8] =
    [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0, 5e-324, f64::MAX, f64::MIN_POSITIVE];

/// A number from 10⁻⁶ to 10⁶, one in two hundred a wrong one.
fn amount(random: &mut Random) -> f64 {
    match below(random, 200) {
        0 => any(random, &WRONG),
        _ => 10_f64.powf(6.0 * random.symmetric()),
    }
}

/// Of edges, from a twentieth of the longest on: shorter ones are work, not another case.
fn length(random: &mut Random, mesh: &Mesh) -> f64 {
    let longest = mesh.edge_lengths().as_flattened().iter().fold(0.0_f64, |longest, l| longest.max(*l));
    longest * (0.05 + amount(random))
}

/// A share, its ends too; one in two hundred a wrong one.
fn share(random: &mut Random) -> f64 {
    match below(random, 200) {
        0 => any(random, &WRONG),
        i => [0.0, 1.0, 0.5].get(i as usize % 8).copied().unwrap_or_else(|| random.uniform()),
    }
}

/// Nothing, or what `draw` draws.
fn maybe<T>(random: &mut Random, draw: impl FnOnce(&mut Random) -> T) -> Option<T> {
    (below(random, 3) == 0).then(|| draw(random))
}

/// As many as needed, one in two hundred one too few.
fn rows<T>(random: &mut Random, n: usize, mut draw: impl FnMut(&mut Random) -> T) -> Vec<T> {
    let n = if below(random, 200) == 0 { n.saturating_sub(1) } else { n };
    (0..n).map(|_| draw(random)).collect()
}

fn picked(random: &mut Random, n: usize) -> Option<Vec<bool>> {
    let share = any(random, &[0.0, 0.2, 0.7, 1.0]);
    maybe(random, |random| rows(random, n, |random| random.uniform() < share))
}

fn weights(random: &mut Random, n: usize) -> Option<Vec<f64>> {
    let least = any(random, &[1e-3, 1e-3, 0.0]);
    maybe(random, |random| rows(random, n, |random| least + random.uniform()))
}

fn edge_weights(random: &mut Random, mesh: &Mesh) -> Option<Vec<[f64; 3]>> {
    let n = mesh.connectivity().n_faces();
    maybe(random, |random| rows(random, n, |random| [0; 3].map(|_| random.uniform())))
}

/// One to three columns of numbers of any size.
pub(crate) fn values(random: &mut Random, rows: usize) -> Columns {
    let columns = 1 + below(random, 3) as usize;
    let rows = if below(random, 60) == 0 { rows + 1 } else { rows };
    let exponent: i32 = any(random, &[0, 0, 0, -30, 30, -500, 500, -1000, 1000]);
    let size = 2_f64.powi(exponent / 2) * 2_f64.powi(exponent - exponent / 2);
    let mut data: Vec<f64> = (0..rows * columns).map(|_| size * random.symmetric()).collect();
    match below(random, 40) {
        0 if !data.is_empty() => {
            let i = below(random, data.len() as u64) as usize;
            data[i] = any(random, &WRONG);
        }
        1 => data.fill(size),
        _ => {}
    }
    Columns { n_rows: rows, n_columns: columns, data }
}

fn solving(random: &mut Random) -> SolveOptions {
    SolveOptions {
        solver: any(random, &[Solver::Auto, Solver::Auto, Solver::Fast, Solver::Clarabel]),
        tolerance: any(random, &[None, Some(1e-3), Some(0.1), Some(1e-6)]),
        max_iterations: any(random, &[None, Some(1), Some(50)]),
        memory_limit: any(random, &[Some(1), Some(100_000)]).filter(|_| below(random, 20) == 0),
        threads: any(random, &[Some(1), Some(1), Some(1), Some(usize::MAX)]),
    }
}

fn coupling(random: &mut Random) -> Coupling {
    any(random, &[Coupling::Joint, Coupling::Separate])
}

fn dual(random: &mut Random) -> Dual {
    any(random, &[Dual::Barycentric, Dual::Circumcentric, Dual::CircumcentricOrBarycentric])
}

fn levels(random: &mut Random) -> Levels {
    any(random, &[Levels::Auto, Levels::Always, Levels::Never])
}

fn scale(random: &mut Random) -> Scale {
    let length = amount(random);
    any(random, &[Scale::MaxEdge, Scale::BoundingBox, Scale::Area, Scale::Extent, Scale::Length(length)])
}

fn energy(random: &mut Random, mesh: &Mesh) -> EnergyOptions {
    let kind = any(random, &Energy::ALL).1;
    let flips = !matches!(kind, Energy::L2Hessian | Energy::L1HessianStein2018);
    EnergyOptions {
        kind,
        face_weights: weights(random, mesh.connectivity().n_faces()),
        dual: if kind == Energy::L1Hessian { dual(random) } else { Dual::Barycentric },
        delaunay: below(random, if flips { 3 } else { 100 }) == 0,
    }
}

/// Of an energy: a quadratic one takes one factorization, whatever solver is asked for, and mostly none is.
fn solving_of(random: &mut Random, energy: Energy) -> SolveOptions {
    let solve = solving(random);
    let is_plain = energy.is_quadratic() && below(random, 20) > 0;
    SolveOptions { solver: if is_plain { Solver::Auto } else { solve.solver }, ..solve }
}

/// Of the tools that find values. `n_columns`: of what is given to them.
pub(crate) fn scalar(random: &mut Random, mesh: &Mesh, n_columns: usize) -> ScalarOptions {
    let energy = energy(random, mesh);
    let solve = solving_of(random, energy.kind);
    let n = mesh.connectivity().n_vertices();
    let sharp = energy.kind == Energy::L1Hessian || below(random, 20) == 0;
    let linear_constraints = (below(random, 5) == 0).then(|| {
        let mut matrix = TriMat::new((2, n));
        for row in 0..2 {
            for v in (0..n).filter(|_| random.uniform() < 0.5).collect::<Vec<_>>() {
                matrix.add_triplet(row, v, random.symmetric());
            }
        }
        let targets = Columns { n_rows: 2, n_columns, data: vec![random.symmetric(); 2 * n_columns] };
        (matrix.to_csr(), targets)
    });
    ScalarOptions {
        energy,
        linear_constraints,
        coupling: coupling(random),
        sharpness: if sharp && below(random, 3) == 0 { share(random) } else { 0.0 },
        solve,
    }
}

pub(crate) fn denoise(random: &mut Random, mesh: &Mesh, n_columns: usize) -> DenoiseOptions {
    DenoiseOptions {
        fidelity: amount(random),
        fixed: picked(random, mesh.connectivity().n_vertices()),
        scalar: scalar(random, mesh, n_columns),
    }
}

pub(crate) fn modes(random: &mut Random, mesh: &Mesh) -> ModeOptions {
    let energy = energy(random, mesh);
    let solve = solving_of(random, energy.kind);
    ModeOptions { energy, solve }
}

pub(crate) fn stylize(random: &mut Random, mesh: &Mesh) -> StylizeOptions {
    let [n, m] = [mesh.connectivity().n_vertices(), mesh.connectivity().n_faces()];
    StylizeOptions {
        iterations: below(random, 4) as usize,
        fidelity: amount(random),
        movement: maybe(random, amount).filter(|_| random.uniform() < 0.5),
        flat_share: maybe(random, share).filter(|_| random.uniform() < 0.5),
        sharpness: share(random),
        coupling: coupling(random),
        scale: scale(random),
        fixed: picked(random, n),
        strength: weights(random, n),
        ridge_weights: weights(random, m),
        delaunay: below(random, 3) == 0,
        dual: dual(random),
        levels: levels(random),
        solve: solving(random),
    }
}

pub(crate) fn segment(random: &mut Random, mesh: &Mesh) -> SegmentOptions {
    let m = mesh.connectivity().n_faces();
    let standard = SegmentOptions::default();
    let is_paper = below(random, 8) == 0;
    SegmentOptions {
        method: if is_paper { SegmentMethod::Paper } else { SegmentMethod::Fitted },
        length_weight: amount(random),
        fidelity: maybe(random, amount),
        epsilon_start: if is_paper { 0.1 * amount(random) } else { standard.epsilon_start },
        cut_threshold: if is_paper { share(random) } else { standard.cut_threshold },
        min_faces: maybe(random, |random| any(random, &[0, 1, 5, usize::MAX])),
        n_segments: any(random, &[None, None, Some(1), Some(3), Some(100)]),
        scale: scale(random),
        face_weights: weights(random, m),
        edge_weights: edge_weights(random, mesh),
        faces: picked(random, m),
        noise: maybe(random, amount),
        levels: levels(random),
        solve: solving(random),
        fillets: any(random, &[Fillets::Automatic, Fillets::Apart, Fillets::Joined, Fillets::Unseen]),
        ..standard
    }
}

pub(crate) fn parts(random: &mut Random, mesh: &Mesh) -> PartsOptions {
    let m = mesh.connectivity().n_faces();
    PartsOptions {
        n_parts: any(random, &[None, None, Some(1), Some(3), Some(usize::MAX)]),
        coarseness: if below(random, 2) == 0 { 1.0 } else { amount(random) },
        face_weights: weights(random, m),
        edge_weights: edge_weights(random, mesh),
        faces: picked(random, m),
        threads: Some(1),
    }
}

pub(crate) fn fill_holes(random: &mut Random, mesh: &Mesh) -> FillHolesOptions {
    let n = mesh.connectivity().n_vertices();
    let a_loop = |random: &mut Random| {
        if below(random, 2) == 0 {
            return LoopChoice::Index(any(random, &[0, 0, 1, 5, usize::MAX]));
        }
        LoopChoice::Vertices((0..below(random, 5)).map(|_| below(random, n as u64 + 1) as u32).collect())
    };
    FillHolesOptions {
        loops: maybe(random, |random| (0..below(random, 4)).map(|_| a_loop(random)).collect()),
        max_edges: maybe(random, |random| any(random, &[0, 3, 30])),
        outer: below(random, 2) == 0,
        edge_length: maybe(random, |random| length(random, mesh)),
        iterations: below(random, 5) as usize,
        fidelity: amount(random),
        shape: any(random, &[PatchShape::Auto, PatchShape::Flat, PatchShape::Smooth, PatchShape::Sharp]),
        sharpness: if below(random, 2) == 0 { Sharpness::Auto } else { Sharpness::Value(share(random)) },
        coupling: coupling(random),
        scale: scale(random),
        dual: dual(random),
        solve: solving(random),
    }
}

pub(crate) fn remesh(random: &mut Random, mesh: &Mesh) -> RemeshOptions {
    RemeshOptions {
        edge_length: maybe(random, |random| length(random, mesh)),
        iterations: below(random, 4) as usize,
        fixed: picked(random, mesh.connectivity().n_vertices()),
        feature_angle: any(random, &[None, Some(0.0), Some(45.0), Some(180.0)]),
    }
}

pub(crate) fn facet(random: &mut Random, mesh: &Mesh) -> FacetOptions {
    FacetOptions {
        facets: any(random, &[None, None, Some(1), Some(7), Some(100_000)]),
        error: maybe(random, amount),
        edge_weights: edge_weights(random, mesh),
        faces: picked(random, mesh.connectivity().n_faces()),
        keep_triangles: below(random, 4) == 0,
        keep_volume: below(random, 4) == 0,
        symmetric: any(
            random,
            &[None, None, None, None, None, None, Some(Symmetric::Found), Some(Symmetric::Across(0))],
        ),
        levels: levels(random),
        threads: Some(1),
    }
}

pub(crate) fn restore(random: &mut Random, mesh: &Mesh) -> RestoreOptions {
    let [n, m] = [mesh.connectivity().n_vertices(), mesh.connectivity().n_faces()];
    RestoreOptions {
        max_move: maybe(random, amount),
        noise: maybe(random, amount),
        regularize: maybe(random, |random| 30.0 * share(random)),
        free: below(random, 2) == 0,
        fixed: picked(random, n),
        faces: picked(random, m),
        solve: solving(random),
    }
}

pub(crate) fn curves(random: &mut Random) -> DiffusionCurvesOptions {
    DiffusionCurvesOptions {
        fidelity: amount(random),
        rims: below(random, 2) == 0,
        refine: below(random, 2) == 0,
        color_error: any(random, &[0.0, 0.0, 0.3]),
    }
}

/// Some of the vertices that faces name.
pub(crate) fn few_vertices(random: &mut Random, mesh: &Mesh) -> Vec<usize> {
    let mut used: Vec<usize> = faces_of(mesh).iter().flatten().map(|&v| v as usize).collect();
    used.sort_unstable();
    used.dedup();
    random.permutation(used.len()).into_iter().take(5).map(|i| used[i]).collect()
}
