//! Which cameras look, and what stands in their way: hemispheres, lists of cameras, floors and enclosures.
#![allow(clippy::unwrap_used)]

use approx::assert_abs_diff_eq;
use glam::{DAffine3, DVec3};
use outsight::backend::BackendKind;
use outsight::camera::{CameraList, CameraPattern, CameraSphere, Cameras};
use outsight::mesh::shapes;
use outsight::mesh::{TriMesh, TriangleId};
use outsight::progress::Silent;
use outsight::visibility::{Hidden, MeasureOptions, Sides, Subject, Visibility, look, measure};

/// Noise of pixels along outlines, on a face of a cube at 480 pixels.
const PIXELS: f64 = 0.01;

fn options(cameras: Cameras) -> MeasureOptions {
    MeasureOptions { cameras, sides: Sides::One, ..MeasureOptions::default() }
}

fn cube() -> TriMesh {
    shapes::cuboid(DVec3::ONE, 3)
}

/// Triangles of an axis-aligned mesh whose normal points along `normal`.
fn facing(mesh: &TriMesh, normal: DVec3) -> Vec<usize> {
    let faces =
        |t: &usize| outsight::geom::triangle_normal(mesh.corners(TriangleId(*t as u32))).unwrap().dot(normal) > 0.99;
    (0..mesh.triangle_count()).filter(faces).collect()
}

fn mean(values: &[f64], triangles: &[usize]) -> f64 {
    triangles.iter().map(|&t| values[t]).sum::<f64>() / triangles.len() as f64
}

/// A square floor of side `width` at height `z`.
fn floor(width: f64, z: f64) -> TriMesh {
    let sheet = shapes::sheet(width, width, [1, 1]);
    let centre = sheet.bounds().centre();
    shapes::transformed(&sheet, &DAffine3::from_translation(DVec3::new(0.0, 0.0, z) - centre)).unwrap()
}

/// The cube with its centre at the origin, whatever its generator does.
fn centred(mesh: &TriMesh) -> TriMesh {
    shapes::transformed(mesh, &DAffine3::from_translation(-mesh.bounds().centre())).unwrap()
}

fn among(mesh: &TriMesh, occluders: &[TriMesh], backend: BackendKind, options: &MeasureOptions) -> Visibility {
    let subject = Subject::among(mesh, occluders, backend).unwrap();
    subject.measure(&MeasureOptions { backend, ..options.clone() }, &Silent).unwrap()
}

#[test]
fn under_a_hemisphere_the_top_is_whole_walls_are_half_and_the_bottom_is_dark() {
    let cube = cube();
    for (rotation, walls) in [(None, PIXELS), (Some(5), 0.03)] {
        let cameras = Cameras { hemisphere: Some(DVec3::Y), rotation, ..Cameras::default() };
        let seen = measure(&cube, &options(cameras), &Silent).unwrap();
        let side = |normal| mean(seen.front(), &facing(&cube, normal));
        assert_abs_diff_eq!(side(DVec3::Y), 1.0, epsilon = PIXELS);
        assert_eq!(side(DVec3::NEG_Y), 0.0);
        for wall in [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z] {
            assert_abs_diff_eq!(side(wall), 0.5, epsilon = walls);
        }
    }
}

#[test]
fn what_is_never_seen_from_above_is_deleted_only_under_a_hemisphere() {
    let cube = cube();
    let deleted = |cameras| look(&cube, &options(cameras), Hidden::Delete, &Silent).unwrap().hidden;
    assert!(deleted(Cameras::default()).iter().all(|&h| !h));
    let below = deleted(Cameras { hemisphere: Some(DVec3::Z), ..Cameras::default() });
    let bottom = facing(&cube, DVec3::NEG_Z);
    assert!((0..cube.triangle_count()).all(|t| below[t] == bottom.contains(&t)));
}

