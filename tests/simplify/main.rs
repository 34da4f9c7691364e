//! The simplifier on meshes whose answer is known beforehand, and laws over random ones.
#![allow(clippy::unwrap_used, clippy::panic)]

mod properties;
mod shapes;

use std::sync::atomic::{AtomicUsize, Ordering};

use glam::{DVec3, IVec3};
use outsight::Error;
use outsight::mesh::{TriMesh, compose_maps};
use outsight::progress::{CancelFlag, Progress, Silent};
use outsight::simplify::{Boundary, Level, PlaneWeight, SimplifyOptions, Stop, Target, Topology, simplify};
use shapes::{Grid, add_box, area, ball, box_at, bumpy_sheet, cube, euler_characteristic, is_closed, sheet};
use shapes::{tetrahedron, torus, volume};

/// Rounding of a position that is known exactly, in units of the mesh's size: quadrics in f64 lose half the digits of
/// a squared distance.
const POSITION_TOLERANCE: f64 = 1e-7;

fn to(triangles: usize) -> SimplifyOptions {
    SimplifyOptions::default().with_targets(vec![Target::Triangles(triangles)])
}

fn run(mesh: &TriMesh, options: &SimplifyOptions) -> Level {
    simplify(mesh, None, options, &Silent).unwrap().pop().unwrap()
}

fn has_vertex_at(mesh: &TriMesh, p: DVec3, tolerance: f64) -> bool {
    mesh.positions().iter().any(|q| q.distance(p) <= tolerance)
}

fn scaled(mesh: &TriMesh, factor: f64) -> TriMesh {
    TriMesh::new(mesh.positions().iter().map(|p| factor * p).collect(), mesh.triangles().to_vec()).unwrap()
}

#[test]
fn subdivided_cube_collapses_to_twelve_triangles_with_all_corners() {
    for options in [to(12), SimplifyOptions::paper().with_targets(vec![Target::Triangles(12)])] {
        let level = run(&cube(8), &options);
        assert_eq!((level.mesh.triangle_count(), level.stop), (12, Stop::Target));
        assert!(level.error <= 8.0 * POSITION_TOLERANCE, "error {}", level.error);
        for i in 0..8 {
            let corner = DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 8.0;
            assert!(has_vertex_at(&level.mesh, corner, 8.0 * POSITION_TOLERANCE), "{corner} is gone");
        }
        assert!(is_closed(&level.mesh));
        assert!((volume(&level.mesh) - 512.0).abs() < 512.0 * POSITION_TOLERANCE);
    }
}

#[test]
fn flat_sheet_keeps_its_outline() {
    let level = run(&sheet(10), &to(2));
    assert_eq!(level.mesh.triangle_count(), 2);
    for corner in [(0, 0), (10, 0), (0, 10), (10, 10)] {
        let corner = DVec3::new(corner.0.into(), corner.1.into(), 0.0);
        assert!(has_vertex_at(&level.mesh, corner, 10.0 * POSITION_TOLERANCE), "{corner} is gone");
    }
    assert!((area(&level.mesh) - 100.0).abs() < 1e-4);
}

#[test]
fn preserve_keeps_closed_surfaces_closed_and_their_euler_characteristic() {
    for (mesh, euler) in [(ball(8), 2), (torus(16), 0), (cube(6), 2)] {
        let level = run(&mesh, &SimplifyOptions { topology: Topology::Preserve, ..to(1) });
        assert!(is_closed(&level.mesh));
        assert_eq!(euler_characteristic(&level.mesh), euler);
        assert_eq!(level.topology, outsight::simplify::TopologyChange::default());
        assert_eq!(level.stop, Stop::QueueEmpty);
    }
}

#[test]
fn preserve_keeps_an_annulus_and_an_isolated_triangle() {
    // A 6 x 6 sheet with a 2 x 2 hole, and a triangle beside it: Euler characteristic 0 + 1.
    let mut grid = Grid::default();
    for (i, j) in
        (0..6).flat_map(|i| (0..6).map(move |j| (i, j))).filter(|(i, j)| !(2..4).contains(i) || !(2..4).contains(j))
    {
        grid.sheet(IVec3::new(i, j, 0), IVec3::X, IVec3::Y, 1);
    }
    let (mut positions, mut triangles) = grid.into_mesh(|p| p).into_parts();
    let first = positions.len() as u32;
    positions.extend([DVec3::new(8.0, 0.0, 0.0), DVec3::new(9.0, 0.0, 0.0), DVec3::new(8.0, 1.0, 0.0)]);
    triangles.push([first, first + 1, first + 2]);
    let mesh = TriMesh::new(positions, triangles).unwrap();

    let level = run(&mesh, &SimplifyOptions { topology: Topology::Preserve, ..to(1) });
    assert_eq!(euler_characteristic(&level.mesh), 1);
    assert_eq!(level.topology.components, 0);
    assert_eq!(level.topology.euler_characteristic, 0);
}

