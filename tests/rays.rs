//! What the estimators that cast rays promise, held against the judge on small meshes.

#![allow(clippy::unwrap_used)]

use glam::DVec3;
use outsight::Error;
use outsight::backend::BackendKind;
use outsight::camera::{CameraSphere, CameraWeights, Cameras};
use outsight::mesh::shapes::{self, Tagged};
use outsight::mesh::{TriMesh, TriangleId};
use outsight::progress::Silent;
use outsight::visibility::{
    DiagramRecorder, Estimator, Hidden, MOST_SAMPLES, MeasureOptions, PartlySeen, RayOptions, SamplingEnd, Sides,
    Subject, Visibility, VisibilityDiagram, look, measure,
};

fn options(estimator: Estimator, rays: RayOptions) -> MeasureOptions {
    let cameras = Cameras::octahedral(66);
    MeasureOptions { backend: BackendKind::Brute, estimator, cameras, rays, ..MeasureOptions::default() }
}

fn surface(points: u32) -> MeasureOptions {
    options(Estimator::Surface, RayOptions { points, ..RayOptions::default() })
}

fn hemisphere(samples: u32) -> MeasureOptions {
    options(Estimator::Hemisphere, RayOptions { samples, ..RayOptions::default() })
}

fn seen(mesh: &TriMesh, options: &MeasureOptions) -> Visibility {
    measure(mesh, options, &Silent).unwrap()
}

/// A box with things in it: some triangles are seen whole, some in part, some not at all.
fn clutter() -> Tagged {
    shapes::cluttered_open_box(5, 2, 3)
}

fn with_diagram(mesh: &TriMesh, options: &MeasureOptions) -> (Visibility, VisibilityDiagram, CameraSphere) {
    let cameras = options.cameras.sphere(options.camera_weights).unwrap();
    let recorder = DiagramRecorder::new(mesh.triangle_count(), cameras.count(), None).unwrap();
    let subject = Subject::new(mesh, options.backend).unwrap();
    let visibility = subject.measure_from(&cameras, options, Some(&recorder), &Silent).unwrap();
    (visibility, recorder.finish(), cameras)
}

#[test]
fn an_occluder_never_lets_more_be_seen() {
    let open = shapes::open_box(4).mesh;
    // Inside the box's box, so that the frame stays; behind all others, so that their numbers stay.
    let ball = shapes::transformed(
        &shapes::icosphere(1),
        &glam::DAffine3::from_scale_rotation_translation(DVec3::splat(0.2), glam::DQuat::IDENTITY, DVec3::splat(0.5)),
    );
    let filled = shapes::merge(&[open.clone(), ball.unwrap()]).unwrap();
    for options in [surface(1), surface(4), surface(7), hemisphere(64)] {
        let [before, after] = [&open, &filled].map(|mesh| seen(mesh, &options));
        let pairs = || before.front().iter().zip(after.front()).chain(before.back().iter().zip(after.back()));
        assert!(pairs().all(|(before, after)| after <= before));
        assert!(pairs().filter(|(before, after)| after < before).count() > 20, "the ball hides something");
    }
}

#[test]
fn the_order_of_triangles_changes_no_visibility() {
    let mesh = clutter().mesh;
    let count = mesh.triangle_count();
    // Multiplication by a number without a common factor is a permutation.
    assert!(!count.is_multiple_of(7));
    let place = |t: usize| t * 7 % count;
    let mut triangles = vec![[0; 3]; count];
    mesh.triangles().iter().enumerate().for_each(|(t, &corners)| triangles[place(t)] = corners);
    let shuffled = TriMesh::new(mesh.positions().to_vec(), triangles).unwrap();
    for points in [1, 3, 4] {
        let [before, after] = [&mesh, &shuffled].map(|mesh| seen(mesh, &surface(points)));
        assert!((0..count).all(|t| before.front()[t] == after.front()[place(t)]));
        assert!((0..count).all(|t| before.back()[t] == after.back()[place(t)]));
    }
}

#[test]
fn any_number_of_threads_gives_the_same_numbers() {
    let mesh = clutter().mesh;
    for options in [surface(1), surface(5), hemisphere(32)] {
        let on = |threads: usize| {
            rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| seen(&mesh, &options))
        };
        let one = on(1);
        assert!(one.front().iter().any(|&v| v > 0.0 && v < 1.0));
        assert_eq!(one, on(2));
        assert_eq!(one, on(3));
    }
}

