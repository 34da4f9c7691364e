#![allow(clippy::unwrap_used)]

use glam::{DMat3, DVec3};

use super::*;
use crate::backend::BackendKind;
use crate::camera::{CameraWeights, Cameras, Window};
use crate::mesh::{TriMesh, TriangleId, shapes};
use crate::progress::Silent;
use crate::visibility::{Details, DiagramRecorder, Estimator, Setting, Subject, Visibility};

const RASTER: Setting = Setting { estimator: Estimator::Coverage, backend: BackendKind::Raster };
const HEMISPHERE: Setting = Setting { estimator: Estimator::Hemisphere, backend: BackendKind::Brute };

/// Sums of a few numbers of one size.
const ROUNDING: f64 = 1e-12;

/// `Shapes` keeps normals in `f32`.
const NARROWED: f64 = 1e-6;

fn small(cameras: usize, sides: Sides) -> MeasureOptions {
    let cameras = Cameras::octahedral(cameras);
    MeasureOptions { cameras, sides, resolution: Some(64), ..MeasureOptions::default() }
}

fn octahedral(count: usize) -> CameraSphere {
    CameraSphere::octahedral(count, CameraWeights::Area).unwrap()
}

fn comparing<'a>(cameras: &'a CameraSphere, options: &'a MeasureOptions) -> Comparing<'a> {
    Comparing { cameras, options, progress: &Silent }
}

#[test]
fn kappa_is_that_of_the_textbook() {
    // 50 grant proposals and two readers: 20 twice yes, 15 twice no, 5 and 10 split; p_o = 0.7, p_e = 0.5.
    let readers = Confusion { n11: 20.0, n10: 5.0, n01: 10.0, n00: 15.0 };
    approx::assert_relative_eq!(readers.agreement(), 0.7, epsilon = ROUNDING);
    approx::assert_relative_eq!(readers.kappa(), 0.4, epsilon = ROUNDING);
    approx::assert_relative_eq!(readers.differing(), 15.0 / 35.0, epsilon = ROUNDING);
    // Answers that do not depend on each other, and opposite ones.
    let chance = Confusion { n11: 4.0, n10: 4.0, n01: 4.0, n00: 4.0 };
    approx::assert_relative_eq!(chance.kappa(), 0.0, epsilon = ROUNDING);
    let opposite = Confusion { n11: 0.0, n10: 5.0, n01: 5.0, n00: 0.0 };
    approx::assert_relative_eq!(opposite.kappa(), -1.0, epsilon = ROUNDING);
}

#[test]
fn always_the_same_answer_is_perfect_agreement() {
    for table in [
        Confusion::default(),
        Confusion { n11: 7.0, ..Confusion::default() },
        Confusion { n00: 7.0, ..Confusion::default() },
    ] {
        assert_eq!((table.agreement(), table.kappa(), table.differing()), (1.0, 1.0, 0.0));
    }
}

#[test]
fn percentile_holds_its_share_of_the_area() {
    let (differences, areas) = ([-0.2, 0.0, 1.0, 0.1], [9.5, 50.0, 0.5, 40.0]);
    let at = |share: f64| values::percentile(&differences, &areas, share);
    assert_eq!([at(0.5), at(0.51), at(0.99), at(0.996)], [0.0, 0.1, 0.2, 1.0]);
    assert_eq!(values::percentile(&[], &[], 0.99), 0.0);
}

#[test]
fn worst_triangles_are_those_that_add_most_to_the_mean() {
    let worst: Vec<usize> = values::worst(&[0.1, -5.0, 0.0, 0.1], &[1.0, 0.01, 9.0, 1.0]).collect();
    assert_eq!(worst, [0, 3, 1], "equal ones by number, without those that do not differ");
    assert_eq!(values::worst(&[1.0; 30], &[1.0; 30]).count(), 20);
}

