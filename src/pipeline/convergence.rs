mod page;

use std::io::{self as std_io, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::backend::{BackendKind, Workload};
use crate::camera::{CameraPattern, CameraWeights, Cameras, Window};
use crate::error::{Error, Result};
use crate::io::{self, ReadOptions};
use crate::pipeline::observation::Surrounded;
use crate::pipeline::surroundings::Surroundings;
use crate::pipeline::{Clock, Observer};
use crate::progress::Progress;
use crate::report::plot::{Curve, LogLogPlot, Mark, Panel};
use crate::visibility::{
    Estimator, MeasureOptions, NestedVisibility, RayOptions, Setting, Sides, Subject, Visibility, mean_difference,
    nested_resolution, nested_visibility, surface_mean,
};

/// What [`study_convergence`] does.
#[derive(Debug, Clone)]
pub struct ConvergenceRequest {
    /// The meshes.
    pub inputs: Vec<PathBuf>,
    /// How they are read.
    pub read: ReadOptions,
    /// Meshes in the same coordinates that hide and are not studied.
    pub occluders: Vec<PathBuf>,
    /// What the second comparison is with.
    pub against: IndependentReference,
    /// Pixels along an image's side; `None` takes [`nested_resolution`].
    pub resolution: Option<u32>,
    /// Bytes that the images of all threads together may take.
    pub memory_limit: Option<u64>,
}

/// Other means of finding V, which do not share what is wrong with the octahedral pattern.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IndependentReference {
    /// [`Estimator::Hemisphere`] with so many rays from a triangle's front, taken up to a power of two: no cameras, no
    /// pixels, and a standard error. Needs Embree.
    Hemisphere(u32),
    /// 4096 cameras on a spiral, with pixels like those of the cameras under study: all that can be done without rays.
    Fibonacci,
}

/// Cameras of [`IndependentReference::Fibonacci`]; their weights need no correction.
const SPIRAL: usize = 4096;

/// Result of [`study_convergence`].
#[derive(Debug, Clone, Serialize)]
pub struct ConvergenceReport {
    /// Estimator and backend of the second comparison.
    pub reference: String,
    /// Rays that it casts from a triangle's front; `None` where it looks from cameras on a spiral.
    pub reference_samples: Option<u32>,
    /// One entry per mesh.
    pub meshes: Vec<MeshConvergence>,
}

/// How V of one mesh depends on the number of cameras.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeshConvergence {
    /// The file.
    pub file: PathBuf,
    /// Its triangles.
    pub triangles: usize,
    /// Pixels along an image's side.
    pub resolution: u32,
    /// Standard error of a triangle's V in the reference, mean over the surface: smaller errors do not show.
    pub reference_error: Option<f64>,
    /// One entry per pattern and weights, ascending by cameras.
    pub errors: Vec<ConvergenceError>,
    /// Wall time of the looking.
    pub seconds: f64,
}

/// How far V from some cameras is off: Σ A |V − V_ref| / Σ A over the triangles' fronts, as counted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ConvergenceError {
    /// Octahedral cameras.
    pub cameras: usize,
    /// How they count, `equal` or `area`.
    pub weights: CameraWeights,
    /// Against 4098 cameras of the same pattern and weights; `None` for these themselves.
    pub against_4098: Option<f64>,
    /// Against the independent reference.
    pub against_reference: f64,
}

impl IndependentReference {
    /// Says whether this build has it.
    ///
    /// # Errors
    /// [`Error::Unavailable`], naming the other.
    pub fn check(self) -> Result<()> {
        self.setting().backend.check().map_err(|_| Error::Unavailable {
            message:
                "the reference hemisphere casts rays, and this program was built without the feature `embree`; install \
                      Embree (Debian, Ubuntu: apt-get install libembree-dev libclang-dev) and build with \
                      `--features embree`, or use --against fibonacci"
                    .to_owned(),
        })
    }

    fn setting(self) -> Setting {
        match self {
            Self::Hemisphere(_) => Setting { estimator: Estimator::Hemisphere, backend: BackendKind::Embree },
            Self::Fibonacci => Setting { estimator: Estimator::Coverage, backend: BackendKind::Raster },
        }
    }

    fn samples(self) -> Option<u32> {
        match self {
            Self::Hemisphere(samples) => Some(samples.next_power_of_two()),
            Self::Fibonacci => None,
        }
    }

    /// V of the fronts, by these means.
    fn measure(self, scene: Surrounded<'_>, options: &MeasureOptions, progress: &dyn Progress) -> Result<Visibility> {
        let mut options = self.setting().apply(options);
        match self {
            Self::Hemisphere(samples) => options.rays = RayOptions { samples, ..options.rays },
            Self::Fibonacci => {
                options.cameras = Cameras { pattern: CameraPattern::Fibonacci(SPIRAL), ..options.cameras };
            }
        }
        scene.for_backend(options.backend)?.measure(&options, progress)
    }
}

/// Compares V from 6 to 4098 octahedral cameras with V from the most of them, and with V found by other means.
///
/// Zhang & Turk 2002, Fig. 3, compare with 4096 cameras of the same pattern. That cannot show what is wrong with the pattern
/// itself: with equal weights its densest places count too much, however many cameras there are.
///
/// # Errors
/// [`Error::Unavailable`] for a reference that this build does not have; as its steps.
pub fn study_convergence(request: &ConvergenceRequest, observer: &dyn Observer) -> Result<ConvergenceReport> {
    let against = request.against;
    against.check()?;
    let occluders = Surroundings::read(&request.occluders, &request.read)?;
    let study = |path: &PathBuf| study_one(path, &occluders, request, observer);
    let meshes = request.inputs.iter().map(study).collect::<Result<_>>()?;
    Ok(ConvergenceReport::of(against, meshes))
}