#[test]
fn few_listed_cameras_are_no_reason_to_delete_what_they_miss() {
    let cube = cube();
    let list = CameraList { name: "two".to_owned(), cameras: vec![(DVec3::X, 1.0), (DVec3::Z, 1.0)] };
    let cameras = Cameras { pattern: CameraPattern::Listed(list), ..Cameras::default() };
    let looked = look(&cube, &options(cameras), Hidden::Delete, &Silent).unwrap();
    let side = |normal| mean(looked.visibility.front(), &facing(&cube, normal));
    assert_abs_diff_eq!(side(DVec3::X), 1.0, epsilon = PIXELS);
    assert_abs_diff_eq!(side(DVec3::Z), 1.0, epsilon = PIXELS);
    assert_eq!([side(DVec3::NEG_X), side(DVec3::NEG_Z)], [0.0; 2]);
    assert_abs_diff_eq!(side(DVec3::Y), 0.0, epsilon = PIXELS);
    assert!(looked.hidden.iter().all(|&h| !h));
}

/// The spiral's upper end: no camera has an opposite one. The sphere is convex, so that each triangle is seen whole by
/// every camera before it, and numerator and denominator are the same sum.
#[test]
fn cameras_without_opposites_see_a_convex_solid_whole_where_they_see_it() {
    let sphere = shapes::icosphere(3);
    let spiral = CameraSphere::fibonacci(130).unwrap();
    let looking = || spiral.directions().iter().step_by(2).take(50);
    let listed = looking().enumerate().map(|(i, &d)| (d, 1.0 + (i % 3) as f64)).collect();
    let list = CameraList { name: "half".to_owned(), cameras: listed };
    let cameras = Cameras { pattern: CameraPattern::Listed(list), ..Cameras::default() };
    for backend in [BackendKind::Raster, BackendKind::Brute] {
        // The judge needs minutes for more pixels.
        let resolution = Some(if backend == BackendKind::Brute { 48 } else { 480 });
        let seen = among(&sphere, &[], backend, &MeasureOptions { resolution, ..options(cameras.clone()) });
        assert!(seen.back().iter().all(|&v| v == 0.0));
        let above = facing(&sphere, DVec3::Z);
        let normal = |t: &usize| outsight::geom::triangle_normal(sphere.corners(TriangleId(*t as u32))).unwrap();
        let is_dark = |t: &usize| looking().all(|d| d.dot(normal(t)) < -1e-3);
        let dark: Vec<usize> = (0..sphere.triangle_count()).filter(is_dark).collect();
        assert!(!dark.is_empty() && dark.iter().all(|&t| seen.front()[t] == 0.0));
        assert_abs_diff_eq!(
            mean(seen.front(), &above),
            1.0,
            epsilon = if resolution == Some(48) { 0.05 } else { PIXELS }
        );
    }
}

#[test]
fn closed_forms_hold_with_every_pattern() {
    /// As for the octahedral cameras of `closed_forms.rs`.
    const CAMERAS: f64 = 0.01;
    let well = shapes::cylindrical_well(1.0, [96, 24]);
    for pattern in [CameraPattern::Fibonacci(258), CameraPattern::Latlong, CameraPattern::Octahedral(258)] {
        let cameras = Cameras { pattern, rotation: Some(11), ..Cameras::default() };
        let seen = measure(&well.mesh, &options(cameras.clone()), &Silent).unwrap();
        let area = |t: &usize| outsight::geom::triangle_area(well.mesh.corners(TriangleId(*t as u32)));
        let all: Vec<usize> = (0..well.mesh.triangle_count()).collect();
        let flux: f64 = all.iter().map(|t| area(t) * seen.front()[*t]).sum();
        // The cavity theorem: what leaves the well leaves through its opening.
        let open = flux / all.iter().map(area).sum::<f64>();
        let expected = well.opening_area / all.iter().map(area).sum::<f64>();
        assert_abs_diff_eq!(open, expected, epsilon = CAMERAS);
    }
}

