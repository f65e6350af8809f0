//! The facets that are wanted, as many as are asked for, such that none passes through another.

use std::borrow::Cow;

use super::constants::{self, CHANGE, COUNTS, REFUSALS};
use super::count::Wanted;
use super::faces::{Faces, Scan};
use super::faults::{Inspection, Unsound};
use super::fitting;
use super::hierarchy::{Cut, Hierarchy};
use super::job::Job;
use super::merging::{merges, Merges};
use super::moments::Moments;
use super::nearest::Distances;
use super::options::FacetOptions;
use super::refusals::Refusals;
use super::regions::{Regions, OUTSIDE};
use super::shape::Shape;
use crate::error::MeshError;
use crate::memory;
use crate::progress::{Progress, Report};
use crate::Result;

/// What was made of a number of regions.
pub(super) struct Found {
    pub shape: Shape,
    pub inspection: Inspection,
    pub labels: Vec<u32>,
    pub distances: Distances,
    pub n_facets: usize,
    pub n_crossings: usize,
}

/// Facets that are flat, with the faces that they stand for.
struct Settled<'s> {
    shape: Shape,
    faces: Faces<'s>,
}

impl Settled<'_> {
    fn distances(&self) -> Result<Distances> {
        Ok(self.faces.nearest(&self.shape, &Inspection::new(&self.shape, &self.faces, true)?)?.1)
    }
}

