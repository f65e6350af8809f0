//! Labels, what they stand for, and what both cost.

use super::constants::{BESIDE, BORDER, FREE_MISFIT, MOST_RISE, MOST_TURN};
use super::Domain;
use crate::mesh::vector::{between, centroid, dot, norm, sub};
use crate::shape_guard::TURNED;
use crate::surfaces::{misfit, Kind, Surface, MOST_MISFIT};
use crate::{memory, Result};

/// No label: the face takes no part.
pub const NONE: u32 = u32::MAX;

/// The label of each face, and what the labels stand for.
#[derive(Debug, Clone)]
pub struct Labelling {
    /// Index of the piece of each face, or [`NONE`].
    pub labels: Vec<u32>,
    /// The pieces.
    pub pieces: Vec<Piece>,
}

/// What faces of one label have in common.
#[derive(Debug, Clone, Default)]
pub struct Piece {
    /// Its faces, ascending.
    pub faces: Vec<u32>,
    /// Its surface; `None` where it is free.
    pub surface: Option<Surface>,
    /// 1 where the faces' normals point to where the surface's distance grows, else −1.
    pub side: f64,
    /// Root mean square distance of its vertices from the surface.
    pub rms: f64,
    /// What it costs with its parameters.
    pub(super) energy: f64,
}

impl Labelling {
    /// A copy.
    ///
    /// # Errors
    /// [`crate::Error::Solve`] where memory is missing.
    pub(super) fn copied(&self) -> Result<Self> {
        let mut pieces = memory::room(self.pieces.len())?;
        for piece in &self.pieces {
            pieces.push(Piece { faces: memory::twin(&piece.faces)?, ..*piece });
        }
        Ok(Self { labels: memory::twin(&self.labels)?, pieces })
    }

    /// `E` of these labels and surfaces.
    #[must_use]
    pub fn energy(&self, domain: &Domain<'_>) -> f64 {
        let data: f64 = (0..self.labels.len()).map(|f| domain.face_cost(f, self.piece(f))).sum();
        let parameters: f64 = self.pieces.iter().map(|piece| domain.price(piece)).sum();
        data + BORDER * self.border_length(domain) / domain.mean_edge + parameters
    }

    fn piece(&self, f: usize) -> Option<&Piece> {
        self.pieces.get(self.labels[f] as usize)
    }

    fn border_length(&self, domain: &Domain<'_>) -> f64 {
        let is_border = |h: usize, twin: usize| {
            let (a, b) = (self.labels[h / 3], self.labels[twin / 3]);
            a != b && a != NONE && b != NONE
        };
        let edges = domain.connectivity.edges().filter_map(|h| Some((h, domain.connectivity.mate(h)?)));
        edges.filter(|&(h, twin)| is_border(h, twin)).map(|(h, _)| domain.lengths[h / 3][h % 3]).sum()
    }
}

impl Domain<'_> {
    /// What the corners of face `f` cost on a piece, by its share of each.
    pub(super) fn face_cost(&self, f: usize, piece: Option<&Piece>) -> f64 {
        let Some(piece) = piece else { return 0.0 };
        let corners = self.connectivity.faces()[f];
        let each = |cost: &dyn Fn(u32) -> f64| corners.iter().map(|&v| self.share(f, v) * cost(v)).sum();
        match &piece.surface {
            Some(surface) if self.strays(f, surface) => each(&|_| MOST_MISFIT),
            Some(surface) => each(&|v| misfit(surface.distance(self.positions[v as usize]).0, self.sigma)),
            None => each(&|_| FREE_MISFIT),
        }
    }

    /// Whether face `f` is none of `surface`, although its corners may lie on it: it stands across it by
    /// more than noise tilts it, or the surface turns by more than [`MOST_TURN`] under it.
    fn strays(&self, f: usize, surface: &Surface) -> bool {
        if surface.kind() == Kind::Plane {
            return false;
        }
        let corners = self.connectivity.faces()[f].map(|v| self.positions[v as usize]);
        let (center, area) = (centroid(corners), self.areas[f]);
        let normal = surface.distance(center).1;
        let rise = corners.map(|p| dot(sub(p, center), normal).abs()).into_iter().fold(0.0, f64::max);
        if rise > MOST_RISE * self.sigma && dot(normal, area).abs() < TURNED * norm(area) {
            return true;
        }
        let longest = self.lengths[f].into_iter().fold(0.0, f64::max);
        if longest < MOST_TURN * surface.least_radius() {
            return false;
        }
        let [a, b, c] = corners.map(|p| surface.distance(between(p, center, BESIDE)).1);
        let least = MOST_TURN.cos();
        dot(a, b) < least || dot(b, c) < least || dot(c, a) < least
    }

    /// What `faces` cost more than their corners say, since they are none of `surface`.
    pub(super) fn strain(&self, faces: &[u32], surface: &Surface) -> f64 {
        let cost = |f: usize| -> f64 {
            let excess =
                |v: u32| MOST_MISFIT - misfit(surface.distance(self.positions[v as usize]).0, self.sigma);
            self.connectivity.faces()[f].iter().map(|&v| self.share(f, v) * excess(v)).sum()
        };
        let each = faces.iter().map(|&f| f as usize);
        each.filter(|&f| self.strays(f, surface)).map(cost).sum()
    }

    /// What the parameters of a piece cost.
    fn price(&self, piece: &Piece) -> f64 {
        piece.surface.map_or(0.0, |surface| self.kappa * surface.kind().n_parameters() as f64)
    }
}
