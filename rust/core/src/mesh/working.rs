//! The mesh that tools compute on: neighboring faces agree on what is outside, the sides of seams are joined,
//! and the origin is near. What comes out is given back for the mesh as it was.

use std::borrow::Cow;
use std::collections::HashMap;

use crate::error::SolveError;
use crate::memory::{self, Tool};
use crate::mesh::orientation::turned_over;
use crate::mesh::vector::{add, sub, Point};
use crate::mesh::{flipped_faces, EdgeKind, Mesh, Weld};

/// A coordinate of all vertices that is so many times as large as the range that they take is measured from
/// one of them: below, subtracting squares of it loses no more than the last digits.
const FAR: f64 = 16.0;

/// A mesh made ready to be computed on. The faces are as many and in the order of the mesh's.
#[derive(Debug, Clone)]
pub struct Working<'a> {
    mesh: Cow<'a, Mesh>,
    /// The mesh's own faces.
    original: &'a Mesh,
    weld: Option<Weld>,
    flipped: Option<Vec<bool>>,
    origin: Point,
}

impl<'a> Working<'a> {
    /// The mesh with its faces oriented ([`flipped_faces`]), its seams joined ([`Weld::of_seams`]) and its
    /// origin near; the mesh itself where that changes nothing.
    ///
    /// # Errors
    /// [`crate::Error::Memory`] where a copy does not fit.
    pub fn new(mesh: &'a Mesh) -> crate::Result<Self> {
        mesh.demand(Tool::Mesh).admit(None)?;
        let weld = match mesh.positions() {
            Some(positions) => Weld::of_seams(mesh.connectivity(), positions, None)?,
            None => None,
        };
        Self::of(mesh, weld)
    }

    /// The same with sides of length 0 contracted ([`Weld::contracted`]), for what makes other faces.
    ///
    /// # Errors
    /// [`crate::Error::Memory`] where a copy does not fit.
    pub fn contracted(mesh: &'a Mesh) -> crate::Result<Self> {
        mesh.demand(Tool::Mesh).admit(None)?;
        let Some(positions) = mesh.positions() else { return Self::of(mesh, None) };
        let seams = Weld::of_seams(mesh.connectivity(), positions, None)?;
        Self::of(mesh, Weld::contracted(seams, mesh.connectivity(), positions)?)
    }

    /// The same with the vertices as they are, for functions on them,
    /// which may differ between the sides of a seam.
    ///
    /// # Errors
    /// [`crate::Error::Memory`] where a copy does not fit.
    pub fn unwelded(mesh: &'a Mesh) -> crate::Result<Self> {
        mesh.demand(Tool::Mesh).admit(None)?;
        Self::of(mesh, None)
    }

    fn of(mesh: &'a Mesh, weld: Option<Weld>) -> crate::Result<Self> {
        let origin = mesh.positions().map_or([0.0; 3], far_origin);
        let mut working = Self { mesh: Cow::Borrowed(mesh), original: mesh, weld, flipped: None, origin };
        if let (true, Some(positions)) = (working.weld.is_some() || origin != [0.0; 3], mesh.positions()) {
            let near = |p: &Point| sub(*p, origin);
            let faces = mesh.connectivity().faces();
            let (positions, faces): (Vec<Point>, _) = match &working.weld {
                Some(weld) => {
                    let firsts = weld.first.iter().map(|&v| near(&positions[v as usize]));
                    (memory::gathered(firsts)?, weld.faces(faces)?)
                }
                None => (memory::gathered(positions.iter().map(near))?, memory::twin(faces)?),
            };
            working.mesh = Cow::Owned(Mesh::new(positions, faces)?);
        }
        if working.mesh.connectivity().has_any(&[EdgeKind::Inconsistent]) {
            let flipped = flipped_faces(working.mesh.connectivity())?;
            working.mesh = Cow::Owned(turned(&working.mesh, &flipped)?);
            working.flipped = Some(flipped);
        }
        Ok(working)
    }

