use std::path::PathBuf;

use serde::Serialize;

use crate::camera::{CameraSphere, Window};
use crate::error::{Error, Result};
use crate::io::{self, Loaded, ReadOptions};
use crate::mesh::TriangleId;
use crate::pipeline::Observer;
use crate::pipeline::observation::Surrounded;
use crate::pipeline::surroundings::Surroundings;
use crate::raster::Side;
use crate::visibility::{CameraSight, Explaining, Explanation, MeasureOptions, Sight, explain};

/// What [`explain_file`] does.
#[derive(Debug, Clone)]
pub struct ExplainRequest {
    /// The mesh.
    pub input: PathBuf,
    /// How it is read.
    pub read: ReadOptions,
    /// Meshes in the same coordinates that may be in the way.
    pub occluders: Vec<PathBuf>,
    /// The triangle, numbered as in the file from 0.
    pub triangle: usize,
    /// The side to explain.
    pub side: Side,
    /// Which cameras look, and at how many pixels.
    pub measure: MeasureOptions,
}

/// Result of [`explain_file`]; triangles are numbered as in the file.
#[derive(Debug, Clone, Serialize)]
pub struct ExplainReport {
    /// The triangle.
    pub triangle: usize,
    /// `front` or `back`.
    pub side: &'static str,
    /// V of that side, from rays.
    pub visibility: f64,
    /// Cameras that see it.
    pub seen: usize,
    /// Cameras that nothing blocks, to which it is smaller than a pixel.
    pub too_small: usize,
    /// Cameras that see none of its points.
    pub blocked: usize,
    /// Cameras behind its plane, or edge-on.
    pub behind: usize,
    /// Triangles in the way, the one that blocks most cameras first.
    pub blockers: Vec<BlockerReport>,
    /// One entry per camera.
    pub cameras: Vec<SightReport>,
    /// Pixels along an image's side that `pixels` and `too_small` count by.
    pub resolution: u32,
}

/// A triangle in the way.
#[derive(Debug, Clone, Serialize)]
pub struct BlockerReport {
    /// Its number.
    pub triangle: usize,
    /// How many cameras it blocks.
    pub cameras: usize,
    /// The file, where it is a triangle of an occluder.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub occluder: Option<PathBuf>,
}

/// What one camera makes of the triangle.
#[derive(Debug, Clone, Serialize)]
pub struct SightReport {
    /// Number of the camera.
    pub camera: u32,
    /// Unit vector from the mesh toward it.
    pub direction: [f64; 3],
    /// `seen`, `too_small`, `blocked` or `behind`.
    pub sight: &'static str,
    /// The triangle in the way.
    pub blocked_by: Option<usize>,
    /// Its file, where it is a triangle of an occluder.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub occluder: Option<PathBuf>,
    /// Share of the triangle's points that it sees.
    pub share: f64,
    /// Between the direction and the side's normal.
    pub cosine: f64,
    /// Size of the whole triangle's image.
    pub pixels: f64,
}

/// Reads a mesh and says for each camera whether it sees a triangle, and what is in the way if not.
///
/// # Errors
/// As its steps; [`Error::Option`] for a triangle that the file does not have, [`Error::Parse`] for one that nobody can see.
pub fn explain_file(request: &ExplainRequest, observer: &dyn Observer) -> Result<ExplainReport> {
    request.measure.check()?;
    let occluders = Surroundings::read(&request.occluders, &request.read)?;
    let loaded = io::read(&request.input, &request.read)?;
    observer.mesh_read(&request.input, &loaded)?;
    let order = loaded.file_order();
    let triangle = find(request, &order, &loaded)?;
    let cameras = request.measure.camera_sphere()?;
    let resolution = request.measure.resolution_for(loaded.mesh.triangle_count());
    let window = Window::around_sphere(resolution);
    let Surrounded { mesh, occluders: around } = occluders.around(&loaded.mesh)?;
    let scene = Explaining { mesh, occluders: around, cameras: &cameras, window, progress: observer };
    let found = explain(scene, triangle, request.side)?
        .ok_or_else(|| unseeable(request, "is smaller than 1e-14 of the squared radius of the mesh"))?;
    let numbers = Numbers { in_file: loaded.numbers_in_file(), occluders: &occluders };
    Ok(ExplainReport { triangle: request.triangle, resolution, ..report(&found, &cameras, &numbers, request.side) })
}

/// The number in the mesh of the triangle that was asked for.
fn find(request: &ExplainRequest, order: &[Option<TriangleId>], loaded: &Loaded) -> Result<TriangleId> {
    let asked = order.get(request.triangle).ok_or_else(|| Error::Option {
        name: "TRIANGLE",
        message: format!(
            "{} is no triangle of {}, which has 0 to {}",
            request.triangle,
            request.input.display(),
            order.len() - 1
        ),
    })?;
    let repeats = loaded.set_aside.repeated_vertex.iter().any(|&t| t as usize == request.triangle);
    asked.ok_or_else(|| unseeable(request, if repeats { "repeats a vertex" } else { "has no area" }))
}

fn unseeable(request: &ExplainRequest, why: &str) -> Error {
    let message = format!("triangle {} {why}: no camera can see it; name another", request.triangle);
    Error::Parse { place: request.input.display().to_string(), message }
}

/// Where the triangles that are in the way come from.
struct Numbers<'a> {
    /// For each triangle of the mesh its number in the file.
    in_file: Vec<usize>,
    occluders: &'a Surroundings,
}

impl Numbers<'_> {
    /// A triangle's number in its file, and the file if it is an occluder's.
    fn of(&self, id: TriangleId) -> (usize, Option<PathBuf>) {
        let number = id.0 as usize;
        match self.in_file.get(number) {
            Some(&number) => (number, None),
            None => {
                let found = self.occluders.find(number - self.in_file.len());
                let (file, number) = found.expect("only triangles of the mesh and of its occluders are in the way");
                (number, Some(file.to_owned()))
            }
        }
    }
}

fn report(found: &Explanation, cameras: &CameraSphere, numbers: &Numbers<'_>, side: Side) -> ExplainReport {
    let count = |sight: &str| found.cameras.iter().filter(|answer| name(answer.sight) == sight).count();
    let blocker = |&(id, cameras): &(TriangleId, usize)| {
        let (triangle, occluder) = numbers.of(id);
        BlockerReport { triangle, cameras, occluder }
    };
    let blocked_by = |sight| if let Sight::Blocked(id) = sight { Some(numbers.of(id)) } else { None };
    let camera = |answer: &CameraSight| SightReport {
        camera: answer.camera,
        direction: cameras.directions()[answer.camera as usize].to_array(),
        sight: name(answer.sight),
        blocked_by: blocked_by(answer.sight).map(|(triangle, _)| triangle),
        occluder: blocked_by(answer.sight).and_then(|(_, file)| file),
        share: answer.share,
        cosine: answer.cosine,
        pixels: answer.pixels,
    };
    ExplainReport {
        triangle: 0,
        side: if side == Side::Front { "front" } else { "back" },
        visibility: found.visibility,
        seen: count("seen"),
        too_small: count("too_small"),
        blocked: count("blocked"),
        behind: count("behind"),
        blockers: found.blockers.iter().map(blocker).collect(),
        cameras: found.cameras.iter().map(camera).collect(),
        resolution: 0,
    }
}

fn name(sight: Sight) -> &'static str {
    match sight {
        Sight::Seen => "seen",
        Sight::TooSmall => "too_small",
        Sight::Blocked(_) => "blocked",
        Sight::Behind => "behind",
    }
}
