//! Rims that are closed flat: planar ones that the surface meets steeply all round, as the missing side of a
//! box or the cut end of a tube.

use super::long_loops::{triangulate, Triangulation};
use super::options::FillOptions;
use super::patch::refined;
use super::polygon::Polygon;
use super::rims::Rims;
use crate::mesh::vector::{add, area_vector, cross, distance, dot, norm, scale, sub, unit, Point};
use crate::{Progress, Result};

/// A rim is planar if its vertices are off its mean plane by no more than this part of an edge, root mean
/// square: noise of a third of an edge and the steps of a cut along faces are.
const OFF_EDGE: f64 = 0.5;

/// And by no more than this part of the square root of its area:
/// four edges around a hole are planar by chance.
const OFF_SIZE: f64 = 0.1;

/// The surface meets the plane of the rim steeply where its normal leans out of that plane by no more than
/// these sines: out of the hole by 25 degrees, as a finger does at its tip, which is closed round, and
/// inwards by 30, as the foot of a bust does.
const STEEP: [f64; 2] = [-0.42, 0.5];

/// That much of the rim must be steep.
const STEEP_SHARE: f64 = 0.9;

/// How far the surface leans is a mean over so many edges on either side: single faces are noise.
const WINDOW: usize = 4;

/// Notches in the rim that are deeper than these parts of an edge are closed with faces that go on with the
/// surface around, the deep ones first; without any if that leaves a lid that is in order.
const DEPTHS: [f64; 4] = [f64::INFINITY, 0.6, 0.3, 0.1];

/// A notch is closed by a triangle that goes on with the faces beside it: turned from those on one side by
/// less than 45 degrees, and from those on the other by no more than 95, as around the edge of a box.
const ALONG: [f64; 2] = [-0.09, std::f64::consts::FRAC_1_SQRT_2];

/// What closes notches is no more than this part of the lid:
/// a hole that is closed by going on with the sides around it has none.
const MOST_NOTCHES: f64 = 0.5;

/// Faces of a lid look along its normal by more than this, those at a noisy rim too.
const LEAST_COSINE: f64 = 0.05;

/// The mean plane of a rim.
#[derive(Debug, Clone, Copy)]
pub(super) struct RimPlane {
    pub center: Point,
    /// To the side that a patch shows.
    pub normal: Point,
}

impl RimPlane {
    /// Through the center of gravity of the polygon's edges, along its area vector.
    fn of(points: &[Point]) -> Self {
        let n = points.len();
        let (mut center, mut area, mut total) = ([0.0; 3], [0.0; 3], 0.0);
        for (i, &a) in points.iter().enumerate() {
            let b = points[(i + 1) % n];
            let length = distance(a, b);
            center = add(center, scale(add(sub(a, points[0]), sub(b, points[0])), 0.5 * length));
            area = add(area, cross(sub(a, points[0]), sub(b, points[0])));
            total += length;
        }
        let center = add(points[0], scale(center, 1.0 / total.max(f64::MIN_POSITIVE)));
        Self { center, normal: unit(area) }
    }

    fn height(&self, p: Point) -> f64 {
        dot(sub(p, self.center), self.normal)
    }

    fn project(&self, p: Point) -> Point {
        sub(p, scale(self.normal, self.height(p)))
    }
}

/// A rim without its notches.
struct Trimmed {
    /// The triangles that close the notches, as places in the polygon.
    notches: Vec<[u32; 3]>,
    /// The places that are left.
    places: Vec<usize>,
    /// The unit normal beyond the edge that starts at each.
    outside: Vec<Point>,
}

/// The normal of a lid, to the side that it shows, if the rim of a hole calls for one: if it is planar, but
/// for notches, and met steeply all round.
pub(super) fn normal(polygon: &Polygon) -> Option<Point> {
    let rims = DEPTHS.into_iter().map(|depth| trimmed(polygon, depth, |_, _| false));
    let mut few = rims
        .take_while(|rim| notches_area(polygon, rim) <= MOST_NOTCHES * lid_area(&points_of(polygon, rim)));
    few.find_map(|rim| plane_of(polygon, &rim)).map(|plane| plane.normal)
}

