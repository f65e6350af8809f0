//! One call of each tool with arguments drawn from end to end, and what holds of what it returns.

use ridgeform_core::linear::Columns;
use ridgeform_core::mesh::Mesh;
use ridgeform_core::operators::{Dual, Energy};
use ridgeform_core::remesh::{remesh, RemeshOptions};
use ridgeform_core::shapes::Random;
use ridgeform_core::solve::{Coupling, Solution, Solver};
use ridgeform_core::tools::{
    color_regions, denoise, diffusion_curves, facet, fill_holes, interpolate, restore, segment, stylize,
    vibration_modes, DenoiseOptions, DiffusionCurvesOptions, EnergyOptions, FacetOptions, FillHolesOptions,
    ModeOptions, RestoreOptions, ScalarOptions, SegmentOptions, Sharpness, SolveOptions, StylizeOptions,
};
use ridgeform_core::{Progress, Result};

/// A tool to call.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Tool {
    Denoise,
    Interpolate,
    Modes,
    Stylize,
    Segment,
    FillHoles,
    Remesh,
    Curves,
    Facet,
    Restore,
}

/// All of them.
pub(crate) const TOOLS: [(&str, Tool); 10] = [
    ("denoise", Tool::Denoise),
    ("interpolate", Tool::Interpolate),
    ("modes", Tool::Modes),
    ("stylize", Tool::Stylize),
    ("segment", Tool::Segment),
    ("fill holes", Tool::FillHoles),
    ("remesh", Tool::Remesh),
    ("curves", Tool::Curves),
    ("facet", Tool::Facet),
    ("restore", Tool::Restore),
];

fn any<T: Copy>(random: &mut Random, of: &[T]) -> T {
    of[(random.bits() % of.len() as u64) as usize]
}

fn power(random: &mut Random) -> f64 {
    10_f64.powf(6.0 * random.symmetric())
}

fn values(random: &mut Random, rows: usize) -> Columns {
    let columns = 1 + (random.bits() % 3) as usize;
    let exponent = any(random, &[0, 0, 0, -30, 30, -500, 500, -1000, 1000]);
    let size = 2_f64.powi(exponent / 2) * 2_f64.powi(exponent - exponent / 2);
    Columns {
        n_rows: rows,
        n_columns: columns,
        data: (0..rows * columns).map(|_| size * random.symmetric()).collect(),
    }
}

fn solving(random: &mut Random) -> SolveOptions {
    SolveOptions {
        solver: any(random, &[Solver::Auto, Solver::Auto, Solver::Fast, Solver::Clarabel]),
        tolerance: any(random, &[None, Some(1e-3), Some(0.1), Some(1e-6)]),
        max_iterations: any(random, &[None, Some(1), Some(50)]),
        memory_limit: any(random, &[None, None, Some(1), Some(100_000)]),
        threads: Some(1),
    }
}

fn scalar(random: &mut Random) -> ScalarOptions {
    let kind = any(random, &Energy::ALL).1;
    ScalarOptions {
        energy: EnergyOptions {
            kind,
            delaunay: any(random, &[false, false, true]),
            ..EnergyOptions::default()
        },
        coupling: any(random, &[Coupling::Joint, Coupling::Separate]),
        sharpness: if kind == Energy::L1Hessian { any(random, &[0.0, 0.0, 0.7]) } else { 0.0 },
        solve: SolveOptions { solver: Solver::Auto, ..solving(random) },
        ..ScalarOptions::default()
    }
}

fn assert_finite<'x>(what: &str, numbers: impl IntoIterator<Item = &'x f64>) {
    assert!(numbers.into_iter().all(|x| x.is_finite()), "{what}: not a number");
}

fn assert_near(mesh: &Mesh, points: &[[f64; 3]]) {
    let Some(positions) = mesh.positions() else { return };
    for c in 0..3 {
        let corners = || mesh.connectivity().faces().iter().flatten().map(|&v| positions[v as usize]);
        let side = |c: usize| {
            let [low, high] =
                corners().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], p| [a.min(p[c]), b.max(p[c])]);
            [low, high, high - low]
        };
        let size = (0..3).map(|c| side(c)[2]).fold(0.0, f64::max) * 10.01;
        let [low, high, _] = side(c);
        let near = |p: &[f64; 3]| p[c].is_finite() && p[c] >= low - size && p[c] <= high + size;
        assert!(points.iter().all(near), "points have left their surroundings");
    }
}

