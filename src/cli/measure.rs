//! `outsight measure`: the visibility of every triangle.

use std::path::{Path, PathBuf};

use clap::Args;
use outsight::Error;
use outsight::pipeline::{DiagramRequest, ErrorSummary, MeasureReport, MeasureRequest, RescueSummary, measure_file};
use outsight::report::table::thousands;
use serde::Serialize;
use serde_json::Value;

use super::cache::{CacheFlags, reused};
use super::console::Console;
use super::estimate::{Task, cameras_drawing};
use super::failure::Failure;
use super::flags::{ColourMapName, InputFlags, LookingFlags, OccluderFlags, PageFlags};
use super::in_force;
use super::outputs::{self, Kind, Planned, ending_of};
use super::presets;
use super::system::peak_mib;
use super::text::{count, duration, pairs, significant};
use super::watch::{Found, Watch};

#[derive(Debug, Args)]
pub struct Flags {
    #[command(flatten)]
    input: InputFlags,
    /// Visibility of each triangle: .ply or .glb with heat colours, .npy or .csv
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Which camera sees which triangle: .vdg, .npy, or a picture, .png
    #[arg(long, value_name = "FILE")]
    diagram: Option<PathBuf>,
    /// The visible share of each triangle in the diagram too, in steps of 1/255
    #[arg(long, requires = "diagram")]
    diagram_fractions: bool,
    /// Heat colours of a .ply or .glb: as in the paper, or readable for every eye
    #[arg(long, value_name = "NAME", default_value = "paper")]
    colour_map: ColourMapName,
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
    report: &'a MeasureReport,
    peak_mb: Option<f64>,
    #[serde(flatten)]
    found: Found,
    output: &'a Option<PathBuf>,
    occluders: &'a [PathBuf],
    diagram: Option<&'a PathBuf>,
    page: Option<&'a PathBuf>,
    options: Value,
}

/// Measures, writes, prints.
pub fn run(flags: &Flags, console: &Console) -> Result<(), Failure> {
    let request = request(flags, console)?;
    check_outputs(&request)?;
    let writes_mesh = request.output.as_deref().is_some_and(|p| !["npy", "csv"].contains(&ending_of(p).as_str()));
    let watch = Watch::new(console, task(&request)?).writing_mesh(writes_mesh);
    let report = measure_file(&request, &watch)?;
    let object = Object {
        report: &report,
        peak_mb: peak_mib(),
        found: watch.found(),
        output: &request.output,
        occluders: &request.occluders,
        diagram: request.diagram.as_ref().map(|diagram| &diagram.output),
        page: request.page.as_ref().map(|page| &page.output),
        options: in_force::measure(&request.measure),
    };
    console.result(&object, &text(&report, &request), true)
}

fn request(flags: &Flags, console: &Console) -> outsight::Result<MeasureRequest> {
    Ok(MeasureRequest {
        input: flags.input.mesh.clone(),
        read: flags.input.reading.options(&console.global),
        measure: presets::measure_options(&flags.looking, &console.global)?,
        occluders: flags.around.occluders.clone(),
        output: flags.output.clone(),
        diagram: flags.diagram.clone().map(|output| DiagramRequest { output, fractions: flags.diagram_fractions }),
        colour_map: flags.colour_map.into(),
        cache: flags.cache.place()?,
        page: flags.page.request(&console.command_line),
        force: console.global.force,
    })
}

fn check_outputs(request: &MeasureRequest) -> outsight::Result<()> {
    let diagram = request.diagram.as_ref().map(|diagram| &diagram.output);
    let inputs: Vec<&Path> = request.occluders.iter().chain([&request.input]).map(PathBuf::as_path).collect();
    if let Some(path) = &request.output {
        let planned = Planned { path, kind: Kind::Visibility, format: None };
        outputs::check(planned, &inputs, request.force)?;
    }
    if let Some(path) = diagram {
        let planned = Planned { path, kind: Kind::Diagram, format: None };
        outputs::check(planned, &inputs, request.force)?;
    }
    if let Some(page) = &request.page {
        let planned = Planned { path: &page.output, kind: Kind::Page, format: None };
        outputs::check(planned, &inputs, request.force)?;
    }
    if diagram.is_some() && diagram == request.output.as_ref() {
        let message = "the same file as --output; choose another name".to_owned();
        return Err(Error::Option { name: "--diagram", message });
    }
    Ok(())
}

