//! Corners, and facets as loops of them.

use std::collections::{HashMap, HashSet};

use super::moments::{Moments, Plane};
use super::regions::{Regions, Ridge, OUTSIDE};
use crate::mesh::vector::{add, distance, scale, Point};
use crate::remesh::closest::closest_on_segment;
use crate::{memory, Result};

/// A point where facets meet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    pub point: Point,
    /// Where it was on the mesh.
    pub home: Point,
    /// How many times as firmly as others it is held.
    pub firmness: f64,
    /// Never moved.
    pub is_fixed: bool,
    /// The axis of coordinates along which it does not move, as on a mirror's plane.
    pub across: Option<usize>,
    /// The vertex of the mesh.
    pub vertex: u32,
}

/// A facet: its loops run counterclockwise around it, seen from outside, and clockwise around its holes.
#[derive(Debug)]
pub(super) struct Facet {
    pub loops: Vec<Vec<u32>>,
    pub plane: Plane,
    /// Of the faces that it stands for.
    pub moments: Moments,
    /// A face that stays as it is.
    pub is_held: bool,
    /// One of the faces that it began with.
    pub part: u32,
}

impl Facet {
    /// The same.
    pub(super) fn twin(&self) -> Result<Self> {
        let mut loops = memory::room(self.loops.len())?;
        for corners in &self.loops {
            loops.push(memory::twin(corners)?);
        }
        Ok(Self { loops, ..*self })
    }

    /// The integral of the squared distance of its faces from its plane.
    pub(super) fn squared_distance(&self) -> f64 {
        self.moments.squared_distance(&self.plane)
    }

    /// Its corners.
    pub(super) fn corners(&self) -> impl Iterator<Item = u32> + '_ {
        self.loops.iter().flatten().copied()
    }

    /// Its sides, from corner to corner.
    pub(super) fn sides(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        self.loops.iter().flat_map(|corners| sides(corners))
    }

    pub(super) fn is_triangle(&self) -> bool {
        self.loops.len() == 1 && self.loops[0].len() == 3
    }
}

/// The sides of a loop.
pub(super) fn sides(corners: &[u32]) -> impl Iterator<Item = [u32; 2]> + '_ {
    (0..corners.len()).map(|i| [corners[i], corners[(i + 1) % corners.len()]])
}

/// A surface of facets.
#[derive(Debug, Default)]
pub(super) struct Shape {
    pub corners: Vec<Corner>,
    pub facets: Vec<Facet>,
}

impl Shape {
    /// The facets that `regions` are, which have `moments` and begin with `parts`.
    /// What lies along the mesh's boundary keeps within `tolerance` of it. Vertices without `firmness` stay.
    pub(super) fn new(
        regions: &Regions<'_>,
        moments: &[Moments],
        positions: &[Point],
        parts: &[u32],
        is_held: &[bool],
        firmness: impl Fn(u32) -> Option<f64>,
        tolerance: f64,
    ) -> Result<Self> {
        let mut shape = Self::default();
        let mut names: HashMap<u32, u32> = HashMap::new();
        for (((region, moments), &is_held), &part) in (0..).zip(moments).zip(is_held).zip(parts) {
            let mut loops = Vec::new();
            for ridges in regions.loops(region)?.unwrap_or_default() {
                let vertices = polygon(regions, region, &ridges, positions, tolerance)?;
                memory::extend_map(&mut names, vertices.len())?;
                memory::extend(&mut shape.corners, vertices.len())?;
                let mut name = |v: u32| {
                    *names.entry(v).or_insert_with(|| {
                        let point = positions[v as usize];
                        let (firmness, is_fixed) = (firmness(v).unwrap_or(1.0), firmness(v).is_none());
                        shape.corners.push(Corner {
                            point,
                            home: point,
                            firmness,
                            is_fixed,
                            across: None,
                            vertex: v,
                        });
                        shape.corners.len() as u32 - 1
                    })
                };
                memory::push(&mut loops, memory::gathered(vertices.into_iter().map(&mut name))?)?;
            }
            let plane = moments.fit().plane;
            memory::push(&mut shape.facets, Facet { loops, plane, moments: *moments, is_held, part })?;
        }
        Ok(shape)
    }

    /// What of a vector a corner may move along.
    pub(super) fn free(&self, corner: usize, mut vector: Point) -> Point {
        if let Some(axis) = self.corners[corner].across {
            vector[axis] = 0.0;
        }
        vector
    }

    pub(super) fn point(&self, corner: u32) -> Point {
        self.corners[corner as usize].point
    }

    pub(super) fn home(&self, corner: u32) -> Point {
        self.corners[corner as usize].home
    }

