//! Whether a mesh consists of its planes, as what was modeled by hand does.

use super::constants::{FLAT, ROUND};
use super::faces::Scan;
use super::hierarchy::Hierarchy;
use super::job::Job;
use super::merging::Merges;
use super::moments::Plane;
use super::regions::OUTSIDE;
use crate::mesh::partition::{contiguous, Partition};
use crate::mesh::vector::{area_vector, dot, unit, Point};
use crate::{memory, Result};

impl Job<'_> {
    /// How many planes the mesh has, if it consists of them: if most are evident, since three of their
    /// vertices lie on no more than three of them, so that planes say where these are, and with most of
    /// their neighbors they make a sharp edge. That is no chance, as it is where every face has a plane of
    /// its own, or every quad of a round shape, and no round shape in many sides.
    pub(super) fn evident_planes(&self, merges: &Merges, scan: &Scan) -> Result<Option<usize>> {
        let n = self.parts.len();
        let planes = merges.planes(n, scan.area.max(f64::MIN_POSITIVE));
        let (tree, cut) = Hierarchy::new(merges, n, n - planes)?;
        let (labels, tops) = tree.labels(&cut)?;
        Ok(self.are_evident(&labels, tops.len(), scan)?.then_some(planes))
    }

    /// Whether the mesh consists of its planes, as above, which are found by what their faces share:
    /// neighbors are of one plane if the smaller one is on the plane of the larger one.
    pub(super) fn is_modeled(&self, scan: &Scan) -> Result<bool> {
        let mesh = self.working.mesh();
        let connectivity = mesh.connectivity();
        let mut part_of = memory::repeated(OUTSIDE, connectivity.n_faces())?;
        (0..).zip(&self.parts).for_each(|(part, &f)| part_of[f as usize] = part);
        let mut joined = Partition::new(self.parts.len())?;
        for (part, &f) in (0_u32..).zip(&self.parts) {
            for h in 3 * f as usize..3 * f as usize + 3 {
                let Some(other) = connectivity.mate(h).map(|mate| part_of[mate / 3]) else { continue };
                if other <= part || other == OUTSIDE {
                    continue;
                }
                let areas = [part, other].map(|part| scan.moments[part as usize].area);
                let [small, large] = if areas[0] < areas[1] { [part, other] } else { [other, part] };
                let [corners, on] = [small, large].map(|part| scan.places[part as usize]);
                let plane = Plane::through(on[0], unit(area_vector(on)));
                if corners.iter().all(|&p| plane.height(p).abs() <= FLAT) {
                    joined.unite(part, other);
                }
            }
        }
        let roots = memory::gathered((0..self.parts.len() as u32).map(|part| joined.root(part)))?;
        let (labels, n_planes) = contiguous(&roots)?;
        self.are_evident(&labels, n_planes, scan)
    }

    /// Whether most of `n_planes` planes are evident, which the parts of each label are.
    fn are_evident(&self, labels: &[u32], n_planes: usize, scan: &Scan) -> Result<bool> {
        let connectivity = self.working.mesh().connectivity();
        let free = || self.parts.iter().zip(labels).zip(&self.is_held).filter(|(_, &held)| !held);
        let corners =
            free().flat_map(|((&f, &label), _)| connectivity.faces()[f as usize].map(|v| (v, label)));
        let mut at: Vec<(u32, u32)> = memory::sifted(corners)?;
        at.sort_unstable();
        at.dedup();
        let mut n_known = memory::repeated(0_usize, n_planes)?;
        for of_vertex in at.chunk_by(|a, b| a.0 == b.0).filter(|of_vertex| of_vertex.len() <= 3) {
            of_vertex.iter().for_each(|&(_, label)| n_known[label as usize] += 1);
        }
        let of_all = self.labels(labels.iter().copied())?;
        let beside = |h: usize| connectivity.mate(h).map_or(OUTSIDE, |mate| of_all[mate / 3]);
        let sides = free().flat_map(|((&f, &label), _)| (0..3).map(move |i| (label, 3 * f as usize + i)));
        let sides = sides.map(|(label, h)| (label, beside(h))).filter(|(label, other)| label != other);
        let mut neighbors: Vec<(u32, u32)> = memory::sifted(sides)?;
        neighbors.sort_unstable();
        neighbors.dedup();
        let sums = scan.sums(labels, n_planes)?;
        let normals: Vec<Point> = memory::gathered(sums.iter().map(|sum| sum.fit().plane.normal))?;
        let mut n_sharp = memory::repeated(0_isize, n_planes)?;
        for &(label, other) in &neighbors {
            let turn = normals.get(other as usize).map(|normal| dot(*normal, normals[label as usize]));
            n_sharp[label as usize] += if turn.is_none_or(|cosine| cosine < ROUND.cos()) { 1 } else { -1 };
        }
        let evident = n_known.iter().zip(&n_sharp).filter(|(&known, &sharp)| known >= 3 && sharp > 0);
        Ok(2 * evident.count() > n_planes)
    }
}
