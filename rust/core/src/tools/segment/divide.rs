//! Dividing segments that lie across a ridge: where noise hides a ridge, basins of the indicator run over it.
//!
//! Two planes, or two curved patches, are fitted in turns with the assignment of faces to them, as
//! variational shape approximation does (Cohen-Steiner et al. 2004), and must explain the segment better than
//! one patch does, by the ratio of their likelihoods. So the strips of a cylinder, which one patch explains,
//! stay together however coarse and noisy they are.

use std::collections::BTreeSet;

use super::constants::{DIVIDE_ROUNDS, DIVIDE_TURNS, EVIDENCE_TO_DIVIDE, LEAST_PART};
use super::patches::{Patch, SegmentPlane};
use super::surface::{members, pieces, Surface};
use crate::mesh::vector::{distance, dot, Point};
use crate::progress::Progress;
use crate::{memory, Result};

/// How segments are divided.
pub(super) struct Divide<'a> {
    pub surface: &'a Surface<'a>,
    /// Standard deviation of the distances from a plane.
    pub deviation: f64,
    /// The most that the corners of faces of one side are off it, root mean square.
    pub flat: f64,
    /// Parts that bend by less where they meet are one.
    pub bend: f64,
    pub progress: &'a Progress,
}

/// What a part of a segment looks like.
enum Model {
    Plane(SegmentPlane),
    Patch(Patch),
}

impl Model {
    fn normal(&self, p: Point) -> Point {
        match self {
            Self::Plane(plane) => plane.normal(),
            Self::Patch(patch) => patch.normal(p),
        }
    }
}

impl Divide<'_> {
    /// Divides every segment that two sides explain better than one. Pieces that are not connected become
    /// segments of their own; labels are contiguous then.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub(super) fn run(&self, labels: &mut Vec<u32>) -> Result<()> {
        for _ in 0..DIVIDE_ROUNDS {
            self.progress.check()?;
            let members = members(labels)?;
            let mut divided = false;
            for (fresh, faces) in (members.len() as u32..).zip(members) {
                if self.progress.is_finishing() {
                    break;
                }
                for f in self.second_side(&faces)?.unwrap_or_default() {
                    labels[f as usize] = fresh;
                    divided = true;
                }
            }
            if !divided {
                break;
            }
            *labels = pieces(self.surface, labels)?.0;
        }
        Ok(())
    }

    /// The faces of the second of two sides, where they explain what one patch does not.
    fn second_side(&self, faces: &[u32]) -> Result<Option<Vec<u32>>> {
        let is_divisible = |plane: SegmentPlane| faces.len() >= 2 * LEAST_PART && plane.spread > self.flat;
        if !SegmentPlane::through(self.surface, faces).is_some_and(is_divisible) {
            return Ok(None);
        }
        let Some(patch) = Patch::fit(self.surface, faces, None) else { return Ok(None) };
        let directions = patch.curvature_directions();
        let squares = self.squares(&Model::Patch(patch), faces);
        for across in directions {
            let leaning = |&f: &u32| dot(across, self.surface.centroids[f as usize]);
            let mut leanings: Vec<f64> = memory::gathered(faces.iter().map(leaning))?;
            let mut sorted = memory::twin(&leanings)?;
            let middle = *sorted.select_nth_unstable_by(faces.len() / 2, f64::total_cmp).1;
            leanings.iter_mut().for_each(|x| *x -= middle);
            for curved in [false, true] {
                if let Some(second) = self.halves(faces, &mut leanings, squares, curved)? {
                    return Ok(Some(second));
                }
            }
        }
        Ok(None)
    }

    /// The second of two sides, planes or `curved`, that follow from how faces lean: those with positive
    /// `leanings` to it. Nothing where they do not fit within the noise, bend little where they meet, or
    /// explain no more than the one patch that misses the corners by `squares`.
    fn halves(
        &self,
        faces: &[u32],
        leanings: &mut [f64],
        squares: f64,
        curved: bool,
    ) -> Result<Option<Vec<u32>>> {
        let kind = usize::from(curved);
        let mut turn = 0;
        loop {
            let side = |second: bool| {
                let pairs = faces.iter().zip(leanings.iter());
                memory::sifted(pairs.filter(|(_, x)| (**x > 0.0) == second).map(|(f, _)| *f))
            };
            let sides: [Vec<u32>; 2] = [side(false)?, side(true)?];
            if sides.iter().any(|side| side.len() < LEAST_PART) {
                return Ok(None);
            }
            let [Some(first), Some(second)] = [0, 1].map(|i| self.model(&sides[i], curved)) else {
                return Ok(None);
            };
            let models = [first, second];
            if turn < DIVIDE_TURNS[kind] {
                turn += 1;
                for (leaning, &f) in leanings.iter_mut().zip(faces) {
                    *leaning = self.squares(&models[0], &[f]) - self.squares(&models[1], &[f]);
                }
                continue;
            }
            let left = [0, 1].map(|i| self.squares(&models[i], &sides[i]));
            let fits = (0..2).all(|i| left[i] <= (3 * sides[i].len()) as f64 * self.flat * self.flat);
            let stands = fits
                && log_likelihood_ratio(squares - left[0] - left[1], self.deviation)
                    > EVIDENCE_TO_DIVIDE[kind]
                && self.bend_between(&models, &sides) > self.bend;
            let [_, second] = sides;
            return Ok(stands.then_some(second));
        }
    }

    fn model(&self, faces: &[u32], curved: bool) -> Option<Model> {
        if curved {
            Patch::fit(self.surface, faces, None).map(Model::Patch)
        } else {
            SegmentPlane::through(self.surface, faces).map(Model::Plane)
        }
    }

    /// The sum of the squared distances of all corners.
    fn squares(&self, model: &Model, faces: &[u32]) -> f64 {
        let surface = self.surface;
        match model {
            Model::Plane(plane) => {
                let corners = faces.iter().flat_map(|&f| surface.connectivity.faces()[f as usize]);
                corners.map(|v| plane.distance(surface.positions[v as usize]).powi(2)).sum()
            }
            Model::Patch(patch) => patch.squares(surface, faces),
        }
    }

    /// The mean bend from one model to the other along the edges where their sides meet.
    fn bend_between(&self, models: &[Model; 2], sides: &[Vec<u32>; 2]) -> f64 {
        let surface = self.surface;
        let second: BTreeSet<u32> = sides[1].iter().copied().collect();
        let (mut sum, mut total) = (0.0, 0.0);
        for &f in &sides[0] {
            for (h, _) in surface.around(f as usize).filter(|(_, g)| second.contains(&(*g as u32))) {
                let (length, place) = (surface.lengths[f as usize][h % 3], surface.centroids[f as usize]);
                sum += length * distance(models[0].normal(place), models[1].normal(place));
                total += length;
            }
        }
        if total > 0.0 {
            sum / total
        } else {
            0.0
        }
    }
}

/// The logarithm of the ratio of likelihoods of two models under noise of that deviation, where the squared
/// distances of the corners of faces differ by `squares` in sum: a vertex is a corner of six faces.
pub(super) fn log_likelihood_ratio(squares: f64, deviation: f64) -> f64 {
    squares / (6.0 * 2.0 * deviation * deviation)
}
