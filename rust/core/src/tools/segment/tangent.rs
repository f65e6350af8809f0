//! The order in which faces that no bend parts become one: those first that together look most to one side.
//!
//! Where fillets are tangent to what they join, the bend at borders says nothing. So faces merge by what that
//! adds to the variance of their normals (Ward 1963, as Garland et al. 2001 do with facets): a fillet goes
//! with the larger side beside it, and as many segments as a shape has sides are these sides with their
//! fillets.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

use super::merge::Merge;
use super::surface::Surface;
use crate::mesh::vector::{add, dot, scale, sub, Point};
use crate::ordered::Ordered;
use crate::{memory, Result};

/// The area and the sum of the vector areas of a segment.
type Normals = (f64, Point);

/// What it adds to the variance of the normals of two segments, times their area, if they are one.
fn cost(a: Normals, b: Normals) -> f64 {
    if a.0 <= 0.0 || b.0 <= 0.0 {
        return 0.0;
    }
    let apart = sub(scale(a.1, 1.0 / a.0), scale(b.1, 1.0 / b.0));
    a.0 * b.0 / (a.0 + b.0) * dot(apart, apart)
}

/// Merges segments that touch and that `may` be one until none do, in the order of what that costs, and
/// names them so. What is kept of two may be one with what either might.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(super) fn merged(
    surface: &Surface<'_>,
    labels: &mut [u32],
    may: impl Fn(u32, u32) -> bool,
) -> Result<Vec<Merge>> {
    let mut normals: BTreeMap<u32, Normals> = BTreeMap::new();
    let mut around: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for (f, &label) in labels.iter().enumerate() {
        let (area, sum) = normals.entry(label).or_insert((0.0, [0.0; 3]));
        *area += surface.areas[f];
        *sum = add(*sum, surface.vector_area(f));
        for (_, g) in surface.around(f).filter(|&(_, g)| labels[g] != label && may(labels[g], label)) {
            around.entry(label).or_default().insert(labels[g]);
        }
    }
    let mut heap = BinaryHeap::new();
    let offer = |heap: &mut BinaryHeap<_>, normals: &BTreeMap<u32, Normals>, a: u32, b: u32| {
        memory::extend_heap(heap, 1)?;
        heap.push(Reverse((Ordered(cost(normals[&a], normals[&b])), [a.min(b), a.max(b)])));
        Ok::<(), crate::Error>(())
    };
    for (&a, others) in &around {
        for &b in others.iter().filter(|&&b| a < b) {
            offer(&mut heap, &normals, a, b)?;
        }
    }
    let mut merges = Vec::new();
    while let Some(Reverse((Ordered(strength), [a, b]))) = heap.pop() {
        // Segments that are gone, or have grown since.
        let is_current = |label: &u32| normals.contains_key(label);
        if ![a, b].iter().all(is_current) || Ordered(cost(normals[&a], normals[&b])) != Ordered(strength) {
            continue;
        }
        let (kept, gone) = if normals[&a].0 >= normals[&b].0 { (a, b) } else { (b, a) };
        let Some(joined) = normals.remove(&gone) else { continue };
        normals.entry(kept).and_modify(|(area, sum)| (*area, *sum) = (*area + joined.0, add(*sum, joined.1)));
        let others = around.remove(&gone).unwrap_or_default();
        for &third in others.iter().filter(|&&third| third != kept) {
            around.entry(third).or_default().extend([kept]);
            around.entry(kept).or_default().insert(third);
        }
        for other in &others {
            around.entry(*other).or_default().remove(&gone);
        }
        for &third in around.get(&kept).into_iter().flatten() {
            offer(&mut heap, &normals, kept, third)?;
        }
        memory::push(&mut merges, Merge { kept, gone, strength: strength.sqrt() })?;
    }
    super::merge::rename(labels, &merges);
    Ok(merges)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::shapes::grid;

    #[test]
    fn a_fillet_goes_with_a_side_before_sides_become_one() {
        // Two sides, four and three squares long, and a quarter of a circle of three squares between them.
        let shape = grid(10, 2).map(|[x, y, _]| {
            let (turn, radius) =
                ((x - 4.0).clamp(0.0, 3.0) / 3.0 * std::f64::consts::FRAC_PI_2, 6.0 / std::f64::consts::PI);
            let (over, up) = ((x - 7.0).max(0.0), x.min(4.0));
            [up + radius * turn.sin(), y, -radius * (1.0 - turn.cos()) - over]
        });
        let mesh = shape.mesh().unwrap();
        let (connectivity, positions) = (mesh.connectivity(), mesh.positions().unwrap());
        let costs = vec![[1.0; 3]; connectivity.n_faces()];
        let surface = Surface::new(connectivity, positions, 1.0, costs).unwrap();
        let along = |f: usize| surface.connectivity.faces()[f].iter().min().unwrap() % 11;
        let mut labels: Vec<u32> = (0..surface.n_faces())
            .map(|f| match along(f) {
                0..4 => 0,
                4..7 => 1,
                _ => 2,
            })
            .collect();
        let merges = merged(&surface, &mut labels, |_, _| true).unwrap();
        assert_eq!(merges.len(), 2);
        assert_eq!((merges[0].kept, merges[0].gone), (2, 1));
        assert!(merges[0].strength < merges[1].strength);
        assert!(labels.iter().all(|label| *label == labels[0]));
    }
}
