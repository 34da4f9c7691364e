//! Geometry of points, single triangles and boxes, without any notion of a mesh.

mod bounds;
mod dodecahedron;
mod morton;
mod octahedron;

pub use bounds::Aabb;
pub use dodecahedron::dodecahedron_axes;
pub use morton::morton_code;
pub use octahedron::OctahedralSphere;

use glam::DVec3;

/// Twice the area of triangle `abc` times its unit normal; zero where the triangle has no area.
#[must_use]
pub fn area_vector_doubled([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// Area of a triangle, in units of its corners squared.
#[must_use]
pub fn triangle_area(corners: [DVec3; 3]) -> f64 {
    0.5 * area_vector_doubled(corners).length()
}

/// Unit normal by the right-hand rule, `None` where the triangle has no area.
#[must_use]
pub fn triangle_normal(corners: [DVec3; 3]) -> Option<DVec3> {
    area_vector_doubled(corners).try_normalize()
}
