use std::io::{self as std_io, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::backend::{BackendKind, Workload};
use crate::camera::{CameraPattern, CameraWeights, Cameras, Window};
use crate::error::Result;
use crate::io::{self, ReadOptions};
use crate::mesh::TriMesh;
use crate::pipeline::{Clock, Observer};
use crate::report::plot::{Curve, LogLogPlot, Mark, Panel};
use crate::visibility::{MeasureOptions, NestedVisibility, Sides, Subject, mean_difference, nested_visibility};

/// What [`study_convergence`] does.
#[derive(Debug, Clone)]
pub struct ConvergenceRequest {
    /// The meshes.
    pub inputs: Vec<PathBuf>,
    /// How they are read.
    pub read: ReadOptions,
    /// Pixels along an image's side; `None` chooses by the number of triangles.
    pub resolution: Option<u32>,
    /// Bytes that the images of all threads together may take.
    pub memory_limit: Option<u64>,
}

/// Result of [`study_convergence`].
#[derive(Debug, Clone, Serialize)]
pub struct ConvergenceReport {
    /// What the second comparison is with.
    pub reference: String,
    /// One entry per mesh.
    pub meshes: Vec<MeshConvergence>,
}

/// How V of one mesh depends on the number of cameras.
#[derive(Debug, Clone, Serialize)]
pub struct MeshConvergence {
    /// The file.
    pub file: PathBuf,
    /// Its triangles.
    pub triangles: usize,
    /// Pixels along an image's side.
    pub resolution: u32,
    /// One entry per pattern and weights, ascending by cameras.
    pub errors: Vec<ConvergenceError>,
    /// Wall time of the looking.
    pub seconds: f64,
}

/// How far V from some cameras is off: Σ A |V − V_ref| / Σ A over the triangles' fronts, as counted.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct ConvergenceError {
    /// Octahedral cameras.
    pub cameras: usize,
    /// How they count, `equal` or `area`.
    pub weights: &'static str,
    /// Against 4098 cameras of the same pattern and weights; `None` for these themselves.
    pub against_4098: Option<f64>,
    /// Against cameras of another pattern.
    pub against_reference: f64,
}

/// Cameras of the independent reference: another pattern, of weights that need no correction.
const REFERENCE: usize = 4096;

/// Compares V from 6 to 4098 octahedral cameras with V from the most of them, and with V from other cameras.
///
/// Zhang & Turk 2002, Fig. 3, compare with 4096 cameras of the same pattern. That cannot show what is wrong with the pattern
/// itself: with equal weights its densest places count too much, however many cameras there are.
///
/// # Errors
/// As its steps.
pub fn study_convergence(request: &ConvergenceRequest, observer: &dyn Observer) -> Result<ConvergenceReport> {
    let meshes = request.inputs.iter().map(|path| study_one(path, request, observer)).collect::<Result<_>>()?;
    Ok(ConvergenceReport { reference: format!("{REFERENCE} cameras on a spiral"), meshes })
}

fn study_one(path: &Path, request: &ConvergenceRequest, observer: &dyn Observer) -> Result<MeshConvergence> {
    let loaded = io::read(path, &request.read)?;
    observer.mesh_read(path, &loaded)?;
    let mesh: TriMesh = loaded.mesh;
    let mut clock = Clock::start();
    let options = MeasureOptions {
        cameras: Cameras { pattern: CameraPattern::Fibonacci(REFERENCE), ..Cameras::default() },
        resolution: request.resolution,
        sides: Sides::One,
        memory_limit: request.memory_limit,
        ..MeasureOptions::default()
    };
    let subject = Subject::new(&mesh, BackendKind::Raster)?;
    let reference = subject.measure(&options, observer)?;
    let window = Window::around_sphere(reference.resolution());
    let load = Workload { window, memory_limit: request.memory_limit, phase: "convergence", progress: observer };
    let nested = nested_visibility(&subject, load)?;
    let finest = |weights: CameraWeights| nested.iter().rev().find(|of_one| of_one.weights == weights);
    let error = |of_one: &NestedVisibility| ConvergenceError {
        cameras: of_one.cameras,
        weights: match of_one.weights {
            CameraWeights::Equal => "equal",
            CameraWeights::Area => "area",
        },
        against_4098: finest(of_one.weights)
            .filter(|finest| finest.cameras != of_one.cameras)
            .map(|finest| mean_difference(&subject, &of_one.front, &finest.front)),
        against_reference: mean_difference(&subject, &of_one.front, reference.front()),
    };
    Ok(MeshConvergence {
        file: path.to_owned(),
        triangles: mesh.triangle_count(),
        resolution: window.width,
        errors: nested.iter().map(error).collect(),
        seconds: clock.lap(),
    })
}

impl MeshConvergence {
    /// The file's name without its directory.
    #[must_use]
    pub fn name(&self) -> String {
        self.file.file_name().unwrap_or(self.file.as_os_str()).to_string_lossy().into_owned()
    }

    fn curve(&self, weights: &'static str, error: impl Fn(&ConvergenceError) -> Option<f64>) -> Curve {
        let chosen = self.errors.iter().filter(|e| e.weights == weights);
        let points = chosen.filter_map(|e| Some((e.cameras as f64, error(e)?))).collect();
        let mark = if weights == "equal" { Mark::Open } else { Mark::Filled };
        Curve { name: format!("{}, {weights}", self.name()), points, mark }
    }
}

impl ConvergenceReport {
    /// Writes one row per mesh, number of cameras and weights; an error that there is not is empty.
    ///
    /// # Errors
    /// As `output`.
    pub fn write_csv(&self, output: &mut dyn Write) -> std_io::Result<()> {
        writeln!(output, "file,triangles,resolution,cameras,weights,against_4098,against_reference")?;
        for mesh in &self.meshes {
            // A name with a comma or a quote is quoted, quotes doubled (RFC 4180).
            let file = format!("\"{}\"", mesh.name().replace('"', "\"\""));
            for e in &mesh.errors {
                let same = e.against_4098.map(|error| error.to_string()).unwrap_or_default();
                let (triangles, resolution) = (mesh.triangles, mesh.resolution);
                let row = format!("{},{},{same},{}", e.cameras, e.weights, e.against_reference);
                writeln!(output, "{file},{triangles},{resolution},{row}")?;
            }
        }
        Ok(())
    }

    /// The errors over the number of cameras: to the left against the same pattern, to the right against the reference.
    #[must_use]
    pub fn plot(&self) -> LogLogPlot {
        let panel = |title: String, error: fn(&ConvergenceError) -> Option<f64>| {
            let curves = self.meshes.iter().map(|mesh| ["equal", "area"].map(|w| mesh.curve(w, error)).to_vec());
            Panel { title, groups: curves.collect() }
        };
        LogLogPlot {
            panels: vec![
                panel("against 4098 cameras of the same pattern".to_owned(), |e| e.against_4098),
                panel(format!("against {}", self.reference), |e| Some(e.against_reference)),
            ],
            x: "octahedral cameras".to_owned(),
            y: "mean error of V (from 0 to 1)".to_owned(),
            slope: -0.75,
        }
    }
}
