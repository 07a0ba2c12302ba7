//! How much memory there is to be had, and the refusal of what would take more, before it is taken.
//!
//! A Rust program ends where memory cannot be had, and Linux promises more than it has. So what is large is estimated
//! first, and held against what is free on the machine, what the limits of the process leave (`ulimit -v`, `-d`), and
//! what its control groups do, which is how containers and batch systems bound it.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use crate::error::Error;

/// What is smaller is not worth a look at what there is [bytes]: a look takes some tens of microseconds.
const SMALL: f64 = 16e6;

/// Share of what there is that an estimate may take up; the rest is for what no estimate counts.
const USABLE: f64 = 0.9;

/// Stack of a thread, and what an allocator sets up for it [bytes].
pub const THREAD: f64 = 4e6;

/// Refuses what would take so many bytes if there are not so many, or more than `most`: `key` and `value` are what asked
/// for it, `what` takes the memory, `mend` says what would take less.
pub fn check(key: &str, value: impl ToString, bytes: f64, most: f64, what: &str, mend: &str) -> Result<(), Error> {
    check_beside(0.0, key, value, bytes, most, what, mend)
}

fn check_beside(
    promised: f64,
    key: &str,
    value: impl ToString,
    bytes: f64,
    most: f64,
    what: &str,
    mend: &str,
) -> Result<(), Error> {
    if bytes <= SMALL.min(most) {
        return Ok(());
    }
    let there = most.min((available() - promised).max(0.0));
    if bytes <= there {
        return Ok(());
    }
    let allowed = format!("{what} would take {} of memory, more than {}: {mend}", size(bytes), size(there));
    // What is too much wherever it runs is another thing than what is too much here and now.
    Err(if bytes > most { Error::input(key, value, allowed) } else { Error::memory(key, value, allowed) })
}

/// What work under way was told that it may take, bit by bit [bytes].
static PROMISED: AtomicU64 = AtomicU64::new(0);

/// Memory promised to work as long as it takes it.
#[derive(Debug)]
pub struct Promise(u64);

impl Drop for Promise {
    fn drop(&mut self) {
        PROMISED.fetch_sub(self.0, Ordering::Relaxed);
    }
}

/// The same as [`check`] for work that takes its memory bit by bit: what others beside it were promised is not there.
pub fn promise(
    key: &str,
    value: impl ToString,
    bytes: f64,
    most: f64,
    what: &str,
    mend: &str,
) -> Result<Promise, Error> {
    let own = if bytes <= SMALL { 0 } else { bytes as u64 };
    let others = PROMISED.fetch_add(own, Ordering::Relaxed);
    let promise = Promise(own);
    check_beside(others as f64, key, value, bytes, most, what, mend)?;
    Ok(promise)
}

/// Memory that may be asked for now [bytes]; infinite where the system does not say.
pub fn available() -> f64 {
    USABLE * System { proc: PathBuf::from("/proc"), groups: PathBuf::from("/sys/fs/cgroup") }.free()
}

/// So many zeros, or a refusal where the system has no room for them: see [`check`] for how it is put.
pub fn zeros<T: Clone + Default>(key: &str, value: impl ToString, count: usize) -> Result<Vec<T>, Error> {
    // Asked for and given back: zeros that come from the system as such need not be written.
    let room = Vec::<T>::new().try_reserve_exact(count);
    room.map_err(|_| none_left(key, value, count as f64 * size_of::<T>() as f64))?;
    Ok(vec![T::default(); count])
}

/// Makes room for so many more, or refuses.
pub fn reserve<T>(values: &mut Vec<T>, key: &str, value: impl ToString, count: usize) -> Result<(), Error> {
    let bytes = count as f64 * size_of::<T>() as f64;
    values.try_reserve_exact(count).map_err(|_| none_left(key, value, bytes))
}

fn none_left(key: &str, value: impl ToString, bytes: f64) -> Error {
    Error::memory(key, value, format!("there is no memory left for the {} that this takes", size(bytes)))
}

/// In words.
fn size(bytes: f64) -> String {
    if bytes < 1e8 { format!("{:.0} MB", bytes / 1e6) } else { format!("{:.1} GB", bytes / 1e9) }
}

/// Where the system says what it has.
struct System {
    proc: PathBuf,
    groups: PathBuf,
}

