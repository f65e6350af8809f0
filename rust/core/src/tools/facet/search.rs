//! The facets that are wanted, as many as are asked for, such that none passes through another.

use std::cmp::Ordering::Equal;

use super::constants::{self, CHANGE, COUNTS, DOUBLINGS, REFUSALS};
use super::count::Wanted;
use super::faces::{Faces, Scan};
use super::faults::{Inspection, Unsound};
use super::fitting;
use super::hierarchy::{Cut, Hierarchy};
use super::job::Job;
use super::merging::{merges, Merges};
use super::nearest::Distances;
use super::options::FacetOptions;
use super::reducing::{reduce, Goal};
use super::refusals::Refusals;
use super::regions::{Regions, OUTSIDE};
use super::shape::Shape;
use super::stage::{shares, Stage, USUAL};
use super::volume;
use crate::error::MeshError;
use crate::memory;
use crate::progress::Progress;
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

/// The same, where what was not sound is divided.
struct Divided<'s> {
    n_unsound: usize,
    /// The regions, and which of them are not sound or touch one that is not.
    cut: Cut,
    in_doubt: Vec<u32>,
    /// Whether the regions are smaller where they were not sound, and nowhere else.
    is_local: bool,
    is_divided: bool,
    settled: Settled<'s>,
    /// Twice how far the regions are off their planes.
    tolerance: f64,
}

/// What comes nearest: unsound facets, and how far it is off what is wanted.
type Rank = (usize, f64);

impl Settled<'_> {
    fn distances(&self) -> Result<Distances> {
        Ok(self.faces.nearest(&self.shape, &Inspection::new(&self.shape, &self.faces, true)?)?.1)
    }
}

impl Divided<'_> {
    /// Joins facets up to a goal, as far as that goes; how far the number is off.
    fn join(&mut self, goal: Goal, share: [f64; 2], progress: &Progress) -> Result<f64> {
        let Settled { shape, faces } = &mut self.settled;
        let n_joins = shape.facets.len().saturating_sub(goal.count);
        let stage = Stage::new(progress, "joining facets", share, USUAL[1] * n_joins);
        reduce(shape, faces, goal, self.tolerance, &stage)?;
        Ok(goal.count.abs_diff(self.settled.shape.facets.len()) as f64)
    }
}

