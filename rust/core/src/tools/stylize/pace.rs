//! How large the steps of a flow are, and when it has come to its end.

use super::flatness::Flatness;
use super::FlowStatus;

/// Bend in edges under the ridge angle, as a part of all bend, at which a shape counts as made of planes
/// that meet in ridges, if [`PLANES`] agrees. An exact model has none, one whose coordinates were rounded to
/// `f32` under 1e-4; a 32-sided cylinder 1.
const SOFT: f64 = 0.02;

/// Rough noise has no soft edges, either, but every face lies in a plane of its own; a model has most of its
/// area in planes of several faces.
const PLANES: f64 = 0.5;

/// A flow has settled when two steps together have made less than this part of the area flat. A noisy cube
/// reaches its planes at 0.77 and gains nothing after; a scan at the same place still gains 0.03 with each
/// doubling.
const SETTLED: f64 = 0.01;

/// What must have become flat before a flow can settle: a sphere gains nothing for its first steps, either.
const BEGUN: f64 = 0.05;

/// While a step still makes this much of the area flat, facets are forming, and a flow goes on beyond the
/// share asked for: planes under noise come out within two steps that gain 0.3 each; on scans at a half no
/// step gains more than 0.07.
const FORMING: f64 = 0.1;

/// The flow ends within this part of the movement asked for.
const NEAR: f64 = 0.97;

/// Movement grows with the time of the flow to this power where nothing else is known: 0.4 to 0.6 on scans.
const USUAL_GROWTH: f64 = 0.5;

/// The pace of one flow.
///
/// A step with fidelity `η` is a step of length `1 / η` in the time of the flow (implicit Euler). What a
/// flow reaches depends on its time, hardly on the number of steps: ten steps that each double the time find
/// the planes that a hundred equal ones find. So with a movement to reach, every step doubles the time, and
/// the last ends where the movement does.
#[derive(Debug, Clone)]
pub(super) struct Pace {
    movement: Option<f64>,
    flat_share: Option<f64>,
    /// The next step's fidelity in parts of the first one's.
    factor: f64,
    /// The time so far, in steps of the first length.
    time: f64,
    last: Option<(f64, f64)>,
    flat: Vec<f64>,
    fraction: f64,
    /// The factors of all steps so far.
    factors: Vec<f64>,
    plan: Option<Plan>,
}

/// The steps that another flow of the same shape took.
#[derive(Debug, Clone)]
pub(super) struct Plan {
    /// Their factors.
    factors: Vec<f64>,
    /// That of a short step.
    short: f64,
    /// How it ended; `None` where it could not go on.
    end: Option<FlowStatus>,
    /// The part of the area that was flat then.
    flat_share: f64,
}

impl Plan {
    /// How many.
    pub(super) fn n_steps(&self) -> usize {
        self.factors.len()
    }

    /// The same for a mesh with `by` times as many vertices, with short steps in the place of the last
    /// `count`.
    ///
    /// A short step is one that is to the edges of its mesh what the flow's first was to those of the mesh
    /// where it began: what a coarser level does not have is as large as faces are. A time is a volume (the
    /// energy is a length, `‖·‖²_M` its fourth power), so it falls with the third power of edges.
    pub(super) fn ending_shortly(mut self, count: usize, by: f64) -> Self {
        self.short *= by.powf(1.5);
        let n = self.factors.len();
        self.factors[n.saturating_sub(count)..].fill(self.short);
        self
    }
}

impl Pace {
    /// The pace of a flow that ends at one of two marks, or after its steps if there is none.
    pub(super) fn new(movement: Option<f64>, flat_share: Option<f64>, start: &Flatness) -> Self {
        Self {
            movement,
            flat_share,
            factor: 1.0,
            time: 0.0,
            last: None,
            flat: vec![start.flat_share],
            fraction: 0.0,
            factors: Vec::new(),
            plan: None,
        }
    }

    /// What a flow that ended with `status` did, for another one to do; what it was to do itself where it did
    /// that, in no more steps.
    pub(super) fn plan(&self, status: FlowStatus) -> Plan {
        use FlowStatus::{Converged, Reached, Settled};
        let end = Some(status).filter(|status| matches!(status, Reached | Settled | Converged));
        match &self.plan {
            Some(plan) if plan.factors.len() >= self.factors.len() => Plan { end, ..plan.clone() },
            _ => {
                let short = self.factors.first().copied().unwrap_or(self.factor);
                Plan { factors: self.factors.clone(), short, end, flat_share: self.flat_share_now() }
            }
        }
    }

