//! Facets of one half of a mesh, and their images.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::faceted::Faceted;
use super::symmetry::{nearest_corner, Half};
use super::triangulation;
use crate::mesh::vector::{centroid, Point};
use crate::mesh::{Mesh, FILE_ROUNDING};
use crate::remesh::closest::ClosestPoint;
use crate::remesh::crossings::crossings;
use crate::{memory, Result};

impl Half {
    /// The facets of the whole `mesh`, from those of the half. A facet that is at right angles to the plane
    /// where it meets it is one with its image.
    ///
    /// # Errors
    /// [`crate::error::SolveError::Memory`].
    pub(super) fn doubled(&self, mesh: &Mesh, mut found: Faceted) -> Result<Faceted> {
        let (axis, n) = (self.mirror.axis, found.vertices.len());
        let tree = Tree::new(mesh)?;
        let mut images = memory::room(n)?;
        let from = |found: &Faceted, v: usize| found.origins[v] as usize;
        for v in 0..n {
            if self.is_on[from(&found, v)] {
                found.vertices[v][axis] = self.mirror.at;
                images.push(v as u32);
            } else {
                images.push(found.vertices.len() as u32);
                let image = self.mirror.image(found.vertices[v]);
                memory::push(&mut found.vertices, image)?;
                let own = self.mesh.positions().unwrap_or_default()[from(&found, v)];
                memory::push(&mut found.origins, tree.vertex(self.mirror.image(own)))?;
            }
        }
        for origin in &mut found.origins[..n] {
            *origin = self.origins[*origin as usize];
        }
        let of_images = self.facets_of_images(&mut found, &images)?;
        let triangles: Vec<[u32; 3]> = memory::twin(&found.faces)?;
        let owners: Vec<u32> = memory::twin(&found.face_facets)?;
        let image = |[a, b, c]: [u32; 3]| [c, b, a].map(|v| images[v as usize]);
        let mut of_facets: BTreeMap<u32, Vec<[u32; 3]>> = BTreeMap::new();
        for (&triangle, &k) in triangles.iter().zip(&owners) {
            // A line along the plane is its own image: what is on both sides of it meets without it.
            if triangle.iter().all(|&v| images[v as usize] == v) {
                continue;
            }
            memory::push(of_facets.entry(k).or_default(), triangle)?;
            memory::push(of_facets.entry(of_images[k as usize]).or_default(), image(triangle))?;
        }
        let n_crossings = self.crossings_between(&found, &triangles, &owners, image)?;
        found.n_crossings = 2 * found.n_crossings + n_crossings;
        (found.faces, found.face_facets) = (Vec::new(), Vec::new());
        (found.polygons, found.polygon_facets) = (Vec::new(), Vec::new());
        for (k, own) in of_facets {
            for polygon in triangulation::polygons(&own)? {
                memory::push(&mut found.polygons, polygon)?;
                memory::push(&mut found.polygon_facets, k)?;
            }
            memory::extend(&mut found.face_facets, own.len())?;
            found.face_facets.extend(own.iter().map(|_| k));
            memory::extend(&mut found.faces, own.len())?;
            found.faces.extend(own);
        }
        self.without_bends(&mut found, &images)?;
        without_unused(&mut found)?;
        found.labels = self.labels(mesh, &found.labels, &of_images)?;
        found.n_facets = found.planes.len();
        Ok(found)
    }

