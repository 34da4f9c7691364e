//! The straight path, from mesh file to result: read, look, weigh, simplify, write; then compare.
//!
//! Each run takes a request, a plain struct that says all there is to decide, and gives a report: what was reached, why
//! it stopped, and where the time went. [`run_simplify`] is the path itself; the others are its parts.

mod compare;
mod measure;
mod render;
mod simplify;

pub use compare::{CompareReport, CompareRequest, TestReport, compare_files};
pub use measure::{MeasureReport, MeasureRequest, MeasureSeconds, VisibilitySummary, measure_file};
pub use render::{RenderRequest, Style, render_file};
pub use simplify::{LevelReport, LevelRequest, Metric, SimplifyReport, SimplifyRequest, SimplifySeconds, run_simplify};

use std::path::Path;
use std::time::Instant;

use crate::error::Result;
use crate::io::{self, Loaded, ReadOptions};
use crate::progress::{CancelFlag, Progress, Silent};

/// Follows a run: its progress, and what its user should know before the long work goes on.
pub trait Observer: Progress {
    /// A mesh was read; an error ends the run.
    ///
    /// # Errors
    /// Whatever the observer decides.
    fn mesh_read(&self, _path: &Path, _loaded: &Loaded) -> Result<()> {
        Ok(())
    }

    /// `deleted` of `given` triangles are hidden and leave the mesh before it is simplified; an error ends the run.
    ///
    /// # Errors
    /// Whatever the observer decides.
    fn hidden_deleted(&self, _deleted: usize, _given: usize) -> Result<()> {
        Ok(())
    }
}

impl Observer for Silent {}
impl Observer for CancelFlag {}

/// Lets an observer be handed on where only its progress counts.
fn as_progress<'a>(observer: &'a dyn Observer) -> &'a (dyn Progress + 'a) {
    observer
}

fn read(path: &Path, options: &ReadOptions, observer: &dyn Observer) -> Result<Loaded> {
    let loaded = io::read(path, options)?;
    observer.mesh_read(path, &loaded)?;
    observer.check()?;
    Ok(loaded)
}

/// What was dropped, as JSON spells it.
fn dropped_names(loaded: &Loaded) -> Vec<&'static str> {
    loaded.dropped.iter().map(|d| d.name()).collect()
}

/// Measures the steps of a run, one after the other.
struct Stopwatch {
    start: Instant,
    lap: Instant,
}

impl Stopwatch {
    fn start() -> Self {
        let now = Instant::now();
        Self { start: now, lap: now }
    }

    /// Seconds since the last call, or since the start.
    fn lap_s(&mut self) -> f64 {
        let before = std::mem::replace(&mut self.lap, Instant::now());
        (self.lap - before).as_secs_f64()
    }

    /// Seconds since the start.
    fn total_s(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }
}
