//! Surfaces grown over the facets that lie on them.

use super::super::constants::{LOOSE_SPHERE, MOST_BEND_ON_A_SURFACE, MOST_RISE, MOST_TILT, NEAR, SLACKS};
use super::facets::{Link, Marks, Shape};
use crate::mesh::vector::{dot, Point};
use crate::surfaces::{through, Surface as Named};
use crate::{memory, Result};

/// No radius is larger, nor smaller, in the unit of the segmentation.
const RADII: std::ops::Range<f64> = 1e-6..20.0;

/// A surface with the facets that lie on it.
pub(super) struct Grown {
    pub surface: Named,
    pub facets: Vec<u32>,
}

/// Whether the numbers of a surface say something.
pub(super) fn is_sound(surface: &Named) -> bool {
    surface.is_finite()
        && match *surface {
            Named::Sphere { radius, .. } | Named::Cylinder { radius, .. } => RADII.contains(&radius),
            // Fillets of bores smaller than they are spindle tori.
            Named::Torus { major, minor, .. } => RADII.contains(&minor) && major < RADII.end,
            Named::Cone { .. } | Named::Plane { .. } => true,
        }
}

impl Shape<'_> {
    /// Whether facet `f` lies on a surface whose distance grows to `side` of the facets: all of its vertices
    /// do, it is tilted by no more than a chord, and rises over it no more than one.
    fn fits(&self, f: u32, surface: &Named, side: f64, slack: f64) -> bool {
        let loose = if matches!(surface, Named::Sphere { .. }) { LOOSE_SPHERE } else { 1.0 };
        let (most, k) = (loose * slack * self.rounding, f as usize);
        if surface.distance(self.centers[k]).0.abs() > MOST_RISE * self.sizes[k] + most {
            return false;
        }
        self.vertices(f).iter().all(|&v| {
            let (off, normal) = surface.distance(self.positions[v as usize]);
            off.abs() <= most && side * dot(normal, self.normals[k]) >= MOST_TILT.cos()
        })
    }

    /// Whether facet `f`, beside a surface at `link`, is one of it but for vertices on ridges, near it still.
    pub(super) fn is_cut_from(&self, f: u32, link: &Link, surface: &Named) -> bool {
        let (side, most) = (self.side(link.facet, surface), MOST_RISE * self.sizes[f as usize]);
        let is_on_ridge = |v: u32| self.links(f).iter().any(|l| l.bend >= self.bend && l.ends.contains(&v));
        let is_near = |&v: &u32| {
            let (off, normal) = surface.distance(self.positions[v as usize]);
            let is_level = side * dot(normal, self.normals[f as usize]) >= MOST_TILT.cos();
            is_level && (off.abs() <= self.rounding || off.abs() <= most && is_on_ridge(v))
        };
        let rise = surface.distance(self.centers[f as usize]).0.abs();
        let back = Link { facet: f, ..*link };
        rise <= most && self.vertices(f).iter().all(is_near) && !self.is_tangent(&back, surface)
    }

    /// The facets on a surface that are connected with `seed`, about `most` of them.
    fn flood(
        &self,
        marks: &mut Marks,
        seed: &[u32],
        surface: &Named,
        (side, slack): (f64, f64),
        most: usize,
    ) -> Result<Vec<u32>> {
        // Sides of a prism are no cylinder where they bend as sides do.
        let is_ruled = matches!(surface, Named::Cylinder { .. } | Named::Cone { .. });
        let (seed, bend) = if is_ruled { (&seed[..1], self.bend) } else { (seed, MOST_BEND_ON_A_SURFACE) };
        marks.begin();
        let mut found = Vec::new();
        for &f in seed {
            if self.fits(f, surface, side, slack) && marks.mark(f) {
                memory::push(&mut found, f)?;
            }
        }
        let mut next = 0;
        while let Some(&f) = found.get(next) {
            next += 1;
            for link in self.links(f) {
                if found.len() >= most {
                    return Ok(found);
                }
                if link.bend < bend && marks.mark(link.facet) && self.fits(link.facet, surface, side, slack) {
                    memory::push(&mut found, link.facet)?;
                }
            }
        }
        Ok(found)
    }

    /// The surface grown from `seed`, which lies on it, as far as facets do: fitted again whenever it has
    /// doubled, since what few facets say of it is not exact farther away.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing.
    pub(super) fn grown(&self, marks: &mut Marks, seed: &[u32], start: &Named) -> Result<Option<Grown>> {
        let points = self.points_of(seed)?;
        let size = seed.iter().map(|&f| self.sizes[f as usize]).fold(0.0, f64::max);
        if !is_sound(start) || points.iter().any(|&p| start.distance(p).0.abs() > NEAR * size) {
            return Ok(None);
        }
        let mut surface = through(start, &points);
        let side = self.side(seed[0], &surface);
        let fits = |surface: &Named, facets: &[u32]| {
            is_sound(surface) && facets.iter().all(|&f| self.fits(f, surface, side, 1.0))
        };
        if !fits(&surface, seed) {
            return Ok(None);
        }
        let mut held = seed.len();
        'growing: loop {
            for slack in SLACKS {
                let more = self.flood(marks, seed, &surface, (side, slack), 2 * held + 4)?;
                if more.len() <= held {
                    break 'growing;
                }
                let next = through(&surface, &self.points_of(&more)?);
                if fits(&next, &more) {
                    (surface, held) = (next, more.len());
                    continue 'growing;
                }
            }
            break;
        }
        let facets = self.flood(marks, seed, &surface, (side, 1.0), usize::MAX)?;
        Ok((facets.len() >= seed.len()).then_some(Grown { surface, facets }))
    }

    fn side(&self, f: u32, surface: &Named) -> f64 {
        let p: Point = self.positions[self.vertices(f)[0] as usize];
        if dot(surface.distance(p).1, self.normals[f as usize]) < 0.0 {
            -1.0
        } else {
            1.0
        }
    }
}
