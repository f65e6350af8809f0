//! The Python bindings of `ridgeform-core`: a thin crate, arrays in and arrays out.
//!
//! [`arrays`] is the doorway for data, [`doorway`] that for calls and [`errors`] that for failures; then one
//! file for each thing that Python sees.

#[macro_use]
mod keywords;

mod arrays;
mod coarsen;
mod columns;
mod denoise;
mod diffusion_curves;
mod doorway;
mod errors;
mod facet;
mod fill_holes;
mod holes;
mod interpolate;
mod matrix;
mod memory;
mod mesh;
mod modes;
mod nested;
mod numbers;
mod operators;
mod options;
mod parts;
mod progress;
mod remesh;
mod restore;
mod scalar;
mod segment;
mod solution;
mod stylize;
mod topology;
mod trace;
mod watch;

use pyo3::prelude::*;

#[pymodule]
#[pyo3(name = "_native_0_1_0")]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<mesh::Mesh>()?;
    module.add_class::<mesh::MeshReport>()?;
    module.add_class::<matrix::SparseMatrix>()?;
    module.add_class::<progress::Progress>()?;
    module.add_class::<segment::Segmentation>()?;
    module.add_class::<parts::Parts>()?;
    module.add_class::<facet::Faceted>()?;
    module.add_class::<solution::Solution>()?;
    module.add_class::<holes::Hole>()?;
    module.add_class::<stylize::Stylized>()?;
    module.add_class::<remesh::Remeshed>()?;
    module.add_class::<coarsen::Coarsened>()?;
    module.add_class::<restore::Restored>()?;
    module.add_class::<diffusion_curves::DiffusionCurves>()?;
    module.add_class::<diffusion_curves::Redrawn>()?;
    module.add_class::<fill_holes::Filled>()?;
    module.add_class::<fill_holes::FilledHole>()?;
    module.add_function(wrap_pyfunction!(operators::hessian, module)?)?;
    module.add_function(wrap_pyfunction!(operators::hessian_norm, module)?)?;
    module.add_function(wrap_pyfunction!(operators::energy, module)?)?;
    module.add_function(wrap_pyfunction!(operators::voronoi_mass, module)?)?;
    module.add_function(wrap_pyfunction!(operators::cotangent_laplacian, module)?)?;
    module.add_function(wrap_pyfunction!(operators::intrinsic_delaunay, module)?)?;
    module.add_function(wrap_pyfunction!(operators::boundary_loops, module)?)?;
    module.add_function(wrap_pyfunction!(holes::find_holes, module)?)?;
    module.add_function(wrap_pyfunction!(topology::weld, module)?)?;
    module.add_function(wrap_pyfunction!(topology::orient, module)?)?;
    module.add_function(wrap_pyfunction!(denoise::denoise, module)?)?;
    module.add_function(wrap_pyfunction!(interpolate::interpolate, module)?)?;
    module.add_function(wrap_pyfunction!(modes::vibration_modes, module)?)?;
    module.add_function(wrap_pyfunction!(segment::segment, module)?)?;
    module.add_function(wrap_pyfunction!(parts::parts, module)?)?;
    module.add_function(wrap_pyfunction!(facet::facet, module)?)?;
    module.add_function(wrap_pyfunction!(stylize::stylize, module)?)?;
    module.add_function(wrap_pyfunction!(remesh::remesh, module)?)?;
    module.add_function(wrap_pyfunction!(coarsen::coarsen, module)?)?;
    module.add_function(wrap_pyfunction!(restore::restore, module)?)?;
    module.add_function(wrap_pyfunction!(diffusion_curves::diffusion_curves, module)?)?;
    module.add_function(wrap_pyfunction!(diffusion_curves::redraw, module)?)?;
    module.add_function(wrap_pyfunction!(diffusion_curves::smooth_curves, module)?)?;
    module.add_function(wrap_pyfunction!(trace::trace_curves, module)?)?;
    module.add_function(wrap_pyfunction!(fill_holes::fill_holes, module)?)?;
    module.add_function(wrap_pyfunction!(memory::memory_available, module)?)?;
    module.add_function(wrap_pyfunction!(memory::memory_estimate, module)?)?;
    Ok(())
}
