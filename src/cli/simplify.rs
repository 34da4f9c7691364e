//! `outsight simplify`: fewer triangles, taken first where nobody looks.

use std::path::{Path, PathBuf};

use clap::{ArgGroup, Args};
use outsight::Error;
use outsight::pipeline::{LevelReport, LevelRequest, Metric, SimplifyReport, SimplifyRequest, run_simplify};
use outsight::simplify::{SimplifyOptions, Target};
use serde::Serialize;
use serde_json::Value;

use super::cache::{CacheFlags, reused};
use super::collapsing::CollapseFlags;
use super::console::Console;
use super::estimate::{Task, cameras_drawing};
use super::failure::Failure;
use super::flags::{InputFlags, LookingFlags, OccluderFlags, OutputFormatName, PageFlags};
use super::in_force;
use super::outputs::{self, Kind, Planned, is_pipe};
use super::presets;
use super::system::peak_mib;
use super::text::{count, duration, significant, table};
use super::values::{self, LevelSize};
use super::watch::{Found, Watch};

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("size").required(true).multiple(true))]
pub struct Flags {
    #[command(flatten)]
    input: InputFlags,
    /// Result: .ply, .obj, .stl, .off or .glb, also with .zst or .gz; - is standard output
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Format of the output, where its name does not say it
    #[arg(long, value_name = "FORMAT")]
    output_format: Option<OutputFormatName>,
    /// Stop at this many triangles
    #[arg(short, long, value_name = "N", value_parser = values::triangles, allow_negative_numbers = true, group = "size")]
    triangles: Option<usize>,
    /// Stop at this share of the triangles, in (0, 1]
    #[arg(short, long, value_name = "RATIO", value_parser = values::ratio, allow_negative_numbers = true, group = "size")]
    ratio: Option<f64>,
    /// Stop before this root mean square distance from what is visible, in model units
    #[arg(short = 'e', long, value_name = "ERROR", value_parser = values::length, allow_negative_numbers = true, group = "size")]
    max_error: Option<f64>,
    /// Several results in one run, from large to small, as in 0.5,0.25,5000
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = values::level_size, group = "size")]
    #[arg(conflicts_with_all = ["triangles", "ratio"])]
    lods: Vec<LevelSize>,
    #[command(flatten)]
    page: PageFlags,
    #[command(flatten)]
    collapse: CollapseFlags,
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
    report: &'a SimplifyReport,
    peak_mb: Option<f64>,
    #[serde(flatten)]
    found: Found,
    occluders: &'a [PathBuf],
    page: Option<&'a PathBuf>,
    options: Value,
}

/// Reads, looks, simplifies, writes, prints.
pub fn run(flags: &Flags, console: &Console) -> Result<(), Failure> {
    let request = request(flags, console)?;
    check_outputs(&request, console.global.json)?;
    let looks = request.metric == Metric::Visibility;
    let cameras = if looks { cameras_drawing(&request.measure)? } else { 0 };
    let task = Task::Simplify { resolution: request.measure.resolution.unwrap_or(0), cameras };
    let watch = Watch::new(console, task).writing_mesh(true).deleting_knowingly(flags.collapse.hidden.is_some());
    let report = run_simplify(&request, &watch)?;
    report.levels.iter().filter_map(|level| falls_short(level, &report)).for_each(|message| console.announce(&message));
    let object = Object {
        report: &report,
        peak_mb: peak_mib(),
        found: watch.found(),
        occluders: &request.occluders,
        page: request.page.as_ref().map(|page| &page.output),
        options: in_force::simplify(&request),
    };
    let to_stdout = !request.levels.iter().any(|level| is_pipe(&level.output));
    console.result(&object, &text(&report), to_stdout)
}

fn request(flags: &Flags, console: &Console) -> outsight::Result<SimplifyRequest> {
    let preset = flags.looking.preset;
    let metric = presets::metric(&flags.collapse)?;
    let hidden = presets::hidden(&flags.collapse, preset, metric)?;
    Ok(SimplifyRequest {
        input: flags.input.mesh.clone(),
        read: flags.input.reading.options(&console.global),
        metric,
        measure: presets::simplify_measure_options(&flags.looking, &console.global, hidden)?,
        occluders: flags.around.occluders.clone(),
        hidden,
        visibility_power: presets::visibility_power(&flags.collapse),
        simplify: SimplifyOptions { max_error: flags.max_error, ..presets::simplify_options(&flags.collapse, preset)? },
        levels: levels(flags)?,
        format: flags.output_format.map(Into::into),
        cache: flags.cache.place()?,
        page: flags.page.request(&console.command_line),
        force: console.global.force,
    })
}