fn assert_sound(solution: &Solution, options: &ScalarOptions) {
    assert_finite("values", &solution.values.data);
    assert_finite("objective and gap", &[solution.objective, solution.gap]);
    assert!(solution.gap >= 0.0);
    let claims = solution.status.name() == "solved";
    assert!(!claims || options.solve.tolerance.is_none_or(|tolerance| solution.gap <= tolerance));
}

/// Calls `tool` on `mesh`.
///
/// # Errors
/// Those of the tool.
pub(crate) fn check(tool: Tool, mesh: &Mesh, random: &mut Random) -> Result<()> {
    let progress = Progress::new();
    let n = mesh.connectivity().n_vertices();
    match random.bits() % 20 {
        0 => progress.cancel(),
        1 => progress.finish(),
        _ => {}
    }
    match tool {
        Tool::Denoise => {
            let scalar = scalar(random);
            let fixed: Vec<bool> = (0..n).map(|_| random.uniform() < 0.1).collect();
            let given = values(random, n);
            let options = DenoiseOptions { fidelity: power(random), fixed: Some(fixed.clone()), scalar };
            let found = denoise(mesh, &given, &options, &progress)?;
            assert_sound(&found, &options.scalar);
            for c in 0..given.n_columns {
                let kept = |v: usize| !fixed[v] || found.values.column(c)[v] == given.column(c)[v];
                assert!((0..n).all(kept), "fixed values have changed");
            }
        }
        Tool::Interpolate => {
            let scalar = scalar(random);
            let mut used: Vec<usize> =
                mesh.connectivity().faces().iter().flatten().map(|&v| v as usize).collect();
            used.sort_unstable();
            used.dedup();
            let few: Vec<usize> =
                random.permutation(used.len()).into_iter().take(5).map(|i| used[i]).collect();
            let given = values(random, few.len());
            let found = interpolate(mesh, &few, &given, &scalar, &progress)?;
            assert_sound(&found, &scalar);
        }
        Tool::Modes => {
            let energy = scalar(random).energy;
            let kind = energy.kind;
            let options =
                ModeOptions { energy, solve: SolveOptions { solver: Solver::Auto, ..solving(random) } };
            let found = vibration_modes(mesh, 1 + (random.bits() % 3) as usize, &options, &progress)?;
            assert_finite("modes", &found.values.data);
            // Energies grow with a power of the inverse size, up to the fourth: of a mesh of 1e-124 they are
            // past all numbers, on the side of 0 where they are. One energy can be below it, on noisy sheets.
            let longest =
                mesh.edge_lengths().as_flattened().iter().fold(0.0_f64, |longest, l| longest.max(*l));
            let can_be = |energy: f64| energy > 0.0 || energy < 0.0 && kind == Energy::L2CurvedHessian;
            let is_one = |&energy: &f64| energy.is_finite() || longest < 1e-60 && can_be(energy);
            assert!(found.energies.iter().all(is_one), "energies: not a number");
        }
        Tool::Stylize => {
            let options = StylizeOptions {
                iterations: (random.bits() % 4) as usize,
                fidelity: power(random),
                sharpness: random.uniform(),
                delaunay: any(random, &[false, false, true]),
                dual: any(random, &[Dual::Barycentric, Dual::CircumcentricOrBarycentric]),
                solve: solving(random),
                ..StylizeOptions::default()
            };
            let found = stylize(mesh, &options, &progress)?;
            assert_finite("energies and gaps", found.energy.iter().chain(&found.gap));
            let corners = mesh.connectivity().faces().iter().flatten();
            assert_near(mesh, &corners.map(|&v| found.vertices[v as usize]).collect::<Vec<_>>());
            assert!(found.gap.iter().all(|gap| *gap >= 0.0));
        }
        Tool::Segment => {
            let signal = Some(values(random, n)).filter(|_| random.uniform() < 0.3);
            let options = SegmentOptions {
                length_weight: power(random),
                n_segments: any(random, &[None, Some(1), Some(100)]),
                solve: SolveOptions { threads: Some(1), ..SegmentOptions::default().solve },
                ..SegmentOptions::default()
            };
            let found = segment(mesh, signal.as_ref(), &options, &progress)?;
            assert_finite("values", found.values.data.iter().chain(&found.indicator));
            assert_eq!(found.labels.iter().max().map_or(0, |l| l + 1), found.n_segments as i32);
        }
        Tool::FillHoles => {
            let options = FillHolesOptions {
                outer: any(random, &[false, true]),
                iterations: (random.bits() % 5) as usize,
                fidelity: power(random),
                sharpness: any(random, &[Sharpness::Auto, Sharpness::Value(0.0), Sharpness::Value(1.0)]),
                solve: solving(random),
                ..FillHolesOptions::default()
            };
            let found = fill_holes(mesh, &options, &progress)?;
            assert_near(mesh, &found.vertices);
            for hole in &found.holes {
                assert_finite("energy and gap", hole.energy.iter().chain([&hole.gap]));
                assert!(hole.gap >= 0.0);
            }
        }
        Tool::Facet => {
            let faces: Vec<bool> =
                mesh.connectivity().faces().iter().map(|_| random.uniform() < 0.7).collect();
            let distance = power(random);
            let options = FacetOptions {
                facets: any(random, &[None, Some(1), Some(7), Some(100_000)]),
                error: any(random, &[None, None, Some(distance)]),
                faces: Some(faces).filter(|_| random.uniform() < 0.3),
                threads: Some(1),
                ..FacetOptions::default()
            };
            let found = facet(mesh, None, &options, &progress)?;
            assert_near(mesh, &found.vertices);
            assert_finite("distances", found.planes.iter().flatten().chain([&found.rms, &found.largest]));
            let named = found.faces.iter().flatten().chain(found.polygons.iter().flatten());
            assert!(named.copied().all(|v| (v as usize) < found.vertices.len()), "corners that do not exist");
            assert!(found.polygons.iter().all(|polygon| polygon.len() >= 3));
            assert!(found.labels.iter().all(|&l| l < found.planes.len() as i32));
        }
        Tool::Restore => {
            let fixed: Vec<bool> = (0..n).map(|_| random.uniform() < 0.2).collect();
            let lengths = [power(random), power(random)];
            let options = RestoreOptions {
                max_move: any(random, &[None, None, Some(lengths[0])]),
                noise: any(random, &[None, None, Some(lengths[1])]),
                regularize: any(random, &[None, Some(5.0)]),
                free: any(random, &[true, false]),
                fixed: Some(fixed).filter(|_| random.uniform() < 0.3),
                solve: solving(random),
                ..RestoreOptions::default()
            };
            let found = restore(mesh, &options, &progress)?;
            let corners = mesh.connectivity().faces().iter().flatten();
            assert_near(mesh, &corners.map(|&v| found.vertices[v as usize]).collect::<Vec<_>>());
            assert_finite("noise", &[found.noise]);
            let before = mesh.positions().unwrap_or_default();
            let kept =
                |v: usize| !options.fixed.as_ref().is_some_and(|f| f[v]) || found.vertices[v] == before[v];
            assert!((0..n).all(kept), "fixed vertices have moved");
        }
        Tool::Remesh => {
            let iterations = (random.bits() % 3) as usize;
            let found = remesh(mesh, &RemeshOptions { iterations, ..RemeshOptions::default() }, &progress)?;
            assert_near(mesh, &found.vertices);
            assert!(found.edge_length.is_finite());
        }
        Tool::Curves => {
            let colors = values(random, n);
            let regions = SegmentOptions::default();
            let labels = color_regions(mesh, &colors, &regions, None, 1e3, &progress)?;
            let found =
                diffusion_curves(mesh, &colors, &labels, &DiffusionCurvesOptions::default(), &progress)?;
            assert_finite(
                "colors",
                found.redrawn.colors.data.iter().chain(&found.curves.left).chain([&found.error]),
            );
        }
    }
    Ok(())
}
