//! How much memory this process may still take.

use super::cgroup;

/// Bytes that this process may still take: what the machine has free (on Linux `MemAvailable`: with what
/// caches would give back), and on Linux also what is left under the limits of its control groups and under
/// `RLIMIT_AS` and `RLIMIT_DATA` (`ulimit -v`, `ulimit -d`). `usize::MAX` where the system tells nothing.
#[must_use]
pub fn available() -> usize {
    let mut least = machine().unwrap_or(u64::MAX);
    if cfg!(target_os = "linux") {
        let left = [cgroup::left(), resources()];
        least = left.into_iter().flatten().fold(least, u64::min);
    }
    usize::try_from(least).unwrap_or(usize::MAX)
}

fn machine() -> Option<u64> {
    let ram = sysinfo::MemoryRefreshKind::nothing().with_ram();
    let system = sysinfo::System::new_with_specifics(sysinfo::RefreshKind::nothing().with_memory(ram));
    Some(system.available_memory()).filter(|&bytes| bytes > 0)
}

/// What is left of the soft limits on address space and data, by `/proc`.
pub(super) fn resources() -> Option<u64> {
    let limits = std::fs::read_to_string("/proc/self/limits").ok()?;
    let limit = |name: &str| {
        let line = limits.lines().find(|line| line.starts_with(name))?;
        // "unlimited" is no number.
        line[name.len()..].split_whitespace().next()?.parse::<u64>().ok()
    };
    let bounds = [("Max address space", "VmSize:"), ("Max data size", "VmData:")];
    let bounds = bounds.map(|(name, used)| limit(name).map(|most| (most, used)));
    if bounds == [None, None] {
        return None;
    }
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let used = |name: &str| {
        let line = status.lines().find(|line| line.starts_with(name))?;
        line[name.len()..].split_whitespace().next()?.parse::<u64>().ok().map(|kib| kib << 10)
    };
    bounds.into_iter().flatten().map(|(most, name)| most.saturating_sub(used(name).unwrap_or(0))).min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_some_memory_and_less_than_a_petabyte() {
        assert!((1 << 20..1_usize << 50).contains(&available()), "{}", available());
    }
}