fn task(request: &MeasureRequest) -> outsight::Result<Task> {
    let resolution = request.measure.resolution.unwrap_or(0);
    let Some(diagram) = &request.diagram else {
        return Ok(Task::Measure { resolution, cameras: cameras_drawing(&request.measure)? });
    };
    let cameras = request.measure.camera_sphere()?.count();
    Ok(Task::Diagram { resolution, cameras, fractions: diagram.fractions })
}

fn text(report: &MeasureReport, request: &MeasureRequest) -> String {
    let seen = &report.visibility;
    let never = 100.0 * seen.never_seen as f64 / report.triangles as f64;
    let mut rows = vec![
        ("visibility of the mesh", format!("{:.4}  (1: all of it sees open sky; fronts of triangles only)", seen.mesh)),
        ("triangles", count(report.triangles)),
        ("never seen", format!("{} ({never:.1} %)", count(seen.never_seen))),
        ("looked with", looked_with(report)),
        (
            "time",
            format!(
                "{} ({} looking{})",
                duration(report.seconds.total),
                duration(report.seconds.visibility),
                reused(report.cache)
            ),
        ),
    ];
    if let (Some(rescue), Some(pieces)) = (report.rescue, report.subdivided) {
        let rescued = format!("{:.1} % of what is seen has no pixel of its own", 100.0 * rescue.rate);
        rows.insert(4, ("cut into", format!("{} pieces; {rescued}", count(pieces))));
        rows.insert(5, ("rescue leaks", leaks(&rescue)));
    }
    if seen.mesh_sides != seen.mesh {
        rows.insert(1, ("with backs", format!("{:.4}  (--sides {})", seen.mesh_sides, report.sides)));
    }
    if let Some(error) = &report.standard_error {
        rows.insert(1, ("standard error", exactness(error)));
    }
    if report.occluder_triangles > 0 {
        rows.insert(2, ("around it", format!("{} triangles of occluders", count(report.occluder_triangles))));
    }
    if let Some(output) = &request.output {
        rows.push(("written", output.display().to_string()));
    }
    if let Some(diagram) = &request.diagram {
        rows.push(("diagram", diagram.output.display().to_string()));
    }
    if let Some(page) = &request.page {
        rows.push(("page", page.output.display().to_string()));
    }
    pairs(&rows)
}

fn leaks(rescue: &RescueSummary) -> String {
    match (rescue.leak_rate, rescue.leak_unmeasured) {
        (Some(rate), _) => {
            let sampled = thousands(rescue.leak_sampled);
            format!("{:.1} % of {sampled} of these pairs, asked by rays, are hidden after all", 100.0 * rate)
        }
        (None, reason) => format!("not measured: {}", reason.unwrap_or_default()),
    }
}

fn looked_with(report: &MeasureReport) -> String {
    let mut parts = vec![report.backend.to_owned(), report.estimator.to_owned()];
    parts.extend(report.cameras.map(|n| format!("{n} cameras")));
    parts.extend(report.resolution.map(|n| format!("{n} pixels square")));
    parts.extend((report.rays > 0).then(|| format!("{} rays", thousands(report.rays))));
    parts.join(", ")
}

fn exactness(error: &ErrorSummary) -> String {
    let [mesh, p99] = [error.mesh, error.p99].map(significant);
    let samples = thousands(error.samples.into());
    format!("{mesh}, of single triangles at most {p99} for 99 in 100  ({samples} rays a side)")
}