fn study_one(
    path: &Path,
    occluders: &Surroundings,
    request: &ConvergenceRequest,
    observer: &dyn Observer,
) -> Result<MeshConvergence> {
    let loaded = io::read(path, &request.read)?;
    observer.mesh_read(path, &loaded)?;
    convergence_of(path, occluders.around(&loaded.mesh)?, request, observer)
}

/// How V of one mesh, read from `path`, depends on the number of cameras.
pub(super) fn convergence_of(
    path: &Path,
    scene: Surrounded<'_>,
    request: &ConvergenceRequest,
    observer: &dyn Observer,
) -> Result<MeshConvergence> {
    let mesh = scene.mesh;
    let mut clock = Clock::start();
    let resolution = request.resolution.unwrap_or_else(|| nested_resolution(mesh.triangle_count()));
    let options = MeasureOptions {
        resolution: Some(resolution),
        sides: Sides::One,
        memory_limit: request.memory_limit,
        ..MeasureOptions::default()
    };
    let reference = request.against.measure(scene, &options, observer)?;
    let subject = scene.for_backend(BackendKind::Raster)?;
    let window = Window::around_sphere(resolution);
    let load = Workload { window, memory_limit: request.memory_limit, phase: "convergence", progress: observer };
    let nested = nested_visibility(&subject, load)?;
    let standard_error = reference.details().standard_error.as_ref();
    Ok(MeshConvergence {
        file: path.to_owned(),
        triangles: mesh.triangle_count(),
        resolution,
        reference_error: standard_error.map(|error| surface_mean(&subject, |t| error.per_triangle[t])),
        errors: nested.iter().map(|of_one| error_of(of_one, &nested, &reference, &subject)).collect(),
        seconds: clock.lap(),
    })
}

/// How far one of the nested patterns is off from the finest, and from the reference.
fn error_of(
    of_one: &NestedVisibility,
    nested: &[NestedVisibility],
    reference: &Visibility,
    subject: &Subject<'_>,
) -> ConvergenceError {
    let finest = nested.iter().rev().find(|finest| finest.weights == of_one.weights);
    ConvergenceError {
        cameras: of_one.cameras,
        weights: of_one.weights,
        against_4098: finest
            .filter(|finest| finest.cameras != of_one.cameras)
            .map(|finest| mean_difference(subject, &of_one.front, &finest.front)),
        against_reference: mean_difference(subject, &of_one.front, reference.front()),
    }
}

impl MeshConvergence {
    fn curve(&self, name: &str, weights: CameraWeights, error: impl Fn(&ConvergenceError) -> Option<f64>) -> Curve {
        let chosen = self.errors.iter().filter(|e| e.weights == weights);
        let points = chosen.filter_map(|e| Some((e.cameras as f64, error(e)?))).collect();
        let mark = if weights == CameraWeights::Equal { Mark::Open } else { Mark::Filled };
        Curve { name: format!("{name}, {}", weights.name()), points, mark }
    }
}

impl ConvergenceReport {
    /// The report on these meshes.
    pub(super) fn of(against: IndependentReference, meshes: Vec<MeshConvergence>) -> Self {
        Self { reference: against.setting().to_string(), reference_samples: against.samples(), meshes }
    }

    /// The reference in words.
    #[must_use]
    pub fn reference_in_words(&self) -> String {
        match self.reference_samples {
            Some(samples) => format!("{}, {samples} rays a triangle", self.reference),
            None => format!("{}, {SPIRAL} cameras on a spiral", self.reference),
        }
    }

    /// Writes one row per mesh, number of cameras and weights; an error that there is not is empty.
    ///
    /// # Errors
    /// As `output`.
    pub fn write_csv(&self, output: &mut dyn Write) -> std_io::Result<()> {
        let columns =
            "file,triangles,resolution,reference,reference_error,cameras,weights,against_4098,against_reference";
        writeln!(output, "{columns}")?;
        for (mesh, name) in self.meshes.iter().zip(self.names()) {
            // A name with a comma or a quote is quoted, quotes doubled (RFC 4180).
            let file = format!("\"{}\"", name.replace('"', "\"\""));
            let cell = |error: Option<f64>| error.map(|error| error.to_string()).unwrap_or_default();
            let (triangles, resolution, known_to) = (mesh.triangles, mesh.resolution, cell(mesh.reference_error));
            for e in &mesh.errors {
                let row =
                    format!("{},{},{},{}", e.cameras, e.weights.name(), cell(e.against_4098), e.against_reference);
                writeln!(output, "{file},{triangles},{resolution},{},{known_to},{row}", self.reference)?;
            }
        }
        Ok(())
    }

    /// The errors over the number of cameras: to the left against the same pattern, to the right against the reference.
    #[must_use]
    pub fn plot(&self) -> LogLogPlot {
        let panel = |title: String, error: fn(&ConvergenceError) -> Option<f64>| {
            let both = [CameraWeights::Equal, CameraWeights::Area];
            let named = self.meshes.iter().zip(self.names());
            let curves = named.map(|(mesh, name)| both.map(|weights| mesh.curve(&name, weights, error)).to_vec());
            Panel { title, groups: curves.collect() }
        };
        LogLogPlot {
            panels: vec![
                panel("against 4098 cameras of the same pattern".to_owned(), |e| e.against_4098),
                panel(format!("against {}", self.reference_in_words()), |e| Some(e.against_reference)),
            ],
            x: "octahedral cameras".to_owned(),
            y: "mean error of V (from 0 to 1)".to_owned(),
            slope: -0.75,
        }
    }
}