/// Two triangles with areas 1 : 3 that face (1, 1, 1), so that cameras +x, +y, +z see their fronts.
fn two_triangles() -> TriMesh {
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
    let scale = 3.0_f64.sqrt();
    let shift = 2.0 * (x - y);
    TriMesh::new(vec![x, y, z, scale * x + shift, scale * y + shift, scale * z + shift], vec![[0, 1, 2], [3, 4, 5]])
        .unwrap()
}

/// A measurement of [`two_triangles`] by hand: V of their fronts and backs, and cameras that see each.
fn by_hand<'a>(
    subject: &'a Subject<'a>,
    [front, back]: [[f64; 2]; 2],
    seen: Option<[&[usize]; 2]>,
    setting: Setting,
) -> Measurement<'a> {
    let visibility = Visibility {
        front: front.to_vec(),
        back: back.to_vec(),
        per_triangle: front.map(|v| v.clamp(0.0, 1.0)).to_vec(),
        seen: vec![true; 2],
        of_mesh: 0.25 * front[0] + 0.75 * front[1],
        of_mesh_sides: 0.0,
        resolution: 480,
        cameras: 6,
        details: Details::default(),
    };
    let diagram = seen.map(|seen| {
        let recorder = DiagramRecorder::new(2, 6, None).unwrap();
        for (t, cameras) in (0..).zip(seen) {
            cameras.iter().for_each(|&camera| recorder.record(TriangleId(t), camera));
        }
        recorder.finish()
    });
    Measurement { subject, setting, visibility, diagram }
}

/// Cameras +x, +y, −x of the octahedron.
fn three_cameras(cameras: &CameraSphere) -> [usize; 3] {
    [DVec3::X, DVec3::Y, -DVec3::X].map(|d| cameras.directions().iter().position(|&c| c == d).unwrap())
}

#[test]
fn five_statistics_of_two_triangles_are_those_computed_by_hand() {
    let (mesh, cameras, options) = (two_triangles(), octahedral(6), small(6, Sides::One));
    let subject = Subject::new(&mesh, BackendKind::Raster).unwrap();
    let [x, y, behind] = three_cameras(&cameras);
    // −x looks at backs, which do not count with one side.
    let a = by_hand(&subject, [[0.5, 1.0], [0.0; 2]], Some([&[x, y, behind], &[x]]), RASTER);
    let b = by_hand(&subject, [[0.25, 1.1], [0.0; 2]], Some([&[x], &[x]]), RASTER);
    let found = Agreement::of(&a, &b, comparing(&cameras, &options)).unwrap();
    let seen = found.seen.unwrap();
    assert_eq!(seen.counts, Confusion { n11: 2.0, n10: 1.0, n01: 0.0, n00: 3.0 });
    approx::assert_relative_eq!(seen.counts.agreement(), 5.0 / 6.0, epsilon = ROUNDING);
    // A says yes to 3 of 6, B to 2: p_e = 3/6 · 2/6 + 3/6 · 4/6 = 1/2.
    approx::assert_relative_eq!(seen.counts.kappa(), 2.0 / 3.0, epsilon = ROUNDING);
    // All cosines and camera weights are equal, the areas are 1 and 3: 11 of 12 parts agree.
    approx::assert_relative_eq!(seen.weighted.agreement(), 11.0 / 12.0, epsilon = NARROWED);
    assert_eq!(seen.worst_camera, Some(y));
    let values = found.values;
    approx::assert_relative_eq!(values.mean_abs, 0.25 * 0.25 + 0.75 * 0.1, epsilon = ROUNDING);
    approx::assert_relative_eq!(values.bias, 0.25 * 0.25 - 0.75 * 0.1, epsilon = ROUNDING);
    approx::assert_relative_eq!(values.of_mesh, 0.0125, epsilon = ROUNDING);
    approx::assert_relative_eq!(values.p99, 0.25, epsilon = ROUNDING);
    let order: Vec<usize> = values.worst.iter().map(|w| w.triangle).collect();
    assert_eq!(order, [1, 0], "0.75 · 0.1 is more than 0.25 · 0.25");
    approx::assert_relative_eq!(values.worst[0].area_share, 0.75, epsilon = ROUNDING);
}

