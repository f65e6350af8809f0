//! Fillets and bevels: segments in the place of a ridge, which others would make if they went on beyond them.
//!
//! Across a fillet or a bevel, from one neighbor to another, the surface turns to one side all the way,
//! inside of it, at its borders, or both. On either side it does not, over twice its width: that is what
//! parts a bevel from the sides of a prism. And the ridge in its place is near: the neighbors are not
//! parallel, as beside the rim of a plate. Turns are measured across: an edge with the dihedral angle `β` in
//! the direction `e` turns the surface about `t`, the border nearby, by `β (e·t)²` for its length
//! (Cohen-Steiner and Morvan 2003). So the curvature of a ring along itself does not count.

use std::collections::{BTreeMap, BTreeSet};

use super::constants::{
    AGAINST, BESIDE_A_BLEND, LEAST_AS_LONG, LEAST_LONG, MOST_BESIDE, NEIGHBORS_OF_A_BLEND, ROUNDS_OF_BORDERS,
};
use super::surface::{Surface, NONE};
use crate::mesh::vector::{
    add, area_vector, between, centroid, cross, distance, dot, norm, sub, unit, Point,
};
use crate::remesh::closest::closest_on_segment;
use crate::{memory, Result};

/// Segments with what turns at their edges.
pub(super) struct Blends<'a> {
    surface: &'a Surface<'a>,
    labels: &'a [u32],
    /// The vertices, without noise.
    points: &'a [Point],
    /// The same with borders that do not run in teeth along the edges of faces.
    straight: Vec<Point>,
    /// Whether edges of faces run along borders; else ridges may run through the faces beside them.
    tessellated: bool,
    /// The dihedral angle at each halfedge, convex positive, times its length.
    turns: Vec<f64>,
    areas: Vec<f64>,
    members: Vec<Vec<u32>>,
    /// For each segment its neighbors, each with the halfedges of the segment there.
    borders: Vec<BTreeMap<u32, Vec<u32>>>,
}

/// What crosses a border of a segment.
#[derive(Clone, Copy)]
struct Crossing {
    label: u32,
    length: f64,
    /// By how much the surface turns there on average.
    turn: f64,
}

impl<'a> Blends<'a> {
    /// The segments `labels`, from 0, of a `surface` whose vertices are at `points`, without noise. The edges
    /// of what is `tessellated` run along borders.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing, here and below.
    pub(super) fn new(
        surface: &'a Surface<'a>,
        labels: &'a [u32],
        points: &'a [Point],
        tessellated: bool,
    ) -> Result<Self> {
        let n = labels.iter().map(|label| *label as usize + 1).max().unwrap_or(0);
        let corners = |f: usize| surface.connectivity.faces()[f].map(|v| points[v as usize]);
        let mut members = memory::repeated(Vec::new(), n)?;
        let mut areas = memory::repeated(0.0, n)?;
        let mut borders = memory::repeated(BTreeMap::<u32, Vec<u32>>::new(), n)?;
        let mut turns = memory::repeated(0.0, 3 * labels.len())?;
        let normals: Vec<Point> = memory::gathered((0..labels.len()).map(|f| area_vector(corners(f))))?;
        for (f, &own) in labels.iter().enumerate() {
            memory::push(&mut members[own as usize], f as u32)?;
            areas[own as usize] += norm(normals[f]);
            for (h, g) in surface.around(f) {
                let [p, q] = ends(surface, points, h);
                let (m, n) = (unit(normals[f]), unit(normals[g]));
                turns[h] = dot(cross(m, n), sub(q, p)).atan2(distance(p, q) * dot(m, n)) * distance(p, q);
                if labels[g] != own {
                    let list = borders[own as usize].entry(labels[g]).or_default();
                    memory::push(list, h as u32)?;
                }
            }
        }
        let straight = straight(surface, labels, points, if tessellated { 0 } else { ROUNDS_OF_BORDERS })?;
        Ok(Self { surface, labels, points, straight, tessellated, turns, areas, members, borders })
    }

    /// The fillets and bevels at ridges that turn by `least` and more, each with the larger of the two
    /// segments beside it; then the corners between them.
    pub(super) fn found(&self, least: f64) -> Result<Vec<[u32; 2]>> {
        let mut found: BTreeMap<u32, u32> = BTreeMap::new();
        for _ in 0..2 {
            let known: BTreeSet<u32> = found.keys().copied().collect();
            for own in (0..self.members.len() as u32).filter(|own| !known.contains(own)) {
                if let Some(beside) = self.beside(own, &known, least)? {
                    found.insert(own, beside);
                }
            }
        }
        Ok(memory::gathered(found.into_iter().map(|(own, beside)| [own, beside]))?)
    }

