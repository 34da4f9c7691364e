//! The estimator of Zhang & Turk: triangles cut into pieces, seen or not seen, rescued by depth.

// Leak rates and biases are to be read, with --nocapture, as well as bounded.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use glam::{DMat3, DVec3};
use outsight::backend::BackendKind;
use outsight::camera::{CameraSphere, CameraWeights, Cameras, Frame, Window};
use outsight::geom::triangle_area;
use outsight::mesh::shapes::{self, Tagged};
use outsight::mesh::{TriMesh, TriangleId};
use outsight::progress::Silent;
use outsight::visibility::{
    DepthRescue, DiagramRecorder, Estimator, MeasureOptions, Sides, Subject, Visibility, measure,
};

/// Mean over a surface, 258 area-weighted cameras: the quadrature error of the camera pattern.
const CAMERAS: f64 = 0.01;

/// What pieces half in shadow add to the mean over a cavity at 480 pixels; see
/// `what_half_seen_pieces_add_halves_with_the_pixels`; less than there, since these are cut more finely to begin with.
const HALF_SEEN: f64 = 0.02;

/// Cameras turned away from the walls of boxes.
fn cameras(count: usize) -> CameraSphere {
    let rotation = DMat3::from_rotation_z(0.4) * DMat3::from_rotation_y(1.1) * DMat3::from_rotation_x(0.7);
    CameraSphere::octahedral(count, CameraWeights::Area).unwrap().rotated(rotation)
}

fn look(mesh: &TriMesh, options: &MeasureOptions) -> Visibility {
    let subject = Subject::new(mesh, options.backend).unwrap();
    subject.measure_from(&cameras(258), options, None, &Silent).unwrap()
}

fn area(mesh: &TriMesh, t: usize) -> f64 {
    triangle_area(mesh.corners(TriangleId(t as u32)))
}

fn mean_of(shape: &Tagged, surface: &str) -> f64 {
    let visibility = look(&shape.mesh, &MeasureOptions::paper());
    let sum: f64 = shape.triangles(surface).map(|t| area(&shape.mesh, t) * visibility.front()[t]).sum();
    sum / shape.area(surface)
}

#[test]
fn t1_convex_solids_are_seen_by_everyone_to_the_last_bit() {
    let solids = [
        shapes::icosphere(5),
        shapes::cuboid(DVec3::new(1.0, 2.0, 0.5), 1),
        shapes::cuboid(DVec3::new(1.0, 1e-4, 0.5), 7),
        shapes::tetrahedron(),
        shapes::ellipsoid(DVec3::new(1.0, 0.6, 0.3), 96, 48),
    ];
    // Small pictures: most triangles of the ball have no pixel.
    for (solid, resolution) in solids.iter().flat_map(|s| [(s, 48), (s, 160)]) {
        for camera_weights in [CameraWeights::Equal, CameraWeights::Area] {
            let options = MeasureOptions { camera_weights, resolution: Some(resolution), ..MeasureOptions::paper() };
            let unturned = measure(solid, &options, &Silent).unwrap();
            for visibility in [unturned, look(solid, &options)] {
                assert!(visibility.front().iter().all(|&v| v == 1.0), "{:?}", visibility.details());
                assert_eq!(visibility.of_mesh(), 1.0);
                assert_eq!(visibility.never_seen(), 0);
            }
        }
    }
}

/// A box inside a box, a wall of `pixels` pixels all around it.
fn boxed_box(pixels: f64, resolution: u32) -> Tagged {
    // The outer box is a cube whose corners lie on the unit sphere.
    let outer = 2.0 / 3.0_f64.sqrt();
    let inner = outer - 2.0 * pixels * 2.0 * (1.0 + 2.0 / f64::from(resolution)) / f64::from(resolution);
    let box_of = |edge: f64| shapes::cuboid(DVec3::splat(edge), 12);
    let [outside, inside] = [box_of(outer), box_of(inner)];
    let count = outside.triangle_count();
    let mesh = shapes::merge(&[outside, inside]).unwrap();
    let all = mesh.triangle_count();
    Tagged { mesh, surfaces: vec![("outside", 0..count), ("inside", count..all)], opening_area: 0.0 }
}