/// The new points of a flat patch, and its faces as places in the polygon;
/// places from its length on are the new points.
pub(super) type FlatPatch = (Vec<Point>, Vec<[u32; 3]>);

/// The flat patch of a rim: its new points, and its faces as places in the polygon, places from its length on
/// being the new points. Nothing if the rim does not call for one and `any` rim is not asked for, or if none
/// is in order.
pub(super) fn lid(
    polygon: &Polygon,
    rims: &Rims,
    options: &FillOptions,
    any: bool,
    progress: &Progress,
) -> Result<Option<FlatPatch>> {
    let is_taken = |i: usize, j: usize| rims.is_taken(polygon.vertices[i], polygon.vertices[j]);
    let mut before = usize::MAX;
    for depth in DEPTHS {
        progress.check()?;
        let rim = trimmed(polygon, depth, is_taken);
        if rim.notches.len() == before {
            continue;
        }
        before = rim.notches.len();
        if notches_area(polygon, &rim) > MOST_NOTCHES * lid_area(&points_of(polygon, &rim)) {
            break;
        }
        let Some(plane) =
            plane_of(polygon, &rim).or_else(|| any.then(|| RimPlane::of(&points_of(polygon, &rim))))
        else {
            continue;
        };
        if let Some(patch) = closed(polygon, &rim, plane, rims, options, progress)? {
            return Ok(Some(patch));
        }
    }
    Ok(None)
}

fn points_of(polygon: &Polygon, rim: &Trimmed) -> Vec<Point> {
    rim.places.iter().map(|&i| polygon.points[i]).collect()
}

/// The area of the projection of a polygon onto its mean plane.
fn lid_area(points: &[Point]) -> f64 {
    let Some(&first) = points.first() else { return 0.0 };
    let doubled = points
        .windows(2)
        .fold([0.0; 3], |sum, pair| add(sum, cross(sub(pair[0], first), sub(pair[1], first))));
    0.5 * norm(doubled)
}

/// The area of what closes the notches.
fn notches_area(polygon: &Polygon, rim: &Trimmed) -> f64 {
    rim.notches.iter().map(|face| norm(area_vector(face.map(|v| polygon.points[v as usize])))).sum()
}

/// The mean plane of a rim that is planar and met steeply.
fn plane_of(polygon: &Polygon, rim: &Trimmed) -> Option<RimPlane> {
    let points = points_of(polygon, rim);
    let n = points.len();
    if n < 3 {
        return None;
    }
    let plane = RimPlane::of(&points);
    let lengths: Vec<f64> = (0..n).map(|i| distance(points[i], points[(i + 1) % n])).collect();
    let total: f64 = lengths.iter().sum();
    let squares: f64 =
        (0..n).map(|i| 0.5 * (lengths[i] + lengths[(i + n - 1) % n]) * plane.height(points[i]).powi(2)).sum();
    let off = (squares / total.max(f64::MIN_POSITIVE)).sqrt();
    let size = lid_area(&points).sqrt();
    let is_planar = off <= (OFF_EDGE * total / n as f64).min(OFF_SIZE * size);
    let lean = |i: usize| {
        let around = (i + n - WINDOW.min(n)..=i + n + WINDOW.min(n)).map(|k| k % n);
        let (sum, span) = around.fold((0.0, 0.0), |(sum, span), k| {
            (sum + lengths[k] * dot(rim.outside[k], plane.normal), span + lengths[k])
        });
        sum / span.max(f64::MIN_POSITIVE)
    };
    let is_steep = |&i: &usize| (STEEP[0]..STEEP[1]).contains(&-lean(i));
    let steep: f64 = (0..n).filter(is_steep).map(|i| lengths[i]).sum();
    (is_planar && steep >= STEEP_SHARE * total).then_some(plane)
}

