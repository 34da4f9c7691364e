//! `outsight demo`: the whole story on the bundled model.

use std::path::{Path, PathBuf};

use clap::Args;
use outsight::error::{Error, Result};
use outsight::io::{self, ReadOptions};
use outsight::pipeline::{
    self, CompareReport, CompareRequest, LevelRequest, MeasureReport, MeasureRequest, Metric, PageRequest,
    RenderRequest, SimplifyReport, SimplifyRequest, Style, TestReport,
};
use outsight::report::colour::ColourMap;
use outsight::simplify::{SimplifyOptions, Target};
use outsight::visibility::{Hidden, MeasureOptions};
use serde::Serialize;

use super::bundled;
use super::console::Console;
use super::estimate::Task;
use super::failure::Failure;
use super::flags::LookingFlags;
use super::outputs;
use super::presets;
use super::text::{count, table};
use super::watch::Watch;

/// Where everything goes, in the directory the program is run in.
const DIRECTORY: &str = "outsight-demo";
/// Share of the triangles that both results keep.
const RATIO: f64 = 0.05;
/// From the gearbox toward the camera of the heat map: above, in front, to the right.
const CAMERA: [f64; 3] = [1.0, -2.0, 1.2];
/// The gearbox stands on its feet along z.
const UP: [f64; 3] = [0.0, 0.0, 1.0];
/// Pixels along the side of the heat map.
const PICTURE_SIZE: u32 = 900;

#[derive(Debug, Args)]
pub struct Flags {}

/// Everything the demo found.
#[derive(Debug, Serialize)]
struct Report {
    model: &'static str,
    triangles: usize,
    measure: MeasureReport,
    quadric: SimplifyReport,
    visibility: SimplifyReport,
    compare: CompareReport,
    /// How much smaller the image error is with visibility, in %.
    image_error_saved: f64,
    files: Files,
}

/// What the demo writes.
#[derive(Debug, Serialize)]
struct Files {
    model: PathBuf,
    heat_mesh: PathBuf,
    heat_picture: PathBuf,
    quadric: PathBuf,
    visibility: PathBuf,
    differences: PathBuf,
    page: PathBuf,
    json: PathBuf,
}

impl Files {
    fn in_directory(directory: &Path) -> Self {
        let file = |name: &str| directory.join(name);
        Self {
            model: file(bundled::NAME),
            heat_mesh: file("heat.glb"),
            heat_picture: file("heat.png"),
            quadric: file("gearbox-quadric.ply"),
            visibility: file("gearbox-visibility.ply"),
            differences: file("differences.png"),
            page: file("report.html"),
            json: file("demo.json"),
        }
    }

    fn all(&self) -> [&Path; 8] {
        [
            &self.model,
            &self.heat_mesh,
            &self.heat_picture,
            &self.quadric,
            &self.visibility,
            &self.differences,
            &self.page,
            &self.json,
        ]
    }
}

/// Measures, simplifies twice, compares, draws, explains.
pub fn run(_flags: &Flags, console: &Console) -> std::result::Result<(), Failure> {
    let files = prepare(Path::new(DIRECTORY))?;
    let looking = presets::measure_options(&LookingFlags::default(), &console.global)?;
    let watch = Watch::new(console, Task::Simplify { resolution: 0, cameras: 0 }).deleting_knowingly(true);

    console.note("measuring: which triangles of the gearbox can be seen from outside?");
    let measure = pipeline::measure_file(&measure_request(&files, &looking), &watch)?;
    pipeline::render_file(&heat_request(&files, &looking), &watch)?;

    console.note("simplifying to 5 %: once by shape alone, once by shape and visibility");
    let quadric = simplified(&files.model, &files.quadric, Metric::Quadric, &looking);
    let quadric = pipeline::run_simplify(&quadric, &watch)?;
    let visibility = simplified(&files.model, &files.visibility, Metric::Visibility, &looking);
    let visibility = pipeline::run_simplify(&visibility, &watch)?;

    console.note("comparing both with the original, from 20 cameras that were not used before");
    let compare = pipeline::compare_files(&compare_request(&files, looking, console), &watch)?;

    let image_error_saved = saved(&compare);
    let triangles = measure.triangles;
    let model = bundled::NAME;
    let report = Report { model, triangles, measure, quadric, visibility, compare, image_error_saved, files };
    let json = console.to_json(&report)?;
    io::write_atomic(&report.files.json, true, |out| out.write_all(json.as_bytes()))?;
    console.result(&report, &text(&report), true)
}

/// Makes the directory, checks that everything can be written, and puts the model there.
fn prepare(directory: &Path) -> Result<Files> {
    let fail = |e: std::io::Error| Error::Write { path: directory.to_owned(), message: e.to_string() };
    std::fs::create_dir_all(directory).map_err(fail)?;
    let files = Files::in_directory(directory);
    for file in files.all() {
        outputs::check_place(file, true)?;
    }
    io::write_atomic(&files.model, true, |out| out.write_all(bundled::BYTES))?;
    Ok(files)
}

fn measure_request(files: &Files, looking: &MeasureOptions) -> MeasureRequest {
    MeasureRequest {
        input: files.model.clone(),
        read: ReadOptions::default(),
        measure: looking.clone(),
        occluders: Vec::new(),
        output: Some(files.heat_mesh.clone()),
        diagram: None,
        page: None,
        colour_map: ColourMap::Paper,
        cache: None,
        force: true,
    }
}

