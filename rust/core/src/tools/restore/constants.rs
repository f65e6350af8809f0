//! The thresholds of restoring, with their reasons.

use crate::limits::Limits;

/// How far a vertex may move: so many standard deviations of the noise, which it is off by once in sixteen
/// thousand times in each coordinate, and this part of a mean edge, as borders that run along the mesh are
/// off the curve where the surfaces meet.
pub(super) const MOST_MOVE: [f64; 2] = [4.0, 0.5];

/// Vertices nearer to each other than this part of a mean edge would make a triangle vanish:
/// one of them takes the corner.
pub(super) const SAME_PLACE: f64 = 0.1;

/// Rounds of relaxing at most. Folds of noise up to 0.3 of an edge are gone after five to thirty.
pub(super) const MOST_ROUNDS: usize = 200;

/// Steps of the flow for free pieces at most; each doubles the time of the flow, so ten are a thousandfold.
pub(super) const FLOW_STEPS: usize = 12;

/// The fidelity of its first step, on a surface of area 1:
/// it moves a scan of ten thousand vertices by a fraction of its noise.
pub(super) const FLOW_FIDELITY: f64 = 1e7;

/// Newton's steps that turn axes, and such that shift surfaces. Both rest at rounding: that of unit vectors
/// for turns, that of places in the unit of the shape for shifts.
pub(super) const TURNS: Limits = Limits { steps: 20, rest: 1e-15 };
pub(super) const SHIFTS: Limits = Limits { steps: 20, rest: 1e-14 };

/// A surface is shifted along what its points determine: along the axis of a cylinder nothing does, and what
/// rounding leaves there is less than this part of the largest eigenvalue.
pub(super) const UNDETERMINED: f64 = 1e-6;

/// A sliver of the mesh is in order as long as it keeps this part of its quality: rounding thins the fan of
/// slivers that a flat cap may be made of, and so it would be relaxed.
pub(super) const THINNED: f64 = 0.9;
