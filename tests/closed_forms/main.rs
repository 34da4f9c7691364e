//! Visibility against exact answers, for every estimator on every backend that can serve it.
//!
//! Each expected number is the mean of eq. (3.1) of Zhang & Turk 2002 over a surface, known in closed form: V is one
//! minus the classical form factor toward opaque geometry. Cameras are turned away from the coordinate planes, in which
//! octahedral cameras lie exactly. The pairs, their tolerances and the reasons for these are in `pair.rs`.

#![allow(clippy::unwrap_used)]

mod pair;

use std::f64::consts::PI;

use approx::assert_abs_diff_eq;
use glam::{DAffine3, DVec3};
use outsight::backend::{BackendKind, Workload};
use outsight::camera::{CameraSphere, CameraWeights, Window};
use outsight::geom::triangle_area;
use outsight::mesh::shapes::{self, Tagged};
use outsight::mesh::{TriMesh, TriangleId};
use outsight::progress::Silent;
use outsight::visibility::{CoverageCounts, DepthRescue, Sides, Subject};

use pair::Pair;

/// One test per claim and pair; a new pair needs a function in `pair.rs` and a line here.
macro_rules! suite {
    ($($pair:ident),+ $(,)?) => { $(mod $pair {
        #[test]
        fn t1_convex_solids_are_seen_whole() { super::convex_solids(&super::pair::$pair()); }
        #[test]
        fn t1_holds_with_every_number_of_cameras_and_both_weights() { super::all_cameras(&super::pair::$pair()); }
        #[test]
        fn t1_holds_at_the_ends_of_the_range_of_numbers() { super::all_scales(&super::pair::$pair()); }
        #[test]
        fn t2_nothing_inside_a_sealed_shell_is_seen() { super::sealed_shells(&super::pair::$pair()); }
        #[test]
        fn t3_coaxial_discs_and_parallel_squares() { super::discs_and_squares(&super::pair::$pair()); }
        #[test]
        fn t4_wedges() { super::wedges(&super::pair::$pair()); }
        #[test]
        fn t5_a_bowl_is_seen_alike_at_every_point() { super::bowls(&super::pair::$pair()); }
        #[test]
        fn t6_t7_a_shell_with_a_hole() { super::shells_with_a_hole(&super::pair::$pair()); }
        #[test]
        fn t8_a_cylindrical_well() { super::wells(&super::pair::$pair()); }
        #[test]
        fn t9_a_long_slot() { super::slots(&super::pair::$pair()); }
        #[test]
        fn t10_an_open_box() { super::open_boxes(&super::pair::$pair()); }
        #[test]
        fn t11_whatever_is_inside_a_cavity_shares_the_light_of_its_opening() {
            super::cluttered_cavities(&super::pair::$pair());
        }
        #[test]
        fn t12_cauchy_links_visibility_to_silhouettes() { super::silhouettes(&super::pair::$pair()); }
        #[test]
        fn t12_two_balls_and_a_torus_hide_some_of_themselves() { super::balls_and_torus(&super::pair::$pair()); }
        #[test]
        fn t13_t14_nested_spheres_and_a_sheet() { super::spheres_and_sheet(&super::pair::$pair()); }
    })+ };
}

suite!(coverage_on_raster, item_buffer_on_raster, surface_on_brute, hemisphere_on_brute);

#[cfg(feature = "embree")]
suite!(coverage_on_embree, item_buffer_on_embree, surface_on_embree, hemisphere_on_embree);

/// What a smooth shape's answer may differ from its mesh's, where that has less area.
fn polygonal(mesh_area: f64, smooth_area: f64) -> f64 {
    1.5 * (1.0 - mesh_area / smooth_area)
}

fn area(mesh: &TriMesh) -> f64 {
    (0..mesh.triangle_count()).map(|t| triangle_area(mesh.corners(TriangleId(t as u32)))).sum()
}

/// V(M) of a whole mesh: the expected number, up to what the pair may be off and `polygonal`.
#[track_caller]
fn check_mesh(pair: &Pair, mesh: &TriMesh, expected: f64, polygonal: f64) {
    let visibility = pair.look(mesh);
    let error = visibility.details().standard_error.as_ref().map_or(0.0, |error| error.of_mesh);
    let tolerance = pair.mean + 4.0 * error + pair.half_seen(mesh, area(mesh)) + polygonal;
    assert_abs_diff_eq!(visibility.of_mesh(), expected, epsilon = tolerance);
}