fn heat_request(files: &Files, looking: &MeasureOptions) -> RenderRequest {
    RenderRequest {
        input: files.model.clone(),
        read: ReadOptions::default(),
        output: files.heat_picture.clone(),
        style: Style::Heat,
        camera: CAMERA,
        up: UP,
        size: PICTURE_SIZE,
        colour_map: ColourMap::Paper,
        legend: true,
        measure: looking.clone(),
        cache: None,
        force: true,
    }
}

fn simplified(input: &Path, output: &Path, metric: Metric, looking: &MeasureOptions) -> SimplifyRequest {
    SimplifyRequest {
        input: input.to_owned(),
        read: ReadOptions::default(),
        metric,
        measure: looking.clone(),
        occluders: Vec::new(),
        hidden: if metric == Metric::Quadric { Hidden::Keep } else { Hidden::Delete },
        visibility_power: pipeline::VISIBILITY_POWER,
        simplify: SimplifyOptions::default(),
        levels: vec![LevelRequest { targets: vec![Target::Ratio(RATIO)], output: output.to_owned() }],
        format: None,
        cache: None,
        page: None,
        force: true,
    }
}

/// What `demo` does, command by command, begun with itself.
fn commands(console: &Console) -> Vec<String> {
    let [model, seed] = [bundled::NAME, console.command_line.trim_start_matches("outsight demo")];
    let [quadric, visibility] = ["gearbox-quadric.ply", "gearbox-visibility.ply"];
    vec![
        format!("{}   # which is the same as", console.command_line),
        format!("outsight simplify {model} -o {quadric} -r {RATIO} --metric quadric{seed}"),
        format!("outsight simplify {model} -o {visibility} -r {RATIO}{seed}"),
        format!("outsight compare {model} {quadric} {visibility} -o differences.png --report report.html{seed}"),
    ]
}

fn compare_request(files: &Files, looking: MeasureOptions, console: &Console) -> CompareRequest {
    let names = vec!["QB (shape alone)".to_owned(), "VG (shape and visibility)".to_owned()];
    let page = PageRequest { output: files.page.clone(), up: UP, commands: commands(console), names };
    CompareRequest {
        reference: files.model.clone(),
        tests: vec![files.quadric.clone(), files.visibility.clone()],
        read: ReadOptions::default(),
        samples: None,
        seed: console.global.seed,
        occluders: Vec::new(),
        cache: None,
        sheet: Some(files.differences.clone()),
        up: UP,
        page: Some(page),
        measure: looking,
        force: true,
    }
}

/// How much smaller the image error of the second test is than that of the first, in %.
fn saved(compare: &CompareReport) -> f64 {
    match compare.tests.as_slice() {
        [quadric, visibility] if quadric.image_rmse > 0.0 => 100.0 * (1.0 - visibility.image_rmse / quadric.image_rmse),
        _ => 0.0,
    }
}

fn text(report: &Report) -> String {
    let row = |name: &str, test: &TestReport| {
        let image = format!("{:.2}", test.image_rmse);
        vec![name.to_owned(), count(test.triangles), image, format!("{:.0}", test.silhouette_xor)]
    };
    let names = ["by shape alone (QB)", "by shape and visibility (VG)"];
    let original = vec!["original".to_owned(), count(report.triangles), "0.00".to_owned(), "0".to_owned()];
    let results = names.iter().zip(&report.compare.tests).map(|(name, test)| row(name, test));
    let rows: Vec<Vec<String>> = std::iter::once(original).chain(results).collect();
    let table = table(&["gearbox", "triangles", "image error", "outline error"], &rows);
    format!("\n{table}\n{}\n{}", explanation(report), next_steps(&report.files))
}

fn explanation(report: &Report) -> String {
    let seen = &report.measure.visibility;
    let never = 100.0 * seen.never_seen as f64 / report.triangles.max(1) as f64;
    let mut lines = format!(
        "The gearbox has visibility {:.2}: a ball has 1, a sealed inside has 0.\n\
         {never:.0} % of its triangles are seen by none of the {} cameras.\n\
         Both results keep {:.0} % of the triangles; only the choice of where differs.\n\
         Image error: how far pictures of it are from pictures of the original, in grey levels of 255.\n\
         Outline error: pixels per picture, of 512 by 512, that only one of the two outlines covers.\n",
        seen.mesh,
        report.measure.cameras.unwrap_or_default(),
        100.0 * RATIO,
    );
    if report.image_error_saved > 0.0 {
        lines += &format!("With visibility the image error is {:.0} % smaller.\n", report.image_error_saved);
    }
    lines
}

fn next_steps(files: &Files) -> String {
    format!(
        "Open      {}        all of it on one page, with models to turn\n\
         Look at   {}   original, both results, and in red where they differ\n\
         Look at   {}          how well each triangle is seen\n\
         Numbers   {}\n\n\
         Try next  outsight simplify YOUR.ply -o small.ply -r 0.05\n          \
         outsight compare YOUR.ply small.ply -o differences.png\n",
        files.page.display(),
        files.differences.display(),
        files.heat_picture.display(),
        files.json.display(),
    )
}
