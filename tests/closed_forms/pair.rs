//! The pairs of an estimator and a backend that the suite runs on, and how exact each is.

use std::ops::Range;

use approx::assert_abs_diff_eq;
use glam::DMat3;
use outsight::backend::BackendKind;
use outsight::camera::{CameraSphere, CameraWeights, Cameras};
use outsight::geom::triangle_area;
use outsight::mesh::shapes::Tagged;
use outsight::mesh::{TriMesh, TriangleId};
use outsight::progress::Silent;
use outsight::visibility::{Estimator, MeasureOptions, RayOptions, Sides, Subject, Visibility};

/// An estimator on a backend.
pub struct Pair {
    options: MeasureOptions,
    /// Meshes have so many times fewer cells along a side than those for pictures: the judge takes quadratic time.
    coarser: usize,
    /// Subdivisions of balls that are left out, for the same reason.
    rougher: u32,
    /// What a mean over a surface may be off, beside four standard errors where the estimator knows its own.
    pub mean: f64,
    /// Relative to small values: cameras that happen to look in through a narrow hole.
    pub narrow: f64,
    /// What a single triangle may be off, root mean square.
    pub point_rms: f64,
    /// What convex and sealed surfaces may be off.
    pub certain: f64,
    /// The same for meshes of few pixels a triangle or under few cameras.
    pub certain_if_coarse: f64,
}

/// Quadrature error of 258 area-weighted cameras, of a mean over a surface.
const CAMERAS: f64 = 0.01;

/// Of single triangles.
const CAMERAS_POINT_RMS: f64 = 0.015;

/// Error of a mean when the cameras see it through a hole of 30°, relative: there are few of them.
const CAMERAS_NARROW: f64 = 0.1;

/// Coverage counts pixels: beside the cameras' error there is the noise along outlines.
pub fn coverage_on_raster() -> Pair {
    Pair {
        options: MeasureOptions::default(),
        coarser: 1,
        rougher: 0,
        mean: CAMERAS,
        narrow: CAMERAS_NARROW,
        point_rms: 0.03,
        certain: 1e-3,
        certain_if_coarse: 4e-3,
    }
}

/// The cameras' error, and that three points stand for a triangle; both sums of eq. (4.3) are the same where all is
/// seen, so that this is exact.
pub fn surface_on_brute() -> Pair {
    Pair {
        options: options(BackendKind::Brute, Estimator::Surface, RayOptions { points: 3, ..RayOptions::default() }),
        coarser: 4,
        rougher: 3,
        mean: CAMERAS,
        narrow: CAMERAS_NARROW,
        point_rms: CAMERAS_POINT_RMS,
        certain: 0.0,
        certain_if_coarse: 0.0,
    }
}

/// No cameras; four standard errors are added wherever a mean is taken. What is left is that points stay 1e-4 of a
/// triangle away from its edges.
pub fn hemisphere_on_brute() -> Pair {
    let rays = RayOptions { samples: 256, ..RayOptions::default() };
    Pair {
        options: options(BackendKind::Brute, Estimator::Hemisphere, rays),
        coarser: 4,
        rougher: 3,
        mean: 1e-4,
        narrow: 1e-2,
        // √(V (1 − V) / 256) at worst.
        point_rms: 0.032,
        certain: 0.0,
        certain_if_coarse: 0.0,
    }
}

#[cfg(feature = "embree")]
pub fn surface_on_embree() -> Pair {
    let options = MeasureOptions { backend: BackendKind::Embree, ..surface_on_brute().options };
    // On fine meshes a few rays to cameras that look along a triangle are lost: 2e-13 of an icosphere of 20,480.
    // Rays are `f32`, and such cameras hardly count.
    Pair { options, coarser: 1, rougher: 0, certain: 1e-12, ..surface_on_brute() }
}

#[cfg(feature = "embree")]
pub fn hemisphere_on_embree() -> Pair {
    let rays = RayOptions { samples: 4096, ..RayOptions::default() };
    let options = options(BackendKind::Embree, Estimator::Hemisphere, rays);
    // √(V (1 − V) / 4096) at worst.
    Pair { options, coarser: 2, rougher: 2, point_rms: 0.008, ..hemisphere_on_brute() }
}

