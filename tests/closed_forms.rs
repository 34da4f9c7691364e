//! Visibility against exact answers.
//!
//! Each expected number is the mean of eq. (3.1) of Zhang & Turk 2002 over a surface, known in closed form: V is one
//! minus the classical form factor toward opaque geometry. Cameras are turned away from the coordinate planes, in which
//! octahedral cameras lie exactly.

#![allow(clippy::unwrap_used)]

use std::f64::consts::PI;

use approx::assert_abs_diff_eq;
use glam::{DMat3, DVec3};
use outsight::backend::BackendKind;
use outsight::camera::{CameraSphere, CameraWeights, Cameras};
use outsight::geom::triangle_area;
use outsight::mesh::shapes::{self, Tagged};
use outsight::mesh::{TriMesh, TriangleId};
use outsight::progress::Silent;
use outsight::visibility::{MeasureOptions, Sides, Subject, Visibility, measure};

/// Mean over a surface, 258 area-weighted cameras: the quadrature error of the camera pattern.
const CAMERAS: f64 = 0.01;

/// Convex solids, unclamped: what is left is the noise of pixels along outlines.
const CONVEX: f64 = 1e-3;

fn look(mesh: &TriMesh) -> Visibility {
    let rotation = DMat3::from_rotation_z(0.4) * DMat3::from_rotation_y(1.1) * DMat3::from_rotation_x(0.7);
    let cameras = CameraSphere::octahedral(258, CameraWeights::Area).unwrap().rotated(rotation);
    let options = MeasureOptions { sides: Sides::One, ..MeasureOptions::default() };
    Subject::new(mesh, BackendKind::Raster).unwrap().measure_from(&cameras, &options, None, &Silent).unwrap()
}

/// Area-weighted mean of the front side's visibility over some triangles.
fn mean(mesh: &TriMesh, visibility: &Visibility, triangles: impl Iterator<Item = usize>) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for t in triangles {
        let area = triangle_area(mesh.corners(TriangleId(t as u32)));
        sum += area * visibility.front()[t];
        total += area;
    }
    sum / total
}

fn mean_of(shape: &Tagged, surface: &str) -> f64 {
    mean(&shape.mesh, &look(&shape.mesh), shape.triangles(surface))
}

fn area_times_v(shape: &Tagged) -> f64 {
    let visibility = look(&shape.mesh);
    let all = 0..shape.mesh.triangle_count();
    let area: f64 = all.clone().map(|t| triangle_area(shape.mesh.corners(TriangleId(t as u32)))).sum();
    area * mean(&shape.mesh, &visibility, all)
}

#[test]
fn t1_convex_solids_are_seen_whole() {
    let solids = [
        shapes::icosphere(5),
        shapes::cuboid(DVec3::new(1.0, 2.0, 0.5), 7),
        shapes::tetrahedron(),
        shapes::ellipsoid(DVec3::new(1.0, 0.6, 0.3), 96, 48),
    ];
    for solid in solids {
        let visibility = look(&solid);
        assert_abs_diff_eq!(visibility.of_mesh(), 1.0, epsilon = CONVEX);
        assert_eq!(visibility.never_seen(), 0);
        assert!(visibility.back().iter().all(|&v| v == 0.0), "nobody sees a closed solid's back");
    }
}

#[test]
fn t1_holds_with_every_number_of_cameras_and_both_weights() {
    let sphere = shapes::icosphere(4);
    for cameras in [6, 18, 66, 258, 1026] {
        for camera_weights in [CameraWeights::Area, CameraWeights::Equal] {
            let cameras = Cameras::octahedral(cameras);
            let options = MeasureOptions { cameras, camera_weights, ..MeasureOptions::default() };
            let visibility = measure(&sphere, &options, &Silent).unwrap();
            assert_abs_diff_eq!(visibility.of_mesh(), 1.0, epsilon = 4e-3);
        }
    }
}

