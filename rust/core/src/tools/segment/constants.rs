//! How segments are told apart: every threshold of the segmentation, with its reason.

use crate::limits::Limits;
use crate::tools::Scale;

// Noise and the functional (41).

/// `ε` below this many mean edges makes the indicator rise again everywhere: no row of faces is narrow
/// enough for it.
pub(super) const LEAST_EPSILON: f64 = 0.35;

/// The unit in which the weights of a segmentation are meant unless the caller says otherwise.
pub(super) const DEFAULT_SCALE: Scale = Scale::Extent;

/// The paper's `α`, which is right for data without noise.
pub(super) const CLEAN_FIDELITY: f64 = 1000.0;

/// Alternations for one `ε` at most.
pub(super) const MOST_ALTERNATIONS: usize = 30;

/// Weights `v²` of the conic program are held above this, so that no face is wholly free.
pub(super) const LEAST_WEIGHT: f64 = 1e-6;

/// Solutions that look for the fidelity that leaves the noise; they rest where the remainder misses it by no
/// more than this part.
pub(super) const NOISE_SEARCH: Limits = Limits { steps: 8, rest: 0.1 };

/// The remainder grows with the fidelity to this power, measured on noisy cubes: the exponent of the
/// search.
pub(super) const NOISE_POWER: f64 = 1.5;

// Shapes that were modeled, not measured.

/// Far from the origin coordinates are off by this part of the largest: twice what single precision rounds
/// by.
pub(super) const SINGLE_PRECISION: f64 = 2.4e-7;

/// Two faces never count as one plane if their unit normals differ by more, however thin they are.
pub(super) const MOST_TURN_IN_A_PLANE: f64 = 0.02;

/// A face of less height than so many roundings has no normal to speak of.
pub(super) const SLIVER_ROUNDINGS: f64 = 50.0;

/// A modeled mesh has flat polygons of more than three corners: at least this share of its edges is flat
/// (a third where all are quads). Of noisy or smooth surfaces hardly any is.
pub(super) const FLAT_SHARE: f64 = 0.2;

/// Below so many faces, noise cannot be told from shape, and the shape is taken as it is.
pub(super) const FEW_FACES: usize = 100;

/// A side with fewer faces away from its border than this is too coarse for the Hessian: four by four
/// quads have sixteen and are found.
pub(super) const LEAST_INSIDE: usize = 16;

// Faces on spheres, cylinders, cones and tori, of exact shapes.

/// Kernels put no vertex inside a plane. A mesh with more than this part of its vertices there is remeshed or
/// subdivided.
pub(super) const MOST_INSIDE: f64 = 0.1;

/// Two facets of a sphere or torus turn by no more than this from one to the other: kernels make small
/// fillets of corners two facets wide (eight a turn). Cylinders and cones bend less than the sides of prisms.
pub(super) const MOST_BEND_ON_A_SURFACE: f64 = 0.8;

/// The normal of a facet turns from those of its surface in its corners by no more, half of that in both
/// directions (radians), and its middle rises over the surface by no more than this part of its size, as an
/// arc of eight does over its chord: the disk within the circle where a torus touches it rises by more.
pub(super) const MOST_TILT: f64 = 0.6;
pub(super) const MOST_RISE: f64 = 0.1;

/// A surface to begin with is off the facets that it is made of by no more than this part of their size: the
/// fit would not come close.
pub(super) const NEAR: f64 = 0.02;

/// Vertices on a surface that is not exact yet may be off by so many roundings, the most with which all are
/// on it once it is fitted to them: what is known from a few facets is off as much where it has doubled.
pub(super) const SLACKS: [f64; 3] = [64.0, 8.0, 1.0];

/// What kernels make as balls by turning arcs is none by some roundings (hemispheres of a capsule: eight),
/// and vertices inside say enough.
pub(super) const LOOSE_SPHERE: f64 = 10.0;

/// Coincidences that are more than chance. One is not: two strips through three points of a circle that are
/// tangent to one plane.
pub(super) const LEAST_EVIDENCE: i64 = 2;

/// Angles that differ by less are those of one row of vertices; finest tessellations turn by fifty times
/// that.
pub(super) const ROW_GAP: f64 = 1e-3;

/// An edge that leaves a surface with this slope is tangent to it: known radii are exact to a tenth of that,
/// and chords of a fine tessellation rise by sixty times that.
pub(super) const TANGENT_RISE: f64 = 1e-3;

/// What goes on smoothly beside a surface is off it by more than so many roundings. Surfaces that lie on
/// nothing by more than chance end by one to twenty, true ones by 250 and more.
pub(super) const CLEAR_STOP: f64 = 30.0;

/// Normals of tangent surfaces differ by less where they meet: by a tenth on parts.
pub(super) const BLUNT: f64 = 0.01;

/// A ring between two rows of a turned surface goes on where it bends by less: chamfers bend by 0.76.
pub(super) const MOST_BEND_ALONG_A_ROW: f64 = 0.6;