#[test]
fn better_side_is_the_one_that_both_together_find_more_visible() {
    let (mesh, cameras) = (two_triangles(), octahedral(6));
    let subject = Subject::new(&mesh, BackendKind::Raster).unwrap();
    let [x, _, behind] = three_cameras(&cameras);
    // The second triangle is wound the wrong way: its back is what one sees, and where the two differ.
    let a = by_hand(&subject, [[1.0, 0.0], [0.0, 0.9]], Some([&[x], &[behind]]), RASTER);
    let b = by_hand(&subject, [[1.0, 0.0], [0.0, 0.5]], Some([&[x], &[]]), RASTER);
    let with = |sides| Agreement::of(&a, &b, comparing(&cameras, &small(6, sides))).unwrap();
    let [one, better, sum] = [Sides::One, Sides::Better, Sides::Sum].map(with);
    assert_eq!(one.values.mean_abs, 0.0);
    approx::assert_relative_eq!(better.values.mean_abs, 0.75 * 0.4, epsilon = ROUNDING);
    approx::assert_relative_eq!(sum.values.mean_abs, 0.75 * 0.4, epsilon = ROUNDING);
    let counts = [one, better, sum].map(|agreement| agreement.seen.unwrap().counts);
    assert_eq!(counts[0], Confusion { n11: 1.0, n10: 0.0, n01: 0.0, n00: 5.0 });
    assert_eq!(counts[1], Confusion { n11: 1.0, n10: 1.0, n01: 0.0, n00: 4.0 });
    assert_eq!(counts[2], Confusion { n11: 1.0, n10: 1.0, n01: 0.0, n00: 10.0 });
}

#[test]
fn limits_of_quadrature_follow_cameras_and_counts() {
    let mesh = two_triangles();
    let subject = Subject::new(&mesh, BackendKind::Raster).unwrap();
    let a = by_hand(&subject, [[0.5; 2], [0.0; 2]], None, RASTER);
    let b = by_hand(&subject, [[0.5; 2], [0.0; 2]], None, HEMISPHERE);
    let areas = Shapes::of(&mesh, subject.frame()).areas;
    for (count, q, of_mesh) in [(258, 0.012, 0.01), (1026, 0.005, 0.004)] {
        let (cameras, options) = (octahedral(count), small(count, Sides::One));
        let pixel = Window::around_sphere(480).pixel_size();
        let counts = count as f64 * 0.5 * (areas[0] + areas[1]) * 0.5 / (4.0 * pixel * pixel);
        for limits in [
            Limits::between(&a, &b, comparing(&cameras, &options)),
            Limits::between(&b, &a, comparing(&cameras, &options)),
        ] {
            approx::assert_relative_eq!(limits.mean_abs_dv.unwrap(), q + 0.8 / counts.sqrt(), epsilon = ROUNDING);
            assert_eq!((limits.dvm, limits.kappa), (Some(of_mesh), None));
        }
        let equal = MeasureOptions { camera_weights: CameraWeights::Equal, ..options };
        assert_eq!(Limits::between(&a, &b, comparing(&cameras, &equal)), Limits::default(), "not known");
    }
    let few = octahedral(66);
    assert_eq!(Limits::between(&a, &b, comparing(&few, &small(66, Sides::One))), Limits::default(), "not known");
}

