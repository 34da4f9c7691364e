#![allow(clippy::unwrap_used)]

use glam::DVec3;

use super::super::pictures::IMAGE_WIDTH;
use super::*;
use crate::camera::{View, Window};
use crate::eval::{Gallery, Shot};
use crate::mesh::shapes;
use crate::progress::Silent;

/// A square plate of side 2 across the z axis, two triangles.
fn plate(shift: DVec3) -> TriMesh {
    let corners = [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]];
    let positions = corners.map(|[x, y]| DVec3::new(x, y, 0.0) + shift).to_vec();
    TriMesh::new(positions, vec![[0, 1, 2], [0, 2, 3]]).unwrap()
}

fn error(reference: &TriMesh, test: &TriMesh) -> ImageError {
    image_errors(reference, &[test], &Silent).unwrap()[0]
}

/// Mean of a function of |d·z| over the views.
fn mean_over_views(of: impl Fn(f64) -> f64) -> f64 {
    dodecahedron_axes().iter().map(|d| of(d.z.abs())).sum::<f64>() / 10.0
}

/// Edges of the plate cut pixels: its image is known to so many parts.
const PIXELATED: f64 = 2e-3;

#[test]
fn a_mesh_does_not_differ_from_itself() {
    let mesh = shapes::icosphere(2);
    let nothing = GreyError::default();
    let error = ReferencePictures::new(&mesh, &Silent).unwrap().compare(&mesh, &Silent).unwrap();
    let expected = ImageError {
        image_rms: 0.0,
        image_rmse: 0.0,
        fixed_light: nothing,
        smooth: nothing,
        silhouette_xor: 0.0,
        depth_rms: Some(0.0),
        ssim: 1.0,
    };
    assert_eq!(error, expected);
}

/// A plate moved out of every picture leaves its own image as the error: area 4 cos over the frame's area 8, grey
/// 255 cos, hence a mean square of 255² · mean(cos³) / 2. Its smooth normals are its flat ones. The fixed light falls on
/// it at |n·l| = 3/√14 from wherever it is seen.
#[test]
fn a_missing_plate_has_the_error_of_its_own_picture() {
    let gone = error(&plate(DVec3::ZERO), &plate(DVec3::X * 100.0));
    let pixels = f64::from(IMAGE_WIDTH * IMAGE_WIDTH);
    let cubes = mean_over_views(|c| c.powi(3));
    approx::assert_relative_eq!(gone.image_rmse, 255.0 * (cubes / 2.0).sqrt(), max_relative = PIXELATED);
    approx::assert_relative_eq!(gone.smooth.image_rmse, gone.image_rmse, max_relative = 1e-6);
    let fixed = 255.0 * (0.25 + 0.75 * 3.0 / 14.0_f64.sqrt());
    let cosines = mean_over_views(|c| c);
    approx::assert_relative_eq!(gone.fixed_light.image_rmse, fixed * (cosines / 2.0).sqrt(), max_relative = PIXELATED);
    approx::assert_relative_eq!(gone.silhouette_xor, pixels * cosines / 2.0, max_relative = PIXELATED);
    approx::assert_relative_eq!(gone.image_rms, gone.image_rmse * (20.0 * pixels).sqrt(), max_relative = 1e-12);
    assert_eq!(gone.depth_rms, None, "no sample is covered by both");
}

/// Raised by h, a plate is h·cos nearer along a view that meets it at the cosine cos, and shifted within the picture: in
/// depth at one sample, h / cos. The mean is over samples that both cover, which the shift makes fewer by little.
#[test]
fn a_raised_plate_differs_in_depth_by_the_height_over_the_cosine() {
    let height = 0.01;
    let raised = error(&plate(DVec3::ZERO), &plate(DVec3::Z * height));
    let samples = mean_over_views(|c| c);
    // Two axes of the ten lie in the plate's plane and show nothing of it.
    let slopes = mean_over_views(|c| if c > 0.0 { 1.0 / c } else { 0.0 });
    let expected = height * (slopes / samples).sqrt();
    // The shift takes up to h·tan of a side of 2 away, most where the depth differs most.
    approx::assert_relative_eq!(raised.depth_rms.unwrap(), expected, max_relative = 2e-2);
    let doubled = {
        let scaled = |mesh: TriMesh| {
            let (positions, triangles) = mesh.into_parts();
            TriMesh::new(positions.into_iter().map(|p| p * 2.0).collect(), triangles).unwrap()
        };
        error(&scaled(plate(DVec3::ZERO)), &scaled(plate(DVec3::Z * height)))
    };
    assert_eq!(doubled.depth_rms.unwrap(), 2.0 * raised.depth_rms.unwrap(), "depth is in model units");
    assert_eq!(doubled.image_rms, raised.image_rms);
}

