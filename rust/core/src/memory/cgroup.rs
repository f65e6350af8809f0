//! What is left under the memory limits of the Linux control groups that hold this process, version 1 or 2.

use std::fs::read_to_string;
use std::path::{Path, PathBuf};

/// Bytes left under the tightest limit; `None` where there is none.
pub(super) fn left() -> Option<u64> {
    left_in(&read_to_string("/proc/self/cgroup").ok()?, Path::new("/sys/fs/cgroup"))
}

/// [`left`], for the text of `/proc/self/cgroup` and the place where the groups are mounted.
///
/// A limit of a group counts for all groups in it. In a container the path names groups of the host that
/// cannot be seen from inside; the container's own is the root there.
fn left_in(memberships: &str, mount: &Path) -> Option<u64> {
    let mut least = None;
    for line in memberships.lines() {
        let mut fields = line.splitn(3, ':');
        let (Some(_), Some(controllers), Some(path)) = (fields.next(), fields.next(), fields.next()) else {
            continue;
        };
        let (root, files) = match controllers {
            "" => (mount.to_path_buf(), ["memory.max", "memory.current", "inactive_file"]),
            list if list.split(',').any(|name| name == "memory") => (
                mount.join("memory"),
                ["memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"],
            ),
            _ => continue,
        };
        let mut group: PathBuf = root.join(path.trim_start_matches('/'));
        loop {
            if let Some(left) = left_in_group(&group, files) {
                least = Some(least.unwrap_or(left).min(left));
            }
            if group == root || !group.pop() {
                break;
            }
        }
    }
    least
}

/// The limit less what is used and could not be given back: pages of files that nobody has read for a while.
fn left_in_group(group: &Path, [limit, usage, inactive]: [&str; 3]) -> Option<u64> {
    let number = |name: &str| read_to_string(group.join(name)).ok()?.trim().parse::<u64>().ok();
    // "max" is no number; version 1 writes a number beyond any machine.
    let limit = number(limit).filter(|&limit| limit < 1 << 60)?;
    let stat = read_to_string(group.join("memory.stat")).unwrap_or_default();
    let idle = stat.lines().find_map(|line| line.strip_prefix(inactive)?.trim().parse::<u64>().ok());
    Some(limit.saturating_sub(number(usage)?.saturating_sub(idle.unwrap_or(0))))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn write(folder: &Path, files: &[(&str, &str)]) {
        std::fs::create_dir_all(folder).unwrap();
        for (name, text) in files {
            std::fs::write(folder.join(name), text).unwrap();
        }
    }

    #[test]
    fn the_tightest_limit_on_the_way_to_the_root_counts() {
        let mount = std::env::temp_dir().join(format!("ridgeform-cgroup-{}", std::process::id()));
        write(&mount.join("slice"), &[("memory.max", "3000\n"), ("memory.current", "1000\n")]);
        write(&mount.join("slice/app"), &[("memory.max", "max\n"), ("memory.current", "900\n")]);
        assert_eq!(left_in("0::/slice/app\n", &mount), Some(2000));
        write(&mount.join("slice"), &[("memory.stat", "anon 600\ninactive_file 400\n")]);
        assert_eq!(left_in("0::/slice/app\n", &mount), Some(2400));
        let one = [("memory.limit_in_bytes", "500"), ("memory.usage_in_bytes", "200")];
        write(&mount.join("memory"), &one);
        // The host's path is not there: the root of the container is.
        assert_eq!(left_in("4:memory:/docker/1234\n9:name=systemd:/\n0::/slice\n", &mount), Some(300));
        write(&mount.join("memory"), &[("memory.limit_in_bytes", "9223372036854771712")]);
        assert_eq!(left_in("4:memory:/\n", &mount), None);
        assert_eq!(left_in("7:cpu:/\n", &mount), None);
        std::fs::remove_dir_all(&mount).unwrap();
    }
}
