//! How far two surfaces are apart: sampled two-sided distance.
//!
//! Points are spread over each of the two meshes, and for each the nearest point of the *other* mesh is found. From the
//! reference to the test this shows what was lost; from the test to the reference, what was made up.
//!
//! Sources: Cignoni, Rocchini & Scopigno, Metro: measuring error on simplified surfaces, 1998 (sampling one surface
//! and searching the other, each way); Aspert, Santa-Cruz & Ebrahimi, MESH: measuring errors between surfaces using
//! the Hausdorff distance, 2002 (the larger direction as the symmetric value, for mean and RMS too).

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use super::nearest::NearestTriangles;
use super::sample::SurfaceSamples;
use crate::error::{Error, Result};
use crate::geom::Aabb;
use crate::mesh::TriMesh;
use crate::progress::Progress;

/// Samples that one thread takes at a time. Part of the result's last bits, since sums are made chunk by chunk.
const CHUNK: u64 = 4096;

/// Fewest area-uniform samples per mesh that [`SampleCount::PerTriangle`] takes.
pub const MIN_SAMPLES: u64 = 100_000;

const PHASE: &str = "geometric error";

/// How many points are spread over the area of each mesh. Every vertex that a triangle uses comes on top.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SampleCount {
    /// This many per triangle of the *reference*, and at least [`MIN_SAMPLES`]; the same number on both meshes.
    PerTriangle(u32),
    /// Exactly this many on each mesh, at least 1.
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
    /// Diagonal of the reference's box, in model units.
    pub diagonal: f64,
    /// Points whose distance was taken, both directions and the vertices included.
    pub samples: u64,
}

impl GeometricError {
    /// The symmetric values in % of the diagonal of the reference's box; not finite where that box is a point.
    #[must_use]
    pub fn percent(&self) -> Distances {
        let Self { mean, rms, max, .. } = *self;
        Distances { mean, rms, max }.times(100.0 / self.diagonal)
    }
}

impl Distances {
    fn times(self, factor: f64) -> Self {
        Self { mean: self.mean * factor, rms: self.rms * factor, max: self.max * factor }
    }
}

/// Measures how far `test` and `reference` are apart, both ways.
///
/// Mean and RMS are taken over points spread evenly over the area, so that they are means over the *surface*; the
/// maximum also over all vertices that a triangle uses, where simplified surfaces stick out most. A mesh whose
/// triangles have no area gives its vertices to all three. The symmetric mean, RMS and maximum are the larger of the
/// two directions'.
///
/// The result depends on the options alone, not on the number of threads. Both meshes are moved into the unit box
/// first, so it does not depend on the unit either, beyond rounding.
///
/// # Errors
/// [`Error::Option`] for a sample count of 0, [`Error::Cancelled`].
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
    let frame = Frame::around(reference, test);
    let count = sample_count(options.samples, reference)?;
    let [reference_surface, test_surface] = [reference, test].map(|mesh| Surface::new(mesh, frame));
    let samples = [&reference_surface, &test_surface].map(|s| SurfaceSamples::new(&s.corners, count, options.seed));
    let totals = [0, 1].map(|i| samples[i].count() + [&reference_surface, &test_surface][i].vertices.len() as u64);
    let counter = Counter { progress, done: AtomicU64::new(0), total: totals[0] + totals[1] };

    let forward = one_sided(&reference_surface, &samples[0], &test_surface, &counter)?.times(frame.unit);
    let backward = one_sided(&test_surface, &samples[1], &reference_surface, &counter)?.times(frame.unit);
    Ok(GeometricError {
        mean: forward.mean.max(backward.mean),
        rms: forward.rms.max(backward.rms),
        max: forward.max.max(backward.max),
        forward,
        backward,
        diagonal: reference.bounds().diagonal(),
        samples: counter.total,
    })
}

fn sample_count(asked: SampleCount, reference: &TriMesh) -> Result<u64> {
    let count = match asked {
        SampleCount::Exactly(count) => count,
        SampleCount::PerTriangle(each) => {
            let wanted = u64::from(each) * reference.triangle_count() as u64;
            if each == 0 { 0 } else { wanted.max(MIN_SAMPLES) }
        }
    };
    if count == 0 {
        let message = "0 samples measure nothing; give at least 1".to_owned();
        return Err(Error::Option { name: "--samples", message });
    }
    Ok(count)
}

/// Moves both meshes into a cube of side 1 around the origin, so that no square overflows or vanishes.
#[derive(Clone, Copy)]
struct Frame {
    centre: DVec3,
    /// Length of the cube's side in model units.
    unit: f64,
}

