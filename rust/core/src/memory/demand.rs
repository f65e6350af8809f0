//! One call and its size: what it needs, and whether that fits.

use super::model::{Cost, CLARABEL, COARSER, DIVIDED, LOOSE, ON_COARSER};
use super::threads::settle;
use super::{available, is_granted, share_of, share_of_free, with_margin, Tool, SMALL};
use crate::{Error, Result};

/// What decides how much memory a call takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// The call.
    pub tool: Tool,
    /// Vertices of the mesh.
    pub n_vertices: usize,
    /// Faces of the mesh.
    pub n_faces: usize,
    /// Columns of values that share a solution.
    pub n_columns: usize,
    /// Whether Clarabel solves.
    pub is_clarabel: bool,
}

impl Demand {
    /// One column on a mesh of this size, by the default solver.
    #[must_use]
    pub fn new(tool: Tool, n_vertices: usize, n_faces: usize) -> Self {
        Self { tool, n_vertices, n_faces, n_columns: 1, is_clarabel: false }
    }

    /// The same with so many columns, by Clarabel or not.
    #[must_use]
    pub fn with_columns(self, n_columns: usize, is_clarabel: bool) -> Self {
        Self { n_columns, is_clarabel, ..self }
    }

    /// Bytes that the call takes at its peak, about: within a quarter of the truth on meshes that are about
    /// as wide as long.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub fn estimate(&self) -> usize {
        let on_itself = match self.tool {
            Tool::SegmentByLevels => Tool::Segment,
            Tool::FacetByLevels => Tool::Facet,
            other => other,
        };
        if on_itself != self.tool && self.n_vertices < COARSER {
            return Self { tool: on_itself, ..*self }.estimate();
        }
        // Most of it is the segments, which are found on coarser meshes here, too.
        if self.tool == Tool::Restore && self.n_vertices >= COARSER {
            return Self { tool: Tool::SegmentByLevels, ..*self }.estimate();
        }
        let is_solved = self.tool.solves();
        // Of the solver's work only what the coarser mesh needs.
        let is_clarabel = is_solved && self.is_clarabel && self.tool != Tool::SegmentByLevels;
        let Cost { face, logarithmic, column } = if is_clarabel { CLARABEL } else { self.tool.cost() };
        let faces = self.n_faces as f64;
        let n_columns = if self.tool == Tool::Stylize && is_clarabel { 3 } else { self.n_columns };
        // Modes are computed one after the other; Clarabel takes columns as they are.
        let is_single = self.tool.has_single_columns();
        let column = if is_single { self.tool.cost().column } else { column };
        let lanes = if is_single || is_clarabel { n_columns } else { n_columns.max(1).next_power_of_two() };
        let further = lanes.saturating_sub(1) as f64;
        let loose = self.n_vertices.saturating_sub(self.n_faces.div_ceil(2).saturating_mul(3)) as f64;
        let per_loose = if is_solved { LOOSE[0] } else { LOOSE[1] };
        let fixed = match self.tool {
            Tool::Parts => DIVIDED.1 * faces.min(DIVIDED.0),
            Tool::SegmentByLevels => ON_COARSER[0],
            Tool::FacetByLevels => ON_COARSER[1],
            _ => 0.0,
        };
        let per_face = face + logarithmic * faces.max(2.0).log2() + column * further;
        let bytes = faces * per_face + fixed + per_loose * loose;
        bytes.min(1e18) as usize
    }

    /// How many vertices a mesh of this kind may have that fits into so many bytes.
    #[must_use]
    pub fn fitting(&self, bytes: usize) -> usize {
        let scaled = |n: usize| Self {
            n_vertices: n,
            n_faces: (self.n_faces as u128 * n as u128 / (self.n_vertices.max(1) as u128)) as usize,
            ..*self
        };
        let (mut fits, mut not) = (0, self.n_vertices);
        while fits + 1 < not {
            let middle = usize::midpoint(fits, not);
            if scaled(middle).estimate() <= bytes {
                fits = middle;
            } else {
                not = middle;
            }
        }
        fits
    }

    /// Refuses the call if it does not fit: into `limit` bytes, or without a limit into [`super::SHARE`] of
    /// what is free. Returns the bytes that it may take.
    ///
    /// # Errors
    /// [`Error::Memory`] with what is needed, what there is, and what would fit.
    pub fn admit(&self, limit: Option<usize>) -> Result<usize> {
        let needed = self.estimate();
        let reserved = settle(self.tool.name(), self.tool.solves())?;
        let most = limit.unwrap_or_else(|| share_of_free(needed));
        if needed > most {
            let fits = self.fitting(most);
            return Err(Error::Memory {
                what: self.tool.name(),
                needed,
                limit: most,
                is_given: limit.is_some(),
                fits,
            });
        }
        // The small pieces of a small call fit into the heaps that are there.
        let reserved = match reserved {
            _ if needed < SMALL => reserved.min(SMALL),
            _ if self.is_clarabel => 2 * reserved,
            _ => reserved,
        };
        let asked = with_margin(needed).saturating_add(reserved);
        if (needed >= SMALL || reserved > 0) && !is_granted(asked) {
            let left = available().min(asked);
            let fits = self.fitting(share_of(left.saturating_sub(reserved)));
            return Err(Error::Memory {
                what: self.tool.name(),
                needed: asked,
                limit: left,
                is_given: false,
                fits,
            });
        }
        Ok(most)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn demand(tool: Tool, n: usize) -> Demand {
        Demand::new(tool, n, 2 * n)
    }

    #[test]
    fn a_refusal_says_what_is_needed_and_what_would_fit() {
        let large = demand(Tool::Stylize, 1_000_000);
        let error = large.admit(Some(1_000_000_000)).unwrap_err();
        let Error::Memory { needed, fits, .. } = error else { unreachable!("{error}") };
        assert_eq!(needed, large.estimate());
        assert!(demand(Tool::Stylize, fits).estimate() <= 1_000_000_000);
        assert!(demand(Tool::Stylize, fits + 1).estimate() > 999_000_000);
        let text = error.to_string();
        assert!(
            text.contains("more than the limit of 1.00 GB") && text.contains("raise memory_limit"),
            "{text}"
        );
    }

    #[test]
    fn no_size_overflows() {
        for (_, tool) in Tool::ALL {
            let huge = Demand { n_vertices: usize::MAX, n_faces: usize::MAX, ..demand(tool, 1) };
            assert!(huge.estimate() >= 1 << 50);
            assert!(huge.admit(None).is_err());
        }
    }

    #[test]
    fn small_meshes_need_nothing_and_small_limits_still_count() {
        let small = demand(Tool::Stylize, 25);
        assert_eq!(small.admit(None).unwrap(), usize::MAX);
        assert!(small.admit(Some(1000)).is_err());
    }
}
