//! One suite for every backend: each must draw what the judge, [`Brute`], draws.

#![allow(clippy::unwrap_used)]

use glam::{DMat3, DVec3};
#[cfg(feature = "embree")]
use outsight::backend::EmbreeScene;
use outsight::backend::{Brute, ItemBuffers};
use outsight::camera::{CameraSphere, CameraWeights, Frame, UnitMesh, View, Window};
use outsight::mesh::{TriMesh, TriangleId};
use outsight::raster::{Hit, ItemBufferPair, Scene, Side};
use proptest::prelude::*;

type Images = (Vec<Option<Hit>>, Vec<Option<Hit>>);

fn images<B: ItemBuffers>(backend: &B, view: &View) -> Images {
    let mut buffers = ItemBufferPair::new(view.window);
    backend.draw(view, &mut B::Scratch::default(), &mut buffers).unwrap();
    (buffers.near().collect(), buffers.far().collect())
}

/// Images in which a backend and the judge may differ: one centre on an edge may change both images of an axis.
///
/// The raster snaps vertices to 2⁻¹⁸ pixel, so that one centre that close to an edge may fall on its other side.
const RASTER_MAY_DIFFER: usize = 2;
/// Embree's rays start at positions rounded to `f32`, 10⁻⁷ off, and random triangles have some hundred edges: one centre
/// so close to one of them is met in every tenth picture.
#[cfg(feature = "embree")]
const EMBREE_MAY_DIFFER: usize = 6;

/// What each backend draws, with its name and how many pixels may differ from the judge's.
fn every_backend(unit: &UnitMesh, view: &View) -> Vec<(&'static str, Images, usize)> {
    vec![
        ("raster", images(&Scene::new(unit.clone()), view), RASTER_MAY_DIFFER),
        #[cfg(feature = "embree")]
        ("embree", images(&EmbreeScene::new(unit).unwrap(), view), EMBREE_MAY_DIFFER),
    ]
}

/// The first backend that differs from the judge on more pixels than it may.
fn disagreement(mesh: &TriMesh, view: &View) -> Option<String> {
    let unit = Frame::of(mesh).unit_copy(mesh);
    let judge = images(&Brute::new(&unit), view);
    every_backend(&unit, view).into_iter().find_map(|(name, drawn, may_differ)| {
        let differ = |a: &[Option<Hit>], b: &[Option<Hit>]| a.iter().zip(b).filter(|(a, b)| a != b).count();
        let pixels = differ(&judge.0, &drawn.0) + differ(&judge.1, &drawn.1);
        (pixels > may_differ).then(|| format!("{name} differs from the judge on {pixels} pixels"))
    })
}

fn soup(coordinates: &[f64]) -> Option<TriMesh> {
    let positions: Vec<DVec3> = coordinates.chunks_exact(3).map(DVec3::from_slice).collect();
    let triangles = (0..positions.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    TriMesh::from_triangles(positions, triangles).ok().map(|(mesh, _)| mesh)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn every_backend_draws_what_the_judge_draws(
        coordinates in prop::collection::vec(-1.0..1.0_f64, 9..360),
        camera in 0..66_usize,
        width in 16..80_u32,
    ) {
        if let Some(mesh) = soup(&coordinates) {
            let rotation = DMat3::from_rotation_z(0.3) * DMat3::from_rotation_x(0.7);
            let sphere = CameraSphere::octahedral(66, CameraWeights::Area).unwrap().rotated(rotation);
            let view = View::toward(sphere.directions()[camera], Window::around_sphere(width));
            prop_assert_eq!(disagreement(&mesh, &view), None);
        }
    }

    #[test]
    fn slivers_and_thin_triangles_are_drawn_alike(
        coordinates in prop::collection::vec(-1.0..1.0_f64, 9..180),
        squeeze in 1..12_i32,
    ) {
        let squeezed: Vec<f64> =
            coordinates.chunks_exact(3).flat_map(|p| [p[0], p[1] * 0.5_f64.powi(squeeze), p[2]]).collect();
        if let Some(mesh) = soup(&squeezed) {
            let toward = DVec3::new(0.3, 0.2, 0.9).normalize();
            prop_assert_eq!(disagreement(&mesh, &View::toward(toward, Window::around_sphere(64))), None);
        }
    }
}

/// Two triangles that share the diagonal of a square, seen head-on with pixel centres exactly on every edge.
///
/// ```text
///   3───2
///   │ ╱ │
///   0───1
/// ```
#[test]
fn a_pixel_centre_on_a_shared_edge_belongs_to_one_triangle() {
    let corners = [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]].map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
    let mesh = TriMesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).unwrap();
    let frame = Frame { centre: DVec3::ZERO, radius: 1.0 };
    // 8 pixels over [−2, 2]: centres at odd quarters; shift the frame so that they fall on the edges.
    let frame = Frame { centre: frame.centre + DVec3::new(0.25, 0.25, 0.0), ..frame };
    let view = View::toward(DVec3::Z, Window { width: 8, half_width: 2.0 });
    let (near, far) = images(&Scene::new(frame.unit_copy(&mesh)), &view);
    let count = |image: &[Option<Hit>], t: u32| image.iter().flatten().filter(|h| h.triangle == TriangleId(t)).count();
    // A 2 × 2 square of half-unit pixels holds 16, however the edges are shared out.
    assert_eq!(count(&near, 0) + count(&near, 1), 16);
    assert_eq!(count(&near, 0), count(&far, 0));
    assert!(near.iter().flatten().all(|h| h.side == Side::Front) && far.iter().flatten().all(|h| h.side == Side::Back));
}

#[test]
fn coincident_triangles_go_to_the_smaller_number_in_both_images() {
    let corners = vec![DVec3::new(-0.9, -0.7, 0.31), DVec3::new(0.8, -0.5, -0.27), DVec3::new(0.1, 0.9, 0.123)];
    // The same three points with other vertex numbers, another order and the other winding.
    let positions = [corners.clone(), corners].concat();
    let mesh = TriMesh::new(positions, vec![[0, 1, 2], [5, 4, 3]]).unwrap();
    let view = View::toward(DVec3::new(0.2, 0.5, 0.7).normalize(), Window::around_sphere(200));
    for (name, (near, far), _) in every_backend(&Frame::of(&mesh).unit_copy(&mesh), &view) {
        assert!(near.iter().chain(&far).flatten().count() > 1000, "{name}");
        assert!(near.iter().chain(&far).flatten().all(|hit| hit.triangle == TriangleId(0)), "{name}");
    }
}

#[test]
fn a_mesh_larger_than_the_window_is_clipped() {
    let corners = [[-90., -80.], [100., -70.], [3., 95.]].map(|[x, y]| DVec3::new(x, y, 0.1)).to_vec();
    let mesh = TriMesh::new(corners, vec![[0, 1, 2]]).unwrap();
    let unit = Frame { centre: DVec3::ZERO, radius: 1.0 }.unit_copy(&mesh);
    let view = View::toward(DVec3::Z, Window::around_sphere(32));
    for (name, (near, _), _) in every_backend(&unit, &view) {
        assert!(near.iter().all(Option::is_some), "{name}: the triangle covers the whole window");
    }
}
