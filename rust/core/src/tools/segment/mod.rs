//! Segmentation: the faces that a person would name, with clean borders (Rowe et al. 2024, section 7.5).
//!
//! [`indicator`] minimizes the functional (41), whose `v` is low at borders. From there on the paper's way is
//! [`threshold`]; the other one ([`passes`]) is [`watershed`], then merging across borders that bend little
//! ([`crease`], [`merge`]), dividing what lies across a ridge ([`divide`]), joining what a neighbor explains
//! ([`explain`]), and moving faces at borders to the segment that they fit best ([`relabel`]), or, between
//! curved segments, along creases ([`straighten`]). Sides of a few triangles, which the Hessian cannot see,
//! are told by their planes ([`exact`]), tangent faces of CAD parts by their surfaces ([`cover`]), sides of a
//! few rows under little noise by the clear ridges around them ([`regions`]). Where surfaces of a known kind
//! explain faces, these are segments ([`mod@fillets`]). In any case a [`hierarchy`] of nested segmentations
//! comes with it ([`nesting`]). Faces split at T-junctions ([`split`]) and [`copies`]
//! of faces are given back as the mesh has them.

mod blends;
mod coarse_to_fine;
mod constants;
mod copies;
mod cover;
mod crease;
mod divide;
mod exact;
mod explain;
mod fillets;
mod hierarchy;
mod indicator;
mod indicator_step;
mod merge;
mod nesting;
mod noise;
mod normalized;
mod options;
mod part;
mod passes;
mod patches;
mod piece;
mod regions;
mod relabel;
mod segmentation;
mod slopes;
mod split;
mod straighten;
mod surface;
mod tangent;
mod threshold;
mod walk;
mod watershed;

pub use hierarchy::Hierarchy;
pub use options::{Fillets, SegmentMethod, SegmentOptions};
pub(super) use segmentation::boundary_edges;
pub use segmentation::Segmentation;

use crate::error::MeshError;
use crate::linear::Columns;
use crate::memory::Tool;
use crate::mesh::partition::contiguous;
use crate::mesh::{Mesh, TJunctions, Working};
use crate::progress::Progress;
use crate::solve::{Settings, Status};
use crate::tools::answer;
use crate::tools::Scale;
use crate::unit::Unit;
use crate::{memory, Result};
use coarse_to_fine::coarse_to_fine;
use constants::{BEND, LEAST_EPSILON};
use copies::Copies;
use cover::{covered, is_even};
use exact::coarse_planes;
use fillets::by_surfaces;
use indicator::Functional;
use noise::noise_level;
use normalized::Normalized;
use passes::Passes;
use surface::Surface;

/// Divides the faces of `mesh` into segments on which `values`, or without them the vertex positions,
/// are nearly affine.
///
/// Minimizes `α ‖u − u₀‖²_M + Σ_f v_f² ‖(H u)_f‖ + λ ε vᵀ L v + λ/(4ε) ‖1 − v‖²_{M_F}` (Rowe et al. 2024, eq.
/// (41)) in turns over `u` and `v`, with `ε` halved down, and makes segments from `v`: see [`SegmentMethod`].
///
/// Faces are oriented first, and for a shape its seams joined ([`Working`]),
/// T-junctions too ([`TJunctions`]).
///
/// # Errors
/// [`MeshError::NoPositions`], [`MeshError::NoFaces`], arguments of the wrong shape or range,
/// [`crate::Error::Cancelled`], and the errors of the solver.
pub fn segment(
    mesh: &Mesh,
    values: Option<&Columns>,
    options: &SegmentOptions,
    progress: &Progress,
) -> Result<Segmentation> {
    options.check(mesh, values)?;
    if values.is_some() {
        // The values may differ between the sides of a seam.
        return oriented(mesh, &Working::unwelded(mesh)?, values, options, progress);
    }
    let working = Working::new(mesh)?;
    let here = working.mesh();
    let positions = here.positions().ok_or(MeshError::NoPositions)?;
    let Some(found) = TJunctions::find(here.connectivity(), positions)? else {
        return oriented(mesh, &working, None, options, progress);
    };
    let split = found.split(here, positions)?;
    let options = split::options_of_parts(&split, &options_here(&working, options)?)?;
    // Joined sides may disagree on what is outside.
    let parts = oriented(&split.mesh, &Working::unwelded(&split.mesh)?, None, &options, progress)?;
    given_back(&working, None, split::of_whole_faces(&split, here, parts)?)
}