#[test]
fn t1_holds_at_the_ends_of_the_range_of_numbers() {
    let sphere = shapes::icosphere(3);
    let expected = look(&sphere).of_mesh();
    for exponent in [-1000, -40, 40, 300] {
        let scale = 2.0_f64.powi(exponent);
        let positions = sphere.positions().iter().map(|&p| scale * p).collect();
        let scaled = TriMesh::new(positions, sphere.triangles().to_vec()).unwrap();
        assert_eq!(look(&scaled).of_mesh(), expected, "times 2^{exponent}");
    }
}

#[test]
fn t2_nothing_inside_a_sealed_shell_is_seen() {
    for seed in 0..4 {
        let shape = shapes::cluttered_sealed_box(seed, 20, 4);
        let visibility = look(&shape.mesh);
        assert!(shape.triangles("clutter").all(|t| visibility.front()[t] == 0.0 && visibility.back()[t] == 0.0));
        assert!(shape.triangles("clutter").all(|t| visibility.per_triangle()[t] == 0.0 && !visibility.seen()[t]));
        assert!(shape.triangles("outside").all(|t| visibility.back()[t] == 0.0));
    }
    let nested = shapes::nested_spheres(0.7, 4);
    let visibility = look(&nested.mesh);
    assert!(nested.triangles("inner").all(|t| visibility.per_triangle()[t] == 0.0));
}

#[test]
fn t3_coaxial_discs_and_parallel_squares() {
    for (gap, expected) in [(0.25, 0.220_696), (0.5, 0.390_388), (1.0, 0.618_034), (2.0, 0.828_427), (4.0, 0.944_272)] {
        let discs = shapes::coaxial_discs(1.0, gap, [128, 16]);
        assert_abs_diff_eq!(mean_of(&discs, "lower"), expected, epsilon = CAMERAS);
        assert_abs_diff_eq!(mean_of(&discs, "upper"), expected, epsilon = CAMERAS);
    }
    for (gap, expected) in [(0.5, 0.584_747), (1.0, 0.800_175), (2.0, 0.931_410)] {
        assert_abs_diff_eq!(mean_of(&shapes::parallel_squares(gap, 16), "lower"), expected, epsilon = CAMERAS);
    }
}

#[test]
fn t4_wedges() {
    let squares = shapes::right_angle_squares(16);
    assert_abs_diff_eq!(mean_of(&squares, "floor"), 0.799_956, epsilon = CAMERAS);
    assert_abs_diff_eq!(mean_of(&squares, "wall"), 0.799_956, epsilon = CAMERAS);
    const LENGTH: f64 = 20.0;
    for degrees in [30.0_f64, 60.0, 90.0, 120.0] {
        let angle = degrees.to_radians();
        let wedge = shapes::wedge(angle, LENGTH, [8, 32]);
        let visibility = look(&wedge.mesh);
        let mean = mean(&wedge.mesh, &visibility, 0..wedge.mesh.triangle_count());
        // Infinite strips have sin(α/2); the open ends of finite ones let in at most their own area.
        let infinite = (0.5 * angle).sin();
        let ends = angle.sin() / (2.0 * LENGTH);
        assert!(mean > infinite - CAMERAS && mean < infinite + ends + CAMERAS, "{degrees}°: {mean}");
    }
}

#[test]
fn t5_a_bowl_is_seen_alike_at_every_point() {
    for fraction in [0.25, 0.5, 0.75] {
        let bowl = shapes::spherical_bowl(fraction, [96, 64]);
        let visibility = look(&bowl.mesh);
        // The mean through the theorem of T11, which holds for the polyhedron; the points through the smooth sphere.
        let inside: f64 = bowl.area("inside");
        let all = mean(&bowl.mesh, &visibility, bowl.triangles("inside"));
        assert_abs_diff_eq!(all, bowl.opening_area / inside, epsilon = CAMERAS);
        let squares = bowl.triangles("inside").map(|t| (visibility.per_triangle()[t] - (1.0 - fraction)).powi(2));
        let rms = (squares.sum::<f64>() / bowl.triangles("inside").count() as f64).sqrt();
        assert!(rms < 0.03, "fraction {fraction}: {rms}");
    }
}