impl Job<'_> {
    pub(super) fn scan(&self, options: &FacetOptions) -> Result<Scan> {
        let faces = self.working.mesh().connectivity().faces();
        Scan::new(
            &memory::gathered(self.parts.iter().map(|&f| faces[f as usize]))?,
            self.places()?,
            self.borders(options)?,
        )
    }

    /// What borders cost along each halfedge.
    pub(super) fn weight<'o>(&'o self, options: &FacetOptions) -> Result<impl Fn(u32) -> f64 + 'o> {
        let rows = options.edge_weights.as_ref().map(|rows| self.working.corner_rows(rows)).transpose()?;
        let connectivity = self.working.mesh().connectivity();
        Ok(move |h: u32| {
            let of = |h: usize| rows.as_ref().map_or(1.0, |rows| rows[h / 3][h % 3]);
            connectivity.mate(h as usize).map_or(of(h as usize), |mate| of(h as usize).min(of(mate)))
        })
    }

    /// The merges of all parts but those that are held.
    pub(super) fn merges(&self, scan: &Scan, options: &FacetOptions, progress: &Progress) -> Result<Merges> {
        let n = self.parts.len();
        let mut regions = self.regions(&memory::numbers(n)?, n)?;
        let weight = self.weight(options)?;
        let moments = memory::twin(&scan.moments)?;
        merges(&mut regions, moments, &self.is_held, weight, |p| scan.on_mesh(p), progress)
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
        let n_held = self.is_held.iter().filter(|held| **held).count();
        let [fewest, most] = merges.range(n);
        let area = scan.area.max(f64::MIN_POSITIVE);
        let evident = match wanted {
            Wanted::Found => self.evident_planes(merges, scan)?,
            _ => None,
        };
        let mut aim =
            evident.unwrap_or_else(|| merges.count(wanted.and(n_held), n, self.positions.len(), area));
        let (first, mut count) = (aim, aim);
        // Where more are farther off, that is noise, and more facets are less likely.
        let is_near = merges.distance(n, count, area) <= constants::ERROR;
        let is_found = matches!(wanted, Wanted::Found) && evident.is_none();
        let limit = (is_found && is_near).then_some(constants::ERROR);
        // With fewer facets than are wanted, and with as many or more.
        let mut best: [Option<(Rank, Divided<'_>)>; 2] = [None, None];
        let mut begun = [0; 2];
        let stage = Stage::new(progress, "finding facets", shares::FINDING[0], USUAL[0]);
        for _ in 0..COUNTS {
            let start = self.start(merges, count, limit, scan)?;
            if limit.is_some() && count == first {
                // However many there are to begin with, more are joined again.
                aim = start.1.len();
            }
            let mut divided = self.sound(merges, count, start, scan, &stage)?;
            let Settled { shape, faces } = &mut divided.settled;
            let n_made = shape.facets.len();
            let off = aim as f64 - n_made as f64;
            let is_enough = n_made >= aim || !matches!(wanted, Wanted::Facets(_));
            let (miss, next) = match wanted {
                // What was divided is joined again: another number to begin with is no nearer.
                Wanted::Facets(_) if divided.is_divided && n_made >= aim => (off.abs(), count as f64),
                Wanted::Facets(_) => {
                    let most = CHANGE[0] + CHANGE[1] * count as f64;
                    (off.abs(), count as f64 + off.clamp(-most, most).round())
                }
                Wanted::Error(error) => {
                    fitting::refine(shape, faces, &stage)?;
                    let over = divided.settled.distances()?.rms / error;
                    ((over - 1.0).max(0.0), (count as f64 * over.max(1.05)).ceil())
                }
                Wanted::Found => {
                    let over = divided.settled.distances()?.rms / constants::ERROR.max(divided.tolerance);
                    ((over - 1.0).max(0.0), (count as f64 * over.clamp(1.0, 2.0)).ceil())
                }
            };
            let (rank, best) = ((divided.n_unsound, miss), &mut best[usize::from(is_enough)]);
            if best.as_ref().is_none_or(|(least, _)| rank < *least) {
                *best = Some((rank, divided));
                begun[usize::from(is_enough)] = count;
            }
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let next = (next as usize).clamp(fewest, most);
            if miss == 0.0 || next == count || progress.is_finishing() {
                break;
            }
            count = next;
        }
        let [few, mut enough] = best;
        // Where no number is asked for, more facets than were looked for are better than such as are far off.
        let is_asked = matches!(wanted, Wanted::Facets(_));
        let goal = Goal { count: aim, error: if is_asked { f64::INFINITY } else { constants::ERROR } };
        if let Some((rank, divided)) = &mut enough {
            if !matches!(wanted, Wanted::Error(_)) {
                rank.1 = divided.join(goal, shares::JOINING[0], progress)?;
                // Smaller regions everywhere leave more ways to join them.
                if is_asked && rank.1 > 0.0 && divided.is_local && !progress.is_finishing() {
                    let stage = Stage::new(progress, "finding facets", shares::FINDING[1], USUAL[0]);
                    let (tree, cut) = self.start(merges, aim, None, scan)?;
                    // What is sound by parts began with more that was not.
                    let divide = || self.divided((&tree, cut), aim == most, scan, &stage);
                    let coarsest = (begun[1] != aim).then(divide).transpose()?;
                    if let Some(other) = self.finer((merges, &tree), aim, coarsest, scan, &stage)? {
                        let mut other = self.released(other)?;
                        let miss = other.join(goal, shares::JOINING[1], progress)?;
                        if (other.n_unsound, miss) < *rank {
                            (*rank, *divided) = ((other.n_unsound, miss), other);
                        }
                    }
                }
            }
        }
        let nearest =
            [few, enough].into_iter().flatten().min_by(|a, b| a.0.partial_cmp(&b.0).unwrap_or(Equal));
        let (_, Divided { mut settled, .. }) = nearest.ok_or(MeshError::NoFaces)?;
        if !matches!(wanted, Wanted::Error(_)) {
            let stage = Stage::new(progress, "fitting planes", shares::FITTING, USUAL[2]);
            fitting::refine(&mut settled.shape, &mut settled.faces, &stage)?;
        }
        if options.keep_volume {
            let stage = Stage::new(progress, "keeping the volume", shares::VOLUME, USUAL[2]);
            volume::keep(&mut settled.shape, &settled.faces, self.volume(&scan.places)?, &stage)?;
        }
        self.given_labels(settled)
    }

    /// The mesh as it is: all its faces stay.
    pub(super) fn as_it_is(&self, merges: &Merges, scan: &Scan, progress: &Progress) -> Result<Found> {
        let n = self.parts.len();
        let (tree, cut) = Hierarchy::new(merges, n, 0)?;
        let refusals = Refusals::new(&memory::repeated(true, n)?)?;
        let is_fixed = memory::repeated(true, self.is_fixed.len())?;
        let stage = Stage::new(progress, "finding facets", shares::FINDING[0], USUAL[0]);
        self.given_labels(self.settled(scan, &tree, &cut, &refusals, &is_fixed, &stage)?.0)
    }

    /// What is found once nothing changes any more.
    fn given_labels(&self, mut settled: Settled<'_>) -> Result<Found> {
        let n_facets = fitting::order(&mut settled.shape, &mut settled.faces)?;
        let inspection = Inspection::new(&settled.shape, &settled.faces, true)?;
        let n_crossings = inspection.pairs.len();
        let (nearest, distances) = settled.faces.nearest(&settled.shape, &inspection)?;
        let labels = if self.keeps { settled.faces.labels } else { nearest };
        Ok(Found { shape: settled.shape, inspection, labels, distances, n_facets, n_crossings })
    }

    /// The shape of the regions of a cut, `count` of them or a few more; where that is not sound of smaller
    /// ones, and of smaller ones everywhere if that is not enough.
    fn sound<'s>(
        &self,
        merges: &Merges,
        count: usize,
        (tree, cut): (Hierarchy, Cut),
        scan: &'s Scan,
        stage: &Stage<'_>,
    ) -> Result<Divided<'s>> {
        let [_, most] = merges.range(self.parts.len());
        let mut best = self.divided((&tree, cut), count == most, scan, stage)?;
        let is_done = |best: &Divided<'_>| best.n_unsound == 0 || stage.is_finishing();
        let mut above = count;
        // Where most of it is in doubt, nothing is gained by keeping the rest.
        let is_sparse = |best: &Divided<'_>| 2 * best.in_doubt.len() < best.cut.len();
        while !(is_done(&best) || above >= most.min(count << DOUBLINGS)) && is_sparse(&best) {
            above *= 2;
            let mut cut = best.cut.clone();
            let lowest = tree.above(merges, above.min(most));
            best.in_doubt.iter().for_each(|&node| tree.split_to(&mut cut, node, lowest));
            tree.close(&mut cut, |labels, n| self.regions(labels, n))?;
            let divided = self.divided((&tree, cut), false, scan, stage)?;
            if divided.n_unsound < best.n_unsound {
                best = Divided { is_local: true, is_divided: true, ..divided };
            }
        }
        let best = self.finer((merges, &tree), count, Some(best), scan, stage)?;
        self.released(best.ok_or(MeshError::NoFaces)?)
    }

    /// The best of a shape, and those of regions that are twice as many as `count`, four times, … everywhere,
    /// until one is sound.
    fn finer<'s>(
        &self,
        (merges, tree): (&Merges, &Hierarchy),
        mut count: usize,
        mut best: Option<Divided<'s>>,
        scan: &'s Scan,
        stage: &Stage<'_>,
    ) -> Result<Option<Divided<'s>>> {
        let (n, [_, most]) = (self.parts.len(), merges.range(self.parts.len()));
        let last = most.min(count << DOUBLINGS);
        let is_sound = |best: &Divided<'_>| best.n_unsound == 0;
        while !(best.as_ref().is_some_and(is_sound) || stage.is_finishing()) && count < last {
            count = (2 * count).min(most);
            let cut = Hierarchy::new(merges, n, n - count)?.1;
            let divided = self.divided((tree, cut), count == last, scan, stage)?;
            if best.as_ref().is_none_or(|best| divided.n_unsound < best.n_unsound) {
                best = Some(Divided { is_divided: true, ..divided });
            }
        }
        Ok(best)
    }

    /// What stayed so that the rest is sound may change again.
    fn released<'s>(&self, mut divided: Divided<'s>) -> Result<Divided<'s>> {
        let settled = &mut divided.settled;
        for facet in &mut settled.shape.facets {
            facet.is_held &= self.is_held[facet.part as usize];
        }
        settled.shape.corners.iter_mut().for_each(|c| c.is_fixed = self.is_fixed[c.vertex as usize]);
        settled.faces.is_held = memory::twin(&self.is_held)?;
        Ok(divided)
    }

    /// The shape of the regions of a cut, divided where it is not sound; where `is_last`, what is unsound
    /// even then stays as on the mesh.
    fn divided<'s>(
        &self,
        (tree, mut cut): (&Hierarchy, Cut),
        is_last: bool,
        scan: &'s Scan,
        stage: &Stage<'_>,
    ) -> Result<Divided<'s>> {
        let mut refusals = Refusals::new(&self.is_held)?;
        let mut is_fixed = memory::twin(&self.is_fixed)?;
        let mut best: Option<Divided<'_>> = None;
        for round in 0..=if is_last { 2 * REFUSALS } else { REFUSALS } {
            let (settled, tolerance, spread) = self.settled(scan, tree, &cut, &refusals, &is_fixed, stage)?;
            refusals.are_repaired &= !spread;
            let mut unsound = Unsound::new(&settled.shape, &settled.faces)?;
            let n_unsound = unsound.facets.len();
            if round + 1 == 2 * REFUSALS {
                // The mesh itself is sound.
                unsound.facets = memory::numbers(settled.shape.facets.len())?;
            }
            let in_doubt = unsound.around(&settled.shape, &tree.nodes(&cut)?)?;
            let so_far = cut.clone();
            let stay = refusals.refuse((tree, &mut cut), &settled.shape, &unsound, round >= REFUSALS)?;
            if best.as_ref().is_none_or(|best| n_unsound < best.n_unsound) {
                best = Some(Divided {
                    n_unsound,
                    cut: so_far,
                    in_doubt,
                    is_local: false,
                    is_divided: round > 0,
                    settled,
                    tolerance,
                });
            }
            if n_unsound == 0 || stage.is_finishing() {
                break;
            }
            self.stay(&stay, &mut refusals.is_held, &mut is_fixed);
            refusals.close((tree, &mut cut), |labels, n| self.regions(labels, n))?;
        }
        Ok(best.ok_or(MeshError::NoFaces)?)
    }

    /// The regions that `labels` of the parts make.
    pub(super) fn regions(&self, labels: &[u32], n: usize) -> Result<Regions<'_>> {
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

    /// The shape made of a cut, sound where that can be had; twice how far it is off; whether faults spread.
    fn settled<'s>(
        &self,
        scan: &'s Scan,
        tree: &Hierarchy,
        cut: &Cut,
        refusals: &Refusals,
        is_fixed: &[bool],
        stage: &Stage<'_>,
    ) -> Result<(Settled<'s>, f64, bool)> {
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
        let tolerance = 2.0 * (squares / area.max(f64::MIN_POSITIVE)).sqrt().max(constants::FLAT);
        let firmness = |v: u32| (!is_fixed[v as usize]).then(|| refusals.firmness(v));
        let mut shape =
            Shape::new(&regions, &moments, &self.positions, &parts, &is_held, firmness, tolerance)?;
        if let Some(mirror) = self.mirror {
            for corner in &mut shape.corners {
                corner.across = (corner.home[mirror.axis] == mirror.at).then_some(mirror.axis);
            }
        }
        let mut faces = Faces { scan, labels, is_held: memory::twin(&refusals.is_held)? };
        let spread = fitting::settle(&mut shape, &mut faces, refusals.are_repaired, stage)?;
        fitting::fold(&mut shape, &mut faces, stage)?;
        Ok((Settled { shape, faces }, tolerance, spread))
    }
}
