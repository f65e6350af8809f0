//! Patches in which the parts around a hole go on until they meet: planes and gently bent surfaces,
//! joined in their ridges.

use super::assign::{assign, borders, parts_at};
use super::constants::{
    CLOSE_CORNERS, COARSE_FACES, CUTS, EXTENDING, RESAMPLE_ROUNDS, SETTLE_PASSES, UNTANGLE_FROM,
};
use super::flips::flip_along_ridges;
use super::guard::move_guarded;
use super::meeting::{has_arrived, meeting_point, order};
use super::parts::SmoothParts;
use super::region::Region;
use super::resample::{resample, typical_edge, Kept, Target};
use super::untangle::untangle;
use crate::memory;
use crate::mesh::vector::{between, centroid, distance};
use crate::progress::Progress;
use crate::remesh::split::LONG;
use crate::shape_guard::{farthest, SLIVER};
use crate::{Error, Result};

/// How letting the parts go on ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Extended {
    /// They do not say how the surface goes on, or do not meet.
    NotMet,
    /// They meet, and all are planes.
    Planes,
    /// They meet, and some are bent.
    Bent,
}

/// Lets the parts around the patch go on in it until they meet.
pub(super) fn extend(
    region: &mut Region,
    parts: &SmoothParts,
    edge_length: Option<f64>,
    progress: &Progress,
) -> Result<Extended> {
    let edge = typical_edge(&region.mesh)?;
    let target = Target { edge_length, max_faces: COARSE_FACES, rounds: RESAMPLE_ROUNDS };
    let mut labels = Vec::new();
    for round in 0..EXTENDING.steps {
        progress.check()?;
        if round > 0 {
            let borders = borders(region, parts, &labels)?;
            let kept = Kept {
                borders: &borders,
                merges: &merges(region, parts, &labels, edge)?,
                ridge: std::f64::consts::PI,
            };
            resample(region, &kept, &target, progress)?;
        }
        labels = assign(region, parts, edge)?;
        for _ in 0..CUTS {
            if !cut(region, parts, &mut labels, edge)? {
                break;
            }
            labels = assign(region, parts, edge)?;
        }
        let mut moved = settle(region, parts, &labels)?;
        if flip_along_ridges(region)? > 0 {
            labels = assign(region, parts, edge)?;
            moved = moved.max(settle(region, parts, &labels)?);
        }
        if round >= UNTANGLE_FROM {
            untangle(region, parts, &labels);
        }
        if moved < EXTENDING.rest * edge && has_arrived(region, parts, &labels, edge) {
            break;
        }
    }
    Ok(match has_arrived(region, parts, &labels, edge) {
        false => Extended::NotMet,
        true if parts.models.iter().all(|model| model.is_flat) => Extended::Planes,
        true => Extended::Bent,
    })
}

