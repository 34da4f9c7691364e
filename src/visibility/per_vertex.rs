use crate::camera::Frame;
use crate::mesh::TriMesh;
use crate::visibility::Shapes;

/// Mean of a value over the triangles around each vertex, by area; one entry per vertex, 0 where no triangle has an area.
///
/// `per_triangle` has one entry per triangle of `mesh`. Sums run in the order of the triangles.
#[must_use]
pub fn per_vertex(mesh: &TriMesh, per_triangle: &[f64]) -> Vec<f64> {
    // Areas in the unit sphere: those of very small or large models would leave the range of numbers.
    let shapes = Shapes::of(mesh, &Frame::of(mesh));
    let mut sums = vec![(0.0, 0.0); mesh.vertex_count()];
    for ((corners, &area), &value) in mesh.triangles().iter().zip(&shapes.areas).zip(per_triangle) {
        for &vertex in corners {
            let (weighted, areas) = &mut sums[vertex as usize];
            *weighted += area * value;
            *areas += area;
        }
    }
    sums.into_iter().map(|(weighted, areas)| if areas > 0.0 { weighted / areas } else { 0.0 }).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use glam::DVec3;

    use super::*;

    /// Two triangles of areas 1 and 3 on a common edge, and a vertex that no triangle uses.
    ///
    /// ```text
    ///   2
    ///   | \
    ///   0--1
    ///    \ |   triangle 1 reaches three times as deep as triangle 0 is high
    ///      3
    /// ```
    #[test]
    fn larger_triangles_count_by_their_area_and_loose_vertices_get_0() {
        let corners = [[0., 0., 0.], [2., 0., 0.], [0., 1., 0.], [2., -3., 0.], [9., 9., 9.]];
        let mesh = TriMesh::new(corners.map(DVec3::from).to_vec(), vec![[0, 1, 2], [1, 0, 3]]).unwrap();
        let values = per_vertex(&mesh, &[1.0, 0.2]);
        let shared = (1.0 + 3.0 * 0.2) / 4.0;
        for (value, wanted) in values.iter().zip([shared, shared, 1.0, 0.2, 0.0]) {
            assert!((value - wanted).abs() < 1e-12, "{values:?}");
        }
    }
}
