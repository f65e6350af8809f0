//! Wall time, processor time and memory of this process.

use std::time::Instant;

use cpu_time::ProcessTime;

use crate::input::Arguments;
use crate::list;

/// A sample lasts at least this long, in seconds, so that what other processes do evens out.
const LEAST: f64 = 0.1;

/// Repeated measurements of one thing, in seconds.
pub(crate) struct Samples {
    repeats: usize,
    budget: f64,
    /// By the clock on the wall.
    pub wall: Vec<f64>,
    /// Spent by the processor on all threads of this process; empty where the system does not tell.
    pub cpu: Vec<f64>,
}

impl Samples {
    /// As many as `repeats` says (5), or fewer once they have taken `budget` seconds (60) together.
    pub(crate) fn new(arguments: &Arguments) -> Result<Self, Box<dyn std::error::Error>> {
        let repeats = (arguments.number("repeats", 5.0)? as usize).max(1);
        let budget = arguments.number("budget", 60.0)?;
        Ok(Self { repeats, budget, wall: Vec::new(), cpu: Vec::new() })
    }

    /// Takes the samples and returns the last result of `work`. Short work is done several times per sample.
    pub(crate) fn take<T, E>(&mut self, mut work: impl FnMut() -> Result<T, E>) -> Result<T, E> {
        let mut times_per_sample = 1;
        loop {
            let (wall, cpu) = (Instant::now(), processor_time());
            for _ in 1..times_per_sample {
                work()?;
            }
            let result = work()?;
            let elapsed = wall.elapsed().as_secs_f64();
            if self.wall.is_empty() && elapsed < LEAST && times_per_sample == 1 {
                times_per_sample = (LEAST / elapsed.max(1e-7)).ceil() as usize;
                continue;
            }
            let each = 1.0 / times_per_sample as f64;
            self.wall.push(each * elapsed);
            self.cpu.extend(cpu.zip(processor_time()).map(|(before, after)| each * (after - before)));
            if self.wall.len() >= self.repeats || self.wall.iter().sum::<f64>() > self.budget {
                return Ok(result);
            }
        }
    }

    /// The two lists as JSON fields.
    pub(crate) fn fields(&self) -> Vec<(&'static str, String)> {
        vec![("wall_s", list(&self.wall)), ("cpu_s", list(&self.cpu))]
    }
}

/// Seconds that the threads of this process have run, those that have ended too, as Clarabel's.
fn processor_time() -> Option<f64> {
    Some(ProcessTime::try_now().ok()?.as_duration().as_secs_f64())
}

/// The most memory that this process has held so far, in bytes; 0 where the system does not tell.
pub(crate) fn peak_memory() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|rest| rest.split_whitespace().next()?.parse::<u64>().ok());
    kilobytes.unwrap_or(0) * 1024
}