fn convex_solids(pair: &Pair) {
    // The strict rule loses slivers beside sharp edges.
    let pair = &pair.rescuing(DepthRescue::Plain);
    let [segments, rings] = pair.round([96, 48]);
    let solids = [
        shapes::icosphere(pair.level(5)),
        shapes::cuboid(DVec3::new(1.0, 2.0, 0.5), pair.cells(7)),
        shapes::tetrahedron(),
        shapes::ellipsoid(DVec3::new(1.0, 0.6, 0.3), segments, rings),
    ];
    for solid in solids {
        let visibility = pair.look(&solid);
        assert_abs_diff_eq!(visibility.of_mesh(), 1.0, epsilon = pair.certain);
        assert_eq!(visibility.never_seen(), 0);
        let back = visibility.back().iter().sum::<f64>() / visibility.back().len() as f64;
        assert!(back <= pair.backs, "nobody sees a closed solid's back: {back}");
    }
}

fn all_cameras(pair: &Pair) {
    // The strict rule loses slivers beside sharp edges.
    let pair = &pair.rescuing(DepthRescue::Plain);
    let sphere = shapes::icosphere(pair.level(4));
    // The dear ones stand where pairs that are short of time leave them out.
    for cameras in pair.some(&[6, 258, 18, 1026, 66]) {
        for weights in [CameraWeights::Area, CameraWeights::Equal] {
            let visibility = pair.measure(&sphere, cameras, weights);
            assert_abs_diff_eq!(visibility.of_mesh(), 1.0, epsilon = pair.certain_if_coarse);
            assert_eq!(visibility.cameras(), if pair.has_cameras() { cameras } else { 0 });
        }
    }
}

fn all_scales(pair: &Pair) {
    let well = shapes::open_box(pair.cells(8)).mesh;
    let expected = pair.look(&well);
    for exponent in [-1000, -40, 40, 300] {
        let scale = 2.0_f64.powi(exponent);
        let positions = well.positions().iter().map(|&p| scale * p).collect();
        let scaled = TriMesh::new(positions, well.triangles().to_vec()).unwrap();
        assert_eq!(pair.look(&scaled), expected, "times 2^{exponent}");
    }
}

fn sealed_shells(pair: &Pair) {
    // Clutter comes within three pixels of the walls, through which rescue reaches; it also finds backs on outlines.
    let pair = &pair.rescuing(DepthRescue::None);
    for seed in 0..4 {
        let shape = shapes::cluttered_sealed_box(seed, pair.pieces(20), pair.cells(4));
        let visibility = pair.look_at(&shape.mesh, Sides::Better);
        assert!(shape.triangles("clutter").all(|t| visibility.front()[t] == 0.0 && visibility.back()[t] == 0.0));
        assert!(shape.triangles("clutter").all(|t| visibility.per_triangle()[t] == 0.0 && !visibility.seen()[t]));
        assert!(shape.triangles("outside").all(|t| visibility.back()[t] == 0.0));
    }
}

fn discs_and_squares(pair: &Pair) {
    let rim = pair.round([128, 16]);
    let gaps = [(0.25, 0.220_696), (0.5, 0.390_388), (1.0, 0.618_034), (2.0, 0.828_427), (4.0, 0.944_272)];
    for (gap, expected) in pair.some(&gaps) {
        let discs = shapes::coaxial_discs(1.0, gap, rim);
        let polygonal = polygonal(discs.area("lower"), PI);
        let seen = pair.see(&discs);
        seen.check("lower", expected, polygonal);
        seen.check("upper", expected, polygonal);
    }
    for (gap, expected) in [(0.5, 0.584_747), (1.0, 0.800_175), (2.0, 0.931_410)] {
        pair.see(&shapes::parallel_squares(gap, pair.cells(16))).check("lower", expected, 0.0);
    }
}

fn wedges(pair: &Pair) {
    let squares = shapes::right_angle_squares(pair.cells(16));
    let seen = pair.see(&squares);
    seen.check("floor", 0.799_956, 0.0);
    seen.check("wall", 0.799_956, 0.0);
    let length = pair.length(20.0);
    for degrees in [30.0_f64, 60.0, 90.0, 120.0] {
        let angle = degrees.to_radians();
        let wedge = shapes::wedge(angle, length, pair.round([16, 32]));
        let seen = pair.see(&wedge);
        // Infinite strips have sin(α/2); the open ends of finite ones let in at most their own area.
        let infinite = (0.5 * angle).sin();
        let ends = angle.sin() / (2.0 * length);
        let (mean, tolerance) = (seen.mean_of_all(), seen.tolerance());
        assert!(mean > infinite - tolerance && mean < infinite + ends + tolerance, "{degrees}°: {mean}");
    }
}

