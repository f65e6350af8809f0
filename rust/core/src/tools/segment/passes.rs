//! The passes from the indicator to segments and their hierarchy,
//! each with what it takes from the options and the noise.

use super::constants::{BEND, BEND_SHARES, PERSISTENCE, PLANE_EDGE, PLANE_NOISE};
use super::divide::Divide;
use super::exact::Planes;
use super::explain::Explain;
use super::hierarchy::Hierarchy;
use super::merge::{rename, within_order, Merge, Merging};
use super::nesting::nested_leaves;
use super::options::{SegmentMethod, SegmentOptions};
use super::patches::patch_size;
use super::regions::Regions;
use super::relabel::Relabel;
use super::slopes::Slopes;
use super::straighten::Straighten;
use super::surface::{pieces, Surface};
use super::tangent;
use super::threshold::cut_and_merge;
use super::watershed::watershed;
use crate::linear::Columns;
use crate::mesh::partition::contiguous;
use crate::progress::{Progress, Report};
use crate::{memory, Result};

/// All that segments are made from.
pub(super) struct Passes<'a> {
    pub surface: &'a Surface<'a>,
    /// The signal as it came, in the unit of the segmentation.
    pub start: &'a Columns,
    /// Whether the signal is the positions.
    pub is_shape: bool,
    pub noise: f64,
    pub indicator: &'a [f64],
    /// The planes of an exact shape, which are segments to begin with.
    pub planes: Option<&'a Planes>,
    /// The regions that are segmented by themselves.
    pub regions: Option<&'a Regions>,
    pub options: &'a SegmentOptions,
    pub progress: &'a Progress,
}

impl<'a> Passes<'a> {
    /// What bends across borders.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing.
    pub(super) fn slopes(&self) -> Result<Slopes> {
        match self.planes {
            Some(planes) => Slopes::of_planes(self.surface, &planes.normals),
            None if self.is_shape => Slopes::of_shape(self.surface, self.noise),
            None => Slopes::of_values(self.surface, self.start, self.noise),
        }
    }

    /// What merges across borders that bend little.
    pub(super) fn merging(&self, slopes: &'a Slopes) -> Merging<'a> {
        Merging { surface: self.surface, slopes, groups: None, progress: self.progress }
    }

    /// The segments to begin with: planes, or pieces between low indicators,
    /// divided where a ridge runs through them.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub(super) fn leaves(&self) -> Result<Vec<u32>> {
        self.report(0.9, "segments");
        if let Some(planes) = self.planes {
            return Ok(memory::twin(&planes.labels)?);
        }
        match self.options.method {
            SegmentMethod::Paper => {
                let (threshold, least) = (self.options.cut_threshold, self.least_faces());
                Ok(cut_and_merge(self.surface, self.indicator, threshold, least)?.0)
            }
            SegmentMethod::Fitted => {
                let mut leaves = watershed(self.surface, self.indicator, PERSISTENCE)?.0;
                if let Some(regions) = self.groups() {
                    leaves = common(self.surface, &leaves, regions)?;
                }
                self.divide(&mut leaves)?;
                Ok(leaves)
            }
        }
    }