#[test]
fn t2_nothing_inside_is_seen_through_walls_of_eight_pixels() {
    for sides in [Sides::One, Sides::Better] {
        for rescue in [DepthRescue::Plain, DepthRescue::Strict, DepthRescue::None] {
            let options = MeasureOptions { sides, rescue, resolution: Some(160), ..MeasureOptions::paper() };
            let boxes = boxed_box(8.0, 160);
            let visibility = look(&boxes.mesh, &options);
            assert!(boxes.triangles("inside").all(|t| visibility.per_triangle()[t] == 0.0 && !visibility.seen()[t]));
            let nested = shapes::nested_spheres(0.7, 4);
            let visibility = look(&nested.mesh, &options);
            assert!(nested.triangles("inner").all(|t| visibility.per_triangle()[t] == 0.0));
        }
    }
}

/// The tolerance reaches 0.5 to 3.1 pixels behind what is shown. Walls thinner than that leak, and how much is printed.
#[test]
fn thin_walls_leak_less_the_thicker_they_are() {
    let leak = |pixels: f64, rescue: DepthRescue| {
        let options = MeasureOptions { rescue, resolution: Some(160), ..MeasureOptions::paper() };
        let boxes = boxed_box(pixels, 160);
        let visibility = look(&boxes.mesh, &options);
        let sum: f64 = boxes.triangles("inside").map(|t| area(&boxes.mesh, t) * visibility.front()[t]).sum();
        sum / boxes.area("inside")
    };
    let thicknesses = [0.25, 0.5, 1.0, 2.0, 3.0, 4.0];
    let [plain, strict, none] = [DepthRescue::Plain, DepthRescue::Strict, DepthRescue::None]
        .map(|rescue| thicknesses.map(|pixels| leak(pixels, rescue)));
    println!("wall in pixels {thicknesses:?}\nplain  {plain:.4?}\nstrict {strict:.4?}\nnone   {none:.4?}");
    assert!(plain.is_sorted_by(|thin, thick| thin >= thick), "{plain:?}");
    assert!(plain[0] > 0.9, "a quarter of a pixel hides nothing from rescue");
    assert!(plain[3] < 0.03 && plain[4] < 0.01, "{plain:?}");
    assert_eq!(plain[5], 0.0, "4 pixels are more than any tolerance");
    assert!(strict.iter().zip(plain).all(|(&strict, plain)| strict <= plain) && strict[1..] == [0.0; 5], "{strict:?}");
    assert_eq!(none, [0.0; 6], "a pixel shows what is in front");
}

#[cfg(feature = "embree")]
#[test]
fn rays_find_the_leaks_of_thin_walls_and_none_on_a_convex_solid() {
    let leaks = |mesh: &TriMesh, rescue, sides| {
        let options = MeasureOptions { rescue, sides, resolution: Some(160), ..MeasureOptions::paper() };
        look(mesh, &options).details().rescue.unwrap().leaks.unwrap()
    };
    let ball = leaks(&shapes::icosphere(5), DepthRescue::Plain, Sides::One);
    assert_eq!((ball.sampled, ball.leaking), (4096, 0));
    // Backs of a closed solid are hidden: whoever rescues them is wrong every time.
    let backs = leaks(&shapes::icosphere(5), DepthRescue::Plain, Sides::Better);
    assert!(backs.leaking > 100, "{backs:?}");
    // A quarter of a pixel hides nothing from rescue: every piece of the inner box leaks, few of the outer lack a pixel.
    let thin = leaks(&boxed_box(0.25, 160).mesh, DepthRescue::Plain, Sides::One);
    assert!(thin.rate().unwrap() > 0.5, "{thin:?}");
    let none = leaks(&boxed_box(0.25, 160).mesh, DepthRescue::None, Sides::One);
    assert_eq!((none.sampled, none.rate()), (0, None));
}

#[cfg(not(feature = "embree"))]
#[test]
fn without_rays_nobody_claims_to_know_how_much_leaks() {
    let options = MeasureOptions { resolution: Some(160), ..MeasureOptions::paper() };
    assert_eq!(look(&shapes::icosphere(5), &options).details().rescue.unwrap().leaks, None);
}

