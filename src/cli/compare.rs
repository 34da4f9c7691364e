//! `outsight compare`: how far meshes differ from a reference.

use std::path::{Path, PathBuf};

use clap::Args;
use outsight::eval::geometric::MAX_SAMPLES;
use outsight::pipeline::{CompareReport, CompareRequest, compare_files};
use serde::Serialize;
use serde_json::Value;

use super::cache::CacheFlags;
use super::console::Console;
use super::estimate::Task;
use super::failure::Failure;
use super::flags::{LookingFlags, OccluderFlags, PageFlags, ReadingFlags};
use super::in_force;
use super::outputs::{self, Kind, Planned};
use super::presets;
use super::system::peak_mib;
use super::text::{significant, table};
use super::watch::Watch;

#[derive(Debug, Args)]
pub struct Flags {
    /// Mesh that the others are compared with
    #[arg(value_name = "REF")]
    reference: PathBuf,
    /// Meshes to compare
    #[arg(value_name = "TEST", required = true)]
    tests: Vec<PathBuf>,
    #[command(flatten)]
    reading: ReadingFlags,
    /// Write a PNG contact sheet: reference, test, difference in red
    #[arg(short, long, value_name = "PNG")]
    output: Option<PathBuf>,
    /// Points on each mesh whose distance is taken [default: 10 per triangle of REF, at least 100000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MAX_SAMPLES))]
    surface_samples: Option<u64>,
    #[command(flatten)]
    page: PageFlags,
    #[command(flatten)]
    looking: LookingFlags,
    #[command(flatten)]
    around: OccluderFlags,
    #[command(flatten)]
    cache: CacheFlags,
}

/// The library's report with what only the program knows.
#[derive(Debug, Serialize)]
struct Object<'a> {
    #[serde(flatten)]
    report: &'a CompareReport,
    reference: &'a Path,
    occluders: &'a [PathBuf],
    page: Option<&'a Path>,
    peak_mb: Option<f64>,
    options: Value,
}

/// Compares, writes the contact sheet, prints.
pub fn run(flags: &Flags, console: &Console) -> Result<(), Failure> {
    let measure = presets::measure_options(&flags.looking, &console.global)?;
    let options = in_force::compare(flags.surface_samples, &measure);
    let request = CompareRequest {
        reference: flags.reference.clone(),
        tests: flags.tests.clone(),
        read: flags.reading.options(&console.global),
        samples: flags.surface_samples,
        seed: console.global.seed,
        measure,
        occluders: flags.around.occluders.clone(),
        cache: flags.cache.place()?,
        sheet: flags.output.clone(),
        up: flags.page.up.up,
        page: flags.page.request(&console.command_line),
        force: console.global.force,
    };
    let others = flags.tests.iter().chain(&request.occluders);
    let inputs: Vec<&Path> = others.chain([&flags.reference]).map(PathBuf::as_path).collect();
    if let Some(path) = &flags.page.page {
        outputs::check(Planned { path, kind: Kind::Page, format: None }, &inputs, request.force)?;
    }
    if let Some(path) = &request.sheet {
        outputs::check(Planned { path, kind: Kind::Picture, format: None }, &inputs, request.force)?;
    }
    let task = Task::Compare { resolution: flags.looking.resolution.unwrap_or(0) };
    let report = compare_files(&request, &Watch::new(console, task))?;
    let object = Object {
        report: &report,
        reference: &request.reference,
        occluders: &request.occluders,
        page: flags.page.page.as_deref(),
        peak_mb: peak_mib(),
        options,
    };
    console.result(&object, &text(&report, &request), true)
}

fn text(report: &CompareReport, request: &CompareRequest) -> String {
    let line = |name: &str, path: &Path| format!("{name}: {}\n", path.display());
    let sheet = request.sheet.as_ref().map(|path| line("contact sheet", path)).unwrap_or_default();
    let page = request.page.as_ref().map(|page| line("page", &page.output)).unwrap_or_default();
    let names: Vec<String> = report.tests.iter().map(|test| test.file.display().to_string()).collect();
    let [pictures, distances, triangles] =
        report.tables(&names).map(|t| table(&t.heads.iter().map(String::as_str).collect::<Vec<_>>(), &t.rows));
    format!(
        "{pictures}image error, root mean square in grey levels (0 to 255): head light on flat triangles, fixed light, \
         smooth\nshading; SSIM: 1 is alike; outline: pixels per picture in one silhouette only; depth: % of the \
         diagonal\n\n\
         {distances}distance in % of the diagonal ({}) of {}: mean, RMS, max of the worse direction;\nRMS from each mesh to the \
         other, and from visible, from hidden and from all surface of REF, weighted by visibility\n\n\
         {triangles}flipped: against the surface of REF nearest to them, and their share of the area; edges: with three or \
         more\ntriangles, and how many more than REF has\n{sheet}{page}",
        significant(report.diagonal),
        request.reference.display(),
    )
}
