//! Edge collapses in the order of how far they leave the surface (Garland and Heckbert 1997), in bulk.
//!
//! A queue of all edges costs more than the collapses. So edges collapse in passes: of as many edges as
//! vertices are still to go, the cheapest, each whose ends have not changed in the pass. What the queue
//! would do is done in the same order but for the neighborhoods of collapses, which wait for the next pass.

use rayon::prelude::*;

use crate::linear::small::Quadric;
use crate::mesh::partition::Partition;
use crate::mesh::vector::{add, area_vector, cross, dot, norm, quality, sub, unit, Point};
use crate::mesh::Connectivity;
use crate::ordered::Ordered;
use crate::remesh::EditableMesh;
use crate::shape_guard::{is_thinned, is_turned};
use crate::{memory, Progress, Result};

/// How much a distance along the surface counts beside one away from it, squared: enough that flat regions
/// get even triangles, too little to draw a vertex from a ridge.
const ALONG: f64 = 1e-3;

/// A vertex stands for at most so many times the area that the vertices of its level have on average. Where
/// a part of the surface cannot collapse, as at a pole of a thousand slivers under noise, the level then has
/// more vertices than wanted; without a limit the rest of the surface would have next to none (a cylinder
/// became a box). Levels of even meshes have vertices of up to 4 times.
const MOST_AREA: f64 = 8.0;

/// Collapses between two looks at whether to go on.
const CHECK_EVERY: usize = 1024;

/// How many vertices or edges a thread takes at once: some microseconds of work.
const AT_ONCE: usize = 256;

/// A surface whose edges collapse, with the planes of all faces that each vertex stands for.
#[derive(Debug)]
pub(super) struct Collapser {
    mesh: EditableMesh,
    quadrics: Vec<Quadric>,
    kinds: Vec<Kind>,
    /// The box around the vertices that have faces, wider by its longest side on each.
    within: [Point; 2],
    /// The area of all faces, as the weights of the quadrics have it.
    area: f64,
    /// The most of it that a vertex of the present level may stand for.
    most: f64,
    /// Which vertices have changed in the present pass.
    is_changed: Vec<bool>,
    /// What a vertex collapsed into; itself while it is there.
    into: Partition,
    /// The vertices of the last level that was asked for.
    last: Vec<u32>,
    n_left: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Kind {
    is_held: bool,
    is_border: bool,
    /// At an edge with three faces, or where two fans meet, or kept by the caller.
    is_locked: bool,
}

/// Cost and ends.
type Candidate = (Ordered, [u32; 2]);

impl Collapser {
    pub(super) fn new(
        connectivity: &Connectivity,
        positions: &[Point],
        [held, kept]: [Option<&[bool]>; 2],
        progress: &Progress,
    ) -> Result<Self> {
        let n = positions.len();
        let mesh = EditableMesh::new(memory::twin(positions)?, memory::twin(connectivity.faces())?)?;
        progress.check()?;
        let found = (0..n as u32).into_par_iter().with_min_len(AT_ONCE).map(|v| quadric(&mesh, v));
        let mut quadrics: Vec<Quadric> = memory::joined(found)?;
        let manifold = (0..n as u32).into_par_iter().with_min_len(AT_ONCE).map(|v| mesh.is_manifold(v));
        let kind = |(v, is_manifold): (usize, bool)| Kind {
            is_held: held.is_some_and(|held| held[v]),
            is_border: false,
            is_locked: !is_manifold || kept.is_some_and(|kept| kept[v]),
        };
        progress.check()?;
        let mut kinds: Vec<Kind> = memory::joined(manifold.enumerate().map(kind))?;
        progress.check()?;
        // A border is kept by the planes through its edges across their faces.
        for h in connectivity.boundary() {
            let [tail, head, tip] = [connectivity.tail(h), connectivity.head(h), connectivity.opposite(h)];
            let [a, b, c] = [tail, head, tip].map(|v| mesh.position(v));
            let along = sub(b, a);
            let across = unit(cross(along, area_vector([a, b, c])));
            for v in [tail, head] {
                quadrics[v as usize].add(dot(along, along), across, dot(across, a));
                kinds[v as usize].is_border = true;
            }
        }
        Ok(Self {
            within: around(connectivity.faces().iter().flatten().map(|&v| positions[v as usize])),
            n_left: (0..n as u32).filter(|&v| !mesh.faces_of(v).is_empty()).count(),
            area: quadrics.iter().map(Quadric::weight).sum(),
            quadrics,
            kinds,
            most: f64::INFINITY,
            is_changed: memory::repeated(false, n)?,
            into: Partition::new(n)?,
            last: memory::numbers(n)?,
            mesh,
        })
    }