/// Without rescue, triangles smaller than pixels are lost; with it, V(M) is back at the truth.
///
/// A visible triangle of area A, far smaller than a pixel of area s², has a pixel with probability A cos / s²; the mean of
/// that over cameras, each counted by its cosine, is 2 A / (3 s²): the mean of cos² over that of cos is 2/3.
#[test]
fn rescue_gives_back_what_falls_between_pixels() {
    /// Visible triangles are a little larger than hidden ones; some have two pixels, and only one counts.
    const SIZES: f64 = 0.05;
    /// Rescue is generous: corners just beyond a horizon pass.
    const GENEROUS: f64 = 0.02;
    let ball = shapes::bumpy_sphere(6, 0.15);
    let frame = Frame::of(&ball);
    let areas = (0..ball.triangle_count() as u32).filter_map(|t| frame.area_and_normal(&ball, TriangleId(t)));
    let (sum, squares) = areas.fold((0.0, 0.0), |(sum, squares), (a, _)| (sum + a, squares + a * a));
    for resolution in [536, 268, 134, 67] {
        let by = |rescue, estimator| {
            let resolution = Some(resolution);
            let options = MeasureOptions {
                cameras: Cameras::octahedral(66),
                resolution,
                rescue,
                estimator,
                ..MeasureOptions::paper()
            };
            measure(&ball, &options, &Silent).unwrap().of_mesh()
        };
        let truth = by(DepthRescue::None, Estimator::Coverage);
        let [none, strict, plain] = [DepthRescue::None, DepthRescue::Strict, DepthRescue::Plain]
            .map(|rescue| by(rescue, Estimator::ItemBuffer) / truth);
        let left = squares / sum / Window::around_sphere(resolution).pixel_size().powi(2) * 2.0 / 3.0;
        println!(
            "{resolution} pixels: V(M) {truth:.4}; of it none {none:.4} ({left:.4}), strict {strict:.4}, plain {plain:.4}"
        );
        assert!((plain - 1.0).abs() < GENEROUS && (strict - 1.0).abs() < GENEROUS, "{plain} {strict}");
        assert!(left > 0.5 || (none / left - 1.0).abs() < SIZES, "{none} of {left}");
    }
}

#[test]
fn every_backend_agrees_with_the_judge() {
    let meshes =
        [shapes::torus(1.0, 0.5, 16, 8), shapes::cluttered_open_box(3, 6, 2).mesh, shapes::sheet(1.0, 2.0, [3, 5])];
    for (mesh, sides) in meshes.iter().flat_map(|m| [(m, Sides::One), (m, Sides::Better)]) {
        for rescue in [DepthRescue::Plain, DepthRescue::Strict, DepthRescue::None] {
            let options = MeasureOptions { rescue, sides, resolution: Some(32), ..MeasureOptions::paper() };
            let by = |backend| {
                let subject = Subject::new(mesh, backend).unwrap();
                let diagram = DiagramRecorder::new(mesh.triangle_count(), 66, None).unwrap();
                let visibility = subject.measure_from(&cameras(66), &options, Some(&diagram), &Silent).unwrap();
                (visibility, diagram.finish())
            };
            let (judge, judged) = by(BackendKind::Brute);
            let backends = [
                BackendKind::Raster,
                #[cfg(feature = "embree")]
                BackendKind::Embree,
            ];
            for backend in backends {
                let (visibility, seen) = by(backend);
                assert_eq!(visibility.details().pieces, judge.details().pieces);
                // Vertices are snapped or rounded: a pixel centre, and a depth, may fall on the other side.
                let pairs = (0..mesh.triangle_count() as u32).flat_map(|t| (0..66).map(move |v| (TriangleId(t), v)));
                let differ = pairs.clone().filter(|&(t, v)| seen.sees(t, v) != judged.sees(t, v)).count();
                assert!(differ <= pairs.count() / 1000, "{backend:?}: {differ}");
                assert!((visibility.of_mesh() - judge.of_mesh()).abs() < 1e-3, "{backend:?}");
            }
        }
    }
}

