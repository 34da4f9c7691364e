//! What the estimators that cast rays share: who starts them where, in which order, and in which batches.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::backend::{Occlusion, Ray};
use crate::camera::CameraSphere;
use crate::error::Result;
use crate::geom::morton_code;
use crate::mesh::TriangleId;
use crate::progress::Progress;
use crate::visibility::{Shapes, Subject};

/// Casts rays from the triangles of a subject.
pub(super) struct Caster<'a> {
    subject: &'a Subject<'a>,
    occlusion: &'a dyn Occlusion,
    /// The triangles that have an area, along a Morton curve, so that the rays of a batch run through the same space.
    order: Vec<u32>,
    /// Where the cameras are restricted to a hemisphere, nothing is seen from the other one.
    hemisphere: Option<Vec3>,
    rays: AtomicU64,
}

/// Rounding of the cosine between a direction and the plane that bounds a hemisphere.
const HORIZON: f32 = 1e-6;

/// The rays that a worker casts together; kept from batch to batch.
#[derive(Default)]
pub(super) struct Batch {
    pub rays: Vec<Ray>,
    blocked: Vec<bool>,
}

impl<'a> Caster<'a> {
    /// # Errors
    /// [`crate::Error::Option`] for a backend that only draws.
    pub fn new(subject: &'a Subject<'a>, shapes: &Shapes, cameras: &CameraSphere) -> Result<Self> {
        let occlusion = subject.machine().occlusion()?;
        let solid = (0..shapes.areas.len() as u32).into_par_iter().filter(|&t| shapes.areas[t as usize] > 0.0);
        let place = |t: u32| morton_code(corners(subject, t).iter().sum::<DVec3>() / 3.0);
        let mut keys: Vec<(u64, u32)> = solid.map(|t| (place(t), t)).collect();
        keys.par_sort_unstable();
        let order = keys.into_iter().map(|(_, t)| t).collect();
        let hemisphere = cameras.hemisphere().map(|toward| toward.as_vec3());
        Ok(Self { subject, occlusion, order, hemisphere, rays: AtomicU64::new(0) })
    }

    /// Triangles in the order in which rays are cast.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Rays cast so far.
    pub fn rays(&self) -> u64 {
        self.rays.load(Ordering::Relaxed)
    }

    /// Corners of a triangle as the backend holds them, narrowed to `f32`: a ray starts in the plane that it sees.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        corners(self.subject, triangle)
    }

    /// Unit normal of a triangle, as exact as the mesh: narrowed, it would turn cameras that look along it to a side.
    pub fn normal(&self, triangle: u32) -> DVec3 {
        let shape = self.subject.frame().area_and_normal(self.subject.mesh(), TriangleId(triangle));
        shape.map_or(DVec3::ZERO, |(_, normal)| normal)
    }

    /// Says which rays of the batch are blocked, or lead out of the hemisphere of the cameras.
    ///
    /// # Errors
    /// What the backend says.
    pub fn cast<'b>(&self, batch: &'b mut Batch) -> Result<&'b [bool]> {
        batch.blocked.clear();
        batch.blocked.resize(batch.rays.len(), false);
        self.occlusion.blocked(&batch.rays, &mut batch.blocked)?;
        if let Some(toward) = self.hemisphere {
            for (ray, blocked) in batch.rays.iter().zip(&mut batch.blocked) {
                *blocked |= toward.dot(Vec3::from_array(ray.direction)) < -HORIZON;
            }
        }
        self.rays.fetch_add(batch.rays.len() as u64, Ordering::Relaxed);
        Ok(&batch.blocked)
    }

    /// Runs `work` on blocks of triangles and on their slots, in parallel; `slots` has one for each triangle of
    /// [`Caster::order`].
    ///
    /// # Errors
    /// What `work` says, [`crate::Error::Cancelled`].
    pub fn fill<S: Send>(
        &self,
        slots: &mut [S],
        block: usize,
        progress: &dyn Progress,
        work: impl Fn(&mut Batch, &[u32], &mut [S]) -> Result<()> + Sync,
    ) -> Result<()> {
        let (done, total) = (AtomicU64::new(0), self.order.len() as u64);
        let blocks = self.order.par_chunks(block).zip(slots.par_chunks_mut(block));
        blocks.try_for_each_init(Batch::default, |batch, (triangles, slots)| {
            progress.check()?;
            work(batch, triangles, slots)?;
            let block = triangles.len() as u64;
            progress.report("visibility", done.fetch_add(block, Ordering::Relaxed) + block, total);
            Ok(())
        })
    }

    /// One value per triangle of the mesh, from the slots of [`Caster::fill`]; 0 for triangles without an area.
    pub fn in_index_order<S>(&self, slots: &[S], value: impl Fn(&S) -> f64) -> Vec<f64> {
        let mut values = vec![0.0; self.subject.mesh().triangle_count()];
        self.order.iter().zip(slots).for_each(|(&t, slot)| values[t as usize] = value(slot));
        values
    }
}

