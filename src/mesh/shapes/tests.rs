#![allow(clippy::unwrap_used)]

use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI};

use approx::assert_relative_eq;
use glam::{DAffine3, DVec3};

use super::*;
use crate::mesh::TriangleId;

/// Directed edges that lack their opposite, or stand in two triangles.
pub(super) fn unpaired_edges(triangles: &[[u32; 3]]) -> usize {
    let mut balance: HashMap<[u32; 2], [u32; 2]> = HashMap::new();
    for t in triangles {
        for i in 0..3 {
            let (a, b) = (t[i], t[(i + 1) % 3]);
            balance.entry([a.min(b), a.max(b)]).or_default()[usize::from(a > b)] += 1;
        }
    }
    balance.values().filter(|&&count| count != [1, 1]).count()
}

/// Volume inside closed triangles, positive where they face outward.
pub(super) fn signed_volume(mesh: &TriMesh, triangles: Range<usize>) -> f64 {
    let corner = |v: u32| mesh.positions()[v as usize];
    let six_times = |&[a, b, c]: &[u32; 3]| corner(a).dot(corner(b).cross(corner(c)));
    mesh.triangles()[triangles].iter().map(six_times).sum::<f64>() / 6.0
}

fn volume(mesh: &TriMesh) -> f64 {
    signed_volume(mesh, 0..mesh.triangle_count())
}

fn area(mesh: &TriMesh) -> f64 {
    (0..mesh.triangle_count()).map(|t| geom::triangle_area(mesh.corners(TriangleId(t as u32)))).sum()
}

#[test]
fn solids_are_closed_and_face_outward() {
    let solids = [
        tetrahedron(),
        cuboid(DVec3::new(1.0, 2.0, 3.0), 4),
        icosphere(2),
        uv_sphere(16, 8),
        ellipsoid(DVec3::new(1.0, 2.0, 0.5), 16, 8),
        torus(1.0, 0.5, 24, 12),
        bumpy_sphere(3, 0.2),
        open_box_solid(0.1, 3).mesh,
        nested_spheres(0.5, 2).mesh,
        cluttered_sealed_box(7, 12, 2).mesh,
    ];
    for (i, solid) in solids.iter().enumerate() {
        assert_eq!(unpaired_edges(solid.triangles()), 0, "solid {i}");
        assert!(volume(solid) > 0.0, "solid {i}");
    }
}

#[test]
fn volumes_and_areas_are_those_of_the_solids() {
    assert_relative_eq!(volume(&tetrahedron()), 8.0 / 3.0, epsilon = 1e-12);
    assert_relative_eq!(volume(&cuboid(DVec3::new(1.0, 2.0, 3.0), 3)), 6.0, epsilon = 1e-12);
    // A fine polyhedral sphere lacks about (edge length)² of the smooth one.
    assert_relative_eq!(volume(&icosphere(5)), 4.0 / 3.0 * PI, max_relative = 2e-3);
    assert_relative_eq!(area(&uv_sphere(128, 64)), 4.0 * PI, max_relative = 2e-3);
    assert_relative_eq!(area(&torus(1.0, 0.5, 128, 64)), 2.0 * PI * PI, max_relative = 2e-3);
    assert_relative_eq!(area(&disc(2.0, 256, 4)), 4.0 * PI, max_relative = 2e-3);
    let open = open_box_solid(0.25, 2);
    assert_relative_eq!(volume(&open.mesh), 1.5 * 1.5 * 1.25 - 1.0, epsilon = 1e-12);
}

#[test]
fn counts_follow_the_subdivision() {
    assert_eq!(icosphere(3).triangle_count(), 20 * 64);
    assert_eq!(cuboid(DVec3::ONE, 5).triangle_count(), 6 * 2 * 25);
    assert_eq!(cuboid(DVec3::ONE, 5).vertex_count(), 6 * 25 + 2);
    assert_eq!(sheet(1.0, 1.0, [3, 4]).triangle_count(), 24);
    assert_eq!(disc(1.0, 10, 3).triangle_count(), 10 + 2 * 20);
}