impl System {
    /// What is free on the machine, within the limits of the process and within those of its control groups [bytes].
    fn free(&self) -> f64 {
        let text = |name: &str| std::fs::read_to_string(self.proc.join(name)).unwrap_or_default();
        let machine = kilobytes(&text("meminfo"), "MemAvailable:");
        let (limits, status) = (text("self/limits"), text("self/status"));
        let left = |limit: &str, used: &str| limit_of(&limits, limit).zip(kilobytes(&status, used)).map(|(l, u)| l - u);
        let process = [left("Max address space", "VmSize:"), left("Max data size", "VmData:")];
        let groups = self.group_limits(&text("self/cgroup"));
        let all = process.into_iter().flatten().chain(machine).chain(groups);
        all.fold(f64::INFINITY, f64::min).max(0.0)
    }

    /// What each control group of the process leaves, and each that it is part of.
    fn group_limits(&self, text: &str) -> Vec<f64> {
        let mut all = Vec::new();
        for line in text.lines() {
            let mut parts = line.splitn(3, ':').skip(1);
            let (Some(controllers), Some(path)) = (parts.next(), parts.next()) else { continue };
            let (roots, names): (&[&str], _) = match controllers {
                "" => (&["", "unified"], &SECOND),
                _ if controllers.split(',').any(|name| name == "memory") => (&["memory"], &FIRST),
                _ => continue,
            };
            // In a container the path may be the host's, of which only the root is seen.
            for root in roots {
                let root = self.groups.join(root);
                let own = root.join(path.trim_start_matches('/'));
                let groups = own.ancestors().take_while(|group| group.starts_with(&root));
                all.extend(groups.filter_map(|group| names.left(group)));
            }
        }
        all
    }
}

/// What a version of control groups calls its files.
struct Names {
    limits: &'static [&'static str],
    used: &'static str,
    /// In `memory.stat`: files kept in memory, which make way.
    gives_way: &'static str,
}

const FIRST: Names =
    Names { limits: &["memory.limit_in_bytes"], used: "memory.usage_in_bytes", gives_way: "total_inactive_file" };

const SECOND: Names =
    Names { limits: &["memory.max", "memory.high"], used: "memory.current", gives_way: "inactive_file" };

impl Names {
    /// What a group leaves, if it has a limit.
    fn left(&self, group: &Path) -> Option<f64> {
        let text = |name: &str| std::fs::read_to_string(group.join(name)).ok();
        // Without a limit it says "max", or a number near the largest.
        let number = |name: &str| text(name)?.trim().parse::<f64>().ok();
        let limit = self.limits.iter().filter_map(|name| number(name)).fold(f64::INFINITY, f64::min);
        let stat = text("memory.stat").unwrap_or_default();
        let mut words = stat.lines().filter_map(|line| line.split_once(' '));
        let gives_way =
            words.find(|(name, _)| *name == self.gives_way).and_then(|(_, bytes)| bytes.trim().parse().ok());
        let used = (number(self.used)? - gives_way.unwrap_or(0.0)).max(0.0);
        limit.is_finite().then_some(limit - used)
    }
}

/// A number of kilobytes by its name, in bytes.
fn kilobytes(text: &str, name: &str) -> Option<f64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let number = line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()?;
    Some(1024.0 * number)
}