#[test]
fn tetrahedron_is_kept_under_preserve() {
    let level = run(&tetrahedron(), &SimplifyOptions { topology: Topology::Preserve, ..to(1) });
    assert_eq!((level.mesh.triangle_count(), level.stop), (4, Stop::QueueEmpty));
    assert_eq!(level.mesh, tetrahedron());
}

#[test]
fn locked_border_keeps_its_vertices() {
    let mesh = bumpy_sheet(10, |x, y| 0.3 * ((x * 7.0 + y * 3.0) % 4.0));
    let level = run(&mesh, &SimplifyOptions { boundary: Boundary::Locked, ..to(1) });
    for (v, p) in mesh.positions().iter().enumerate() {
        if p.x == 0.0 || p.y == 0.0 || p.x == 10.0 || p.y == 10.0 {
            let now = level.vertex_map[v].unwrap();
            assert_eq!(level.mesh.positions()[now as usize], *p, "border vertex {v} moved");
        }
    }
    // 40 border vertices and none inside: 38 triangles.
    assert_eq!((level.mesh.triangle_count(), level.stop), (38, Stop::QueueEmpty));
}

#[test]
fn importance_of_one_gives_the_same_bytes_as_none() {
    let mesh = bumpy_sheet(20, |x, y| (0.5 * x).sin() + (0.3 * x * y).cos());
    for options in [to(60), SimplifyOptions::paper().with_targets(vec![Target::Triangles(60)])] {
        let ones = vec![1.0; mesh.triangle_count()];
        let weighted = simplify(&mesh, Some(&ones), &options, &Silent).unwrap().pop().unwrap();
        let plain = run(&mesh, &options);
        assert_eq!(weighted.mesh, plain.mesh);
        assert_eq!(weighted.error.to_bits(), plain.error.to_bits());
        assert_eq!((weighted.vertex_map, weighted.triangle_map), (plain.vertex_map, plain.triangle_map));
    }
}

#[test]
fn scaling_by_a_power_of_two_changes_no_choice() {
    let mesh = bumpy_sheet(16, |x, y| (0.5 * x).sin() + (0.3 * x * y).cos());
    let plain = run(&mesh, &to(50));
    for exponent in [-40, 40, -400, 300] {
        let factor = 2f64.powi(exponent);
        let level = run(&scaled(&mesh, factor), &to(50));
        assert_eq!(level.mesh.triangles(), plain.mesh.triangles(), "scaled by 2^{exponent}");
        assert_eq!(level.vertex_map, plain.vertex_map);
        assert_eq!(level.error, factor * plain.error);
        assert_eq!(level.mesh, scaled(&plain.mesh, factor));
    }
}

#[test]
fn regions_without_importance_go_first() {
    // Two equal balls; nobody looks at the second.
    let (a, b) = (ball(8), ball(8));
    let count = a.triangle_count();
    let shift = a.vertex_count() as u32;
    let positions = a.positions().iter().copied().chain(b.positions().iter().map(|p| *p + 5.0 * DVec3::X)).collect();
    let triangles = a.triangles().iter().copied().chain(b.triangles().iter().map(|t| t.map(|v| v + shift))).collect();
    let mesh = TriMesh::new(positions, triangles).unwrap();
    let importance: Vec<f64> = (0..2 * count).map(|t| if t < count { 1.0 } else { 0.0 }).collect();

    let level = simplify(&mesh, Some(&importance), &to(count + 20), &Silent).unwrap().pop().unwrap();
    assert!(level.triangle_map[..count].iter().all(Option::is_some), "a seen triangle was removed");
    assert_eq!(level.error, 0.0);
}

#[test]
fn back_to_back_triangles_are_cancelled() {
    // A tetrahedron inside a ball: collapsing an edge of it leaves two triangles back to back.
    let (mut positions, mut triangles) = ball(2).into_parts();
    let (small, first) = (tetrahedron(), positions.len() as u32);
    positions.extend(small.positions().iter().map(|p| 0.1 * *p));
    triangles.extend(small.triangles().iter().map(|t| t.map(|v| v + first)));
    let mesh = TriMesh::new(positions, triangles).unwrap();
    let importance: Vec<f64> = (0..52).map(|t| if t < 48 { 1.0 } else { 0.0 }).collect();

    let level = simplify(&mesh, Some(&importance), &to(48), &Silent).unwrap().pop().unwrap();
    assert_eq!(level.mesh.triangle_count(), 48);
    assert_eq!(level.topology.cancelled_pairs, 1);
    assert_eq!((level.topology.components, level.topology.euler_characteristic), (-1, -2));
    assert!(level.vertex_map[first as usize..].iter().all(Option::is_none), "no vertex of the tetrahedron is left");
    assert!(is_closed(&level.mesh));
}