#[test]
fn the_diagram_holds_what_the_visibility_is_made_of() {
    let mesh = clutter().mesh;
    let mut options = surface(4);
    options.rays.partly_seen = PartlySeen::Whole;
    let (visibility, diagram, cameras) = with_diagram(&mesh, &options);
    let subject = Subject::new(&mesh, BackendKind::Brute).unwrap();
    for t in 0..mesh.triangle_count() {
        let (_, normal) = subject.frame().area_and_normal(&mesh, TriangleId(t as u32)).unwrap();
        let (mut seen, mut all) = (0.0, 0.0);
        for (camera, direction) in cameras.directions().iter().enumerate() {
            let cosine = direction.dot(normal).max(0.0) * cameras.weight(camera as u32) as f64;
            all += cosine;
            seen += if diagram.sees(TriangleId(t as u32), camera) { cosine } else { 0.0 };
        }
        assert!((visibility.front()[t] - seen / all).abs() < 1e-12, "triangle {t}");
    }
}

#[test]
fn a_triangle_seen_in_part_counts_by_its_share_or_whole() {
    let mesh = clutter().mesh;
    let whole = |points| {
        let rays = RayOptions { points, partly_seen: PartlySeen::Whole, ..RayOptions::default() };
        seen(&mesh, &options(Estimator::Surface, rays))
    };
    assert_eq!(seen(&mesh, &surface(1)), whole(1), "one point is seen or not");
    let pairs = seen(&mesh, &surface(4)).front().iter().copied().zip(whole(4).front().to_vec()).collect::<Vec<_>>();
    assert!(pairs.iter().all(|(share, whole)| share <= whole));
    assert!(pairs.iter().filter(|(share, whole)| share < whole).count() > 20);
}

#[test]
fn one_side_costs_half_the_rays() {
    let ball = shapes::icosphere(1);
    let rays = |options: MeasureOptions, sides| seen(&ball, &MeasureOptions { sides, ..options }).details().rays;
    let both = rays(surface(3), Sides::Better);
    assert_eq!(both, 2 * rays(surface(3), Sides::One));
    // A camera sees an edge-on triangle of a symmetric ball from neither side.
    assert!((80 * 60 * 3..=80 * 66 * 3).contains(&both), "{both}");
    assert_eq!(rays(hemisphere(64), Sides::One), 80 * 64);
    assert_eq!(rays(hemisphere(64), Sides::Better), 2 * 80 * 64);
}

/// Each run's true error lies within two standard errors, 95 times in 100, since the scrambles are independent.
#[test]
fn the_standard_error_of_a_hemisphere_is_honest() {
    const RUNS: u64 = 50;
    for (mesh, exact) in [(shapes::open_box(1).mesh, 0.2), (shapes::parallel_squares(1.0, 1).mesh, 0.800_175)] {
        let runs = (0..RUNS).map(|seed| {
            let mut options = MeasureOptions { sides: Sides::One, ..hemisphere(256) };
            options.rays.seed = seed;
            let visibility = seen(&mesh, &options);
            let error = visibility.details().standard_error.clone().unwrap().of_mesh;
            (visibility.of_mesh() - exact, error)
        });
        let runs: Vec<(f64, f64)> = runs.collect();
        let within = runs.iter().filter(|(off, error)| off.abs() <= 2.0 * error).count();
        assert!(within as f64 >= 0.85 * RUNS as f64, "{within} of {RUNS} within two standard errors of {exact}");
        // Nor is it too careful.
        let root_mean = |values: &dyn Fn(&(f64, f64)) -> f64| {
            (runs.iter().map(|run| values(run).powi(2)).sum::<f64>() / RUNS as f64).sqrt()
        };
        let ratio = root_mean(&|run| run.0) / root_mean(&|run| run.1);
        assert!((0.7..1.4).contains(&ratio), "{ratio}");
    }
}

#[test]
fn more_samples_come_until_the_error_is_reached() {
    let mesh = shapes::open_box(2).mesh;
    let run = |target_error, target_error_p99| {
        let rays = RayOptions { samples: 10, target_error, target_error_p99, ..RayOptions::default() };
        seen(&mesh, &options(Estimator::Hemisphere, rays)).details().standard_error.clone().unwrap()
    };
    let asked = run(None, None);
    assert_eq!((asked.samples, asked.end), (16, SamplingEnd::AsAsked));
    let mesh_error = run(Some(1e-3), None);
    assert!(mesh_error.of_mesh <= 1e-3 && mesh_error.samples > 16 && mesh_error.samples.is_power_of_two());
    assert_eq!(mesh_error.end, SamplingEnd::TargetReached);
    let single = run(None, Some(0.02));
    assert!(single.p99 <= 0.02 && single.samples > 16);
    assert!(single.per_triangle.iter().filter(|&&error| error > single.p99).count() * 100 <= mesh.triangle_count());
}

