//! A surface grows from a few faces as far as faces lie on it.

use super::constants::{GROWN_BY, MORE, MOST_GROWTHS, ON_AVERAGE, REACH, STARTS, UNLIMITED};
use super::marks::Marks;
use super::pieces::best;
use super::Domain;
use crate::surfaces::{refit, Surface};
use crate::{memory, Result};

/// A surface with the faces that lie on it about where it began.
pub(super) struct Grown {
    pub surface: Surface,
    pub faces: Vec<u32>,
    /// By how much the energy falls if they are of this surface, and not free.
    pub gain: f64,
}

impl Domain<'_> {
    /// So many faces nearest to `f` over edges.
    pub(super) fn nearest(&self, marks: &mut Marks, f: u32, most: usize) -> Result<Vec<u32>> {
        marks.begin();
        marks.mark(f);
        let mut found = memory::room(most.max(1))?;
        found.push(f);
        let mut next = 0;
        while next < found.len() && found.len() < most {
            for (_, g) in self.around(found[next] as usize) {
                if found.len() < most && marks.mark(g as u32) {
                    found.push(g as u32);
                }
            }
            next += 1;
        }
        Ok(found)
    }

    /// Whether face `f` lies on `surface`: its corners do as far as noise tells, and so do they and those
    /// across its edges on average, which knows better.
    fn lies_on(&self, f: u32, surface: &Surface) -> bool {
        let off = self.off(f as usize, surface);
        if off.iter().any(|d| d.abs() >= REACH * self.sigma) || self.is_across(f as usize, surface) {
            return false;
        }
        let own = self.connectivity.faces()[f as usize];
        let (mut sum, mut count) = (off.iter().sum::<f64>(), 3.0);
        for (_, g) in self.around(f as usize) {
            let across = self.connectivity.faces()[g].into_iter().filter(|v| !own.contains(v));
            for v in across {
                sum += surface.distance(self.positions[v as usize]).0;
                count += 1.0;
            }
        }
        (sum / count).abs() < ON_AVERAGE * self.sigma
    }

    /// The faces that lie on `surface` and hang together with such of `seed`.
    pub(super) fn flood(&self, marks: &mut Marks, seed: &[u32], surface: &Surface) -> Result<Vec<u32>> {
        marks.begin();
        let mut found: Vec<u32> =
            memory::sifted(seed.iter().copied().filter(|&f| self.lies_on(f, surface) && marks.mark(f)))?;
        let mut next = 0;
        while let Some(&f) = found.get(next) {
            next += 1;
            for (_, g) in self.around(f as usize) {
                if marks.mark(g as u32) && self.lies_on(g as u32, surface) {
                    memory::push(&mut found, g as u32)?;
                }
            }
        }
        Ok(found)
    }

    /// The half of `faces` by rows that is farther from their border: what is tangent to a surface reaches
    /// over it there. All, where it would be few.
    pub(super) fn inner(&self, marks: &mut Marks, faces: &[u32]) -> Result<Vec<u32>> {
        marks.begin();
        faces.iter().for_each(|&f| {
            marks.mark(f);
        });
        let is_border = |f: &u32| self.around(*f as usize).any(|(_, g)| !marks.is_marked(g as u32));
        let mut queue: Vec<u32> = memory::sifted(faces.iter().copied().filter(is_border))?;
        queue.iter().for_each(|&f| {
            marks.mark_at(f, 0);
        });
        let (mut next, mut most) = (0, 0);
        while let Some(&f) = queue.get(next) {
            next += 1;
            most = marks.depth(f);
            for (_, g) in self.around(f as usize) {
                let g = g as u32;
                if marks.is_marked(g) && marks.depth(g) == u32::MAX {
                    marks.mark_at(g, most + 1);
                    memory::push(&mut queue, g)?;
                }
            }
        }
        let inner: Vec<u32> = memory::sifted(
            faces.iter().copied().filter(|&f| 2 * u64::from(marks.depth(f)) >= u64::from(most)),
        )?;
        Ok(if inner.len() < STARTS[0] { memory::twin(faces)? } else { inner })
    }

    /// By how much the energy falls if `faces` are of `surface`, and not free.
    pub(super) fn gain(&self, faces: &[u32], surface: &Surface) -> f64 {
        let data: f64 = faces.iter().map(|&f| self.gain_of(f as usize, surface)).sum();
        data - self.kappa * surface.kind().n_parameters() as f64
    }

    /// The surface that grows from the faces `seed`, if one does.
    pub(super) fn grown(&self, marks: &mut Marks, seed: &[u32]) -> Result<Option<Grown>> {
        let found = best(self, seed, &self.samples(seed)?, UNLIMITED)?;
        let Some((mut surface, _)) = found else { return Ok(None) };
        let mut faces: Vec<u32> = Vec::new();
        for _ in 0..MOST_GROWTHS {
            let next = self.flood(marks, seed, &surface)?;
            if 2 * next.len() < STARTS[0] {
                return Ok(None);
            }
            let is_first = faces.is_empty();
            let has_grown = is_first || next.len() as f64 > MORE * faces.len() as f64;
            faces = next;
            if !has_grown {
                break;
            }
            let inner = self.inner(marks, &faces)?;
            let samples = self.samples(&inner)?.thinned(GROWN_BY)?;
            let again = if is_first { None } else { refit(&surface, &samples, self.sigma)? };
            surface = match again {
                Some(again) => again.surface,
                None => match best(self, &inner, &samples, UNLIMITED)? {
                    Some((surface, _)) => surface,
                    None => return Ok(None),
                },
            };
        }
        let faces = self.flood(marks, seed, &surface)?;
        let gain = self.gain(&faces, &surface);
        Ok((2 * faces.len() >= STARTS[0]).then_some(Grown { surface, faces, gain }))
    }
}
