//! When an allocation fails, the call is an error and the process lives.
//!
//! This program has an allocator that gives no more than a limit. Each case runs in a child: the mesh is made, the limit is set
//! to a part of what the call says that it needs, and the call must end with a result or with an error that says what is missing.
//! A child that took a failed allocation for granted would be ended by SIGABRT. What is asked of the allocator at once before a
//! call is the estimate and a quarter more: with less than that every call is refused. With a little more some are refused when the
//! matrix has been analyzed, or when they ask for the next stage; with twice as much every call has a result.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::alloc::System;
use std::process::Command;

use cap::Cap;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use rayon::prelude::*;
use ridgeform_core::error::SolveError;
use ridgeform_core::linear::Columns;
use ridgeform_core::memory::{Demand, Tool};
use ridgeform_core::mesh::Mesh;
use ridgeform_core::operators::Energy;
use ridgeform_core::remesh::{remesh, RemeshOptions};
use ridgeform_core::shapes::{cylinder, grid, Shape};
use ridgeform_core::solve::Solver;
use ridgeform_core::tools::{
    denoise, diffusion_curves, fill_holes, filling_demand, interpolate, parts, segment, smooth_curves, stylize,
    trace_curves, vibration_modes, DenoiseOptions, DiffusionCurvesOptions, EnergyOptions, FillHolesOptions,
    ModeOptions, PartsOptions, ScalarOptions, SegmentOptions, SolveOptions, StylizeOptions,
};
use ridgeform_core::{Error, Progress, Result};

#[global_allocator]
static ALLOCATOR: Cap<System> = Cap::new(System, usize::MAX);

/// Names the case in the child.
const CASE: &str = "RIDGEFORM_ALLOCATION_CASE";

/// The limits in parts of what the call says that it needs.
const PARTS: [f64; 12] = [0.0, 0.001, 0.01, 0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 1.1, 1.3, 2.5];

/// Less than this part is refused, and more than that is enough.
const ASKED: f64 = 1.25;
const ENOUGH: f64 = 2.5;

/// What is left for small pieces, which nobody asks for one by one.
const ROOM: usize = 8 << 20;

/// Each call, and how many vertices a side of its mesh has: those that take little are asked for on large meshes only.
const CALLS: [(&str, usize); 13] = [
    ("stylize", 75),
    ("denoise", 75),
    ("denoise 3 columns", 75),
    ("denoise quadratic", 75),
    ("denoise by clarabel", 40),
    ("interpolate", 75),
    ("vibration_modes", 75),
    ("segment", 60),
    ("parts", 115),
    ("fill_holes", 210),
    ("remesh", 165),
    ("diffusion_curves", 60),
    ("trace_curves", 230),
];

fn shape_for(name: &str, side: usize, scale: f64) -> Shape {
    let shape = if name == "fill_holes" { cylinder(side, 2, side as f64 / 6.0, 2.0) } else { grid(side, side) };
    let lift = |[x, y, z]: [f64; 3]| [x, y, z + 2.0 * (0.1 * x).sin() + (3.7 * x * y).sin() * 0.05];
    shape.map(|p| lift(p).map(|x| scale * x))
}

fn few(n: usize, solver: Solver) -> SolveOptions {
    SolveOptions { max_iterations: Some(n), solver, ..SolveOptions::default() }
}

fn demand(name: &str, mesh: &Mesh) -> Demand {
    match name {
        "stylize" => mesh.demand(Tool::Stylize).with_columns(3, false),
        "denoise" => mesh.demand(Tool::Denoise),
        "denoise 3 columns" => mesh.demand(Tool::Denoise).with_columns(3, false),
        "denoise quadratic" => mesh.demand(Tool::Quadratic),
        "denoise by clarabel" => mesh.demand(Tool::Denoise).with_columns(1, true),
        "interpolate" => mesh.demand(Tool::Interpolate),
        "vibration_modes" => mesh.demand(Tool::Modes),
        "segment" => mesh.demand(Tool::Segment).with_columns(3, false),
        "parts" => mesh.demand(Tool::Parts),
        "fill_holes" => filling_demand(mesh, None),
        "remesh" => mesh.demand(Tool::Remesh),
        "diffusion_curves" => mesh.demand(Tool::DiffusionCurves),
        _ => mesh.demand(Tool::Curves),
    }
}

