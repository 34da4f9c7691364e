use glam::DVec3;
use rayon::prelude::*;

use super::ReferenceSurface;
use crate::geom::{triangle_area, triangle_normal};
use crate::mesh::{TriMesh, TriangleId};

/// Distances that differ by less than this share of the reference's box are alike: some rounding of files in `f32`.
const FLIP_SLACK: f64 = 1e-6;

/// Result of [`ReferenceSurface::flipped`].
pub(in crate::eval) struct Flipped {
    pub(in crate::eval) triangles: usize,
    /// Share of the test's area, 0 to 1.
    pub(in crate::eval) area: f64,
}

impl ReferenceSurface<'_> {
    /// Triangles of `test` that are turned over: their share of its area, and how many they are.
    ///
    /// A triangle is turned over if the surface of the reference that is nearest to its centroid faces against it. Where
    /// several triangles are as near, to [`FLIP_SLACK`], one of them that faces the same way is enough.
    pub(in crate::eval) fn flipped(&self, test: &TriMesh) -> Flipped {
        let flipped_area = |corners: [DVec3; 3]| {
            let corners = corners.map(|p| self.frame.to_cube(p));
            let normal = triangle_normal(corners)?;
            let centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
            let distance = self.tree.nearest(centroid, 0).distance_squared.sqrt();
            let facing = self.tree.facing(centroid, normal, distance + FLIP_SLACK);
            (facing.against && !facing.same_way).then(|| triangle_area(corners))
        };
        let corners = |t: u32| test.corners(TriangleId(t));
        let count = test.triangle_count() as u32;
        let areas: Vec<Option<f64>> = (0..count).into_par_iter().map(|t| flipped_area(corners(t))).collect();
        let whole: f64 = (0..count).map(|t| triangle_area(corners(t).map(|p| self.frame.to_cube(p)))).sum();
        // Not `sum`, which gives -0 for nothing.
        let flipped = areas.iter().flatten().fold(0.0, |sum, area| sum + area);
        Flipped { triangles: areas.iter().flatten().count(), area: if whole > 0.0 { flipped / whole } else { 0.0 } }
    }
}
