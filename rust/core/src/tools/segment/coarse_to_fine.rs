//! Segments of a large mesh, found on a coarser one.
//!
//! Which faces there are, a mesh of some thousand vertices says as well as one of a million, and with less
//! noise ([`crate::levels`]). So all passes are done there; on each finer level only the borders move, to
//! where it has them. The hierarchy is that of the coarsest level.

use std::collections::BTreeMap;

use super::noise::noise_level;
use super::options::SegmentOptions;
use super::passes::Passes;
use super::segmentation::{boundary_edges, Segmentation};
use super::surface::{Surface, NONE};
use crate::error::MeshError;
use crate::levels::{face_values, levels, Level};
use crate::linear::Columns;
use crate::mesh::partition::contiguous;
use crate::mesh::vector::Point;
use crate::mesh::Mesh;
use crate::progress::Progress;
use crate::tools::options::ENOUGH;
use crate::tools::{Levels, Scale};
use crate::{memory, Result};

/// The segments of `mesh`, a shape whose `surface` has lengths in `unit`; nothing if it has no coarser level.
/// Those of the coarsest are found by `segment`.
pub(super) fn coarse_to_fine(
    mesh: &Mesh,
    surface: &Surface<'_>,
    noise: f64,
    unit: f64,
    options: &SegmentOptions,
    progress: &Progress,
    segment: impl FnOnce(&Mesh, &SegmentOptions) -> Result<Segmentation>,
) -> Result<Option<Segmentation>> {
    let levels = levels(mesh, None, ENOUGH, progress)?;
    let Some(coarsest) = levels.last() else { return Ok(None) };
    let values = |weights: &Vec<f64>| face_values(mesh, &levels, weights);
    let weights = options.face_weights.as_ref().map(values).transpose()?;
    // What is said of the noise of the mesh is in proportion true of coarser ones.
    let found_here = noise_level(surface, &Columns::from_points(&surface.positions)?, 1)?;
    let doubt = if options.noise.is_some() && found_here > 0.0 { noise / found_here } else { 1.0 };
    let noise_on = |surface: &Surface<'_>| -> Result<f64> {
        Ok(doubt * noise_level(surface, &Columns::from_points(&surface.positions)?, 1)?)
    };
    let on_level = |depth: usize| -> Result<SegmentOptions> {
        let level = &levels[depth - 1].mesh;
        let share = |count: usize| {
            let n = count as f64 * level.connectivity().n_faces() as f64;
            (n / mesh.connectivity().n_faces() as f64).round() as usize
        };
        let of_level = |weights: &Vec<Vec<f64>>| memory::twin(&weights[depth - 1]);
        Ok(SegmentOptions {
            face_weights: weights.as_ref().map(of_level).transpose()?,
            min_faces: options.min_faces.map(share),
            scale: Scale::Length(unit),
            noise: None,
            levels: Levels::Never,
            ..options.without_arrays()
        })
    };
    let mut coarsest_options = on_level(levels.len())?;
    if options.noise.is_some() {
        let (mesh, points) = (&coarsest.mesh, coarsest.mesh.positions().ok_or(MeshError::NoPositions)?);
        let surface = Surface::new(mesh.connectivity(), points, unit, coarsest_options.edge_costs(mesh)?)?;
        coarsest_options.noise = Some(unit * noise_on(&surface)?);
    }
    let found = segment(&coarsest.mesh, &coarsest_options)?;
    let mut carried = Carried::of(&found)?;
    for depth in (1..levels.len()).rev() {
        let finer = &levels[depth - 1].mesh;
        carried.go_to(finer, &levels[depth])?;
        let options = on_level(depth)?;
        let points = finer.positions().ok_or(MeshError::NoPositions)?;
        let surface = Surface::new(finer.connectivity(), points, unit, options.edge_costs(finer)?)?;
        let start = Columns::from_points(&surface.positions)?;
        let noise = noise_on(&surface)?;
        let mut labels = memory::twin(&carried.labels)?;
        carried.passes(&surface, &start, noise, &options, progress).refine(&mut labels)?;
        carried.labels = labels;
    }
    carried.go_to(mesh, &levels[0])?;
    let start = Columns::from_points(&surface.positions)?;
    let passes = carried.passes(surface, &start, noise, options, progress);
    let mut labels = memory::twin(&carried.labels)?;
    passes.refine(&mut labels)?;
    carried.name(&found, &mut labels);
    let leaves = carried.leaves_within(surface, &found, &labels)?;
    let any = some_faces(&memory::gathered(found.labels.iter().map(|label| label.cast_unsigned()))?);
    let merges = passes.settled(&mut labels)?;
    let joined = merges.iter().map(|m| ([m.kept, m.gone].map(|label| any[&label]), m.strength));
    let hierarchy = found.hierarchy.joined(found.n_segments, joined)?.picked(&leaves)?.ascending();
    let n_segments = contiguous(&labels)?.1;
    let labels = hierarchy.labels_at(n_segments)?;
    Ok(Some(Segmentation {
        boundary_edges: boundary_edges(mesh, &labels)?,
        labels,
        n_segments,
        indicator: carried.indicator,
        values: Columns::from_points(&carried.points)?,
        hierarchy,
        noise: noise * unit,
        ..found
    }))
}