fn levels(flags: &Flags) -> outsight::Result<Vec<LevelRequest>> {
    if flags.lods.is_empty() {
        let count = flags.triangles.map(Target::Triangles);
        let targets = count.into_iter().chain(flags.ratio.map(Target::Ratio)).collect();
        return Ok(vec![LevelRequest { targets, output: flags.output.clone() }]);
    }
    if is_pipe(&flags.output) {
        let message = "standard output holds one mesh, --lods makes several; name a file".to_owned();
        return Err(Error::Option { name: "--output", message });
    }
    let level = |(number, size): (usize, &LevelSize)| {
        let target = match *size {
            LevelSize::Ratio(ratio) => Target::Ratio(ratio),
            LevelSize::Triangles(count) => Target::Triangles(count),
        };
        LevelRequest { targets: vec![target], output: outputs::level_path(&flags.output, number) }
    };
    Ok(flags.lods.iter().enumerate().map(level).collect())
}

fn check_outputs(request: &SimplifyRequest, json: bool) -> outsight::Result<()> {
    let inputs: Vec<&Path> = request.occluders.iter().chain([&request.input]).map(PathBuf::as_path).collect();
    for level in &request.levels {
        let path: &Path = &level.output;
        if is_pipe(path) && json {
            let message = "standard output cannot hold both a mesh and --json; name a file".to_owned();
            return Err(Error::Option { name: "--output", message });
        }
        outputs::check(Planned { path, kind: Kind::Mesh, format: request.format }, &inputs, request.force)?;
    }
    if let Some(page) = &request.page {
        outputs::check(Planned { path: &page.output, kind: Kind::Page, format: None }, &inputs, request.force)?;
    }
    Ok(())
}

fn text(report: &SimplifyReport) -> String {
    let row = |level: &LevelReport| {
        vec![
            level.file.display().to_string(),
            count(level.output),
            format!("{:.2} %", 100.0 * level.output as f64 / report.triangles as f64),
            significant(level.error),
            stop_in_words(level, report).to_owned(),
        ]
    };
    let rows: Vec<Vec<String>> = report.levels.iter().map(row).collect();
    let seconds = &report.seconds;
    format!(
        "{}error: largest distance of a collapse from {}, root mean square, in the units of the mesh\n\
         {} triangles in, metric {}, {} ({} looking, {} making sure of what is hidden{}, {} simplifying)\n",
        table(&["file", "triangles", "kept", "error", "stopped by"], &rows),
        if report.metric == "quadric" { "its surface" } else { "surface that can be seen, however little of it" },
        count(report.triangles),
        report.metric,
        duration(seconds.total),
        duration(seconds.visibility),
        duration(seconds.hidden),
        reused(report.cache),
        duration(seconds.simplify),
    )
}

/// What a user should know of a level that is not as large as was asked for.
fn falls_short(level: &LevelReport, report: &SimplifyReport) -> Option<String> {
    let (file, reached, target) = (level.file.display(), count(level.output), level.target?);
    let wanted = count(target);
    match level.stop {
        "queue_empty" => Some(format!("{file}: {reached} triangles instead of {wanted}: nothing more may collapse")),
        "target" if nothing_to_do(level, report) => {
            Some(format!("{file}: {reached} triangles were there to begin with, not {wanted}: nothing was collapsed"))
        }
        _ => None,
    }
}

/// Whether there were fewer triangles than asked for before the first collapse, hidden ones apart.
fn nothing_to_do(level: &LevelReport, report: &SimplifyReport) -> bool {
    level.target.is_some_and(|target| report.triangles - report.hidden_deleted < target)
}

/// What a `stop` of the report means to its reader.
fn stop_in_words(level: &LevelReport, report: &SimplifyReport) -> &'static str {
    match level.stop {
        "target" if nothing_to_do(level, report) => "fewer than that to begin with",
        "target" => "target reached",
        "error" => "error bound",
        "queue_empty" => "no collapse left",
        other => other,
    }
}
