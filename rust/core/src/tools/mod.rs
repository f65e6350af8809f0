//! What a user asks for, one file each: scattered data interpolation, denoising, vibration modes,
//! stylization.

mod denoise;
mod energy_options;
mod interpolate;
mod modes;
mod options;
mod scalar;
mod sharpness;
mod stylize;
mod unseen;

pub use denoise::{denoise, DenoiseOptions};
pub use energy_options::EnergyOptions;
pub use interpolate::interpolate;
pub use modes::{vibration_modes, ModeOptions, Modes};
pub use options::SolveOptions;
pub use scalar::ScalarOptions;
pub use sharpness::sharpened_weights;
pub use stylize::{stylize, FlowStatus, Scale, StylizeOptions, Stylized};

pub use crate::solve::Solution;
