//! Folds of a patch that already lies on its surfaces: faces that look backwards,
//! in a plane with their neighbors.

use super::constants::{UNTANGLE_PASSES, UNTANGLE_RINGS};
use super::meeting::{meeting_point, turned};
use super::parts::SmoothParts;
use super::region::Region;
use crate::mesh::vector::{add, scale, Point};

/// Moves vertices around faces that are turned away from their part to the mean of their neighbors, as in an
/// embedding with fixed surroundings, which has no folds (Tutte 1963), and back onto their surfaces. Nothing
/// changes if as many faces are turned after that.
pub(super) fn untangle(region: &mut Region, parts: &SmoothParts, labels: &[u32]) {
    let before = turned(region, parts, labels);
    if before.is_empty() {
        return;
    }
    let mut near: Vec<u32> = before.iter().filter_map(|&f| region.mesh.face(f)).flatten().collect();
    for _ in 0..UNTANGLE_RINGS {
        let more: Vec<u32> = near.iter().flat_map(|&v| region.mesh.neighbors(v)).collect();
        near.extend(more);
        near.sort_unstable();
        near.dedup();
    }
    near.retain(|&v| !region.is_anchor(v));
    let start: Vec<Point> = near.iter().map(|&v| region.mesh.position(v)).collect();
    for _ in 0..UNTANGLE_PASSES {
        for &v in &near {
            let around = region.mesh.neighbors(v);
            let share = 1.0 / around.len().max(1) as f64;
            let mean =
                around.iter().fold([0.0; 3], |sum, &w| add(sum, scale(region.mesh.position(w), share)));
            region.mesh.set_position(v, mean);
            let goal = meeting_point(region, parts, labels, v);
            region.mesh.set_position(v, goal);
        }
    }
    if turned(region, parts, labels).len() >= before.len() {
        near.iter().zip(start).for_each(|(&v, p)| region.mesh.set_position(v, p));
    }
}
