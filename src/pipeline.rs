//! The straight path, from mesh file to result.

use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::error::{Error, Result};
use crate::io::{Format, Loaded, ReadOptions};
use crate::progress::{CancelFlag, Progress, Silent};
use crate::simplify::{SimplifyOptions, Target};
use crate::visibility::MeasureOptions;

/// Follows a run: its progress, and what its user should know before the long work starts.
pub trait Observer: Progress {
    /// A mesh was read; an error ends the run.
    ///
    /// # Errors
    /// Whatever the observer decides.
    fn mesh_read(&self, _path: &Path, _loaded: &Loaded) -> Result<()> {
        Ok(())
    }

    /// `deleted` of `given` triangles are hidden and leave the mesh before it is simplified.
    ///
    /// # Errors
    /// Whatever the observer decides.
    fn hidden_deleted(&self, _deleted: usize, _given: usize) -> Result<()> {
        Ok(())
    }
}

impl Observer for Silent {}
impl Observer for CancelFlag {}

/// What orders the collapses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Metric {
    /// Quadric error weighted by visibility (VG).
    #[default]
    Visibility,
    /// Quadric error alone (QB).
    Quadric,
}

/// What happens to triangles that no camera sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Hidden {
    /// They keep a small visibility and their shape.
    Keep,
    /// They collapse first.
    Collapse,
    /// They are removed before simplifying.
    #[default]
    Delete,
}

/// What [`measure_file`] does.
#[derive(Debug, Clone)]
pub struct MeasureRequest {
    /// The mesh.
    pub input: PathBuf,
    /// How it is read.
    pub read: ReadOptions,
    /// How it is looked at.
    pub measure: MeasureOptions,
    /// PLY, `.npy` or `.csv` to write.
    pub output: Option<PathBuf>,
    /// Heat colours in a PLY output.
    pub colour_map: ColourMap,
    /// Replace an output that is there.
    pub force: bool,
}

/// A scale of heat colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColourMap {
    /// White, red, yellow, green.
    #[default]
    Paper,
    /// Blue to yellow, for every eye.
    Cividis,
}

/// Result of [`measure_file`].
#[derive(Debug, Clone, Serialize)]
pub struct MeasureReport {
    /// Triangles looked at.
    pub triangles: usize,
    /// Cameras.
    pub cameras: usize,
    /// Pixels along an image's side.
    pub resolution: u32,
    /// Who looked.
    pub backend: &'static str,
    /// What was counted.
    pub estimator: &'static str,
    /// The numbers.
    pub visibility: VisibilitySummary,
    /// Where the time went.
    pub seconds: MeasureSeconds,
}

/// Visibility of a whole mesh.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct VisibilitySummary {
    /// V(M), one-sided.
    pub mesh: f64,
    /// The same under the rule for sides.
    pub mesh_sides: f64,
    /// Triangles that no camera sees.
    pub never_seen: usize,
}

/// Seconds of wall time per step.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct MeasureSeconds {
    /// Reading and checking the file.
    pub read: f64,
    /// Preparing to look.
    pub build: f64,
    /// Looking.
    pub visibility: f64,
    /// All of it, writing included.
    pub total: f64,
}

/// Reads a mesh, measures it, writes the result where asked.
///
/// # Errors
/// As its steps.
pub fn measure_file(_request: &MeasureRequest, _observer: &dyn Observer) -> Result<MeasureReport> {
    Err(to_come())
}

/// One level of detail to make.
#[derive(Debug, Clone)]
pub struct LevelRequest {
    /// The first one reached ends the level; empty only with an error bound.
    pub targets: Vec<Target>,
    /// Where it goes.
    pub output: PathBuf,
}

/// What [`run_simplify`] does.
#[derive(Debug, Clone)]
pub struct SimplifyRequest {
    /// The mesh.
    pub input: PathBuf,
    /// How it is read.
    pub read: ReadOptions,
    /// What orders the collapses.
    pub metric: Metric,
    /// How visibility is measured, where it is needed.
    pub measure: MeasureOptions,
    /// What happens to hidden triangles.
    pub hidden: Hidden,
    /// p in V^p.
    pub visibility_power: f64,
    /// The collapser's options; its `targets` are those of `levels`.
    pub simplify: SimplifyOptions,
    /// Levels of detail, each at most as large as the one before.
    pub levels: Vec<LevelRequest>,
    /// Format of the outputs, where their names do not say it.
    pub format: Option<Format>,
    /// Replace outputs that are there.
    pub force: bool,
}