    /// How many vertices have faces.
    pub(super) fn n_left(&self) -> usize {
        self.n_left
    }

    /// Collapses edges until no more than `wanted` vertices are left, or none can any more.
    pub(super) fn reduce_to(&mut self, wanted: usize, progress: &Progress) -> Result<()> {
        self.most = MOST_AREA * self.area / wanted.max(1) as f64;
        let mut changed = memory::twin(&self.last)?;
        let mut candidates: Vec<Candidate> = Vec::new();
        loop {
            changed.iter().for_each(|&v| self.is_changed[v as usize] = true);
            candidates.retain(|&(_, ends)| ends.iter().all(|&v| !self.is_changed[v as usize]));
            self.add_candidates(&changed, &mut candidates, progress)?;
            changed.iter().for_each(|&v| self.is_changed[v as usize] = false);
            changed.clear();
            let count = self.n_left.saturating_sub(wanted).min(candidates.len());
            if count == 0 {
                return Ok(());
            }
            if count < candidates.len() {
                candidates.select_nth_unstable(count);
            }
            let mut tried = memory::twin(&candidates[..count])?;
            candidates.drain(..count);
            tried.par_sort_unstable();
            for (i, (_, [a, b])) in tried.into_iter().enumerate() {
                if i.is_multiple_of(CHECK_EVERY) {
                    progress.check()?;
                }
                if !self.is_changed[a as usize] && !self.is_changed[b as usize] {
                    self.collapse(a, b, &mut changed)?;
                }
            }
        }
    }

    /// Which vertices of the last level are held.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing, here and below.
    pub(super) fn held(&self) -> Result<Vec<bool>> {
        Ok(memory::gathered(self.last.iter().map(|&v| self.kinds[v as usize].is_held))?)
    }

    /// Points and faces as they are now, and which of the points stands for each vertex of the last level.
    #[allow(clippy::type_complexity)]
    pub(super) fn level(&mut self) -> Result<(Vec<Point>, Vec<[u32; 3]>, Vec<u32>)> {
        let used = (0..self.mesh.n_vertices() as u32).filter(|&v| !self.mesh.faces_of(v).is_empty());
        let kept: Vec<u32> = memory::sifted(used)?;
        let mut number = memory::repeated(u32::MAX, self.mesh.n_vertices())?;
        kept.iter().zip(0..).for_each(|(&v, new)| number[v as usize] = new);
        let into = &mut self.into;
        let parents = memory::gathered(self.last.iter().map(|&v| number[into.root(v) as usize]))?;
        let points = memory::gathered(kept.iter().map(|&v| self.mesh.position(v)))?;
        let faces = self.mesh.faces().map(|(_, face)| face.map(|v| number[v as usize]));
        let faces = memory::sifted(faces)?;
        self.last = kept;
        Ok((points, faces, parents))
    }

    /// Adds the edges at the vertices that have changed, each once.
    fn add_candidates(
        &self,
        vertices: &[u32],
        candidates: &mut Vec<Candidate>,
        progress: &Progress,
    ) -> Result<()> {
        let at = |&v: &u32| {
            let others = self.mesh.neighbors(v).into_iter();
            others.filter(move |&w| v < w || !self.is_changed[w as usize]).filter_map(move |w| {
                let ends = if v < w { [v, w] } else { [w, v] };
                self.candidate(ends)
            })
        };
        // Parts that are small, and then all of them in order: a whole in one piece cannot be refused.
        for many in vertices.chunks(AT_ONCE * AT_ONCE) {
            progress.check()?;
            let found = many.par_chunks(AT_ONCE).map(|few| few.iter().flat_map(at).collect());
            let found: Vec<Vec<Candidate>> = memory::joined(found)?;
            memory::extend(candidates, found.iter().map(Vec::len).sum())?;
            candidates.extend(found.into_iter().flatten());
        }
        Ok(())
    }

    fn candidate(&self, [a, b]: [u32; 2]) -> Option<Candidate> {
        let (point, sum) = (self.place(a, b)?, self.sum(a, b));
        (sum.weight() <= self.most).then(|| (Ordered(sum.value(point)), [a, b]))
    }

    fn sum(&self, a: u32, b: u32) -> Quadric {
        self.quadrics[a as usize].plus(&self.quadrics[b as usize])
    }

