//! `outsight convert`: a mesh in another format.

use std::path::{Path, PathBuf};

use clap::Args;
use outsight::Error;
use outsight::io::{self, Attributes, WriteOptions};
use outsight::pipeline::Observer;
use serde::Serialize;

use super::console::Console;
use super::estimate::Task;
use super::failure::Failure;
use super::flags::{InputFlags, OutputFormatName};
use super::outputs::{self, Kind, Planned, is_pipe};
use super::text::count;
use super::watch::{Found, Watch};

#[derive(Debug, Args)]
pub struct Flags {
    #[command(flatten)]
    input: InputFlags,
    /// Result: .ply, .obj, .stl, .off or .glb, also with .zst or .gz; - is standard output
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// Format of OUT, where its name does not say it
    #[arg(long, value_name = "FORMAT")]
    output_format: Option<OutputFormatName>,
}

#[derive(Debug, Serialize)]
struct Report<'a> {
    output: &'a Path,
    triangles: usize,
    vertices: usize,
    welded: Option<usize>,
    #[serde(flatten)]
    found: Found,
}

/// Reads, writes, prints.
pub fn run(flags: &Flags, console: &Console) -> Result<(), Failure> {
    let (input, output) = (&flags.input.mesh, flags.output.as_path());
    let write = WriteOptions { force: console.global.force, format: flags.output_format.map(Into::into) };
    if is_pipe(output) && console.global.json {
        let message = "standard output cannot hold both a mesh and --json; name a file".to_owned();
        return Err(Error::Option { name: "OUT", message }.into());
    }
    outputs::check(Planned { path: output, kind: Kind::Mesh, format: write.format }, &[input], write.force)?;
    let loaded = io::read(input, &flags.input.reading.options(&console.global))?;
    Watch::new(console, Task::Read).writing_mesh(true).mesh_read(input, &loaded)?;
    io::write(output, &loaded.mesh, &Attributes::default(), &write)?;
    let report = Report {
        output,
        triangles: loaded.mesh.triangle_count(),
        vertices: loaded.mesh.vertex_count(),
        welded: loaded.welded,
        found: Found::new(input, &loaded),
    };
    console.result(&report, &text(&report), !is_pipe(output))
}

fn text(report: &Report<'_>) -> String {
    let welded = report.welded.map(|n| format!(", {} vertices welded", count(n))).unwrap_or_default();
    format!(
        "{}  {} triangles, {} vertices{welded}\n",
        report.output.display(),
        count(report.triangles),
        count(report.vertices)
    )
}