#[test]
fn something_is_always_left() {
    for mesh in [tetrahedron(), cube(1), sheet(1), ball(2)] {
        let level = run(&mesh, &SimplifyOptions { min_normal_cosine: -1.0, ..to(1) });
        assert!(level.mesh.triangle_count() >= 1);
        assert!(level.mesh.triangle_count() == 1 || level.stop == Stop::QueueEmpty);
    }
}

#[test]
fn collapse_cannot_creep_past_flip() {
    // Over a height field no triangle may ever face down, however far it is simplified.
    let mesh = bumpy_sheet(24, |x, y| 0.8 * (1.3 * x).sin() * (1.7 * y).cos());
    for target in [200, 50, 10] {
        let level = run(&mesh, &to(target));
        for t in level.mesh.triangles() {
            let normal = outsight::geom::area_vector_doubled(t.map(|v| level.mesh.positions()[v as usize]));
            assert!(normal.z > 0.0, "a triangle of the {target} faces down");
        }
    }
}

#[test]
fn error_grows_from_level_to_level_and_levels_nest() {
    let mesh = bumpy_sheet(24, |x, y| (0.5 * x).sin() + (0.3 * y).cos());
    let targets = vec![Target::Ratio(0.5), Target::Triangles(300), Target::Ratio(0.1), Target::Ratio(0.01)];
    let levels = simplify(&mesh, None, &to(1).with_targets(targets), &Silent).unwrap();
    assert_eq!(levels.iter().map(|l| l.target.unwrap()).collect::<Vec<_>>(), [576, 300, 115, 11]);
    for pair in levels.windows(2) {
        assert!(pair[0].error <= pair[1].error);
        let lost = |l: &Level| l.triangle_map.iter().filter(|t| t.is_none()).count();
        assert!(lost(&pair[0]) < lost(&pair[1]));
    }
    assert!(levels.iter().all(|l| l.mesh.triangle_count() <= l.target.unwrap() && l.stop == Stop::Target));
}

#[test]
fn max_error_is_respected_and_named() {
    let mesh = ball(16);
    let bound = 4e-3;
    let options = SimplifyOptions { targets: vec![], max_error: Some(bound), ..to(1) };
    let level = run(&mesh, &options);
    assert_eq!((level.target, level.stop), (None, Stop::Error));
    assert!(level.error <= bound && level.mesh.triangle_count() < mesh.triangle_count());

    let looser = run(&mesh, &SimplifyOptions { max_error: Some(10.0 * bound), ..options });
    assert!(looser.mesh.triangle_count() < level.mesh.triangle_count());

    let both = run(&mesh, &SimplifyOptions { max_error: Some(bound), ..to(mesh.triangle_count() - 100) });
    assert_eq!(both.stop, Stop::Target);
}

#[test]
fn ratio_of_one_gives_the_mesh_back_without_its_unused_vertices() {
    let (mut positions, triangles) = cube(2).into_parts();
    positions.insert(0, DVec3::splat(1e9));
    let mesh = TriMesh::new(positions, triangles.iter().map(|t| t.map(|v| v + 1)).collect()).unwrap();
    let level = run(&mesh, &to(1).with_targets(vec![Target::Ratio(1.0)]));
    assert_eq!(level.mesh, cube(2));
    assert_eq!((level.error, level.stop, level.vertex_map[0]), (0.0, Stop::Target, None));
}

#[test]
fn cancelled_run_says_so() {
    let flag = CancelFlag::default();
    flag.cancel();
    assert!(matches!(simplify(&cube(4), None, &to(12), &flag), Err(Error::Cancelled)));
}

#[test]
fn run_can_be_cancelled_half_way_and_reports_progress() {
    /// Asks for the end after three reports.
    #[derive(Default)]
    struct ThreeReports(AtomicUsize);

    impl Progress for ThreeReports {
        fn report(&self, phase: &'static str, done: u64, total: u64) {
            assert_eq!((phase, total), ("simplify", 7500 - 100));
            assert!(done <= total);
            self.0.fetch_add(1, Ordering::Relaxed);
        }

        fn is_cancelled(&self) -> bool {
            self.0.load(Ordering::Relaxed) >= 3
        }
    }

    let progress = ThreeReports::default();
    assert!(matches!(simplify(&ball(25), None, &to(100), &progress), Err(Error::Cancelled)));
    assert_eq!(progress.0.into_inner(), 3);
}