fn bowls(pair: &Pair) {
    for fraction in [0.25, 0.5, 0.75] {
        let bowl = shapes::spherical_bowl(fraction, pair.round([96, 64]));
        let seen = pair.see(&bowl);
        // The mean through the theorem of T11, which holds for the polyhedron; the points through the smooth sphere.
        seen.check("inside", bowl.opening_area / bowl.area("inside"), 0.0);
        let polygonal = polygonal(bowl.area("inside"), 4.0 * PI * fraction);
        let front = seen.visibility.front();
        let squares = bowl.triangles("inside").map(|t| (front[t] - (1.0 - fraction)).powi(2));
        let rms = (squares.sum::<f64>() / bowl.triangles("inside").count() as f64).sqrt();
        let tolerance = pair.point_rms + polygonal + pair.half_seen(&bowl.mesh, bowl.area("inside"));
        assert!(rms < tolerance, "fraction {fraction}: {rms}");
    }
}

fn shells_with_a_hole(pair: &Pair) {
    let shell = shapes::shell_with_hole(PI / 3.0, pair.round([96, 64]));
    // The theorem of T11 holds for the polyhedron; (1 − cos ψ)/2 for the smooth shell.
    let inside = shell.area("inside");
    let polygonal = polygonal(inside, 3.0 * PI);
    assert_abs_diff_eq!(shell.opening_area / inside, 0.25, epsilon = polygonal);
    pair.see(&shell).check("inside", shell.opening_area / inside, 0.0);

    let filled = shapes::shell_with_hole_and_ball(PI / 3.0, 0.4, pair.round([96, 64]));
    let seen = pair.see(&filled);
    seen.check("ball", 0.25, polygonal);
    seen.check("inside", 0.196_667, polygonal);

    let narrow = shapes::shell_with_hole(PI / 6.0, pair.round([96, 64]));
    let expected = narrow.opening_area / narrow.area("inside");
    pair.see(&narrow).check("inside", expected, pair.narrow * expected);
    if !pair.has_cameras() {
        // Three of 258 cameras look in through 10°.
        let slit = shapes::shell_with_hole(PI / 18.0, pair.round([96, 64]));
        pair.see(&slit).check("inside", slit.opening_area / slit.area("inside"), 0.0);
    }
}

fn wells(pair: &Pair) {
    let all = [
        (0.5, 0.609_612, 0.390_388),
        (1.0, 0.381_966, 0.309_017),
        (2.0, 0.171_573, 0.207_107),
        (4.0, 0.055_728, 0.118_034),
    ];
    for (depth, bottom, wall) in pair.some(&all) {
        let well = shapes::cylindrical_well(depth, pair.round([96, 24]));
        let polygonal = polygonal(well.area("bottom"), PI);
        let seen = pair.see(&well);
        seen.check("bottom", bottom, polygonal);
        seen.check("walls", wall, polygonal);
        assert_abs_diff_eq!(seen.mean_of_all(), well.opening_area / area(&well.mesh), epsilon = seen.tolerance());
    }
}

/// Form factor between equal rectangles face to face, of edges `x` and `y` times their distance.
///
/// Source: the standard view factor of aligned parallel rectangles, as in Howell's catalogue, C-11.
fn parallel_rectangles(x: f64, y: f64) -> f64 {
    let [x1, y1] = [x, y].map(|edge| (1.0 + edge * edge).sqrt());
    let corners = (x1 * y1 / (1.0 + x * x + y * y).sqrt()).ln();
    let sides = x * y1 * (x / y1).atan() + y * x1 * (y / x1).atan();
    2.0 / (PI * x * y) * (corners + sides - x * x.atan() - y * y.atan())
}

/// T9 is an endless slot, which no mesh is: a long closed one has an exact answer too, near the endless one's.
fn slots(pair: &Pair) {
    let pair = &pair.without_rescue_at_folds();
    let length = pair.length(20.0);
    for (depth, endless) in [(1.0, 0.414_214), (2.0, 0.236_068)] {
        let bottom = parallel_rectangles(1.0 / depth, length / depth);
        assert!(bottom < endless && endless - bottom < 0.5 / length, "{bottom} is no finite slot's");
        let cube = shapes::open_box(pair.cells(32));
        let longer = DAffine3::from_scale(DVec3::new(1.0, length, depth));
        let mesh = shapes::transformed(&cube.mesh, &longer).unwrap();
        let slot = Tagged { mesh, surfaces: cube.surfaces, opening_area: length };
        let seen = pair.see(&slot);
        seen.check("bottom", bottom, 0.0);
        // What the bottom does not get of the opening's light, the walls do (T11).
        seen.check("walls", length * (1.0 - bottom) / slot.area("walls"), 0.0);
    }
}

