//! What a user asks for, one file each: scattered data interpolation, denoising, vibration modes,
//! stylization, facets, segmentation, parts, diffusion curves.

pub(crate) mod answer;
mod denoise;
mod diffusion_curves;
mod energy_options;
mod facet;
mod fill_holes;
pub(crate) mod heights;
mod interpolate;
pub(crate) mod minimum_cut;
mod modes;
mod options;
mod parts;
mod restore;
mod scalar;
mod scale;
mod segment;
mod sharpness;
mod stylize;
mod unseen;

pub use denoise::{denoise, DenoiseOptions};
pub use diffusion_curves::{
    color_regions, diffusion_curves, redraw, smooth_curves, trace_curves, ColoredCurves, DiffusionCurves,
    DiffusionCurvesOptions, Redrawn, TracedCurve,
};
pub use energy_options::EnergyOptions;
pub use facet::{facet, FacetMerges, FacetOptions, Faceted, KeptTriangles, Symmetric};
pub use fill_holes::{
    fill_holes, filling_demand, FillHolesOptions, Filled, FilledHole, HoleStatus, LoopChoice, PatchShape,
    Sharpness,
};
pub use interpolate::interpolate;
pub use modes::{vibration_modes, ModeOptions, Modes};
pub use options::{Levels, SolveOptions};
pub use parts::{parts, Parts, PartsOptions};
pub use restore::{restore, RestoreOptions, RestoreStatus, Restored, RestoredSurface};
pub use scalar::ScalarOptions;
pub use scale::Scale;
pub use segment::{segment, Fillets, Hierarchy, SegmentMethod, SegmentOptions, Segmentation};
pub use sharpness::sharpened_weights;
pub use stylize::{stylize, Flatness, FlowStatus, StylizeOptions, Stylized};

pub use crate::solve::Solution;
