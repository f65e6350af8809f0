//! When an allocation fails, the call is an error and the process lives.
//!
//! This program has an allocator that gives no more than a limit. Each case runs in a child: the mesh is
//! made, the limit is set to a part of what the call says that it needs, and the call must end with a result
//! or with an error that says what is missing. A child that took a failed allocation for granted would be
//! ended by SIGABRT. What is asked of the allocator at once before a call is the estimate and a quarter more:
//! with less than that every call is refused. With a little more some are refused when the matrix has been
//! analyzed, or when they ask for the next stage; with twice as much every call has a result.
#![allow(clippy::unwrap_used, clippy::panic)]

mod allocation_calls;

use allocation_calls::{in_a_child, multiply, shape_for, Given, CALLS};
use cap::Cap;
use rayon::prelude::*;
use ridgeform_core::error::SolveError;
use ridgeform_core::memory::{Demand, Tool};
use ridgeform_core::mesh::Mesh;
use ridgeform_core::tools::filling_demand;
use ridgeform_core::Error;
use std::alloc::System;

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

fn demand(name: &str, mesh: &Mesh) -> Demand {
    match name {
        "stylize" => mesh.demand(Tool::Stylize).with_columns(3, false),
        "stylize by levels" => mesh.demand(Tool::Stylize).with_columns(3, false),
        "denoise" => mesh.demand(Tool::Denoise),
        "denoise 3 columns" => mesh.demand(Tool::Denoise).with_columns(3, false),
        "denoise quadratic" => mesh.demand(Tool::Quadratic),
        "denoise by clarabel" => mesh.demand(Tool::Denoise).with_columns(1, true),
        "interpolate" => mesh.demand(Tool::Interpolate),
        "vibration_modes" => mesh.demand(Tool::Modes),
        "segment" => mesh.demand(Tool::Segment).with_columns(3, false),
        "segment by levels" => mesh.demand(Tool::SegmentByLevels).with_columns(3, false),
        "parts" => mesh.demand(Tool::Parts),
        "facet" => mesh.demand(Tool::Facet),
        "restore" => mesh.demand(Tool::Restore).with_columns(3, false),
        "fill_holes" => filling_demand(mesh, None).unwrap(),
        "remesh" => mesh.demand(Tool::Remesh),
        "diffusion_curves" => mesh.demand(Tool::DiffusionCurves),
        _ => mesh.demand(Tool::Curves),
    }
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
    let case = format!("{name}@{part}@{scale:e}");
    let child = in_a_child("no_failed_allocation_ends_the_process", CASE, &case, 2);
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
