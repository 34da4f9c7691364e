//! `outsight study zt`: the tables and figures of Zhang & Turk 2002 on meshes of one's own.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use outsight::error::{Error, Result};
use outsight::pipeline::{LEVELS, PlannedCell, Preset, ZtModel, ZtReport, ZtRequest, plan_zt, study_zt};
use outsight::report::paper::parse_model_argument;
use serde::Serialize;

use crate::cli::console::Console;
use crate::cli::estimate::{Task, study_seconds};
use crate::cli::failure::Failure;
use crate::cli::flags::ReadingFlags;
use crate::cli::outputs::{self, Kind, Planned};
use crate::cli::system::{peak_mib, processor};
use crate::cli::text::{duration, table};
use crate::cli::values;
use crate::cli::watch::Watch;

#[derive(Debug, Args)]
pub struct Flags {
    /// Mesh files; NAME=FILE says which of the paper's models a file stands for, as in motor=engine.ply
    #[arg(value_name = "MODELS", required = true)]
    models: Vec<OsString>,
    #[command(flatten)]
    reading: ReadingFlags,
    /// Directory for all that is found; the next run with the same directory goes on where this one ended
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Whose options: the paper's, the best, or each in turn
    #[arg(long, value_name = "NAME", default_value = "both")]
    preset: Presets,
    /// Shares of the triangles at which simplifiers are compared, descending, as in 0.2,0.1,0.05 [default: halves, 0.5, 0.25,
    /// … 0.0078125: the paper has seven levels, evenly spread in its figure, and does not say which]
    #[arg(long, value_name = "R,R,…", value_delimiter = ',', value_parser = values::share)]
    levels: Vec<f64>,
    /// Samples on each mesh for the geometric error
    #[arg(long, value_name = "N", default_value_t = 200_000, value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    samples: u64,
    /// Octahedral cameras: 6, 18, 66, 258, 1026, 4098 [default: 258]
    #[arg(long, value_name = "N")]
    cameras: Option<usize>,
    /// Pixels along each image's side, 16 to 16384 [best: by triangles, paper: 480]
    #[arg(long, value_name = "W", value_parser = clap::value_parser!(u32).range(16..=16384))]
    resolution: Option<u32>,
    /// Leave out figure 3, how V depends on the number of cameras, which takes longest
    #[arg(long)]
    no_convergence: bool,
    /// Print what would be computed, and how long it may take
    #[arg(long)]
    dry_run: bool,
    /// Direction that points up in pictures, of all models, or of one as in bunny=0,1,0; may be given several times
    /// [default: 0,0,1]
    #[arg(long, value_name = "[NAME=]X,Y,Z", value_parser = values::direction_of)]
    up: Vec<(Option<String>, [f64; 3])>,
    /// The model of this name is another file than the paper's, though its number of triangles is the same; may be given
    /// several times
    #[arg(long, value_name = "NAME")]
    stand_in: Vec<String>,
    /// Write the page to this place too: .html, one file that loads nothing
    #[arg(long = "report", value_name = "FILE")]
    page: Option<PathBuf>,
}

/// Upward where nobody says otherwise.
const UP: [f64; 3] = [0.0, 0.0, 1.0];

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Presets {
    /// Nearest to the text of Zhang & Turk 2002
    Paper,
    /// The best results
    Best,
    /// Each in turn
    Both,
}

/// What `--dry-run` prints.
#[derive(Debug, Serialize)]
struct Plan {
    cells: Vec<PlannedCell>,
    /// For what is not there yet.
    estimated_seconds: f64,
}

/// The library's report with what only the program knows.
#[derive(Debug, Serialize)]
struct Object<'a> {
    options: serde_json::Value,
    #[serde(flatten)]
    report: &'a ZtReport,
    peak_mb: Option<f64>,
}

impl Flags {
    fn request(&self, console: &Console) -> Result<ZtRequest> {
        Ok(ZtRequest {
            models: self.studied()?,
            read: self.reading.options(&console.global),
            presets: match self.preset {
                Presets::Paper => vec![Preset::Paper],
                Presets::Best => vec![Preset::Best],
                Presets::Both => Preset::ALL.to_vec(),
            },
            levels: if self.levels.is_empty() { LEVELS.to_vec() } else { self.levels.clone() },
            samples: self.samples,
            seed: console.global.seed,
            cameras: self.cameras,
            resolution: self.resolution,
            convergence: !self.no_convergence,
            memory_limit: console.global.memory_limit,
            output: self.output.clone(),
            machine: machine(),
            page: self.page.clone(),
        })
    }

    /// The models, each the way up that was said of it, or else of all.
    fn studied(&self) -> Result<Vec<ZtModel>> {
        let mut models = self.models.iter().map(model).collect::<Result<Vec<_>>>()?;
        check_names("--up", self.up.iter().filter_map(|(name, _)| name.as_ref()), &models)?;
        check_names("--stand-in", self.stand_in.iter(), &models)?;
        for model in &mut models {
            model.stand_in = self.stand_in.contains(&model.name);
            let said = |wanted: Option<&String>| self.up.iter().rfind(|(name, _)| name.as_ref() == wanted);
            if let Some((_, up)) = said(Some(&model.name)).or_else(|| said(None)) {
                model.up = *up;
            }
        }
        Ok(models)
    }
}

