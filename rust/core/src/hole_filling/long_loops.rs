//! Triangulating polygons of any length: long ones are divided along the chords of a coarse polygon.

use super::polygon::Polygon;
use super::rims::Rims;
use super::triangulation::{minimum_weight, TABLE_LIMIT};
use crate::mesh::vector::{add, area_vector, cross, distance, dot, norm, scale, sub, unit, Point};
use crate::{memory, Progress, Result};

/// Vertices of the coarse polygon. Its table takes a quarter of the time of the largest full one.
const COARSE: usize = 250;

/// Parts of a long polygon, narrow pieces along its sides, are divided from this many vertices on, along a
/// coarse polygon of [`PART_COARSE`]: their tables would grow with the square of the polygon's length. 20,000
/// vertices took 5.7 s of processor time so, three times as much as half of them.
const PART_LIMIT: usize = 64;

/// Vertices of the coarse polygon of a part.
const PART_COARSE: usize = 40;

/// Triangles as places in the polygon; places from its length on are the extra points.
pub(super) struct Triangulation {
    /// New points, needed only where all chords are taken.
    pub(super) extra: Vec<Point>,
    /// Vertex triples, counterclockwise.
    pub(super) faces: Vec<[u32; 3]>,
}

/// A triangulation of the polygon that makes no edge which is taken.
///
/// - Up to [`TABLE_LIMIT`] vertices: that of minimum weight.
/// - Longer polygons: [`COARSE`] of the vertices, denser at corners, form a coarse polygon. The chords of its
///   triangulation of minimum weight cut the polygon into parts, one for each coarse triangle, with the whole
///   run of vertices in place of a coarse edge. The parts are triangulated in the same way, so that the time
///   grows in proportion to the length; 5000 vertices take some 0.5 s. The weight is then not the least
///   possible, but no fold across the hole is decided by less than all of it.
/// - Where every triangulation needs an edge that is taken, a fan around one new point at the middle.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(super) fn triangulate(polygon: &Polygon, rims: &Rims, progress: &Progress) -> Result<Triangulation> {
    let mut result = Triangulation { extra: Vec::new(), faces: Vec::new() };
    let places: Vec<usize> = memory::gathered(0..polygon.len())?;
    let sizes = if polygon.len() <= TABLE_LIMIT { (TABLE_LIMIT, COARSE) } else { (PART_LIMIT, COARSE) };
    add_part(polygon, &places, memory::twin(&polygon.outside)?, rims, sizes, progress, &mut result)?;
    Ok(result)
}

/// Adds the triangles of the part of `polygon` at `places`, along a coarse polygon of `n_coarse` vertices if
/// it has more than `limit`.
fn add_part(
    polygon: &Polygon,
    places: &[usize],
    outside: Vec<Point>,
    rims: &Rims,
    (limit, n_coarse): (usize, usize),
    progress: &Progress,
    result: &mut Triangulation,
) -> Result<()> {
    let part = polygon.part(places, outside);
    let whole = |local: u32| places[local as usize] as u32;
    if part.len() <= limit {
        match minimum_weight(&part, rims, progress)? {
            Some(faces) => {
                memory::extend(&mut result.faces, faces.len())?;
                result.faces.extend(faces.into_iter().map(|face| face.map(whole)));
            }
            None => add_fan(polygon, places, result)?,
        }
        return Ok(());
    }
    let samples = samples(&part, n_coarse);
    let coarse = coarse_polygon(&part, &samples);
    let Some(faces) = minimum_weight(&coarse, rims, progress)? else {
        return add_fan(polygon, places, result);
    };
    let normals: Vec<Point> =
        faces.iter().map(|face| unit(area_vector(face.map(|v| coarse.points[v as usize])))).collect();
    let beyond: std::collections::HashMap<[u32; 2], usize> = faces
        .iter()
        .enumerate()
        .flat_map(|(f, &[a, b, c])| [([a, b], f), ([b, c], f), ([c, a], f)])
        .collect();
    for &[a, b, c] in &faces {
        if progress.is_cancelled() {
            return Ok(());
        }
        let (mut run, mut outside) = (Vec::new(), Vec::new());
        for [tail, head] in [[a, b], [b, c], [c, a]] {
            if (tail as usize + 1) % samples.len() == head as usize {
                let (mut at, end) = (samples[tail as usize], samples[head as usize]);
                while at != end {
                    memory::push(&mut run, places[at])?;
                    memory::push(&mut outside, part.outside[at])?;
                    at = (at + 1) % part.len();
                }
            } else {
                run.push(places[samples[tail as usize]]);
                outside.push(beyond.get(&[head, tail]).map_or([0.0; 3], |&f| normals[f]));
            }
        }
        add_part(polygon, &run, outside, rims, (PART_LIMIT, PART_COARSE), progress, result)?;
    }
    Ok(())
}