    fn flat_share_now(&self) -> f64 {
        self.flat.last().copied().unwrap_or(0.0)
    }

    /// The pace of a flow that stands where the one of `plan` stood after `done` steps.
    pub(super) fn follow(&mut self, plan: Plan, done: usize) {
        self.factors = plan.factors[..done].to_vec();
        self.time = self.factors.iter().map(|factor| 1.0 / factor).sum();
        self.factor = plan.factors.get(done).copied().unwrap_or(self.factor);
        self.plan = Some(plan);
    }

    /// Sets the step after one that a plan had, or says how it ends: after its steps, or before where as much
    /// is flat already as the other flow ended with.
    fn planned(&mut self) -> Option<FlowStatus> {
        let plan = self.plan.as_ref()?;
        if plan.end.is_some() && self.flat_share_now() >= plan.flat_share {
            return plan.end;
        }
        match (plan.factors.get(self.factors.len()), plan.end) {
            (Some(&next), _) => self.factor = next,
            (None, Some(end)) => return Some(end),
            // The other flow could not go on: this one tries, with steps that double the time.
            (None, None) => self.factor = 1.0 / self.time,
        }
        None
    }

    /// Whether there is nothing to do for a flow that looks for an end by itself.
    pub(super) fn is_flat(&self, now: &Flatness) -> bool {
        self.looks_for_an_end() && now.soft_share <= SOFT && now.plane_share >= PLANES
    }

    fn looks_for_an_end(&self) -> bool {
        self.movement.is_some() || self.flat_share.is_some()
    }

    /// The factor of the fidelity in the next step.
    pub(super) fn factor(&self) -> f64 {
        self.factor
    }

    /// How much of the flow is done after `done` of at most `limit` steps, 0 to 1; never less than before.
    pub(super) fn fraction(&mut self, done: usize, limit: usize) -> f64 {
        let steps = done as f64 / limit.max(1) as f64;
        let expected = match (self.movement, self.last) {
            (Some(wanted), Some((_, moved))) if moved > 0.0 => {
                let doublings = ((wanted / moved).log2() / USUAL_GROWTH).max(0.0);
                done as f64 / (done as f64 + doublings)
            }
            _ => steps,
        };
        self.fraction = self.fraction.max(expected).max(steps).min(1.0);
        self.fraction
    }

    /// Takes note of a step that has left the shape `moved` from where it began (as a part of its size), and
    /// sets the next one; the status where there shall be none.
    pub(super) fn after(&mut self, moved: f64, now: &Flatness) -> Option<FlowStatus> {
        self.factors.push(self.factor);
        if !self.looks_for_an_end() {
            return None;
        }
        let gain = now.flat_share - self.flat_share_now();
        self.time += 1.0 / self.factor;
        self.flat.push(now.flat_share);
        if self.plan.is_some() {
            return self.planned();
        }
        let is_far = self.movement.is_some_and(|wanted| moved >= NEAR * wanted);
        let is_flat_enough = self.flat_share.is_some_and(|wanted| now.flat_share >= wanted && gain < FORMING);
        if is_far || is_flat_enough {
            return Some(FlowStatus::Reached);
        }
        if self.is_flat(now) || self.has_settled() {
            return Some(FlowStatus::Settled);
        }
        let power = self.last.map_or(USUAL_GROWTH, |(time, before)| {
            if before > 0.0 && moved > before {
                ((moved / before).ln() / (self.time / time).ln()).clamp(0.05, 1.0)
            } else {
                USUAL_GROWTH
            }
        });
        // A tenth at the least: otherwise a wrong guess of the growth would end in ever smaller steps.
        let growth = match self.movement {
            Some(wanted) if moved > 0.0 => (wanted / moved).powf(1.0 / power).clamp(1.1, 2.0),
            _ => 2.0,
        };
        self.factor = 1.0 / (self.time * (growth - 1.0));
        self.last = Some((self.time, moved));
        None
    }

    fn has_settled(&self) -> bool {
        let n = self.flat.len();
        let most = self.flat.iter().copied().fold(0.0, f64::max);
        n > 3 && most - self.flat[0] > BEGUN && self.flat[n - 1] - self.flat[n - 3] < SETTLED
    }
}
