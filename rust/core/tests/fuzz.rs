//! Structured fuzzing: every tool on meshes that nobody modeled, and what holds of every answer.
//!
//! A call follows from its seed alone. The kept seeds of `fuzz_seeds.txt` come first, then fixed ones; with
//! `RIDGEFORM_FUZZ_SECONDS` set, for so long ones that no run had before. `RIDGEFORM_FUZZ_CALL` repeats one.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

#[path = "fuzz_answers/mod.rs"]
mod fuzz_answers;

use std::collections::BTreeMap;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::time::{Duration, Instant, SystemTime};

use fuzz_answers::{check, TOOLS};
use ridgeform_core::shapes::{cube, grid, icosphere, torus, Random, Shape};
use ridgeform_core::Error;

/// A number below `n`.
fn below(random: &mut Random, n: u64) -> u64 {
    random.bits() % n
}

/// A small shape, sound or with a fault.
fn shape(random: &mut Random) -> Shape {
    let k = 1 + below(random, 4) as usize;
    let mut shape = match below(random, 5) {
        0 => grid(2 * k, 2 * k),
        1 => icosphere(k.div_ceil(2)),
        2 => torus(3 * k, 2 + k, 1.0, 0.4),
        3 => cube(k),
        _ => {
            let n = 4 * k as u64;
            let mut point = || std::array::from_fn(|_| random.symmetric());
            let vertices = (0..n).map(|_| point()).collect();
            let mut corner = || below(random, n) as u32;
            Shape { vertices, faces: (0..6 * k).map(|_| [corner(), corner(), corner()]).collect() }
        }
    };
    if below(random, 2) == 0 {
        shape = shape.noisy([0.05, 0.5][below(random, 2) as usize], random.bits());
    }
    let (n, m) = (shape.vertices.len() as u64, shape.faces.len() as u64);
    let f = below(random, m) as usize;
    match below(random, 14) {
        0 => {
            let share = random.uniform() * 0.4;
            let gone: Vec<bool> = (0..m).map(|_| random.uniform() < share).collect();
            shape = shape.without_faces(|f| gone[f]);
        }
        1 => shape.faces.push([shape.faces[f][0], shape.faces[f][1], below(random, n) as u32]),
        2 => shape.faces.push(shape.faces[f]),
        3 => shape.faces.extend(shape.faces.clone().into_iter().map(|[a, b, c]| [c, b, a])),
        4 => shape.faces[f][1] = shape.faces[f][0],
        5 => shape.vertices[shape.faces[f][0] as usize] = shape.vertices[shape.faces[f][1] as usize],
        6 => shape.vertices.iter_mut().for_each(|p| p[1] *= 1e-9),
        7 => shape.vertices.extend([[3.0, 1.0, 2.0], [0.0; 3]]),
        8 => shape.faces[f].swap(0, 1),
        _ => {}
    }
    shape
}

/// The vertices, of any size.
fn sized(shape: &mut Shape, random: &mut Random) {
    let exponent = below(random, 2000) as i32 - 1000;
    let power = |e: i32| 2_f64.powi(e / 2) * 2_f64.powi(e - e / 2);
    match below(random, 8) {
        0 => shape.vertices.iter_mut().flatten().for_each(|x| *x *= power(exponent)),
        1 => shape.vertices.iter_mut().for_each(|p| {
            let size = 10_f64.powf(30.0 * random.symmetric());
            *p = p.map(|x| size * x);
        }),
        2 => shape.vertices.iter_mut().flatten().for_each(|x| *x += power(exponent.abs() % 54)),
        3 => shape.vertices.iter_mut().flatten().for_each(|x| *x = (*x * 50.0).round() * 5e-324),
        _ => {}
    }
}

/// Makes the call of a seed: which tool, and how it ended.
fn call(seed: u64) -> (&'static str, &'static str) {
    let mut random = Random::new(seed);
    let (name, tool) = TOOLS[below(&mut random, TOOLS.len() as u64) as usize];
    let mut shape = shape(&mut random);
    sized(&mut shape, &mut random);
    let ended = match shape.mesh().and_then(|mesh| check(tool, &mesh, &mut random)) {
        Ok(()) => "answer",
        Err(error) => {
            assert!(
                error == Error::Cancelled || error.to_string().split(' ').count() > 3,
                "no sentence: {error}"
            );
            "refused"
        }
    };
    (name, ended)
}

/// Calls in the suite: always the same, whatever the machine does. They take some seconds.
const SUITE: usize = 600;

#[test]
fn every_answer_is_a_number_near_what_went_in() {
    let given = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    if let Some(seed) = given("RIDGEFORM_FUZZ_CALL") {
        println!("core: seed {seed}: {:?}", call(seed));
        return;
    }
    let seconds = given("RIDGEFORM_FUZZ_SECONDS");
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap().as_secs();
    let first = seconds.map_or(0, |_| since << 20);
    let kept = include_str!("fuzz_seeds.txt").split_whitespace().map(|line| line.parse().unwrap());
    let end = seconds.map(|seconds| Instant::now() + Duration::from_secs(seconds));
    let (mut counts, mut faults) = (BTreeMap::new(), Vec::new());
    let kept: Vec<u64> = kept.collect();
    let n_kept = kept.len();
    for (i, seed) in kept.into_iter().chain(first..).enumerate() {
        let is_over = end.map_or(i >= n_kept + SUITE, |end| i >= n_kept && Instant::now() > end);
        if is_over {
            break;
        }
        match catch_unwind(AssertUnwindSafe(|| call(seed))) {
            Ok(ended) => *counts.entry(ended).or_insert(0_usize) += 1,
            Err(_) => {
                eprintln!("seed {seed}");
                faults.push(seed);
            }
        }
    }
    println!("core: {} calls, {} faults: {counts:?}", counts.values().sum::<usize>(), faults.len());
    assert!(faults.is_empty(), "add these seeds to fuzz_seeds.txt: {faults:?}");
    assert!(counts.iter().any(|((_, ended), n)| *ended == "answer" && *n > 0));
}