/// Cuts triangles that cannot lie on their part whatever their free vertices do, because they have none or
/// because all their vertices are where the part meets another one; and long borders that have no free
/// vertex. Returns whether anything was cut.
fn cut(region: &mut Region, parts: &SmoothParts, labels: &mut Vec<u32>, edge: f64) -> Result<bool> {
    let first = region.n_outer as u32;
    let before = labels.len();
    let is_off = |region: &Region, v: u32, part: u32| {
        region.is_anchor(v)
            && !parts.at(region, v).contains(&part)
            && !parts.has(part, region.mesh.position(v), edge)
    };
    let split = |region: &mut Region, labels: &mut Vec<u32>, a: u32, b: u32| {
        let Some(wings) = region.mesh.wings(a, b).filter(|w| w.faces.iter().all(|&f| region.is_patch(f)))
        else {
            return Ok(());
        };
        let middle = between(region.mesh.position(a), region.mesh.position(b), 0.5);
        if region.mesh.split(a, b, middle)?.is_some() {
            memory::extend(labels, 2)?;
            wings.faces.iter().for_each(|&f| labels.push(labels[(f - first) as usize]));
        }
        Ok::<(), Error>(())
    };
    for f in first..first + before as u32 {
        let Some(face) = region.mesh.face(f) else { continue };
        let part = labels[(f - first) as usize];
        let off = face.map(|v| is_off(region, v, part));
        let on = [0, 1, 2].map(|i| region.is_anchor(face[i]) && !off[i]);
        if let Some(i) = (0..3).find(|&i| off[i] && on[(i + 1) % 3] || on[i] && off[(i + 1) % 3]) {
            let [a, b] = [face[i], face[(i + 1) % 3]];
            let shared = parts.at(region, a).iter().any(|part| parts.at(region, b).contains(part));
            if !shared {
                split(region, labels, a, b)?;
                continue;
            }
        }
        let is_stiff = off.contains(&true) && face.iter().all(|&v| region.is_anchor(v));
        if is_stiff && region.mesh.split_face(f, centroid(region.mesh.corners(face)))?.is_some() {
            memory::extend(labels, 2)?;
            labels.extend([part; 2]);
        }
    }
    for [a, b] in region.mesh.edges()? {
        let Some(wings) = region.mesh.wings(a, b) else { continue };
        if !wings.faces.iter().all(|&f| region.is_patch(f)) {
            continue;
        }
        let [own, other] = wings.faces.map(|f| labels[(f - first) as usize]);
        let ends = [a, b].map(|v| parts_at(region, parts, labels, v));
        let is_chord = own == other && ends[0].iter().any(|part| *part != own && ends[1].contains(part));
        let is_stiff =
            own != other && [a, b].iter().all(|&v| region.is_anchor(v)) && length(region, a, b) > LONG * edge;
        if is_chord || is_stiff {
            split(region, labels, a, b)?;
        }
    }
    Ok(labels.len() > before)
}

/// Free vertices that belong where a neighbor is, and that neighbor:
/// remeshing does not join two vertices that are both fixed. Where more than three parts meet in a point,
/// as two ridges that cross, the corners of three of them each are one.
fn merges(region: &Region, parts: &SmoothParts, labels: &[u32], edge: f64) -> Result<Vec<[u32; 2]>> {
    let found = |v: u32| {
        let own = parts_at(region, parts, labels, v);
        let joins = |w: u32| {
            length(region, v, w) < CLOSE_CORNERS * edge
                && if region.is_anchor(w) {
                    own.len() > 1 && own.iter().all(|&part| parts.has(part, region.mesh.position(w), edge))
                } else {
                    let others = parts_at(region, parts, labels, w);
                    let is_there = |part: &u32| parts.has(*part, region.mesh.position(w), edge);
                    w < v
                        && own.len().min(others.len()) > 2
                        && (own == others || own.iter().chain(&others).all(is_there))
                }
        };
        region.mesh.neighbors(v).into_iter().find(|&w| joins(w))
    };
    Ok(memory::sifted(region.free().filter_map(|v| Some([v, found(v)?])))?)
}

fn length(region: &Region, a: u32, b: u32) -> f64 {
    distance(region.mesh.position(a), region.mesh.position(b))
}