/// Closes notches deeper than `depth` edges, the narrowest first,
/// as long as a triangle over one goes on with the surface beside it.
fn trimmed(polygon: &Polygon, depth: f64, is_taken: impl Fn(usize, usize) -> bool) -> Trimmed {
    let mut rim = Trimmed {
        notches: Vec::new(),
        places: (0..polygon.len()).collect(),
        outside: polygon.outside.clone(),
    };
    if !depth.is_finite() {
        return rim;
    }
    let total: f64 = (0..polygon.len())
        .map(|i| distance(polygon.points[i], polygon.points[(i + 1) % polygon.len()]))
        .sum();
    let least = depth * total / polygon.len() as f64;
    loop {
        let n = rim.places.len();
        if n <= 3 {
            return rim;
        }
        let span = |i: usize| {
            let [p, c, q] = [i + n - 1, i, i + 1].map(|k| polygon.points[rim.places[k % n]]);
            let area = area_vector([p, c, q]);
            let width = distance(p, q);
            let normal = unit(area);
            let turns = [rim.outside[(i + n - 1) % n], rim.outside[i]].map(|m| dot(m, normal));
            let goes_on = turns[0].min(turns[1]) > ALONG[0] && turns[0].max(turns[1]) > ALONG[1];
            let height = 2.0 * norm(area) / width.max(f64::MIN_POSITIVE);
            let free = !is_taken(rim.places[(i + n - 1) % n], rim.places[(i + 1) % n]);
            (goes_on && height > least && free).then_some((width, i, normal))
        };
        let Some((_, i, normal)) =
            (0..n).filter_map(span).min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
        else {
            return rim;
        };
        let before = (i + n - 1) % n;
        rim.notches.push([before, i, (i + 1) % n].map(|k| rim.places[k] as u32));
        rim.outside[before] = normal;
        rim.places.remove(i);
        rim.outside.remove(i);
    }
}

/// The notches and the flat patch in the `plane` of what is left of the rim;
/// nothing if its projection overlaps itself.
fn closed(
    polygon: &Polygon,
    rim: &Trimmed,
    plane: RimPlane,
    rims: &Rims,
    options: &FillOptions,
    progress: &Progress,
) -> Result<Option<FlatPatch>> {
    // Nothing but the outline counts in the plane.
    let mut flat = polygon.part(&rim.places, vec![[0.0; 3]; rim.places.len()]);
    flat.points.iter_mut().for_each(|p| *p = plane.project(*p));
    let coarse = triangulate(&flat, rims, progress)?;
    progress.check()?;
    let looks_out = |corners: [Point; 3], least: f64| {
        let area = area_vector(corners);
        dot(area, plane.normal) > least * norm(area)
    };
    let is_plain = coarse.extra.is_empty()
        && coarse.faces.iter().all(|f| looks_out(f.map(|v| flat.points[v as usize]), 0.0));
    if !is_plain {
        return Ok(None);
    }
    flat.outside.fill(plane.normal);
    let (new, faces) = if options.refine {
        let Triangulation { extra, faces } = coarse;
        refined(&flat, &Triangulation { extra, faces }, rims, options, progress)?
    } else {
        (Vec::new(), coarse.faces)
    };
    let new: Vec<Point> = new.into_iter().map(|p| plane.project(p)).collect();
    let n = flat.len() as u32;
    let point = |v: u32| if v < n { polygon.points[rim.places[v as usize]] } else { new[(v - n) as usize] };
    if !faces.iter().all(|face| looks_out(face.map(point), LEAST_COSINE)) {
        return Ok(None);
    }
    let place = |v: u32| if v < n { rim.places[v as usize] as u32 } else { polygon.len() as u32 + v - n };
    let faces = rim.notches.iter().copied().chain(faces.into_iter().map(|face| face.map(place))).collect();
    Ok(Some((new, faces)))
}
