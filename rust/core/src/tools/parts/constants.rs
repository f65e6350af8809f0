//! What is a part: every threshold, with its reason. Lengths are parts of the square root of the area.
//!
//! Where figures stand, they are Rand errors (× 100, less is better) on 48 shapes of the Princeton
//! Segmentation Benchmark, those of the count on 190.

// Faces of any mesh.

/// Faces without area take this part of the whole, so that every face has a place.
pub(super) const LEAST_AREA: f64 = 1e-9;

/// The residual, relative; and the most iterations, which take some twenty, and a hundred where most faces
/// carry no mass.
pub(super) const DIFFUSION_RESIDUAL: f64 = 1e-4;
pub(super) const MOST_ITERATIONS: usize = 300;

// What a border costs, in units of the square root of the area.

/// Normals are smoothed over, and bends measured on, this part of the square root of the area: 0.03 blurs
/// fingers away (Rand error 11.9 against 11.3 on a quarter of the shapes of the Princeton benchmark).
pub(super) const BEND_SCALE: f64 = 0.02;

/// A hollow that bends by this over its scale costs a third of a flat border, in radians; 0.3 finds fewer
/// joints (12.7 against 11.3).
pub(super) const BEND_OF_A_THIRD: f64 = 0.15;

/// Of a bend between faces farther apart than the scale that share counts which falls to it, so that coarse
/// meshes of smooth shapes have no more hollows than fine ones; but at least this part, since large faces of
/// modeled shapes meet in edges.
pub(super) const LEAST_SHARE: f64 = 0.2;

/// The thickness is smoothed over, and its change measured on, this.
pub(super) const THICKNESS_SCALE: f64 = 0.03;

/// A change of the logarithm of the thickness by this over its scale costs a third as well. Without it
/// smooth joints of fish, birds and four-legged animals are missed (10.9 against 10.6).
pub(super) const CHANGE_OF_A_THIRD: f64 = 0.5;

/// The least that a border costs, so that short ones win among hollows: 0.01 and 0.2 are worse (14.1 and
/// 11.8 against 10.9).
pub(super) const HOLLOW: f64 = 0.1;

// Looking inside.

/// Rays within 60 degrees of the normal, spread evenly over that cone.
pub(super) const RAYS: usize = 16;
pub(super) const LEAST_COSINE: f64 = 0.5;

/// Rays start this far inside, in parts of the square root of the area.
pub(super) const RAY_START: f64 = 1e-4;

/// Fewer rays than this part that leave the shape from inside give no thickness: an open sheet has none.
pub(super) const LEAST_RAYS: f64 = 0.25;

/// So many faces at equal steps of area are looked under; the thickness is smoothed over more than lies
/// between them.
pub(super) const SAMPLES: usize = 4000;

/// The mass of faces that were not looked under, against that of those which were: they follow their
/// neighbors.
pub(super) const UNSEEN: f64 = 1e-3;

/// Costs and distances below this part of the shape's size are rounding: edges of degenerate faces.
pub(super) const ROUNDING: f64 = 1e-9;

// Gaps.

/// From a large piece so many of its faces look for what is near.
pub(super) const LOOKOUTS: usize = 200;

// Clusters.

/// So many clusters of equal area: a limb of a hundredth of the area has thirty.
pub(super) const CLUSTERS: usize = 3000;

/// Meshes of up to this many times as many faces are taken as they are.
pub(super) const AS_IT_IS: f64 = 1.5;

/// Rounds of moving seeds into the middle of their clusters (Lloyd 1982).
pub(super) const CENTERINGS: usize = 2;

/// How much farther a step across the dearest hollow is, so that clusters end there.
pub(super) const LEAST_OPENNESS: f64 = 1e-3;

// Dividing.

/// Nothing smaller than this part of the shape is a part of its own: a disk as wide as the scale to both
/// sides of its middle. What is less has no border that was judged apart from it: dents of the noise looked
/// like parts, and took the place of others (Rand error at the usual count 10.8 with 3e-4, 10.6 with this,
/// 10.9 with twice as much; as found it is the same). Of what people name 2.5 percent are smaller.
pub(super) const LEAST_PART: f64 = std::f64::consts::PI * BEND_SCALE * BEND_SCALE;

