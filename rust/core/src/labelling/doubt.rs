//! Which faces their surface does not explain: beside a true surface there is noise only, which does not know
//! its neighbor. Vertices that stray from it together lie on something else.

use rayon::prelude::*;

use super::constants::{CIRCLES, MOST_ROUNDS};
use super::labels::{Labelling, Piece};
use super::Domain;
use crate::buckets::Buckets;
use crate::mesh::vector::norm;
use crate::progress::Progress;
use crate::surfaces::{Kind, MOST_MISFIT};
use crate::{memory, Result};

/// Makes faces free whose vertices stray from their surface together, and fits what is left, as long as there
/// are such. `has_left` says which have left a surface before.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn doubt(
    domain: &Domain<'_>,
    state: &mut Labelling,
    has_left: &[bool],
    progress: &Progress,
) -> Result<()> {
    let mut is_free = memory::repeated(false, state.labels.len())?;
    for _ in 0..MOST_ROUNDS {
        progress.check()?;
        let strays = Strays::new(domain, state)?.found()?;
        if !strays.contains(&true) || progress.is_finishing() {
            break;
        }
        state.leave(domain, &strays, &mut is_free)?;
        state.fit_all(domain, progress)?;
        for piece in state.pieces.iter_mut().filter(|piece| is_free[piece.faces[0] as usize]) {
            let faces = std::mem::take(&mut piece.faces);
            *piece = Piece { faces, side: 1.0, ..Piece::default() };
        }
    }
    let has = |f: &u32| has_left[*f as usize] || is_free[*f as usize];
    for piece in state.pieces.iter_mut().filter(|piece| piece.surface.is_none()) {
        piece.is_doubted = piece.faces.iter().any(has);
    }
    Ok(())
}

/// What vertices are off by, and which of them are on the same surfaces.
pub(super) struct Strays {
    /// How far each vertex is from the nearest of its surfaces, outside of it positive, in deviations of the
    /// noise, and no farther than counts.
    off: Vec<f64>,
    /// For each vertex the neighbors inside of the same piece, or along a border of it.
    alike: Buckets<u32>,
    /// Whether each vertex is on a surface.
    is_on: Vec<bool>,
    /// The square of the sum of so many that is no chance, over their number.
    limit: f64,
}

impl Strays {
    pub(super) fn new(domain: &Domain<'_>, state: &Labelling) -> Result<Self> {
        let n = domain.positions.len();
        let on: Vec<Vec<u32>> =
            memory::all(memory::gathered((0..n).map(|v| surfaces_at(domain, state, v as u32)))?)?;
        let distance = |v: usize| {
            let distances = on[v].iter().filter_map(|&label| {
                let piece = &state.pieces[label as usize];
                Some(piece.side * piece.surface?.distance(domain.positions[v]).0)
            });
            distances.min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0)
        };
        let mut off: Vec<f64> = memory::joined((0..n).into_par_iter().map(distance))?;
        // Inside of one piece, or along borders of one.
        let are_alike = |v: u32, w: u32| {
            let [v, w] = [v, w].map(|v| &on[v as usize]);
            (v.len() > 1) == (w.len() > 1) && v.iter().any(|label| w.contains(label))
        };
        let alike = Buckets::new(n, |visit| {
            for h in domain.connectivity.edges() {
                let (v, w) = (domain.connectivity.tail(h), domain.connectivity.head(h));
                if are_alike(v, w) {
                    visit(v as usize, w);
                    visit(w as usize, v);
                }
            }
        })?;
        let most = (2.0 * MOST_MISFIT).sqrt();
        off.iter_mut().for_each(|d| *d = (*d / domain.sigma).clamp(-most, most));
        let is_on = memory::gathered(on.iter().map(|on| !on.is_empty()))?;
        // A shift of their own, somewhere among all vertices, has as many parameters as a plane.
        let limit = 2.0 * domain.kappa * Kind::Plane.n_parameters() as f64;
        Ok(Self { off, alike, is_on, limit })
    }

    /// The vertices about which vertices stray together by more than chance makes them, the nearest first:
    /// what strays is left out of wider circles.
    pub(super) fn found(mut self) -> Result<Vec<bool>> {
        let n = self.off.len();
        let mut found = memory::repeated(false, n)?;
        for most in CIRCLES {
            let stray = memory::joined((0..n).into_par_iter().map(|v| self.strays(v as u32, most)))?;
            for (v, stray) in stray.into_iter().enumerate().filter(|(_, stray)| *stray) {
                (found[v], self.is_on[v]) = (stray, false);
            }
        }
        Ok(found)
    }

    /// Whether so many vertices about `v`, or fewer, that are on the same surfaces stray together.
    fn strays(&self, v: u32, most: usize) -> bool {
        if !self.is_on[v as usize] {
            return false;
        }
        let mut seen = vec![v];
        let (mut next, mut sum) = (0, 0.0);
        while next < seen.len() {
            let row = next..seen.len();
            sum += seen[row.clone()].iter().map(|&v| self.off[v as usize]).sum::<f64>();
            if sum * sum > self.limit * seen.len() as f64 {
                return true;
            }
            next = seen.len();
            for k in row {
                for &w in self.alike.of(seen[k] as usize) {
                    if seen.len() < most && self.is_on[w as usize] && !seen.contains(&w) {
                        seen.push(w);
                    }
                }
            }
        }
        false
    }
}

