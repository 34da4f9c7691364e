use serde::{Deserialize, Serialize};

use super::geometric::ReferenceSurface;
use crate::camera::Frame;
use crate::mesh::adjacency::{CornerLists, Edges, TopologyCounts};
use crate::mesh::{TriMesh, TriangleId};

/// What is wrong with the triangles of a mesh that should look like the reference.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct TriangleQuality {
    /// Triangles that are turned over: the surface of the reference nearest to their centroid faces against them. Where
    /// several of its triangles are as near, none of them faces the same way.
    pub flipped: usize,
    /// Their share of the area, 0 to 1.
    pub flipped_area: f64,
    /// Triangles too small or too thin to be drawn: area below 10⁻¹⁴ of the reference's squared radius.
    pub degenerate: usize,
    /// Edges with three or more triangles.
    pub non_manifold_edges: usize,
    /// How many more of them there are than in the reference; 0 if there are fewer.
    pub new_non_manifold_edges: usize,
}

impl TriangleQuality {
    /// Of `test`, against a reference with this surface, frame, and number of non-manifold edges.
    pub(super) fn of(test: &TriMesh, surface: &ReferenceSurface, frame: &Frame, reference_edges: usize) -> Self {
        let flipped = surface.flipped(test);
        let triangles = (0..test.triangle_count() as u32).map(TriangleId);
        let edges = non_manifold_edges(test);
        Self {
            flipped: flipped.triangles,
            flipped_area: flipped.area,
            degenerate: triangles.filter(|&t| frame.area_and_normal(test, t).is_none()).count(),
            non_manifold_edges: edges,
            new_non_manifold_edges: edges.saturating_sub(reference_edges),
        }
    }
}

/// Edges with three or more triangles.
pub(super) fn non_manifold_edges(mesh: &TriMesh) -> usize {
    let lists = CornerLists::of(mesh);
    TopologyCounts::of(mesh, &lists, &Edges::of(mesh, &lists)).non_manifold_edges
}