/// What a level leaves to the finer one.
struct Carried {
    labels: Vec<u32>,
    /// For each face one of the coarsest level that has the same segment in the finest segmentation there.
    leaves: Vec<u32>,
    indicator: Vec<f64>,
    /// The shape with borders sharpened.
    points: Vec<Point>,
}

impl Carried {
    fn of(found: &Segmentation) -> Result<Self> {
        Ok(Self {
            labels: memory::gathered(found.labels.iter().map(|label| label.cast_unsigned()))?,
            leaves: found.hierarchy.first_faces()?,
            indicator: memory::twin(&found.indicator)?,
            points: found.values.to_points()?,
        })
    }

    /// The same on the finer mesh below `level`.
    fn go_to(&mut self, finer: &Mesh, level: &Level) -> Result<()> {
        let faces = level.carry.faces(finer, &level.mesh)?;
        // Nothing is held, so that every face has its place.
        let at = |f: &Option<u32>| f.map_or(0, |f| f as usize);
        self.labels = memory::gathered(faces.iter().map(|f| self.labels[at(f)]))?;
        self.leaves = memory::gathered(faces.iter().map(|f| self.leaves[at(f)]))?;
        self.indicator = memory::gathered(faces.iter().map(|f| self.indicator[at(f)]))?;
        self.points = level.carry.points(&self.points, [0.0; 3])?;
        Ok(())
    }

    /// Names segments that were refined after those of the coarsest level, as which they were `found`: each
    /// after that which most of its faces came from.
    fn name(&self, found: &Segmentation, labels: &mut [u32]) {
        let mut counts: BTreeMap<u32, BTreeMap<u32, usize>> = BTreeMap::new();
        for (&label, &leaf) in labels.iter().zip(&self.leaves) {
            let home = found.labels[leaf as usize].cast_unsigned();
            *counts.entry(label).or_default().entry(home).or_default() += 1;
        }
        let most =
            |homes: &BTreeMap<u32, usize>| homes.iter().max_by_key(|(_, n)| **n).map(|(home, _)| *home);
        let names: BTreeMap<u32, u32> =
            counts.iter().filter_map(|(label, homes)| Some((*label, most(homes)?))).collect();
        labels.iter_mut().for_each(|label| *label = names[label]);
    }

    /// The finest segmentation within the segments `labels`, named as those that were `found`: a face whose
    /// own finest segment is elsewhere goes to the nearest one of its segment.
    fn leaves_within(&self, surface: &Surface<'_>, found: &Segmentation, labels: &[u32]) -> Result<Vec<u32>> {
        let homes = memory::gathered(found.labels.iter().map(|label| label.cast_unsigned()))?;
        let own = |(&leaf, &label): (&u32, &u32)| if homes[leaf as usize] == label { leaf } else { NONE };
        let mut leaves: Vec<u32> = memory::gathered(self.leaves.iter().zip(labels).map(own))?;
        let mut queue: Vec<usize> = memory::sifted((0..leaves.len()).filter(|&f| leaves[f] != NONE))?;
        let mut next = 0;
        while let Some(&f) = queue.get(next) {
            next += 1;
            for (_, g) in surface.around(f) {
                if leaves[g] == NONE && labels[g] == labels[f] {
                    leaves[g] = leaves[f];
                    memory::push(&mut queue, g)?;
                }
            }
        }
        let any = some_faces(&homes);
        leaves.iter_mut().zip(labels).filter(|(leaf, _)| **leaf == NONE).for_each(|(leaf, l)| *leaf = any[l]);
        Ok(leaves)
    }

    fn passes<'a>(
        &'a self,
        surface: &'a Surface<'a>,
        start: &'a Columns,
        noise: f64,
        options: &'a SegmentOptions,
        progress: &'a Progress,
    ) -> Passes<'a> {
        let indicator = &self.indicator;
        let (planes, regions, is_shape) = (None, None, true);
        Passes { surface, start, is_shape, noise, indicator, planes, regions, options, progress }
    }
}

/// A face of each segment.
fn some_faces(labels: &[u32]) -> BTreeMap<u32, u32> {
    (0_u32..).zip(labels).map(|(f, label)| (*label, f)).collect()
}
