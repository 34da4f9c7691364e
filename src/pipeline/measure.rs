use std::path::{Path, PathBuf};

use serde::Serialize;

use super::{Observer, Stopwatch, as_progress, dropped_names, read};
use crate::camera::{CameraSphere, Frame};
use crate::error::{Error, Result};
use crate::io::{self, Format, ReadOptions, TriangleAttributes, WriteOptions};
use crate::mesh::TriMesh;
use crate::raster::Scene;
use crate::report::colour::ColourMap;
use crate::visibility::{self, MeasureOptions, Visibility};

/// What [`measure_file`] does.
#[derive(Debug, Clone)]
pub struct MeasureRequest {
    /// The mesh.
    pub input: PathBuf,
    /// How it is read.
    pub read: ReadOptions,
    /// How it is looked at.
    pub measure: MeasureOptions,
    /// `.ply`, `.npy` or `.csv` to write.
    pub output: Option<PathBuf>,
    /// Colours of a `.ply` output.
    pub colour_map: ColourMap,
    /// Replace an output that is there.
    pub force: bool,
}

/// What [`measure_file`] found; its fields are the keys of the JSON object.
#[derive(Debug, Clone, Serialize)]
pub struct MeasureReport {
    /// Triangles looked at.
    pub triangles: usize,
    /// Cameras that looked.
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
    /// The mesh file.
    pub file: PathBuf,
    /// Which side of a triangle counted for `mesh_sides`.
    pub sides: &'static str,
    /// Triangles of the file that were set aside.
    pub set_aside: usize,
    /// What the file held beyond triangles.
    pub dropped: Vec<&'static str>,
}

/// Visibility of a whole mesh.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct VisibilitySummary {
    /// One-sided, area-weighted, unclamped. Source: Zhang & Turk 2002, eq. (3.2).
    pub mesh: f64,
    /// The same under the rule for sides.
    pub mesh_sides: f64,
    /// Triangles that no camera sees from either side.
    pub never_seen: usize,
}

/// Wall time of each step, in seconds.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct MeasureSeconds {
    /// Reading and checking the file.
    pub read: f64,
    /// Preparing the mesh for the cameras.
    pub build: f64,
    /// Looking and counting.
    pub visibility: f64,
    /// All of it, writing included.
    pub total: f64,
}

impl VisibilitySummary {
    pub(super) fn of(visibility: &Visibility) -> Self {
        Self { mesh: visibility.of_mesh(), mesh_sides: visibility.of_mesh_sides(), never_seen: visibility.never_seen() }
    }
}

/// Reads a mesh, measures it, and writes the visibility of each triangle where asked.
///
/// # Errors
/// Those of reading, measuring and writing, and of the observer.
pub fn measure_file(request: &MeasureRequest, observer: &dyn Observer) -> Result<MeasureReport> {
    let mut clock = Stopwatch::start();
    let mut seconds = MeasureSeconds::default();
    request.measure.check()?;

    let loaded = read(&request.input, &request.read, observer)?;
    seconds.read = clock.lap_s();

    let mesh = &loaded.mesh;
    let cameras = CameraSphere::octahedral(request.measure.cameras, request.measure.camera_weights)?;
    let scene = Scene::new(Frame::of(mesh).unit_copy(mesh));
    seconds.build = clock.lap_s();

    let visibility = visibility::measure_with(&scene, mesh, &cameras, &request.measure, as_progress(observer))?;
    seconds.visibility = clock.lap_s();

    if let Some(output) = &request.output {
        write(output, mesh, &visibility, request)?;
    }
    seconds.total = clock.total_s();
    Ok(MeasureReport {
        triangles: mesh.triangle_count(),
        cameras: visibility.cameras(),
        resolution: visibility.resolution(),
        backend: request.measure.backend.name(),
        estimator: request.measure.estimator.name(),
        visibility: VisibilitySummary::of(&visibility),
        seconds,
        file: request.input.clone(),
        sides: request.measure.sides.name(),
        set_aside: loaded.set_aside.count(),
        dropped: dropped_names(&loaded),
    })
}

/// Writes the visibility of each triangle in the format that the name says.
fn write(path: &Path, mesh: &TriMesh, visibility: &Visibility, request: &MeasureRequest) -> Result<()> {
    let values = visibility.per_triangle();
    match ending(path).as_str() {
        "npy" => io::write_npy_f64(path, values, request.force),
        "csv" => {
            let columns = [("visibility", values), ("front", visibility.front()), ("back", visibility.back())];
            io::write_visibility_csv(path, &columns, request.force)
        }
        _ if Format::of_path(path) == Some(Format::Ply) => {
            let colours: Vec<[u8; 3]> = values.iter().map(|&v| request.colour_map.colour(v)).collect();
            let attributes = TriangleAttributes { visibility: Some(values), colours: Some(&colours) };
            io::write(path, mesh, &attributes, &WriteOptions { force: request.force, format: None })
        }
        _ => {
            let message = format!("{}: name a file that ends in .ply, .npy or .csv", path.display());
            Err(Error::Option { name: "--output", message })
        }
    }
}

/// The lower-case extension, that of compression put aside.
fn ending(path: &Path) -> String {
    let lower = |p: &Path| p.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    match lower(path).as_str() {
        "gz" | "zst" => lower(&path.with_extension("")),
        own => own.to_owned(),
    }
}
