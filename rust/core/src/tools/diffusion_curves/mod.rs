//! Diffusion curves: the few curves, with a color on each side,
//! that redraw a painted surface (Rowe et al. 2024, section 7.6).
//!
//! [`regions`] ([`sharpen`]ed paint, [`sorting`] vertices, [`settle`] faces, [`patches`], [`weak`] borders,
//! [`groups`] of faces) → [`chains`] (the edges between them, as curves) → [`fit`] (colors along the curves,
//! (27)) → [`borders`], [`thinning`] (what is stored) → [`redraw()`] ((26)); fit and drawing on the Laplacian
//! of [`membrane`]. [`trace`] brings curves that were drawn or moved by hand onto the edges, [`smooth`] draws
//! curves without teeth.

mod borders;
mod chains;
mod constants;
mod fit;
mod groups;
mod membrane;
mod patches;
mod redraw;
mod regions;
mod settle;
mod sharpen;
mod smooth;
mod sorting;
mod thinning;
mod trace;
mod weak;

pub use redraw::{redraw, ColoredCurves, Redrawn};
pub use regions::color_regions;
pub use smooth::smooth_curves;
pub use trace::{trace_curves, TracedCurve};

use super::options::check_range;
use crate::error::MeshError;
use crate::linear::Columns;
use crate::memory::{self, Tool};
use crate::mesh::{triangle, CutMesh, EdgeTable, Mesh};
use crate::operators::voronoi_mass;
use crate::progress::{Progress, Report};
use crate::unit::Unit;
use crate::{Error, Result};
use borders::Borders;
use chains::{border_edges, chain};
use fit::{pieces, CopyColors, Task};
use membrane::{Harmonic, Membrane};
use redraw::Conditions;

/// How to find the colors of the curves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiffusionCurvesOptions {
    /// `α` of (27), in the unit that makes the area of the surface 1:
    /// colors are smoothed over a length of `1 / √α`.
    pub fidelity: f64,
    /// Whether the rims of an open mesh are curves too, with one side.
    pub rims: bool,
    /// Whether the colors of (27) are improved until the rebuilt surface is closest to the original.
    pub refine: bool,
    /// How much a color on a curve may change for fewer of them; 0 keeps one at every vertex.
    pub color_error: f64,
}

impl Default for DiffusionCurvesOptions {
    fn default() -> Self {
        Self { fidelity: 1e3, rims: false, refine: true, color_error: 0.0 }
    }
}

/// Curves with colors, and the surface that they rebuild.
#[derive(Debug, Clone, PartialEq)]
pub struct DiffusionCurves {
    /// The curves, edge after edge of one after another, and the colors on their sides; a point for every
    /// piece of surface that no curve reaches.
    pub curves: ColoredCurves,
    /// Where each curve starts among the edges, and their number.
    pub starts: Vec<usize>,
    /// The rebuilt colors.
    pub redrawn: Redrawn,
    /// A face for each vertex whose side it takes; nothing for a vertex that is a blend of its sides,
    /// and without faces.
    pub sides: Vec<Option<u32>>,
    /// Mean squared error of the rebuilt colors over the area and the channels.
    pub error: f64,
    /// How many numbers the curves are: two for each of their vertices (which it is, and its side), the
    /// colors, and one for each knot where colors were thinned; for a point its vertex and color.
    pub n_numbers: usize,
}

/// The curves along the borders of the regions `labels` (one a face),
/// with colors that rebuild `colors` (n × c).
///
/// On each piece of the surface cut open along the borders `min uᵀ L u + α ‖u − u₀‖²` is solved; its values
/// at the borders are the colors of the curves. A vertex on a border counts for the side whose color is
/// nearest, and for none where the mean of its sides is nearer. With [`DiffusionCurvesOptions::refine`] least
/// squares then improve them. Every color stays within the range of `colors`, channel by channel.
///
/// Source: Rowe et al. 2024, eqs. (26) and (27).
///
/// # Errors
/// Arguments of the wrong shape or range, a mesh without faces, [`Error::Cancelled`].
pub fn diffusion_curves(
    mesh: &Mesh,
    colors: &Columns,
    labels: &[i32],
    options: &DiffusionCurvesOptions,
    progress: &Progress,
) -> Result<DiffusionCurves> {
    let unit = Unit::of(colors.data.iter().copied());
    let measured = DiffusionCurvesOptions { color_error: unit.measure(options.color_error), ..*options };
    let mesh = mesh.measured(mesh.unit())?;
    let painted = Painted { mesh: &mesh, colors: &colors.measured(unit), labels };
    let mut found = in_their_unit(&painted, &measured, progress)?;
    found.error = unit.power(2).restore_finite("the error", found.error)?;
    found.curves.restore(unit);
    found.redrawn.restore(unit);
    Ok(found)
}

/// A mesh with colors at its vertices and regions of faces.
struct Painted<'a> {
    mesh: &'a Mesh,
    colors: &'a Columns,
    labels: &'a [i32],
}

