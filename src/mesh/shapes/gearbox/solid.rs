//! Closed solids and where to put them.

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::super::builder::{Builder, at_height};
use super::super::revolve::{direction, revolve_closed, turn};
use crate::mesh::TriMesh;

/// An outline with holes, pulled up from one height to another.
pub(super) fn extrude(outline: &[DVec2], holes: &[Vec<DVec2>], [low, high]: [f64; 2]) -> TriMesh {
    let mut builder = Builder::default();
    let loops = |z: f64| -> Vec<Vec<DVec3>> { holes.iter().map(|hole| at_height(hole, z)).collect() };
    builder.polygon(&at_height(outline, low), &loops(low), DVec3::NEG_Z);
    builder.polygon(&at_height(outline, high), &loops(high), DVec3::Z);
    builder.band(&at_height(outline, low), &at_height(outline, high));
    for hole in holes {
        builder.band(&at_height(hole, high), &at_height(hole, low));
    }
    builder.finish()
}

/// A ring with a rectangular section.
pub(super) fn ring([inner, outer]: [f64; 2], [low, high]: [f64; 2], segments: usize) -> TriMesh {
    let section = [(inner, low), (outer, low), (outer, high), (inner, high)].map(DVec2::from);
    revolve_closed(&section, segments)
}

/// A turned solid: its radius along the axis, as (height, radius) steps from bottom to top with chamfered outer edges.
pub(super) fn stepped(steps: &[[f64; 3]], chamfer: f64, segments: usize) -> TriMesh {
    // Each step is [from, to, radius].
    let first = steps[0][0];
    let last = steps[steps.len() - 1][1];
    let mut section = vec![DVec2::new(0.0, first)];
    for (i, &[from, to, radius]) in steps.iter().enumerate() {
        let wider_than = |j: Option<usize>| j.and_then(|j| steps.get(j)).is_none_or(|s| s[2] < radius);
        section.extend(edge(radius, from, chamfer, wider_than(i.checked_sub(1))));
        section.extend(edge(radius, to, -chamfer, wider_than(Some(i + 1))));
    }
    section.push(DVec2::new(0.0, last));
    revolve_closed(&section, segments)
}

/// The corner of a step at height `at`, chamfered where it sticks out, along the way up.
fn edge(radius: f64, at: f64, chamfer: f64, sticks_out: bool) -> Vec<DVec2> {
    if !sticks_out {
        return vec![DVec2::new(radius, at)];
    }
    let flat = DVec2::new(radius - chamfer.abs(), at);
    let upright = DVec2::new(radius, at + chamfer);
    if chamfer > 0.0 { vec![flat, upright] } else { vec![upright, flat] }
}

/// A round bar of the given radius along a path, with flat ends.
pub(super) fn bar(path: &[DVec3], radius: f64, segments: usize) -> TriMesh {
    let mut builder = Builder::default();
    let way = |i: usize| (path[(i + 1).min(path.len() - 1)] - path[i.saturating_sub(1)]).normalize();
    let mut right = way(0).any_orthonormal_vector();
    let mut rings: Vec<Vec<DVec3>> = Vec::with_capacity(path.len());
    for (i, &p) in path.iter().enumerate() {
        // Carried along without twist: the part of the old direction that is square to the new way.
        right = right.reject_from_normalized(way(i)).normalize();
        let up = way(i).cross(right);
        let at = |k: usize| direction(turn(k, segments)) * radius;
        rings.push((0..segments).map(|k| p + right * at(k).x + up * at(k).y).collect());
    }
    builder.band(&[path[0]], &rings[0]);
    rings.windows(2).for_each(|pair| builder.band(&pair[0], &pair[1]));
    builder.band(&rings[rings.len() - 1], &[path[path.len() - 1]]);
    builder.finish()
}

/// Puts a solid's origin at `origin` and its z axis along `axis`.
pub(super) fn along(origin: DVec3, axis: DVec3) -> DAffine3 {
    let (right, up) = axis.normalize().any_orthonormal_pair();
    DAffine3::from_mat3_translation(DMat3::from_cols(right, up, axis.normalize()), origin)
}

/// Puts a solid's origin at `origin`, its z axis along `axis` and its x axis along `right` (square to it).
pub(super) fn facing(origin: DVec3, right: DVec3, axis: DVec3) -> DAffine3 {
    DAffine3::from_mat3_translation(DMat3::from_cols(right, axis.cross(right), axis), origin)
}

/// Shifts a solid to `(u, v)` and up by `w`.
pub(super) fn at(centre: DVec2, w: f64) -> DAffine3 {
    DAffine3::from_translation(centre.extend(w))
}

/// Turns a solid upside down about the joint side: w becomes `mirror_at` − w.
pub(super) fn mirrored(mirror_at: f64) -> DAffine3 {
    DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0)), translation: DVec3::Z * mirror_at }
}
