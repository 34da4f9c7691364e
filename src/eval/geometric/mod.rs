//! How far two surfaces are apart: sampled two-sided distance.
//!
//! Points are spread over each of the two meshes, and for each the nearest point of the *other* mesh is found. From the
//! reference to the test this shows what was lost; from the test to the reference, what was made up.
//!
//! Sources: Cignoni, Rocchini & Scopigno, Metro: measuring error on simplified surfaces, 1998 (sampling one surface
//! and searching the other, each way); Aspert, Santa-Cruz & Ebrahimi, MESH: measuring errors between surfaces using
//! the Hausdorff distance, 2002 (the larger direction as the symmetric value, for mean and RMS too).

mod flipped;
mod sums;

use std::sync::atomic::AtomicU64;

use glam::DVec3;

use super::nearest::NearestTriangles;
use super::sample::SurfaceSamples;
use crate::error::{Error, Result};
use crate::geom::Aabb;
use crate::mesh::TriMesh;
use crate::progress::Progress;
use sums::{Counter, one_sided};

/// Fewest area-uniform samples per mesh that [`SampleCount::PerTriangle`] takes.
pub const MIN_SAMPLES: u64 = 100_000;

/// Most area-uniform samples per mesh: ten minutes of one thread.
pub const MAX_SAMPLES: u64 = 1_000_000_000;

/// How many times larger or smaller than the reference a mesh may be.
const MAX_SCALE: f64 = 1e6;

const PHASE: &str = "geometric error";

/// How many points are spread over the area of each mesh. Every vertex that a triangle uses comes on top.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SampleCount {
    /// This many per triangle of the *reference*, and at least [`MIN_SAMPLES`]; the same number on both meshes.
    PerTriangle(u32),
    /// Exactly this many on each mesh, 1 to [`MAX_SAMPLES`].
    Exactly(u64),
}

impl Default for SampleCount {
    fn default() -> Self {
        Self::PerTriangle(10)
    }
}

/// How the geometric error is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GeometricOptions {
    /// Number of samples.
    pub samples: SampleCount,
    /// Moves the samples; the same seed gives the same samples.
    pub seed: u64,
}

/// Mean, root mean square and largest of some distances.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct Distances {
    /// Mean.
    pub mean: f64,
    /// Root mean square.
    pub rms: f64,
    /// Largest.
    pub max: f64,
}

/// Distances between two surfaces, in model units; [`GeometricError::percent`] gives them in % of the diagonal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GeometricError {
    /// The larger of both directions' means.
    pub mean: f64,
    /// The larger of both directions' root mean squares.
    pub rms: f64,
    /// The larger of both directions' maxima: the sampled Hausdorff distance, never above the true one.
    pub max: f64,
    /// From points of the reference to the test.
    pub forward: Distances,
    /// From points of the test to the reference.
    pub backward: Distances,
    /// What the reference's visibility tells apart; `None` where it was not given.
    pub seen: Option<SeenError>,
    /// Diagonal of the reference's box, in model units.
    pub diagonal: f64,
    /// Points whose distance was taken, both directions and the vertices included.
    pub samples: u64,
}

/// Distances from points of the reference to the test, by how well the reference's surface can be seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenError {
    /// Over its visible surface, V > 0; `None` if there is none.
    pub visible: Option<Distances>,
    /// Over its hidden surface, V = 0; `None` if there is none.
    pub hidden: Option<Distances>,
    /// Root mean square with visibility as the weight, √(∫ V d² / ∫ V); `None` where nothing is visible.
    pub weighted_rms: Option<f64>,
}

impl GeometricError {
    /// The symmetric values in % of the diagonal of the reference's box; not finite where that box is a point.
    #[must_use]
    pub fn percent(&self) -> Distances {
        let Self { mean, rms, max, .. } = self.times(100.0 / self.diagonal);
        Distances { mean, rms, max }
    }

    /// The same in another unit: all distances and the diagonal times `factor`.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        Self {
            mean: self.mean * factor,
            rms: self.rms * factor,
            max: self.max * factor,
            forward: self.forward.times(factor),
            backward: self.backward.times(factor),
            seen: self.seen.map(|seen| SeenError {
                visible: seen.visible.map(|d| d.times(factor)),
                hidden: seen.hidden.map(|d| d.times(factor)),
                weighted_rms: seen.weighted_rms.map(|rms| rms * factor),
            }),
            diagonal: self.diagonal * factor,
            samples: self.samples,
        }
    }
}

