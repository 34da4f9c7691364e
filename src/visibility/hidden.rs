use glam::{DMat3, DQuat};
use rayon::prelude::*;

use crate::backend::ItemBuffers;
use crate::camera::{CameraSphere, CameraWeights, Window};
use crate::error::Result;
use crate::mesh::{TriMesh, TriangleId, VertexTriangles};
use crate::progress::Progress;
use crate::raster::Side;
use crate::visibility::{CoverageCounts, MeasureOptions, Visibility};

/// Rings of neighbours that must be hidden as well: they guard against what falls between cameras and pixels.
const GUARD_RINGS: usize = 2;

/// Cameras of the second look. On an assembly seen through narrow slits, 66 at twice the resolution halve what the first
/// look missed, for half its time; the same at the first resolution catch a third as many triangles.
const SECOND_LOOK_CAMERAS: usize = 66;

/// Marks the triangles that can go without anyone seeing it, one entry per triangle of the measured mesh.
///
/// A triangle is marked if no camera sees it nor any triangle within two rings of it. A second look from other
/// directions, at twice the resolution, then takes back whatever it sees, with its neighbours.
///
/// # Errors
/// As [`super::measure`].
pub fn hidden_triangles<B: ItemBuffers>(
    backend: &B,
    mesh: &TriMesh,
    visibility: &Visibility,
    options: &MeasureOptions,
    progress: &dyn Progress,
) -> Result<Vec<bool>> {
    let seen = visibility.seen();
    if seen.iter().all(|&s| s) {
        return Ok(vec![false; seen.len()]);
    }
    let neighbours = VertexTriangles::of(mesh);
    let unseen = |t: u32| neighbours.all_within(mesh, TriangleId(t), GUARD_RINGS, |n| !seen[n as usize]);
    let mut hidden: Vec<bool> = (0..seen.len() as u32).into_par_iter().map(unseen).collect();
    if hidden.iter().any(|&h| h) {
        let window = Window::around_sphere((2 * visibility.resolution()).min(16384));
        let cameras = second_look()?;
        let counts = CoverageCounts::of(backend, seen.len(), &cameras, window, options.memory_limit, progress)?;
        take_back(&counts, mesh, &neighbours, &mut hidden);
    }
    Ok(hidden)
}

/// Cameras turned away from the first look's.
fn second_look() -> Result<CameraSphere> {
    // A rotation with rational entries: no sine, no cosine, the same on every machine.
    let rotation = DMat3::from_quat(DQuat::from_xyzw(1.0, 2.0, 3.0, 4.0).normalize());
    Ok(CameraSphere::octahedral(SECOND_LOOK_CAMERAS, CameraWeights::Equal)?.rotated(rotation))
}

fn take_back(counts: &CoverageCounts, mesh: &TriMesh, neighbours: &VertexTriangles, hidden: &mut [bool]) {
    let seen = |t: usize| counts.seen(t, Side::Front) + counts.seen(t, Side::Back) > 0;
    let caught: Vec<usize> = (0..hidden.len()).filter(|&t| hidden[t] && seen(t)).collect();
    for t in caught {
        for &v in &mesh.triangles()[t] {
            neighbours.around(v).iter().for_each(|&n| hidden[n as usize] = false);
        }
    }
}