    /// The facet that the image of each facet is, itself where both are one; planes of the others are added.
    fn facets_of_images(&self, found: &mut Faceted, images: &[u32]) -> Result<Vec<u32>> {
        let axis = self.mirror.axis;
        let is_on = |v: u32| images[v as usize] == v;
        let sides = |t: &[u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
        let meeting = found.faces.iter().zip(&found.face_facets);
        let meeting = meeting.filter(|(t, _)| sides(t).iter().any(|side| side.iter().all(|&v| is_on(v))));
        let meets: HashSet<u32> = memory::distinct(meeting.map(|(_, &k)| k))?;
        let mut of_images = memory::room(found.planes.len())?;
        for k in 0..found.planes.len() {
            let [x, y, z, offset] = found.planes[k];
            let mut normal = [x, y, z];
            if meets.contains(&(k as u32)) && normal[axis].abs() <= FILE_ROUNDING {
                of_images.push(k as u32);
                continue;
            }
            of_images.push(found.planes.len() as u32);
            normal[axis] = -normal[axis];
            let offset = offset + 2.0 * self.mirror.at * normal[axis];
            memory::push(&mut found.planes, [normal[0], normal[1], normal[2], offset])?;
        }
        Ok(of_images)
    }

    /// Pairs of facets of which one passes through the image of the other.
    fn crossings_between(
        &self,
        found: &Faceted,
        triangles: &[[u32; 3]],
        owners: &[u32],
        image: impl Fn([u32; 3]) -> [u32; 3],
    ) -> Result<usize> {
        let all: Vec<[u32; 3]> =
            memory::sifted(triangles.iter().copied().chain(triangles.iter().map(|&t| image(t))))?;
        let places: Vec<[Point; 3]> =
            memory::gathered(all.iter().map(|t| t.map(|v| found.vertices[v as usize])))?;
        let m = triangles.len();
        let between = crossings(&all, &places)?.into_iter().filter(|&[i, j]| {
            let (i, j) = (i as usize, j as usize);
            (i < m) != (j < m)
        });
        let owner = |i: u32| owners[i as usize % m];
        let pairs = between.map(|[i, j]| [owner(i).min(owner(j)), owner(i).max(owner(j))]);
        Ok(memory::distinct(pairs)?.len())
    }

    /// Takes corners on the plane out of polygons that do not bend there: between two facets, each of which
    /// is one with its image.
    fn without_bends(&self, found: &mut Faceted, images: &[u32]) -> Result<()> {
        let mut at: HashMap<u32, Vec<usize>> = HashMap::new();
        for (p, polygon) in found.polygons.iter().enumerate() {
            for &v in polygon.iter().filter(|&&v| images.get(v as usize) == Some(&v)) {
                memory::extend_map(&mut at, 1)?;
                memory::push(at.entry(v).or_default(), p)?;
            }
        }
        let mut on: Vec<(u32, Vec<usize>)> = memory::sifted(at)?;
        on.sort_unstable();
        for (v, polygons) in on {
            let is_straight = |&p: &usize| {
                let ring = &found.polygons[p];
                let (i, n) = (ring.iter().position(|&w| w == v).unwrap_or(0), ring.len());
                let (a, b) = (ring[(i + n - 1) % n] as usize, ring[(i + 1) % n] as usize);
                // Each is the image of the other.
                n > 3 && (images.get(a) == Some(&(b as u32)) || images.get(b) == Some(&(a as u32))) && a != b
            };
            if polygons.len() <= 2 && polygons.iter().all(is_straight) {
                polygons.iter().for_each(|&p| found.polygons[p].retain(|&w| w != v));
            }
        }
        Ok(())
    }

    /// The facet of each face of the whole: that of the nearest face of the half, or its image.
    fn labels(&self, mesh: &Mesh, of_half: &[i32], of_images: &[u32]) -> Result<Vec<i32>> {
        let own = self.mesh.positions().unwrap_or_default();
        let faces = self.mesh.connectivity().faces();
        let rows: Vec<usize> = memory::sifted((0..faces.len()).filter(|&f| of_half[f] >= 0))?;
        let places = memory::gathered(rows.iter().map(|&f| faces[f].map(|v| own[v as usize])))?;
        let tree = ClosestPoint::new(places)?;
        let positions = mesh.positions().unwrap_or_default();
        let axis = self.mirror.axis;
        let label = |face: &[u32; 3]| {
            let [a, b, c] = *face;
            if a == b || b == c || c == a {
                return -1;
            }
            let center = centroid(face.map(|v| positions[v as usize]));
            let is_image = center[axis] < self.mirror.at;
            let place = if is_image { self.mirror.image(center) } else { center };
            let Some(near) = tree.closest(place, None, |_| true) else { return -1 };
            let label = of_half[rows[near.triangle as usize]];
            if is_image {
                of_images[label as usize] as i32
            } else {
                label
            }
        };
        Ok(memory::gathered(mesh.connectivity().faces().iter().map(label))?)
    }
}

/// Takes out vertices that no triangle has.
fn without_unused(found: &mut Faceted) -> Result<()> {
    let mut names = memory::repeated(u32::MAX, found.vertices.len())?;
    found.faces.iter().flatten().for_each(|&v| names[v as usize] = 0);
    let mut kept = names.iter().map(|name| *name == 0);
    found.vertices.retain(|_| kept.next().unwrap_or(false));
    let mut kept = names.iter().map(|name| *name == 0);
    found.origins.retain(|_| kept.next().unwrap_or(false));
    let mut next = 0..;
    names.iter_mut().filter(|name| **name == 0).zip(&mut next).for_each(|(name, i)| *name = i);
    let corners = found.faces.iter_mut().flatten().chain(found.polygons.iter_mut().flatten());
    corners.for_each(|v| *v = names[*v as usize]);
    Ok(())
}

/// The vertices of a mesh, to be found by place.
struct Tree<'a> {
    mesh: &'a Mesh,
    tree: ClosestPoint,
}

impl<'a> Tree<'a> {
    fn new(mesh: &'a Mesh) -> Result<Self> {
        let positions = mesh.positions().unwrap_or_default();
        let places = mesh.connectivity().faces().iter().map(|f| f.map(|v| positions[v as usize]));
        Ok(Self { mesh, tree: ClosestPoint::new(memory::gathered(places)?)? })
    }

    /// The vertex near a point of the surface.
    fn vertex(&self, point: Point) -> u32 {
        let (faces, positions) =
            (self.mesh.connectivity().faces(), self.mesh.positions().unwrap_or_default());
        let near = self.tree.closest(point, None, |_| true);
        near.map_or(0, |near| nearest_corner(faces[near.triangle as usize], positions, point))
    }
}
