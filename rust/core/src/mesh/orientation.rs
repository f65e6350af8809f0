//! Making neighboring faces agree on which side is outside.

use std::collections::VecDeque;

use crate::mesh::{Connectivity, EdgeKind};
use crate::{memory, Result};

/// For every face whether it is turned against the faces around it,
/// so that turning these over makes neighbors agree.
///
/// Within each edge-connected component the smaller number of faces counts as turned, of two equal numbers
/// those that do not agree with its first face. Across edges with three faces or more nothing is compared. On
/// a surface with one side only, as a Möbius strip, some neighbors disagree after that as before.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub fn flipped_faces(connectivity: &Connectivity) -> Result<Vec<bool>> {
    let mut flipped = memory::repeated(false, connectivity.n_faces())?;
    if !connectivity.has_any(&[EdgeKind::Inconsistent]) {
        return Ok(flipped);
    }
    let mut seen = memory::repeated(false, connectivity.n_faces())?;
    let mut component = Vec::new();
    for seed in 0..connectivity.n_faces() {
        if std::mem::replace(&mut seen[seed], true) {
            continue;
        }
        component.clear();
        memory::push(&mut component, seed)?;
        // Across edges where faces disagree only when no other way is left:
        // so few are turned on surfaces with one side.
        let mut disagreeing = VecDeque::new();
        let mut next = 0;
        loop {
            while let Some(&f) = component.get(next) {
                next += 1;
                for h in 3 * f..3 * f + 3 {
                    let Some(mate) = connectivity.mate(h) else { continue };
                    if connectivity.kind(h) == EdgeKind::Inconsistent {
                        memory::push_back(&mut disagreeing, [f, mate / 3])?;
                    } else if !std::mem::replace(&mut seen[mate / 3], true) {
                        flipped[mate / 3] = flipped[f];
                        memory::push(&mut component, mate / 3)?;
                    }
                }
            }
            let Some([f, g]) = disagreeing.pop_front() else { break };
            if !std::mem::replace(&mut seen[g], true) {
                flipped[g] = !flipped[f];
                memory::push(&mut component, g)?;
            }
        }
        if 2 * component.iter().filter(|&&f| flipped[f]).count() > component.len() {
            component.iter().for_each(|&f| flipped[f] = !flipped[f]);
        }
    }
    Ok(flipped)
}

/// The faces with those turned over that [`flipped_faces`] names, their first corner kept,
/// and which these are.
///
/// # Errors
/// Those of [`Connectivity::new`].
pub fn orient(faces: Vec<[u32; 3]>, n_vertices: usize) -> Result<(Vec<[u32; 3]>, Vec<bool>)> {
    let connectivity = Connectivity::new(faces, n_vertices)?;
    let flipped = flipped_faces(&connectivity)?;
    Ok((turned_over(connectivity.faces(), &flipped)?, flipped))
}

/// The faces, those of `flipped` with their last two corners swapped: halfedges 1 and 2 change places.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(crate) fn turned_over(faces: &[[u32; 3]], flipped: &[bool]) -> Result<Vec<[u32; 3]>> {
    let turned =
        faces.iter().zip(flipped).map(|(&[a, b, c], &flip)| if flip { [a, c, b] } else { [a, b, c] });
    Ok(memory::gathered(turned)?)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::shapes::{self, Random};

    fn turned(faces: &[[u32; 3]], share: f64, seed: u64) -> (Vec<[u32; 3]>, Vec<bool>) {
        let mut random = Random::new(seed);
        let flip: Vec<bool> = faces.iter().map(|_| random.uniform() < share).collect();
        (turned_over(faces, &flip).unwrap(), flip)
    }

    #[test]
    fn faces_turned_at_random_are_found_one_by_one() {
        for (shape, share) in
            [(shapes::cube(5), 0.1), (shapes::torus(9, 7, 2.0, 0.5), 0.4), (shapes::grid(8, 6), 0.3)]
        {
            let (faces, flip) = turned(&shape.faces, share, 3);
            let (oriented, flipped) = orient(faces, shape.vertices.len()).unwrap();
            assert_eq!(flipped, flip);
            assert_eq!(oriented, shape.faces);
        }
    }

    #[test]
    fn components_are_judged_by_themselves_and_agreement_is_left_alone() {
        let pair = shapes::cube(2).and(&shapes::icosphere(1));
        let inside_out: Vec<[u32; 3]> = pair.faces.iter().map(|&[a, b, c]| [a, c, b]).collect();
        assert_eq!(orient(inside_out.clone(), pair.vertices.len()).unwrap().0, inside_out);
        let mut faces = pair.faces.clone();
        faces[60].swap(1, 2);
        let (oriented, flipped) = orient(faces, pair.vertices.len()).unwrap();
        assert_eq!(oriented, pair.faces);
        assert_eq!(flipped.iter().filter(|&&f| f).count(), 1);
    }

    #[test]
    fn a_moebius_strip_disagrees_somewhere_however_it_is_turned() {
        // Five vertices, five triangles, each neighbor of the next.
        let faces: Vec<[u32; 3]> = (0..5).map(|i| [i, (i + 1) % 5, (i + 2) % 5]).collect();
        let (oriented, _) = orient(faces, 5).unwrap();
        assert!(Connectivity::new(oriented, 5).unwrap().has_any(&[EdgeKind::Inconsistent]));
    }
}