fn options(backend: BackendKind, estimator: Estimator, rays: RayOptions) -> MeasureOptions {
    MeasureOptions { backend, estimator, rays, ..MeasureOptions::default() }
}

impl Pair {
    /// Cells along a side of a mesh that has `n` for pictures.
    pub fn cells(&self, n: usize) -> usize {
        (n / self.coarser).max(1)
    }

    /// Segments of a circle, or rings, that has `n` for pictures.
    pub fn round<const N: usize>(&self, n: [usize; N]) -> [usize; N] {
        n.map(|n| self.cells(n))
    }

    /// Subdivisions of a ball that has `n` for pictures.
    pub fn level(&self, n: u32) -> u32 {
        n - self.rougher.min(n)
    }

    /// Random pieces in a box that holds `n` for pictures.
    pub fn pieces(&self, n: usize) -> usize {
        n / self.coarser.pow(2)
    }

    /// The front sides, from 258 cameras that are turned away from the coordinate planes.
    pub fn look(&self, mesh: &TriMesh) -> Visibility {
        self.look_at(mesh, Sides::One)
    }

    pub fn look_at(&self, mesh: &TriMesh, sides: Sides) -> Visibility {
        let rotation = DMat3::from_rotation_z(0.4) * DMat3::from_rotation_y(1.1) * DMat3::from_rotation_x(0.7);
        let cameras = CameraSphere::octahedral(258, CameraWeights::Area).unwrap().rotated(rotation);
        let options = MeasureOptions { sides, ..self.options.clone() };
        Subject::new(mesh, options.backend).unwrap().measure_from(&cameras, &options, None, &Silent).unwrap()
    }

    /// The same without turning the cameras.
    pub fn measure(&self, mesh: &TriMesh, cameras: usize, camera_weights: CameraWeights) -> Visibility {
        let options = MeasureOptions { cameras: Cameras::octahedral(cameras), camera_weights, ..self.options.clone() };
        outsight::visibility::measure(mesh, &options, &Silent).unwrap()
    }

    /// Whether cameras are what it looks with.
    pub fn has_cameras(&self) -> bool {
        self.options.estimator != Estimator::Hemisphere
    }

    /// Looks at a shape, for [`Seen::check`].
    pub fn see<'a>(&'a self, shape: &'a Tagged) -> Seen<'a> {
        Seen { pair: self, shape, visibility: self.look(&shape.mesh) }
    }
}

/// A shape and what a pair sees of it.
pub struct Seen<'a> {
    pair: &'a Pair,
    pub shape: &'a Tagged,
    pub visibility: Visibility,
}

impl Seen<'_> {
    /// The mean over a surface is as expected, up to what the pair may be off and the mesh differs from the smooth shape.
    #[track_caller]
    pub fn check(&self, surface: &str, expected: f64, polygonal: f64) {
        let triangles = self.shape.triangles(surface);
        let tolerance = self.pair.mean + 4.0 * self.standard_error(triangles.clone()) + polygonal;
        assert_abs_diff_eq!(self.mean(triangles), expected, epsilon = tolerance);
    }

    /// Area-weighted mean of the fronts of all triangles.
    pub fn mean_of_all(&self) -> f64 {
        self.mean(0..self.shape.mesh.triangle_count())
    }

    /// What the mean over all triangles may be off.
    pub fn tolerance(&self) -> f64 {
        self.pair.mean + 4.0 * self.standard_error(0..self.shape.mesh.triangle_count())
    }

    pub fn mean(&self, triangles: Range<usize>) -> f64 {
        let front = self.visibility.front();
        self.weighted(triangles.clone(), |area, t| area * front[t]) / self.area(triangles)
    }

    fn standard_error(&self, triangles: Range<usize>) -> f64 {
        let Some(errors) = &self.visibility.details().standard_error else { return 0.0 };
        let variance = self.weighted(triangles.clone(), |area, t| (area * errors.per_triangle[t]).powi(2));
        variance.sqrt() / self.area(triangles)
    }

    fn area(&self, triangles: Range<usize>) -> f64 {
        self.weighted(triangles, |area, _| area)
    }

    fn weighted(&self, triangles: Range<usize>, term: impl Fn(f64, usize) -> f64) -> f64 {
        triangles.map(|t| term(triangle_area(self.shape.mesh.corners(TriangleId(t as u32))), t)).sum()
    }
}