impl Distances {
    fn times(self, factor: f64) -> Self {
        Self { mean: self.mean * factor, rms: self.rms * factor, max: self.max * factor }
    }
}

/// Measures how far `test` and `reference` are apart, both ways; see [`ReferenceSurface::compare`].
///
/// # Errors
/// As [`ReferenceSurface::new`] and [`ReferenceSurface::compare`].
///
/// # Examples
/// ```
/// use glam::DVec3;
/// use outsight::eval::geometric::{GeometricOptions, geometric_error};
/// use outsight::mesh::TriMesh;
/// use outsight::progress::Silent;
///
/// let plate = |z| TriMesh::new(vec![DVec3::new(0.0, 0.0, z), DVec3::new(3.0, 0.0, z), DVec3::new(0.0, 4.0, z)], vec![[0, 1, 2]]);
/// let error = geometric_error(&plate(0.0)?, &plate(0.5)?, GeometricOptions::default(), &Silent).unwrap();
/// assert!((error.rms - 0.5).abs() < 1e-12);
/// assert!((error.percent().max - 10.0).abs() < 1e-10); // of a diagonal of 5
/// # Ok::<(), outsight::error::MeshError>(())
/// ```
pub fn geometric_error(
    reference: &TriMesh,
    test: &TriMesh,
    options: GeometricOptions,
    progress: &dyn Progress,
) -> Result<GeometricError> {
    ReferenceSurface::new(reference, None, options)?.compare(test, progress)
}

/// The surface that others are compared with, laid out for search once.
#[derive(Debug)]
pub struct ReferenceSurface<'a> {
    bounds: Aabb,
    frame: Frame,
    surface: Surface,
    tree: NearestTriangles,
    visibility: Option<&'a [f64]>,
    count: u64,
    seed: u64,
}

impl<'a> ReferenceSurface<'a> {
    /// Prepares `mesh`; `visibility` holds V of each of its triangles, 0 to 1, where that is known.
    ///
    /// # Errors
    /// [`Error::Option`] for no samples or more than [`MAX_SAMPLES`], [`Error::ShapeMismatch`] if `visibility` was made
    /// for another mesh.
    pub fn new(mesh: &TriMesh, visibility: Option<&'a [f64]>, options: GeometricOptions) -> Result<Self> {
        let (expected, got) = (mesh.triangle_count(), visibility.map(<[f64]>::len));
        if let Some(got) = got.filter(|&got| got != expected) {
            return Err(Error::ShapeMismatch { what: "visibility", got, expected });
        }
        let count = sample_count(options.samples, mesh)?;
        let (bounds, frame) = (mesh.bounds(), Frame::around(mesh.bounds()));
        let surface = Surface::new(mesh, frame, visibility);
        let tree = NearestTriangles::new(surface.corners.clone());
        Ok(Self { bounds, frame, surface, tree, visibility, count, seed: options.seed })
    }

    /// Measures how far `test` and the reference are apart, both ways.
    ///
    /// Mean and RMS are taken over points spread evenly over the area, so that they are means over the *surface*; the
    /// maximum also over all vertices that a triangle uses, where simplified surfaces stick out most. A mesh whose
    /// triangles have no area gives its vertices to all three. The symmetric mean, RMS and maximum are the larger of the
    /// two directions'.
    ///
    /// The result depends on the options alone, not on the number of threads. Both meshes are moved into the unit box
    /// of the reference first, so it does not depend on the unit either, beyond rounding.
    ///
    /// # Errors
    /// [`Error::Limit`] if one mesh is more than a million times larger than the other, [`Error::Cancelled`].
    pub fn compare(&self, test: &TriMesh, progress: &dyn Progress) -> Result<GeometricError> {
        self.check_scale(test.bounds())?;
        let test = Surface::new(test, self.frame, None);
        let samples = [&self.surface, &test].map(|s| SurfaceSamples::new(&s.corners, self.count, self.seed));
        let totals = [0, 1].map(|i| samples[i].count() + [&self.surface, &test][i].vertices.len() as u64);
        let counter = Counter { progress, done: AtomicU64::new(0), total: totals[0] + totals[1] };
        progress.check()?;

        let lost = one_sided((&self.surface, &samples[0]), &NearestTriangles::new(test.corners.clone()), &counter)?;
        let made_up = one_sided((&test, &samples[1]), &self.tree, &counter)?;
        let (forward, backward) = (lost.distances(), made_up.distances());
        let in_cube = GeometricError {
            mean: forward.mean.max(backward.mean),
            rms: forward.rms.max(backward.rms),
            max: forward.max.max(backward.max),
            forward,
            backward,
            seen: self.visibility.map(|_| lost.seen()),
            diagonal: 0.0,
            samples: counter.total,
        };
        Ok(GeometricError { diagonal: self.bounds.diagonal(), ..in_cube.times(self.frame.unit) })
    }