#[test]
fn an_error_out_of_reach_ends_with_what_was_reached() {
    let lid = shapes::parallel_squares(0.5, 1).mesh;
    let rays = RayOptions { target_error: Some(1e-9), ..RayOptions::default() };
    let options = MeasureOptions { sides: Sides::One, ..options(Estimator::Hemisphere, rays) };
    let error = seen(&lid, &options).details().standard_error.clone().unwrap();
    assert_eq!((error.samples, error.end), (MOST_SAMPLES, SamplingEnd::MostSamples));
    assert!(error.of_mesh > 1e-9 && error.of_mesh < 1e-3, "{}", error.of_mesh);
}

#[test]
fn without_a_hit_or_a_miss_the_error_is_the_bound_of_a_share_that_never_showed() {
    let error = seen(&shapes::icosphere(1), &hemisphere(64)).details().standard_error.clone().unwrap();
    assert!(error.per_triangle.iter().all(|&error| error == 3.0 / 64.0));
    assert_eq!(error.p99, 3.0 / 64.0);
    // Eighty triangles of about one size, each with its bound: less by the root of their number.
    approx::assert_relative_eq!(error.of_mesh, 3.0 / 64.0 / 80.0_f64.sqrt(), max_relative = 0.05);
}

/// Few rays of a large triangle meet a small thing above it: who met none must not take that for certain.
#[test]
fn the_error_of_a_mean_is_honest_where_large_triangles_see_all_but_a_little() {
    let small = glam::DAffine3::from_scale_rotation_translation(
        DVec3::splat(0.1),
        glam::DQuat::IDENTITY,
        DVec3::new(0.45, 0.45, 0.3),
    );
    let above = shapes::transformed(&shapes::icosphere(0), &small).unwrap();
    let scene = shapes::merge(&[shapes::sheet(1.0, 1.0, [1, 1]), above]).unwrap();
    let one_sided = |samples, seed| {
        let mut options = MeasureOptions { sides: Sides::One, ..hemisphere(samples) };
        options.rays.seed = seed;
        seen(&scene, &options)
    };
    let truth = one_sided(16384, 99).of_mesh();
    let honest = (0..20).filter(|&seed| {
        let found = one_sided(16, seed);
        (found.of_mesh() - truth).abs() <= 2.0 * found.details().standard_error.as_ref().unwrap().of_mesh
    });
    assert!(honest.count() >= 17, "two standard errors hold in fewer than 85 %");
}

#[test]
fn seeds_change_what_is_random_and_nothing_else() {
    let mesh = clutter().mesh;
    let with_seed = |mut options: MeasureOptions, seed| {
        options.rays.seed = seed;
        seen(&mesh, &options)
    };
    assert_ne!(with_seed(hemisphere(8), 1), with_seed(hemisphere(8), 2));
    assert_ne!(with_seed(surface(7), 1), with_seed(surface(7), 2));
    assert_eq!(with_seed(surface(4), 1), with_seed(surface(4), 2));
}

#[test]
fn hidden_triangles_are_looked_for_with_pictures() {
    let sealed = shapes::cluttered_sealed_box(1, 1, 2);
    let options = MeasureOptions { resolution: Some(64), ..surface(1) };
    assert_eq!(Hidden::Delete.backend(), Some(BackendKind::Raster));
    let hidden = look(&sealed.mesh, &options, Hidden::Delete, &Silent).unwrap().hidden;
    assert!(sealed.triangles("clutter").all(|t| hidden[t]) && sealed.triangles("outside").all(|t| !hidden[t]));
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let refused = |options: &MeasureOptions| {
        let error = measure(&shapes::tetrahedron(), options, &Silent).unwrap_err();
        assert!(matches!(error, Error::Option { .. }), "{error}");
        error.to_string()
    };
    for estimator in [Estimator::Surface, Estimator::Hemisphere] {
        let message = refused(&MeasureOptions { estimator, ..MeasureOptions::default() });
        assert!(message.starts_with("--estimator: ") && message.ends_with("add --backend embree"), "{message}");
    }
    let with = |rays| refused(&options(Estimator::Hemisphere, rays));
    let rays = RayOptions::default;
    assert!(with(RayOptions { points: 0, ..rays() }).starts_with("--points: 0 points"));
    assert!(with(RayOptions { samples: 7, ..rays() }).starts_with("--samples: 7 rays"));
    assert!(with(RayOptions { target_error: Some(0.0), ..rays() }).starts_with("--target-error: 0;"));
    assert!(with(RayOptions { target_error_p99: Some(f64::NAN), ..rays() }).starts_with("--target-error-p99: NaN;"));

    let mesh = shapes::tetrahedron();
    let recorder = DiagramRecorder::new(4, 66, None).unwrap();
    let cameras = CameraSphere::octahedral(66, CameraWeights::Area).unwrap();
    let subject = Subject::new(&mesh, BackendKind::Brute).unwrap();
    let error = subject.measure_from(&cameras, &hemisphere(8), Some(&recorder), &Silent).unwrap_err();
    assert!(error.to_string().starts_with("--estimator: hemisphere looks in random directions"), "{error}");
}