/// Adds a fan around the mean of the part's vertices.
fn add_fan(polygon: &Polygon, places: &[usize], result: &mut Triangulation) -> Result<()> {
    let sum = places.iter().fold([0.0; 3], |sum, &i| add(sum, polygon.points[i]));
    let center = (polygon.len() + result.extra.len()) as u32;
    result.extra.push(scale(sum, 1.0 / places.len() as f64));
    let ends = places.iter().zip(places.iter().cycle().skip(1));
    memory::extend(&mut result.faces, places.len())?;
    result.faces.extend(ends.map(|(&a, &b)| [a as u32, b as u32, center]));
    Ok(())
}

/// So many places of the polygon, equally spaced by a measure that is half length and half turning angle, so
/// that corners are met more closely than straight runs.
fn samples(polygon: &Polygon, count: usize) -> Vec<usize> {
    let n = polygon.len();
    let edge = |i: usize| sub(polygon.points[(i + 1) % n], polygon.points[i]);
    let turn = |i: usize| {
        let (before, after) = (edge((i + n - 1) % n), edge(i));
        norm(cross(before, after)).atan2(dot(before, after))
    };
    let length: f64 = (0..n).map(|i| distance(polygon.points[i], polygon.points[(i + 1) % n])).sum();
    let turning: f64 = (0..n).map(turn).sum();
    let share = |value: f64, total: f64| if total > 0.0 { 0.5 * value / total } else { 0.5 / n as f64 };
    let (mut samples, mut measure) = (Vec::with_capacity(count), 0.0);
    for i in 0..n {
        measure += share(turn(i), turning);
        if samples.len() < count && measure * count as f64 >= samples.len() as f64 {
            samples.push(i);
        }
        measure += share(norm(edge(i)), length);
    }
    samples
}

/// The polygon of the samples; beyond its edges, the mean normals of the runs.
fn coarse_polygon(polygon: &Polygon, samples: &[usize]) -> Polygon {
    let n = polygon.len();
    let ends = samples.iter().zip(samples.iter().cycle().skip(1));
    let outside = ends.map(|(&tail, &head)| {
        let run = (0..n).map(|step| (tail + step) % n).take_while(|&i| i != head);
        unit(run.fold([0.0; 3], |sum, i| add(sum, polygon.outside[i])))
    });
    polygon.part(samples, outside.collect())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::triangulation::TRIED;
    use super::*;
    use crate::hole_filling::faces_at;
    use crate::shapes::ring;

    /// How many triangles are compared to triangulate a round hole of `n` edges.
    fn tried(n: usize) -> usize {
        let (shape, rim) = ring(n);
        let mesh = shape.mesh().unwrap();
        let loops = [rim.clone()];
        let rims = Rims::new(&mesh, &loops, &faces_at(&mesh, &loops).unwrap()).unwrap();
        let polygon = Polygon::new(mesh.positions().unwrap(), &rim, &rims).unwrap_or_else(|_| unreachable!());
        TRIED.set(0);
        let found = triangulate(&polygon, &rims, &Progress::new()).unwrap();
        assert_eq!((found.faces.len(), found.extra.len()), (n - 2, 0));
        TRIED.get()
    }

    #[test]
    fn the_triangles_compared_grow_with_the_length_of_a_rim() {
        let counts = [5000, 10_000, 20_000, 40_000].map(tried);
        // The coarse polygon's own, then at most those of the largest tables all along.
        let coarse = COARSE.pow(3) / 6;
        for (count, n) in counts.into_iter().zip([5000, 10_000, 20_000, 40_000]) {
            assert!(count < coarse + n * PART_LIMIT * PART_LIMIT / 6, "{n}: {counts:?}");
        }
    }
}