fn open_boxes(pair: &Pair) {
    pair.see(&shapes::open_box_solid(0.1, pair.cells(16))).check("bottom", 0.199_825, 0.0);
    let pair = &pair.without_rescue_at_folds();
    assert_abs_diff_eq!(parallel_rectangles(1.0, 1.0), 0.199_825, epsilon = 1e-6);
    let shape = shapes::open_box(pair.cells(16));
    let seen = pair.see(&shape);
    seen.check("bottom", 0.199_825, 0.0);
    seen.check("walls", 0.200_044, 0.0);
    assert_abs_diff_eq!(seen.mean_of_all(), 0.2, epsilon = seen.tolerance());
}

fn cluttered_cavities(pair: &Pair) {
    let pair = &pair.without_rescue_at_folds();
    for (seed, count) in [(1, 0), (2, 5), (3, 20), (4, 60)] {
        let shape = shapes::cluttered_open_box(seed, pair.pieces(count), pair.cells(8));
        let seen = pair.see(&shape);
        let relative = area(&shape.mesh) / shape.opening_area;
        // Each of `n` bodies of area Aᵢ casts a shadow with an edge of about 2 √Aᵢ, all together 2 √(n Σ Aᵢ) at most.
        let bodies = ((pair.pieces(count) + 1) as f64).sqrt();
        let tolerance = seen.tolerance() + (bodies - 1.0) * pair.half_seen(&shape.mesh, area(&shape.mesh));
        assert_abs_diff_eq!(relative * seen.mean_of_all(), 1.0, epsilon = relative * tolerance);
    }
}

/// Cauchy: for a closed mesh, V(M) is four times the mean silhouette over the area. The silhouettes are the raster's, at
/// twice the usual resolution and from other cameras.
fn silhouettes(pair: &Pair) {
    /// Spread of the cameras' mean cosine over normals, and pixels along outlines.
    const SILHOUETTE: f64 = 5e-3;
    let [segments, sides] = pair.round([128, 64]);
    for mesh in [shapes::bumpy_sphere(pair.level(5), 0.15), shapes::torus(1.0, 0.5, segments, sides)] {
        let subject = Subject::new(&mesh, BackendKind::Raster).unwrap();
        let cameras = CameraSphere::octahedral(1026, CameraWeights::Area).unwrap();
        let window = Window::around_sphere(960);
        let load = Workload { window, memory_limit: None, phase: "looking", progress: &Silent };
        let counts = CoverageCounts::of(subject.machine(), mesh.triangle_count(), &cameras, load, None).unwrap();
        let pixels = counts.covered() as f64 / cameras.total_weight() as f64;
        let silhouette = pixels * (window.pixel_size() * subject.frame().radius).powi(2);
        let expected = 4.0 * silhouette / area(&mesh);
        assert!(expected < 0.99, "it hides some of itself");
        check_mesh(pair, &mesh, expected, SILHOUETTE);
    }
}

fn balls_and_torus(pair: &Pair) {
    let ball = shapes::icosphere(pair.level(5));
    // Inscribed balls are smaller at the same distance, and hide less of each other.
    let polygonal = polygonal(area(&ball), 4.0 * PI);
    for (distance, expected) in pair.some(&[(2.0, 0.924_413), (2.5, 0.955_881), (3.0, 0.970_410), (4.0, 0.983_844)]) {
        let moved = DAffine3::from_translation(DVec3::new(0.6, 0.0, 0.8) * distance);
        let other = shapes::transformed(&ball, &moved).unwrap();
        check_mesh(pair, &shapes::merge(&[ball.clone(), other]).unwrap(), expected, polygonal);
    }
    let [segments, sides] = pair.round([128, 64]);
    let ring = shapes::torus(1.0, 0.5, segments, sides);
    let torus = pair.look(&ring).of_mesh();
    // The hull's area over the torus's.
    assert!(torus < 0.977_465 + pair.mean + pair.half_seen(&ring, area(&ring)), "{torus}");
}

/// R² / (R² + r²) for nested spheres (T13), of which the inner is sealed (T2); a sheet alone has 1 on both sides (T14).
fn spheres_and_sheet(pair: &Pair) {
    let pair = &pair.rescuing(DepthRescue::Plain);
    let nested = shapes::nested_spheres(0.5, pair.level(5));
    let visibility = pair.look(&nested.mesh);
    assert_abs_diff_eq!(visibility.of_mesh(), 1.0 / 1.25, epsilon = pair.certain + 1e-12);
    assert!(nested.triangles("inner").all(|t| visibility.per_triangle()[t] == 0.0));
    let sheet = shapes::sheet(1.0, 2.0, [4, 8]);
    let visibility = pair.look_at(&sheet, Sides::Better);
    assert_abs_diff_eq!(visibility.of_mesh(), 1.0, epsilon = pair.certain_if_coarse);
    let back = visibility.back().iter().sum::<f64>() / visibility.back().len() as f64;
    assert_abs_diff_eq!(back, 1.0, epsilon = pair.certain_if_coarse);
}
