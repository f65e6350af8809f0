//! What a user asks for, one file each: scattered data interpolation, denoising, stylization.

mod denoise;
mod interpolate;
mod options;
mod scalar;
mod sharpness;
mod stylize;

pub use denoise::{denoise, DenoiseOptions};
pub use interpolate::interpolate;
pub use options::SolveOptions;
pub use scalar::ScalarOptions;
pub use sharpness::sharpened_weights;
pub use stylize::{stylize, FlowStatus, Scale, StylizeOptions, Stylized};

pub use crate::solve::Solution;
