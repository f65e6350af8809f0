//! Faces of a mesh that lie on facets, and what is done about those that are folded there: vertices move
//! within their facets, then edges flip.

use std::collections::HashMap;

use super::regions::OUTSIDE;
use super::shape::Shape;
use crate::buckets::Buckets;
use crate::mesh::vector::{add, area_vector, cross, dot, scale, sub, Point};
use crate::mesh::{Connectivity, FILE_ROUNDING};
use crate::ordered::Ordered;
use crate::{memory, Result};

/// Rounds of moving vertices, and of flipping edges, around faces that are folded.
const ROUNDS: usize = 50;

/// Faces on facets.
pub(super) struct Sheet<'a> {
    shape: &'a Shape,
    labels: &'a [u32],
    faces: Vec<[u32; 3]>,
    /// The corner of the mesh that each corner was.
    pub(super) corners: Vec<[u32; 3]>,
}

impl<'a> Sheet<'a> {
    pub(super) fn new(connectivity: &Connectivity, shape: &'a Shape, labels: &'a [u32]) -> Result<Self> {
        let own = |f: u32| [3 * f, 3 * f + 1, 3 * f + 2];
        let corners = memory::gathered((0..labels.len() as u32).map(own))?;
        Ok(Self { shape, labels, faces: memory::twin(connectivity.faces())?, corners })
    }

    /// How well a face lies on its facet: twice its area over its longest side squared, negative where it is
    /// turned over.
    fn upright(&self, f: usize, at: impl Fn(u32) -> Point) -> f64 {
        self.upright_as(f, self.faces[f], at)
    }

    /// The same of a face in its place.
    fn upright_as(&self, of: usize, face: [u32; 3], at: impl Fn(u32) -> Point) -> f64 {
        let corners = face.map(at);
        let normal = self.shape.facets[self.labels[of] as usize].plane.normal;
        let sides = [0, 1, 2].map(|i| sub(corners[(i + 1) % 3], corners[i]));
        let longest = sides.iter().map(|side| dot(*side, *side)).fold(f64::MIN_POSITIVE, f64::max);
        2.0 * dot(area_vector(corners), normal) / longest
    }

    fn is_folded(&self, f: usize, places: &[Point]) -> bool {
        let label = self.labels[f];
        label != OUTSIDE
            && !self.shape.facets[label as usize].is_held
            && self.upright(f, |v| places[v as usize]) <= FILE_ROUNDING
    }

    /// Faces that are folded, or not on their facets, as where more than two faces meet at an edge.
    pub(super) fn n_folded(&self, places: &[Point]) -> usize {
        let is_off = |f: usize| {
            let facet = self.shape.facets.get(self.labels[f] as usize).filter(|facet| !facet.is_held);
            let off = |v: u32| facet.map_or(0.0, |facet| facet.plane.height(places[v as usize]).abs());
            self.faces[f].into_iter().any(|v| off(v) > FILE_ROUNDING)
        };
        (0..self.faces.len()).filter(|&f| self.is_folded(f, places) || is_off(f)).count()
    }

    /// How many faces of each facet are folded.
    pub(super) fn folded_of_facets(&self, places: &[Point]) -> Result<Vec<u32>> {
        let mut counts = memory::repeated(0, self.shape.facets.len())?;
        for f in (0..self.faces.len()).filter(|&f| self.is_folded(f, places)) {
            counts[self.labels[f] as usize] += 1;
        }
        Ok(counts)
    }

    /// Moves vertices that are free to, and flips edges, until no face is folded or nothing helps; returns
    /// how many edges were flipped.
    pub(super) fn unfold(&mut self, places: &mut [Point], is_free: impl Fn(u32) -> bool) -> Result<usize> {
        self.relax(places, is_free)?;
        let mut n_flipped = 0;
        for _ in 0..ROUNDS {
            let folded: Vec<usize> =
                memory::sifted((0..self.faces.len()).filter(|&f| self.is_folded(f, places)))?;
            let before = n_flipped;
            if !folded.is_empty() {
                let mut edges = self.edges()?;
                for f in folded {
                    n_flipped += usize::from(self.flip(f, places, &mut edges)?);
                }
            }
            if n_flipped == before {
                break;
            }
        }
        Ok(n_flipped)
    }

