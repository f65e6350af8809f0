//! Every number that fits and meetings of surfaces depend on, with its reason.

use crate::limits::Limits;

/// The most that one point's misfit counts: noise is off by more than 3.5 standard deviations once in two
/// thousand points, and what is off by more belongs to something else.
pub const MOST_MISFIT: f64 = 6.0;

/// Starts that are followed to the end, the best of some twenty: the median distance that ranks them is blind
/// to which of two close ones has the better end.
pub(super) const FOLLOWED: usize = 3;

/// Steps of a fit, which rests after five to fifteen: where one lowers the cost by no more than this part of
/// it.
pub(super) const FIT: Limits = Limits { steps: 30, rest: 1e-10 };

/// No radius is larger than this many times the size of what is fitted: beyond,
/// the surface is a plane as far as doubles tell.
pub(super) const LARGEST: f64 = 1e4;

/// Where the weights of Geman and McClure have fallen to a quarter, in standard deviations: as far as
/// [`MOST_MISFIT`] reaches.
pub(super) const TAIL: f64 = 3.5;

/// A normal distribution has its median distance at this part of a standard deviation.
pub(super) const QUARTILE: f64 = 0.674;

/// The damping of Levenberg and Marquardt at first, as a part of the largest eigenvalue; it changes by tens,
/// and beyond the second no step is left that gains anything.
pub(super) const DAMPING: [f64; 2] = [1e-4, 1e6];

/// The least of it: less makes no difference in double precision.
pub(super) const LEAST_DAMPING: f64 = 1e-12;

/// Steps of a fit to points that are exact, which starts close by: they double the digits. It rests where one
/// lowers the sum of squares by no more than this part.
pub(super) const THROUGH: Limits = Limits { steps: 16, rest: 0.1 };

/// Its least damping, where a step without went too far.
pub(super) const LEAST_THROUGH: f64 = 1e-8;

/// What the equations of a fit leave open, as turning a sphere, has eigenvalues below this part of the
/// largest, as rounding has them.
pub(super) const UNDETERMINED: f64 = 1e-13;

/// Surfaces whose normals differ by less than about four degrees count as tangent: they do not say where
/// along the normals' bisecting plane a point lies. That is the ratio of the eigenvalues, `tan²(θ / 2)`.
pub const TANGENT: f64 = 1e-3;

/// Newton's steps toward a meeting; five do for a part's surfaces. They rest where one is as short as
/// rounding has it, as a part of how far the point is.
pub(super) const MEETING: Limits = Limits { steps: 20, rest: 1e-13 };

/// So many points are enough for a median that starts are ranked by and widths begin with:
/// it is off by a twenty-fifth of a standard deviation.
pub(super) const ENOUGH: usize = 400;
