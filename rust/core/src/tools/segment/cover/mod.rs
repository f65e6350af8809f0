//! Parts as CAD kernels tessellate them: every vertex lies on the surfaces of its faces, to rounding, so
//! faces that are tangent to each other, which no bend parts, are told by their surfaces.
//!
//! Spheres, tori, cylinders and cones begin with a few facets ([`starts`]), grow as far as facets lie on them
//! ([`grow`]), and are taken for faces, those with the most vertices first, where coincidences beyond those
//! that determine them speak for them ([`evidence`]). What is left of an exact shape goes by its bends, as
//! other exact shapes do.

mod evidence;
mod facets;
mod grow;
mod starts;

use super::constants::{
    BLUNT, FACETS_OF_A_START, LEAST_COVERED, LEAST_COVERED_OF_SAMPLE, MOST_BEND_ON_A_SURFACE, MOST_INSIDE,
    SAMPLED_EDGES, SINGLE_PRECISION,
};
use super::exact::Planes;
use super::surface::{Surface, NONE};
use crate::mesh::vector::{cross, norm};
use crate::progress::Progress;
use crate::surfaces::{Kind, Surface as Named};
use crate::{memory, Result};
use facets::{Marks, Shape};
use grow::Grown;

/// The faces of an exact shape that are more than planes, and the facets of what is left, where sides differ
/// by more than `bend`; nothing where surfaces do not explain most of what is curved.
///
/// # Errors
/// [`crate::Error::Cancelled`], and [`crate::Error::Solve`] where memory is missing.
pub(super) fn covered(surface: &Surface<'_>, bend: f64, progress: &Progress) -> Result<Option<Planes>> {
    let shape = exact_shape(surface, bend)?;
    if has_many_inside(&shape, surface)? {
        return Ok(None);
    }
    let smooth = |f: &u32| shape.links(*f).iter().any(|link| link.bend < MOST_BEND_ON_A_SURFACE);
    let curved: Vec<u32> = memory::sifted((0..shape.len() as u32).filter(smooth))?;
    if curved.is_empty() {
        return Ok(None);
    }
    let n = shape.len();
    let mut search = Search {
        shape: &shape,
        found: Vec::new(),
        known: memory::repeated(Vec::new(), n)?,
        marks: Marks::new(n)?,
        progress,
    };
    // A sample says whether it is worth while: scans and characters have no such surfaces.
    let step = curved.len().div_ceil(SAMPLED_EDGES);
    let sample: Vec<u32> = memory::sifted(curved.iter().copied().step_by(step))?;
    search.at_edges(&sample)?;
    let is_known = |search: &Search<'_>, f: &&u32| !search.known[**f as usize].is_empty();
    let n_known = sample.iter().filter(|f| is_known(&search, f)).count();
    if (n_known as f64) < LEAST_COVERED_OF_SAMPLE * sample.len() as f64 {
        return Ok(None);
    }
    search.at_edges(&curved)?;
    search.by_normals(&curved)?;
    let (mut taken, surfaces) = search.taken()?;
    without_strips(&shape, &mut taken, &surfaces)?;
    with_cut_facets(&shape, &mut taken, &surfaces);
    let n_taken = curved.iter().filter(|&&f| taken[f as usize] != NONE).count();
    if (n_taken as f64) < LEAST_COVERED * curved.len() as f64 {
        return Ok(None);
    }
    let count = taken.iter().filter(|t| **t != NONE).map(|t| t + 1).max().unwrap_or(0);
    let own = |&f: &u32| match taken[f as usize] {
        NONE => count + f,
        taken => taken,
    };
    let group = |&f: &u32| taken[f as usize].min(count);
    Ok(Some(Planes {
        labels: super::surface::pieces(surface, &memory::gathered(shape.labels.iter().map(own))?)?.0,
        normals: memory::gathered(shape.labels.iter().map(|&f| shape.normals[f as usize]))?,
        groups: Some(memory::gathered(shape.labels.iter().map(group))?),
    }))
}

/// Whether an exact mesh is even, with vertices inside of its planes, as no kernel makes it.
///
/// # Errors
/// [`crate::Error::Solve`] where memory is missing.
pub(super) fn is_even(surface: &Surface<'_>, bend: f64) -> Result<bool> {
    has_many_inside(&exact_shape(surface, bend)?, surface)
}

