//! Segments that are noise on a neighbor: what the plane or the patch of a larger one explains is no part.

use std::collections::{BTreeMap, BTreeSet};

use super::constants::{EVIDENCE_TO_KEEP, LEAST_AROUND, SPECK_TOLERANCE};
use super::divide::log_likelihood_ratio;
use super::patches::{Patch, SegmentPlane};
use super::surface::{members, Surface};
use crate::mesh::partition::contiguous;
use crate::mesh::vector::{add, dot};
use crate::progress::Progress;
use crate::{memory, Result};

/// How much a neighbor explains.
pub(super) struct Explain<'a> {
    pub surface: &'a Surface<'a>,
    /// Standard deviation of the distances from a plane.
    pub deviation: f64,
    /// The most that the corners of faces of one plane are off it, root mean square.
    pub flat: f64,
    /// Segments of no more faces are specks, and may be part of a curved neighbor.
    pub most_faces: usize,
    /// Whether neighbors may be curved.
    pub curved: bool,
    /// Only faces of the same region may be of one segment, where given: a region for each face.
    pub regions: Option<&'a [u32]>,
    pub progress: &'a Progress,
}

/// The segments of a round.
struct Segments {
    members: Vec<Vec<u32>>,
    areas: Vec<f64>,
    planes: Vec<Option<SegmentPlane>>,
    /// The lengths of borders, by the labels on both sides of them.
    borders: BTreeMap<(u32, u32), f64>,
}

impl Explain<'_> {
    /// Gives segments to the larger neighbors that explain them, the smallest first.
    /// Labels are contiguous then.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub(super) fn run(&self, labels: &mut Vec<u32>) -> Result<()> {
        loop {
            self.progress.check()?;
            if self.progress.is_finishing() {
                *labels = contiguous(labels)?.0;
                return Ok(());
            }
            let segments = self.measured(labels)?;
            let count = segments.members.len();
            let mut order = memory::numbers(count)?;
            let area = |label: u32| segments.areas[label as usize];
            order.sort_unstable_by(|&a, &b| area(a).total_cmp(&area(b)).then(a.cmp(&b)));
            let mut names = memory::numbers(count)?;
            // Each segment takes part in one merge of a round, so that fits are still theirs.
            let mut busy = memory::repeated(false, count)?;
            for own in order {
                if busy[own as usize] {
                    continue;
                }
                if let Some(home) = self.home(labels, &segments, own).filter(|home| !busy[*home as usize]) {
                    names[own as usize] = home;
                    busy[own as usize] = true;
                    busy[home as usize] = true;
                }
            }
            if !busy.contains(&true) {
                return Ok(());
            }
            labels.iter_mut().for_each(|label| *label = names[*label as usize]);
        }
    }

    /// Renumbers the segments and measures them.
    fn measured(&self, labels: &mut Vec<u32>) -> Result<Segments> {
        let surface = self.surface;
        let members = members(labels)?;
        let area = |faces: &Vec<u32>| faces.iter().map(|&f| surface.areas[f as usize]).sum();
        let plane = |faces: &Vec<u32>| {
            SegmentPlane::through(surface, faces).filter(|plane| plane.spread <= self.flat)
        };
        let mut borders: BTreeMap<(u32, u32), f64> = BTreeMap::new();
        for f in 0..labels.len() {
            let may = |g: usize| self.regions.is_none_or(|regions| regions[g] == regions[f]);
            for (h, g) in surface.around(f).filter(|&(_, g)| labels[g] != labels[f] && may(g)) {
                *borders.entry((labels[f], labels[g])).or_default() += surface.lengths[f][h % 3];
            }
        }
        Ok(Segments {
            areas: memory::gathered(members.iter().map(area))?,
            planes: memory::gathered(members.iter().map(plane))?,
            members,
            borders,
        })
    }

    /// The larger neighbor that explains the segment `own`, that with the longest border of several.
    fn home(&self, labels: &[u32], segments: &Segments, own: u32) -> Option<u32> {
        let around: Vec<(u32, f64)> = segments
            .borders
            .range((own, 0)..=(own, u32::MAX))
            .map(|(&(_, to), &length)| (to, length))
            .collect();
        let (faces, area) = (&segments.members[own as usize], segments.areas[own as usize]);
        let is_small = faces.len() <= self.most_faces;
        let explains = |to: u32| match &segments.planes[to as usize] {
            Some(plane) => self.lies_on(plane, faces, area, around.len() == 1),
            None => self.curved && is_small && self.continues(labels, faces, to),
        };
        let larger = around.iter().filter(|(to, _)| segments.areas[*to as usize] >= area);
        let home = larger.filter(|(to, _)| explains(*to)).reduce(|a, b| if b.1 > a.1 { b } else { a });
        home.map(|(to, _)| *to)
    }

    /// Whether `faces` lie on the plane of a neighbor, on the side that it shows; if `enclosed` by it,
    /// on any.
    fn lies_on(&self, plane: &SegmentPlane, faces: &[u32], area: f64, enclosed: bool) -> bool {
        let surface = self.surface;
        let (mut vector, mut squares) = ([0.0; 3], 0.0);
        for &f in faces {
            vector = add(vector, surface.vector_area(f as usize));
            for v in surface.connectivity.faces()[f as usize] {
                squares +=
                    surface.areas[f as usize] / 3.0 * plane.distance(surface.positions[v as usize]).powi(2);
            }
        }
        let tolerance =
            if enclosed && faces.len() <= self.most_faces { SPECK_TOLERANCE * self.flat } else { self.flat };
        (enclosed || dot(vector, plane.normal()) > 0.0) && squares <= area * tolerance * tolerance
    }

    /// Whether `faces` and those of the segment `to` around them are one curved patch as well as they are
    /// two.
    fn continues(&self, labels: &[u32], faces: &[u32], to: u32) -> bool {
        let around = self.around(labels, faces, to);
        let joint: Vec<u32> = faces.iter().chain(&around).copied().collect();
        match [&joint, faces, &around].map(|faces| self.squares_off_patch(faces)) {
            [Some(one), Some(a), Some(b)] => {
                log_likelihood_ratio(one - a - b, self.deviation) < EVIDENCE_TO_KEEP
            }
            _ => true,
        }
    }

    /// The faces of the segment `to` nearest to `faces`, in rings.
    fn around(&self, labels: &[u32], faces: &[u32], to: u32) -> Vec<u32> {
        let mut seen: BTreeSet<u32> = faces.iter().copied().collect();
        let (mut around, mut ring) = (Vec::new(), faces.to_vec());
        while around.len() < faces.len().max(LEAST_AROUND) && !ring.is_empty() {
            let next = ring.iter().flat_map(|&f| self.surface.around(f as usize)).map(|(_, g)| g as u32);
            ring = next.filter(|&g| labels[g as usize] == to && seen.insert(g)).collect();
            around.extend(&ring);
        }
        around
    }

    /// The sum of the squared distances of all corners from the patch that fits them best.
    fn squares_off_patch(&self, faces: &[u32]) -> Option<f64> {
        Some(Patch::fit(self.surface, faces, None)?.squares(self.surface, faces))
    }
}
