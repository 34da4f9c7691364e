//! What a command does when a mesh has been read or hidden triangles were found: warn, and check the memory.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use outsight::error::{Error, Result};
use outsight::io::Loaded;
use outsight::pipeline::Observer;
use outsight::progress::Progress;
use outsight::visibility::{KeptFault, MeasureOptions, RayOptions, SamplingEnd, Visibility};
use serde::Serialize;

use super::console::Console;
use super::estimate::{Task, memory_bytes, seconds};
use super::system;
use super::text::{count, duration, memory, significant};

/// Watches one run of the library for a command.
#[derive(Debug)]
pub struct Watch<'a> {
    console: &'a Console,
    /// What the run will do, which says how much memory it needs.
    task: Task,
    /// Triangles leave as a mesh, so that what is dropped is lost.
    writes_mesh: bool,
    /// `--hidden delete` was spelled out, so that deleting needs no warning.
    deletes_knowingly: bool,
    found: Mutex<Found>,
}

/// What the file held that the result does not: part of every JSON object about one mesh.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Found {
    /// The mesh file.
    file: PathBuf,
    /// Triangles of the file that were set aside.
    set_aside: usize,
    /// What the file held beyond triangles.
    dropped: Vec<&'static str>,
}

impl Found {
    /// What `path` held.
    pub fn new(path: &Path, loaded: &Loaded) -> Self {
        let dropped = loaded.dropped.iter().map(|d| d.name()).collect();
        Self { file: path.to_owned(), set_aside: loaded.set_aside.count(), dropped }
    }

    /// The names of what was dropped, for a message; `None` if nothing was.
    pub fn dropped_list(&self) -> Option<String> {
        (!self.dropped.is_empty()).then(|| self.dropped.join(", "))
    }
}

impl<'a> Watch<'a> {
    /// Watches a run that does `task`.
    pub fn new(console: &'a Console, task: Task) -> Self {
        Self { console, task, writes_mesh: false, deletes_knowingly: false, found: Mutex::default() }
    }

    /// The run writes a mesh, or not.
    pub fn writing_mesh(self, writes_mesh: bool) -> Self {
        Self { writes_mesh, ..self }
    }

    /// The user spelled out that hidden triangles are to be deleted, or knows it from what the command says.
    pub fn deleting_knowingly(self, deletes_knowingly: bool) -> Self {
        Self { deletes_knowingly, ..self }
    }

    /// What the file read last held.
    pub fn found(&self) -> Found {
        self.found.lock().map(|found| found.clone()).unwrap_or_default()
    }
}

impl Watch<'_> {
    /// Says before the work starts what it will cost, where that is much.
    fn tell_cost(&self, triangles: usize) {
        let needed = memory_bytes(self.task, triangles);
        if let Some((_, free)) = system::memory_bytes().filter(|&(_, free)| needed > free) {
            let (needed, free) = (memory(needed), memory(free));
            self.console.announce(&format!(
                "about {needed} of memory are needed, and {free} are free; try a smaller --resolution or fewer --threads"
            ));
        }
        if let Some(seconds) = seconds(self.task, triangles).filter(|&seconds| seconds > LONG_S) {
            self.console.note(&format!(
                "this takes about {}; fewer --cameras or a smaller --resolution take less",
                duration(seconds)
            ));
        }
    }
}

/// Nobody wonders whether a shorter run has stopped.
const LONG_S: f64 = 120.0;

impl Progress for Watch<'_> {
    fn report(&self, phase: &'static str, done: u64, total: u64) {
        self.console.report(phase, done, total);
    }

    fn is_cancelled(&self) -> bool {
        self.console.is_cancelled()
    }
}

impl Observer for Watch<'_> {
    fn mesh_read(&self, path: &Path, loaded: &Loaded) -> Result<()> {
        let triangles = loaded.mesh.triangle_count();
        self.console.detail(&format!("{}: {} triangles", path.display(), count(triangles)));
        let found = Found::new(path, loaded);
        if let Some(list) = found.dropped_list().filter(|_| self.writes_mesh) {
            self.console.warn(path, &format!("not carried over: {list}"))?;
        }
        if let Ok(mut last) = self.found.lock() {
            *last = found;
        }
        if let Some(message) = set_aside_message(loaded) {
            self.console.warn(path, &message)?;
        }
        check_memory(self.console.global.memory_limit, self.task, triangles)?;
        self.tell_cost(triangles);
        Ok(())
    }

    fn kept_look_unusable(&self, file: &Path, fault: KeptFault) -> Result<()> {
        self.console.warn(file, &format!("{fault}; the mesh is looked at again"))
    }

    fn measured(&self, options: &MeasureOptions, seen: &Visibility) -> Result<()> {
        let Some(message) = missed_errors(&options.rays, seen) else { return Ok(()) };
        if self.console.global.strict {
            return Err(Error::Limit { message: format!("{message} (--strict makes this an error)") });
        }
        self.console.announce(&message);
        Ok(())
    }

    fn cell(&self, model: &str, cell: &str, found: bool) {
        let found = if found { ", found" } else { "" };
        self.console.note(&format!("{model}: {cell}{found}"));
    }

    fn hidden_deleted(&self, deleted: usize, given: usize) -> Result<()> {
        let share = 100.0 * deleted as f64 / given.max(1) as f64;
        let found =
            format!("{} of {} triangles ({share:.1} %) are hidden and were deleted", count(deleted), count(given));
        if self.deletes_knowingly || deleted == 0 {
            self.console.detail(&found);
            return Ok(());
        }
        if self.console.global.strict {
            let message =
                format!("{found}; --strict wants this said: add --hidden delete, or keep them with --hidden keep");
            return Err(Error::Option { name: "--hidden", message });
        }
        self.console.announce(&format!("{found}; --hidden keep keeps them"));
        Ok(())
    }
}

/// Standard errors that were asked for and are out of reach.
fn missed_errors(asked: &RayOptions, seen: &Visibility) -> Option<String> {
    let got = seen.details().standard_error.as_ref().filter(|error| error.end == SamplingEnd::MostSamples)?;
    let of_mesh = ("--target-error", asked.target_error, got.of_mesh);
    let of_triangles = ("--target-error-p99", asked.target_error_p99, got.p99);
    let missed = |(name, target, got): (&str, Option<f64>, f64)| {
        let target = target.filter(|&target| got > target)?;
        Some(format!("{name} {} is not reached, {} is", significant(target), significant(got)))
    };
    let missed: Vec<String> = [of_mesh, of_triangles].into_iter().filter_map(missed).collect();
    Some(format!("{}: {} rays are the most a triangle casts", missed.join("; "), count(got.samples as usize)))
}

fn set_aside_message(loaded: &Loaded) -> Option<String> {
    let aside = &loaded.set_aside;
    let parts = [(aside.zero_area.len(), "with zero area"), (aside.repeated_vertex.len(), "that repeat a vertex")];
    let named: Vec<String> =
        parts.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{} {what}", count(*n))).collect();
    (!named.is_empty()).then(|| format!("set aside triangles: {}", named.join(", ")))
}

fn check_memory(limit: Option<u64>, task: Task, triangles: usize) -> Result<()> {
    let Some(limit) = limit else { return Ok(()) };
    let needed = memory_bytes(task, triangles);
    if needed <= limit {
        return Ok(());
    }
    let message = format!(
        "--memory-limit {}: {} triangles need about {}; raise the limit or use a smaller mesh",
        memory(limit),
        count(triangles),
        memory(needed)
    );
    Err(Error::Limit { message })
}