fn exact_shape<'a>(surface: &'a Surface<'_>, bend: f64) -> Result<Shape<'a>> {
    let largest = surface.positions.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    Shape::new(surface, SINGLE_PRECISION * largest, bend.min(MOST_BEND_ON_A_SURFACE))
}

fn has_many_inside(shape: &Shape<'_>, surface: &Surface<'_>) -> Result<bool> {
    Ok(shape.n_inside(surface)? as f64 > MOST_INSIDE * shape.positions.len() as f64)
}

/// Surfaces that are found one by one.
struct Search<'a> {
    shape: &'a Shape<'a>,
    /// Those that something speaks for, with the number of their vertices.
    found: Vec<(Grown, usize)>,
    /// Which of them each facet lies on.
    known: Vec<Vec<u32>>,
    marks: Marks,
    progress: &'a Progress,
}

impl Search<'_> {
    /// Looks for spheres, tori and cylinders at the edges of facets.
    fn at_edges(&mut self, facets: &[u32]) -> Result<()> {
        let shape = self.shape;
        for kind in [Kind::Sphere, Kind::Torus, Kind::Cylinder] {
            // The last surface that was grown over each facet: what it holds would begin it again.
            let (mut last, mut count) = (memory::repeated(NONE, shape.len())?, 0);
            for &f in facets {
                self.progress.check()?;
                if self.progress.is_finishing() {
                    return Ok(());
                }
                for link in shape.links(f).iter().filter(|link| link.bend < MOST_BEND_ON_A_SURFACE) {
                    let Some((seed, start)) = shape.start_at(kind, f, link)? else { continue };
                    let one = last[f as usize];
                    let is_old = one != NONE && seed.iter().all(|&g| last[g as usize] == one);
                    if is_old || self.is_known(&seed) {
                        continue;
                    }
                    let Some(grown) = shape.grown(&mut self.marks, &seed, &start)? else { continue };
                    grown.facets.iter().for_each(|&g| last[g as usize] = count);
                    count += 1;
                    self.keep(grown)?;
                }
            }
        }
        Ok(())
    }

    /// Looks for cylinders and cones that facets without a pattern lie on, where nothing is known yet.
    fn by_normals(&mut self, facets: &[u32]) -> Result<()> {
        let shape = self.shape;
        for kind in [Kind::Cylinder, Kind::Cone] {
            for &f in facets {
                self.progress.check()?;
                if self.progress.is_finishing() {
                    return Ok(());
                }
                if !self.known[f as usize].is_empty() {
                    continue;
                }
                let links = shape.links(f).iter().filter(|link| link.bend < MOST_BEND_ON_A_SURFACE);
                let rows = links.map(|link| shape.row(f, link));
                for seed in FACETS_OF_A_START.map(|most| shape.nearest(f, most)).into_iter().chain(rows) {
                    let Some(start) = shape.start_of(kind, &seed)? else { continue };
                    let Some(grown) = shape.grown(&mut self.marks, &seed, &start)? else { continue };
                    if self.keep(grown)? {
                        break;
                    }
                }
            }
        }
        Ok(())
    }

    /// Whether one surface is known that all of these facets lie on.
    fn is_known(&self, facets: &[u32]) -> bool {
        let mut first = self.known[facets[0] as usize].iter();
        first.any(|one| facets.iter().all(|&f| self.known[f as usize].contains(one)))
    }

    /// Keeps a surface where something speaks for it.
    fn keep(&mut self, grown: Grown) -> Result<bool> {
        let Some(held) = self.shape.held(&mut self.marks, &grown)? else { return Ok(false) };
        let name = self.found.len() as u32;
        for &f in &grown.facets {
            memory::push(&mut self.known[f as usize], name)?;
        }
        memory::push(&mut self.found, (grown, held))?;
        Ok(true)
    }

    /// Which of the surfaces each facet belongs to, or [`NONE`]: those that hold the most vertices take
    /// theirs first, and of the others what is left, if that speaks for them still. They come with it.
    fn taken(self) -> Result<Taken> {
        let Self { shape, mut found, mut marks, .. } = self;
        let mut taken = memory::repeated(NONE, shape.len())?;
        let mut surfaces = Vec::new();
        found.sort_by_key(|(_, held)| *held);
        while let Some((grown, _)) = found.pop() {
            self.progress.check()?;
            let before = grown.facets.len();
            let facets: Vec<u32> =
                memory::sifted(grown.facets.into_iter().filter(|&f| taken[f as usize] == NONE))?;
            if facets.len() == before {
                facets.iter().for_each(|&f| taken[f as usize] = surfaces.len() as u32);
                memory::push(&mut surfaces, grown.surface)?;
                continue;
            }
            let facets = largest_piece(shape, &facets)?;
            let grown = Grown { surface: grown.surface, facets };
            if let Some(held) = shape.held(&mut marks, &grown)? {
                let place = found.partition_point(|(_, other)| *other <= held);
                found.insert(place, (grown, held));
            }
        }
        Ok((taken, surfaces))
    }
}