    /// The larger of the neighbors whose ridge segment `own` is in the place of, if there are such. Those
    /// that are `known` to be fillets and bevels are narrow themselves.
    fn beside(&self, own: u32, known: &BTreeSet<u32>, least: f64) -> Result<Option<u32>> {
        let crossings = self.borders[own as usize].iter().map(|(&label, edges)| self.crossing(label, edges));
        let mut crossings: Vec<Crossing> = memory::all(memory::gathered(crossings)?)?;
        crossings.sort_by(|a, b| b.length.total_cmp(&a.length));
        crossings.truncate(NEIGHBORS_OF_A_BLEND);
        let area = |label: u32| self.areas[label as usize];
        let is_corner = |label: u32| known.contains(&label) && area(label) > area(own);
        for (k, second) in crossings.iter().enumerate() {
            for first in &crossings[..k] {
                if self.is_between(own, [*first, *second], least, is_corner)? {
                    let is_first = area(first.label) >= area(second.label);
                    return Ok(Some(if is_first { first.label } else { second.label }));
                }
            }
        }
        Ok(None)
    }

    /// Whether segment `own` is in the place of the ridge of two neighbors; what is beyond those at a
    /// `corner` does not matter.
    fn is_between(
        &self,
        own: u32,
        pair: [Crossing; 2],
        least: f64,
        corner: impl Fn(u32) -> bool,
    ) -> Result<bool> {
        let [long, short] = [pair[0].length.max(pair[1].length), pair[0].length.min(pair[1].length)];
        let length = 0.5 * (long + short);
        if short < LEAST_AS_LONG * long || length <= 0.0 {
            return Ok(false);
        }
        let width = self.areas[own as usize] / length;
        let borders = pair.map(|crossing| &self.borders[own as usize][&crossing.label]);
        let edges: Vec<u32> = memory::sifted(borders.into_iter().flatten().copied())?;
        let inside = self.turn_from(own, &edges, None)? / length;
        let whole = inside + pair[0].turn + pair[1].turn;
        let side = whole.signum();
        let [inside, first, second] = [inside, pair[0].turn, pair[1].turn].map(|turn| side * turn);
        let most_against = -AGAINST * whole.abs();
        let is_bevel = inside < 0.5 * whole.abs();
        if is_bevel && length < LEAST_LONG * width {
            return Ok(false);
        }
        if whole.abs() < least || [inside, first, second].iter().any(|turn| *turn < most_against) {
            return Ok(false);
        }
        if ridge_over(width, inside.max(0.0), inside.max(0.0) + first.max(0.0) + second.max(0.0)) > width {
            return Ok(false);
        }
        for crossing in pair.into_iter().filter(|crossing| !corner(crossing.label)) {
            let edges = &self.borders[crossing.label as usize][&own];
            let beyond = self.turn_from(crossing.label, edges, Some(BESIDE_A_BLEND * width))?;
            let here = side * (whole - crossing.turn);
            if side * beyond >= MOST_BESIDE * here * crossing.length {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// What crosses the border along `edges` to the segment `label`. What a ridge turns by in the faces there
    /// that touch the border is of the border.
    fn crossing(&self, label: u32, edges: &[u32]) -> Result<Crossing> {
        let [mut length, mut turn] = [0.0; 2];
        for &h in edges {
            let [p, q] = ends(self.surface, &self.straight, h as usize);
            length += distance(p, q);
            turn += self.turn_about(h as usize, unit(sub(q, p)));
        }
        if !self.tessellated {
            let axes = self.axes(edges);
            for (h, axis) in self.row(label, edges, &axes)? {
                // Each edge is met from both sides.
                turn += 0.5 * self.turn_about(h, axis);
            }
        }
        Ok(Crossing { label, length, turn: turn / f64::max(length, f64::MIN_POSITIVE) })
    }

    /// The vertices of border `edges`, each with the direction of the border there.
    fn axes(&self, edges: &[u32]) -> BTreeMap<u32, Point> {
        let mut axes = BTreeMap::<u32, Point>::new();
        for &h in edges {
            let [p, q] = ends(self.surface, &self.straight, h as usize);
            let connectivity = self.surface.connectivity;
            for v in [connectivity.tail(h as usize), connectivity.head(h as usize)] {
                let axis = axes.entry(v).or_default();
                *axis = add(*axis, sub(q, p));
            }
        }
        axes
    }

    /// The halfedges inside of segment `label` that touch the border along `edges` of a neighbor, each with
    /// the direction of the border there.
    fn row(&self, label: u32, edges: &[u32], axes: &BTreeMap<u32, Point>) -> Result<Vec<(usize, Point)>> {
        let connectivity = self.surface.connectivity;
        let touches = |f: u32| connectivity.faces()[f as usize].iter().any(|v| axes.contains_key(v));
        let mut seen = BTreeSet::new();
        let mut queue: Vec<u32> = Vec::new();
        for &h in edges {
            let f = across(self.surface, h) as u32;
            if seen.insert(f) {
                memory::push(&mut queue, f)?;
            }
        }
        let (mut next, mut row) = (0, Vec::new());
        while let Some(&f) = queue.get(next) {
            next += 1;
            for (h, g) in self.surface.around(f as usize).filter(|&(_, g)| self.labels[g] == label) {
                let ends = [connectivity.tail(h), connectivity.head(h)];
                if let Some(axis) = ends.iter().find_map(|v| axes.get(v)) {
                    memory::push(&mut row, (h, unit(*axis)))?;
                }
                if touches(g as u32) && seen.insert(g as u32) {
                    memory::push(&mut queue, g as u32)?;
                }
            }
        }
        Ok(row)
    }

    /// By how much the surface turns about `axis` at an edge, times the length of that.
    fn turn_about(&self, h: usize, axis: Point) -> f64 {
        let [p, q] = ends(self.surface, self.points, h);
        self.turns[h] * dot(unit(sub(q, p)), axis).powi(2)
    }

    /// By how much segment `own` turns about some of its border `edges`, in all of it, or as far from them as
    /// `reach`, there also at its other borders; times their length.
    fn turn_from(&self, own: u32, edges: &[u32], reach: Option<f64>) -> Result<f64> {
        let mut source = BTreeMap::new();
        let mut queue: Vec<u32> = Vec::new();
        for &h in edges {
            if source.insert(h / 3, h).is_none() {
                memory::push(&mut queue, h / 3)?;
            }
        }
        let is_near = |p: Point, from: u32| {
            let [a, b] = ends(self.surface, &self.straight, from as usize);
            reach.is_none_or(|reach| distance(p, closest_on_segment(p, a, b)) <= reach)
        };
        let mut next = 0;
        while let Some(&f) = queue.get(next) {
            next += 1;
            let from = source[&f];
            for (_, g) in self.surface.around(f as usize) {
                let center = || self.surface.connectivity.faces()[g].map(|v| self.points[v as usize]);
                let is_new = self.labels[g] == own && !source.contains_key(&(g as u32));
                if is_new && is_near(centroid(center()), from) {
                    source.insert(g as u32, from);
                    memory::push(&mut queue, g as u32)?;
                }
            }
        }
        // Beyond a border, what touches it is of the border.
        let axes = if reach.is_some() && !self.tessellated { self.axes(edges) } else { BTreeMap::new() };
        let touches = |h: usize| {
            let connectivity = self.surface.connectivity;
            axes.contains_key(&connectivity.tail(h)) || axes.contains_key(&connectivity.head(h))
        };
        let mut turn = 0.0;
        for (&f, &from) in &source {
            let [a, b] = ends(self.surface, &self.straight, from as usize);
            let axis = unit(sub(b, a));
            for (h, g) in self.surface.around(f as usize).filter(|&(h, _)| !touches(h)) {
                if self.labels[g] == own {
                    // Each edge inside is seen from both sides.
                    turn +=
                        if source.contains_key(&(g as u32)) { 0.5 * self.turn_about(h, axis) } else { 0.0 };
                } else if reach.is_some() && self.labels[g] != self.labels[across(self.surface, from)] {
                    let [p, q] = ends(self.surface, self.points, h);
                    turn += if is_near(between(p, q, 0.5), from) { self.turn_about(h, axis) } else { 0.0 };
                }
            }
        }
        Ok(turn)
    }
}

/// The ends of halfedge `h`.
fn ends(surface: &Surface<'_>, points: &[Point], h: usize) -> [Point; 2] {
    [surface.connectivity.tail(h), surface.connectivity.head(h)].map(|v| points[v as usize])
}

/// The face across halfedge `h`, which has one.
fn across(surface: &Surface<'_>, h: u32) -> usize {
    surface.neighbors[h as usize / 3][h as usize % 3] as usize
}

/// How far the ridge of two planes is from the middle of an arc between them, so wide, that turns by
/// `inside`, where the planes differ by `whole`.
fn ridge_over(width: f64, inside: f64, whole: f64) -> f64 {
    if whole >= std::f64::consts::PI {
        return f64::INFINITY;
    }
    let half = 0.5 * inside;
    let chord = if half > 0.0 { width * half.sin() / half } else { width };
    0.5 * chord * ((0.5 * whole).tan() - (0.5 * half).tan())
}

/// The vertices, those along borders each the mean of itself and its neighbors there, so many times. Corners
/// stay.
fn straight(surface: &Surface<'_>, labels: &[u32], points: &[Point], rounds: usize) -> Result<Vec<Point>> {
    let mut beside: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for h in surface.connectivity.edges() {
        let g = surface.neighbors[h / 3][h % 3];
        if g != NONE && labels[g as usize] != labels[h / 3] {
            let [v, w] = [surface.connectivity.tail(h), surface.connectivity.head(h)];
            memory::push(beside.entry(v).or_default(), w)?;
            memory::push(beside.entry(w).or_default(), v)?;
        }
    }
    let mut straight = memory::twin(points)?;
    for _ in 0..rounds {
        let before = memory::twin(&straight)?;
        for (&v, beside) in beside.iter().filter(|(_, beside)| beside.len() == 2) {
            let ends = beside.iter().fold([0.0; 3], |sum, &w| add(sum, before[w as usize]));
            straight[v as usize] = between(before[v as usize], ends.map(|x| 0.5 * x), 0.5);
        }
    }
    Ok(straight)
}