/// Strips of one cone turn alike to this part of their bend.
pub(super) const ALIKE_BENDS: f64 = 0.1;

/// Cylinders and cones of triangles without a pattern begin with so many facets.
pub(super) const FACETS_OF_A_START: [usize; 2] = [4, 7];

/// Curved facets that are looked at first, and the part of them that must be on some surface, and of all
/// facets in the end: of parts with faces of another kind (lofts, text) or scans hardly any is, of others
/// nearly all.
pub(super) const SAMPLED_EDGES: usize = 400;
pub(super) const LEAST_COVERED_OF_SAMPLE: f64 = 0.25;
pub(super) const LEAST_COVERED: f64 = 0.5;

// The order of the passes.

/// Two basins of the indicator stay apart if the pass between them lies deeper than this. Low, since
/// borders that are none are found by their bend later: 0.05 loses sides of coarse cubes under noise,
/// 0.01 leaves basins too small to measure.
pub(super) const PERSISTENCE: f64 = 0.03;

/// A border stands if it bends by more than this share of the length weight.
pub(super) const BEND: f64 = 0.8;

/// Shares of that bend up to which borders fall before each relabeling: with cleaner borders the later ones
/// are measured better.
pub(super) const BEND_SHARES: [f64; 4] = [0.4, 0.7, 1.0, 1.0];

/// The paper's least number of faces, and the noise, in mean edges, from which it is needed.
pub(super) const MOST_LEAST_FACES: f64 = 20.0;
pub(super) const NOISY: f64 = 0.1;

// The bend across borders.

/// How far, in mean edges, the gradient is averaged on either side, longer the more noise there is in
/// mean edges, up to a limit: on the coarsest noisy shapes a limit of 3 finds more parts than 2.5, 3.5 or
/// 5.
pub(super) const REACH: f64 = 2.5;
pub(super) const REACH_OF_NOISE: f64 = 10.0;
pub(super) const MOST_REACH: f64 = 3.0;

/// On a shape at least as far as this part of the square root of its area, as on a mesh of 2000 vertices: so
/// a ridge as wide bends by the same at any density. With 0.7 of it rounded ridges are lost on fine
/// meshes, with 1.4 times it coarse meshes, which cannot see as far, have fewer segments than fine ones.
pub(super) const REACH_ON_A_SHAPE: f64 = 0.06;

/// But not over more mean edges than this: as many as that is on the finest mesh that is segmented itself,
/// twice [`crate::tools::options::ENOUGH`].
pub(super) const MOST_REACH_ON_A_SHAPE: f64 = 7.5;

/// A border that is a smaller part of the smaller segment's perimeter counts as stronger in proportion:
/// where two segments touch at a corner only, a few edges say nothing.
pub(super) const LEAST_CONTACT: f64 = 0.25;

/// A step in the values counts as two bends, up and down over one edge; a step of positions would be a
/// crack, which a mesh has not.
pub(super) const BENDS_OF_A_STEP: f64 = 2.0;

/// Standard deviations of a step that noise alone may make.
pub(super) const STEP_DOUBT: f64 = 3.0;

/// How far gradients, and unit normals, of single faces stray for each mean edge of noise (measured on
/// noisy cubes).
pub(super) const STRAY_OF_NOISE: f64 = 2.0;

/// Curvature explains part of a bend if what it explains is known better than this, half of the bend at
/// which borders stand by default. Less, or demanding that it be significant, cuts the side of a coarse
/// noisy cylinder into strips.
pub(super) const MOST_SLOPE_ERROR: f64 = 0.2;

/// Shares of the threshold up to which borders fall before all are measured again: a small segment's
/// neighborhood says little until it has grown.
pub(super) const MERGE_SHARES: [f64; 6] = [0.2, 0.4, 0.6, 0.8, 1.0, 1.0];

// Planes and patches.

/// Faces of a segment that a local fit looks at: few where the surface is clean and may be curved, more
/// where noise has to be averaged out; as many more for each mean edge of noise, up to a limit.
pub(super) const NEARBY: f64 = 20.0;
pub(super) const NEARBY_OF_NOISE: f64 = 400.0;
pub(super) const MOST_NEARBY: f64 = 60.0;

/// Weight of the pull of the quadratic terms to zero, in squared lengths of the fitted patch: it decides
/// where few faces do not.
pub(super) const PATCH_STIFFNESS: f64 = 1e-3;

/// Both parts of a divided segment must have so many faces.
pub(super) const LEAST_PART: usize = 8;

/// Fits and assignments in turns, of planes and of patches; they settle after three to five.
pub(super) const DIVIDE_TURNS: [usize; 2] = [8, 4];

/// A segment at a corner lies on three planes: divided once, and its parts again.
pub(super) const DIVIDE_ROUNDS: usize = 2;

/// The logarithm of the ratio of likelihoods that two planes, or patches with more coefficients, must
/// have. A quarter of it finds the same parts of known shapes, but takes steps in the walls of scanned
/// buildings for parts.
pub(super) const EVIDENCE_TO_DIVIDE: [f64; 2] = [40.0, 60.0];