#[test]
fn t6_t7_a_shell_with_a_hole() {
    let shell = shapes::shell_with_hole(PI / 3.0, [96, 64]);
    assert_abs_diff_eq!(mean_of(&shell, "inside"), 0.25, epsilon = CAMERAS);
    let filled = shapes::shell_with_hole_and_ball(PI / 3.0, 0.4, [96, 64]);
    assert_abs_diff_eq!(mean_of(&filled, "ball"), 0.25, epsilon = CAMERAS);
    assert_abs_diff_eq!(mean_of(&filled, "inside"), 0.196_667, epsilon = CAMERAS);
    // Through a hole of 30° fewer cameras look in: 10 % of the value.
    let narrow = shapes::shell_with_hole(PI / 6.0, [96, 64]);
    assert_abs_diff_eq!(mean_of(&narrow, "inside"), 0.066_987_3, epsilon = 0.006_7);
}

#[test]
fn t8_a_cylindrical_well() {
    for (depth, bottom, wall) in [
        (0.5, 0.609_612, 0.390_388),
        (1.0, 0.381_966, 0.309_017),
        (2.0, 0.171_573, 0.207_107),
        (4.0, 0.055_728, 0.118_034),
    ] {
        let well = shapes::cylindrical_well(depth, [96, 24]);
        assert_abs_diff_eq!(mean_of(&well, "bottom"), bottom, epsilon = CAMERAS);
        assert_abs_diff_eq!(mean_of(&well, "walls"), wall, epsilon = CAMERAS);
    }
}

#[test]
fn t10_an_open_box() {
    let shape = shapes::open_box(16);
    assert_abs_diff_eq!(mean_of(&shape, "bottom"), 0.199_825, epsilon = CAMERAS);
    assert_abs_diff_eq!(mean_of(&shape, "walls"), 0.200_044, epsilon = CAMERAS);
    let solid = shapes::open_box_solid(0.1, 16);
    assert_abs_diff_eq!(mean_of(&solid, "bottom"), 0.199_825, epsilon = CAMERAS);
}

#[test]
fn t11_whatever_is_inside_a_cavity_shares_the_light_of_its_opening() {
    for (seed, count) in [(1, 0), (2, 5), (3, 20), (4, 60)] {
        let shape = shapes::cluttered_open_box(seed, count, 8);
        let relative = area_times_v(&shape) / shape.opening_area;
        assert_abs_diff_eq!(relative, 1.0, epsilon = CAMERAS);
    }
}

/// V(M) ≤ hull area ÷ area for a torus (T12); R² / (R² + r²) for nested spheres (T13); a sheet alone (T14).
#[test]
fn t12_t13_t14_torus_nested_spheres_sheet() {
    let torus = look(&shapes::torus(1.0, 0.5, 128, 64)).of_mesh();
    assert!(torus < 0.977_465 + CONVEX, "{torus}");
    let nested = look(&shapes::nested_spheres(0.5, 5).mesh).of_mesh();
    assert_abs_diff_eq!(nested, 1.0 / 1.25, epsilon = CONVEX);
    let sheet = shapes::sheet(1.0, 2.0, [4, 8]);
    let visibility = look(&sheet);
    assert_abs_diff_eq!(visibility.of_mesh(), 1.0, epsilon = 4e-3);
    let back = visibility.back().iter().sum::<f64>() / visibility.back().len() as f64;
    assert_abs_diff_eq!(back, 1.0, epsilon = 4e-3);
}

/// Cauchy: for a closed mesh, four times the mean silhouette is V(M) times the area, silhouettes at twice the width.
#[test]
fn t12_cauchy_links_visibility_to_silhouettes() {
    let ball = shapes::bumpy_sphere(6, 0.15);
    let options = |resolution| MeasureOptions { resolution: Some(resolution), ..MeasureOptions::default() };
    let subject = Subject::new(&ball, BackendKind::Raster).unwrap();
    let visibility = subject.measure(&options(480), &Silent).unwrap();
    let fine = subject.measure(&options(960), &Silent).unwrap();
    // The fine run's pixels are the other source: its unclamped V times area is its covered area.
    assert_abs_diff_eq!(visibility.of_mesh(), fine.of_mesh(), epsilon = 2e-3);
    assert!(visibility.of_mesh() < 0.99, "a bumpy ball hides some of itself");
}
