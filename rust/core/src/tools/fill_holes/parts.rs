//! The smooth parts that the surface around a hole falls into along its ridges,
//! each with the surface that it goes on as.

use super::constants::{AS_GOOD, FLAT, NEAR_PART, PART_WIDTH, WORST_FIT};
use super::model::Model;
use super::region::Region;
use super::surface::FaceGeometry;
use crate::memory;
use crate::mesh::partition::Partition;
use crate::mesh::vector::{add, norm, scale, unit, Point};
use crate::mesh::Mesh;
use crate::progress::Progress;
use crate::tools::options::Levels;
use crate::tools::segment::{segment, Fillets, SegmentOptions};
use crate::tools::SolveOptions;
use crate::Result;

/// No part.
pub(super) const NONE: u32 = u32::MAX;

/// The parts that reach a hole.
pub(super) struct SmoothParts {
    /// The part of every face around the patch; [`NONE`] if it does not reach the hole.
    pub of_face: Vec<u32>,
    /// What each goes on as.
    pub models: Vec<Model>,
}

impl SmoothParts {
    /// The parts around the patch of `region`, between edges bent by more than `ridge` radians. Nothing if a
    /// ridge at the hole has the same part on both sides, or a part is not smooth enough: then they do not
    /// say how the surface goes on.
    pub(super) fn between_ridges(region: &Region, ridge: f64, edge: f64) -> Result<Option<Self>> {
        let mesh = &region.mesh;
        let surface = FaceGeometry::of(region)?;
        let on_rim = on_rim(region)?;
        let mut pieces = Partition::new(region.n_outer)?;
        let mut ridges = Vec::new();
        for [a, b] in mesh.edges()? {
            let Some(wings) = mesh.wings(a, b) else { continue };
            let [f, g] = wings.faces;
            if region.is_patch(f) || region.is_patch(g) {
                continue;
            }
            if surface.dihedral([f, g]) <= ridge {
                pieces.unite(f, g);
            } else if on_rim[a as usize] || on_rim[b as usize] {
                memory::push(&mut ridges, [f, g])?;
            }
        }
        let roots = memory::sifted((0..region.n_outer as u32).map(|f| pieces.root(f)))?;
        if ridges.iter().any(|&[f, g]| roots[f as usize] == roots[g as usize]) {
            return Ok(None);
        }
        Self::of_pieces(region, &surface, &on_rim, &roots, edge)
    }

    /// The parts that the surroundings of the patch are segments of ([`mod@crate::tools::segment`]): these
    /// are found where noise bends edges as much as ridges do. Nothing where only one reaches the hole, or
    /// where one is off its surface by more than noise explains.
    pub(super) fn segments(
        region: &Region,
        solve: &SolveOptions,
        edge: f64,
        progress: &Progress,
    ) -> Result<Option<Self>> {
        let points = memory::gathered(region.mesh.positions()[..region.anchors.len()].iter().copied())?;
        let around = region.mesh.faces().take(region.n_outer).map(|(_, face)| face);
        let mesh = Mesh::new(points, memory::sifted(around)?)?;
        let options = SegmentOptions {
            levels: Levels::Never,
            solve: solve.within().on_residuals(),
            fillets: Fillets::Unseen,
            ..SegmentOptions::default()
        };
        let found = segment(&mesh, None, &options, &progress.quiet())?;
        let pieces =
            memory::gathered(found.labels.iter().map(|&label| u32::try_from(label).unwrap_or(NONE)))?;
        let parts = Self::of_pieces(region, &FaceGeometry::of(region)?, &on_rim(region)?, &pieces, edge)?;
        let sure = (FLAT * edge).max(AS_GOOD * found.noise);
        let is_sure = |parts: &Self| parts.models.iter().all(|model| model.misfit <= sure);
        Ok(parts.filter(|parts| parts.models.len() > 1 && is_sure(parts)))
    }