    /// Moves the vertices of folded faces, and of more around them each round, to where the worst of their
    /// faces is best: of the middle of their neighbors and places straight off the side across that one.
    fn relax(&self, places: &mut [Point], is_free: impl Fn(u32) -> bool) -> Result<()> {
        let mut is_near = memory::repeated(false, places.len())?;
        let mut around: Option<Buckets<u32>> = None;
        for _ in 0..ROUNDS {
            let folded: Vec<usize> =
                memory::sifted((0..self.faces.len()).filter(|&f| self.is_folded(f, places)))?;
            if folded.is_empty() {
                break;
            }
            let around = match &mut around {
                Some(around) => around,
                None => around.insert(self.around(places.len())?),
            };
            for v in folded.into_iter().flat_map(|f| self.faces[f]) {
                let ring = around.of(v as usize).iter().flat_map(|&f| self.faces[f as usize]);
                ring.for_each(|w| is_near[w as usize] = is_free(w));
            }
            let mut is_moved = false;
            for v in (0..places.len() as u32).filter(|&v| is_near[v as usize]) {
                // A face that names a vertex twice lies on no facet.
                let own: Vec<u32> = memory::sifted(
                    around.of(v as usize).iter().copied().filter(|&f| self.labels[f as usize] != OUTSIDE),
                )?;
                let worst = |place: Point| {
                    let at = |w: u32| if w == v { place } else { places[w as usize] };
                    let faces = own.iter().map(|&f| (Ordered(self.upright(f as usize, at)), f as usize));
                    faces.min().unwrap_or((Ordered(0.0), 0))
                };
                let (before, f) = worst(places[v as usize]);
                let tried = self.better(v, f, &own, places).map(|place| (worst(place).0, place));
                let best = tried.into_iter().max_by_key(|&(least, _)| least);
                if let Some((_, place)) = best.filter(|(least, _)| *least > before) {
                    places[v as usize] = place;
                    is_moved = true;
                }
            }
            if !is_moved {
                break;
            }
        }
        Ok(())
    }

    /// Places for a vertex of face `f`, of whose faces that is the worst.
    fn better(&self, v: u32, f: usize, own: &[u32], places: &[Point]) -> [Point; 4] {
        let others = || own.iter().flat_map(|&f| self.faces[f as usize]).filter(|&w| w != v);
        let sum = others().fold([0.0; 3], |sum, w| add(sum, places[w as usize]));
        let middle = scale(sum, 1.0 / others().count().max(1) as f64);
        let i = (0..3).find(|&i| self.faces[f][i] == v).unwrap_or(0);
        let [a, b] = [1, 2].map(|j| places[self.faces[f][(i + j) % 3] as usize]);
        let off = cross(self.shape.facets[self.labels[f] as usize].plane.normal, sub(b, a));
        let step = |part: f64| add(places[v as usize], scale(off, part));
        [middle, step(0.5), step(0.125), step(0.03125)]
    }

    /// The faces at each of `n` vertices.
    fn around(&self, n: usize) -> Result<Buckets<u32>> {
        Ok(Buckets::new(n, |visit| {
            for (f, face) in (0_u32..).zip(&self.faces) {
                face.iter().for_each(|&v| visit(v as usize, f));
            }
        })?)
    }

    /// The face that has each directed edge; none where several do.
    fn edges(&self) -> Result<HashMap<[u32; 2], Option<usize>>> {
        let mut edges = HashMap::new();
        memory::extend_map(&mut edges, 3 * self.faces.len())?;
        for (f, &[a, b, c]) in self.faces.iter().enumerate() {
            for edge in [[a, b], [b, c], [c, a]] {
                edges.entry(edge).and_modify(|known| *known = None).or_insert(Some(f));
            }
        }
        Ok(edges)
    }

    /// Flips the edge of a face, within its facet, after which the worse of both faces is best, if that is
    /// better than it was.
    fn flip(
        &mut self,
        f: usize,
        places: &[Point],
        edges: &mut HashMap<[u32; 2], Option<usize>>,
    ) -> Result<bool> {
        let mut best: Option<(f64, usize, usize, usize)> = None;
        for i in 0..3 {
            let [a, b, c] = [0, 1, 2].map(|j| self.faces[f][(i + j) % 3]);
            let Some(&Some(g)) = edges.get(&[b, a]) else { continue };
            let Some(j) = (0..3).find(|&j| self.faces[g][j] == b) else { continue };
            let d = self.faces[g][(j + 2) % 3];
            let is_there = edges.contains_key(&[c, d]) || edges.contains_key(&[d, c]);
            if self.labels[g] != self.labels[f] || c == d || is_there {
                continue;
            }
            let at = |v: u32| places[v as usize];
            let least = |one, other| self.upright_as(f, one, at).min(self.upright_as(f, other, at));
            let now = least([c, a, d], [c, d, b]);
            if now > least([a, b, c], [b, a, d]) && best.is_none_or(|best| now > best.0) {
                best = Some((now, i, g, j));
            }
        }
        let Some((_, i, g, j)) = best else { return Ok(false) };
        let turned = |rows: &[[u32; 3]]| {
            let [a, b, c] = [0, 1, 2].map(|k| rows[f][(i + k) % 3]);
            // Of the other face the corners after the side that both have, and the first of it.
            let (other, d) = (rows[g][j], rows[g][(j + 2) % 3]);
            ([c, a, d], [c, d, other], [a, b])
        };
        let (one, other, [a, b]) = turned(&self.faces);
        let corners = turned(&self.corners);
        let (c, d) = (one[0], one[2]);
        (self.faces[f], self.faces[g]) = (one, other);
        (self.corners[f], self.corners[g]) = (corners.0, corners.1);
        for gone in [[a, b], [b, a]] {
            edges.remove(&gone);
        }
        memory::extend_map(edges, 2)?;
        edges.extend([
            ([c, a], Some(f)),
            ([a, d], Some(f)),
            ([d, c], Some(f)),
            ([c, d], Some(g)),
            ([d, b], Some(g)),
            ([b, c], Some(g)),
        ]);
        Ok(true)
    }
}