#[test]
fn inner_sheets_face_inward() {
    // The divergence theorem on an open sheet seen from the middle of its opening: the opening adds nothing, so the
    // "volume" is that of the cavity, negative because the sheet faces inward.
    let about = |tagged: &Tagged, opening: DVec3| volume(&moved(&tagged.mesh, -opening));
    assert_relative_eq!(about(&open_box(2), DVec3::Z), -1.0, epsilon = 1e-12);
    assert_relative_eq!(about(&cylindrical_well(2.0, [256, 4]), DVec3::ZERO), -2.0 * PI, max_relative = 1e-3);
    let bowl = spherical_bowl(0.5, [128, 64]);
    assert_relative_eq!(about(&bowl, DVec3::ZERO), -2.0 / 3.0 * PI, max_relative = 2e-3);
}

#[test]
fn openings_and_insides_have_the_areas_of_the_closed_forms() {
    let ratio = |tagged: &Tagged, name: &str| tagged.opening_area / tagged.area(name);
    // Mean visibility of a cavity = opening / inside: 1 - g, (1 + cos ψ complement) / 2, 1 / (1 + 2H/R), 1/5.
    assert_relative_eq!(ratio(&spherical_bowl(0.75, [256, 128]), "inside"), 0.25, max_relative = 2e-3);
    assert_relative_eq!(ratio(&shell_with_hole(FRAC_PI_3, [256, 128]), "inside"), 0.25, max_relative = 2e-3);
    let well = cylindrical_well(1.0, [256, 4]);
    assert_relative_eq!(well.opening_area / (well.area("bottom") + well.area("walls")), 1.0 / 3.0, max_relative = 1e-3);
    let open = open_box(3);
    assert_relative_eq!(open.opening_area / (open.area("bottom") + open.area("walls")), 0.2, epsilon = 1e-12);
    let solid = open_box_solid(0.1, 3);
    assert_relative_eq!(solid.area("bottom") + solid.area("walls"), 5.0, epsilon = 1e-12);
}

#[test]
fn facing_pieces_look_at_each_other() {
    let normal = |tagged: &Tagged, name: &str| {
        let first = tagged.triangles(name).start;
        geom::triangle_normal(tagged.mesh.corners(TriangleId(first as u32))).unwrap()
    };
    for tagged in [parallel_squares(1.0, 2), coaxial_discs(1.0, 1.0, [8, 2])] {
        assert_eq!(normal(&tagged, "lower"), DVec3::Z);
        assert_eq!(normal(&tagged, "upper"), DVec3::NEG_Z);
    }
    let squares = right_angle_squares(2);
    assert_eq!((normal(&squares, "floor"), normal(&squares, "wall")), (DVec3::Z, DVec3::X));
    let wedge = wedge(FRAC_PI_2, 10.0, [2, 8]);
    assert_eq!(normal(&wedge, "floor"), DVec3::Z);
    assert!(normal(&wedge, "wall").abs_diff_eq(DVec3::X, 1e-12));
}

#[test]
fn clutter_stays_inside_its_box_and_depends_on_the_seed_alone() {
    let filled = cluttered_open_box(3, 20, 2);
    let bounds = filled.mesh.bounds();
    assert_eq!((bounds.min, bounds.max), (DVec3::ZERO, DVec3::ONE));
    assert_eq!(filled, cluttered_open_box(3, 20, 2));
    assert_ne!(filled.mesh, cluttered_open_box(4, 20, 2).mesh);
    assert!(signed_volume(&filled.mesh, filled.triangles("clutter")) > 0.0);
}

#[test]
fn mirrored_solids_still_face_outward() {
    let mirrored = transformed(&tetrahedron(), &DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0))).unwrap();
    assert_relative_eq!(volume(&mirrored), 8.0 / 3.0, epsilon = 1e-12);
}

#[test]
fn merged_meshes_keep_their_order() {
    let both = merge(&[tetrahedron(), cuboid(DVec3::ONE, 1)]).unwrap();
    assert_eq!(both.triangle_count(), 4 + 12);
    assert_eq!(both.triangles()[4], cuboid(DVec3::ONE, 1).triangles()[0].map(|v| v + 4));
    assert!(merge(&[]).is_none());
}

#[test]
fn surfaces_cover_the_mesh_in_order() {
    for tagged in [open_box_solid(0.1, 2), shell_with_hole_and_ball(1.0, 0.4, [16, 8]), nested_spheres(0.5, 1)] {
        let mut end = 0;
        for (_, range) in &tagged.surfaces {
            assert_eq!(range.start, end);
            end = range.end;
        }
        assert_eq!(end, tagged.mesh.triangle_count());
    }
}