/// Segments the `working` mesh made of `mesh`, and gives back what comes out for that.
fn oriented(
    mesh: &Mesh,
    working: &Working<'_>,
    values: Option<&Columns>,
    options: &SegmentOptions,
    progress: &Progress,
) -> Result<Segmentation> {
    if working.is_plain() {
        return on(mesh, values, options, progress);
    }
    given_back(working, values, on(working.mesh(), values, &options_here(working, options)?, progress)?)
}

/// The options for the faces of the working mesh.
fn options_here(working: &Working<'_>, options: &SegmentOptions) -> Result<SegmentOptions> {
    let edge_weights =
        options.edge_weights.as_ref().map(|weights| working.corner_rows(weights)).transpose()?;
    let faces = options.faces.as_deref().map(memory::twin).transpose()?;
    let face_weights = options.face_weights.as_deref().map(memory::twin).transpose()?;
    Ok(SegmentOptions { edge_weights, faces, face_weights, ..options.without_arrays() })
}

/// The same for the mesh that the working one was made of.
fn given_back(working: &Working<'_>, values: Option<&Columns>, found: Segmentation) -> Result<Segmentation> {
    let edges = found.boundary_edges.iter();
    Ok(Segmentation {
        boundary_edges: memory::gathered(edges.map(|edge| edge.map(|v| working.original(v))))?,
        values: match values {
            None => Columns::from_points(&working.positions(&found.values.to_points()?)?)?,
            Some(_) => found.values,
        },
        ..found
    })
}

/// Segments a mesh as it is.
fn on(
    mesh: &Mesh,
    values: Option<&Columns>,
    options: &SegmentOptions,
    progress: &Progress,
) -> Result<Segmentation> {
    let settings = Settings { announce: false, ..options.solve.settings()? };
    let n_columns = values.map_or(3, |values| values.n_columns);
    let length = mesh.unit();
    let value = values.map_or(length, |values| Unit::of(values.data.iter().copied()));
    let mesh = mesh.measured(length)?;
    let values = values.map(|values| values.measured(value));
    let scale = match options.scale {
        Scale::Length(given) => Scale::Length(length.measure(given)),
        relative => relative,
    };
    let noise = options.noise.map(|noise| value.measure(noise));
    let options = &SegmentOptions { scale, noise, ..options.copied()? };
    let copies = Copies::among(mesh.connectivity(), options.faces.as_deref())?;
    let without = copies.as_ref().map(|copies| copies.others(options.faces.as_deref())).transpose()?;
    let mut found = options.solve.run(|| {
        let by_levels = options.are_levels_used(mesh.connectivity().n_vertices(), values.is_some());
        mesh.demand(if by_levels { Tool::SegmentByLevels } else { Tool::Segment })
            .with_columns(n_columns, options.solve.solver.is_clarabel())
            .admit(options.solve.memory_limit)?;
        match without.as_ref().or(options.faces.as_ref()) {
            None => whole(&mesh, values.as_deref(), options, &settings, progress),
            Some(faces) => {
                part::segment_part(&mesh, values.as_deref(), faces, options, |mesh, values, options| {
                    whole(mesh, values, options, &settings, progress)
                })
            }
        }
    })?;
    if let Some(copies) = &copies {
        found = copies.given(found)?;
    }
    value.restore_all(found.values.data.iter_mut());
    found.noise = value.restore(found.noise);
    if !found.values.data.iter().all(|x| x.is_finite()) {
        return Err(answer::refused());
    }
    Ok(found)
}

/// Segments all faces.
fn whole(
    mesh: &Mesh,
    values: Option<&Columns>,
    options: &SegmentOptions,
    settings: &Settings,
    progress: &Progress,
) -> Result<Segmentation> {
    if options.fillets == Fillets::Unseen || !options.is_plain(values.is_some()) {
        return Ok(by_bends(mesh, values, options, settings, progress)?.0);
    }
    mesh.demand(Tool::Restore).admit(options.solve.memory_limit)?;
    let all = SegmentOptions { n_segments: None, ..options.copied()? };
    let (found, is_exact) = by_bends(mesh, values, &all, settings, progress)?;
    let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
    let costs = options.edge_costs(mesh)?;
    let surface = Surface::new(mesh.connectivity(), positions, options.unit_of(mesh), costs)?;
    // A tessellation is in its surfaces already, and has few vertices inside of them to see any by.
    let is_tessellated = is_exact && !is_even(&surface, BEND * options.length_weight)?;
    by_surfaces(mesh, &surface, found, is_tessellated, options, progress)
}

