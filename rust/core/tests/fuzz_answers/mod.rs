//! One call of each tool with arguments drawn from end to end, and what holds of what it returns.

mod options;
mod shapes;

use ridgeform_core::intrinsic::delaunay_flips;
use ridgeform_core::levels;
use ridgeform_core::mesh::{boundary_loops, flipped_faces, report, Mesh, TJunctions, Weld};
use ridgeform_core::operators::{cotangent_laplacian, energy, hessian, hessian_norm, mass_of, Dual, Energy};
use ridgeform_core::remesh::remesh;
use ridgeform_core::shapes::Random;
use ridgeform_core::solve::Solution;
use ridgeform_core::tools::{
    color_regions, denoise, diffusion_curves, facet, fill_holes, interpolate, parts, redraw, restore,
    segment, smooth_curves, stylize, trace_curves, vibration_modes, FacetOptions, Faceted, Flatness,
    Hierarchy, ScalarOptions, SegmentOptions,
};
use ridgeform_core::{Progress, Result};

pub(crate) use shapes::shape;

/// A tool to call.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Tool {
    Operators,
    Denoise,
    Interpolate,
    Modes,
    Stylize,
    Segment,
    Parts,
    FillHoles,
    Remesh,
    Coarsen,
    Curves,
    Trace,
    Facet,
    Restore,
}

/// All of them.
pub(crate) const TOOLS: [(&str, Tool); 14] = [
    ("operators", Tool::Operators),
    ("denoise", Tool::Denoise),
    ("interpolate", Tool::Interpolate),
    ("modes", Tool::Modes),
    ("stylize", Tool::Stylize),
    ("segment", Tool::Segment),
    ("parts", Tool::Parts),
    ("fill holes", Tool::FillHoles),
    ("remesh", Tool::Remesh),
    ("coarsen", Tool::Coarsen),
    ("curves", Tool::Curves),
    ("trace", Tool::Trace),
    ("facet", Tool::Facet),
    ("restore", Tool::Restore),
];

/// A number below `n`.
pub(crate) fn below(random: &mut Random, n: u64) -> u64 {
    random.bits() % n
}

pub(crate) fn any<T: Copy>(random: &mut Random, of: &[T]) -> T {
    of[below(random, of.len() as u64) as usize]
}

fn faces_of(mesh: &Mesh) -> &[[u32; 3]] {
    mesh.connectivity().faces()
}

fn assert_finite<'x>(what: &str, numbers: impl IntoIterator<Item = &'x f64>) {
    assert!(numbers.into_iter().all(|x| x.is_finite()), "{what}: not a number");
}

fn assert_near(mesh: &Mesh, points: &[[f64; 3]]) {
    let Some(positions) = mesh.positions() else { return };
    for c in 0..3 {
        let corners = || faces_of(mesh).iter().flatten().map(|&v| positions[v as usize]);
        let side = |c: usize| {
            let [low, high] =
                corners().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], p| [a.min(p[c]), b.max(p[c])]);
            [low, high, high - low]
        };
        let size = (0..3).map(|c| side(c)[2]).fold(0.0, f64::max) * 10.01;
        let [low, high, _] = side(c);
        let near = |p: &[f64; 3]| p[c].is_finite() && p[c] >= low - size && p[c] <= high + size;
        assert!(points.iter().all(near), "points have left their surroundings: {points:?}");
    }
}

/// Of the vertices that faces name: those without stay, wherever they are.
fn assert_named_near(mesh: &Mesh, faces: &[[u32; 3]], vertices: &[[f64; 3]]) {
    assert_near(mesh, &faces.iter().flatten().map(|&v| vertices[v as usize]).collect::<Vec<_>>());
}

fn assert_sound(solution: &Solution, options: &ScalarOptions) {
    assert_finite("values", &solution.values.data);
    assert_finite("objective and gap", &[solution.objective, solution.gap]);
    assert!(solution.gap >= 0.0);
    let claims = solution.status.name() == "solved";
    assert!(!claims || options.solve.tolerance.is_none_or(|tolerance| solution.gap <= tolerance));
}