#[test]
fn each_limit_can_fail_alone() {
    let (mesh, cameras, options) = (two_triangles(), octahedral(6), small(6, Sides::One));
    let subject = Subject::new(&mesh, BackendKind::Raster).unwrap();
    let [x, y, _] = three_cameras(&cameras);
    let a = by_hand(&subject, [[0.5, 1.0], [0.0; 2]], Some([&[x, y], &[x]]), RASTER);
    let b = by_hand(&subject, [[0.25, 1.1], [0.0; 2]], Some([&[x], &[x]]), RASTER);
    let found = Agreement::of(&a, &b, comparing(&cameras, &options)).unwrap();
    let none = Limits::default();
    assert_eq!(none.are_kept_by(&found), None);
    let (kept, broken) = (Some(true), Some(false));
    let cases = [
        (Limits { agreement_weighted: Some(0.91), ..none }, Limits { agreement_weighted: Some(0.92), ..none }),
        (Limits { kappa: Some(0.66), ..none }, Limits { kappa: Some(0.67), ..none }),
        (Limits { differing: Some(0.34), ..none }, Limits { differing: Some(0.33), ..none }),
        (Limits { mean_abs_dv: Some(0.138), ..none }, Limits { mean_abs_dv: Some(0.137), ..none }),
        (Limits { dvm: Some(0.013), ..none }, Limits { dvm: Some(0.012), ..none }),
    ];
    for (loose, tight) in cases {
        assert_eq!((loose.are_kept_by(&found), tight.are_kept_by(&found)), (kept, broken), "{tight:?}");
        let both = Limits { dvm: tight.dvm.or(Some(1.0)), ..tight };
        assert_eq!(both.are_kept_by(&found), broken, "one broken limit is enough");
    }
}