    /// Where the two would become one, if they may.
    fn place(&self, a: u32, b: u32) -> Option<Point> {
        let (one, other) = (self.kinds[a as usize], self.kinds[b as usize]);
        if one.is_locked || other.is_locked || one.is_held != other.is_held {
            return None;
        }
        match (self.stays(a), self.stays(b)) {
            (true, true) => None,
            (true, false) => Some(self.mesh.position(a)),
            (false, true) => Some(self.mesh.position(b)),
            (false, false) if one.is_border != other.is_border => {
                Some(self.mesh.position(if one.is_border { a } else { b }))
            }
            // Far from the origin rounding can leave it anywhere.
            (false, false) => self.sum(a, b).minimizer().filter(|point| self.is_within(point)),
        }
    }

    fn is_within(&self, point: &Point) -> bool {
        let [low, high] = &self.within;
        (0..3).all(|c| point[c] >= low[c] && point[c] <= high[c])
    }

    /// A vertex with thousands of faces is never moved: each move would look at all of them.
    fn stays(&self, v: u32) -> bool {
        self.mesh.is_hub(v)
    }

    /// Makes two vertices one if that keeps the surface, and notes which have changed. A hub has not, it only
    /// has more faces.
    fn collapse(&mut self, a: u32, b: u32, changed: &mut Vec<u32>) -> Result<()> {
        let Some(point) = self.place(a, b) else { return Ok(()) };
        // Into the one that stays, or that is on the border.
        let goes_to_a = self.stays(a) || !self.stays(b) && self.kinds[a as usize].is_border;
        let (from, to) = if goes_to_a { (b, a) } else { (a, b) };
        if !self.keeps_shape(from, to, point) || !self.mesh.collapse(from, to, point) {
            return Ok(());
        }
        self.quadrics[to as usize] = self.sum(from, to);
        self.into.attach(from, to);
        self.n_left -= 1;
        let noted: &[u32] = if self.stays(to) { &[from] } else { &[from, to] };
        memory::extend(changed, 2)?;
        changed.extend(noted);
        noted.iter().for_each(|&v| self.is_changed[v as usize] = true);
        Ok(())
    }

    /// Whether no face that stays turns over, unless it lay folded over, and none becomes a thinner sliver
    /// than there was: slivers have to go some way.
    fn keeps_shape(&self, from: u32, to: u32, point: Point) -> bool {
        let around = |v: u32| self.mesh.faces_of(v).iter().filter_map(|&f| self.mesh.face(f));
        let is_gone = |face: &[u32; 3]| face.contains(&from) && face.contains(&to);
        let moves_to = !self.stays(to);
        let all = || around(from).chain(around(to).filter(|face| moves_to && !face.contains(&from)));
        let mut common = [0.0; 3];
        let mut thinnest = f64::INFINITY;
        for face in all() {
            let corners = self.mesh.corners(face);
            common = add(common, area_vector(corners));
            thinnest = thinnest.min(quality(corners));
        }
        all().filter(|face| !is_gone(face)).all(|face| {
            let normal = area_vector(self.mesh.corners(face));
            let new = face.map(|v| if v == from || v == to { point } else { self.mesh.position(v) });
            let is_folded = dot(normal, common) < 0.0;
            let reference = if is_folded { common } else { normal };
            (norm(normal) <= 0.0 || !is_turned(new, reference)) && !is_thinned(quality(new), thinnest)
        })
    }
}

/// The box around `points`, wider by its longest side on each.
fn around(points: impl Iterator<Item = Point>) -> [Point; 2] {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in points {
        for c in 0..3 {
            (low[c], high[c]) = (low[c].min(p[c]), high[c].max(p[c]));
        }
    }
    let side = (0..3).map(|c| high[c] - low[c]).fold(0.0, f64::max);
    [low.map(|x| x - side), high.map(|x| x + side)]
}

/// The planes of the faces of `v`, each by a third of its area.
fn quadric(mesh: &EditableMesh, v: u32) -> Quadric {
    let mut sum = Quadric::default();
    let point = mesh.position(v);
    for face in mesh.faces_of(v).iter().filter_map(|&f| mesh.face(f)) {
        let area = area_vector(mesh.corners(face));
        let (weight, normal) = (norm(area) / 3.0, unit(area));
        sum.add(weight, normal, dot(normal, point));
        sum.add_point(ALONG * weight, point);
    }
    sum
}