/// Segments all faces by the bends between them, and says whether the shape is exact.
fn by_bends(
    mesh: &Mesh,
    values: Option<&Columns>,
    options: &SegmentOptions,
    settings: &Settings,
    progress: &Progress,
) -> Result<(Segmentation, bool)> {
    let positions = mesh.positions().ok_or(MeshError::NoPositions)?;
    let unit = options.unit_of(mesh);
    if !(unit > 0.0 && unit.is_finite()) {
        return Err(MeshError::NoFaces.into());
    }
    let surface = Surface::new(mesh.connectivity(), positions, unit, options.edge_costs(mesh)?)?;
    if surface.areas.iter().all(|area| *area <= 0.0) {
        return Err(MeshError::NoFaces.into());
    }
    let signal = values.map(Normalized::of).transpose()?;
    let start = match &signal {
        Some(signal) => signal.values.copied()?,
        None => Columns::from_points(&surface.positions)?,
    };
    let exact = if options.is_plain(values.is_some()) {
        let bend = BEND * options.length_weight;
        match covered(&surface, bend, progress)? {
            Some(faces) => Some(faces),
            None => coarse_planes(&surface, bend)?,
        }
    } else {
        None
    };
    let is_exact = exact.is_some();
    let degrees = values.map_or(1, |v| v.n_columns);
    let size = signal.as_ref().map_or(unit, |signal| signal.range);
    let noise = match options.noise {
        _ if is_exact => 0.0,
        Some(given) => given / size,
        None => noise_level(&surface, &start, degrees)?,
    };
    if options.are_levels_used(positions.len(), values.is_some()) {
        if !is_exact {
            let segment = |mesh: &Mesh, options: &SegmentOptions| {
                Ok(by_bends(mesh, None, options, settings, progress)?.0)
            };
            if let Some(found) = coarse_to_fine(mesh, &surface, noise, unit, options, progress, segment)? {
                return Ok((found, false));
            }
        }
        mesh.demand(Tool::Segment)
            .with_columns(3, options.solve.solver.is_clarabel())
            .admit(options.solve.memory_limit)?;
    }
    let mut epsilons = options.epsilons(LEAST_EPSILON * surface.mean_edge);
    if is_exact {
        epsilons.drain(..epsilons.len() - 1);
    }
    let functional = Functional {
        surface: &surface,
        values: &start,
        length_weight: options.length_weight,
        face_costs: &options.face_costs(&surface.costs)?,
        fidelity: options.starting_fidelity(),
        noise: options.fidelity.is_none().then_some(noise),
        epsilons: epsilons.clone(),
        inner_tolerance: options.inner_tolerance,
        solver: options.solve.solver,
        settings: *settings,
    };
    let found = if is_exact { functional.indicate(progress)? } else { functional.minimize(progress)? };
    let mut passes = Passes {
        surface: &surface,
        start: &start,
        is_shape: values.is_none(),
        noise,
        indicator: &found.indicator,
        planes: exact.as_ref(),
        regions: None,
        options,
        progress,
    };
    let regions = passes.regions()?;
    passes.regions = regions.as_ref();
    let slopes = passes.slopes()?;
    let merging = passes.merging(&slopes);
    let leaves = passes.leaves()?;
    let (labels, n_segments) = contiguous(&passes.joined(&merging, &leaves)?)?;
    let hierarchy = passes.hierarchy(&merging, &leaves, &labels)?;
    let labels = hierarchy.labels_at(n_segments)?;
    let unscaled = |columns: &Columns| match &signal {
        Some(signal) => signal.restored(columns),
        None if is_exact => Columns::from_points(positions),
        None => {
            let data = memory::gathered(columns.data.iter().map(|x| unit * x))?;
            Ok(Columns { data, ..*columns })
        }
    };
    let found = Segmentation {
        boundary_edges: boundary_edges(mesh, &labels)?,
        labels,
        n_segments,
        indicator: found.indicator,
        values: unscaled(&found.values)?,
        hierarchy,
        noise: noise * size,
        fidelity: found.fidelity,
        epsilons,
        alternations: found.alternations,
        status: if progress.is_finishing() { Status::Stopped } else { found.status },
    };
    Ok((found, is_exact))
}