/// A ball's normals point away from its centre: smooth shading of a fine one is that of a true sphere, whose grey at a
/// distance r from the middle of its disc is 255 √(1 - r²).
#[test]
fn a_smooth_ball_is_lit_like_a_sphere() {
    let ball = shapes::icosphere(5);
    let pictures = ReferencePictures::new(&ball, &Silent).unwrap();
    // Half the diagonal of its box, to which the picture reaches.
    let half = 3.0_f64.sqrt();
    let grey_at = |pixel: usize, across: f64| {
        f64::from(pictures.per_axis[0].greys[Light::Smooth as usize][0][pixel]) - 255.0 * (1.0 - across * across).sqrt()
    };
    let middle = IMAGE_WIDTH as usize / 2;
    for right in [0, 20, 60, 100, 130] {
        let across = (right as f64 + 0.5) * 2.0 * half / f64::from(IMAGE_WIDTH);
        let off = grey_at(middle * IMAGE_WIDTH as usize + middle + right, across);
        // 20 480 triangles are 0.02 wide; the row of pixels runs half a pixel beside the middle.
        assert!(off.abs() < 0.5, "{right}: {off}");
    }
}

#[test]
fn smooth_shading_does_not_care_how_vertices_are_stored() {
    let ball = shapes::icosphere(2);
    let corners: Vec<DVec3> = ball.triangles().iter().flatten().map(|&v| ball.positions()[v as usize]).collect();
    let triangles = (0..ball.triangle_count() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    let apart = TriMesh::new(corners, triangles).unwrap();
    assert_eq!(error(&ball, &apart), error(&ball, &ball));
}

/// Pictures to be compared are drawn apart from those to be looked at, which ray casters confirm (`tests/compare.rs`).
#[test]
fn compared_pictures_are_those_that_a_gallery_shows() {
    let mesh = shapes::bumpy_sphere(4, 0.1);
    let pictures = ReferencePictures::new(&mesh, &Silent).unwrap();
    let half_width = 0.5 * mesh.bounds().diagonal() / Frame::of(&mesh).radius;
    let width = IMAGE_WIDTH as usize;
    for (axis, toward) in dodecahedron_axes().into_iter().enumerate() {
        let up = View::toward(toward, Window { width: IMAGE_WIDTH, half_width }).up;
        let shown =
            Gallery::new(&mesh, &mesh).picture(&Shot { toward, up, width: IMAGE_WIDTH, half_width }, 0.0).unwrap();
        let near = &pictures.per_axis[axis].greys[Light::Head as usize][0];
        let from_above = (0..width).rev().flat_map(|row| &near[row * width..(row + 1) * width]);
        let different = from_above.zip(&shown.pixels).filter(|(a, b)| (*a - *b).abs() > 1e-3).count();
        // The two bases differ in their last bits, which may move a sample over an edge.
        assert!(different <= 10, "{axis}: {different}");
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let (fine, coarse) = (shapes::icosphere(4), shapes::icosphere(1));
    let [one, two, three] = [1, 2, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| ReferencePictures::new(&fine, &Silent)?.compare(&coarse, &Silent)).unwrap()
    });
    assert_eq!(one, two);
    assert_eq!(one, three);
}

#[test]
fn a_mesh_that_dwarfs_the_reference_is_refused() {
    let (positions, triangles) = plate(DVec3::ZERO).into_parts();
    let giant = TriMesh::new(positions.into_iter().map(|p| p * 1e4).collect(), triangles).unwrap();
    let refused = image_errors(&plate(DVec3::ZERO), &[&giant], &Silent);
    assert!(matches!(refused, Err(crate::Error::Limit { message }) if message.contains("units")));
}