    /// The mesh to compute on.
    #[must_use]
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The mesh to compute on, where nothing needs to be given back.
    #[must_use]
    pub fn into_mesh(self) -> Cow<'a, Mesh> {
        self.mesh
    }

    /// Whether that is the mesh itself.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        matches!(self.mesh, Cow::Borrowed(_))
    }

    /// Whether a face is turned over here.
    #[must_use]
    pub fn is_flipped(&self, f: usize) -> bool {
        self.flipped.as_ref().is_some_and(|flipped| flipped[f])
    }

    /// Number of vertices of the mesh itself.
    #[must_use]
    pub fn n_original(&self) -> usize {
        self.original.connectivity().n_vertices()
    }

    /// The vertex here of a vertex of the mesh.
    #[must_use]
    pub fn vertex(&self, v: u32) -> u32 {
        self.weld.as_ref().map_or(v, |weld| weld.vertex[v as usize])
    }

    /// A vertex of the mesh for the vertex `v` here.
    #[must_use]
    pub fn original(&self, v: u32) -> u32 {
        self.weld.as_ref().map_or(v, |weld| weld.first[v as usize])
    }

    /// Whether a mask over the mesh's vertices holds for one of those that each vertex here is.
    ///
    /// # Errors
    /// [`SolveError::Memory`] when the system does not give that much, here and below.
    pub fn any_of(&self, mask: &[bool]) -> Result<Vec<bool>, SolveError> {
        let mut any = memory::repeated(false, self.mesh.connectivity().n_vertices())?;
        (0..).zip(mask).for_each(|(v, &set)| any[self.vertex(v) as usize] |= set);
        Ok(any)
    }

    /// The least of the values of the mesh's vertices that each vertex here is.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn least_of(&self, values: &[f64]) -> Result<Vec<f64>, SolveError> {
        let mut least = memory::repeated(f64::INFINITY, self.mesh.connectivity().n_vertices())?;
        (0..).zip(values).for_each(|(v, &x)| {
            let entry = &mut least[self.vertex(v) as usize];
            *entry = entry.min(x);
        });
        Ok(least)
    }

    /// The faces that were turned over because of faces across seams: in the mesh itself they agree with
    /// their neighbors as they are.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing.
    pub fn turned_across_seams(&self) -> crate::Result<Option<Vec<bool>>> {
        let (Some(flipped), Some(_)) = (&self.flipped, &self.weld) else { return Ok(None) };
        let own = flipped_faces(self.original.connectivity())?;
        let turned: Vec<bool> = memory::gathered(flipped.iter().zip(&own).map(|(here, own)| here != own))?;
        Ok(turned.contains(&true).then_some(turned))
    }

    /// The faces in the mesh's own vertices; oriented as here, but for those that are `turned` across seams.
    pub fn faces_as_given<'f>(&'f self, turned: Option<&'f [bool]>) -> impl Iterator<Item = [u32; 3]> + 'f {
        let faces = self.original.connectivity().faces().iter().enumerate();
        faces.map(move |(f, &[a, b, c])| {
            if self.is_flipped(f) == turned.is_some_and(|turned| turned[f]) {
                [a, b, c]
            } else {
                [a, c, b]
            }
        })
    }

    /// One row a face, column `i` of the edge opposite corner `i`, for the faces here.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn corner_rows(&self, rows: &[[f64; 3]]) -> Result<Vec<[f64; 3]>, SolveError> {
        let row =
            |(f, &[a, b, c]): (usize, &[f64; 3])| if self.is_flipped(f) { [a, c, b] } else { [a, b, c] };
        memory::gathered(rows.iter().enumerate().map(row))
    }

    /// Values of the mesh's vertices from those here.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn spread<T: Copy>(&self, values: &[T]) -> Result<Vec<T>, SolveError> {
        match &self.weld {
            Some(weld) => memory::gathered(weld.vertex.iter().map(|&v| values[v as usize])),
            None => memory::twin(values),
        }
    }

    /// A point here, in the mesh's coordinates.
    #[must_use]
    pub fn place(&self, p: Point) -> Point {
        if self.origin == [0.0; 3] {
            p
        } else {
            add(p, self.origin)
        }
    }

    /// Positions of the mesh's vertices from those here: vertices that did not move keep their bits.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn positions(&self, points: &[Point]) -> Result<Vec<Point>, SolveError> {
        let (Some(before), Some(here)) = (self.original.positions(), self.mesh.positions()) else {
            return memory::twin(points);
        };
        let position = |(v, &old): (u32, &Point)| {
            let w = self.vertex(v) as usize;
            if points[w] == here[w] {
                old
            } else {
                self.place(points[w])
            }
        };
        memory::gathered((0..before.len() as u32).zip(before).map(position))
    }

    /// The vertices of the mesh at the border edges here whose vertices are several of the mesh:
    /// by tail and head here.
    ///
    /// # Errors
    /// [`SolveError::Memory`].
    pub fn seam_edges(&self) -> Result<HashMap<[u32; 2], [u32; 2]>, SolveError> {
        let (connectivity, faces) = (self.mesh.connectivity(), self.original.connectivity().faces());
        if self.weld.is_none() {
            return Ok(HashMap::new());
        }
        let own = |h: usize, v: u32| {
            faces[h / 3].into_iter().find(|&w| self.vertex(w) == v).unwrap_or_else(|| self.original(v))
        };
        let edge = |h: usize| {
            let here = [connectivity.tail(h), connectivity.head(h)];
            (here, here.map(|v| own(h, v)))
        };
        memory::mapped(connectivity.boundary().map(edge))
    }
}