/// Nor what has fewer faces, three sides of a box: by the area alone, 16 and 32 parts of a hand and a cow of
/// 1,600 faces had crumbs of two faces. On 190 shapes the error as found is 10.40 instead of 10.41, at the
/// usual count 10.83 instead of 10.82.
pub(super) const LEAST_FACES: u32 = 6;

/// So many parts the finest division has, unless more are asked for.
pub(super) const MOST_PARTS: usize = 40;

// Cuts.

/// The cost of a cut falls with the area of the smaller side to this power: 0.5 would make it free of
/// scale and take fingertips before arms (Rand error at the usual count 18.8 against 12.6 on half of the
/// shapes); 0.8 gains nothing.
pub(super) const AREA_POWER: f64 = 0.7;

/// A cut costs a third where the smaller side is thinner than the rest by this on the mean, in logarithms: a
/// wing and a body are two parts however softly they meet. A side that is thicker is none for that: the end
/// of a limb is, seen from its tip.
pub(super) const STEP: f64 = 1.0;

/// Eigenfunctions that are swept: more find no better cuts at a part's first division, and later ones have
/// their own.
pub(super) const FUNCTIONS: usize = 4;

/// How exact they need to be: their level sets are only where a cut starts.
pub(super) const FUNCTION_ACCURACY: f64 = 1e-3;

/// Cheapest levels of each that are looked at, apart by [`LEVELS_APART`] of the smaller side.
pub(super) const LEVELS: usize = 3;
pub(super) const LEVELS_APART: f64 = 0.08;

/// So many of all cuts found are drawn tight; two that differ in less than [`SAME_CUT`] of the part are
/// one.
pub(super) const TIGHTENED: usize = 4;
pub(super) const SAME_CUT: f64 = 0.02;

/// Parts of fewer patches are not divided.
pub(super) const LEAST_PATCHES: usize = 6;

/// The band reaches this part of the smaller side's size to both sides.
pub(super) const BAND: f64 = 0.25;

/// At most so many times in a row.
pub(super) const TIGHTENINGS: usize = 2;

// Borders and count.

/// A border moves within so many clusters' widths: they end where the border between faces might as well
/// lie.
pub(super) const CLUSTERS_WIDE: f64 = 2.0;

/// A cut is made at first up to this cost at a coarseness of 1: `length / area^0.7` of a shape of area 1. As
/// found, limits of 1.1 and 1.25 come out the same (10.4), and 1.4 is worse (10.7).
pub(super) const COST: f64 = 1.25;

/// The cost at which as many people see two parts of a whole shape as one, at a coarseness of 1 and without
/// hollows: 1.7, 1.8, 1.9, 2.0, and 2.1 give 10.33, 10.30, 10.28, 10.33, and 10.56 as found.
pub(super) const EVEN_COST: f64 = 1.9;

/// Of a shape with hollows everywhere it is less, with what a border costs there at an average place to this
/// power: a hollow says little where there are many. The first power would do where cuts ran anywhere, but
/// they run where it is hollow most. Without it 10.40 at best; 1 and 3 give 10.29 and 10.32.
pub(super) const USUAL_POWER: f64 = 2.0;

/// Of a part it is less, with its area to this power: people name no parts of what is small. With 0.1 the
/// error is 10.40 and there are 8.2 parts, with 0.3 it is 10.27 and there are 7.0, with this 7.5; people give
/// 7.3.
pub(super) const WHOLE_POWER: f64 = 0.2;

/// A border is seen if hollows and steps save a tenth of its length. The error with any part from 0.05 to
/// 0.15 is the same.
pub(super) const UNSEEN_BORDER: f64 = 0.9;

/// One that is not costs so many times as much: else a cylinder of eight diameters is cut in two, one of
/// twenty in four. The error is the same from 4 to 6.
pub(super) const UNSEEN_COST: f64 = 4.0;

/// The count is what most limits between this much less and more give: limbs that are alike then come and
/// go together, and a little noise or another density changes no count. The error is the same from 1.1 to
/// 1.3, and without.
pub(super) const PLAY: f64 = 1.15;

/// So many limits to both sides: two percent apart.
pub(super) const PLAY_STEPS: usize = 7;