#[test]
fn options_outside_their_range_are_named() {
    let bad = |options: SimplifyOptions, name: &str| match simplify(&cube(1), None, &options, &Silent) {
        Err(Error::Option { name: found, .. }) => assert_eq!(found, name),
        other => panic!("{name}: {other:?}"),
    };
    bad(to(0), "--triangles");
    bad(to(1).with_targets(vec![]), "--ratio");
    for ratio in [0.0, -1.0, 1.5, f64::NAN] {
        bad(to(1).with_targets(vec![Target::Ratio(ratio)]), "--ratio");
    }
    bad(to(1).with_targets(vec![Target::Triangles(3), Target::Triangles(4)]), "--lods");
    bad(SimplifyOptions { boundary: Boundary::Weight(-1.0), ..to(1) }, "--boundary");
    bad(SimplifyOptions { max_error: Some(f64::NAN), ..to(1) }, "--max-error");
    bad(SimplifyOptions { min_normal_cosine: 2.0, ..to(1) }, "min normal cosine");
    bad(SimplifyOptions { regulariser: 1.0, ..to(1) }, "regulariser");
    bad(SimplifyOptions { max_valence: Some(2), ..to(1) }, "max valence");
}

#[test]
fn importance_of_another_mesh_or_below_zero_is_an_error() {
    let with = |importance: &[f64]| simplify(&tetrahedron(), Some(importance), &to(1), &Silent);
    assert!(matches!(with(&[1.0; 3]), Err(Error::ShapeMismatch { got: 3, expected: 4, .. })));
    for wrong in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(with(&[1.0, 1.0, 1.0, wrong]), Err(Error::Option { name: "importance", .. })));
    }
}

#[test]
fn edge_of_three_triangles_and_repeated_triangles_are_harmless() {
    // Three sheets that share one border, one of them given twice.
    let mut grid = Grid::default();
    for along in [IVec3::X, IVec3::Z, -IVec3::X, -IVec3::X] {
        grid.sheet(IVec3::ZERO, IVec3::Y, along, 6);
    }
    let mesh = grid.into_mesh(|p| p);
    for topology in [Topology::Free, Topology::Preserve] {
        let level = run(&mesh, &SimplifyOptions { topology, ..to(6) });
        assert!(level.mesh.triangle_count() <= 6 || level.stop == Stop::QueueEmpty);
        if topology == Topology::Preserve {
            assert_eq!(level.topology.euler_characteristic, 0);
            assert!(level.topology.non_manifold_edges <= 0);
        }
    }
}

#[test]
fn all_vertices_in_one_place_are_harmless() {
    let mesh = TriMesh::new(vec![DVec3::ONE; 5], vec![[0, 1, 2], [2, 1, 3], [3, 1, 4]]).unwrap();
    let level = run(&mesh, &to(1));
    assert_eq!(level.error, 0.0);
    assert!(level.mesh.positions().iter().all(|&p| p == DVec3::ONE));
}

#[test]
fn maps_of_a_removal_and_a_run_compose() {
    let mut grid = Grid::default();
    add_box(&mut grid, 4, IVec3::ZERO);
    let mesh = grid.into_mesh(|p| p);
    let remove: Vec<bool> = (0..mesh.triangle_count()).map(|t| t % 7 == 0).collect();
    let left = mesh.without_triangles(&remove).unwrap().unwrap();
    let level = run(&left.mesh, &to(40));
    let composed = compose_maps(&left.triangle_map, &level.triangle_map);
    assert_eq!(composed.len(), mesh.triangle_count());
    assert_eq!(composed.iter().flatten().count(), level.mesh.triangle_count());
    assert!(remove.iter().zip(&composed).all(|(&removed, now)| !removed || now.is_none()));
}

#[test]
fn uniform_weights_and_area_weights_differ() {
    let mesh = box_at(5, IVec3::new(1, 2, 3));
    let uniform = SimplifyOptions { plane_weight: PlaneWeight::Uniform, ..to(12) };
    assert!(is_closed(&run(&mesh, &uniform).mesh));
}

#[test]
fn a_trace_of_importance_orders_collapses_but_is_no_error() {
    const TRACE: f64 = 1e-6;
    let mesh = bumpy_sheet(24, |x, y| (0.5 * x).sin() + (0.3 * y).cos());
    let options = SimplifyOptions { importance_floor: TRACE, ..to(100) };
    let with = |importance: f64| {
        let importance = vec![importance; mesh.triangle_count()];
        simplify(&mesh, Some(&importance), &options, &Silent).unwrap().swap_remove(0)
    };
    let unseen = with(TRACE);
    assert!(unseen.mesh.triangle_count() <= 100);
    assert_eq!(unseen.error, 0.0);
    let seen = with(1.0 + TRACE);
    let plain = run(&mesh, &to(100));
    assert!(plain.error > 0.0);
    assert!((seen.error / plain.error - 1.0).abs() < 1e-3, "{} and {}", seen.error, plain.error);
}