impl Job<'_> {
    pub(super) fn scan(&self) -> Result<Scan> {
        let faces = self.working.mesh().connectivity().faces();
        Scan::new(&memory::gathered(self.parts.iter().map(|&f| faces[f as usize]))?, self.places()?)
    }

    /// Goes on with merges that were `begun`.
    pub(super) fn merges(
        &self,
        begun: Merges,
        scan: &Scan,
        refusals: &Refusals,
        options: &FacetOptions,
        progress: &Progress,
    ) -> Result<Merges> {
        let connectivity = self.working.mesh().connectivity();
        let n = self.parts.len() - begun.pairs.len();
        let labels = begun.labels(self.parts.len(), n)?;
        let (mut names, mut is_held) = (memory::repeated(OUTSIDE, n)?, memory::repeated(false, n)?);
        let mut moments = memory::repeated(Moments::default(), n)?;
        for (f, ((&label, &held), place)) in
            (0..).zip(labels.iter().zip(&refusals.is_held).zip(self.places()?))
        {
            names[label as usize] = names[label as usize].min(f);
            is_held[label as usize] |= held;
            moments[label as usize] = moments[label as usize].plus(&Moments::of(place));
        }
        let apart: Vec<[u32; 2]> =
            memory::gathered(refusals.apart.iter().map(|pair| pair.map(|f| labels[f as usize])))?;
        let mut regions = Regions::new(connectivity, &self.positions, self.labels(labels)?, n)?;
        let rows = options.edge_weights.as_ref().map(|rows| self.working.corner_rows(rows)).transpose()?;
        let weight = |h: u32| {
            let of = |h: usize| rows.as_ref().map_or(1.0, |rows| rows[h / 3][h % 3]);
            connectivity.mate(h as usize).map_or(of(h as usize), |mate| of(h as usize).min(of(mate)))
        };
        let rest = merges(&mut regions, moments, &is_held, &apart, weight, |p| scan.on_mesh(p), progress)?;
        begun.followed_by(rest, &names)
    }

    /// The shape with as many facets as are wanted.
    pub(super) fn found(
        &self,
        merges: &Merges,
        scan: &Scan,
        options: &FacetOptions,
        progress: &Progress,
    ) -> Result<Found> {
        let wanted = match (options.facets, options.error) {
            (Some(facets), _) => Wanted::Facets(facets),
            (None, Some(error)) => Wanted::Error(error / self.diagonal),
            (None, None) => Wanted::Found,
        };
        let n = self.parts.len();
        let mut merges = Cow::Borrowed(merges);
        let mut refusals = Refusals::new(memory::twin(&self.is_held)?)?;
        let area = scan.area.max(f64::MIN_POSITIVE);
        let mut count = merges.count(wanted.and(refusals.n_held()), n, self.positions.len(), area);
        // Faces that stay beside those that are to are counted besides.
        let aim = count - refusals.n_held();
        let mut is_fixed = memory::twin(&self.is_fixed)?;
        let mut best: Option<((usize, f64), Settled<'_>)> = None;
        let (mut round, mut n_refused) = (0, 0);
        while round < COUNTS {
            let fraction = 0.5 + 0.5 * round as f64 / COUNTS as f64;
            progress.report(Report { fraction, stage: "fitting planes".into(), ..Report::default() });
            let [fewest, most] = merges.range(n);
            count = count.clamp(fewest, most);
            let (tree, cut) = self.partition(&merges, count)?;
            let mut settled = self.settled(scan, &tree, &cut, &refusals, &is_fixed, progress)?;
            let mut unsound = Unsound::new(&settled.shape, &settled.faces)?;
            let (miss, next) = match wanted {
                Wanted::Facets(_) => {
                    let wanted = (aim + refusals.n_held()).clamp(fewest, most);
                    let off = wanted as f64 - settled.shape.facets.len() as f64;
                    let most = CHANGE[0] + CHANGE[1] * count as f64;
                    let further = if off == 0.0 { 1.0 } else { off.clamp(-most, most).round() };
                    (off.abs(), count as f64 + further)
                }
                Wanted::Error(_) if !unsound.facets.is_empty() => (f64::INFINITY, count as f64),
                Wanted::Error(error) => {
                    fitting::refine(&mut settled.shape, &mut settled.faces, progress)?;
                    let over = settled.distances()?.rms / error;
                    ((over - 1.0).max(0.0), (count as f64 * over.max(1.05)).ceil())
                }
                Wanted::Found => (0.0, 0.0),
            };
            let rank = (unsound.facets.len(), miss);
            let has_sound = best.as_ref().is_some_and(|((n_unsound, _), _)| *n_unsound == 0);
            let is_refused = rank.0 > 0 && !progress.is_finishing() && (n_refused < REFUSALS || !has_sound);
            let refused = if is_refused {
                let all = n_refused >= REFUSALS;
                if n_refused >= 2 * REFUSALS {
                    // The mesh itself is sound.
                    unsound.facets = memory::numbers(settled.shape.facets.len())?;
                }
                Some(refusals.refuse(&merges, (tree, cut), &settled.shape, &unsound, all, |labels, n| {
                    self.regions(labels, n)
                })?)
            } else {
                None
            };
            if best.as_ref().is_none_or(|(least, _)| rank < *least) {
                best = Some((rank, settled));
            }
            if let Some(refused) = refused {
                let n_held = refusals.n_held();
                self.stay(&refused.stay, &mut refusals.is_held, &mut is_fixed);
                let begun =
                    refused.remaining(&merges, &refusals.is_held, |labels, n| self.regions(labels, n))?;
                // Elsewhere all stays as it was, until what is wanted is sought again.
                let n_left = n - begun.pairs.len();
                count = if n_refused < REFUSALS / 2 { count + refusals.n_held() - n_held } else { n_left };
                merges = Cow::Owned(self.merges(begun, scan, &refusals, options, progress)?);
                n_refused += 1;
                continue;
            }
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let next = (next as usize).clamp(fewest, most);
            if rank == (0, 0.0) || next == count || progress.is_finishing() {
                break;
            }
            count = next;
            round += 1;
        }
        let ((_, miss), mut settled) = best.ok_or(MeshError::NoFaces)?;
        if !(matches!(wanted, Wanted::Error(_)) && miss.is_finite()) {
            fitting::refine(&mut settled.shape, &mut settled.faces, progress)?;
        }
        let n_facets = fitting::order(&mut settled.shape, &mut settled.faces)?;
        let inspection = Inspection::new(&settled.shape, &settled.faces, true)?;
        let n_crossings = inspection.pairs.len();
        let (labels, distances) = settled.faces.nearest(&settled.shape, &inspection)?;
        Ok(Found { shape: settled.shape, inspection, labels, distances, n_facets, n_crossings })
    }

    /// The first merges such that about `count` regions remain, all of them facets.
    fn partition(&self, merges: &Merges, count: usize) -> Result<(Hierarchy, Cut)> {
        let n = self.parts.len();
        let (tree, mut cut) = Hierarchy::new(merges, n, n - count)?;
        if !merges.is_whole(n - cut.len()) {
            tree.close(&mut cut, |labels, n| self.regions(labels, n))?;
        }
        Ok((tree, cut))
    }

    /// The regions that `labels` of the parts make.
    fn regions(&self, labels: &[u32], n: usize) -> Result<Regions<'_>> {
        let of_all = self.labels(labels.iter().copied())?;
        Regions::new(self.working.mesh().connectivity(), &self.positions, of_all, n)
    }

    /// Holds parts where they are, and what touches them as faces of its own.
    fn stay(&self, parts: &[u32], is_held: &mut [bool], is_fixed: &mut [bool]) {
        if parts.is_empty() {
            return;
        }
        let faces = self.working.mesh().connectivity().faces();
        let corners = |f: u32| faces[self.parts[f as usize] as usize].into_iter();
        parts.iter().flat_map(|&f| corners(f)).for_each(|v| is_fixed[v as usize] = true);
        for (f, held) in (0..).zip(is_held) {
            *held |= corners(f).any(|v| is_fixed[v as usize]);
        }
    }

    /// The shape made of the regions of a cut, sound where that can be had.
    fn settled<'s>(
        &self,
        scan: &'s Scan,
        tree: &Hierarchy,
        cut: &Cut,
        refusals: &Refusals,
        is_fixed: &[bool],
        progress: &Progress,
    ) -> Result<Settled<'s>> {
        let (labels, tops) = tree.labels(cut)?;
        let n_regions = tops.len();
        let (mut parts, mut is_held) =
            (memory::repeated(OUTSIDE, n_regions)?, memory::repeated(false, n_regions)?);
        for ((f, &label), &held) in (0..).zip(&labels).zip(&refusals.is_held) {
            parts[label as usize] = parts[label as usize].min(f);
            is_held[label as usize] |= held;
        }
        let moments = scan.sums(&labels, n_regions)?;
        let regions = self.regions(&labels, n_regions)?;
        let area: f64 = moments.iter().map(|m| m.area).sum();
        let squares: f64 = moments.iter().map(|m| m.fit().squared_distance).sum();
        let tolerance = (squares / area.max(f64::MIN_POSITIVE)).sqrt().max(constants::FLAT);
        let firmness = |v: u32| (!is_fixed[v as usize]).then(|| refusals.firmness(v));
        let mut shape =
            Shape::new(&regions, &moments, &self.positions, &parts, &is_held, firmness, 2.0 * tolerance)?;
        let mut faces = Faces { scan, labels, is_held: memory::twin(&refusals.is_held)? };
        fitting::settle(&mut shape, &mut faces, progress)?;
        fitting::fold(&mut shape, &mut faces)?;
        Ok(Settled { shape, faces })
    }
}