/// What a call is given, made before the limit counts.
struct Given {
    mesh: Mesh,
    points: Columns,
    heights: Columns,
    known: Columns,
    pins: Vec<usize>,
    labels: Vec<i32>,
    curve: Vec<[f64; 3]>,
}

impl Given {
    fn new(mesh: Mesh) -> Self {
        let points = mesh.positions().unwrap().to_vec();
        let heights = Columns { n_rows: points.len(), n_columns: 1, data: points.iter().map(|p| p[2]).collect() };
        let pins: Vec<usize> = (0..points.len()).step_by(500).collect();
        let data = pins.iter().map(|&i| heights.data[i]).collect();
        let middle = points.len() as u32 / 2;
        let labels = mesh.connectivity().faces().iter().map(|f| i32::from(f[0] > middle)).collect();
        Self {
            known: Columns { n_rows: pins.len(), n_columns: 1, data },
            curve: points.iter().copied().step_by(100).collect(),
            points: Columns::from_points(&points),
            mesh,
            heights,
            pins,
            labels,
        }
    }

    fn call(&self, name: &str) -> Result<()> {
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
            "parts" => parts(&self.mesh, &PartsOptions::default(), &progress).map(drop),
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
fn multiply() {
    let ones = Mat::<f64>::full(64, 64, 1.0);
    let mut product = Mat::<f64>::zeros(64, 64);
    matmul(&mut product, Accum::Replace, &ones, &ones, 1.0, Par::Seq);
}

/// Runs a case in the child: prints how it ended.
fn run(name: &str, part: f64, scale: f64) {
    let (_, side) = CALLS.into_iter().find(|(call, _)| *call == name).unwrap();
    let given = Given::new(shape_for(name, side, scale).mesh().unwrap());
    // Threads and what they keep are there before a call counts.
    rayon::broadcast(|_| multiply());
    multiply();
    let needed = demand(name, &given.mesh).estimate();
    assert!(needed >= ridgeform_core::memory::SMALL, "{name}: {needed} bytes are not asked for");
    let most = (part * needed as f64) as usize;
    ALLOCATOR.set_limit(ALLOCATOR.allocated() + most.max(ROOM)).unwrap();
    let outcome = given.call(name);
    ALLOCATOR.set_limit(usize::MAX).unwrap();
    match outcome {
        Ok(()) => println!("outcome: result"),
        Err(Error::Memory { .. } | Error::Solve(SolveError::Memory { .. })) => println!("outcome: refused"),
        Err(error) => println!("outcome: {error}"),
    }
}

/// Runs a case in a child. Returns what was wrong with how it ended.
fn fault_of(name: &str, part: f64, scale: f64) -> Option<String> {
    let child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "no_failed_allocation_ends_the_process", "--nocapture"])
        .env(CASE, format!("{name}@{part}@{scale:e}"))
        .env("RAYON_NUM_THREADS", "2")
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&child.stdout);
    let expected = match part {
        _ if part < ASKED => "outcome: refused",
        _ if part < ENOUGH => "outcome: re",
        _ => "outcome: result",
    };
    let is_fine = child.status.success() && text.contains(expected);
    let errors = String::from_utf8_lossy(&child.stderr);
    (!is_fine).then(|| format!("{name} at {part} and size {scale:e}: {} {text} {errors}", child.status))
}

#[test]
fn no_failed_allocation_ends_the_process() {
    if let Ok(case) = std::env::var(CASE) {
        let fields: Vec<&str> = case.split('@').collect();
        return run(fields[0], fields[1].parse().unwrap(), fields[2].parse().unwrap());
    }
    // At an extreme size the mesh is computed on in another unit, as a copy.
    let cases: Vec<(&str, f64, f64)> = CALLS
        .iter()
        .flat_map(|(name, _)| PARTS.map(|part| (*name, part, 1.0)).into_iter().chain([(*name, 0.0, 1e-40)]))
        .collect();
    let faults: Vec<String> =
        cases.into_par_iter().filter_map(|(name, part, scale)| fault_of(name, part, scale)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