/// A ray that its own triangle does not block.
pub(super) fn ray(origin: [f32; 3], direction: DVec3, own: u32) -> Ray {
    Ray { origin, direction: direction.as_vec3().to_array(), own: Some(TriangleId(own)) }
}

/// How far points stay away from the edges, as a share of the way to the centroid: rounding to `f32` must not push a
/// point behind a wall that stands on an edge. It costs at most this share of how much V varies over the triangle.
const INSET: f64 = 1e-4;

/// The point of a triangle that (u, v) of the unit square is mapped to, evenly and strictly inside.
pub(super) fn point_inside([a, b, c]: [DVec3; 3], u: f32, v: f32) -> [f32; 3] {
    let root = f64::from(u).sqrt();
    let (beta, gamma) = (root * (1.0 - f64::from(v)), root * f64::from(v));
    let inside = |share: f64| share + INSET * (1.0 / 3.0 - share);
    (a * inside(1.0 - root) + b * inside(beta) + c * inside(gamma)).as_vec3().to_array()
}

/// Seed of a triangle's own stream of a scrambled Sobol sequence; streams of one triangle differ.
pub(super) fn stream_seed(seed: u64, triangle: u32, stream: u32) -> u32 {
    // The finaliser of SplitMix64 spreads neighbouring seeds and triangles; the odd factor keeps streams apart.
    let mut z = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ u64::from(triangle);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) as u32).wrapping_add(stream.wrapping_mul(0x9E37_79B9))
}

fn corners(subject: &Subject<'_>, triangle: u32) -> [DVec3; 3] {
    subject.mesh().corners(TriangleId(triangle)).map(|p| subject.frame().to_unit(p).as_vec3().as_dvec3())
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [DVec3; 3] = [DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 1.0, 0.0)];

    #[test]
    fn points_stay_strictly_inside_even_from_the_corners_of_the_unit_square() {
        const MOST: f32 = 1.0 - f32::EPSILON / 2.0;
        for (u, v) in [(0.0, 0.0), (0.0, MOST), (MOST, 0.0), (MOST, MOST), (0.5, 0.5)] {
            let [x, y, z] = point_inside(CORNERS, u, v);
            assert!(x > 1e-5 && y > 1e-5 && x + y < 1.0 - 1e-5 && z == 0.0, "{u} {v}: {x} {y}");
        }
    }

    /// ∫x = ∫y = 1/3 and ∫x² = 1/6 over the unit right triangle, as means.
    #[test]
    fn points_are_spread_evenly() {
        /// 65,536 points on a grid; the inset moves second moments by 1e-4.
        const EVEN: f64 = 2e-4;
        let steps = || (0..256).map(|i| (i as f32 + 0.5) / 256.0);
        let points: Vec<[f32; 3]> = steps().flat_map(|u| steps().map(move |v| point_inside(CORNERS, u, v))).collect();
        let mean = |f: fn(f64, f64) -> f64| {
            points.iter().map(|p| f(p[0].into(), p[1].into())).sum::<f64>() / points.len() as f64
        };
        approx::assert_abs_diff_eq!(mean(|x, _| x), 1.0 / 3.0, epsilon = EVEN);
        approx::assert_abs_diff_eq!(mean(|_, y| y), 1.0 / 3.0, epsilon = EVEN);
        approx::assert_abs_diff_eq!(mean(|x, _| x * x), 1.0 / 6.0, epsilon = EVEN);
        approx::assert_abs_diff_eq!(mean(|x, y| x * y), 1.0 / 12.0, epsilon = EVEN);
    }

    #[test]
    fn streams_of_seeds_triangles_and_scrambles_differ() {
        let seeds = [0, 1, u64::MAX].into_iter();
        let mut all: Vec<u32> =
            seeds.flat_map(|s| (0..1000).flat_map(move |t| (0..8).map(move |i| stream_seed(s, t, i)))).collect();
        all.sort_unstable();
        all.dedup();
        // 24,000 of 2³²: a chance of 7 % for one pair alike.
        assert!(all.len() >= 23_999);
    }
}