/// The pieces with surfaces that vertex `v` is on, ascending. Faces without area have no say.
fn surfaces_at(domain: &Domain<'_>, state: &Labelling, v: u32) -> Result<Vec<u32>> {
    let faces = domain.faces_at(v).iter().filter(|&&f| norm(domain.areas[f as usize]) > 0.0);
    let labels = faces.map(|&f| state.labels[f as usize]);
    let has_surface = |label: &u32| state.pieces.get(*label as usize).is_some_and(|p| p.surface.is_some());
    let mut on: Vec<u32> = memory::sifted(labels.filter(has_surface))?;
    on.sort_unstable();
    on.dedup();
    Ok(on)
}

impl Labelling {
    /// Gives the faces about `strays` labels of their own, one to those that are connected. Pieces that lose
    /// half of their area go with them.
    pub(super) fn leave(
        &mut self,
        domain: &Domain<'_>,
        strays: &[bool],
        has_left: &mut [bool],
    ) -> Result<()> {
        let has_surface = |label: u32| self.pieces.get(label as usize).is_some_and(|p| p.surface.is_some());
        let faces = self.labels.iter().zip(domain.connectivity.faces());
        let mut leaves: Vec<bool> = memory::gathered(
            faces.map(|(&label, face)| has_surface(label) && face.iter().any(|&v| strays[v as usize])),
        )?;
        for piece in self.pieces.iter().filter(|piece| piece.surface.is_some()) {
            let area = |&f: &u32| norm(domain.areas[f as usize]);
            let all: f64 = piece.faces.iter().map(area).sum();
            let left: f64 = piece.faces.iter().filter(|&&f| leaves[f as usize]).map(area).sum();
            if 2.0 * left > all {
                piece.faces.iter().for_each(|&f| leaves[f as usize] = true);
            }
        }
        has_left.iter_mut().zip(&leaves).for_each(|(has_left, leaves)| *has_left |= leaves);
        self.name_apart(domain, &mut leaves)?;
        Ok(())
    }

    /// Gives `faces` labels beyond those of the pieces, one to those that are connected, in the order of
    /// their first faces, and says how many. None is left in `faces`.
    pub(super) fn name_apart(&mut self, domain: &Domain<'_>, faces: &mut [bool]) -> Result<usize> {
        let (first, mut count) = (self.pieces.len(), 0);
        let mut stack: Vec<u32> = Vec::new();
        for f in 0..faces.len() {
            if !std::mem::take(&mut faces[f]) {
                continue;
            }
            let name = (first + count) as u32;
            self.labels[f] = name;
            memory::push(&mut stack, f as u32)?;
            while let Some(f) = stack.pop() {
                for (_, g) in domain.around(f as usize) {
                    if std::mem::take(&mut faces[g]) {
                        self.labels[g] = name;
                        memory::push(&mut stack, g as u32)?;
                    }
                }
            }
            count += 1;
        }
        Ok(count)
    }
}