/// As many parts as are asked for, at any count.
fn assert_nested(hierarchy: &Hierarchy, labels: &[i32]) -> Result<()> {
    assert_finite("strengths", hierarchy.strengths());
    let [fewest, most] = hierarchy.range();
    for count in [fewest, fewest.midpoint(most), most] {
        let found = hierarchy.labels_at(count)?;
        assert_eq!(found.iter().max().map_or(0, |l| l + 1), count as i32);
        assert!(found.iter().zip(labels).all(|(a, b)| (*a < 0) == (*b < 0)), "other faces take part");
    }
    Ok(())
}

fn assert_facets(mesh: &Mesh, found: &Faceted) {
    assert_named_near(mesh, &found.faces, &found.vertices);
    assert_finite("distances", found.planes.iter().flatten().chain([&found.rms, &found.largest]));
    let named = found.faces.iter().flatten().chain(found.polygons.iter().flatten());
    assert!(named.copied().all(|v| (v as usize) < found.vertices.len()), "corners that do not exist");
    assert!(found.polygons.iter().all(|polygon| polygon.len() >= 3));
    assert!(found.labels.iter().all(|&l| l < found.planes.len() as i32));
    assert_eq!(found.vertices.len(), found.origins.len());
    if let Some(kept) = &found.kept {
        assert_named_near(mesh, faces_of(mesh), &kept.vertices);
    }
}

