use std::path::PathBuf;

use serde::Serialize;

use crate::camera::{CameraSphere, Window};
use crate::error::{Error, Result};
use crate::io::{self, Loaded, ReadOptions};
use crate::mesh::TriangleId;
use crate::pipeline::Observer;
use crate::raster::Side;
use crate::visibility::{CameraSight, Explanation, MeasureOptions, Sight, explain};

/// What [`explain_file`] does.
#[derive(Debug, Clone)]
pub struct ExplainRequest {
    /// The mesh.
    pub input: PathBuf,
    /// How it is read.
    pub read: ReadOptions,
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
#[derive(Debug, Clone, Copy, Serialize)]
pub struct BlockerReport {
    /// Its number.
    pub triangle: usize,
    /// How many cameras it blocks.
    pub cameras: usize,
}

/// What one camera makes of the triangle.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct SightReport {
    /// Number of the camera.
    pub camera: u32,
    /// Unit vector from the mesh toward it.
    pub direction: [f64; 3],
    /// `seen`, `too_small`, `blocked` or `behind`.
    pub sight: &'static str,
    /// The triangle in the way.
    pub blocked_by: Option<usize>,
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
    let loaded = io::read(&request.input, &request.read)?;
    observer.mesh_read(&request.input, &loaded)?;
    let order = loaded.file_order();
    let triangle = find(request, &order, &loaded)?;
    let cameras = request.measure.camera_sphere()?;
    let resolution = request.measure.resolution_for(loaded.mesh.triangle_count());
    let window = Window::around_sphere(resolution);
    let found = explain(&loaded.mesh, (triangle, request.side), &cameras, window)
        .ok_or_else(|| unseeable(request, "is smaller than 1e-14 of the squared radius of the mesh"))?;
    observer.check()?;
    let in_file = (0..).zip(&order).filter(|(_, id)| id.is_some()).map(|(t, _)| t).collect::<Vec<usize>>();
    Ok(ExplainReport { triangle: request.triangle, resolution, ..report(&found, &cameras, &in_file, request.side) })
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

/// `in_file` has the number in the file of each triangle of the mesh.
fn report(found: &Explanation, cameras: &CameraSphere, in_file: &[usize], side: Side) -> ExplainReport {
    let count = |sight: &str| found.cameras.iter().filter(|answer| name(answer.sight) == sight).count();
    let blocker = |&(id, cameras): &(TriangleId, usize)| BlockerReport { triangle: in_file[id.0 as usize], cameras };
    let camera = |answer: &CameraSight| SightReport {
        camera: answer.camera,
        direction: cameras.directions()[answer.camera as usize].to_array(),
        sight: name(answer.sight),
        blocked_by: if let Sight::Blocked(id) = answer.sight { Some(in_file[id.0 as usize]) } else { None },
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
