//! How much memory a run takes, by what the system says is resident.

use std::path::Path;
use std::process::Command;

/// Bytes resident now.
pub fn resident() -> u64 {
    of_status("VmRSS:")
}

/// Most bytes that were resident at once while `run` ran.
pub fn peak_of<T>(run: impl FnOnce() -> T) -> u64 {
    // What came before may have peaked higher; the system resets the peak on request.
    std::fs::write("/proc/self/clear_refs", "5").expect("the system can reset the peak");
    std::hint::black_box(run());
    of_status("VmHWM:")
}

/// What this program prints when it runs again with that variable set.
///
/// There the C library's allocator hands every block of 64 KiB or more back to the system as soon as it is freed, so that
/// what is resident is what is held.
pub fn in_a_process_of_its_own(variable: &str, value: &Path) -> String {
    let program = std::env::current_exe().expect("a running program has a file");
    let child = Command::new(program)
        .env(variable, value)
        .env("MALLOC_MMAP_THRESHOLD_", "65536")
        .output()
        .expect("a program runs twice");
    String::from_utf8_lossy(&child.stdout).trim().to_owned()
}

fn of_status(key: &str) -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix(key)).unwrap_or_default();
    1024 * line.split_whitespace().next().and_then(|n| n.parse::<u64>().ok()).unwrap_or(0)
}