    /// Those of the pieces of the faces around the patch that reach it.
    fn of_pieces(
        region: &Region,
        surface: &FaceGeometry,
        on_rim: &[bool],
        pieces: &[u32],
        edge: f64,
    ) -> Result<Option<Self>> {
        let mut reached = Vec::new();
        for [a, b] in region.mesh.edges()? {
            let Some(wings) = region.mesh.wings(a, b) else { continue };
            let [f, g] = wings.faces;
            match [f, g].map(|f| region.is_patch(f)) {
                [true, false] => memory::push(&mut reached, pieces[g as usize])?,
                [false, true] => memory::push(&mut reached, pieces[f as usize])?,
                _ => {}
            }
        }
        reached.sort_unstable();
        reached.dedup();
        reached.retain(|&piece| piece != NONE);
        let part_of = |piece: &u32| reached.binary_search(piece).map_or(NONE, |part| part as u32);
        let of_face = memory::gathered(pieces.iter().map(part_of))?;
        let rings = rings(region, on_rim)?;
        let models =
            (0..reached.len() as u32).map(|part| model(region, surface, &of_face, &rings, part, edge));
        let models = models.collect::<Result<Option<Vec<_>>>>()?;
        Ok(models.map(|models| Self { of_face, models }))
    }

    /// Whether `p` lies on the surface that `part` goes on as.
    pub(super) fn has(&self, part: u32, p: Point, edge: f64) -> bool {
        let model = &self.models[part as usize];
        model.at(p).0.abs() < NEAR_PART * edge + 3.0 * model.misfit
    }

    /// The parts of the faces around the patch that `v` has.
    pub(super) fn at(&self, region: &Region, v: u32) -> Vec<u32> {
        let outer = region.mesh.faces_of(v).iter().filter_map(|&f| self.of_face.get(f as usize));
        outer.copied().filter(|&part| part != NONE).collect()
    }
}

/// Which vertices the patch has.
fn on_rim(region: &Region) -> Result<Vec<bool>> {
    let mut on_rim = memory::repeated(false, region.mesh.n_vertices())?;
    region.patch_faces().for_each(|(_, face)| face.into_iter().for_each(|v| on_rim[v as usize] = true));
    Ok(on_rim)
}

/// The number of edges between every vertex and the hole.
fn rings(region: &Region, on_rim: &[bool]) -> Result<Vec<u32>> {
    let mut rings = memory::gathered(on_rim.iter().map(|&at| if at { 0 } else { u32::MAX }))?;
    let mut front = memory::sifted((0..rings.len() as u32).filter(|&v| on_rim[v as usize]))?;
    let mut ring = 0;
    while !front.is_empty() {
        ring += 1;
        let mut next = Vec::new();
        for w in front.into_iter().flat_map(|v| region.mesh.neighbors(v)) {
            if rings[w as usize] == u32::MAX {
                rings[w as usize] = ring;
                memory::push(&mut next, w)?;
            }
        }
        front = next;
    }
    Ok(rings)
}

fn model(
    region: &Region,
    surface: &FaceGeometry,
    of_face: &[u32],
    rings: &[u32],
    part: u32,
    edge: f64,
) -> Result<Option<Model>> {
    let mut weights = memory::repeated(0.0, region.anchors.len())?;
    let mut normal = [0.0; 3];
    for (f, face) in region.mesh.faces().take(region.n_outer) {
        if of_face[f as usize] != part {
            continue;
        }
        for v in face {
            let away = f64::from(rings[v as usize]) / PART_WIDTH;
            let weight = surface.areas[f as usize] * (-0.5 * away * away).exp();
            weights[v as usize] += weight;
            normal = add(normal, scale(surface.normals[f as usize], weight));
        }
    }
    if norm(normal) <= 0.0 {
        return Ok(None);
    }
    let weighted = (0..).zip(weights).filter(|&(_, weight)| weight > 0.0);
    let points = memory::sifted(weighted.map(|(v, weight)| (region.mesh.position(v), weight)))?;
    Ok(Model::fit(&points, unit(normal), edge).filter(|model| model.misfit < WORST_FIT * edge))
}
