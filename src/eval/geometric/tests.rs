#![allow(clippy::unwrap_used, clippy::panic)]

use std::sync::atomic::Ordering;

use proptest::prelude::*;

use super::*;
use crate::progress::{CancelFlag, Silent};

/// Rounding of sums over some 1e5 samples of size 1.
const ROUNDING: f64 = 1e-12;

const FEW: GeometricOptions = GeometricOptions { samples: SampleCount::Exactly(2000), seed: 0 };

fn mesh(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> TriMesh {
    TriMesh::new(positions.iter().map(|&p| DVec3::from_array(p)).collect(), triangles.to_vec()).unwrap()
}

fn error(reference: &TriMesh, test: &TriMesh) -> GeometricError {
    geometric_error(reference, test, FEW, &Silent).unwrap()
}

/// Unit square at height `z`, cut into `n` by `n` cells of two triangles.
fn plate(z: f64, n: u32) -> TriMesh {
    let at = |i: u32, j: u32| [f64::from(i) / f64::from(n), f64::from(j) / f64::from(n), z];
    let positions: Vec<_> = (0..=n).flat_map(|j| (0..=n).map(move |i| at(i, j))).collect();
    let cell = |i: u32, j: u32| {
        let a = j * (n + 1) + i;
        [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
    };
    let triangles: Vec<_> = (0..n).flat_map(|j| (0..n).flat_map(move |i| cell(i, j))).collect();
    mesh(&positions, &triangles)
}

/// Every triangle cut into four at the middles of its edges; vertices are not shared.
fn subdivided(mesh: &TriMesh, move_vertex: impl Fn(DVec3) -> DVec3) -> TriMesh {
    let mut positions = Vec::new();
    for t in mesh.triangles() {
        let [a, b, c] = t.map(|v| mesh.positions()[v as usize]);
        let (ab, bc, ca) = ((a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0);
        positions.extend([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca].map(&move_vertex));
    }
    let triangles = (0..positions.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    TriMesh::new(positions, triangles).unwrap()
}

fn octahedron() -> TriMesh {
    let (p, n) = (1.0, -1.0);
    mesh(
        &[[p, 0., 0.], [n, 0., 0.], [0., p, 0.], [0., n, 0.], [0., 0., p], [0., 0., n]],
        &[[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]],
    )
}

fn sphere(radius: f64, level: u32) -> TriMesh {
    let unit = (0..level).fold(octahedron(), |m, _| subdivided(&m, DVec3::normalize));
    let (positions, triangles) = unit.into_parts();
    TriMesh::new(positions.into_iter().map(|p| p * radius).collect(), triangles).unwrap()
}

fn cube() -> TriMesh {
    let corners: Vec<_> = (0..8).map(|i| [f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)]).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<_> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    mesh(&corners, &triangles)
}

#[test]
fn parallel_plates_are_their_distance_apart() {
    let error = error(&plate(0.0, 1), &plate(0.25, 7));
    for d in [error.forward, error.backward, Distances { mean: error.mean, rms: error.rms, max: error.max }] {
        for value in [d.mean, d.rms, d.max] {
            assert!((value - 0.25).abs() < ROUNDING, "{d:?}");
        }
    }
    let diagonal = 2.0_f64.sqrt();
    assert!((error.diagonal - diagonal).abs() < ROUNDING);
    assert!((error.percent().mean - 25.0 / diagonal).abs() < 100.0 * ROUNDING);
}

/// A plate and the same plate moved along itself by 1/2: over the half that sticks out the distance grows from 0 to
/// 1/2, so mean 1/8, mean square (1/2)³/3 = 1/24.
#[test]
fn a_shifted_plate_has_the_mean_of_its_overhang() {
    let (positions, triangles) = plate(0.0, 4).into_parts();
    let shifted = TriMesh::new(positions.into_iter().map(|p| p + DVec3::X / 2.0).collect(), triangles).unwrap();
    let options = GeometricOptions { samples: SampleCount::Exactly(100_000), seed: 0 };
    let error = geometric_error(&plate(0.0, 4), &shifted, options, &Silent).unwrap();
    // 100 000 well-spread samples; plain random ones would be off by 5e-4.
    let sampling = 1e-4;
    assert!((error.forward.mean - 0.125).abs() < sampling, "{error:?}");
    assert!((error.backward.rms - (1.0_f64 / 24.0).sqrt()).abs() < sampling, "{error:?}");
    // Vertices are samples, so the far edge counts fully.
    assert!((error.max - 0.5).abs() < ROUNDING);
}

#[test]
fn nested_spheres_are_their_radii_apart() {
    let error = error(&sphere(1.0, 5), &sphere(1.25, 5));
    // The outer sphere's facets of side 0.06 sag by 0.06²/8/1.25; the vertices lie over one another.
    let sag = 1e-3;
    for value in [error.mean, error.rms, error.max, error.forward.mean, error.backward.mean] {
        assert!((value - 0.25).abs() < sag, "{error:?}");
    }
}

#[test]
fn a_subdivided_cube_is_the_same_surface() {
    let error = error(&cube(), &subdivided(&subdivided(&cube(), |p| p), |p| p));
    assert!(error.max < ROUNDING, "{error:?}");
}

#[test]
fn a_part_lies_on_the_whole_but_not_the_other_way() {
    let (whole, part) = (cube(), mesh(&[[0., 0., 0.], [1., 0., 0.], [1., 1., 0.]], &[[0, 1, 2]]));
    let error = error(&whole, &part);
    assert!(error.backward.max < ROUNDING);
    // The corner (0, 1, 1) is 1 above the part's plane and sqrt(1/2) beside its hypotenuse.
    assert!((error.forward.max - 1.5_f64.sqrt()).abs() < ROUNDING);
    assert_eq!(error.max, error.forward.max);
    assert_eq!(error.mean, error.forward.mean);
}

#[test]
fn unused_vertices_are_no_samples() {
    let (mut positions, triangles) = cube().into_parts();
    positions.push(DVec3::splat(9.0));
    let stray = TriMesh::new(positions, triangles).unwrap();
    assert!(error(&cube(), &stray).max < ROUNDING);
}

#[test]
fn samples_count_per_reference_triangle() {
    let options = GeometricOptions::default();
    let small = geometric_error(&cube(), &octahedron(), options, &Silent).unwrap();
    assert_eq!(small.samples, 2 * MIN_SAMPLES + 8 + 6);
    let reference = plate(0.0, 80); // 12 800 triangles, 81² vertices
    let large = geometric_error(&reference, &cube(), options, &Silent).unwrap();
    assert_eq!(large.samples, 2 * 128_000 + 81 * 81 + 8);
}

#[test]
fn no_samples_is_an_error() {
    for samples in [SampleCount::Exactly(0), SampleCount::PerTriangle(0)] {
        let result = geometric_error(&cube(), &cube(), GeometricOptions { samples, seed: 0 }, &Silent);
        assert!(matches!(result, Err(Error::Option { name: "--surface-samples", .. })));
    }
}

#[test]
fn cancelling_ends_the_work() {
    let flag = CancelFlag::default();
    flag.cancel();
    assert!(matches!(geometric_error(&cube(), &cube(), FEW, &flag), Err(Error::Cancelled)));
}

#[test]
fn progress_ends_at_the_total() {
    struct Last(AtomicU64, AtomicU64);
    impl Progress for Last {
        fn report(&self, phase: &'static str, done: u64, total: u64) {
            assert_eq!(phase, PHASE);
            self.0.fetch_max(done, Ordering::Relaxed);
            self.1.store(total, Ordering::Relaxed);
        }
    }
    let last = Last(AtomicU64::new(0), AtomicU64::new(0));
    let error = geometric_error(&cube(), &octahedron(), FEW, &last).unwrap();
    assert_eq!(last.0.into_inner(), error.samples);
    assert_eq!(last.1.into_inner(), error.samples);
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let (reference, test) = (sphere(1.0, 6), sphere(0.9, 3));
    let options = GeometricOptions { samples: SampleCount::Exactly(50_000), seed: 7 };
    let [one, two, three] = [1, 2, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| geometric_error(&reference, &test, options, &Silent)).unwrap()
    });
    assert_eq!(one, two);
    assert_eq!(one, three);
}

#[test]
fn another_seed_moves_the_samples() {
    let [a, b] = [0, 1].map(|seed| {
        let options = GeometricOptions { seed, ..FEW };
        geometric_error(&sphere(1.0, 3), &cube(), options, &Silent).unwrap()
    });
    assert_ne!(a.mean, b.mean);
    // Two thousand well-spread samples agree on the mean to a per cent.
    assert!((a.mean - b.mean).abs() < 0.01 * a.mean);
}

#[test]
fn triangles_without_area_are_met_as_their_edges() {
    // A segment from 0 to 2 as one triangle, and a point as another, against a plate's edge.
    let line = mesh(&[[0., 0., 0.], [1., 0., 0.], [2., 0., 0.], [2., 0., 0.], [2., 0., 0.]], &[[0, 1, 2], [2, 3, 4]]);
    let error = error(&plate(0.0, 1), &line);
    // The far side of the plate is 1 away; from the line, its end is 1 away from the plate, and so on average over
    // its five vertices (0, 0, 1, 1, 1).
    assert!((error.forward.max - 1.0).abs() < ROUNDING);
    assert!((error.backward.max - 1.0).abs() < ROUNDING);
    assert!((error.backward.mean - 0.6).abs() < ROUNDING);
}

#[test]
fn two_points_have_no_percentage() {
    let point = mesh(&[[1., 1., 1.]; 3], &[[0, 1, 2]]);
    let error = error(&point, &point);
    assert_eq!((error.max, error.diagonal), (0.0, 0.0));
    assert!(!error.percent().max.is_finite());
}

#[test]
fn giants_and_dwarfs_do_not_overflow() {
    for scale in [1e100, 1e-100, 1e-300] {
        let scaled = |m: TriMesh| {
            let (positions, triangles) = m.into_parts();
            TriMesh::new(positions.into_iter().map(|p| p * scale).collect(), triangles).unwrap()
        };
        let error = error(&scaled(plate(0.0, 1)), &scaled(plate(0.25, 1)));
        assert!((error.rms / scale - 0.25).abs() < ROUNDING, "{error:?}");
    }
}

fn soup() -> impl Strategy<Value = TriMesh> {
    let corner = prop::array::uniform3(-1.0..1.0);
    let positions = prop::collection::vec(corner, 3..90);
    positions.prop_map(|p| {
        let triangles: Vec<_> = (0..p.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        mesh(&p, &triangles)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn swapping_the_meshes_swaps_the_directions(a in soup(), b in soup()) {
        let (ab, ba) = (error(&a, &b), error(&b, &a));
        prop_assert!((ab.forward.max - ba.backward.max).abs() < ROUNDING);
        prop_assert!((ab.backward.mean - ba.forward.mean).abs() < ROUNDING);
        prop_assert!((ab.rms - ba.rms).abs() < ROUNDING);
    }

    #[test]
    fn a_soup_lies_on_itself(a in soup()) {
        prop_assert!(error(&a, &a).max < ROUNDING);
    }
}
