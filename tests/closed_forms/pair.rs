//! The pairs of an estimator and a backend that the suite runs on, and how exact each is.

use std::ops::Range;

use approx::assert_abs_diff_eq;
use glam::DMat3;
use outsight::backend::BackendKind;
use outsight::camera::{CameraSphere, CameraWeights, Cameras, Frame, Window};
use outsight::geom::triangle_area;
use outsight::mesh::shapes::Tagged;
use outsight::mesh::{TriMesh, TriangleId};
use outsight::progress::Silent;
use outsight::visibility::{DepthRescue, Estimator, MeasureOptions, RayOptions, Sides, Subject, Visibility};

/// An estimator on a backend.
pub struct Pair {
    options: MeasureOptions,
    /// Curved surfaces have 64 quads and more around; here so many times fewer, since the judge takes quadratic time and
    /// others count many rays or large triangles. Nothing is asked that such a mesh cannot answer: the expected number is the
    /// polyhedron's own, by the theorem of T11, or the tolerance grows with the area that it lacks.
    coarser: usize,
    /// Subdivisions of balls that are left out, for the same reason.
    rougher: u32,
    /// Of a row of like cases every so manieth is enough, for want of time.
    sparser: usize,
    /// What a mean over a surface may be off, beside four standard errors where the estimator knows its own.
    pub mean: f64,
    /// Relative to small values: cameras that happen to look in through a narrow hole.
    pub narrow: f64,
    /// Longest edge of the pieces that a camera sees or does not see, in pixels: what is half in shadow counts as seen.
    piece: f64,
    /// What a single triangle may be off, root mean square.
    pub point_rms: f64,
    /// What convex and sealed surfaces may be off.
    pub certain: f64,
    /// What the backs of closed solids may have, in the mean.
    pub backs: f64,
    /// The same as `certain` for meshes of few pixels a triangle or under few cameras.
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
        sparser: 1,
        mean: CAMERAS,
        narrow: CAMERAS_NARROW,
        piece: 0.0,
        point_rms: 0.03,
        certain: 1e-3,
        certain_if_coarse: 4e-3,
        backs: 0.0,
    }
}

/// What Embree's backs of a closed solid may have in the mean.
///
/// Embree takes a line for a hit until it passes an edge by 2⁻²³ of the triangle's height (`eps` in its
/// `triangle_intersector_pluecker.h`). Beyond an outline that may be the front triangle alone, whose back the far camera then
/// sees. The tetrahedron has the highest triangles, 200 pixels, and outlines of about 480 pixels in 129 pictures: 1.5 such
/// pixels are to be expected, 3.5e-7 each. There is one; eight are allowed.
#[cfg(feature = "embree")]
const LONE_FRONTS: f64 = 2.8e-6;

/// The same meshes in a quarter of the pixels, for rays are slower than the rasteriser. The noise along outlines, which are
/// half as many pixels long, counts √8 times.
#[cfg(feature = "embree")]
pub fn coverage_on_embree() -> Pair {
    let options =
        MeasureOptions { backend: BackendKind::Embree, resolution: Some(240), ..coverage_on_raster().options };
    Pair {
        options,
        certain: 3e-3,
        certain_if_coarse: 0.012,
        // Of the raster's 0.03 the cameras have 0.015, and noise 0.026.
        point_rms: 0.075,
        backs: LONE_FRONTS,
        ..coverage_on_raster()
    }
}

/// What cameras see in part they see: too much by half a piece along the edges of shadows (see [`Pair::half_seen`]). What
/// all cameras see counts 1 and what none sees 0, exactly, each under the rule of rescue that promises it.
pub fn item_buffer_on_raster() -> Pair {
    let options =
        MeasureOptions { estimator: Estimator::ItemBuffer, rescue: DepthRescue::Strict, ..Default::default() };
    Pair {
        options,
        piece: 8.0,
        point_rms: CAMERAS_POINT_RMS,
        certain: 0.0,
        certain_if_coarse: 0.0,
        ..coverage_on_raster()
    }
}

/// A quarter of the pixels, and of the triangles, which without rescue must not be smaller than pixels. Its pieces are 25
/// times lower than the tetrahedron: a lone front is not to be expected, and one has 1.4e-6.
#[cfg(feature = "embree")]
pub fn item_buffer_on_embree() -> Pair {
    let options =
        MeasureOptions { backend: BackendKind::Embree, resolution: Some(240), ..item_buffer_on_raster().options };
    Pair { options, coarser: 2, rougher: 1, sparser: 2, backs: LONE_FRONTS, ..item_buffer_on_raster() }
}