/// The origin that brings vertices near: for each coordinate 0, or that of the first vertex where all are far
/// away beside the range that they take. Such a coordinate is subtracted, and added again, without rounding.
fn far_origin(positions: &[Point]) -> Point {
    let Some(&first) = positions.first() else { return [0.0; 3] };
    let is_far = |c: usize| {
        let most = first[c].abs() / FAR;
        first[c] != 0.0 && positions.iter().all(|p| (p[c] - first[c]).abs() <= most)
    };
    let ranges = |c: usize| positions.iter().fold(0.0_f64, |range, p| range.max((p[c] - first[c]).abs()));
    let far = [0, 1, 2].map(is_far);
    if !far.contains(&true) {
        return [0.0; 3];
    }
    // A flat side in one coordinate is no distance: the ranges of the others count as well.
    let size = [0, 1, 2].map(ranges).into_iter().fold(0.0, f64::max);
    [0, 1, 2].map(|c| if far[c] && first[c].abs() > FAR * size { first[c] } else { 0.0 })
}

/// The mesh with some faces turned over.
fn turned(mesh: &Mesh, flipped: &[bool]) -> crate::Result<Mesh> {
    let faces = turned_over(mesh.connectivity().faces(), flipped)?;
    match mesh.positions() {
        Some(positions) => Mesh::new(memory::twin(positions)?, faces),
        None => {
            let swap = |(&[a, b, c], &flip): (&[f64; 3], &bool)| if flip { [a, c, b] } else { [a, b, c] };
            let lengths = memory::gathered(mesh.edge_lengths().iter().zip(flipped).map(swap))?;
            Mesh::from_edge_lengths(faces, lengths, Some(mesh.connectivity().n_vertices()))
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::shapes::{self, Shape};

    #[test]
    fn a_plain_mesh_is_computed_on_as_it_is() {
        for shape in
            [shapes::cube(3), shapes::grid(4, 4), shapes::torus(6, 5, 2.0, 0.5).map(|p| add(p, [9.0; 3]))]
        {
            assert!(Working::new(&shape.mesh().unwrap()).unwrap().is_plain());
        }
    }

    #[test]
    fn what_is_far_away_comes_back_bit_by_bit() {
        let shape = shapes::icosphere(2).map(|[x, y, z]| [x + 512_345.678, y + 5_572_094.155, z]);
        let mesh = shape.mesh().unwrap();
        let working = Working::new(&mesh).unwrap();
        let here = working.mesh().positions().unwrap();
        assert!(here.iter().flatten().all(|x| x.abs() <= 2.0));
        assert!(here.iter().zip(&shape.vertices).all(|(p, q)| p[2] == q[2]));
        let back: Vec<Point> = here.iter().map(|&p| working.place(p)).collect();
        assert_eq!(back, shape.vertices);
        assert_eq!(working.positions(here).unwrap(), shape.vertices);
    }

    #[test]
    fn seams_and_turned_faces_at_once() {
        let shape = shapes::cube(4);
        let mut split = Shape {
            vertices: shape.faces.iter().flatten().map(|&v| shape.vertices[v as usize]).collect(),
            faces: (0..shape.faces.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect(),
        };
        split.faces.iter_mut().step_by(7).for_each(|face| face.swap(0, 2));
        let mesh = split.mesh().unwrap();
        let working = Working::new(&mesh).unwrap();
        let connectivity = working.mesh().connectivity();
        assert!(!connectivity.has_any(&[EdgeKind::Boundary, EdgeKind::Inconsistent]));
        assert_eq!(connectivity.n_vertices(), shape.vertices.len());
        let positions = working.mesh().positions().unwrap();
        assert_eq!(working.positions(positions).unwrap(), split.vertices);
    }
}
