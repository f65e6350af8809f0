//! How holes are filled: every threshold, with its reason.

use crate::limits::Limits;

// Smooth or sharp.

/// The flow's stencil takes two rings; planes are fitted over five.
pub(super) const REGION_RINGS: usize = 5;

/// Patch edges bent by more than this (radians) are ridges: 30 degrees, as Blender's own "smooth by
/// angle".
pub(super) const MARKED_ANGLE: f64 = std::f64::consts::PI / 6.0;

/// Edges bent by more than this (radians) can be ridges: 25 degrees. Irregular meshes of a cylinder of 36
/// edges around reach 20.
pub(super) const LEAST_RIDGE_ANGLE: f64 = 0.44;

/// A ridge is bent by so many times the root mean square of what remains without the ridges.
pub(super) const CONTRAST: f64 = 3.0;

// The order of the passes.

/// Rounds of the smooth start: the third moves the patch by a hundredth of an edge.
pub(super) const SMOOTH_ROUNDS: usize = 3;

/// Sharpness where the surroundings are sharp: with less, a cube's corner is cut off, since the plain
/// energy prefers it so.
pub(super) const SHARP: f64 = 0.8;

/// Flow steps in a cycle, and the cycle from which on vertices snap: before, no face is on its plane yet.
pub(super) const FLOW_STEPS: usize = 3;
pub(super) const SNAP_FROM: usize = 3;
pub(super) const SNAPS: usize = 2;

/// Cycles before the parts around the hole are extended into it; where they do not meet, it is tried again
/// each time the cycles have doubled.
pub(super) const EXTEND_AFTER: usize = 2;

/// Every so many cycles the patch is remeshed: snapping crowds vertices on ridges, and ridges stretch the
/// patch.
pub(super) const RESAMPLE_EVERY: usize = 4;
pub(super) const RESAMPLE_ROUNDS: usize = 2;

/// Edges of the patch bent by more than this part of the ridges around the hole are ridges; where those
/// are unknown, as if they were bent by 1 radian.
pub(super) const RIDGE_SHARE: f64 = 0.6;

/// Faces that a patch has at most, about, while its ridges form: where it would have more, its edges grow
/// with their distance from the rim, and become as short as they may be at the end.
pub(super) const COARSE_FACES: usize = 8000;
pub(super) const FINE_FACES: usize = 40_000;
pub(super) const FINE_ROUNDS: usize = 4;

/// Rounds that make the parts between ridges smooth, and steps in each; the metric of each step is that
/// after the one before.
pub(super) const FAIR_ROUNDS: usize = 3;
pub(super) const FAIR_STEPS: usize = 2;

/// Sweeps over a patch that flip edges or shorten borders between parts at most; they end by themselves after
/// three or four.
pub(super) const SWEEPS: usize = 10;

/// A patch whose vertices all moved by less than this part of its mean edge in a cycle rests.
pub(super) const STILL_CYCLE: f64 = 1e-3;

/// Ridges of which the most bent one is bent by no more than so many times the least bent one are of one
/// kind.
pub(super) const ALIKE: f64 = 1.2;

/// A ridge gathers the bend that a smooth patch spreads. A patch that is bent in all by more than so many
/// times as much has folds that nothing around it asks for: in holes of six meshes, 10 of 13 patches
/// below it were nearer to the truth than the smooth ones, and 3 of 22 above.
pub(super) const MOST_BEND: f64 = 1.35;

// The flow and the flips.

/// Iterations of the solver in a step that is certified to no tolerance. Most steps take 30 to 100; on
/// patches whose edges grow a hundredfold a thousand, which move them no closer to the ridges: a corner
/// with a loop of 5000 vertices came back alike in half of the time.
pub(super) const SOLVER_ITERATIONS: usize = 150;

/// Costs that differ by less than this angle (radians) along an edge are equal.
pub(super) const EVEN_ANGLE: f64 = 0.01;

/// Moves onto ridges may squeeze faces, which remeshing will mend, to this part of their quality: with 1 a
/// concave edge came back 0.055 off instead of exactly.
pub(super) const KEPT: f64 = 0.75;

/// Moves make no bend of more than this cosine (137 degrees) sharper. Below what counts as folded: flips and
/// remeshing sharpen a ridge further.
pub(super) const MOVED_BEND: f64 = -0.7374;

// The parts around a hole.

/// Faces count less the more rings they are away from the hole: a Gaussian of this width.
pub(super) const PART_WIDTH: f64 = 3.0;

/// A part that no surface of ours fits better than to this part of an edge is none that we know how to go
/// on.
pub(super) const WORST_FIT: f64 = 0.3;

/// A point is on a surface if it is no farther from it than this part of an edge, beyond what it misses
/// its own points by.
pub(super) const NEAR_PART: f64 = 0.1;

/// The pull of the quadratic terms to zero, relative to what they explain: it decides where few points do
/// not.
pub(super) const BENT_STIFFNESS: f64 = 1e-4;

/// A part is flat if a plane misses its vertices by no more than this part of an edge, or no more than
/// this many times what the quadratic misses: noise.
pub(super) const FLAT: f64 = 0.01;
pub(super) const AS_GOOD: f64 = 1.5;

/// How much more the distance of a vertex on the rim counts, which will stay where it is.
pub(super) const FIXED_WEIGHT: f64 = 10.0;

/// What a border counts along edges of the rim where the two parts meet: without favor, faces between it
/// and a border beside it would have no area.
pub(super) const RIM_BORDER_COST: f64 = 0.5;

// Where the parts meet.

/// Rounds of assigning faces to parts, moving vertices onto them and remeshing. A patch rests whose vertices
/// all moved by less than this part of an edge.
pub(super) const EXTENDING: Limits = Limits { steps: 12, rest: 1e-6 };

/// The round from which on folds are opened that did not open by themselves; most patches rest before.
pub(super) const UNTANGLE_FROM: usize = 6;

/// Passes over the vertices in a round: a vertex finds room once its neighbors have moved.
pub(super) const SETTLE_PASSES: usize = 3;

/// A corner this near to another one, in edges, is the same.
pub(super) const CLOSE_CORNERS: f64 = 0.4;

/// How often triangles are cut before the faces are assigned anew.
pub(super) const CUTS: usize = 3;

/// A patch whose faces all lie on their surfaces is done if none is thinner: along a ridge that meets the
/// rim at a slant, faces between fixed vertices are as thin as the rim has them.
pub(super) const ARRIVED_SLIVER: f64 = 0.02;

/// Newton steps onto the surfaces: for planes one is enough.
pub(super) const NEWTON_STEPS: usize = 5;

/// Eigenvalues under this part of the largest are dropped: surfaces that meet at less than some twelve
/// degrees have no line.
pub(super) const DROPPED_EIGENVALUES: f64 = 0.01;

/// Rings around a fold that make room for it.
pub(super) const UNTANGLE_RINGS: usize = 3;

/// Passes of averaging: a fold of a few faces is open after ten.
pub(super) const UNTANGLE_PASSES: usize = 30;

// What is smooth in the end.

/// How much the third derivative along ridges counts beside the second ones of the surfaces, in units of
/// the patch's size: a ridge that bends is then shaped by its own ends, not by the surfaces, which would
/// rather be flat.
pub(super) const RIDGE_STIFFNESS: f64 = 100.0;

// In order or not.

/// A face passes through another if it reaches so far through it, in its edges. Faces that fill one plane, of
/// a box off by 1e-7, overlap by 4e-5; of 1105 other pairs in sharp patches of 337 open boxes and cut
/// shapes, one reaches less far.
pub(super) const DEEP: f64 = 1e-4;