/// The cameras' error, and that three points stand for a triangle; both sums of eq. (4.3) are the same where all is
/// seen, so that this is exact.
pub fn surface_on_brute() -> Pair {
    Pair {
        options: options(BackendKind::Brute, Estimator::Surface, RayOptions { points: 3, ..RayOptions::default() }),
        coarser: 5,
        rougher: 3,
        sparser: 2,
        mean: CAMERAS,
        narrow: CAMERAS_NARROW,
        piece: 0.0,
        point_rms: CAMERAS_POINT_RMS,
        certain: 0.0,
        certain_if_coarse: 0.0,
        backs: 0.0,
    }
}

/// No cameras; four standard errors are added wherever a mean is taken. What is left is that points stay 1e-4 of a
/// triangle away from its edges.
pub fn hemisphere_on_brute() -> Pair {
    let rays = RayOptions { samples: 128, ..RayOptions::default() };
    Pair {
        options: options(BackendKind::Brute, Estimator::Hemisphere, rays),
        coarser: 5,
        rougher: 3,
        sparser: 2,
        mean: 1e-4,
        narrow: 1e-2,
        piece: 0.0,
        // √(V (1 − V) / 128) at worst.
        point_rms: 0.045,
        certain: 0.0,
        certain_if_coarse: 0.0,
        backs: 0.0,
    }
}

#[cfg(feature = "embree")]
pub fn surface_on_embree() -> Pair {
    let options = MeasureOptions { backend: BackendKind::Embree, ..surface_on_brute().options };
    // On fine meshes a few rays to cameras that look along a triangle are lost: 2e-13 of an icosphere of 20,480.
    // Rays are `f32`, and such cameras hardly count.
    Pair { options, coarser: 1, rougher: 0, sparser: 1, certain: 1e-12, ..surface_on_brute() }
}

#[cfg(feature = "embree")]
pub fn hemisphere_on_embree() -> Pair {
    let rays = RayOptions { samples: 4096, ..RayOptions::default() };
    let options = options(BackendKind::Embree, Estimator::Hemisphere, rays);
    // √(V (1 − V) / 4096) at worst.
    Pair { options, coarser: 2, rougher: 2, sparser: 1, point_rms: 0.008, ..hemisphere_on_brute() }
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

    /// The same pair under another rule of rescue, which only the item buffer asks for.
    pub fn rescuing(&self, rescue: DepthRescue) -> Self {
        Self { options: MeasureOptions { rescue, ..self.options.clone() }, ..*self }
    }

    /// The same pair for boxes whose walls have no thickness. Along their folds, pieces of the inside have corners on the
    /// outline of the outside, and are rescued for all who look at that: with triangles of 6 by 3 pixels a slot's walls get
    /// 0.021 too much, 0.017 of it there.
    ///
    /// Without rescue a piece of n square pixels has no pixel, with probability 1 − n cos θ, for cameras at less than
    /// cos θ = 1/n, and loses 1/(3 n²) of its light; 1 % for the smallest, of six.
    pub fn without_rescue_at_folds(&self) -> Self {
        self.rescuing(DepthRescue::None)
    }

    /// Of a row of like cases, those that the pair has time for.
    pub fn some<T: Copy>(&self, cases: &[T]) -> Vec<T> {
        cases.iter().copied().step_by(self.sparser).collect()
    }

    /// How long a slot is that `n` stands for an endless one: its length fills the picture, and pieces of eight pixels have
    /// to be small beside its width.
    pub fn length(&self, n: f64) -> f64 {
        if self.piece > 0.0 { n / 5.0 } else { n }
    }

    /// What is too much in the mean over a surface of this area in a mesh, since pieces half in shadow count as seen.
    ///
    /// Along the edge of a shadow that is half a piece. Over a square a convex shadow's edge is at most about two sides
    /// long; seen by a camera that is all: one piece over the side of a square of that area.
    pub fn half_seen(&self, mesh: &TriMesh, area: f64) -> f64 {
        let pixel = Window::around_sphere(self.options.resolution_for(mesh.triangle_count())).pixel_size();
        self.piece * pixel * Frame::of(mesh).radius / area.sqrt()
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
        let tolerance = self.tolerance_over(triangles.clone()) + polygonal;
        assert_abs_diff_eq!(self.mean(triangles), expected, epsilon = tolerance);
    }

    /// Area-weighted mean of the fronts of all triangles.
    pub fn mean_of_all(&self) -> f64 {
        self.mean(0..self.shape.mesh.triangle_count())
    }

    /// What the mean over all triangles may be off.
    pub fn tolerance(&self) -> f64 {
        self.tolerance_over(0..self.shape.mesh.triangle_count())
    }

    fn tolerance_over(&self, triangles: Range<usize>) -> f64 {
        let half_seen = self.pair.half_seen(&self.shape.mesh, self.area(triangles.clone()));
        self.pair.mean + 4.0 * self.standard_error(triangles) + half_seen
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