/// Calls `tool` on `mesh`.
///
/// # Errors
/// Those of the tool.
pub(crate) fn check(tool: Tool, mesh: &Mesh, random: &mut Random) -> Result<()> {
    let progress = Progress::new();
    match below(random, 40) {
        0 | 1 => progress.cancel(),
        2 | 3 => progress.finish(),
        _ => {}
    }
    match tool {
        Tool::Operators => operators(mesh, random),
        Tool::Denoise => denoised(mesh, random, &progress),
        Tool::Interpolate => {
            let few = options::few_vertices(random, mesh);
            let given = options::values(random, few.len());
            let options = options::scalar(random, mesh, given.n_columns);
            let found = interpolate(mesh, &few, &given, &options, &progress)?;
            assert_sound(&found, &options);
            Ok(())
        }
        Tool::Modes => modes(mesh, random, &progress),
        Tool::Stylize => {
            let found = stylize(mesh, &options::stylize(random, mesh), &progress)?;
            assert_finite("energies and gaps", found.energy.iter().chain(&found.gap));
            assert_named_near(mesh, faces_of(mesh), &found.vertices);
            assert!(found.gap.iter().all(|gap| *gap >= 0.0));
            Ok(())
        }
        Tool::Segment => {
            let n = mesh.connectivity().n_vertices();
            let signal = Some(options::values(random, n)).filter(|_| random.uniform() < 0.3);
            let found = segment(mesh, signal.as_ref(), &options::segment(random, mesh), &progress)?;
            assert_finite("values", found.values.data.iter().chain(&found.indicator));
            assert_eq!(found.labels.iter().max().map_or(0, |l| l + 1), found.n_segments as i32);
            assert_nested(&found.hierarchy, &found.labels)
        }
        Tool::Parts => {
            let found = parts(mesh, &options::parts(random, mesh), &progress)?;
            assert_eq!(found.labels.iter().max().map_or(0, |l| l + 1), found.n_parts as i32);
            assert_nested(&found.hierarchy, &found.labels)
        }
        Tool::FillHoles => {
            let found = fill_holes(mesh, &options::fill_holes(random, mesh), &progress)?;
            assert_near(mesh, &found.vertices);
            let n = mesh.connectivity().n_vertices() + found.vertices.len();
            assert!(found.faces.iter().flatten().all(|&v| (v as usize) < n), "corners that do not exist");
            for hole in &found.holes {
                assert_finite("energy and gap", hole.energy.iter().chain([&hole.gap]));
                assert!(hole.gap >= 0.0);
            }
            Ok(())
        }
        Tool::Facet => facets(mesh, random, &progress),
        Tool::Restore => {
            let options = options::restore(random, mesh);
            let found = restore(mesh, &options, &progress)?;
            assert_named_near(mesh, faces_of(mesh), &found.vertices);
            assert_finite("noise", &[found.noise]);
            let before = mesh.positions().unwrap_or_default();
            let stays = |v: usize| options.fixed.as_ref().is_some_and(|f| f[v]);
            let kept = |v: usize| !stays(v) || found.vertices[v] == before[v];
            assert!((0..before.len()).all(kept), "fixed vertices have moved");
            Ok(())
        }
        Tool::Remesh => {
            let found = remesh(mesh, &options::remesh(random, mesh), &progress)?;
            assert_named_near(mesh, &found.faces, &found.vertices);
            assert!(found.edge_length.is_finite());
            Ok(())
        }
        Tool::Coarsen => {
            let n = mesh.connectivity().n_vertices();
            let mut draw = || (0..n).map(|_| random.uniform() < 0.2).collect::<Vec<_>>();
            let (held, kept) = (draw(), draw());
            let wanted = any(random, &[1, 2, 4, n / 2, n]).max(1);
            let held = Some(held.as_slice()).filter(|_| below(random, 3) == 0);
            let kept = Some(kept.as_slice()).filter(|_| below(random, 3) == 0);
            let level = levels::level(mesh, held, kept, wanted, &progress)?;
            assert_near(mesh, level.mesh.positions().unwrap_or_default());
            assert_eq!(level.parents.len(), n);
            let (before, after) = (mesh.positions(), level.mesh.positions());
            for (v, &parent) in level.parents.iter().enumerate().filter(|(_, p)| **p != u32::MAX) {
                let stays = !kept.is_some_and(|kept| kept[v])
                    || before.unwrap_or_default()[v] == after.unwrap_or_default()[parent as usize];
                assert!(stays, "a kept vertex has moved");
            }
            for (face, weights) in level.carry.places().flatten() {
                assert!((face as usize) < faces_of(&level.mesh).len());
                assert_finite("weights", &weights);
            }
            Ok(())
        }
        Tool::Curves => curves(mesh, random, &progress),
        Tool::Trace => {
            let lines: Vec<_> = (0..below(random, 3))
                .map(|_| {
                    let points = (0..below(random, 5)).map(|_| [0; 3].map(|_| 2.0 * random.symmetric()));
                    (points.collect(), below(random, 2) == 0)
                })
                .collect();
            for traced in trace_curves(mesh, &lines)? {
                let exists = |&v: &u32| (v as usize) < mesh.connectivity().n_vertices();
                assert!(traced.vertices.iter().all(exists));
                assert_finite("places", &traced.places);
            }
            Ok(())
        }
    }
}

fn operators(mesh: &Mesh, random: &mut Random) -> Result<()> {
    let connectivity = mesh.connectivity();
    assert_eq!(report(mesh)?.n_boundary_loops, boundary_loops(connectivity)?.len());
    assert_eq!(flipped_faces(connectivity)?.len(), connectivity.n_faces());
    if let Some(positions) = mesh.positions() {
        TJunctions::find(connectivity, positions)?;
        Weld::of_seams(connectivity, positions, None)?;
        Flatness::of(connectivity, positions)?;
    }
    let (flipped, lengths, _) = delaunay_flips(connectivity, mesh.edge_lengths())?;
    assert_eq!(flipped.n_faces(), connectivity.n_faces());
    assert_finite("lengths", lengths.as_flattened());
    // What the wheel hands out.
    let measured = mesh.measured(mesh.unit())?;
    let mass = mass_of(mesh)?;
    assert!(mass.iter().all(|m| m.is_finite() && *m >= 0.0));
    assert_finite("laplacian", cotangent_laplacian(connectivity, measured.edge_lengths())?.data());
    let dual = any(random, &[Dual::Barycentric, Dual::CircumcentricOrBarycentric]);
    assert_finite("hessian", hessian(mesh, dual)?.data());
    let values: Vec<f64> = mass.iter().map(|_| random.symmetric()).collect();
    assert_finite("norm", &hessian_norm(mesh, &values, dual)?);
    let kind = any(random, &Energy::ALL).1;
    let dual = if kind == Energy::L1Hessian { dual } else { Dual::Barycentric };
    assert_finite("energy", &[energy(kind, mesh, &values, None, dual)?]);
    Ok(())
}