/// The limit that holds, by its name; none if there is none.
fn limit_of(text: &str, name: &str) -> Option<f64> {
    text.lines().find_map(|line| line.strip_prefix(name))?.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A machine of files, gone with the test.
    struct Files(PathBuf);

    impl Files {
        fn new(name: &str, files: &[(&str, &str)]) -> Self {
            let root = std::env::temp_dir().join(format!("spanwise-memory-{}-{name}", std::process::id()));
            for (path, text) in files {
                let path = root.join(path);
                std::fs::create_dir_all(path.parent().unwrap()).unwrap();
                std::fs::write(path, text).unwrap();
            }
            Files(root)
        }

        fn free(&self) -> f64 {
            System { proc: self.0.join("proc"), groups: self.0.join("groups") }.free()
        }
    }

    impl Drop for Files {
        fn drop(&mut self) {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }

    const MEMINFO: (&str, &str) =
        ("proc/meminfo", "MemTotal:       24684092 kB\nMemFree:  1 kB\nMemAvailable:   21000000 kB\n");

    #[test]
    fn memory_in_use_counts() {
        assert_eq!(Files::new("machine", &[MEMINFO]).free(), 21_000_000.0 * 1024.0);
        assert_eq!(Files::new("silent", &[("proc/other", "")]).free(), f64::INFINITY);
    }

    #[test]
    fn limits_of_the_process_count() {
        let limits = "Limit                     Soft Limit           Hard Limit           Units     \n\
                      Max data size             unlimited            unlimited            bytes     \n\
                      Max address space         2000000000           unlimited            bytes     \n";
        let status = "Name:\tpython\nVmPeak:\t 900000 kB\nVmSize:\t  500000 kB\nVmData:\t  100000 kB\n";
        let files = [MEMINFO, ("proc/self/limits", limits), ("proc/self/status", status)];
        assert_eq!(Files::new("address", &files).free(), 2e9 - 500_000.0 * 1024.0);
        let limits = limits.replace("data size             unlimited ", "data size             150000000 ");
        let files = [MEMINFO, ("proc/self/limits", &limits), ("proc/self/status", status)];
        assert_eq!(Files::new("data", &files).free(), 150e6 - 100_000.0 * 1024.0);
    }

    #[test]
    fn groups_of_the_second_version_count_with_those_above_them() {
        let of = |own: &str, high: &str, above: &str| {
            let own = format!("{own}\n");
            let files = [
                MEMINFO,
                ("proc/self/cgroup", "0::/jobs/one\n"),
                ("groups/jobs/one/memory.max", &own),
                ("groups/jobs/one/memory.high", high),
                ("groups/jobs/one/memory.current", "3000000000\n"),
                ("groups/jobs/one/memory.stat", "anon 2\nfile 900\ninactive_file 1000000000\nactive_file 5\n"),
                ("groups/jobs/memory.max", above),
                ("groups/jobs/memory.current", "3500000000\n"),
            ];
            Files::new(&format!("second-{}-{}", own.trim(), high.len() + above.len()), &files).free()
        };
        assert_eq!(of("8000000000", "max\n", "max\n"), 6e9);
        assert_eq!(of("8000000000", "4000000000\n", "max\n"), 2e9);
        assert_eq!(of("max", "max\n", "4000000000\n"), 0.5e9);
        assert_eq!(of("max", "max\n", "max\n"), 21_000_000.0 * 1024.0);
        assert_eq!(of("1000000000", "max\n", "max\n"), 0.0);
    }

    #[test]
    fn groups_of_the_first_version_count_in_a_container_too() {
        let files = [
            MEMINFO,
            ("proc/self/cgroup", "9:name=systemd:/\n4:cpu,memory:/docker/11c6\n0::/\n"),
            ("groups/memory/memory.limit_in_bytes", "2147483648\n"),
            ("groups/memory/memory.usage_in_bytes", "1147483648\n"),
            ("groups/memory/memory.stat", "inactive_file 7\ntotal_inactive_file 147483648\n"),
        ];
        assert_eq!(Files::new("first", &files).free(), 2147483648.0 - 1e9);
        let unlimited = [files[0], files[1], (files[2].0, "9223372036854771712\n"), files[3], files[4]];
        assert_eq!(Files::new("unlimited", &unlimited).free(), 21_000_000.0 * 1024.0);
    }

    #[test]
    fn what_is_promised_is_not_there_for_others() {
        let more_than_half = 0.7 * available();
        let promised = || promise("step", 7, more_than_half, f64::INFINITY, "steps", "use fewer");
        let first = promised().unwrap();
        assert!(promised().is_err());
        drop(first);
        assert!(promised().is_ok());
    }

    #[test]
    fn what_does_not_fit_is_refused_by_name() {
        let refused = check("samples", 7, 1e18, f64::INFINITY, "results", "use fewer").unwrap_err().to_string();
        assert!(
            refused.starts_with("samples = 7: results would take 1000000000.0 GB of memory, more than "),
            "{refused}"
        );
        assert!(check("samples", 7, 2e9, 1e9, "results", "use fewer").is_err());
        assert!(check("samples", 7, 1e6, 1e9, "results", "use fewer").is_ok());
        assert!(zeros::<f64>("samples", 7, isize::MAX as usize / 16).is_err());
        assert!(reserve(&mut Vec::<u64>::new(), "samples", 7, isize::MAX as usize / 16).is_err());
        assert_eq!(zeros::<u32>("samples", 7, 3).unwrap(), [0; 3]);
    }
}