impl Frame {
    fn around(reference: &TriMesh, test: &TriMesh) -> Self {
        let (a, b) = (reference.bounds(), test.bounds());
        let both = Aabb { min: a.min.min(b.min), max: a.max.max(b.max) };
        let side = (both.max - both.min).max_element();
        // A mesh shrunk to one point has no side; nor can it be divided by a denormal one.
        Self { centre: both.centre(), unit: if side >= f64::MIN_POSITIVE { side } else { 1.0 } }
    }
}

/// One of the two surfaces, within the unit box.
struct Surface {
    /// Corners of each triangle.
    corners: Vec<[DVec3; 3]>,
    /// Vertices that a triangle uses.
    vertices: Vec<DVec3>,
}

impl Surface {
    fn new(mesh: &TriMesh, frame: Frame) -> Self {
        let positions: Vec<_> = mesh.positions().iter().map(|&p| (p - frame.centre) / frame.unit).collect();
        let corners = mesh.triangles().iter().map(|t| t.map(|v| positions[v as usize])).collect();
        let mut is_used = vec![false; positions.len()];
        mesh.triangles().iter().flatten().for_each(|&v| is_used[v as usize] = true);
        let vertices = positions.into_iter().zip(is_used).filter_map(|(p, used)| used.then_some(p)).collect();
        Self { corners, vertices }
    }
}

/// Tells the caller how far the work is, and asks whether to go on.
struct Counter<'a> {
    progress: &'a dyn Progress,
    done: AtomicU64,
    total: u64,
}

impl Counter<'_> {
    fn add(&self, count: u64) -> Result<()> {
        let done = self.done.fetch_add(count, Ordering::Relaxed) + count;
        self.progress.report(PHASE, done, self.total);
        self.progress.check()
    }
}

/// Distances from the vertices of `from` and from points on it to the surface `to`.
fn one_sided(from: &Surface, points: &SurfaceSamples, to: &Surface, counter: &Counter) -> Result<Distances> {
    counter.progress.check()?;
    let tree = NearestTriangles::new(to.corners.clone());
    let vertex_count = from.vertices.len() as u64;
    let at_vertices = sum_over(vertex_count, counter, |chunk| {
        Sums::over(&tree, from.vertices[chunk.start as usize..chunk.end as usize].iter().copied())
    })?;
    let on_area = sum_over(points.count(), counter, |chunk| Sums::over(&tree, points.points(chunk)))?;
    let mean_of = if points.count() > 0 { on_area } else { at_vertices };
    Ok(Distances { max: at_vertices.max.max(on_area.max), ..mean_of.distances() })
}

/// Sums over `0..count`, in chunks of a fixed size that are added in order: the same for any number of threads.
fn sum_over(count: u64, counter: &Counter, of_chunk: impl Fn(Range<u64>) -> Sums + Sync) -> Result<Sums> {
    let chunks: Vec<Sums> = (0..count.div_ceil(CHUNK))
        .into_par_iter()
        .map(|i| {
            let chunk = i * CHUNK..((i + 1) * CHUNK).min(count);
            let length = chunk.end - chunk.start;
            let sums = of_chunk(chunk);
            counter.add(length).map(|()| sums)
        })
        .collect::<Result<_>>()?;
    Ok(chunks.into_iter().fold(Sums::default(), Sums::plus))
}

/// Sums from which mean, RMS and maximum follow.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    count: u64,
    distance: f64,
    distance_squared: f64,
    max: f64,
}

impl Sums {
    /// Over neighbouring points: the search for each begins at the triangle nearest to the one before.
    fn over(tree: &NearestTriangles, points: impl Iterator<Item = DVec3>) -> Self {
        let mut slot = 0;
        points.fold(Self::default(), |sums, point| {
            let nearest = tree.nearest(point, slot);
            slot = nearest.slot;
            let distance = nearest.distance_squared.sqrt();
            let distance_squared = nearest.distance_squared;
            sums.plus(Self { count: 1, distance, distance_squared, max: distance })
        })
    }

    fn plus(self, other: Self) -> Self {
        Self {
            count: self.count + other.count,
            distance: self.distance + other.distance,
            distance_squared: self.distance_squared + other.distance_squared,
            max: self.max.max(other.max),
        }
    }

    fn distances(self) -> Distances {
        let count = self.count.max(1) as f64;
        Distances { mean: self.distance / count, rms: (self.distance_squared / count).sqrt(), max: self.max }
    }
}

#[cfg(test)]
mod tests;