/// Moves free vertices where the surfaces of the parts that meet at them meet, the nearest first, as far as
/// that leaves the faces around them in order; returns the longest move.
///
/// First all together, which finds its way where the patch is far from its surfaces, then one by one.
fn settle(region: &mut Region, parts: &SmoothParts, labels: &[u32]) -> Result<f64> {
    let goal = |v: u32| {
        if region.is_anchor(v) {
            region.mesh.position(v)
        } else {
            meeting_point(region, parts, labels, v)
        }
    };
    let goals = memory::sifted((0..region.mesh.n_vertices() as u32).map(goal))?;
    let mut longest = move_guarded(region, &goals)?;
    for _ in 0..SETTLE_PASSES {
        let mut moves = memory::sifted(region.free().map(|v| {
            let (at, goal) = (region.mesh.position(v), meeting_point(region, parts, labels, v));
            (distance(at, goal), v, goal)
        }))?;
        moves.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        for (_, v, goal) in moves {
            let start = region.mesh.position(v);
            let before = order(region, parts, labels, v).min(SLIVER);
            let reached = farthest(start, goal, |position| {
                region.mesh.set_position(v, position);
                order(region, parts, labels, v) >= before
            });
            region.mesh.set_position(v, reached.unwrap_or(start));
            longest = longest.max(reached.map_or(0.0, |position| distance(start, position)));
        }
    }
    Ok(longest)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::region::tests::around_hole;
    use super::super::start::smooth;
    use super::*;
    use crate::mesh::vector::{norm, quality, scale, Point};
    use crate::operators::Energy;
    use crate::shapes::{self, Shape};

    /// The region of a hole after its smooth start and the extension, and what this said.
    fn extended(shape: &Shape, place: Point, radius: f64) -> (Region, Extended) {
        let mut region = around_hole(shape, place, radius);
        smooth(&mut region, Energy::L2Laplacian, 3, &Progress::new()).unwrap();
        let edge = typical_edge(&region.mesh).unwrap();
        let parts = SmoothParts::between_ridges(&region, 0.9, edge).unwrap();
        let found = parts
            .map_or(Extended::NotMet, |parts| extend(&mut region, &parts, None, &Progress::new()).unwrap());
        (region, found)
    }

    fn nearest(region: &Region, place: Point) -> f64 {
        region.mesh.positions().iter().map(|&p| distance(p, place)).fold(f64::INFINITY, f64::min)
    }

    fn off_cube(p: Point) -> f64 {
        (p.iter().fold(0.0, |a: f64, x| a.max(x.abs())) - 1.0).abs()
    }

    #[test]
    fn a_cubes_edge_and_corner_are_exact() {
        for (n, place, radius) in
            [(12, [1.0, 1.0, 0.1], 0.5), (12, [1.0; 3], 0.29), (12, [1.0; 3], 0.6), (24, [1.0; 3], 0.5)]
        {
            let (region, found) = extended(&shapes::cube(n), place, radius);
            assert_eq!(found, Extended::Planes);
            for (f, face) in region.patch_faces() {
                let corners = region.mesh.corners(face);
                assert!(off_cube(centroid(corners)) < 1e-9, "face {f}: {corners:?}");
                assert!(quality(corners) > 0.1, "face {f}: {corners:?}");
            }
            assert!(place != [1.0; 3] || nearest(&region, place) < 1e-9);
        }
    }

    #[test]
    fn the_rim_of_a_cylinder_bends_on() {
        let shape = shapes::cylinder(48, 12, 1.0, 1.5);
        let bottom =
            shape.vertices.iter().zip(0..).filter(|(p, _)| p[2] == 0.0).map(|(_, v)| v).collect::<Vec<u32>>();
        let mut capped = shape.clone();
        // Rings toward the center, as wide as the edges of the rim.
        let mut ring = bottom.clone();
        for k in 1..7 {
            let next: Vec<u32> = (0..48).map(|i| capped.vertices.len() as u32 + i).collect();
            let shrunk: Vec<Point> = bottom
                .iter()
                .map(|&v| scale(shape.vertices[v as usize], 1.0 - 0.13 * f64::from(k)))
                .collect();
            capped.vertices.extend(shrunk);
            for i in 0..48 {
                let j = (i + 1) % 48;
                capped.faces.extend([[ring[j], ring[i], next[i]], [ring[j], next[i], next[j]]]);
            }
            ring = next;
        }
        let place = shape.vertices[bottom[5] as usize];
        let (region, found) = extended(&capped, place, 0.35);
        assert_eq!(found, Extended::Bent);
        for (f, face) in region.patch_faces() {
            let p = centroid(region.mesh.corners(face));
            let (radius, z) = (p[0].hypot(p[1]), p[2]);
            assert!(z.abs() < 0.02 || (radius - 1.0).abs() < 0.02, "face {f}: {p:?}");
        }
    }

    #[test]
    fn a_smooth_surface_is_one_part_that_goes_on_smoothly() {
        let (region, found) = extended(&shapes::icosphere(3), [0.0, 0.0, 1.0], 0.4);
        assert_eq!(found, Extended::Bent);
        let off = |v: u32| (norm(region.mesh.position(v)) - 1.0).abs();
        // A quadratic over five rings is no sphere (0.052 at its top), but a flat patch would be off by 0.08.
        let worst = region.free().map(off).fold(0.0, f64::max);
        assert!(worst < 0.06, "{worst}");
    }
}
