//! The state that the passes of isotropic remeshing share.

use rayon::prelude::*;

use crate::memory;
use crate::mesh::vector::{area_vector, between, distance, dot, unit, Point};
use crate::remesh::closest::ClosestPoint;
use crate::remesh::curves::{Curves, Keep, Role};
use crate::remesh::sizing::Sizing;
use crate::remesh::{guard, EditableMesh};
use crate::Result;

/// A surface to stay on: triangles, their normals, and a tree to find the closest.
#[derive(Debug)]
pub(crate) struct Reference {
    tree: ClosestPoint,
    normals: Vec<Point>,
}

impl Reference {
    /// The surface that `mesh` is now.
    pub(crate) fn of(mesh: &EditableMesh) -> Result<Self> {
        let triangles = memory::sifted(mesh.faces().map(|(_, face)| mesh.corners(face)))?;
        let normals = memory::joined(triangles.par_iter().map(|&t| unit(area_vector(t))))?;
        Ok(Self { tree: ClosestPoint::new(triangles)?, normals })
    }

    /// The closest point and its triangle; on the side that looks along `normal` if there is one, so that the
    /// two sides of a thin sheet are not mistaken for each other.
    pub(crate) fn project(&self, p: Point, normal: Point, guess: u32) -> (Point, u32) {
        let same_side = |t: u32| dot(self.normals[t as usize], normal) > 0.0;
        let found = self
            .tree
            .closest(p, Some(guess), same_side)
            .or_else(|| self.tree.closest(p, Some(guess), |_| true));
        found.map_or((p, guess), |c| (c.point, c.triangle))
    }
}

/// A mesh under isotropic remeshing.
#[derive(Debug)]
pub(crate) struct Remesher<'a> {
    pub(crate) mesh: EditableMesh,
    pub(crate) surface: &'a Reference,
    pub(crate) curves: Curves,
    pub(crate) roles: Vec<Role>,
    /// A triangle of the surface close to each vertex.
    pub(crate) near: Vec<u32>,
    pub(crate) sizing: Sizing,
}

impl<'a> Remesher<'a> {
    /// Starts on `mesh`.
    pub(crate) fn new(
        mesh: EditableMesh,
        surface: &'a Reference,
        keep: &Keep,
        make_sizing: impl Fn(&EditableMesh, &Curves) -> Result<Sizing>,
    ) -> Result<Self> {
        let (curves, roles) = Curves::new(&mesh, keep)?;
        let near = memory::repeated(0, mesh.n_vertices())?;
        let sizing = make_sizing(&mesh, &curves)?;
        Ok(Self { mesh, surface, curves, roles, near, sizing })
    }

    /// Whether the vertex may move.
    pub(crate) fn is_movable(&self, v: u32) -> bool {
        matches!(self.roles[v as usize], Role::Free | Role::Curve(_))
    }

    /// The length of the edge.
    pub(crate) fn length(&self, a: u32, b: u32) -> f64 {
        distance(self.mesh.position(a), self.mesh.position(b))
    }

    /// Whether the edge may change at all: it is neither on a curve nor locked.
    pub(crate) fn is_free(&self, a: u32, b: u32) -> bool {
        let lined = |v: u32| self.roles[v as usize] != Role::Free;
        !(lined(a) && lined(b)) || self.curves.curve(a, b).is_none() && !self.curves.is_locked(a, b)
    }

    /// Splits the edge in the middle, on its curve if it is on one.
    pub(crate) fn split(&mut self, a: u32, b: u32) -> Result<()> {
        let middle = between(self.mesh.position(a), self.mesh.position(b), 0.5);
        if middle == self.mesh.position(a) || middle == self.mesh.position(b) {
            // Coordinates have no room for a point between.
            return Ok(());
        }
        let curve = if self.is_free(a, b) { None } else { self.curves.curve(a, b) };
        let Some(new) = self.mesh.split(a, b, middle)? else { return Ok(()) };
        let near = self.near[a as usize];
        memory::push(&mut self.near, near)?;
        memory::extend(&mut self.roles, 1)?;
        self.sizing.push_between(a, b)?;
        if let Some(curve) = curve {
            self.curves.replace([a, b], &[[a, new], [new, b]], curve)?;
            self.roles.push(Role::Curve(curve));
            let on_curve = self.curves.project(curve, middle);
            if guard::may_move(&self.mesh, new, on_curve) {
                self.mesh.set_position(new, on_curve);
            }
        } else {
            self.roles.push(Role::Free);
        }
        Ok(())
    }

    /// Which way the edge may collapse: from, to, and where the vertex that is left goes.
    fn collapse_plan(&self, a: u32, b: u32) -> Option<(u32, u32, Point)> {
        let middle = between(self.mesh.position(a), self.mesh.position(b), 0.5);
        let role = |v: u32| match self.roles[v as usize] {
            Role::Free | Role::Curve(_) if self.mesh.is_hub(v) => Role::Fixed,
            role => role,
        };
        match (role(a), role(b)) {
            (Role::Pinched, _) | (_, Role::Pinched) | (Role::Fixed, Role::Fixed) => None,
            (Role::Free, Role::Free) => Some((b, a, middle)),
            (Role::Free, _) => Some((a, b, self.mesh.position(b))),
            (_, Role::Free) => Some((b, a, self.mesh.position(a))),
            (Role::Curve(_), Role::Curve(_)) => {
                let curve = self.curves.curve(a, b)?;
                Some((b, a, self.curves.project(curve, middle)))
            }
            (Role::Curve(_), Role::Fixed) => self.curves.curve(a, b).map(|_| (a, b, self.mesh.position(b))),
            (Role::Fixed, Role::Curve(_)) => self.curves.curve(a, b).map(|_| (b, a, self.mesh.position(a))),
        }
    }

    /// Collapses the edge if nothing speaks against it: the roles of its ends, the guard, or an edge longer
    /// than `longest` times its target length. Returns whether it did.
    pub(crate) fn collapse(&mut self, a: u32, b: u32, longest: f64) -> Result<bool> {
        let Some((from, to, position)) = self.collapse_plan(a, b) else { return Ok(false) };
        let around = self.mesh.neighbors(from);
        let too_long =
            |w: u32| distance(position, self.mesh.position(w)) > longest * self.sizing.target(to, w);
        // The edges of a hub stay as long as they are.
        let around_to = if self.mesh.is_hub(to) { Vec::new() } else { self.mesh.neighbors(to) };
        if around.iter().chain(&around_to).any(|&w| w != from && w != to && too_long(w)) {
            return Ok(false);
        }
        let carried: Vec<(u32, u32)> = if self.roles[from as usize] == Role::Free {
            Vec::new()
        } else {
            around
                .iter()
                .filter(|&&w| w != to)
                .filter_map(|&w| self.curves.curve(from, w).map(|c| (w, c)))
                .collect()
        };
        if carried.iter().any(|&(w, _)| self.curves.curve(to, w).is_some() || self.curves.is_locked(to, w)) {
            return Ok(false);
        }
        if !guard::may_collapse(&self.mesh, from, to, position) || !self.mesh.collapse(from, to, position) {
            return Ok(false);
        }
        for (w, curve) in carried {
            self.curves.replace([from, w], &[[to, w]], curve)?;
        }
        Ok(true)
    }
}
