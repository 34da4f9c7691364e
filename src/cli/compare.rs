//! `outsight compare`: how far meshes differ from a reference.

use std::path::{Path, PathBuf};

use clap::Args;
use outsight::pipeline::{CompareReport, CompareRequest, TestReport, compare_files};
use serde::Serialize;

use super::console::Console;
use super::estimate::Task;
use super::failure::Failure;
use super::flags::{LookingFlags, PageFlags, ReadingFlags};
use super::outputs::{self, Kind, Planned};
use super::presets;
use super::system::peak_mib;
use super::text::{count, table};
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
    /// Points on each mesh for the distances [default: 10 per triangle of REF]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    samples: Option<u64>,
    #[command(flatten)]
    page: PageFlags,
}

/// The library's report with what only the program knows.
#[derive(Debug, Serialize)]
struct Object<'a> {
    #[serde(flatten)]
    report: &'a CompareReport,
    reference: &'a Path,
    page: Option<&'a Path>,
    peak_mb: Option<f64>,
}

/// Compares, writes the contact sheet, prints.
pub fn run(flags: &Flags, console: &Console) -> Result<(), Failure> {
    let request = CompareRequest {
        reference: flags.reference.clone(),
        tests: flags.tests.clone(),
        read: flags.reading.options(&console.global),
        samples: flags.samples,
        seed: console.global.seed,
        sheet: flags.output.clone(),
        up: flags.page.up.up,
        page: flags.page.request(),
        measure: presets::measure_options(&LookingFlags::default(), &console.global)?,
        force: console.global.force,
    };
    let inputs: Vec<&Path> = flags.tests.iter().chain([&flags.reference]).map(PathBuf::as_path).collect();
    if let Some(path) = &flags.page.page {
        outputs::check(Planned { path, kind: Kind::Page, format: None }, &inputs, request.force)?;
    }
    if let Some(path) = &request.sheet {
        outputs::check(Planned { path, kind: Kind::Picture, format: None }, &inputs, request.force)?;
    }
    let report = compare_files(&request, &Watch::new(console, Task::Compare))?;
    let (reference, page) = (&request.reference, flags.page.page.as_deref());
    let object = Object { report: &report, reference, page, peak_mb: peak_mib() };
    console.result(&object, &text(&report, &request), true)
}

fn text(report: &CompareReport, request: &CompareRequest) -> String {
    let row = |test: &TestReport| {
        vec![
            test.file.display().to_string(),
            count(test.triangles),
            format!("{:.3}", test.image_rmse),
            format!("{:.1}", test.silhouette_xor),
            format!("{:.4}", test.geometric.mean),
            format!("{:.4}", test.geometric.rms),
            format!("{:.4}", test.geometric.max),
        ]
    };
    let rows: Vec<Vec<String>> = report.tests.iter().map(row).collect();
    let heads = ["file", "triangles", "image", "outline", "mean", "rms", "max"];
    let line = |name: &str, path: &Path| format!("{name}: {}\n", path.display());
    let sheet = request.sheet.as_ref().map(|path| line("contact sheet", path)).unwrap_or_default();
    let page = request.page.as_ref().map(|page| line("page", &page.output)).unwrap_or_default();
    format!(
        "{}image: root mean square difference in grey levels (0 to 255); outline: pixels per picture in one silhouette \
         only;\nmean, rms, max: distance between the surfaces in % of the diagonal of {}, hidden surface \
         included\n{sheet}{page}",
        table(&heads, &rows),
        request.reference.display()
    )
}
