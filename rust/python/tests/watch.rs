//! The watcher of the doorway, without Python: panics end there, interruptions cancel, results come through.
#![allow(clippy::panic, missing_docs)]

#[path = "../src/watch.rs"]
mod watch;

use std::convert::Infallible;
use std::time::{Duration, Instant};

use ridgeform_core::Progress;
use watch::{watch, Outcome, INTERVAL};

fn never() -> Option<Infallible> {
    None
}

#[test]
fn a_result_comes_through_at_once() {
    let start = Instant::now();
    assert_eq!(watch(&Progress::new(), || 7, never), Outcome::Done(7));
    assert!(start.elapsed() < INTERVAL, "the end of the work must wake the watcher");
}

#[test]
fn a_panic_becomes_a_value_with_its_message() {
    let fixed = watch(&Progress::new(), || -> u8 { panic!("static text") }, never);
    assert_eq!(fixed, Outcome::Panicked("static text".into()));
    let face = 7;
    let formatted = watch(&Progress::new(), || -> u8 { panic!("face {face}") }, never);
    assert_eq!(formatted, Outcome::Panicked("face 7".into()));
    let other = watch(&Progress::new(), || -> u8 { std::panic::panic_any(3) }, never);
    assert_eq!(other, Outcome::Panicked("unknown panic".into()));
}

#[test]
fn an_interruption_cancels_the_work_and_waits_for_it() {
    let progress = Progress::new();
    let work = || {
        while !progress.is_cancelled() {
            std::thread::sleep(Duration::from_millis(1));
        }
    };
    let start = Instant::now();
    assert_eq!(watch(&progress, work, || Some("interrupted")), Outcome::Interrupted("interrupted"));
    assert!(start.elapsed() >= INTERVAL);
    assert!(progress.is_cancelled());
}

#[test]
fn an_interruption_is_asked_for_once_and_beats_the_result() {
    let progress = Progress::new();
    let mut asked = 0;
    let outcome = watch(
        &progress,
        || std::thread::sleep(4 * INTERVAL),
        || {
            asked += 1;
            Some(asked)
        },
    );
    assert_eq!(outcome, Outcome::Interrupted(1));
    assert_eq!(asked, 1);
}
