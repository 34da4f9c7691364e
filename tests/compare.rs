//! Comparing meshes: known distances, an independent picture, refusals.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use glam::DVec3;
use outsight::backend::{EmbreeScene, GridScratch, ItemBuffers};
use outsight::camera::{Frame, View, Window};
use outsight::eval::geometric::{GeometricOptions, ReferenceSurface, SampleCount, SeenError};
use outsight::eval::{Gallery, Reference, Shot};
use outsight::geom::{dodecahedron_axes, triangle_normal};
use outsight::mesh::{TriMesh, TriangleId, shapes};
use outsight::progress::Silent;
use outsight::raster::ItemBufferPair;
use outsight::visibility::{MeasureOptions, measure};
use serde_json::Value;

/// Sums of 1e5 distances of size 1.
const ROUNDING: f64 = 1e-12;

/// A box of these half sides, two triangles a side.
fn cuboid(half: DVec3) -> TriMesh {
    shapes::cuboid(2.0 * half, 1)
}

fn turned_over(mesh: &TriMesh, which: impl Fn(usize) -> bool) -> TriMesh {
    let (positions, mut triangles) = mesh.clone().into_parts();
    triangles.iter_mut().enumerate().filter(|(t, _)| which(*t)).for_each(|(_, t)| t.swap(1, 2));
    TriMesh::new(positions, triangles).unwrap()
}

fn samples(count: u64) -> GeometricOptions {
    GeometricOptions { samples: SampleCount::Exactly(count), seed: 0 }
}

/// A box of half sides 3, 4, 5 inside one that is larger by d on every side. From the inside out the nearest side is d
/// away from everywhere. From the outside in, a point above the inner side is d away, and one in the rim, up to d beyond an
/// edge, is √(d² + x²) or, in the corner squares, √(d² + x² + y²) away: 3-D offsets have closed forms.
#[test]
fn nested_boxes_are_their_offset_apart() {
    let d = 0.5;
    let inner = DVec3::new(3.0, 4.0, 5.0);
    let (inside, outside) = (cuboid(inner), cuboid(inner + DVec3::splat(d)));
    let error = ReferenceSurface::new(&inside, None, samples(400_000)).unwrap().compare(&outside, &Silent).unwrap();
    for exact in [error.forward.mean, error.forward.rms, error.forward.max] {
        assert!((exact - d).abs() < ROUNDING, "{error:?}");
    }
    assert!((error.backward.max - d * 3.0_f64.sqrt()).abs() < ROUNDING, "corner to corner");
    // Of each side of 2a × 2b of the inner box, the outer has 2(a+d) × 2(b+d): its middle, 4(a+b)d of rim, 4d² of corners.
    let [a, b, c] = inner.to_array();
    let faces = [[a, b], [b, c], [c, a]];
    let area: f64 = faces.iter().map(|[a, b]| 4.0 * (a + d) * (b + d)).sum();
    // Mean of x² over 0..d is d²/3.
    let squares: f64 = faces
        .iter()
        .map(|[a, b]| d * d * (4.0 * a * b + 4.0 * (a + b) * d * (4.0 / 3.0) + 4.0 * d * d * (5.0 / 3.0)))
        .sum();
    // Well-spread samples; plain random ones would be off by 2e-4.
    assert!((error.backward.rms - (squares / area).sqrt()).abs() < 5e-5, "{error:?}");
}

