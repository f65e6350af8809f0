//! Every number that facets depend on, with its reason.
//! Lengths are parts of the diagonal of the bounding box.

/// How many turns there are, and what changes by which factor in each.
pub(super) struct Turns {
    pub count: usize,
    pub factor: f64,
}

/// What faces that are turned away cost against faces that are away, over the area of the region: a spherical
/// cap of radius `r` and curvature `k` is off its plane by `k² r⁴ / 48` in the mean square, its normals by
/// `k² r² / 2`; with the area `π r²` both then weigh about the same. Without it the two sides of an ear
/// become one facet.
pub(super) const TURN: f64 = 0.01;

/// The corners that two facets share lie on one line, as where a step is cut into an edge. They may be off
/// that line by this part of the distance between the farthest two.
pub(super) const BESIDE: f64 = 0.1;

/// So many regions are merged at once at most, where fewer leave no facets: the three sides of a bump and the
/// plane around it take four.
pub(super) const TOGETHER: usize = 8;

/// What a move of a corner costs against distances of faces from planes, over its part of the areas around
/// it, while facets are sought that are sound at all.
pub(super) const STAY: f64 = 1.0;

/// The same while planes are fitted. Distances of 100 facets of Spot and the bunny are least from 0.1 to 0.3;
/// with less, corners of facets that are nearly parallel leave the mesh (3.8 % of the diagonal with 0.02
/// against 1.9 % with 0.2 on Spot).
pub(super) const FITTING: f64 = 0.2;

/// How far corners are drawn to the mesh while planes are fitted, as a part of their distance: without it
/// corners of 100 facets of Spot are 3.5 % of the diagonal away, with 0.3 1.8 %, and the root mean square
/// stays within a fortieth.
pub(super) const PULL: f64 = 0.3;

/// Corners nearer to the mesh than this many times the distance of both surfaces (root mean square) are left
/// to their planes: on a noisy mesh the nearest point is noise, and drawing corners there turns the planes.
/// In the mean over cubes, houses, and dodecahedra under noise, corners are off by 0.53 of the noise, with 0
/// by 0.65; 300 facets of Spot are nearer by a sixth, 30 farther by a hundredth.
pub(super) const NOISE: f64 = 2.0;

/// How much planes resist to being turned, as a part of the spread of their faces: thin facets, whose planes
/// their faces hardly determine, turned by radians without.
pub(super) const DAMPING: f64 = 0.03;

/// Newton steps in one go towards the least distances, and at most as many that only flatten:
/// four to six reach rounding.
pub(super) const STEPS: usize = 10;

/// How much constraints may give at first, as a part of the diagonal of their system, from a start that is
/// not flat and from one that is: with none at all steps swing between two places (eight of twenty-four
/// shapes did not become flat).
pub(super) const SLACK: [f64; 2] = [0.1, 1e-6];

/// The least of it, as constraints may depend on each other.
pub(super) const REGULAR: f64 = 1e-10;

/// A step that leaves more than this part of the distances is followed by one with more slack.
pub(super) const SLOW: f64 = 0.7;

/// The farthest that a corner moves, and a plane turns (radians), in one Newton step.
pub(super) const FARTHEST: [f64; 2] = [0.1, 0.3];

/// A corner that is farther than the mesh is large from where it was is where planes meet that are nearly
/// parallel, and its facets cannot stay. On 22 shapes, 30 facets to 300, no corner was farther than 0.085
/// from the mesh; on meshes of eight random points they were thousands away.
pub(super) const FARTHEST_CORNER: f64 = 1.0;

/// How near to their planes corners are said to be.
pub(super) const PROMISED: f64 = 1e-6;

/// Corners count as on their planes below this distance.
pub(super) const FLAT: f64 = 0.1 * PROMISED;

/// Rounds of repairing facets that cross themselves. Of 24 shapes and counts none took more than six.
pub(super) const REPAIRS: usize = 12;

/// Repairs that leave more than so many times the faults that there were at first do more harm than good, and
/// are taken back: of 90 goes on ten meshes, in 30 facets, 200, and as many as were found, one came to 3 of 1
/// and the others to no more than twice as many; among the holes of a perforated sheet they came to four or
/// five times as many by the fifth round, and went on.
pub(super) const SPREAD: usize = 3;

/// Faces are shared out and planes fitted until both surfaces have not come nearer, to this part of their
/// distance, so many times in a row. Below [`PROMISED`] nothing counts as nearer: where all sides of a fine
/// cylinder are facets, each of some sixty rounds came nearer by a thousandth of 2e-7.
pub(super) const IDLE: Turns = Turns { count: 2, factor: 0.999 };

/// How often a round is tried again with the corners of unsound facets held so many times as firmly.
pub(super) const TRIES: Turns = Turns { count: 6, factor: 10.0 };

/// How often a facet that cannot stay is made of smaller regions, twice as many each time, before its faces
/// stay as they are.
pub(super) const STRIKES: u32 = 5;

/// How many times merges are refused at what touches last, before all that is unsound, and what touches it,
/// is made of the regions that there are when twice as many are left; at last all that is unsound stays as on
/// the mesh, and after as many times again the whole mesh.
pub(super) const REFUSALS: usize = 8;

/// How often the number of regions is doubled where they are not sound: a bound on the time. Whatever stays
/// as on the mesh instead is joined face by face: a torus of 1320 faces in 6 facets took 17 s, and takes 2 s.
/// Doubled everywhere, 300 facets of a scan of 70,000 faces, 4 of them unsound, became 1230 to be joined.
pub(super) const DOUBLINGS: usize = 3;

/// How many times the planes are taken anew to end at the number of facets asked for,
/// since repairs change it.
pub(super) const COUNTS: usize = 4;

/// The root mean square distance that facets keep where nothing is asked for.
pub(super) const ERROR: f64 = 0.005;

/// Planes that meet at less than this (radians; 15 degrees) may be a round shape in many sides: of prisms,
/// Segment takes those of up to 24 for what they are.
pub(super) const ROUND: f64 = std::f64::consts::PI / 12.0;

/// Faces with less than this part of their facet's area say nothing about its plane.
pub(super) const LITTLE: f64 = 1e-3;

/// Triangles cover a facet whose area they have to this part:
/// what rounding leaves of a sum of areas, and far less than any triangle.
pub(super) const COVERED: f64 = 1e-9;

/// So many trials of joining two facets are kept for when it is their turn, each about 25 kB: the memory that
/// a call asks for has room for them.
pub(super) const KEPT: usize = 500;

/// Vertices of a coarser mesh for each facet: with 30, 300 facets of a bunny are 0.13 % of the diagonal off,
/// as they are when found on all of its faces. Where there are more facets than expected, half as many do.
pub(super) const PER_FACET: usize = 30;

/// A coarser mesh may be this part of the error that is allowed away from the mesh: then an eighth of the
/// square is left for what it loses, noise above all.
pub(super) const MOST_LOST: f64 = 0.35;

/// Asked after so many merges whether to stop.
pub(super) const PATIENCE: usize = 1000;

/// The number that is aimed at changes by no more than this from one time to the next, and this part of it:
/// repairs that failed leave many triangles, which say little.
pub(super) const CHANGE: [f64; 2] = [4.0, 0.2];

/// Steps that only flatten end below this part of [`FLAT`].
pub(super) const FLATTEST: f64 = 1e-3;
