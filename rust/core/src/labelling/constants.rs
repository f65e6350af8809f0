//! Every number that the labelling depends on, with its reason.

/// What a vertex of a free piece costs: as if it were 1.5 standard deviations off. A surface that is off by
/// more than that, root mean square, is not sure: no noise is taken for a reason, and nothing is moved onto
/// it. The same ratio at which segments count as plane ([`crate::tools::segment`]).
pub const FREE_MISFIT: f64 = 1.125;

/// What a border costs for each mean edge of its length, beside the likelihoods of its two sides: as much as
/// a vertex that is 1.4 standard deviations off.
pub(super) const BORDER: f64 = 1.0;

/// Rounds of merging and relabeling at most; two or three change something.
pub(super) const MOST_ROUNDS: usize = 8;

/// Sweeps over the faces at most; they end when one changes nothing.
pub(super) const MOST_SWEEPS: usize = 20;

/// A face changes its piece where that gains more than rounding makes of the sum of its costs.
pub(super) const GAIN: f64 = 1e-9;

/// Points that a kind is chosen by; what is chosen is fitted to all.
pub(super) const ENOUGH: usize = 1000;

/// Points that a merge is judged by before it is fitted to all.
pub(super) const JUDGED_BY: usize = 300;

/// A piece that has so many times as many faces as when it was compared with a neighbor is another one.
pub(super) const GROWN: f64 = 1.25;

/// A surface turns by no more than this (radians; 46 degrees) under one face of it, and a face is tilted
/// against it by no more: cylinders have eight sides and more. The corners of any box lie on a sphere, and so
/// do those of two caps and nothing between.
pub(super) const MOST_TURN: f64 = 0.8;

/// The part of the way from the corners of a face to its center at which that is looked at: in the apex of a
/// cone there is no normal.
pub(super) const BESIDE: f64 = 0.1;

/// Noise lifts a corner of a face by no more than so many standard deviations over its center, along the
/// normal of its surface, and a vertex over the surface. Without noise in the first, the caps of a noisy
/// cylinder (0.3 of an edge) took half of its side.
pub(super) const MOST_RISE: f64 = 4.0;

/// Vertices are asked in circles of so many at most whether they stray together, the smallest first: those
/// within one row of a vertex of an even mesh, two, and three. Along borders that is 18 rows to either side:
/// the row in the middle of a fillet three edges wide is off the planes by two deviations of the noise.
pub(super) const CIRCLES: [usize; 3] = [7, 19, 37];

/// Turns of moving borders and fitting surfaces after pieces are divided: what strays is some two faces wide,
/// and most of a fillet of six edges after the first.
pub(super) const TURNS: usize = 2;

/// Rows of faces on either side of a border that may change sides in one turn.
pub(super) const BAND: usize = 24;

/// A border of a divided piece costs its length, and more by the square of how many edges it is from where
/// its surfaces meet or touch. Beyond so many it costs no more, and no contact is looked for.
pub(super) const FARTHEST: f64 = 3.0;

/// Along a contact the normals of two surfaces agree; the square of how much their difference changes is less
/// than this part of that across.
pub(super) const ALONG: f64 = 0.1;

// Surfaces that are sought where none explains the faces. Where figures stand, they are RMS distances in
// edges, of eight parts under noise of 0.1, 0.0124 with what is here.

/// What a vertex beside its surface costs on average: noise alone, of one standard deviation.
pub(super) const NOISE_MISFIT: f64 = 0.5;

/// The least part of what surfaces could gain in free pieces that they do before neighbors become one: of 24
/// parts under noise of 0.1 and 0.2 0.42 and more, of 17 characters and the like 0.30 at most.
pub(super) const SOUGHT_SHARE: f64 = 0.36;

/// Faces that a surface begins with: the fewest lie within a fillet of six edges, the most tell a flat
/// cylinder from a plane under noise of 0.2 of an edge.
pub(super) const STARTS: [usize; 3] = [24, 72, 216];

/// A corner of a face is off by no more than so many standard deviations where a surface grows: once in two
/// thousand times (3: 0.0122, 4.5: 0.0129). Six of them are so on average: three standard deviations of their
/// mean (0.8: 0.0126, 2: 0.0157).
pub(super) const REACH: f64 = 3.5;
pub(super) const ON_AVERAGE: f64 = 1.2;

/// Points that a surface is fitted to while it grows; with 100 and 400 eleven parts come out the same.
pub(super) const GROWN_BY: usize = 200;

/// A surface that has grown by more than this goes on growing; with 1.02 and 1.3 they come out the same. Most
/// have grown in four rounds.
pub(super) const MORE: f64 = 1.1;
pub(super) const MOST_GROWTHS: usize = 12;

/// No limit to what a surface costs.
pub(super) const UNLIMITED: f64 = f64::MAX;

/// Nothing is sought where fewer than this part of so many surfaces go on to twice the faces that they were
/// fitted to. Of seven free shapes it was 0.19 at most without noise, of parts, all of their faces, 0.5 and
/// more.
pub(super) const TRIES: usize = 16;
pub(super) const GOING_ON: f64 = 0.25;

/// So many tries in a row find this part of the area, the first ones and later ones, or the search ends (0.05
/// for later ones: the same).
pub(super) const LEAST_FOUND: [f64; 2] = [0.3, 0.01];

/// A surface begins in faces that are so many edges from what is known (2: 0.0124, 5: 0.0143). Another search
/// in what the first has left gains nothing (0.0125 with one, 0.0124 with three).
pub(super) const LEAST_DEPTH: u32 = 3;

/// A smooth surface is fitted to so many vertices around each at least, those within two rows. Of ten parts
/// with fillets without noise 19 and 37 cost least, under noise of 0.1 and 0.2 75 to 300; finer meshes take
/// more.
pub(super) const FEWEST_NEARBY: usize = 19;
