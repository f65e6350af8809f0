//! Structured fuzzing: every tool on meshes that nobody modeled, and what holds of every answer.
//!
//! A call follows from its seed alone. The kept seeds of `fuzz_seeds.txt` come first, then fixed ones; with
//! `RIDGEFORM_FUZZ_SECONDS` set, for so long ones that no run had before. `RIDGEFORM_FUZZ_CALL` repeats one.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

#[path = "fuzz_answers/mod.rs"]
mod fuzz_answers;

use std::collections::BTreeMap;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant, SystemTime};

use fuzz_answers::{any, check, shape, TOOLS};
use ridgeform_core::shapes::Random;
use ridgeform_core::Error;

/// Makes the call of a seed: which tool, and how it ended.
fn call(seed: u64) -> (&'static str, &'static str) {
    let mut random = Random::new(seed);
    let (name, tool) = any(&mut random, &TOOLS);
    let ended = match shape(&mut random).mesh().and_then(|mesh| check(tool, &mesh, &mut random)) {
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

/// No call takes a second: one that takes two minutes hangs. The process is ended and says which it was.
const PATIENCE: Duration = Duration::from_secs(120);

/// Ends the process where `seed`, the one that is tried, stays the same for too long.
fn watch(seed: &'static AtomicU64) {
    std::thread::spawn(move || loop {
        let before = seed.load(Ordering::Relaxed);
        std::thread::sleep(PATIENCE);
        if seed.load(Ordering::Relaxed) == before {
            eprintln!("seed {before}: no answer after {} s", PATIENCE.as_secs());
            std::process::abort();
        }
    });
}

/// Calls in the suite: always the same, whatever the machine does. They take some seconds.
const SUITE: usize = 3000;

#[test]
fn every_answer_is_a_number_near_what_went_in() {
    let given = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    if let Some(seed) = given("RIDGEFORM_FUZZ_CALL") {
        let mut random = Random::new(seed);
        println!("{}: {:?}", any(&mut random, &TOOLS).0, shape(&mut random));
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
    static TRIED: AtomicU64 = AtomicU64::new(0);
    watch(&TRIED);
    // To hand a small sum to another thread takes longer than the sum.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let mut slowest = (Duration::ZERO, 0);
    for (i, seed) in kept.into_iter().chain(first..).enumerate() {
        let is_over = end.map_or(i >= n_kept + SUITE, |end| i >= n_kept && Instant::now() > end);
        if is_over {
            break;
        }
        TRIED.store(seed, Ordering::Relaxed);
        let start = Instant::now();
        match catch_unwind(AssertUnwindSafe(|| pool.install(|| call(seed)))) {
            Ok(ended) => *counts.entry(ended).or_insert(0_usize) += 1,
            Err(_) => {
                eprintln!("seed {seed}: {}", any(&mut Random::new(seed), &TOOLS).0);
                faults.push(seed);
            }
        }
        slowest = slowest.max((start.elapsed(), seed));
    }
    println!("core: the longest call took {:.2} s: seed {}", slowest.0.as_secs_f64(), slowest.1);
    println!("core: {} calls, {} faults: {counts:?}", counts.values().sum::<usize>(), faults.len());
    assert!(faults.is_empty(), "add these seeds to fuzz_seeds.txt: {faults:?}");
    assert!(counts.iter().any(|((_, ended), n)| *ended == "answer" && *n > 0));
}