#[test]
fn a_camera_sees_a_triangle_if_it_sees_a_piece() {
    // A plate behind a smaller one: head-on, its middle is hidden and its rim is not.
    let plate = |edge: f64, z: f64| {
        let corners =
            [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]].map(|[x, y]: [f64; 2]| DVec3::new(edge * x, edge * y, z));
        TriMesh::new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).unwrap()
    };
    let mesh = shapes::merge(&[plate(1.0, 0.0), plate(0.5, 0.3)]).unwrap();
    let sphere = CameraSphere::octahedral(6, CameraWeights::Equal).unwrap();
    let above = sphere.directions().iter().position(|&d| d == DVec3::Z).unwrap();
    let diagram = DiagramRecorder::new(4, 6, None).unwrap();
    let subject = Subject::new(&mesh, BackendKind::Raster).unwrap();
    let visibility = subject.measure_from(&sphere, &MeasureOptions::paper(), Some(&diagram), &Silent).unwrap();
    assert!(diagram.finish().sees(TriangleId(0), above));
    // Of the six cameras one looks at the plate's front, and a quarter of what it looks at is hidden.
    assert!((visibility.front()[0] - 0.75).abs() < 0.05, "{}", visibility.front()[0]);
    assert_eq!(visibility.front()[2], 1.0);
}

#[test]
fn cavities_have_their_closed_forms_but_for_half_seen_pieces() {
    let discs = shapes::coaxial_discs(1.0, 1.0, [64, 8]);
    assert!((mean_of(&discs, "lower") - 0.618_034).abs() < CAMERAS + HALF_SEEN, "T3: {}", mean_of(&discs, "lower"));
    let bowl = shapes::spherical_bowl(0.5, [64, 32]);
    let expected = bowl.opening_area / bowl.area("inside");
    assert!((mean_of(&bowl, "inside") - expected).abs() < CAMERAS + HALF_SEEN, "T5: {}", mean_of(&bowl, "inside"));
}

/// A piece half in shadow counts as seen: too much by a strip along the shadow's edge as wide as half a piece, so by half
/// as much where pixels, and with them pieces, are half as large. Coverage through the same cameras is the truth.
#[test]
fn what_half_seen_pieces_add_halves_with_the_pixels() {
    let bottom = shapes::open_box(1).triangles("bottom");
    let mean = |resolution, estimator| {
        let options = MeasureOptions { resolution: Some(resolution), estimator, ..MeasureOptions::paper() };
        // The two triangles of the bottom have the same area.
        let front = look(&shapes::open_box(1).mesh, &options).front()[bottom.clone()].to_vec();
        front.iter().sum::<f64>() / front.len() as f64
    };
    let excess = [240, 480, 960].map(|w| mean(w, Estimator::ItemBuffer) - mean(w, Estimator::Coverage));
    println!("excess at 240, 480, 960 pixels: {excess:.4?}");
    // Two shadow edges as long as the floor, each with half a piece of 8 pixels, 0.029 of it at 480; and rescue on top.
    assert!(excess[1] > 0.0 && excess[1] < 0.05, "{excess:?}");
    assert!(excess.windows(2).all(|pair| (0.4..0.65).contains(&(pair[1] / pair[0]))), "{excess:?}");
}

#[test]
fn visibility_is_the_same_at_the_ends_of_the_range_of_numbers_and_on_any_number_of_threads() {
    let mesh = shapes::cluttered_open_box(5, 10, 3).mesh;
    let options = MeasureOptions { resolution: Some(96), ..MeasureOptions::paper() };
    let expected = look(&mesh, &options);
    for exponent in [-1000, 40, 300] {
        let positions = mesh.positions().iter().map(|&p| 2.0_f64.powi(exponent) * p).collect();
        let scaled = TriMesh::new(positions, mesh.triangles().to_vec()).unwrap();
        assert_eq!(look(&scaled, &options), expected, "times 2^{exponent}");
    }
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let three = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    assert_eq!(one.install(|| look(&mesh, &options)), expected);
    assert_eq!(three.install(|| look(&mesh, &options)), expected);
}

#[test]
fn pieces_that_do_not_fit_the_memory_limit_are_refused() {
    let options = MeasureOptions { memory_limit: Some(1 << 20), ..MeasureOptions::paper() };
    let error = measure(&shapes::tetrahedron(), &options, &Silent).unwrap_err();
    assert!(error.to_string().contains("pieces") && error.exit_code() == 5, "{error}");
}
