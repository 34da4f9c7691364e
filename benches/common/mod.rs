//! What the benches share: reading models, timing by processor time, medians, memory.

#![allow(dead_code)]

pub mod memory;

use std::path::{Path, PathBuf};

use cpu_time::ProcessTime;
use outsight::io::{ReadOptions, read};
use outsight::mesh::TriMesh;

/// The mesh files named on the command line, or the bundled gearbox. Flags, which `cargo bench` adds, are skipped.
pub fn models() -> Vec<PathBuf> {
    let named: Vec<PathBuf> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).map(PathBuf::from).collect();
    if named.is_empty() {
        vec![PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/data/gearbox.ply.zst"))]
    } else {
        named
    }
}

pub fn load(path: &Path) -> TriMesh {
    match read(path, &ReadOptions::default()) {
        Ok(loaded) => loaded.mesh,
        Err(error) => {
            eprintln!("{error}");
            std::process::exit(3);
        }
    }
}

/// The file's name without folder and extensions.
pub fn name(path: &Path) -> String {
    let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    file.split('.').next().unwrap_or_default().to_owned()
}

/// Processor seconds of a run, divided by the threads that share the work.
pub fn seconds<T>(threads: usize, run: impl FnOnce() -> T) -> f64 {
    let start = ProcessTime::now();
    std::hint::black_box(run());
    start.elapsed().as_secs_f64() / threads as f64
}

/// The median of [`seconds`] of five runs.
pub fn median_seconds<T>(threads: usize, mut run: impl FnMut() -> T) -> f64 {
    let mut five: Vec<f64> = (0..5).map(|_| seconds(threads, &mut run)).collect();
    five.sort_by(f64::total_cmp);
    five[2]
}

/// The least [`seconds`] of five runs: what is left when others leave the machine alone.
pub fn least_seconds<T>(threads: usize, mut run: impl FnMut() -> T) -> f64 {
    (0..5).map(|_| seconds(threads, &mut run)).fold(f64::INFINITY, f64::min)
}

/// The seven levels at which image errors are compared: shares of the triangles.
pub const LEVELS: [f64; 7] = [0.2, 0.1, 0.05, 0.03, 0.02, 0.01, 0.005];

/// Runs on a pool of so many threads.
pub fn on_threads<T: Send>(threads: usize, run: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool of a few threads").install(run)
}
