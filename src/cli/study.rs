//! `outsight study`: tables and figures about the method itself.

mod zt;

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand, ValueEnum};
use outsight::error::{Error, Result};
use outsight::io;
use outsight::pipeline::{
    ConvergenceReport, ConvergenceRequest, IndependentReference, MeshConvergence, study_convergence,
};
use serde::Serialize;

use super::console::Console;
use super::estimate::Task;
use super::failure::Failure;
use super::flags::{OccluderFlags, ReadingFlags};
use super::help;
use super::outputs::{self, Kind, Planned};
use super::system::peak_mib;
use super::text::{count, duration};
use super::watch::Watch;

#[derive(Debug, Args)]
pub struct Flags {
    #[command(subcommand)]
    study: Study,
}

#[derive(Debug, Subcommand)]
enum Study {
    /// How exact visibility is, by the number of cameras and how they count
    #[command(after_help = help::STUDY_CONVERGENCE)]
    Convergence(ConvergenceFlags),
    /// Tables 1 and 2 and figures 1 to 8 of Zhang & Turk 2002, on meshes of your own
    #[command(after_help = help::STUDY_ZT)]
    Zt(zt::Flags),
}

#[derive(Debug, Args)]
struct ConvergenceFlags {
    /// Mesh files
    #[arg(value_name = "MESH", required = true)]
    meshes: Vec<PathBuf>,
    #[command(flatten)]
    reading: ReadingFlags,
    /// Directory for convergence.json, .csv and .svg; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// The independent reference, which shares no error with the cameras under study
    #[arg(long, value_name = "NAME", default_value = "hemisphere")]
    against: Against,
    /// hemisphere: rays from each triangle's front, 8 to 65536, taken up to a power of two [default: 4096]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(8..=65536))]
    samples: Option<u32>,
    /// Pixels along each image's side, 16 to 16384 [default: by triangles, 480 to 1920]
    #[arg(long, value_name = "W", value_parser = clap::value_parser!(u32).range(16..=16384))]
    resolution: Option<u32>,
    /// Write a page with the plots and tables too: .html, one file that loads nothing
    #[arg(long = "report", value_name = "FILE")]
    page: Option<PathBuf>,
    #[command(flatten)]
    around: OccluderFlags,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Against {
    /// Rays spread by the cosine, with a standard error; needs Embree
    Hemisphere,
    /// 4096 cameras on a spiral, in any build; has pixel noise of its own
    Fibonacci,
}

/// Rays whose error is small beside that of 4098 cameras.
const SAMPLES: u32 = 4096;

impl ConvergenceFlags {
    fn reference(&self) -> Result<IndependentReference> {
        match (self.against, self.samples) {
            (Against::Hemisphere, samples) => Ok(IndependentReference::Hemisphere(samples.unwrap_or(SAMPLES))),
            (Against::Fibonacci, None) => Ok(IndependentReference::Fibonacci),
            (Against::Fibonacci, Some(_)) => {
                let message =
                    "fibonacci looks from 4096 cameras and casts no rays; leave it out, or use --against hemisphere";
                Err(Error::Option { name: "--samples", message: message.to_owned() })
            }
        }
    }
}

/// The library's report with what only the program knows.
#[derive(Debug, Serialize)]
struct Object<'a> {
    #[serde(flatten)]
    report: &'a ConvergenceReport,
    peak_mb: Option<f64>,
    occluders: &'a [PathBuf],
    page: Option<&'a Path>,
}

/// Runs the study that was asked for.
pub fn run(flags: &Flags, console: &Console) -> std::result::Result<(), Failure> {
    match &flags.study {
        Study::Convergence(flags) => convergence(flags, console),
        Study::Zt(flags) => zt::run(flags, console),
    }
}

fn convergence(flags: &ConvergenceFlags, console: &Console) -> std::result::Result<(), Failure> {
    let force = console.global.force;
    let against = flags.reference()?;
    against.check()?;
    let files = ["convergence.json", "convergence.csv", "convergence.svg"].map(|name| flags.output.join(name));
    files.iter().try_for_each(|file| outputs::check_place_to_be(file, force))?;
    let [json, csv, svg] = files;
    let inputs: Vec<&Path> = flags.meshes.iter().chain(&flags.around.occluders).map(PathBuf::as_path).collect();
    if let Some(path) = &flags.page {
        outputs::check(Planned { path, kind: Kind::Page, format: None }, &inputs, force)?;
    }
    let request = ConvergenceRequest {
        inputs: flags.meshes.clone(),
        read: flags.reading.options(&console.global),
        occluders: flags.around.occluders.clone(),
        against,
        resolution: flags.resolution,
        memory_limit: console.global.memory_limit,
    };
    let task = Task::Study { resolution: flags.resolution };
    let report = study_convergence(&request, &Watch::new(console, task))?;
    let object =
        Object { report: &report, peak_mb: peak_mib(), occluders: &request.occluders, page: flags.page.as_deref() };
    let text_of_json = console.to_json(&object)?;
    let picture = report.plot().to_svg().map_err(|e| Error::Write { path: svg.clone(), message: e.to_string() })?;
    io::write_atomic_in_directory(&json, force, |out| out.write_all(text_of_json.as_bytes()))?;
    io::write_atomic(&csv, force, |out| report.write_csv(out))?;
    io::write_atomic(&svg, force, |out| out.write_all(picture.as_bytes()))?;
    if let Some(page) = &flags.page {
        let html = report.page(std::slice::from_ref(&console.command_line))?.to_html()?;
        io::write_atomic(page, force, |out| out.write_all(html.as_bytes()))?;
    }
    let page = flags.page.iter().map(|page| format!("page     {}\n", page.display())).collect::<String>();
    console.result(&object, &(text(&report, &flags.output) + &page), true)
}

fn text(report: &ConvergenceReport, directory: &Path) -> String {
    let tables: String = report.meshes.iter().zip(report.names()).map(|(mesh, name)| table_of(mesh, &name)).collect();
    format!(
        "{tables}mean error of V over the surface, V from 0 to 1\n\
         same pattern: against 4098 octahedral cameras of the same weights\n\
         independent: against {}\n\
         written  {}\n",
        report.reference_in_words(),
        directory.join("convergence.{json,csv,svg}").display(),
    )
}

fn table_of(mesh: &MeshConvergence, name: &str) -> String {
    let known = mesh.reference_error.map_or(String::new(), |e| format!("standard error of the reference: {e:.5}\n"));
    format!(
        "{name}: {} triangles, {} pixels square, {}\n{}{known}\n",
        count(mesh.triangles),
        mesh.resolution,
        duration(mesh.seconds),
        mesh.table(),
    )
}