/// A shell with a kernel that no camera sees; the test has the shell in place and the kernel smaller by d.
#[test]
fn error_of_hidden_surface_is_told_from_that_of_visible_surface() {
    let (shell, kernel) = (cuboid(DVec3::splat(2.0)), cuboid(DVec3::splat(1.0)));
    let d = 0.125;
    let whole = shapes::merge(&[shell.clone(), kernel]).unwrap();
    let test = shapes::merge(&[shell, cuboid(DVec3::splat(1.0 - d))]).unwrap();
    let seen = measure(&whole, &MeasureOptions::default(), &Silent).unwrap();
    let surface = ReferenceSurface::new(&whole, Some(seen.per_triangle()), samples(100_000)).unwrap();
    let error = surface.compare(&test, &Silent).unwrap();
    let SeenError { visible, hidden, weighted_rms } = error.seen.unwrap();
    let (visible, hidden) = (visible.unwrap(), hidden.unwrap());
    assert!(visible.max < ROUNDING && weighted_rms.unwrap() < ROUNDING, "{error:?}");
    assert!(hidden.mean >= d && (hidden.max - d * 3.0_f64.sqrt()).abs() < ROUNDING);
    // The kernel has a fifth of the area.
    assert!((error.forward.mean - hidden.mean / 5.0).abs() < 1e-5, "{error:?}");
}

/// Two plates at heights 0 and 1 of areas 1 and 3, seen at V = 1/2 and 1/4; the test has the first alone. Then ∫ V d² is
/// 3/4 and ∫ V is 5/4.
#[test]
fn weighted_error_is_the_ratio_of_the_integrals() {
    let plate = |z: f64, width: f64| {
        let corners = [[0., 0.], [width, 0.], [width, 1.], [0., 1.]].map(|[x, y]| DVec3::new(x, y, z));
        TriMesh::new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).unwrap()
    };
    let (low, high) = (plate(0.0, 3.0), plate(1.0, 3.0));
    let narrow = plate(0.0, 1.0);
    let reference = shapes::merge(&[narrow, high]).unwrap();
    let visibility = [0.5, 0.5, 0.25, 0.25];
    let surface = ReferenceSurface::new(&reference, Some(&visibility), samples(100_000)).unwrap();
    let seen = surface.compare(&low, &Silent).unwrap().seen.unwrap();
    assert!((seen.weighted_rms.unwrap() - (0.75_f64 / 1.25).sqrt()).abs() < 1e-5, "{seen:?}");
    assert_eq!(seen.hidden, None);
}

#[test]
fn visibility_of_another_mesh_is_refused() {
    let refused = ReferenceSurface::new(&cuboid(DVec3::ONE), Some(&[1.0; 3]), samples(1));
    assert!(matches!(refused, Err(outsight::Error::ShapeMismatch { got: 3, expected: 12, .. })));
}

#[test]
fn triangles_gone_wrong_are_counted() {
    let ball = shapes::icosphere(3);
    let reference = Reference::new(&ball, None, samples(1000), &Silent).unwrap();
    let quality = |test: &TriMesh| reference.compare(test, &Silent).unwrap().quality;

    let own = quality(&ball);
    assert_eq!((own.flipped, own.degenerate, own.non_manifold_edges), (0, 0, 0));
    assert_eq!(quality(&shapes::icosphere(1)).flipped, 0);

    let some = quality(&turned_over(&ball, |t| t % 4 == 0));
    assert_eq!(some.flipped, ball.triangle_count() / 4);
    assert!((some.flipped_area - 0.25).abs() < 0.01, "{some:?}");

    // A fin on an edge of the ball, and a triangle whose corners lie on a line.
    let (mut positions, mut triangles) = ball.clone().into_parts();
    let [a, b, _] = triangles[0];
    let (p, q, first) = (positions[a as usize], positions[b as usize], positions.len() as u32);
    positions.extend([1.5 * p, p + q, 2.0 * (p + q), 3.0 * (p + q)]);
    triangles.extend([[a, b, first], [first + 1, first + 2, first + 3]]);
    let spoilt = quality(&TriMesh::new(positions, triangles).unwrap());
    assert_eq!((spoilt.degenerate, spoilt.non_manifold_edges, spoilt.new_non_manifold_edges), (1, 1, 1));
}

/// Both sides of a sheet as two coincident triangles: each lies on one that faces as it does.
#[test]
fn coincident_sheets_are_not_flipped_against_themselves() {
    let sheet = TriMesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2], [2, 1, 0]]).unwrap();
    let reference = Reference::new(&sheet, None, samples(1000), &Silent).unwrap();
    assert_eq!(reference.compare(&sheet, &Silent).unwrap().quality.flipped, 0);
}