/// Whatever is said of one model is said of one that is there.
fn check_names<'a>(flag: &'static str, names: impl IntoIterator<Item = &'a String>, models: &[ZtModel]) -> Result<()> {
    let Some(stranger) = names.into_iter().find(|name| models.iter().all(|model| &model.name != *name)) else {
        return Ok(());
    };
    let names: Vec<&str> = models.iter().map(|model| model.name.as_str()).collect();
    let message = format!("no model is called {stranger}; there is {}", names.join(", "));
    Err(Error::Option { name: flag, message })
}

/// A model as it was named, called by its file's name without what follows the first dot.
fn model(argument: &OsString) -> Result<ZtModel> {
    let named = parse_model_argument(argument)?;
    let name = named.file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let name = name.split('.').next().unwrap_or_default().to_owned();
    if name.is_empty() {
        let message = format!("{} has no name that files could be named after", named.file.display());
        return Err(Error::Option { name: "MODELS", message });
    }
    Ok(ZtModel { name, path: named.file, paper: named.model, stand_in: false, up: UP })
}

/// Studies the models, or says what that would take.
pub fn run(flags: &Flags, console: &Console) -> std::result::Result<(), Failure> {
    let request = flags.request(console)?;
    check_directory(&request.output, console.global.force)?;
    if let Some(path) = &request.page {
        let inputs: Vec<&Path> = request.models.iter().map(|model| model.path.as_path()).collect();
        outputs::check(Planned { path, kind: Kind::Page, format: None }, &inputs, console.global.force)?;
    }
    if flags.dry_run {
        return dry_run(&request, console);
    }
    let task = Task::Study { resolution: flags.resolution };
    let report = study_zt(&request, &Watch::new(console, task).deleting_knowingly(true));
    if matches!(report, Err(Error::Cancelled)) {
        let directory = request.output.display();
        console.announce(&format!("what was found is kept in {directory}; the same command goes on from there"));
    }
    let report = report?;
    let object = Object { options: options(&request), report: &report, peak_mb: peak_mib() };
    let json = console.to_json(&object)?;
    report.write(&request, &json, std::slice::from_ref(&console.command_line))?;
    console.result(&object, &text(&report, &request), true)
}

/// `on 2 threads (Intel(R) Xeon(R) Processor)`
fn machine() -> String {
    let threads = rayon::current_num_threads();
    let of = processor().map(|name| format!(" ({name})")).unwrap_or_default();
    format!("on {threads} thread{}{of}", if threads == 1 { "" } else { "s" })
}

/// The options in force.
fn options(request: &ZtRequest) -> serde_json::Value {
    serde_json::json!({
        "presets": request.presets,
        "levels": request.levels,
        "samples": request.samples,
        "seed": request.seed,
        "cameras": request.cameras,
        "resolution": request.resolution,
        "convergence": request.convergence,
    })
}

/// A study's files are replaced by its next run; a directory with anything else in it is not touched.
fn check_directory(directory: &Path, force: bool) -> Result<()> {
    if directory.exists() && !directory.is_dir() {
        let message = "is a file; a study writes many files into a directory: give the name of one".to_owned();
        return Err(Error::Write { path: directory.to_owned(), message });
    }
    let Ok(mut entries) = fs::read_dir(directory) else { return Ok(()) };
    if is_ours(&directory.join("cells")) || force || entries.next().is_none() {
        return Ok(());
    }
    let message = "holds files that no study made; give another directory, or --force".to_owned();
    Err(Error::Write { path: directory.to_owned(), message })
}

/// Whether a study keeps its findings in this directory: a folder for each model, and nothing else.
fn is_ours(cells: &Path) -> bool {
    let models: Vec<PathBuf> = fs::read_dir(cells).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    !models.is_empty() && models.iter().all(|model| model.is_dir())
}

fn dry_run(request: &ZtRequest, console: &Console) -> std::result::Result<(), Failure> {
    let cells = plan_zt(request)?;
    let seconds = |cell: &PlannedCell| if cell.done { 0.0 } else { study_seconds(cell, request) };
    let estimated_seconds = cells.iter().map(seconds).sum();
    let row = |cell: &PlannedCell| {
        let state = if cell.done { "found".to_owned() } else { duration(seconds(cell)) };
        vec![cell.model.clone(), cell.cell.name(), state]
    };
    let rows: Vec<_> = cells.iter().map(row).collect();
    let left = cells.iter().filter(|cell| !cell.done).count();
    let text = format!(
        "{}{left} of {} cells to compute, about {}\n",
        table(&["model", "cell", "time"], &rows),
        cells.len(),
        duration(estimated_seconds)
    );
    console.result(&Plan { cells, estimated_seconds }, &text, true)
}

fn text(report: &ZtReport, request: &ZtRequest) -> String {
    let stands = report.models.iter().filter(|model| model.stand.model().is_some());
    let stands: String = stands.map(|m| format!("{}: {}\n", m.findings.name, m.stand_in_words)).collect();
    let left_out = report.left_out_in_words().map(|words| format!("{words}\n"));
    let [page, tables] = ["report.html", "tables.md"].map(|file| request.output.join(file));
    let written = request.page.iter().chain([&page, &tables]).map(|path| path.display().to_string());
    format!(
        "Visibility (table 1), in brackets what the paper prints\n{}\n\
         Image error of VG against QB (table 2)\n{}\n\
         Image error of VG against QB, mean over the models, in brackets how many, and rank correlation with V(M)\n{}\n\
         {stands}{}written  {}\n",
        report.table1(),
        report.table2(),
        report.gains_table(),
        left_out.unwrap_or_default(),
        written.collect::<Vec<_>>().join(", "),
    )
}