/// [`diffusion_curves`] of colors and a mesh whose sizes are sane.
fn in_their_unit(
    painted: &Painted<'_>,
    options: &DiffusionCurvesOptions,
    progress: &Progress,
) -> Result<DiffusionCurves> {
    let &Painted { mesh, colors, labels } = painted;
    let connectivity = mesh.connectivity();
    check_paint(mesh, colors, options.fidelity)?;
    check_labels(labels, connectivity.n_faces())?;
    check_range("color_error", options.color_error, 0.0, f64::MAX)?;
    let area: f64 = mesh.edge_lengths().iter().map(|&l| triangle::area(l)).sum();
    if area <= 0.0 {
        return Err(MeshError::NoFaces.into());
    }
    mesh.demand(Tool::DiffusionCurves).admit(None)?;
    let report = |stage: &str, fraction| {
        progress.report(Report { fraction, stage: stage.into(), ..Report::default() });
        progress.check()
    };
    report("borders", 0.0)?;
    let table = EdgeTable::new(connectivity)?;
    let (edges, starts) = chain(connectivity, &border_edges(connectivity, &table, labels, options.rims)?)?;
    let mut flags = memory::repeated(false, connectivity.n_halfedges())?;
    edges.iter().flat_map(|edge| table.between(edge.ends[0], edge.ends[1])).for_each(|h| flags[h] = true);
    let cut = CutMesh::new(connectivity, &table, &flags)?;
    let membrane = Membrane::new(&cut, mesh.edge_lengths())?;

    report("fitting colors", 0.1)?;
    let task = Task { cut: &cut, membrane: &membrane, colors, fidelity: options.fidelity / area };
    let mut fit = task.screened(progress)?;
    let borders = Borders { connectivity, table: &table, cut: &cut, edges: &edges, starts: &starts };
    let mut curves = borders.colored(&fit.values);
    let on_curves = Conditions::new(connectivity, &table, &cut, &curves)?.fixed;
    let (points, point_colors) = points(&task, &fit, &on_curves)?;
    (curves.points, curves.point_colors) = (points.clone(), point_colors.clone());
    let fixed = Conditions::new(connectivity, &table, &cut, &curves)?.fixed;
    let mut harmonic = Harmonic::new(&membrane, &fixed, progress)?;
    if options.refine && !progress.is_finishing() {
        report("improving colors", 0.4)?;
        task.refined(&mut fit, &mut harmonic, progress)?;
        curves = ColoredCurves { points, point_colors, ..borders.colored(&fit.values) };
    }
    let thinned = options.color_error > 0.0;
    let knots = thinned.then(|| borders.thin(&mut curves, mesh.edge_lengths(), options.color_error));

    report("diffusing", 0.9)?;
    let sides = borders.sides(&fit);
    let conditions = Conditions::new(connectivity, &table, &cut, &curves)?;
    let redrawn = conditions.solve(connectivity, &cut, &mut harmonic, Some(&sides), progress)?;
    let mass = voronoi_mass(connectivity, mesh.edge_lengths())?;
    let error = mean_squared_error(&redrawn.colors, colors, &mass);
    let n_numbers = borders.n_numbers(&curves, knots.as_deref());
    Ok(DiffusionCurves { curves, starts, redrawn, sides, error, n_numbers })
}

fn check_labels(labels: &[i32], n_faces: usize) -> Result<()> {
    if labels.len() == n_faces {
        return Ok(());
    }
    Err(Error::argument("labels", format!("has {} entries, expected one per face: {n_faces}", labels.len())))
}

/// Refuses colors that do not fit the mesh, and a fidelity that is not positive.
fn check_paint(mesh: &Mesh, colors: &Columns, fidelity: f64) -> Result<()> {
    colors.check("colors", mesh.connectivity().n_vertices())?;
    if fidelity > 0.0 && fidelity.is_finite() {
        return Ok(());
    }
    Err(Error::argument("fidelity", format!("is {fidelity}; it must be positive")))
}

/// A vertex for every piece of surface without a curve, and the mean color of the piece.
fn points(task: &Task<'_>, fit: &CopyColors, on_curves: &[bool]) -> Result<(Vec<u32>, Vec<f64>)> {
    let mut roots = pieces(task.cut)?;
    let means = task.means(fit, &mut roots)?;
    let mut reached = memory::repeated(false, on_curves.len())?;
    (0..).zip(on_curves).filter(|(_, on)| **on).for_each(|(i, _)| reached[roots.root(i) as usize] = true);
    let (mut points, mut colors) = (Vec::new(), Vec::new());
    // The root of a piece is its first copy.
    for copy in (0..on_curves.len()).filter(|&i| roots.root(i as u32) as usize == i && !reached[i]) {
        memory::push(&mut points, task.cut.vertices[copy])?;
        memory::extend(&mut colors, means.n_columns)?;
        colors.extend((0..means.n_columns).map(|c| means.column(c)[copy]));
    }
    Ok((points, colors))
}

/// The mean of squared differences over the channels and the area.
fn mean_squared_error(a: &Columns, b: &Columns, mass: &[f64]) -> f64 {
    let total: f64 = mass.iter().sum();
    let squared = |c: usize| {
        let differences = a.column(c).iter().zip(b.column(c)).zip(mass);
        differences.map(|((x, y), m)| m * (x - y) * (x - y)).sum::<f64>()
    };
    (0..a.n_columns).map(squared).sum::<f64>() / (total * a.n_columns as f64)
}
