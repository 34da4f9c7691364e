//! Cavities with a flat opening: what the cavity theorem speaks of (mean visibility = opening ÷ inside area).

use std::f64::consts::FRAC_PI_2;

use glam::{DAffine3, DVec2, DVec3};

use super::builder::Builder;
use super::flat::cuboid_sides;
use super::revolve::revolve;
use super::round::{latitude_below_pole, meridian};
use super::{Tagged, icosphere, merged, transformed, turned_over, uv_sphere};
use crate::mesh::TriMesh;

/// Box with edges of length 1 and an open top, as a sheet that faces inward: "bottom" and "walls", `n` × `n` cells a
/// side.
#[must_use]
pub fn open_box(n: usize) -> Tagged {
    let (bottom, walls) = open_box_inside(n.max(1));
    Tagged::of(&[("bottom", bottom), ("walls", walls)], 1.0)
}

/// The inner surface of the open unit box from (0,0,0) to (1,1,1).
fn open_box_inside(n: usize) -> (TriMesh, TriMesh) {
    let inward = cuboid_sides(DVec3::ZERO, DVec3::ONE).map(|[a, b, c, d]| [a, d, c, b]);
    let built = |sides: &[[DVec3; 4]]| {
        let mut builder = Builder::default();
        sides.iter().for_each(|&side| builder.patch(side, [n, n]));
        builder.finish()
    };
    (built(&inward[..1]), built(&inward[2..]))
}

/// Open box with walls of the given thickness round the unit cube, a closed solid: "bottom" and "walls" of the inside,
/// then "outside" with the rim. Each side has `n` × `n` cells.
#[must_use]
pub fn open_box_solid(thickness: f64, n: usize) -> Tagged {
    let n = n.max(1);
    let (inner_min, inner_max) = (DVec3::ZERO, DVec3::ONE);
    let outer_min = inner_min - DVec3::splat(thickness);
    let outer_max = inner_max + DVec3::new(thickness, thickness, 0.0);
    let inner = cuboid_sides(inner_min, inner_max);
    let outer = cuboid_sides(outer_min, outer_max);
    let mut builder = Builder::default();
    let mut add = |sides: &[[DVec3; 4]], inward: bool| {
        let turned = |[a, b, c, d]: [DVec3; 4]| if inward { [a, d, c, b] } else { [a, b, c, d] };
        let start = builder.triangle_count();
        sides.iter().for_each(|&side| builder.patch(turned(side), [n, n]));
        start..builder.triangle_count()
    };
    let bottom = add(&inner[..1], true);
    let walls = add(&inner[2..], true);
    add(&outer[..1], false);
    add(&outer[2..], false);
    for i in 0..4 {
        let j = (i + 1) % 4;
        // Side 1 is the top; its corners run counter-clockwise from above.
        builder.patch([outer[1][i], outer[1][j], inner[1][j], inner[1][i]], [n, 1]);
    }
    let outside = walls.end..builder.triangle_count();
    let surfaces = vec![("bottom", bottom), ("walls", walls), ("outside", outside)];
    Tagged { mesh: builder.finish(), surfaces, opening_area: 1.0 }
}

/// The inside of a thin spherical bowl that covers `fraction` (between 0 and 1) of the unit sphere, opening up, as a
/// sheet that faces inward: "inside".
#[must_use]
pub fn spherical_bowl(fraction: f64, [segments, rings]: [usize; 2]) -> Tagged {
    // A cap of height h covers h/2 of the sphere, so the rim lies at z = 2g - 1.
    let rim = libm::asin((2.0 * fraction - 1.0).clamp(-1.0, 1.0));
    sphere_open_above(rim, [segments, rings])
}

/// Unit sphere shell with a circular hole of half-angle `half_angle_rad` round +z, as a sheet that faces inward:
/// "inside".
#[must_use]
pub fn shell_with_hole(half_angle_rad: f64, [segments, rings]: [usize; 2]) -> Tagged {
    sphere_open_above(latitude_below_pole(half_angle_rad), [segments, rings])
}

fn sphere_open_above(rim_latitude_rad: f64, [segments, rings]: [usize; 2]) -> Tagged {
    let segments = segments.max(3);
    let section = meridian([-FRAC_PI_2, rim_latitude_rad], rings.max(2));
    let rim_radius = section[section.len() - 1].x;
    let inside = turned_over(&revolve(&section, segments));
    Tagged::of(&[("inside", inside)], regular_polygon_area(rim_radius, segments))
}

/// [`shell_with_hole`] round a concentric ball (a closed solid of `ball_radius` < cos `half_angle_rad`): "inside",
/// "ball".
#[must_use]
pub fn shell_with_hole_and_ball(half_angle_rad: f64, ball_radius: f64, [segments, rings]: [usize; 2]) -> Tagged {
    let shell = shell_with_hole(half_angle_rad, [segments, rings]);
    let ball = scaled(&uv_sphere(segments, rings), ball_radius);
    Tagged::of(&[("inside", shell.mesh), ("ball", ball)], shell.opening_area)
}

/// Cylindrical well of radius 1 and the given depth, open above at z = 0, as a sheet that faces inward: "bottom",
/// "walls".
/// The bottom has `rings` rings, and the wall as many belts.
#[must_use]
pub fn cylindrical_well(depth: f64, [segments, rings]: [usize; 2]) -> Tagged {
    let (segments, rings) = (segments.max(3), rings.max(1));
    let step = |i: usize| i as f64 / rings as f64;
    let bottom: Vec<DVec2> = (0..=rings).map(|i| DVec2::new(1.0 - step(i), -depth)).collect();
    let walls: Vec<DVec2> = (0..=rings).map(|i| DVec2::new(1.0, -depth * step(i))).collect();
    let pieces = [("bottom", revolve(&bottom, segments)), ("walls", revolve(&walls, segments))];
    Tagged::of(&pieces, regular_polygon_area(1.0, segments))
}

/// Closed unit sphere round a closed concentric sphere of radius `inner_radius` < 1, both outward: "outer", "inner".
#[must_use]
pub fn nested_spheres(inner_radius: f64, subdivisions: u32) -> Tagged {
    let outer = icosphere(subdivisions);
    let inner = scaled(&outer, inner_radius);
    Tagged::of(&[("outer", outer), ("inner", inner)], 0.0)
}

/// Area of a regular polygon with its corners on a circle.
fn regular_polygon_area(radius: f64, corners: usize) -> f64 {
    0.5 * corners as f64 * radius * radius * libm::sin(super::revolve::turn(1, corners))
}

fn scaled(mesh: &TriMesh, factor: f64) -> TriMesh {
    transformed(mesh, &DAffine3::from_scale(DVec3::splat(factor))).expect("test pieces have ordinary sizes")
}

/// Sheets and solids as one surface.
pub(super) fn together(meshes: &[TriMesh]) -> TriMesh {
    merged(meshes.iter())
}
