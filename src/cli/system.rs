//! What the machine says about itself and about this process.

/// Most memory this process held so far, in MiB; `None` where the system does not tell (not Linux).
pub fn peak_mib() -> Option<f64> {
    kib_field("/proc/self/status", "VmHWM:").map(|kib| kib as f64 / 1024.0)
}

/// Memory of the machine in bytes: all, and what is free to use.
pub fn memory_bytes() -> Option<(u64, u64)> {
    let field = |name| kib_field("/proc/meminfo", name).map(|kib| 1024 * kib);
    Some((field("MemTotal:")?, field("MemAvailable:")?))
}

/// What the processor is called; `None` where the system does not tell.
pub fn processor() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("model name"))?;
    Some(line.trim_start_matches([' ', '\t', ':']).trim_end().to_owned())
}

/// The number behind `name` in a file of `name: number kB` lines.
fn kib_field(file: &str, name: &str) -> Option<u64> {
    let text = std::fs::read_to_string(file).ok()?;
    text.lines().find_map(|line| line.strip_prefix(name))?.split_whitespace().next()?.parse().ok()
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    #[test]
    fn linux_tells_the_peak_and_the_memory() {
        assert!(super::peak_mib().is_some_and(|mib| mib > 0.5));
        assert!(super::memory_bytes().is_some_and(|(all, free)| all >= free && free > 0));
    }
}