/// Above a plate that faces +z lies one triangle, drawn from above in pixels of 64 around the pixel centre at the middle.
/// The other measurement sees a mesh where it lies below, so that camera +z sees it in one only.
fn planted(corners: [[f64; 3]; 3]) -> Causes {
    let pixel = Window::around_sphere(64).pixel_size();
    let mesh = |up: f64| {
        let place = |[x, y, z]: [f64; 3]| DVec3::new(0.5 + x, 0.5 + y, up * (0.02 + z)) * pixel;
        let plate = [[-0.7, -0.7], [0.7, -0.7], [0.7, 0.7], [-0.7, 0.7]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let positions = [&corners.map(place)[..], &plate].concat();
        TriMesh::new(positions, vec![[0, 1, 2], [3, 4, 5], [3, 5, 6]]).unwrap()
    };
    let (above, below) = (mesh(1.0), mesh(-1.0));
    let (cameras, options) = (octahedral(6), small(6, Sides::One));
    let [above, below] = [&above, &below].map(|mesh| Subject::new(mesh, BackendKind::Raster).unwrap());
    let [a, b] = [&above, &below].map(|s| Measurement::take(s, RASTER, comparing(&cameras, &options)).unwrap());
    let forth = Agreement::of(&a, &b, comparing(&cameras, &options)).unwrap().seen.unwrap();
    assert_eq!((forth.counts.n10, forth.counts.n01), (1.0, 0.0), "the planted pair alone");
    forth.causes
}

#[test]
fn planted_sliver_is_called_a_sliver() {
    let causes = planted([[-8.0, -0.2, 0.0], [8.0, -0.2, 0.0], [0.0, 0.4, 0.0]]);
    assert_eq!(causes, Causes { sliver: 1, ..Causes::default() });
}

#[test]
fn planted_grazing_triangle_is_called_grazing() {
    // Half a pixel deep and 16 pixels high: its normal leans 0.03 toward the camera.
    let causes = planted([[-8.0, -0.2, 0.0], [8.0, -0.2, 0.0], [0.0, 0.3, 16.0]]);
    assert_eq!(causes, Causes { grazing: 1, ..Causes::default() });
}

#[test]
fn planted_small_triangle_is_called_sub_pixel() {
    let causes = planted([[-0.4, -0.3, 0.0], [0.4, -0.3, 0.0], [0.0, 0.4, 0.0]]);
    assert_eq!(causes, Causes { sub_pixel: 1, ..Causes::default() });
}

#[test]
fn large_triangle_without_excuse_stays_unexplained() {
    let causes = planted([[-8.0, -6.0, 0.0], [8.0, -6.0, 0.0], [0.0, 9.0, 0.0]]);
    assert_eq!(causes, Causes { unexplained: 1, ..Causes::default() });
}

#[test]
fn large_triangle_of_which_one_pixel_shows_is_called_sub_pixel() {
    // Eight pixels wide, but a lid just above leaves one pixel centre of it free.
    let pixel = Window::around_sphere(64).pixel_size();
    let mesh = |cover: f64| {
        let at = |x: f64, y: f64, z: f64| DVec3::new((0.5 + x) * pixel, (0.5 + y) * pixel, z * pixel);
        let large = [at(0.0, 0.3, 0.0), at(-4.0, -5.0, 0.0), at(4.0, -5.0, 0.0)];
        let lid = [at(-9.0, cover, 1.0), at(0.0, -15.0, 1.0), at(9.0, cover, 1.0)];
        // In two opposite corners, so that the middle of the picture stays where it is.
        let frame = [[-0.8, -0.6, 0.0], [-0.7, -0.6, 0.0], [-0.8, 0.6, 0.0]].map(DVec3::from);
        let opposite = frame.map(|p| -p);
        let positions = [large, lid, frame, opposite].concat();
        TriMesh::new(positions, (0..4).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect()).unwrap()
    };
    let (open, shut) = (mesh(-0.3), mesh(0.4));
    let (cameras, options) = (octahedral(6), small(6, Sides::Sum));
    let [open, shut] = [&open, &shut].map(|mesh| Subject::new(mesh, BackendKind::Raster).unwrap());
    let [a, b] = [&open, &shut].map(|s| Measurement::take(s, RASTER, comparing(&cameras, &options)).unwrap());
    let seen = Agreement::of(&a, &b, comparing(&cameras, &options)).unwrap().seen.unwrap();
    assert_eq!(seen.causes, Causes { sub_pixel: 1, ..Causes::default() });
}

#[test]
fn coplanar_contact_is_counted_apart() {
    let corners = [[-0.91, -0.73, 0.0], [0.87, -0.57, 0.0], [0.13, 0.91, 0.0]].map(DVec3::from);
    // Twice the same triangle; in the second mesh the first of the two lies 5e-7 deeper, less than rays in f32 can tell.
    let mesh = |depth: f64| {
        let positions = [corners.map(|p| p - depth * DVec3::Z), corners].concat();
        TriMesh::new(positions, vec![[0, 1, 2], [3, 4, 5]]).unwrap()
    };
    let (together, apart) = (mesh(0.0), mesh(5e-7));
    let (cameras, options) = (octahedral(6), small(6, Sides::One));
    let [together, apart] = [&together, &apart].map(|mesh| Subject::new(mesh, BackendKind::Raster).unwrap());
    let [a, b] = [&together, &apart].map(|s| Measurement::take(s, RASTER, comparing(&cameras, &options)).unwrap());
    assert!(a.visibility.front()[0] > 0.9 && a.visibility.front()[1] == 0.0, "the tie goes to the first");
    assert!(b.visibility.front()[0] == 0.0 && b.visibility.front()[1] > 0.9, "here the second lies in front");
    let found = Agreement::of(&a, &b, comparing(&cameras, &options)).unwrap();
    let seen = found.seen.as_ref().unwrap();
    assert_eq!(seen.causes, Causes { coplanar_contact: 2, ..Causes::default() });
    assert_eq!(seen.counts, Confusion::default(), "nothing else is left to compare");
    assert_eq!(found.contacts.pairs, 2);
    // About 1.2 of the window's 4.3 square units.
    assert!((900..1400).contains(&found.contacts.pixels), "{}", found.contacts.pixels);
    // A pixel whose centre lies on an edge is no tie; none does here.
    assert!(found.values.mean_abs < ROUNDING, "{}", found.values.mean_abs);
    // V(M) needs no correction: what one triangle loses the other wins.
    assert!(found.values.of_mesh < ROUNDING);
}

/// A mesh with much hidden, one look at it and a look of turned cameras taken for the same: far from agreement.
fn two_looks<R>(then: impl FnOnce(&Measurement<'_>, &Measurement<'_>, Comparing<'_>) -> R) -> R {
    let mesh = shapes::cluttered_open_box(1, 12, 4).mesh;
    let subject = Subject::new(&mesh, BackendKind::Raster).unwrap();
    let (cameras, options) = (octahedral(66), small(66, Sides::Better));
    let turned = cameras.rotated(DMat3::from_rotation_z(0.3) * DMat3::from_rotation_x(0.7));
    let a = Measurement::take(&subject, RASTER, comparing(&cameras, &options)).unwrap();
    let b = Measurement::take(&subject, RASTER, comparing(&turned, &options)).unwrap();
    then(&a, &b, comparing(&cameras, &options))
}

#[test]
fn a_measurement_agrees_perfectly_with_itself() {
    two_looks(|a, _, comparing| {
        let found = Agreement::of(a, a, comparing).unwrap();
        let seen = found.seen.as_ref().unwrap();
        assert!(seen.counts.n11 > 0.0 && seen.counts.n00 > 0.0);
        assert_eq!((seen.counts.agreement(), seen.counts.kappa(), seen.weighted.agreement()), (1.0, 1.0, 1.0));
        assert_eq!((seen.causes, seen.worst_camera), (Causes::default(), None));
        let values = &found.values;
        assert_eq!([values.mean_abs, values.bias, values.p99, values.of_mesh], [0.0; 4]);
        assert!(values.worst.is_empty());
        assert_eq!(Limits::between(a, a, comparing).are_kept_by(&found), Some(true));
    });
}

#[test]
fn exchanging_the_two_transposes_the_table_and_turns_the_signs() {
    two_looks(|a, b, comparing| {
        let [forth, back] = [(a, b), (b, a)].map(|(a, b)| Agreement::of(a, b, comparing).unwrap());
        let [of_forth, of_back] = [&forth, &back].map(|found| found.seen.as_ref().unwrap());
        for (f, b) in [(of_forth.counts, of_back.counts), (of_forth.weighted, of_back.weighted)] {
            assert_eq!(f, Confusion { n10: b.n01, n01: b.n10, ..b });
        }
        assert!(of_forth.counts.n10 > 0.0 && of_forth.counts.n01 > 0.0);
        assert_eq!((of_forth.causes, of_forth.worst_camera), (of_back.causes, of_back.worst_camera));
        assert_eq!(forth.values.bias, -back.values.bias);
        assert_eq!((forth.values.mean_abs, forth.values.p99), (back.values.mean_abs, back.values.p99));
        assert_eq!(forth.contacts, back.contacts);
        assert_eq!(Limits::between(a, b, comparing).are_kept_by(&forth), Some(false));
    });
}

#[test]
fn any_number_of_threads_finds_the_same_bytes() {
    let find = || two_looks(|a, b, comparing| format!("{:?}", Agreement::of(a, b, comparing).unwrap()));
    let with = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(find);
    assert_eq!(with(1), with(3));
}

#[test]
fn measurements_of_different_meshes_are_refused() {
    let (mesh, other, cameras) = (two_triangles(), shapes::tetrahedron(), octahedral(6));
    let [subject, stranger] = [&mesh, &other].map(|mesh| Subject::new(mesh, BackendKind::Raster).unwrap());
    let options = small(6, Sides::One);
    let [a, b] = [&subject, &stranger].map(|s| Measurement::take(s, RASTER, comparing(&cameras, &options)).unwrap());
    let error = Agreement::of(&a, &b, comparing(&cameras, &options)).unwrap_err();
    assert!(matches!(error, Error::ShapeMismatch { got: 4, expected: 2, .. }), "{error}");
}
