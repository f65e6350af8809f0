//! How to fill holes.

use crate::operators::Dual;
use crate::solve::Coupling;
use crate::tools::options::{check_positive, check_range};
use crate::tools::{Scale, SolveOptions};
use crate::Result;

/// A boundary loop to fill.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LoopChoice {
    /// By its place in [`crate::hole_filling::find_holes`].
    Index(usize),
    /// By the vertices around it, in either direction.
    Vertices(Vec<u32>),
}

/// How sharp the ridges of patches get.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Sharpness {
    /// Per hole: as sharp as can be where there are ridges around it, smooth where there are none.
    #[default]
    Auto,
    /// 0: the flow of the paper, without flips and snapping; toward 1: ever sharper.
    Value(f64),
}

/// What patches look like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PatchShape {
    /// Per hole: flat where a planar rim is met steeply all round,
    /// sharp where there are ridges around the hole, else smooth.
    #[default]
    Auto,
    /// In the mean plane of the rim; as `Auto` where that would overlap itself.
    Flat,
    /// Without ridges.
    Smooth,
    /// Flat pieces that meet in ridges.
    Sharp,
}

impl PatchShape {
    /// The name that users see.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Flat => "flat",
            Self::Smooth => "smooth",
            Self::Sharp => "sharp",
        }
    }
}

/// How to fill holes.
#[derive(Debug, Clone)]
pub struct FillHolesOptions {
    /// Which loops; `None` for all that can be filled.
    pub loops: Option<Vec<LoopChoice>>,
    /// Of all loops, only those with at most so many edges.
    pub max_edges: Option<usize>,
    /// Of all loops, also the outer borders of open sheets.
    pub outer: bool,
    /// Edge length in the patches; that of the rim where `None`.
    pub edge_length: Option<f64>,
    /// Steps of the flow at most; 0 leaves the smooth patch.
    pub iterations: usize,
    /// `η`: a larger one moves less per step.
    pub fidelity: f64,
    /// What the patches look like.
    pub shape: PatchShape,
    /// How sharp those are that are not flat.
    pub sharpness: Sharpness,
    /// Joint norms are invariant under rotations; separate ones are those of the paper.
    pub coupling: Coupling,
    /// The unit of `fidelity`, measured on the patch.
    pub scale: Scale,
    /// Dual edges of the operator.
    pub dual: Dual,
    /// The solver; the default stops on residuals.
    pub solve: SolveOptions,
}

impl Default for FillHolesOptions {
    fn default() -> Self {
        Self {
            loops: None,
            max_edges: None,
            outer: false,
            edge_length: None,
            iterations: 50,
            fidelity: 50.0,
            shape: PatchShape::Auto,
            sharpness: Sharpness::Auto,
            coupling: Coupling::Joint,
            scale: Scale::MaxEdge,
            dual: Dual::Barycentric,
            solve: SolveOptions::default().on_residuals(),
        }
    }
}

impl FillHolesOptions {
    /// Refuses what is out of range.
    pub(super) fn check(&self) -> Result<()> {
        check_positive("fidelity", self.fidelity, "it must be positive")?;
        check_positive("edge_length", self.edge_length, "it must be positive, or None for the rim's")?;
        match self.sharpness {
            Sharpness::Auto => Ok(()),
            Sharpness::Value(sharpness) => check_range("sharpness", sharpness, 0.0, 1.0),
        }
    }
}
