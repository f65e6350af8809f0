//! Labels, what they stand for, and what both cost.

use super::constants::{BESIDE, BORDER, FREE_MISFIT, MOST_RISE, MOST_TURN};
use super::Domain;
use crate::mesh::vector::{between, centroid, dot, norm, sub};
use crate::surfaces::{misfit, Surface, MOST_MISFIT};
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
    /// Whether it is free since its faces were on a surface that does not explain them.
    pub is_doubted: bool,
    /// What it costs with its parameters.
    pub(super) energy: f64,
    /// Whether all of this is that of its faces, to which no surface has to be fitted.
    pub(super) is_fitted: bool,
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
        match &piece.surface {
            Some(surface) => self.cost_on(f, surface),
            None => FREE_MISFIT * self.shares(f),
        }
    }

    pub(super) fn shares(&self, f: usize) -> f64 {
        self.connectivity.faces()[f].iter().map(|&v| self.share(f, v)).sum()
    }

    /// By how much face `f` costs less on `surface` than free.
    pub(super) fn gain_of(&self, f: usize, surface: &Surface) -> f64 {
        FREE_MISFIT * self.shares(f) - self.cost_on(f, surface)
    }

    /// What face `f` costs on `surface`: its corners' misfits. One that has a corner off the surface is no
    /// better there than free, and one that lies across it is as far off as can be.
    fn cost_on(&self, f: usize, surface: &Surface) -> f64 {
        self.cost_so_far_off(f, surface, || self.off(f, surface))
    }

    fn cost_so_far_off(&self, f: usize, surface: &Surface, off: impl FnOnce() -> [f64; 3]) -> f64 {
        if self.is_across(f, surface) {
            return MOST_MISFIT * self.shares(f);
        }
        let off = off();
        let is_off = off.iter().any(|d| d.abs() > MOST_RISE * self.sigma);
        self.misfits(f, off, if is_off { FREE_MISFIT } else { 0.0 })
    }

    /// How far the corners of face `f` are from `surface`.
    pub(super) fn off(&self, f: usize, surface: &Surface) -> [f64; 3] {
        self.connectivity.faces()[f].map(|v| surface.distance(self.positions[v as usize]).0)
    }

    /// What the corners of face `f` cost so far off, each at least `least`.
    fn misfits(&self, f: usize, off: [f64; 3], least: f64) -> f64 {
        let corners = self.connectivity.faces()[f].into_iter().zip(off);
        corners.map(|(v, d)| self.share(f, v) * misfit(d, self.sigma).max(least)).sum()
    }

    /// Whether face `f` lies across `surface`, although its corners may be on it: it is tilted by more than
    /// noise explains, or the surface turns by more than [`MOST_TURN`] under it.
    pub(super) fn is_across(&self, f: usize, surface: &Surface) -> bool {
        let corners = self.connectivity.faces()[f].map(|v| self.positions[v as usize]);
        let (center, area) = (centroid(corners), self.areas[f]);
        let normal = surface.distance(center).1;
        let rise = corners.map(|p| dot(sub(p, center), normal).abs()).into_iter().fold(0.0, f64::max);
        let least = MOST_TURN.cos();
        if rise > MOST_RISE * self.sigma && dot(normal, area).abs() < least * norm(area) {
            return true;
        }
        let longest = self.lengths[f].into_iter().fold(0.0, f64::max);
        if longest < MOST_TURN * surface.least_radius() {
            return false;
        }
        let [a, b, c] = corners.map(|p| surface.distance(between(p, center, BESIDE)).1);
        dot(a, b) < least || dot(b, c) < least || dot(c, a) < least
    }

    /// What `faces` cost on `surface` more than their corners alone say.
    pub(super) fn strain(&self, faces: &[u32], surface: &Surface) -> f64 {
        let strain = |f: usize| {
            let off = self.off(f, surface);
            self.cost_so_far_off(f, surface, || off) - self.misfits(f, off, 0.0)
        };
        faces.iter().map(|&f| strain(f as usize)).sum()
    }

    /// What the parameters of a piece cost.
    fn price(&self, piece: &Piece) -> f64 {
        piece.surface.map_or(0.0, |surface| self.kappa * surface.kind().n_parameters() as f64)
    }
}
