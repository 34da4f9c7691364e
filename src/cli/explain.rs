//! `outsight explain`: why a triangle is as visible as it is.

use std::path::{Path, PathBuf};

use clap::Args;
use outsight::Error;
use outsight::pipeline::{BlockerReport, ExplainReport, ExplainRequest, SightReport, explain_file};
use outsight::raster::Side;
use serde::Serialize;

use super::console::Console;
use super::estimate::Task;
use super::failure::Failure;
use super::flags::{InputFlags, LookingFlags, OccluderFlags};
use super::presets;
use super::text::{count, table};
use super::watch::{Found, Watch};

/// Rows of each table without `--all`.
const SHORT: usize = 10;

#[derive(Debug, Args)]
pub struct Flags {
    #[command(flatten)]
    input: InputFlags,
    /// The triangle's number in the file, from 0
    #[arg(value_name = "TRIANGLE")]
    triangle: usize,
    /// Explain the back of the triangle in place of its front
    #[arg(long)]
    back: bool,
    /// List every camera and every triangle in the way
    #[arg(long)]
    all: bool,
    #[command(flatten)]
    looking: LookingFlags,
    #[command(flatten)]
    around: OccluderFlags,
}

/// The library's report with what only the program knows.
#[derive(Debug, Serialize)]
struct Object<'a> {
    #[serde(flatten)]
    report: &'a ExplainReport,
    #[serde(flatten)]
    found: Found,
    occluders: &'a [PathBuf],
}

/// Explains and prints.
pub fn run(flags: &Flags, console: &Console) -> Result<(), Failure> {
    check_looking(&flags.looking)?;
    let request = ExplainRequest {
        input: flags.input.mesh.clone(),
        read: flags.input.reading.options(&console.global),
        occluders: flags.around.occluders.clone(),
        triangle: flags.triangle,
        side: if flags.back { Side::Back } else { Side::Front },
        measure: presets::measure_options(&flags.looking, &console.global)?,
    };
    let watch = Watch::new(console, Task::Read);
    let report = explain_file(&request, &watch)?;
    let object = Object { report: &report, found: watch.found(), occluders: &request.occluders };
    console.result(&object, &text(&report, if flags.all { usize::MAX } else { SHORT }), true)
}

/// Names of the flags that [`check_looking`] refuses.
pub const REFUSED: [&str; 9] =
    ["backend", "estimator", "sides", "rescue", "points", "partly_seen", "samples", "target_error", "target_error_p99"];

/// Flags about who counts what would change nothing here.
fn check_looking(looking: &LookingFlags) -> outsight::Result<()> {
    let given = [
        ("--backend", looking.backend.is_some()),
        ("--estimator", looking.estimator.is_some()),
        ("--sides", looking.sides.is_some()),
        ("--rescue", looking.rescue.is_some()),
    ];
    let given = given.into_iter().filter(|(_, given)| *given).map(|(name, _)| name);
    let rays = looking.rays.given().map(|(name, _)| name);
    match given.chain(rays).next() {
        None => Ok(()),
        Some(name) => {
            let message = "explain casts rays of its own from one side of the triangle; leave it out".to_owned();
            Err(Error::Option { name, message })
        }
    }
}

fn text(report: &ExplainReport, rows: usize) -> String {
    let ExplainReport { triangle, side, seen, too_small, blocked, behind, .. } = report;
    let mut text = format!(
        "triangle {triangle}, {side}: visibility {:.4}, by rays from four of its points\n\
         {seen} cameras see it, {too_small} more would but for its size (below a pixel at --resolution {}), {blocked} are \
         blocked, {behind} are behind it or edge-on\n",
        report.visibility, report.resolution,
    );
    if !report.blockers.is_empty() {
        let row = |blocker: &BlockerReport| {
            vec![named(blocker.triangle, blocker.occluder.as_deref()), count(blocker.cameras)]
        };
        let shown: Vec<Vec<String>> = report.blockers.iter().take(rows).map(row).collect();
        text += &format!("\n{}", table(&["triangle in the way", "of cameras"], &shown));
        text += &more(report.blockers.len(), rows);
    }
    let in_front: Vec<&SightReport> = report.cameras.iter().filter(|c| rows > SHORT || c.sight != "behind").collect();
    let shown: Vec<Vec<String>> = in_front.iter().take(rows).map(|camera| sight_row(camera)).collect();
    text += &format!("\n{}", table(&["camera", "direction", "sight", "points seen", "pixels"], &shown));
    text + &more(in_front.len(), rows)
}

/// A triangle's number, with the file that it is of where that is an occluder.
fn named(triangle: usize, occluder: Option<&Path>) -> String {
    occluder.map_or_else(|| triangle.to_string(), |file| format!("{triangle} of {}", file.display()))
}

fn sight_row(camera: &SightReport) -> Vec<String> {
    let [x, y, z] = camera.direction;
    let sight = match (camera.sight, camera.blocked_by) {
        (_, Some(triangle)) => format!("blocked by {}", named(triangle, camera.occluder.as_deref())),
        ("too_small", _) => "too small".to_owned(),
        (sight, _) => sight.to_owned(),
    };
    vec![
        camera.camera.to_string(),
        format!("{x:.3} {y:.3} {z:.3}"),
        sight,
        format!("{:.0} %", 100.0 * camera.share),
        format!("{:.1}", camera.pixels),
    ]
}

fn more(all: usize, shown: usize) -> String {
    if all > shown { format!("… {} more, with --all\n", all - shown) } else { String::new() }
}