#[test]
fn a_floor_in_contact_hides_the_bottom_and_leaves_the_top() {
    let cube = centred(&cube());
    let (top, bottom) = (facing(&cube, DVec3::Z), facing(&cube, DVec3::NEG_Z));
    // Unturned cameras in the floor's plane would look past it.
    let cameras = Cameras { rotation: Some(2), ..Cameras::octahedral(66) };
    for gap in [0.0, 1e-3] {
        for (backend, resolution) in [(BackendKind::Raster, 480), (BackendKind::Brute, 64)] {
            let options = MeasureOptions { resolution: Some(resolution), ..options(cameras.clone()) };
            let seen = among(&cube, &[floor(100.0, -0.5 - gap)], backend, &options);
            let name = backend.name();
            assert!(bottom.iter().all(|&t| seen.front()[t] == 0.0 && !seen.seen()[t]), "{name}, gap {gap}");
            assert_abs_diff_eq!(mean(seen.front(), &top), 1.0, epsilon = if resolution == 64 { 0.05 } else { PIXELS });
            // Half of all directions come from below the floor, exactly so for two opposite walls and opposite cameras.
            let walls = [DVec3::X, DVec3::NEG_X].map(|side| facing(&cube, side)).concat();
            assert_abs_diff_eq!(
                mean(seen.front(), &walls),
                0.5,
                epsilon = if resolution == 64 { 0.05 } else { PIXELS }
            );
        }
    }
}

#[test]
fn what_stands_on_a_floor_loses_its_bottom() {
    let cube = centred(&cube());
    let occluders = [floor(20.0, -0.5)];
    let subject = Subject::among(&cube, &occluders, BackendKind::Raster).unwrap();
    let seen = subject.measure(&MeasureOptions::default(), &Silent).unwrap();
    let hidden = Hidden::Delete.marks(&subject, &seen, &MeasureOptions::default(), &Silent).unwrap();
    let bottom = facing(&cube, DVec3::NEG_Z);
    assert!((0..cube.triangle_count()).all(|t| hidden[t] == bottom.contains(&t)));
}

#[test]
fn in_a_closed_enclosure_everything_is_dark_and_that_is_a_result() {
    let cube = centred(&cube());
    let shell = shapes::transformed(&shapes::icosphere(2), &DAffine3::from_scale(DVec3::splat(3.0))).unwrap();
    for (backend, resolution) in [(BackendKind::Raster, 480), (BackendKind::Brute, 32)] {
        let options = MeasureOptions { resolution: Some(resolution), ..options(Cameras::octahedral(18)) };
        let seen = among(&cube, std::slice::from_ref(&shell), backend, &options);
        assert_eq!((seen.of_mesh(), seen.never_seen()), (0.0, cube.triangle_count()));
    }
}

/// The occluder stays within the mesh's own sphere, so that pixels and vertices are snapped alike with and without it.
#[test]
fn an_occluder_never_raises_visibility() {
    let mesh = centred(&shapes::torus(1.0, 0.3, 48, 24));
    let options = options(Cameras::octahedral(66));
    let alone = among(&mesh, &[], BackendKind::Raster, &options);
    let plate = floor(0.8, 0.0);
    let hidden = among(&mesh, &[plate], BackendKind::Raster, &options);
    assert!(alone.front().iter().zip(hidden.front()).all(|(a, b)| b <= a));
    assert!(hidden.of_mesh() < alone.of_mesh());
}

#[test]
fn an_occluder_far_away_changes_nothing_that_can_be_seen() {
    /// Depths and vertices are snapped more coarsely: single pixels along outlines.
    const SNAPPING: f64 = 1e-4;
    let mesh = centred(&cube());
    let options = options(Cameras::default());
    let alone = among(&mesh, &[], BackendKind::Raster, &options);
    let pillar = shapes::cuboid(DVec3::new(0.01, 0.01, 0.01), 1);
    let pillar = shapes::transformed(&pillar, &DAffine3::from_translation(DVec3::new(700.0, 300.0, 0.3))).unwrap();
    let beside = among(&mesh, &[pillar], BackendKind::Raster, &options);
    assert_abs_diff_eq!(alone.of_mesh(), beside.of_mesh(), epsilon = SNAPPING);
}
