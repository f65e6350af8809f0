//! Which surface each face belongs to: one energy over labels `L` and surfaces `Θ`,
//!
//! `E(L, Θ) = Σ_v Σ_f∋v (A_f / A_v) ρ(d(v, Θ_L(f)) / σ) + Σ_border length / edge`
//! `+ κ Σ_surfaces parameters(Θ)`
//!
//! (PEARL: Isack and Boykov 2012; label costs: Delong et al. 2012). Every vertex is one observation of its
//! surfaces, shared among them by the areas of its faces: so the correlation of neighboring faces, which have
//! corners in common, is taken into account, and `E` is the negative logarithm of a likelihood. `ρ` is
//! [`misfit`], `κ` half the logarithm of the number of observations (Schwarz 1978). A piece without a surface
//! of a known kind is free: its vertices cost [`FREE_MISFIT`] each.
//!
//! Moves: fit and exchange the kind ([`pieces`]), [`relabel`] faces at borders, [`merge`] neighbors; each is
//! taken only if `E` falls.

mod domain;
mod merge;
mod pieces;
mod relabel;

pub use domain::Domain;
pub use pieces::Piece;

use crate::progress::Progress;
use crate::surfaces::misfit;
use crate::Result;

/// No label: the face takes no part.
pub const NONE: u32 = u32::MAX;

/// What a vertex of a free piece costs: as if it were 1.5 standard deviations off. A surface that is off by
/// more than that, root mean square, is not sure: no noise is taken for a reason, and nothing is moved onto
/// it. The same ratio at which segments count as plane ([`crate::tools::segment`]).
pub const FREE_MISFIT: f64 = 1.125;

/// What a border costs for each mean edge of its length, beside the likelihoods of its two sides.
const BORDER: f64 = 1.0;

/// Rounds of merging and relabeling; two or three change something.
const MOST_ROUNDS: usize = 8;

/// The label of each face, and what the labels stand for.
#[derive(Debug, Clone)]
pub struct Labelling {
    /// Index of the piece of each face, or [`NONE`].
    pub labels: Vec<u32>,
    /// The pieces.
    pub pieces: Vec<Piece>,
}

/// The labels of the faces of a `domain` that begin as `start` (negative: takes no part) and follow the
/// energy downhill.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub fn labelling(domain: &Domain<'_>, start: &[i32], progress: &Progress) -> Result<Labelling> {
    let labels = start.iter().map(|&l| u32::try_from(l).unwrap_or(NONE)).collect();
    let mut state = Labelling { labels, pieces: Vec::new() };
    state.fit_all(domain, progress)?;
    let mut energy = state.energy(domain);
    for _ in 0..MOST_ROUNDS {
        let before = state.clone();
        merge::merge(domain, &mut state, progress)?;
        relabel::relabel(domain, &mut state, progress)?;
        state.fit_all(domain, progress)?;
        let after = state.energy(domain);
        if after.is_nan() || after >= energy {
            // Fits are local: what they lose is not taken.
            if after > energy {
                state = before;
            }
            break;
        }
        energy = after;
    }
    Ok(state)
}

impl Labelling {
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
    fn face_cost(&self, f: usize, piece: Option<&Piece>) -> f64 {
        let Some(piece) = piece else { return 0.0 };
        let corner = |&v: &u32| {
            let share = self.share(f, v);
            match &piece.surface {
                Some(surface) => share * misfit(surface.distance(self.positions[v as usize]).0, self.sigma),
                None => share * FREE_MISFIT,
            }
        };
        self.connectivity.faces()[f].iter().map(corner).sum()
    }

    /// What the parameters of a piece cost.
    fn price(&self, piece: &Piece) -> f64 {
        piece.surface.map_or(0.0, |surface| self.kappa * surface.kind().n_parameters() as f64)
    }
}
