//! How painted colors become curves: every threshold, with its reason.

use crate::limits::Limits;

// Regions.

/// What lies around a neighbor with more neighbors or regions than this is not near: where 2,000 faces meet
/// at one edge every vertex would be compared with all of them, 15 s.
pub(super) const HUB: usize = 256;

/// What differs by less than this part of the range of the colors may be shading. A patch differs by more
/// from its region everywhere, and across its border; a vertex that differs by more from its region is a
/// blend or noise, and gets no face for itself; borders over which colors jump by more are kept untried.
pub(super) const SHADING: f64 = 0.1;

/// And by this many times what colors change over half of the edges, which is noise where it is much.
pub(super) const PAINT_NOISE: f64 = 4.0;

/// Rounds of moving borders at most, and sweeps that shorten them: each moves them by a row of faces;
/// segments are rarely off by more than two, and few sweeps follow a third.
pub(super) const REGION_ROUNDS: usize = 16;

/// Smaller islands are what moving borders leaves over, not paint.
pub(super) const LEAST_ISLAND: usize = 5;

/// A region must explain a vertex better than any other by this factor, and by what can be seen
/// ([`UNSEEN`]): a gentle change of color is no reason to move a border.
pub(super) const NEARER: f64 = 2.0;

/// The largest fidelity of the fit that tells where vertices belong: broad, so that vertices on the wrong
/// side cannot hide behind each other. It smooths over a fifth of a surface.
pub(super) const BROAD: f64 = 30.0;

/// A border must become shorter by this part of the edges that change, or two equal ones would change for
/// ever.
pub(super) const SHORTER_BY: f64 = 1e-9;

// Colors.

/// The least weight of an edge. Delaunay edges inside have weights from 0 up; only edges with one face
/// opposite an obtuse angle fall below, and those of flat right-angled cells are 0. A positive floor
/// keeps connected what is connected.
pub(super) const LEAST_WEIGHT: f64 = 1e-9;

/// On painted meshes the error of the rebuilt colors stays within 0.01 dB after some 20 products.
pub(super) const FIT: Limits = Limits { steps: 60, rest: 1e-4 };

/// Fits at most after the one without the vertices on curves. Where a region is so narrow that all its
/// vertices are on curves, the first owners come from a blend of its sides, and the second from its own
/// colors; more never changed anything.
pub(super) const MOST_FITS: usize = 3;

/// How much the squared error of two regions may grow when they become one, …
pub(super) const WORSE: f64 = 1.25;

/// … if it is larger than this part of the range of the colors: what is smaller is hard to tell side by
/// side (40 dB).
pub(super) const UNSEEN: f64 = 0.01;

/// Steps toward the nearest mixture of colors. Two colors need one, three at most some ten until the
/// rest is below what is tolerated.
pub(super) const MIXING_STEPS: usize = 32;

// Curves.

/// Steps toward the mean of the neighbors, half of the way each. Teeth of one edge are gone after five,
/// steps of lines that cross a lattice at a slant after twenty.
pub(super) const SMOOTH_STEPS: usize = 20;

/// How far a point leaves its vertex, in mean edges of the curves there: a border between vertices lies
/// up to half an edge away, and farther off, corners of the paint would be cut.
pub(super) const FARTHEST: f64 = 0.6;
