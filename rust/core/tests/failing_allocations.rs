//! One large allocation of a call fails, each in turn.
//!
//! In a child the call runs on one thread with an allocator that gives nothing for one allocation of at least
//! [`LARGE`] bytes. It must end with a result or an error that says what is missing. Where the allocation
//! cannot return an error the process ends, as Rust has it: that is why a call asks for all of it before
//! ([`ridgeform_core::memory`]). Nothing else may happen: no panic, no result that says that it is none, no
//! other error. What was found is printed; with `RIDGEFORM_FAIL=all` for every allocation, with the name of a
//! call for all of that call.
#![allow(clippy::unwrap_used, clippy::panic)]

mod allocation_calls;

use allocation_calls::{in_a_child, multiply, shape_for, Given, CALLS};
use rayon::prelude::*;
use ridgeform_core::error::SolveError;
use ridgeform_core::Error;
use ridgeform_failing_allocator::Failing;

#[global_allocator]
static ALLOCATOR: Failing = Failing::new();

/// Names the case in the child.
const CASE: &str = "RIDGEFORM_FAILING_ALLOCATION";

/// With `all`, every allocation is failed, not some; with the name of a call every one of that.
const WHICH: &str = "RIDGEFORM_FAIL";

/// What the system allocator takes from the system by itself, and not from what it keeps for small pieces;
/// [`SIZE`] says another number of bytes.
const LARGE: usize = 128 << 10;

/// From how many bytes on an allocation is failed: fewer find arrays that are large on larger meshes.
const SIZE: &str = "RIDGEFORM_FAIL_SIZE";

/// With it only every so many allocations are failed.
const STEP: &str = "RIDGEFORM_FAIL_STEP";

/// So many of a call are tried, evenly spread.
const TRIED: usize = 3;

/// How many allocations of ours end the process at most, in calls that have been gone through: a number may
/// fall and not rise. Those of a library can: they have nothing to return an error with.
const MOST: [(&str, usize); 17] = [
    ("stylize", 0),
    ("stylize by levels", 0),
    ("denoise", 0),
    ("denoise 3 columns", 0),
    ("denoise quadratic", 0),
    ("denoise by clarabel", 0),
    ("interpolate", 0),
    ("vibration_modes", 0),
    ("segment", 0),
    ("segment by levels", 0),
    ("parts", 0),
    ("facet", 0),
    ("restore", 0),
    ("fill_holes", 0),
    ("remesh", 0),
    ("diffusion_curves", 0),
    ("trace_curves", 0),
];

/// What the names of the functions of libraries begin with.
const LIBRARIES: [&str; 5] = ["clarabel::", "<clarabel::", "faer::", "spade::", "<spade::"];

/// So many functions say where an allocation was asked for.
const NAMED: usize = 4;

/// The number that a variable of the environment says.
fn number(name: &str) -> Option<usize> {
    std::env::var(name).ok()?.parse().ok()
}

/// Runs a case in the child: prints how it ended.
fn run(name: &str, which: usize) {
    let (_, side) = CALLS.into_iter().find(|(call, _)| *call == name).unwrap();
    let given = Given::new(shape_for(name, side, 1.0).mesh().unwrap());
    rayon::broadcast(|_| multiply());
    multiply();
    ALLOCATOR.fail(which, number(SIZE).unwrap_or(LARGE), true);
    let outcome = given.call(name);
    let count = ALLOCATOR.stop();
    match outcome {
        Ok(()) => println!("outcome: {count} result"),
        Err(Error::Memory { .. } | Error::Solve(SolveError::Memory { .. })) => {
            println!("outcome: {count} refused")
        }
        Err(error) => println!("outcome: {count} {error}"),
    }
}

/// How a call ends whose allocation `which` fails.
#[derive(Debug, PartialEq)]
enum End {
    /// After so many large allocations.
    Result(usize),
    Refused,
    /// The allocation could not return an error; the function that asked for it.
    Aborted(String),
    Fault(String),
}

/// The innermost functions of a backtrace that are not of the standard library, and who called them.
fn culprit(backtrace: &str) -> String {
    let frames = backtrace.lines().filter_map(|line| line.trim().split_once(": ")).map(|(_, frame)| frame);
    let owners = ["ridgeform_core", "faer", "clarabel", "rayon", "spade"];
    let own = frames.filter(|frame| owners.iter().any(|name| frame.contains(name)));
    own.take(NAMED).collect::<Vec<_>>().join(" < ")
}

fn end_of(name: &str, which: usize) -> End {
    let child = in_a_child("a_failed_allocation_is_refused_or_known", CASE, &format!("{name}@{which}"), 1);
    let (text, errors) = (String::from_utf8_lossy(&child.stdout), String::from_utf8_lossy(&child.stderr));
    let outcome =
        text.lines().find_map(|line| line.split("outcome: ").nth(1)).and_then(|rest| rest.split_once(' '));
    match outcome {
        Some((count, "result")) if child.status.success() => End::Result(count.parse().unwrap()),
        Some((_, "refused")) if child.status.success() => End::Refused,
        None if errors.contains("memory allocation of") => End::Aborted(culprit(&errors)),
        _ => End::Fault(format!("{name} at {which}: {} {text} {errors}", child.status)),
    }
}

/// What was wrong with how a call ended. Its first large allocation is what it asks for all of itself,
/// which is refused.
fn faults_of(name: &str, is_all: bool) -> Vec<String> {
    let count = match end_of(name, usize::MAX) {
        End::Result(count) => count,
        end => return vec![format!("{name} has no result: {end:?}")],
    };
    let step = if is_all { number(STEP).unwrap_or(1) } else { count.div_ceil(TRIED).max(1) };
    let ends: Vec<End> = (0..count).step_by(step).map(|which| end_of(name, which)).collect();
    let n_refused = ends.iter().filter(|end| **end == End::Refused).count();
    let n_aborted = ends.iter().filter(|end| matches!(end, End::Aborted(_))).count();
    println!("{name}: {count} large, {} tried, {n_refused} refused, {n_aborted} end the process", ends.len());
    let ours = |place: &&String| !LIBRARIES.iter().any(|library| place.starts_with(library));
    let places = ends.iter().filter_map(|end| match end {
        End::Aborted(place) => Some(place),
        _ => None,
    });
    let places: Vec<&String> = places.filter(ours).collect();
    places.iter().for_each(|place| println!("{name} ends the process in {place}"));
    let most = MOST.iter().find(|(call, _)| *call == name).map_or(usize::MAX, |(_, most)| *most);
    let many = (places.len() > most).then(|| format!("{name} ends the process more often: {places:?}"));
    let first =
        (ends.first() != Some(&End::Refused)).then(|| format!("{name}: the first is {:?}", ends.first()));
    let others = ends.iter().filter_map(|end| match end {
        End::Fault(fault) => Some(fault.clone()),
        _ => None,
    });
    others.chain(first).chain(many).collect()
}

#[test]
fn a_failed_allocation_is_refused_or_known() {
    if let Ok(case) = std::env::var(CASE) {
        let (name, which) = case.split_once('@').unwrap();
        return run(name, which.parse().unwrap());
    }
    let which = std::env::var(WHICH).unwrap_or_default();
    let calls =
        CALLS.into_par_iter().filter(|(name, _)| which.is_empty() || which == "all" || which == *name);
    let faults: Vec<String> = calls.flat_map(|(name, _)| faults_of(name, !which.is_empty())).collect();
    assert!(faults.is_empty(), "{faults:?}");
}