/// Pixels of a picture along its side, of 2 × 2 samples.
const WIDTH: u32 = 512;

/// Greys further apart than this are different pixels: `f32` keeps six digits of 255.
const GREY_ROUNDING: f32 = 1e-3;

/// Most pixels that may differ, of those covered: samples on an edge between triangles are decided by rounding.
const MAX_DIFFERENT: f64 = 1e-3;

/// Of the pixels that either picture covers, those that differ from a picture by rays: one ray of Embree's for each
/// sample, shaded by the normal of the triangle that it hits first. Drawn, lit and averaged apart from our pictures.
fn differing_pixels(mesh: &TriMesh) -> f64 {
    let frame = Frame::of(mesh);
    let embree = EmbreeScene::new(&frame.unit_copy(mesh)).unwrap();
    let gallery = Gallery::new(mesh, mesh);
    let (mut covered, mut different) = (0_u32, 0_u32);
    for toward in dodecahedron_axes() {
        let half_width = 0.5 * mesh.bounds().diagonal() / frame.radius;
        let up = toward.any_orthonormal_vector();
        let ours = gallery.picture(&Shot { toward, up, width: WIDTH, half_width }, 0.0).unwrap().pixels;
        let view = View::upright(toward, up, Window { width: 2 * WIDTH, half_width });
        let mut rays = ItemBufferPair::new(view.window);
        embree.draw(&view, &mut GridScratch::default(), &mut rays).unwrap();
        let hits: Vec<_> = rays.near().collect();
        let grey = |sample: u32| {
            let normal = |t: TriangleId| triangle_normal(mesh.corners(t)).unwrap();
            hits[sample as usize].map_or(0.0, |hit| 255.0 * normal(hit.triangle).dot(toward).abs())
        };
        for (pixel, &own) in (0..).zip(&ours) {
            let (column, row) = (2 * (pixel % WIDTH), 2 * (WIDTH - 1 - pixel / WIDTH));
            let corner = row * 2 * WIDTH + column;
            let traced = [0, 1, 2 * WIDTH, 2 * WIDTH + 1].map(|offset| grey(corner + offset)).iter().sum::<f64>() / 4.0;
            covered += u32::from(own > 0.0 || traced > 0.0);
            different += u32::from((own - traced as f32).abs() > GREY_ROUNDING);
        }
    }
    f64::from(different) / f64::from(covered)
}

#[test]
fn pictures_are_those_of_an_independent_ray_caster() {
    let clutter = shapes::cluttered_open_box(3, 20, 4).mesh;
    for (name, mesh) in [("bumpy ball", shapes::bumpy_sphere(5, 0.1)), ("clutter", clutter)] {
        let share = differing_pixels(&mesh);
        assert!(share <= MAX_DIFFERENT, "{name}: {share}");
    }
}

