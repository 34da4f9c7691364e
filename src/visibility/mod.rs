//! How visible each triangle is: the share of camera directions that see it, each counted by its cosine.
//!
//! Sources: Zhang & Turk 2002, eqs. (3.1) V of a point, (3.2) V of a mesh, (4.3) V from cameras. The estimator
//! `coverage` replaces their F(t, v), seen or not, by the share of the triangle's image that is seen; the cosines of
//! eq. (4.3) then cancel, and counting pixels is enough.

mod coverage;
mod hidden;
mod importance;
mod options;
mod pool;

pub use coverage::CoverageCounts;
pub use importance::{Hidden, importance};
pub use options::{Estimator, MeasureOptions, Sides};

use glam::DVec3;
use rayon::prelude::*;

use crate::backend::ItemBuffers;
use crate::camera::{CameraSphere, Frame, Window};
use crate::error::{Error, MeshError, Result};
use crate::mesh::{TriMesh, TriangleId};
use crate::progress::Progress;
use crate::raster::Scene;

/// The visibility of every triangle of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Visibility {
    front: Vec<f64>,
    back: Vec<f64>,
    per_triangle: Vec<f64>,
    seen: Vec<bool>,
    of_mesh: f64,
    of_mesh_sides: f64,
    resolution: u32,
    cameras: usize,
}

impl Visibility {
    /// One number per triangle, 0 to 1, under the rule for sides: clamped, and pooled where triangles are too small.
    #[must_use]
    pub fn per_triangle(&self) -> &[f64] {
        &self.per_triangle
    }

    /// V of each triangle's front side as counted: neither clamped nor pooled, so that it may pass 1 on tiny triangles.
    #[must_use]
    pub fn front(&self) -> &[f64] {
        &self.front
    }

    /// V of each triangle's back side as counted.
    #[must_use]
    pub fn back(&self) -> &[f64] {
        &self.back
    }

    /// Whether any camera sees the triangle, or the neighbourhood it was pooled with, from either side.
    #[must_use]
    pub fn seen(&self) -> &[bool] {
        &self.seen
    }

    /// Visibility of the mesh: one-sided, area-weighted, unclamped. Source: Zhang & Turk 2002, eq. (3.2).
    #[must_use]
    pub fn of_mesh(&self) -> f64 {
        self.of_mesh
    }

    /// The same mean under the rule for sides.
    #[must_use]
    pub fn of_mesh_sides(&self) -> f64 {
        self.of_mesh_sides
    }

    /// Number of triangles that no camera sees from either side; see [`Visibility::seen`].
    #[must_use]
    pub fn never_seen(&self) -> usize {
        self.seen.iter().filter(|&&s| !s).count()
    }

    /// Pixels along an image's side that were used.
    #[must_use]
    pub fn resolution(&self) -> u32 {
        self.resolution
    }

    /// Number of cameras that looked.
    #[must_use]
    pub fn cameras(&self) -> usize {
        self.cameras
    }
}

/// Looks at `mesh` from all cameras.
///
/// # Errors
/// [`crate::Error::Mesh`] if no triangle is large enough to be seen at all,
/// [`crate::Error::Option`] for a resolution or a number of cameras outside its range, [`crate::Error::Unavailable`] for
/// a backend or estimator that is not there, [`crate::Error::Limit`] if it does not fit the memory limit,
/// [`crate::Error::Cancelled`].
///
/// # Examples
/// ```
/// use outsight::mesh::TriMesh;
/// use outsight::progress::Silent;
/// use outsight::visibility::{measure, MeasureOptions};
///
/// let corners = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]].map(Into::into).to_vec();
/// let tetrahedron = TriMesh::new(corners, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])?;
/// let visibility = measure(&tetrahedron, &MeasureOptions::default(), &Silent)?;
/// assert!((visibility.of_mesh() - 1.0).abs() < 1e-2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn measure(mesh: &TriMesh, options: &MeasureOptions, progress: &dyn Progress) -> Result<Visibility> {
    measure_scene(&scene_of(mesh), mesh, options, progress)
}

/// What [`measure`] does before it looks: lays out `mesh` for drawing, in its own [`Frame`].
#[must_use]
pub fn scene_of(mesh: &TriMesh) -> Scene {
    Scene::new(Frame::of(mesh).unit_copy(mesh))
}

/// The rest of [`measure`]: looks at `mesh`, laid out as `scene`.
///
/// # Errors
/// As [`measure`].
pub fn measure_scene(
    scene: &Scene,
    mesh: &TriMesh,
    options: &MeasureOptions,
    progress: &dyn Progress,
) -> Result<Visibility> {
    options.check()?;
    let cameras = CameraSphere::octahedral(options.cameras, options.camera_weights)?;
    measure_with(scene, mesh, &cameras, options, progress)
}