    /// The same.
    pub(super) fn twin(&self) -> Result<Self> {
        let mut facets = memory::room(self.facets.len())?;
        for facet in &self.facets {
            facets.push(facet.twin()?);
        }
        Ok(Self { corners: memory::twin(&self.corners)?, facets })
    }

    /// The same with every corner where it was on the mesh.
    pub(super) fn at_home(&self) -> Result<Self> {
        let mut shape = self.twin()?;
        shape.corners.iter_mut().for_each(|corner| corner.point = corner.home);
        Ok(shape)
    }

    /// The integrals over the polygon of a facet, flat or not, as a fan around the mean of its corners.
    pub(super) fn polygon_moments(&self, facet: &Facet) -> Moments {
        let n = facet.corners().count().max(1) as f64;
        let middle = scale(facet.corners().fold([0.0; 3], |sum, c| add(sum, self.point(c))), 1.0 / n);
        let triangle = |[a, b]: [u32; 2]| Moments::of([middle, self.point(a), self.point(b)]);
        facet.sides().fold(Moments::default(), |sum, side| sum.plus(&triangle(side)))
    }

    /// The largest distance of a corner from the plane of one of its facets.
    pub(super) fn off_planes(&self) -> f64 {
        (0..self.facets.len() as u32).map(|k| self.off_plane(k)).fold(0.0, f64::max)
    }

    /// The same of one facet.
    pub(super) fn off_plane(&self, k: u32) -> f64 {
        let facet = &self.facets[k as usize];
        facet.corners().map(|c| facet.plane.height(self.point(c)).abs()).fold(0.0, f64::max)
    }

    /// Whether one of the facets has the side `[a, b]` in this direction.
    pub(super) fn all_sides(&self) -> Result<HashSet<[u32; 2]>> {
        Ok(memory::distinct(self.facets.iter().flat_map(Facet::sides))?)
    }
}

/// The vertices of a loop that become corners.
fn polygon(
    regions: &Regions<'_>,
    region: u32,
    ridges: &[Ridge],
    positions: &[Point],
    tolerance: f64,
) -> Result<Vec<u32>> {
    let mut corners: Vec<u32> = Vec::new();
    for ridge in ridges {
        if ridge.neighbor == OUTSIDE {
            let kept = simplified(&regions.run(region, ridge)?, positions, tolerance)?;
            memory::extend(&mut corners, kept.len())?;
            corners.extend(kept);
        } else {
            memory::push(&mut corners, ridge.from)?;
        }
    }
    if corners.len() >= 3 {
        return Ok(corners);
    }
    // Two triangles on top of each other have no corner at all.
    corners.clear();
    for ridge in ridges {
        let run = regions.run(region, ridge)?;
        memory::extend(&mut corners, run.len())?;
        corners.extend(&run[1..]);
    }
    Ok(corners)
}

/// The vertices of a run that keep it within `tolerance`, at least three of one that is closed, without the
/// last [Douglas and Peucker 1973].
fn simplified(run: &[u32], positions: &[Point], tolerance: f64) -> Result<Vec<u32>> {
    let at = |i: usize| positions[run[i] as usize];
    let off = |i: usize, a: usize, b: usize| distance(at(i), closest_on_segment(at(i), at(a), at(b)));
    let last = run.len() - 1;
    let farthest = |from: usize, to: usize, far: &dyn Fn(usize) -> f64| {
        (from..to).max_by(|&i, &j| far(i).total_cmp(&far(j)).then(j.cmp(&i)))
    };
    let mut marks = vec![0, last];
    if run[0] == run[last] && last >= 3 {
        let opposite = farthest(1, last, &|i| distance(at(i), at(0))).unwrap_or(1);
        let third =
            farthest(1, last, &|i| if i == opposite { -1.0 } else { off(i, 0, opposite) }).unwrap_or(1);
        marks.extend([opposite, third]);
        marks.sort_unstable();
    }
    let mut kept = memory::repeated(false, run.len())?;
    marks.iter().for_each(|&i| kept[i] = true);
    let mut pieces: Vec<(usize, usize)> = marks.windows(2).map(|pair| (pair[0], pair[1])).collect();
    while let Some((a, b)) = pieces.pop() {
        let Some(far) = farthest(a + 1, b, &|i| off(i, a, b)) else { continue };
        if off(far, a, b) > tolerance {
            kept[far] = true;
            memory::extend(&mut pieces, 2)?;
            pieces.extend([(a, far), (far, b)]);
        }
    }
    Ok(memory::sifted((0..last).filter(|&i| kept[i]).map(|i| run[i]))?)
}
