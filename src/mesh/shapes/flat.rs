//! Solids and sheets with flat faces.

use glam::DVec3;

use super::builder::Builder;
use crate::mesh::TriMesh;

/// Regular tetrahedron with corners on four corners of the cube from −1 to 1.
#[must_use]
pub fn tetrahedron() -> TriMesh {
    let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]].map(DVec3::from);
    let triangles = vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
    TriMesh::new(corners.to_vec(), triangles).expect("the four corners differ")
}

/// Box around the origin with the given edge lengths, each side cut into `n` × `n` squares of two triangles (`n` ≥ 1).
#[must_use]
pub fn cuboid(edges: DVec3, n: usize) -> TriMesh {
    let n = n.max(1);
    let mut builder = Builder::default();
    for [a, b, c, d] in cuboid_sides(-0.5 * edges, 0.5 * edges) {
        builder.patch([a, b, c, d], [n, n]);
    }
    builder.finish()
}

/// The six sides of a box in the order −z +z −y +y −x +x, each counter-clockwise from outside.
pub(super) fn cuboid_sides(min: DVec3, max: DVec3) -> [[DVec3; 4]; 6] {
    // Corner number = x + 2y + 4z, with 0 for the small and 1 for the large coordinate.
    let corner = |i: usize| {
        let pick = |bit: usize, small: f64, large: f64| if i >> bit & 1 == 1 { large } else { small };
        DVec3::new(pick(0, min.x, max.x), pick(1, min.y, max.y), pick(2, min.z, max.z))
    };
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]].map(|side| side.map(corner))
}

/// Rectangle around the origin in the plane z = 0, facing +z, cut into `n` × `m` cells of two triangles (both ≥ 1).
#[must_use]
pub fn sheet(width: f64, height: f64, [n, m]: [usize; 2]) -> TriMesh {
    let mut builder = Builder::default();
    let corner = DVec3::new(-0.5 * width, -0.5 * height, 0.0);
    builder.sheet(corner, [DVec3::X * width, DVec3::Y * height], [n.max(1), m.max(1)]);
    builder.finish()
}