/// What the simplifier needs to know of a mesh: how visible each triangle is, and which may go unseen.
#[derive(Debug, Clone)]
pub struct Look {
    /// The visibility.
    pub visibility: Visibility,
    /// The triangles to remove, one entry per triangle; none are marked unless [`Hidden::Delete`] asks for it.
    pub hidden: Vec<bool>,
}

/// Measures `mesh`, and finds what can be removed unseen where `hidden` asks for it.
///
/// # Errors
/// As [`measure`].
pub fn look(mesh: &TriMesh, options: &MeasureOptions, hidden: Hidden, progress: &dyn Progress) -> Result<Look> {
    let scene = scene_of(mesh);
    let visibility = measure_scene(&scene, mesh, options, progress)?;
    let hidden = hidden.marks(&scene, mesh, &visibility, options, progress)?;
    Ok(Look { visibility, hidden })
}

/// Like [`measure`], with a backend and cameras of the caller's.
///
/// `backend` must draw the mesh in its own [`Frame`]; of `options`, the resolution, the sides and the memory limit count.
///
/// # Errors
/// As [`measure`].
pub fn measure_with<B: ItemBuffers>(
    backend: &B,
    mesh: &TriMesh,
    cameras: &CameraSphere,
    options: &MeasureOptions,
    progress: &dyn Progress,
) -> Result<Visibility> {
    let window = Window::around_sphere(options.resolution_for(mesh.triangle_count()));
    let counts = CoverageCounts::of(backend, mesh.triangle_count(), cameras, window, options.memory_limit, progress)?;
    progress.check()?;
    if counts.covered() == 0 {
        let source = MeshError::NothingToSee { triangles: mesh.triangle_count() };
        return Err(Error::Mesh { place: "looking".to_owned(), source });
    }
    let shapes = Shapes::of(mesh, &Frame::of(mesh));
    from_coverage(&counts, mesh, &shapes, cameras, options.sides, progress)
}

/// Areas (unit-sphere units) and unit normals of all triangles; area 0 marks degenerate ones.
struct Shapes {
    areas: Vec<f64>,
    normals: Vec<[f32; 3]>,
}

impl Shapes {
    fn of(mesh: &TriMesh, frame: &Frame) -> Self {
        let shape = |t: u32| {
            let (area, normal) = frame.area_and_normal(mesh, TriangleId(t)).unwrap_or((0.0, DVec3::ZERO));
            (area, normal.as_vec3().to_array())
        };
        let (areas, normals) = (0..mesh.triangle_count() as u32).into_par_iter().map(shape).unzip();
        Self { areas, normals }
    }

    fn normal(&self, t: usize) -> DVec3 {
        DVec3::from_array(self.normals[t].map(f64::from))
    }
}

fn from_coverage(
    counts: &CoverageCounts,
    mesh: &TriMesh,
    shapes: &Shapes,
    cameras: &CameraSphere,
    sides: Sides,
    progress: &dyn Progress,
) -> Result<Visibility> {
    let (front, back) = counts.visibilities(shapes, cameras);
    debug_assert!(counts.identity_holds(&front, &back, shapes, cameras));
    let pools = pool::pool_small(mesh, shapes, counts.smallest_area(cameras), [&front, &back], progress)?;
    let value = |t: usize| sides.combine(pools.front(t, &front), pools.back(t, &back));
    let per_triangle = (0..front.len()).map(|t| value(t).clamp(0.0, 1.0)).collect();
    let seen = (0..front.len()).map(|t| pools.front(t, &front) > 0.0 || pools.back(t, &back) > 0.0).collect();
    let raw_sides = |t: usize| sides.combine(front[t], back[t]);
    Ok(Visibility {
        of_mesh: area_mean(&shapes.areas, |t| front[t]),
        of_mesh_sides: area_mean(&shapes.areas, raw_sides),
        per_triangle,
        seen,
        resolution: counts.window().width,
        cameras: cameras.count(),
        front,
        back,
    })
}

/// Mean of a value over the surface; sums run in index order.
fn area_mean(areas: &[f64], value: impl Fn(usize) -> f64) -> f64 {
    let total: f64 = areas.iter().sum();
    let weighted: f64 = areas.iter().enumerate().map(|(t, area)| area * value(t)).sum();
    if total > 0.0 { weighted / total } else { 0.0 }
}
