//! What became of the holes.

use super::options::PatchShape;
use crate::error::Refusal;
use crate::mesh::vector::Point;

/// How the filling of one hole ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HoleStatus {
    /// The patch no longer moves, or is the smooth one.
    Converged,
    /// All steps were done.
    Finished,
    /// The caller asked to finish early; the patch is what was reached.
    Stopped,
    /// It cannot be filled.
    Refused(Refusal),
}

impl HoleStatus {
    /// The name that users see.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::Finished => "finished",
            Self::Stopped => "stopped",
            Self::Refused(_) => "refused",
        }
    }
}

/// How one patch ended.
pub(super) struct Completed {
    pub shape: PatchShape,
    pub sharpness: f64,
    pub status: HoleStatus,
    pub energy: [f64; 2],
    pub gap: f64,
    pub iterations: usize,
}

impl Completed {
    /// The end of a patch that stays smooth.
    pub(super) fn smooth() -> Self {
        Self {
            shape: PatchShape::Smooth,
            sharpness: 0.0,
            status: HoleStatus::Converged,
            energy: [0.0; 2],
            gap: 0.0,
            iterations: 0,
        }
    }
}

/// One hole and how it was filled.
#[derive(Debug, Clone, PartialEq)]
pub struct FilledHole {
    /// The vertices around it.
    pub boundary: Vec<u32>,
    /// How it ended.
    pub status: HoleStatus,
    /// What the patch looks like: flat, smooth or sharp; `Auto` where there is none.
    pub shape: PatchShape,
    /// The sharpness used; 0 where it is smooth or flat.
    pub sharpness: f64,
    /// `E_H` of the coordinates of the patch and its surroundings, before and after the flow;
    /// zeros if there was none.
    pub energy: [f64; 2],
    /// The relative duality gap of the flow's last step.
    pub gap: f64,
    /// Steps of the flow.
    pub iterations: usize,
}

impl FilledHole {
    /// What became of the hole within `boundary`.
    pub(super) fn of(boundary: Vec<u32>, outcome: Result<Completed, Refusal>) -> Self {
        let (shape, outcome) = match outcome {
            Ok(completed) => (completed.shape, completed),
            Err(reason) => {
                (PatchShape::Auto, Completed { status: HoleStatus::Refused(reason), ..Completed::smooth() })
            }
        };
        let Completed { sharpness, status, energy, gap, iterations, .. } = outcome;
        Self { boundary, status, shape, sharpness, energy, gap, iterations }
    }
}

/// The patches of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Filled {
    /// The vertices of the patches that are not the mesh's; their numbers follow on those of the mesh.
    pub vertices: Vec<Point>,
    /// The faces of the patches, oriented as the faces around.
    pub faces: Vec<[u32; 3]>,
    /// For each of these faces the entry of `holes` that it fills.
    pub patch: Vec<u32>,
    /// The holes that were chosen.
    pub holes: Vec<FilledHole>,
    /// How the holes ended: stopped if one was, else finished if one was, else converged.
    pub status: HoleStatus,
    /// The edges of sharp and flat patches that are bent by more than 30 degrees,
    /// smaller vertex first, sorted.
    pub ridges: Vec<[u32; 2]>,
}

impl Filled {
    /// No patches yet.
    pub(super) fn none() -> Self {
        Self {
            vertices: Vec::new(),
            faces: Vec::new(),
            patch: Vec::new(),
            holes: Vec::new(),
            status: HoleStatus::Converged,
            ridges: Vec::new(),
        }
    }

    /// Once all holes are there: how they ended together, and each ridge once.
    pub(super) fn sum_up(&mut self) {
        let ended = |status| self.holes.iter().any(|hole| hole.status == status);
        if let Some(status) =
            [HoleStatus::Stopped, HoleStatus::Finished].into_iter().find(|&status| ended(status))
        {
            self.status = status;
        }
        self.ridges.sort_unstable();
        self.ridges.dedup();
    }
}