fn denoised(mesh: &Mesh, random: &mut Random, progress: &Progress) -> Result<()> {
    let given = options::values(random, mesh.connectivity().n_vertices());
    let options = options::denoise(random, mesh, given.n_columns);
    let found = denoise(mesh, &given, &options, progress)?;
    assert_sound(&found, &options.scalar);
    for (v, _) in options.fixed.iter().flatten().enumerate().filter(|(_, fixed)| **fixed) {
        let kept = |c: usize| found.values.column(c)[v] == given.column(c)[v];
        assert!((0..given.n_columns).all(kept), "fixed values have changed");
    }
    Ok(())
}

fn modes(mesh: &Mesh, random: &mut Random, progress: &Progress) -> Result<()> {
    let options = options::modes(random, mesh);
    let count = any(random, &[1, 2, 3, 4]);
    let found = vibration_modes(mesh, count, &options, progress)?;
    assert_finite("modes", &found.values.data);
    // Energies grow with a power of the inverse size, up to the fourth: of a mesh of 1e-124 they are
    // past all numbers, on the side of 0 where they are. One energy can be below it, on noisy sheets.
    let longest = mesh.edge_lengths().as_flattened().iter().fold(0.0_f64, |longest, l| longest.max(*l));
    let can_be = |energy: f64| energy > 0.0 || energy < 0.0 && options.energy.kind == Energy::L2CurvedHessian;
    let is_one = |&energy: &f64| energy.is_finite() || longest < 1e-60 && can_be(energy);
    assert!(found.energies.iter().all(is_one), "energies: not a number");
    Ok(())
}

/// Facets, and others from the same merges.
fn facets(mesh: &Mesh, random: &mut Random, progress: &Progress) -> Result<()> {
    let options = options::facet(random, mesh);
    let found = facet(mesh, None, &options, progress)?;
    assert_facets(mesh, &found);
    if options.faces.is_none() {
        let again = FacetOptions { facets: any(random, &[None, Some(1), Some(4)]), error: None, ..options };
        assert_facets(mesh, &facet(mesh, Some(&found.merges), &again, progress)?);
    }
    Ok(())
}

/// Curves along regions of colors or any labels, and what they are redrawn and smoothed to.
fn curves(mesh: &Mesh, random: &mut Random, progress: &Progress) -> Result<()> {
    let colors = options::values(random, mesh.connectivity().n_vertices());
    let labels = if below(random, 2) == 0 {
        color_regions(mesh, &colors, &SegmentOptions::default(), None, 1e3, progress)?
    } else {
        faces_of(mesh).iter().map(|_| below(random, 3) as i32).collect()
    };
    let found = diffusion_curves(mesh, &colors, &labels, &options::curves(random), progress)?;
    let drawn = &found.curves;
    let numbers = drawn.left.iter().chain(&drawn.right).chain(&drawn.point_colors);
    assert_finite("colors", found.redrawn.colors.data.iter().chain(numbers).chain([&found.error]));
    assert_finite("redrawn", &redraw(mesh, drawn, Some(&found.sides), progress)?.colors.data);
    if !drawn.edges.is_empty() {
        assert_finite("smoothed", smooth_curves(mesh, &drawn.edges)?.as_flattened().as_flattened());
    }
    Ok(())
}
