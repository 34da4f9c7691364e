//! What a command does when a mesh has been read or hidden triangles were found: warn, and check the memory.

use std::path::Path;

use outsight::error::{Error, Result};
use outsight::io::{Dropped, Loaded};
use outsight::pipeline::Observer;
use outsight::progress::Progress;

use super::console::Console;
use super::estimate::{Task, memory_bytes};
use super::text::{count, megabytes};

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
}

impl<'a> Watch<'a> {
    /// Watches a run that does `task`.
    pub fn new(console: &'a Console, task: Task) -> Self {
        Self { console, task, writes_mesh: false, deletes_knowingly: false }
    }

    /// The run writes a mesh, or not.
    pub fn writing_mesh(self, writes_mesh: bool) -> Self {
        Self { writes_mesh, ..self }
    }

    /// The user asked for hidden triangles to be deleted, or it is the default.
    pub fn deleting_knowingly(self, deletes_knowingly: bool) -> Self {
        Self { deletes_knowingly, ..self }
    }
}

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
        if self.writes_mesh && !loaded.dropped.is_empty() {
            self.console.warn(path, &format!("not carried over: {}", dropped_names(&loaded.dropped).join(", ")))?;
        }
        if let Some(message) = set_aside_message(loaded) {
            self.console.warn(path, &message)?;
        }
        check_memory(self.console.global.memory_limit, self.task, triangles)
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
        megabytes(limit),
        count(triangles),
        megabytes(needed)
    );
    Err(Error::Limit { message })
}

/// The names of what was dropped, as messages and JSON spell them.
pub fn dropped_names(dropped: &[Dropped]) -> Vec<&'static str> {
    dropped.iter().map(|d| d.name()).collect()
}