/// Which surface each facet belongs to, or [`NONE`], and the surfaces.
type Taken = (Vec<u32>, Vec<Named>);

/// The same without surfaces that meet another one too bluntly for an edge everywhere, yet are not tangent to
/// it: a bevel swept along a curve has a cylinder for each of its chords, and is one face.
fn without_strips(shape: &Shape<'_>, taken: &mut [u32], surfaces: &[Named]) -> Result<()> {
    // By pairs, whether their normals differ anywhere, and the most that facets bend: a miter begins bluntly.
    let mut borders: std::collections::BTreeMap<[u32; 2], (bool, f64)> = std::collections::BTreeMap::new();
    for f in 0..shape.len() as u32 {
        for link in shape.links(f) {
            let [own, other] = [f, link.facet].map(|f| taken[f as usize]);
            if own >= other || other == NONE {
                continue;
            }
            let [a, b] = [own, other].map(|k| &surfaces[k as usize]);
            let is_blunt = link.ends.iter().all(|&v| {
                let [m, n] = [a, b].map(|surface| surface.distance(shape.positions[v as usize]).1);
                norm(cross(m, n)) > BLUNT
            });
            let border = borders.entry([own, other]).or_insert((false, 0.0));
            *border = (border.0 || is_blunt, border.1.max(link.bend));
        }
    }
    let mut is_strip = memory::repeated(false, surfaces.len())?;
    for (pair, _) in borders.iter().filter(|(_, (is_blunt, most))| *is_blunt && *most < shape.bend) {
        pair.iter().for_each(|&k| is_strip[k as usize] = true);
    }
    for taken in taken {
        if *taken != NONE && is_strip[*taken as usize] {
            *taken = NONE;
        }
    }
    Ok(())
}

/// Gives surfaces the facets beside them that would lie on them but for vertices on ridges: where modeled
/// shapes are cut, these lie on the facets of both, not on the surfaces.
fn with_cut_facets(shape: &Shape<'_>, taken: &mut [u32], surfaces: &[Named]) {
    for f in 0..shape.len() as u32 {
        if taken[f as usize] != NONE {
            continue;
        }
        let beside = shape.links(f).iter().filter(|link| link.bend < shape.bend);
        let known =
            beside.filter_map(|link| Some((link, *surfaces.get(*taken.get(link.facet as usize)? as usize)?)));
        let cut = known
            .filter(|(link, surface)| shape.is_cut_from(f, link, surface))
            .map(|(link, _)| taken[link.facet as usize])
            .next();
        taken[f as usize] = cut.unwrap_or(NONE);
    }
}

/// The largest of the connected pieces of some facets.
fn largest_piece(shape: &Shape<'_>, facets: &[u32]) -> Result<Vec<u32>> {
    let mut left: std::collections::BTreeSet<u32> = facets.iter().copied().collect();
    let mut largest: Vec<u32> = Vec::new();
    for &start in facets {
        if !left.remove(&start) {
            continue;
        }
        let mut piece = vec![start];
        let mut next = 0;
        while let Some(&f) = piece.get(next) {
            next += 1;
            for link in shape.links(f).iter().filter(|link| link.bend < MOST_BEND_ON_A_SURFACE) {
                if left.remove(&link.facet) {
                    memory::push(&mut piece, link.facet)?;
                }
            }
        }
        if piece.len() > largest.len() {
            largest = piece;
        }
    }
    Ok(largest)
}

#[cfg(test)]
mod tests;