/// Two patches that explain a small segment and what lies around it better than one, by more than this
/// logarithm of likelihoods, are two.
pub(super) const EVIDENCE_TO_KEEP: f64 = 10.0;

/// So many faces around a small segment, or as many as it has, say how its neighbor would go on.
pub(super) const LEAST_AROUND: usize = 20;

/// A speck inside one plane was found because it lies off that plane, by chance or at slivers that noise
/// has folded over: it may lie off by this much more.
pub(super) const SPECK_TOLERANCE: f64 = 2.0;

// Where borders run.

/// Rounds of fits, and sweeps over the faces with the fits of a round.
pub(super) const RELABEL_ROUNDS: usize = 6;
pub(super) const RELABEL_SWEEPS: usize = 12;

/// A segment counts as plane if it is off its plane by no more than this many times the noise, or this
/// part of an edge.
pub(super) const PLANE_NOISE: f64 = 1.5;
pub(super) const PLANE_EDGE: f64 = 0.02;

/// The least noise to reckon with, in mean edges for shapes and in the range of other signals: fits near
/// curved borders are off by as much, and with less, borders on scans and characters have teeth.
pub(super) const LEAST_NOISE: f64 = 0.1;
pub(super) const LEAST_NOISE_OF_VALUES: f64 = 0.02;

/// The most that one corner's misfit costs: a spike does not decide alone.
pub(super) const MOST_MISFIT: f64 = 12.0;

/// How far unit normals of faces stray in any case, beside what noise adds ([`STRAY_OF_NOISE`]).
pub(super) const LEAST_TURN: f64 = 0.15;

/// What a mean edge of border costs, in the units of the misfit: 1.5 and more leave fewer teeth on
/// characters, but lose a side of a noisy dodecahedron.
pub(super) const EDGE_COST: f64 = 1.0;

/// How many rows of faces on either side of a border may change sides.
pub(super) const BAND_ROWS: usize = 4;

/// What a bend over a ridge counts against the same bend in a hollow.
pub(super) const BEND_OVER_A_RIDGE: f64 = 0.5;

/// Passes over all borders: where three segments meet, the second pass sees what the first has done.
pub(super) const STRAIGHTEN_PASSES: usize = 2;

// Regions between clear ridges.

/// Noise of more than this part of a mean edge hides which edges are ridges: up to it the reveals of windows
/// one edge deep are found to the face (of four walls and houses, 0.075 comes out as 0.08 to 0.09), and with
/// 0.1 faces at blunt ridges go astray (dodecahedron).
pub(super) const MOST_REGION_NOISE: f64 = 0.09;

/// Normals are averaged over neighbors whose normals differ by about this, in so many rounds: noise of 0.05
/// of an edge turns neighbors by 0.15, and a quarter of that is left.
pub(super) const ALIKE_NORMALS: f64 = 0.35;
pub(super) const NORMAL_ROUNDS: usize = 3;

/// Faces are of one region if their averaged normals differ by less.
pub(super) const ONE_SIDE: f64 = 0.2;

/// Regions are joined where the averaged normals turn by less than this along their border: the sides of
/// prisms that stand for cylinders are no regions, from ten sides on.
pub(super) const CLEAR_RIDGE: f64 = 0.6;

/// At most this part of the length of clear ridges lies inside regions, which does not close: of eight built
/// shapes under noise of up to 0.075 it was 0.011 at most, of seven characters 0.22 at least.
pub(super) const MOST_OPEN_RIDGES: f64 = 0.05;

// Fillets and bevels.

/// A fillet or bevel lies between two of so many neighbors, those with the longest borders.
pub(super) const NEIGHBORS_OF_A_BLEND: usize = 4;

/// Its borders with both are about as long: the shorter one this part of the other.
pub(super) const LEAST_AS_LONG: f64 = 0.4;

/// The borders of a bevel, which has most of its turn there, are as long as this part of its width: the slope
/// of a rib lies across the ridge of what it holds.
pub(super) const LEAST_LONG: f64 = 0.5;

/// It turns to one side: nowhere back by more than this part of its turn.
pub(super) const AGAINST: f64 = 0.25;

/// Over so many times its width, its neighbors turn by less than this part of what it turns by.
pub(super) const BESIDE_A_BLEND: f64 = 2.0;
pub(super) const MOST_BESIDE: f64 = 0.5;

/// Borders run in teeth one edge wide, which so many means of neighbors leave a sixth of.
pub(super) const ROUNDS_OF_BORDERS: usize = 4;

/// Surfaces are told with this part of a mean edge as noise at least: chords of a tessellation that was
/// remeshed are off its surfaces by a hundredth. Of 44 remeshed parts 34 are right, 24 without it.
pub(super) const LEAST_SIGMA: f64 = 0.02;

/// A piece of no surface has as many faces as a surface begins with.
pub(super) const LEAST_FREE: usize = 24;
