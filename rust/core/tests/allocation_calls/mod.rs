//! Every tool as the tests of failing allocations call it.
#![allow(dead_code, unreachable_pub)]

use std::process::{Command, Output};

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use ridgeform_core::linear::Columns;
use ridgeform_core::mesh::Mesh;
use ridgeform_core::operators::Energy;
use ridgeform_core::remesh::{remesh, RemeshOptions};
use ridgeform_core::shapes::{cylinder, grid, Shape};
use ridgeform_core::solve::Solver;
use ridgeform_core::tools::{
    denoise, diffusion_curves, facet, fill_holes, interpolate, parts, restore, segment, smooth_curves,
    stylize, trace_curves, vibration_modes, DenoiseOptions, DiffusionCurvesOptions, EnergyOptions,
    FacetOptions, FillHolesOptions, Levels, ModeOptions, PartsOptions, RestoreOptions, ScalarOptions,
    SegmentOptions, SolveOptions, StylizeOptions,
};
use ridgeform_core::{Progress, Result};

/// Each call, and how many vertices a side of its mesh has:
/// those that take little are asked for on large meshes only.
pub const CALLS: [(&str, usize); 17] = [
    ("stylize", 75),
    ("stylize by levels", 124),
    ("denoise", 75),
    ("denoise 3 columns", 75),
    ("denoise quadratic", 75),
    ("denoise by clarabel", 40),
    ("interpolate", 75),
    ("vibration_modes", 75),
    ("segment", 60),
    ("segment by levels", 124),
    ("parts", 115),
    ("facet", 110),
    ("restore", 60),
    ("fill_holes", 210),
    ("remesh", 165),
    ("diffusion_curves", 60),
    ("trace_curves", 230),
];

/// The mesh of a call.
pub fn shape_for(name: &str, side: usize, scale: f64) -> Shape {
    let shape =
        if name == "fill_holes" { cylinder(side, 2, side as f64 / 6.0, 2.0) } else { grid(side, side) };
    let lift = |[x, y, z]: [f64; 3]| [x, y, z + 2.0 * (0.1 * x).sin() + (3.7 * x * y).sin() * 0.05];
    shape.map(|p| lift(p).map(|x| scale * x))
}

fn few(n: usize, solver: Solver) -> SolveOptions {
    SolveOptions { max_iterations: Some(n), solver, ..SolveOptions::default() }
}

/// What a call is given, made before the limit counts.
pub struct Given {
    pub mesh: Mesh,
    points: Columns,
    heights: Columns,
    known: Columns,
    pins: Vec<usize>,
    labels: Vec<i32>,
    curve: Vec<[f64; 3]>,
}

impl Given {
    pub fn new(mesh: Mesh) -> Self {
        let points = mesh.positions().unwrap().to_vec();
        let heights =
            Columns { n_rows: points.len(), n_columns: 1, data: points.iter().map(|p| p[2]).collect() };
        let pins: Vec<usize> = (0..points.len()).step_by(500).collect();
        let data = pins.iter().map(|&i| heights.data[i]).collect();
        let middle = points.len() as u32 / 2;
        let labels = mesh.connectivity().faces().iter().map(|f| i32::from(f[0] > middle)).collect();
        Self {
            known: Columns { n_rows: pins.len(), n_columns: 1, data },
            curve: points.iter().copied().step_by(100).collect(),
            points: Columns::from_points(&points).unwrap(),
            mesh,
            heights,
            pins,
            labels,
        }
    }

    pub fn call(&self, name: &str) -> Result<()> {
        let progress = Progress::new();
        let scalar = |solver| ScalarOptions { solve: few(5, solver), ..ScalarOptions::default() };
        let denoised = |values, scalar| {
            let options = DenoiseOptions { scalar, ..DenoiseOptions::default() };
            denoise(&self.mesh, values, &options, &progress).map(drop)
        };
        match name {
            "stylize" => {
                let solve = few(5, Solver::Auto);
                let options = StylizeOptions { iterations: 1, solve, ..StylizeOptions::default() };
                stylize(&self.mesh, &options, &progress).map(drop)
            }
            "stylize by levels" => {
                let solve = few(2, Solver::Auto);
                let (levels, movement) = (Levels::Always, Some(1e-3));
                let options =
                    StylizeOptions { iterations: 2, solve, levels, movement, ..StylizeOptions::default() };
                stylize(&self.mesh, &options, &progress).map(drop)
            }
            "denoise" => denoised(&self.heights, scalar(Solver::Auto)),
            "denoise 3 columns" => denoised(&self.points, scalar(Solver::Auto)),
            "denoise quadratic" => {
                let energy = EnergyOptions { kind: Energy::L2Hessian, ..EnergyOptions::default() };
                denoised(&self.heights, ScalarOptions { energy, ..scalar(Solver::Auto) })
            }
            "denoise by clarabel" => denoised(&self.heights, scalar(Solver::Clarabel)),
            "interpolate" => {
                interpolate(&self.mesh, &self.pins, &self.known, &scalar(Solver::Auto), &progress).map(drop)
            }
            "vibration_modes" => {
                let options = ModeOptions { solve: few(2, Solver::Auto), ..ModeOptions::default() };
                vibration_modes(&self.mesh, 2, &options, &progress).map(drop)
            }
            "segment" => segment(&self.mesh, None, &SegmentOptions::default(), &progress).map(drop),
            "segment by levels" => {
                let options = SegmentOptions { levels: Levels::Always, ..SegmentOptions::default() };
                segment(&self.mesh, None, &options, &progress).map(drop)
            }
            "parts" => parts(&self.mesh, &PartsOptions::default(), &progress).map(drop),
            "facet" => {
                let options = FacetOptions { facets: Some(2000), ..FacetOptions::default() };
                facet(&self.mesh, None, &options, &progress).map(drop)
            }
            "restore" => restore(&self.mesh, &RestoreOptions::default(), &progress).map(drop),
            "fill_holes" => {
                let options = FillHolesOptions { iterations: 1, outer: true, ..FillHolesOptions::default() };
                fill_holes(&self.mesh, &options, &progress).map(drop)
            }
            "remesh" => {
                let options = RemeshOptions { iterations: 1, ..RemeshOptions::default() };
                remesh(&self.mesh, &options, &progress).map(drop)
            }
            "diffusion_curves" => {
                let options = DiffusionCurvesOptions::default();
                diffusion_curves(&self.mesh, &self.heights, &self.labels, &options, &progress).map(drop)
            }
            _ => {
                trace_curves(&self.mesh, &[(self.curve.clone(), false)])?;
                smooth_curves(&self.mesh, &[]).map(drop)
            }
        }
    }
}

/// Has faer take the buffer that it keeps in this thread.
pub fn multiply() {
    let ones = Mat::<f64>::full(64, 64, 1.0);
    let mut product = Mat::<f64>::zeros(64, 64);
    matmul(&mut product, Accum::Replace, &ones, &ones, 1.0, Par::Seq);
}

/// What becomes of one test of this program in a process of its own, where `variable` names the case.
pub fn in_a_child(test: &str, variable: &str, case: &str, threads: usize) -> Output {
    Command::new(std::env::current_exe().unwrap())
        .args(["--exact", test, "--nocapture"])
        .env(variable, case)
        .env("RAYON_NUM_THREADS", threads.to_string())
        .output()
        .unwrap()
}
