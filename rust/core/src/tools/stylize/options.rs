//! What a flow is asked, and what it answers.

use super::Flatness;
use crate::error::{Error, Result};
use crate::memory;
use crate::mesh::Mesh;
use crate::operators::Dual;
use crate::solve::Coupling;
use crate::tools::options::{check_fixed, check_positive, check_range, check_weights, ENOUGH};
use crate::tools::{Levels, Scale, SolveOptions};

/// How to stylize.
#[derive(Debug, Clone)]
pub struct StylizeOptions {
    /// Steps of the flow; the most where there is a `movement` or a `flat_share` to reach.
    pub iterations: usize,
    /// `η`: a larger one moves less per step. Where there is an end to reach, that of the first step.
    pub fidelity: f64,
    /// How far the shape may move: the root mean square distance of its free vertices from where they began,
    /// by area, in parts of the square root of the surface's area. Steps grow until it is reached or the
    /// planes have settled. `None`: all steps have the same fidelity, and all are done.
    pub movement: Option<f64>,
    /// The part of the area that shall lie in flat faces ([`Flatness::flat_share`]): steps grow until it does
    /// and facets have formed. With a `movement`, whichever is reached first. `None`: no such end.
    pub flat_share: Option<f64>,
    /// 0: the energy of the paper; 1: the most angular.
    pub sharpness: f64,
    /// Joint norms are invariant under rotations; separate ones are those of eq. (24).
    pub coupling: Coupling,
    /// The unit of `fidelity`.
    pub scale: Scale,
    /// Vertices that do not move.
    pub fixed: Option<Vec<bool>>,
    /// How much each vertex takes part: 0 fixed, 1 fully.
    pub strength: Option<Vec<f64>>,
    /// A weight for each face: 1 neutral, smaller where ridges are welcome, larger where they are not.
    pub ridge_weights: Option<Vec<f64>>,
    /// Intrinsic Delaunay flips before each step.
    pub delaunay: bool,
    /// Dual edges of the operator.
    pub dual: Dual,
    /// Whether most steps are done on coarser meshes; where that is automatic, in flows that look for an end.
    pub levels: Levels,
    /// The solver.
    pub solve: SolveOptions,
}

impl Default for StylizeOptions {
    fn default() -> Self {
        Self {
            iterations: 20,
            fidelity: 500.0,
            movement: None,
            flat_share: None,
            sharpness: 0.5,
            coupling: Coupling::Joint,
            scale: Scale::MaxEdge,
            fixed: None,
            strength: None,
            ridge_weights: None,
            delaunay: false,
            dual: Dual::Barycentric,
            levels: Levels::Auto,
            solve: SolveOptions::default(),
        }
    }
}

impl StylizeOptions {
    /// A copy.
    ///
    /// # Errors
    /// [`Error::Solve`] where memory is missing.
    pub(super) fn copied(&self) -> Result<Self> {
        Ok(Self {
            fixed: self.fixed.as_deref().map(memory::twin).transpose()?,
            strength: self.strength.as_deref().map(memory::twin).transpose()?,
            ridge_weights: self.ridge_weights.as_deref().map(memory::twin).transpose()?,
            ..self.without_arrays()
        })
    }

    /// The same without what has an entry a vertex or a face.
    pub(super) fn without_arrays(&self) -> Self {
        Self { fixed: None, strength: None, ridge_weights: None, ..*self }
    }

    /// Whether a vertex is asked not to move at all.
    pub(super) fn holds(&self, v: usize) -> bool {
        self.fixed.as_ref().is_some_and(|fixed| fixed[v])
            || self.strength.as_ref().is_some_and(|strength| strength[v] <= 0.0)
    }

    /// Whether a mesh with so many vertices gets levels.
    pub(super) fn uses_levels(&self, n_vertices: usize) -> bool {
        // Equal steps are those of the paper, each on the mesh itself.
        let is_suited = self.movement.is_some() || self.flat_share.is_some();
        self.levels.are_used(n_vertices, ENOUGH, is_suited)
    }
}

/// How a flow ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlowStatus {
    /// All steps were done; with a `movement` to reach, before it was reached.
    Finished,
    /// The shape has moved as far as it may.
    Reached,
    /// The planes have settled: more steps would make no more of the shape flat.
    Settled,
    /// All steps were done, but not all of them to the gap asked for.
    Inaccurate,
    /// Nothing moves any more.
    Converged,
    /// The shape has shrunk to (almost) nothing; the last sound step is returned.
    Collapsed,
    /// A step led out of the surroundings of the shape, as rounding does on triangles that are too uneven;
    /// the last sound step is returned.
    Diverged,
    /// The caller asked to finish early.
    Stopped,
}

impl FlowStatus {
    /// The name that users see.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Finished => "finished",
            Self::Reached => "reached",
            Self::Settled => "settled",
            Self::Inaccurate => "inaccurate",
            Self::Converged => "converged",
            Self::Collapsed => "collapsed",
            Self::Diverged => "diverged",
            Self::Stopped => "stopped",
        }
    }
}

/// What came out of a flow.
#[derive(Debug, Clone, PartialEq)]
pub struct Stylized {
    /// The vertices, as many and in the order of the input.
    pub vertices: Vec<[f64; 3]>,
    /// The steps from the beginning to the end of the flow. With levels the last of them were done on several
    /// meshes, and what follows has an entry each time.
    pub iterations: usize,
    /// `E_H` of the coordinates (18), before the first and after every step, on the mesh of that step.
    pub energy: Vec<f64>,
    /// The fidelity of every step.
    pub fidelities: Vec<f64>,
    /// The relative duality gap of every step's convex problem.
    pub gap: Vec<f64>,
    /// The solver's iterations in every step.
    pub solver_iterations: Vec<usize>,
    /// The vertices of the mesh that each step was done on: fewer than the mesh's own for those on coarse
    /// levels.
    pub level_vertices: Vec<usize>,
    /// Numeric factorizations in all.
    pub factorisations: usize,
    /// How far the shape is made of planes, before the first and after the last step.
    pub flatness: [Flatness; 2],
    /// How it ended.
    pub status: FlowStatus,
}

/// Refuses options that do not fit the mesh.
pub(super) fn check(mesh: &Mesh, options: &StylizeOptions) -> Result<()> {
    let (n, m) = (mesh.connectivity().n_vertices(), mesh.connectivity().n_faces());
    check_positive("fidelity", options.fidelity, "it must be positive")?;
    if options.movement.is_some_and(|movement| !(movement > 0.0 && movement.is_finite())) {
        return Err(Error::argument("movement", "is not a positive number; 0.007 is a useful one"));
    }
    if let Some(share) = options.flat_share {
        check_range("flat_share", share, 0.0, 1.0)?;
    }
    check_range("sharpness", options.sharpness, 0.0, 1.0)?;
    check_weights("strength", options.strength.as_ref(), n, "vertex")?;
    check_weights("ridge_weights", options.ridge_weights.as_ref(), m, "face")?;
    if let Some(strength) = &options.strength {
        if let Some(i) = strength.iter().position(|s| *s > 1.0) {
            return Err(Error::argument(
                "strength",
                format!("entry {i} is {}; it must be at most 1", strength[i]),
            ));
        }
    }
    check_fixed(options.fixed.as_deref(), n)
}
