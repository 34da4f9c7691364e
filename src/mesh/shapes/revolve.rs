//! Surfaces of revolution about the z axis.

use glam::{DVec2, DVec3};

use super::builder::Builder;
use crate::mesh::TriMesh;

/// Turns a polyline of (radius, height) points about the z axis, in `segments` steps.
///
/// The front side lies to the right of the polyline's direction, so a section that rises faces away from the axis,
/// and a
/// closed counter-clockwise section gives an outward solid.
pub(super) fn revolve(section: &[DVec2], segments: usize) -> TriMesh {
    let mut builder = Builder::default();
    let rings: Vec<Vec<DVec3>> = section.iter().map(|&p| ring(p, segments)).collect();
    for pair in rings.windows(2) {
        builder.band(&pair[0], &pair[1]);
    }
    builder.finish()
}

/// [`revolve`] of a section whose last point is joined to its first.
pub(super) fn revolve_closed(section: &[DVec2], segments: usize) -> TriMesh {
    let closed: Vec<DVec2> = section.iter().chain(section.first()).copied().collect();
    revolve(&closed, segments)
}

/// The circle that a section point describes; one point on the axis.
fn ring(p: DVec2, segments: usize) -> Vec<DVec3> {
    if p.x == 0.0 {
        return vec![DVec3::new(0.0, 0.0, p.y)];
    }
    (0..segments).map(|i| (direction(turn(i, segments)) * p.x).extend(p.y)).collect()
}

/// Angle of step `i` of `n` in a full turn, in radians.
pub(super) fn turn(i: usize, n: usize) -> f64 {
    std::f64::consts::TAU * i as f64 / n as f64
}

/// Unit vector at an angle.
pub(super) fn direction(angle_rad: f64) -> DVec2 {
    DVec2::new(libm::cos(angle_rad), libm::sin(angle_rad))
}

/// `steps` + 1 points of an arc round `centre`, from one angle to another, both in radians.
pub(super) fn arc(centre: DVec2, radius: f64, [from, to]: [f64; 2], steps: usize) -> Vec<DVec2> {
    let at = |i: usize| from + (to - from) * i as f64 / steps as f64;
    (0..=steps).map(|i| centre + direction(at(i)) * radius).collect()
}