    fn check_scale(&self, test: Aabb) -> Result<()> {
        let reach = (test.min - self.frame.centre).abs().max((test.max - self.frame.centre).abs()).max_element();
        let larger = reach / self.frame.unit;
        let smaller = self.bounds.diagonal() / test.diagonal();
        let (times, how) = if larger > smaller { (larger, "larger") } else { (smaller, "smaller") };
        if times > MAX_SCALE {
            let message = format!(
                "a mesh {times:.0e} times {how} than the reference cannot be compared with it; are the units the same?"
            );
            return Err(Error::Limit { message });
        }
        Ok(())
    }
}

fn sample_count(asked: SampleCount, reference: &TriMesh) -> Result<u64> {
    let triangles = reference.triangle_count() as u64;
    let count = match asked {
        SampleCount::Exactly(count) => count,
        SampleCount::PerTriangle(0) => 0,
        SampleCount::PerTriangle(each) => (u64::from(each) * triangles).max(MIN_SAMPLES),
    };
    if !(1..=MAX_SAMPLES).contains(&count) {
        let message = format!("{count} samples; give 1 to {MAX_SAMPLES} on each mesh");
        return Err(Error::Option { name: "--surface-samples", message });
    }
    Ok(count)
}

/// Moves the reference into a cube of side 1 around the origin, so that no square overflows or vanishes.
#[derive(Debug, Clone, Copy)]
struct Frame {
    centre: DVec3,
    /// Length of the cube's side in model units.
    unit: f64,
}

impl Frame {
    fn around(reference: Aabb) -> Self {
        let side = (reference.max - reference.min).max_element();
        // A mesh shrunk to one point has no side; nor can it be divided by a denormal one.
        Self { centre: reference.centre(), unit: if side >= f64::MIN_POSITIVE { side } else { 1.0 } }
    }

    fn to_cube(self, p: DVec3) -> DVec3 {
        (p - self.centre) / self.unit
    }
}

/// One of the two surfaces, in the reference's cube.
#[derive(Debug)]
struct Surface {
    /// Corners of each triangle.
    corners: Vec<[DVec3; 3]>,
    /// V of each triangle; all of it counts as visible where V is not known.
    visibility: Option<Vec<f64>>,
    /// Vertices that a triangle uses, each with the V of the most visible of its triangles.
    vertices: Vec<(DVec3, f64)>,
}

/// V of surface of which no visibility is known.
const UNKNOWN: f64 = 1.0;

/// Stands for the V of a vertex that no triangle uses.
const UNUSED: f64 = f64::NEG_INFINITY;

impl Surface {
    fn new(mesh: &TriMesh, frame: Frame, visibility: Option<&[f64]>) -> Self {
        let positions: Vec<_> = mesh.positions().iter().map(|&p| frame.to_cube(p)).collect();
        let corners = mesh.triangles().iter().map(|t| t.map(|v| positions[v as usize])).collect();
        let mut best = vec![UNUSED; positions.len()];
        for (number, triangle) in mesh.triangles().iter().enumerate() {
            let v = visibility.map_or(UNKNOWN, |v| v[number]);
            triangle.iter().for_each(|&vertex| best[vertex as usize] = v.max(best[vertex as usize]));
        }
        let vertices = positions.into_iter().zip(best).filter(|(_, v)| *v > UNUSED).collect();
        Self { corners, visibility: visibility.map(<[f64]>::to_vec), vertices }
    }

    fn visibility_of(&self, triangle: usize) -> f64 {
        self.visibility.as_ref().map_or(UNKNOWN, |v| v[triangle])
    }
}

#[cfg(test)]
mod tests;
