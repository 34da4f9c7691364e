//! Spheres and what is made by bending them, tori, discs.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DAffine3, DVec2, DVec3};

use super::builder::Builder;
use super::revolve::{arc, direction, revolve, turn};
use super::transformed;
use crate::mesh::TriMesh;

/// Sphere of radius 1 from an icosahedron whose triangles are cut in four `subdivisions` times: 20·4^k triangles.
#[must_use]
pub fn icosphere(subdivisions: u32) -> TriMesh {
    let mut triangles = icosahedron();
    for _ in 0..subdivisions {
        triangles = triangles.iter().flat_map(|&t| quartered(t)).collect();
    }
    let mut builder = Builder::default();
    triangles.into_iter().for_each(|t| builder.triangle(t));
    builder.finish()
}

fn icosahedron() -> Vec<[DVec3; 3]> {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let corner = |i: usize| {
        // Twelve corners: (0, ±1, ±φ) and its cyclic turns.
        let (a, b) = (if i & 1 == 0 { 1.0 } else { -1.0 }, if i & 2 == 0 { golden } else { -golden });
        let p = [DVec3::new(0.0, a, b), DVec3::new(b, 0.0, a), DVec3::new(a, b, 0.0)][i / 4];
        p.normalize()
    };
    let neighbours = |i: usize, j: usize| corner(i).dot(corner(j)) > 0.4;
    let mut triangles = Vec::with_capacity(20);
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if neighbours(i, j) && neighbours(j, k) && neighbours(i, k) {
                    triangles.push(outward([corner(i), corner(j), corner(k)]));
                }
            }
        }
    }
    triangles
}

/// The triangle turned so that it faces away from the origin.
fn outward([a, b, c]: [DVec3; 3]) -> [DVec3; 3] {
    if (b - a).cross(c - a).dot(a) > 0.0 { [a, b, c] } else { [a, c, b] }
}

/// Four triangles of a spherical triangle, new corners pushed out to radius 1.
fn quartered([a, b, c]: [DVec3; 3]) -> [[DVec3; 3]; 4] {
    let middle = |p: DVec3, q: DVec3| (p + q).normalize();
    let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}

/// Sphere of radius 1 in `segments` (≥ 3) meridians and `rings` (≥ 2) belts of latitude.
#[must_use]
pub fn uv_sphere(segments: usize, rings: usize) -> TriMesh {
    revolve(&meridian([-FRAC_PI_2, FRAC_PI_2], rings.max(2)), segments.max(3))
}

/// Points of the unit circle between two latitudes, exactly on the axis at the poles.
pub(super) fn meridian(latitudes_rad: [f64; 2], steps: usize) -> Vec<DVec2> {
    let mut points = arc(DVec2::ZERO, 1.0, latitudes_rad, steps);
    for p in &mut points {
        if p.x.abs() < 1e-12 {
            *p = DVec2::new(0.0, p.y.signum());
        }
    }
    points
}

/// Ellipsoid with the given half axes (> 0), tessellated like [`uv_sphere`].
#[must_use]
pub fn ellipsoid(half_axes: DVec3, segments: usize, rings: usize) -> TriMesh {
    transformed(&uv_sphere(segments, rings), &DAffine3::from_scale(half_axes))
        .expect("half axes are finite lengths of a test piece")
}

/// Torus about the z axis: tube of radius `tube` round a circle of radius `ring`, `segments` × `sides` quads (≥ 3
/// each).
#[must_use]
pub fn torus(ring: f64, tube: f64, segments: usize, sides: usize) -> TriMesh {
    let sides = sides.max(3);
    let section: Vec<DVec2> = (0..sides).map(|i| DVec2::new(ring, 0.0) + direction(turn(i, sides)) * tube).collect();
    super::revolve::revolve_closed(&section, segments.max(3))
}

/// Flat disc round the origin in the plane z = 0, facing +z, in `segments` (≥ 3) sectors and `rings` (≥ 1) rings.
#[must_use]
pub fn disc(radius: f64, segments: usize, rings: usize) -> TriMesh {
    let rings = rings.max(1);
    let section: Vec<DVec2> = (0..=rings).rev().map(|i| DVec2::new(radius * i as f64 / rings as f64, 0.0)).collect();
    revolve(&section, segments.max(3))
}

/// Sphere whose radius goes up and down by `amplitude` (< 1) in smooth bumps, 20·4^`subdivisions` triangles.
///
/// The radius is 1 + amplitude · sin 7x · sin 7y · sin 7z at the direction (x, y, z).
#[must_use]
pub fn bumpy_sphere(subdivisions: u32, amplitude: f64) -> TriMesh {
    let wave = |c: f64| libm::sin(7.0 * c);
    let (positions, triangles) = icosphere(subdivisions).into_parts();
    let bent = positions.iter().map(|&p| p * (1.0 + amplitude * wave(p.x) * wave(p.y) * wave(p.z))).collect();
    TriMesh::new(bent, triangles).expect("moving vertices along their own directions keeps the mesh valid")
}

/// Latitude of a plane that cuts the unit sphere at an angle from the pole, both in radians.
pub(super) fn latitude_below_pole(angle_rad: f64) -> f64 {
    0.5 * PI - angle_rad
}
