//! What keeps triangles in shape wherever vertices move, edges flip or edges collapse: how thin a face may be, how far it may
//! turn, how sharply it may fold.
//!
//! One limit each would be best. Turning has one. Thinness and folding do not: a limit that remeshing can keep would stop moves
//! onto ridges, and one that lets those through would let remeshing make slivers. Each that differs says what it is for; they
//! are the values with which the tables of holes were measured.

/// The least cosine between a face's normal and what it was before an edit, or what its surface asks for: 60 degrees. A fold
/// turns it by more than 90; a chamfer that becomes part of a ridge turns by half the ridge's angle, at most 45.
pub const TURNED: f64 = 0.5;

/// The same for a patch that has reached its surfaces, where nothing is to turn any more: 45 degrees.
pub const ARRIVED_TURNED: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// An edit that turns no face by more than this (11 degrees) makes no fold, and need not be looked at for bends.
pub const HARDLY_TURNED: f64 = 0.98;

/// Faces of less quality ([`crate::mesh::vector::quality`]) than this count as slivers: a triangle whose height is 0.09 of its
/// longest edge. An edit may make one only if that is better than the worst face before.
pub const SLIVER: f64 = 0.2;

/// Moves onto ridges squeeze faces that remeshing will mend: a face keeps this quality, or [`KEPT`] of its own where it had less.
pub const MOVED_SLIVER: f64 = 0.15;
/// See [`MOVED_SLIVER`].
pub const KEPT: f64 = 0.75;

/// Flips along ridges make no triangle of less quality: its height would be a twentieth of its longest edge.
pub const FLIPPED_SLIVER: f64 = 0.1;

/// A patch whose faces all lie on their surfaces is done if none is thinner: along a ridge that meets the rim at a slant, faces
/// between fixed vertices are as thin as the rim has them.
pub const ARRIVED_SLIVER: f64 = 0.02;

/// A dihedral angle above this (137 degrees, in radians) must not grow where a patch moves.
pub const FOLD_ANGLE: f64 = 2.4;

/// A patch with a bend beyond this cosine (154 degrees) is folded, unless its smooth start or its rim had such a bend: the last
/// one without is taken. Sharper than what must not grow, since ridges of 140 degrees are real.
pub const FOLDED: f64 = -0.9;

/// Edges whose faces turn by more than this (40 degrees) carry shape and are not flipped for better valences.
pub const RIDGE: f64 = 0.766;

/// Where a whole move would break one of these, its half and its quarter are tried.
pub const PARTS_OF_A_MOVE: [f64; 3] = [1.0, 0.5, 0.25];