/// On real models: `OUTSIGHT_MODELS="a.ply b.ply" cargo test --release --test compare -- --ignored --nocapture`.
#[test]
#[ignore = "needs meshes that are not part of the project"]
#[allow(clippy::print_stdout)]
fn pictures_of_real_models_are_those_of_an_independent_ray_caster() {
    for path in std::env::var("OUTSIGHT_MODELS").unwrap().split_whitespace() {
        let mesh = outsight::io::read(Path::new(path), &Default::default()).unwrap().mesh;
        let share = differing_pixels(&mesh);
        println!("{path} | {} | {:.4} %", mesh.triangle_count(), 100.0 * share);
        assert!(share <= MAX_DIFFERENT, "{path}: {share}");
    }
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn json_has_the_promised_keys() {
    let home = tempfile::tempdir().unwrap();
    for (name, size) in [("ref.off", "1"), ("test.off", "1.5")] {
        fs::write(home.path().join(name), tetrahedron(size)).unwrap();
    }
    let (code, out, error) = run(home.path(), &["compare", "ref.off", "ref.off", "test.off", "--json"]);
    assert_eq!(code, Some(0), "{error}");
    let object: Value = serde_json::from_str(&out).unwrap();
    let promised = ["schema", "tests", "diagonal", "reference_visibility", "cache", "reference", "occluders"];
    assert_eq!(keys(&object)[..7], promised);
    let tests = object["tests"].as_array().unwrap();
    for test in tests {
        let pictures = ["file", "triangles", "image_rms", "image_rmse", "silhouette_xor", "geometric", "distances"];
        let more = ["fixed_light", "smooth", "ssim", "depth", "depth_rms", "quality", "samples"];
        assert_eq!(keys(test), [pictures, more].concat());
        for lengths in ["geometric", "distances"] {
            let promised = ["mean", "rms", "max", "forward", "backward", "visible", "hidden", "weighted_rms"];
            assert_eq!(keys(&test[lengths]), promised);
        }
        let promised = ["flipped", "flipped_area", "degenerate", "non_manifold_edges", "new_non_manifold_edges"];
        assert_eq!(keys(&test["quality"]), promised);
    }
    let own = &tests[0];
    assert_eq!(
        (own["image_rmse"].as_f64(), own["ssim"].as_f64(), own["depth"].as_f64()),
        (Some(0.0), Some(1.0), Some(0.0))
    );
    assert!(own["geometric"]["hidden"].is_null(), "nothing of a tetrahedron is hidden");
    let percent = 100.0 / object["diagonal"].as_f64().unwrap();
    let rms = |lengths: &str| tests[1][lengths]["forward"]["rms"].as_f64().unwrap();
    assert!((rms("geometric") - rms("distances") * percent).abs() < 1e-9);
}

fn run(directory: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let few = ["--cameras", "18", "--resolution", "64"];
    let mut command = Command::cargo_bin("outsight").unwrap();
    let output = command.current_dir(directory).args(arguments).args(few).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

/// A tetrahedron without one of its sides.
fn tetrahedron(size: &str) -> String {
    format!("OFF\n4 3 0\n0 0 0\n{size} 0 0\n0 {size} 0\n0 0 {size}\n3 0 2 1\n3 0 1 3\n3 0 3 2\n")
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let home = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(home.path().join(name), text).unwrap();
    write("ref.off", &tetrahedron("1"));
    write("giant.off", &tetrahedron("1e5"));
    write("dwarf.off", &tetrahedron("1e-9"));
    write("flat.off", "OFF\n3 1 0\n0 0 0\n1 1 1\n2 2 2\n3 0 1 2\n");
    write("empty.off", "OFF\n0 0 0\n");
    let cases: [(&[&str], i32, &str); 6] = [
        (&["flat.off"], 3, "flat.off: all 1 triangles have zero area"),
        (&["empty.off"], 3, "empty.off: no vertices and no triangles"),
        (&["giant.off"], 5, "are the units the same?"),
        (&["dwarf.off"], 5, "are the units the same?"),
        (&["ref.off", "--surface-samples", "0"], 2, "--surface-samples"),
        (&["ref.off", "--surface-samples", "99999999999"], 2, "1000000000"),
    ];
    for (arguments, expected, message) in cases {
        let (code, _, error) = run(home.path(), &[&["compare", "ref.off"], arguments].concat());
        assert_eq!(code, Some(expected), "{arguments:?}: {error}");
        assert!(error.contains(message), "{arguments:?}: {error}");
    }
}

#[test]
fn a_look_that_simplify_kept_is_reused() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("ref.off"), tetrahedron("1")).unwrap();
    let simplify = ["simplify", "ref.off", "-o", "small.off", "-r", "1", "--cache", "kept"];
    assert_eq!(run(home.path(), &simplify).0, Some(0));
    let (code, out, error) = run(home.path(), &["compare", "ref.off", "small.off", "--cache", "kept", "--json"]);
    assert_eq!(code, Some(0), "{error}");
    let object: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(object["cache"], "hit");
    assert_eq!(object["tests"][0]["quality"]["flipped"], 0);
}
