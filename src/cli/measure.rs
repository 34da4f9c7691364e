//! `outsight measure`: the visibility of every triangle.

use std::path::PathBuf;

use clap::Args;
use outsight::pipeline::{MeasureReport, MeasureRequest, measure_file};
use serde::Serialize;
use serde_json::Value;

use super::console::Console;
use super::estimate::Task;
use super::failure::Failure;
use super::flags::{ColourMapName, InputFlags, LookingFlags};
use super::in_force;
use super::outputs::{self, Kind, Planned, ending_of};
use super::presets;
use super::system::peak_mib;
use super::text::{count, duration, pairs};
use super::watch::{Found, Watch};

#[derive(Debug, Args)]
pub struct Flags {
    #[command(flatten)]
    input: InputFlags,
    /// Visibility of each triangle: .ply with heat colours, .npy or .csv
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Heat colours of a .ply: as in the paper, or readable for every eye
    #[arg(long, value_name = "NAME", default_value = "paper")]
    colour_map: ColourMapName,
    #[command(flatten)]
    looking: LookingFlags,
}

/// The library's report with what only the program knows.
#[derive(Debug, Serialize)]
struct Object<'a> {
    #[serde(flatten)]
    report: &'a MeasureReport,
    peak_mb: Option<f64>,
    #[serde(flatten)]
    found: Found,
    output: &'a Option<PathBuf>,
    options: Value,
}

/// Measures, writes, prints.
pub fn run(flags: &Flags, console: &Console) -> Result<(), Failure> {
    let request = request(flags, console)?;
    if let Some(path) = &request.output {
        let planned = Planned { path, kind: Kind::Visibility, format: None };
        outputs::check(planned, &[&request.input], request.force)?;
    }
    let task = Task::Measure { resolution: request.measure.resolution.unwrap_or(0) };
    let writes_mesh = request.output.as_deref().is_some_and(|p| !["npy", "csv"].contains(&ending_of(p).as_str()));
    let watch = Watch::new(console, task).writing_mesh(writes_mesh);
    let report = measure_file(&request, &watch)?;
    let object = Object {
        report: &report,
        peak_mb: peak_mib(),
        found: watch.found(),
        output: &request.output,
        options: in_force::measure(&request.measure),
    };
    console.result(&object, &text(&report, &request), true)
}

fn request(flags: &Flags, console: &Console) -> outsight::Result<MeasureRequest> {
    Ok(MeasureRequest {
        input: flags.input.mesh.clone(),
        read: flags.input.reading.options(&console.global),
        measure: presets::measure_options(&flags.looking, &console.global)?,
        output: flags.output.clone(),
        colour_map: flags.colour_map.into(),
        force: console.global.force,
    })
}

fn text(report: &MeasureReport, request: &MeasureRequest) -> String {
    let seen = &report.visibility;
    let never = 100.0 * seen.never_seen as f64 / report.triangles as f64;
    let mut rows = vec![
        ("visibility of the mesh", format!("{:.4}  (1: all of it sees open sky; fronts of triangles only)", seen.mesh)),
        ("triangles", count(report.triangles)),
        ("never seen", format!("{} ({never:.1} %)", count(seen.never_seen))),
        (
            "looked with",
            format!(
                "{}, {}, {} cameras, {} pixels square",
                report.backend, report.estimator, report.cameras, report.resolution
            ),
        ),
        ("time", format!("{} ({} looking)", duration(report.seconds.total), duration(report.seconds.visibility))),
    ];
    if let (Some(rescue), Some(pieces)) = (report.rescue, report.subdivided) {
        let rescued = format!("{:.1} % of what is seen has no pixel of its own", 100.0 * rescue.rate);
        rows.insert(4, ("cut into", format!("{} pieces; {rescued}", count(pieces))));
    }
    if seen.mesh_sides != seen.mesh {
        rows.insert(1, ("with backs", format!("{:.4}  (--sides {})", seen.mesh_sides, report.sides)));
    }
    if let Some(output) = &request.output {
        rows.push(("written", output.display().to_string()));
    }
    pairs(&rows)
}