/// Result of [`run_simplify`].
#[derive(Debug, Clone, Serialize)]
pub struct SimplifyReport {
    /// One entry per level.
    pub levels: Vec<LevelReport>,
    /// Triangles given.
    pub triangles: usize,
    /// What ordered the collapses.
    pub metric: &'static str,
    /// Where the time went.
    pub seconds: SimplifySeconds,
    /// Hidden triangles that were deleted.
    pub hidden_deleted: usize,
}

/// One level of detail, as made.
#[derive(Debug, Clone, Serialize)]
pub struct LevelReport {
    /// Triangles asked for.
    pub target: Option<usize>,
    /// Triangles reached.
    pub output: usize,
    /// Why it stopped.
    pub stop: &'static str,
    /// Error reached, model units.
    pub error: f64,
    /// The file.
    pub file: PathBuf,
}

/// Seconds of wall time per step.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct SimplifySeconds {
    /// Reading and checking the file.
    pub read: f64,
    /// Measuring visibility.
    pub visibility: f64,
    /// Collapsing.
    pub simplify: f64,
    /// Writing.
    pub write: f64,
    /// All of it.
    pub total: f64,
}

/// Reads a mesh, looks at it, simplifies it, writes every level.
///
/// # Errors
/// As its steps.
pub fn run_simplify(_request: &SimplifyRequest, _observer: &dyn Observer) -> Result<SimplifyReport> {
    Err(to_come())
}

/// What [`compare_files`] does.
#[derive(Debug, Clone)]
pub struct CompareRequest {
    /// What the others are compared with.
    pub reference: PathBuf,
    /// The others.
    pub tests: Vec<PathBuf>,
    /// How they are read.
    pub read: ReadOptions,
    /// Samples on each mesh for the geometric error; `None` chooses.
    pub samples: Option<usize>,
    /// Seed of the samples.
    pub seed: u64,
    /// Contact sheet to write.
    pub sheet: Option<PathBuf>,
    /// Replace a sheet that is there.
    pub force: bool,
}

/// Result of [`compare_files`].
#[derive(Debug, Clone, Serialize)]
pub struct CompareReport {
    /// One entry per test.
    pub tests: Vec<TestReport>,
}

/// How one test differs from the reference.
#[derive(Debug, Clone, Serialize)]
pub struct TestReport {
    /// The file.
    pub file: PathBuf,
    /// Its triangles.
    pub triangles: usize,
    /// Square root of the summed squared grey differences.
    pub image_rms: f64,
    /// The same per pixel, grey levels.
    pub image_rmse: f64,
    /// Pixels per camera in one silhouette only.
    pub silhouette_xor: f64,
    /// Distances in % of the diagonal.
    pub geometric: GeometricReport,
}

/// Two-sided distances in % of the reference's diagonal.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct GeometricReport {
    /// Mean.
    pub mean: f64,
    /// Root mean square.
    pub rms: f64,
    /// Largest.
    pub max: f64,
}

/// Compares meshes with a reference.
///
/// # Errors
/// As its steps.
pub fn compare_files(_request: &CompareRequest, _observer: &dyn Observer) -> Result<CompareReport> {
    Err(to_come())
}

/// How a picture is coloured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Style {
    /// Head light on flat triangles.
    #[default]
    Flat,
    /// Visibility as heat colours.
    Heat,
}

/// What [`render_file`] does.
#[derive(Debug, Clone)]
pub struct RenderRequest {
    /// The mesh.
    pub input: PathBuf,
    /// How it is read.
    pub read: ReadOptions,
    /// The picture.
    pub output: PathBuf,
    /// How it is coloured.
    pub style: Style,
    /// From the mesh toward the camera, any length but 0.
    pub camera: [f64; 3],
    /// Pixels along the side.
    pub size: u32,
    /// Heat colours.
    pub colour_map: ColourMap,
    /// Draw the colour scale beside the picture.
    pub legend: bool,
    /// How visibility is measured for heat colours.
    pub measure: MeasureOptions,
    /// Replace a picture that is there.
    pub force: bool,
}

/// Draws a mesh.
///
/// # Errors
/// As its steps.
pub fn render_file(_request: &RenderRequest, _observer: &dyn Observer) -> Result<()> {
    Err(to_come())
}

fn to_come() -> Error {
    Error::Unavailable { message: "to come".to_owned() }
}