    /// The segments that are left of `leaves`, without borders that bend little.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub(super) fn joined(&self, merging: &Merging<'_>, leaves: &[u32]) -> Result<Vec<u32>> {
        let mut labels = memory::twin(leaves)?;
        if let Some(planes) = self.planes {
            let within = Merging { groups: planes.groups.as_deref(), ..*merging };
            within.below(&mut labels, BEND * self.options.length_weight)?;
            merging.absorb_small(&mut labels, self.options.min_faces.unwrap_or(0))?;
        } else if self.options.method == SegmentMethod::Fitted {
            self.fit(&Merging { groups: self.groups(), ..*merging }, &mut labels)?;
            if let Some(regions) = self.regions {
                regions.join(self.surface, &mut labels, BEND * self.options.length_weight)?;
                merging.absorb_small(&mut labels, self.options.min_faces.unwrap_or(0))?;
            }
        }
        if let Some(n) = self.options.n_segments {
            self.merge_to(merging, &mut labels, n)?;
        }
        Ok(labels)
    }

    /// How many faces a segment must have.
    fn least_faces(&self) -> usize {
        self.options.least_faces(self.noise / self.surface.mean_edge)
    }

    /// How far the corners of a side are off it, as a standard deviation and at most.
    fn deviations(&self) -> [f64; 2] {
        let least = PLANE_EDGE * self.surface.mean_edge;
        [self.noise.max(least), (PLANE_NOISE * self.noise).max(least)]
    }

    /// The regions between clear ridges of a shape; none of shapes that are planes already,
    /// and of other signals.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub(super) fn regions(&self) -> Result<Option<Regions>> {
        if self.planes.is_some() || !self.is_shape || self.options.method != SegmentMethod::Fitted {
            return Ok(None);
        }
        if self.is_finishing() {
            return Ok(None);
        }
        Regions::between_clear_ridges(self.surface, self.noise, &self.explanation(true, None))
    }

    /// Divides segments of a shape that lie across a ridge.
    fn divide(&self, labels: &mut Vec<u32>) -> Result<()> {
        if !self.is_shape || self.is_finishing() {
            return Ok(());
        }
        let [deviation, flat] = self.deviations();
        let bend = BEND * self.options.length_weight;
        Divide { surface: self.surface, deviation, flat, bend, progress: self.progress }.run(labels)
    }

    /// Gives segments of a shape to the planes, and small ones also to the `curved` sides, that explain them.
    fn explain(&self, labels: &mut Vec<u32>, curved: bool) -> Result<()> {
        if self.is_shape && !self.is_finishing() {
            self.explanation(curved, self.groups()).run(labels)?;
        }
        Ok(())
    }

    fn explanation(&self, curved: bool, regions: Option<&'a [u32]>) -> Explain<'a> {
        let [deviation, flat] = self.deviations();
        let most_faces = patch_size(self.noise / self.surface.mean_edge);
        Explain {
            surface: self.surface,
            deviation,
            flat,
            most_faces,
            curved,
            regions,
            progress: self.progress,
        }
    }

    fn groups(&self) -> Option<&'a [u32]> {
        self.regions.map(|regions| regions.labels.as_slice())
    }

    /// Merges and relabels in turns; only merges once the caller wishes to finish.
    fn fit(&self, merging: &Merging<'_>, labels: &mut Vec<u32>) -> Result<()> {
        let relabel = self.relabel(self.least_faces());
        let threshold = BEND * self.options.length_weight;
        for (round, share) in BEND_SHARES.into_iter().enumerate() {
            if self.is_finishing() {
                break;
            }
            self.report(0.9 + 0.02 * round as f64, "segments");
            merging.below(labels, share * threshold)?;
            merging.absorb_small(labels, self.least_faces())?;
            self.explain(labels, false)?;
            self.divide(labels)?;
            let before = memory::twin(labels)?;
            relabel.run(labels)?;
            if *labels == before && share == 1.0 {
                break;
            }
        }
        let [_, flat] = self.deviations();
        let is_straightened = self.is_shape && !self.is_finishing();
        let straighten =
            is_straightened.then(|| Straighten::new(self.surface, flat, self.groups(), self.progress));
        let straighten = straighten.transpose()?;
        if let Some(straighten) = &straighten {
            straighten.run(labels)?;
            relabel.rejoin(labels)?;
        }
        merging.below(labels, threshold)?;
        merging.absorb_small(labels, self.least_faces())?;
        self.explain(labels, true)?;
        if let (Some(straighten), false) = (&straighten, self.is_finishing()) {
            straighten.run(labels)?;
            relabel.rejoin(labels)?;
        }
        Ok(())
    }

    fn relabel(&self, least_faces: usize) -> Relabel<'_> {
        Relabel {
            surface: self.surface,
            signal: (!self.is_shape).then_some(self.start),
            noise: self.noise,
            least_faces,
            regions: self.groups(),
            progress: self.progress,
        }
    }

    /// Moves the borders of segments of a shape, found on a coarser mesh, to where this one has them. None
    /// falls apart: small pieces that come loose are its neighbors'.
    pub(super) fn refine(&self, labels: &mut Vec<u32>) -> Result<()> {
        let relabel = self.relabel(usize::MAX);
        relabel.run(labels)?;
        let [_, flat] = self.deviations();
        Straighten::new(self.surface, flat, self.groups(), self.progress)?.run(labels)?;
        relabel.rejoin(labels)?;
        Ok(())
    }

    /// Joins segments that were refined and have fewer faces of this mesh than was asked for.
    pub(super) fn settled(&self, labels: &mut [u32]) -> Result<Vec<Merge>> {
        match self.options.min_faces {
            None | Some(0) => Ok(Vec::new()),
            Some(least) => self.merging(&self.slopes()?).absorb_small(labels, least),
        }
    }

    /// Merges down to `n` segments, where there are more.
    fn merge_to(&self, merging: &Merging<'_>, labels: &mut [u32], n: usize) -> Result<()> {
        let count = contiguous(labels)?.1;
        if count <= n {
            return Ok(());
        }
        let mut merged = memory::twin(labels)?;
        let merges = self.all_merges(merging, &mut merged)?;
        rename(labels, &merges[..(count - n).min(merges.len())]);
        Ok(())
    }

    /// Merges until nothing that may merge touches. Bends say nothing of faces that are tangent.
    fn all_merges(&self, merging: &Merging<'_>, labels: &mut [u32]) -> Result<Vec<Merge>> {
        match self.planes {
            Some(Planes { groups: Some(_), .. }) => tangent::merged(self.surface, labels, |_, _| true),
            _ => merging.all(labels),
        }
    }

    /// The finest segments are the pieces of `leaves` inside the segments `labels`; they merge to those, and
    /// those to one for each connected part.
    pub(super) fn hierarchy(
        &self,
        merging: &Merging<'_>,
        leaves: &[u32],
        labels: &[u32],
    ) -> Result<Hierarchy> {
        self.report(0.98, "hierarchy");
        let (finest, n_leaves) = nested_leaves(self.surface, leaves, labels)?;
        let mut current = memory::twin(&finest)?;
        let within = Merging { groups: Some(labels), ..*merging };
        let mut merges: Vec<Merge> = within.all(&mut current)?;
        merges.sort_by(|a, b| a.strength.total_cmp(&b.strength));
        let mut merges = within_order(&finest, n_leaves, &merges)?;
        let mut current = memory::twin(&finest)?;
        rename(&mut current, &merges);
        let outer = self.all_merges(merging, &mut current)?;
        memory::extend(&mut merges, outer.len())?;
        merges.extend(outer);
        let merges = merges.iter().map(|m| ([m.kept, m.gone], m.strength));
        Ok(Hierarchy::new(finest, n_leaves, merges).ascending())
    }

    /// Whether what only makes borders better is left out.
    fn is_finishing(&self) -> bool {
        self.progress.is_finishing()
    }

    fn report(&self, fraction: f64, stage: &str) {
        self.progress.report(Report { fraction, stage: stage.into(), ..Report::default() });
    }
}

/// The connected pieces in which two labelings both have one label.
fn common(surface: &Surface<'_>, first: &[u32], second: &[u32]) -> Result<Vec<u32>> {
    let mut names = std::collections::BTreeMap::new();
    let pairs = first.iter().zip(second);
    let labels: Vec<u32> = memory::gathered(pairs.map(|pair| {
        let fresh = names.len() as u32;
        *names.entry(pair).or_insert(fresh)
    }))?;
    Ok(pieces(surface, &labels)?.0)
}
