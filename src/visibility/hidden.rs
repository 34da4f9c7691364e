use rayon::prelude::*;

use crate::mesh::{TriMesh, TriangleId, VertexTriangles};
use crate::visibility::Visibility;

/// Rings of neighbours that must be hidden as well: they guard against what falls between cameras and pixels.
const GUARD_RINGS: usize = 2;

/// Marks the triangles that can go without anyone seeing it: no camera sees them or any triangle within two rings.
///
/// One entry per triangle of `mesh`, which must be the mesh that was measured.
#[must_use]
pub fn hidden_triangles(mesh: &TriMesh, visibility: &Visibility) -> Vec<bool> {
    let seen = visibility.seen();
    if seen.iter().all(|&s| s) {
        return vec![false; seen.len()];
    }
    let neighbours = VertexTriangles::of(mesh);
    let hidden = |t: u32| neighbours.all_within(mesh, TriangleId(t), GUARD_RINGS, |n| !seen[n as usize]);
    (0..mesh.triangle_count() as u32).into_par_iter().map(hidden).collect()
}
