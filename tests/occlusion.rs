//! Embree's answers about rays against the judge's, from one thread and from many.

#![allow(clippy::unwrap_used)]

use glam::{DVec3, Vec3};
use outsight::Error;
use outsight::backend::{BackendKind, Brute, EmbreeScene, Occlusion, Ray};
use outsight::camera::{Frame, UnitMesh};
use outsight::geom::OctahedralSphere;
use outsight::mesh::{TriMesh, TriangleId, shapes};
use outsight::progress::Silent;
use outsight::visibility::{Estimator, MeasureOptions, measure};
use proptest::prelude::*;

fn unit(mesh: &TriMesh) -> UnitMesh {
    Frame::of(mesh).unit_copy(mesh)
}

fn answers(backend: &impl Occlusion, rays: &[Ray]) -> Vec<bool> {
    let mut blocked = vec![false; rays.len()];
    backend.blocked(rays, &mut blocked).unwrap();
    blocked
}

/// A ray from the centroid of every triangle in each of 18 directions, to both sides.
fn surface_rays(mesh: &UnitMesh) -> Vec<Ray> {
    let directions: Vec<Vec3> = OctahedralSphere::new(1).vertices.iter().map(|d| d.as_vec3()).collect();
    let from = |&(corners, own): &([u32; 3], TriangleId)| {
        let [a, b, c] = corners.map(|v| Vec3::from_array(mesh.positions[v as usize]));
        let origin = ((a + b + c) / 3.0).to_array();
        let ray = move |d: &Vec3| Ray { origin, direction: d.to_array(), own: Some(own) };
        directions.iter().map(ray).collect::<Vec<Ray>>()
    };
    mesh.triangles.iter().flat_map(from).collect()
}

fn soup(coordinates: &[f64]) -> Option<TriMesh> {
    let positions: Vec<DVec3> = coordinates.chunks_exact(3).map(DVec3::from_slice).collect();
    let triangles = (0..positions.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    TriMesh::from_triangles(positions, triangles).ok().map(|(mesh, _)| mesh)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, ..ProptestConfig::default() })]

    #[test]
    fn embree_blocks_what_the_judge_blocks(coordinates in prop::collection::vec(-1.0..1.0_f64, 9..360)) {
        // In general position no ray passes an edge within the rounding of `f32`, so that there is nothing to allow for.
        if let Some(mesh) = soup(&coordinates) {
            let mesh = unit(&mesh);
            let rays = surface_rays(&mesh);
            prop_assert_eq!(answers(&EmbreeScene::new(&mesh).unwrap(), &rays), answers(&Brute::new(&mesh), &rays));
        }
    }
}

/// Rays of a closed convex solid leave it outward and hit it inward, with their own triangle out of the way.
#[test]
fn own_triangle_does_not_block_and_every_other_does() {
    let mesh = unit(&shapes::icosphere(2));
    for (name, backend) in
        [("brute", &Brute::new(&mesh) as &dyn Occlusion), ("embree", &EmbreeScene::new(&mesh).unwrap())]
    {
        for (factor, expected) in [(1.0, false), (-1.0, true)] {
            let rays: Vec<Ray> = surface_rays(&mesh)
                .into_iter()
                .filter(|ray| Vec3::from_array(ray.direction).dot(Vec3::from_array(ray.origin)) > 0.2)
                .map(|ray| Ray { direction: ray.direction.map(|x| factor * x), ..ray })
                .collect();
            let mut blocked = vec![!expected; rays.len()];
            backend.blocked(&rays, &mut blocked).unwrap();
            assert!(rays.len() > 1000 && blocked.iter().all(|&b| b == expected), "{name} {factor}");
        }
    }
}

#[test]
fn one_scene_answers_many_threads_alike() {
    let mesh = unit(&shapes::nested_spheres(0.5, 4).mesh);
    let (scene, rays) = (EmbreeScene::new(&mesh).unwrap(), surface_rays(&mesh));
    let alone = answers(&scene, &rays);
    assert!(alone.contains(&true) && alone.contains(&false));
    std::thread::scope(|threads| {
        let together: Vec<_> = (0..16).map(|_| threads.spawn(|| answers(&scene, &rays))).collect();
        assert!(together.into_iter().all(|thread| thread.join().unwrap() == alone));
    });
}

#[test]
fn a_batch_of_another_length_and_rays_that_are_no_numbers_are_refused() {
    let mesh = unit(&shapes::icosphere(0));
    let scene = EmbreeScene::new(&mesh).unwrap();
    let ray = Ray { origin: [0.0; 3], direction: [0.0, 0.0, 1.0], own: None };
    let error = scene.blocked(&[ray], &mut [false; 2]).unwrap_err();
    assert!(matches!(error, Error::ShapeMismatch { got: 2, expected: 1, .. }), "{error}");
    let wrong = Ray { direction: [0.0, f32::NAN, 1.0], ..ray };
    let error = scene.blocked(&[ray, wrong], &mut [false; 2]).unwrap_err();
    assert!(error.to_string().starts_with("rays: ray 1 has a coordinate"), "{error}");
}

#[test]
fn a_scene_is_refused_where_the_library_would_read_past_its_buffers() {
    let good = unit(&shapes::icosphere(0));
    let mut wrong = good.clone();
    wrong.triangles[3].0[1] = 12;
    let error = EmbreeScene::new(&wrong).unwrap_err();
    assert!(error.to_string().contains("triangle 3 uses vertex 12, but the mesh has 12 vertices"), "{error}");
    let mut wrong = good;
    wrong.positions[5][2] = f32::INFINITY;
    assert!(EmbreeScene::new(&wrong).unwrap_err().to_string().contains("vertex 5 is at"));
}

/// Of two triangles at one place the first is seen, as in pictures; the other, wound either way, is behind it.
#[test]
fn of_coincident_triangles_the_first_is_seen_by_rays_too() {
    let corners = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]].map(Into::into).to_vec();
    for second in [[0, 1, 2], [1, 2, 0], [0, 2, 1]] {
        let mesh =
            TriMesh::new([corners.clone(), corners.clone()].concat(), vec![[0, 1, 2], second.map(|v| v + 3)]).unwrap();
        for backend in [BackendKind::Brute, BackendKind::Embree] {
            for estimator in [Estimator::Surface, Estimator::Hemisphere] {
                let options = MeasureOptions { backend, estimator, ..MeasureOptions::default() };
                let seen = measure(&mesh, &options, &Silent).unwrap();
                assert_eq!(
                    (seen.front(), seen.back()),
                    (&[1.0, 0.0][..], &[1.0, 0.0][..]),
                    "{backend:?} {estimator:?}"
                );
            }
        }
    }
}
