use glam::DVec3;
use sobol_burley::sample;

use crate::camera::CameraSphere;
use crate::error::Result;
use crate::mesh::TriangleId;
use crate::visibility::estimate::{Estimate, Looking};
use crate::visibility::rays::{Batch, Caster, point_inside, ray, stream_seed};
use crate::visibility::{Details, PartlySeen, Shapes, Sides, Subject};

/// A camera that a triangle's plane passes this close, as a cosine, looks along it and counts for neither side.
const EDGE_ON: f64 = 1e-9;

/// Rays cast together: those of neighbouring triangles toward one camera.
const BATCH_RAYS: usize = 256;

/// Casts rays from points on each triangle toward the cameras: [`crate::visibility::Estimator::Surface`].
///
/// V(t) = Σ_v a_v (d_v·n_t)⁺ F(t,v) / Σ_v a_v (d_v·n_t)⁺: Zhang & Turk 2002, eq. (4.3), with F as [`PartlySeen`] says.
/// Both sums run over the same cameras in the same order, so that a triangle that everyone sees has exactly 1. The back
/// counts the same way; [`Sides::One`] does not pay for it and leaves it at 0.
///
/// # Errors
/// [`crate::Error::Option`] for a backend that casts no rays, what the backend says, [`crate::Error::Cancelled`].
pub(super) fn estimate(subject: &Subject<'_>, shapes: &Shapes, looking: &Looking<'_>) -> Result<Estimate> {
    let caster = Caster::new(subject, shapes, looking.cameras)?;
    let surface = Surface { caster: &caster, looking, cameras: all(looking.cameras) };
    let points = looking.options.rays.points as usize;
    let mut sums = vec![[Sum::default(); 2]; caster.order().len()];
    let block = (BATCH_RAYS / points).max(1);
    caster.fill(&mut sums, block, looking.progress, |batch, triangles, sums| surface.look(batch, triangles, sums))?;
    if looking.cameras.hemisphere().is_some() {
        // Cameras that the hemisphere leaves out are in front of a triangle too, and see nothing.
        for (&t, [front, back]) in caster.order().iter().zip(&mut sums) {
            let normal = caster.normal(t);
            (front.all, back.all) = (looking.cameras.cosine_sum(normal), looking.cameras.cosine_sum(-normal));
        }
    }
    let [front, back] = [0, 1].map(|side| caster.in_index_order(&sums, |sums| sums[side].visibility()));
    let details = Details { rays: caster.rays(), ..Details::default() };
    Ok(Estimate { front, back, pooled_below: 0.0, resolution: 0, details })
}

/// The two sums of eq. (4.3) for one side of a triangle.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    seen: f64,
    all: f64,
}

impl Sum {
    fn add(&mut self, weight: f64, share: f64) {
        self.seen += weight * share;
        self.all += weight;
    }

    fn visibility(self) -> f64 {
        if self.all > 0.0 { self.seen / self.all } else { 0.0 }
    }
}

struct Camera {
    number: usize,
    direction: DVec3,
    weight: f64,
}

fn all(cameras: &CameraSphere) -> Vec<Camera> {
    let camera = |(number, &direction)| Camera { number, direction, weight: cameras.weight(number as u32) as f64 };
    cameras.directions().iter().enumerate().map(camera).collect()
}

struct Surface<'a> {
    caster: &'a Caster<'a>,
    looking: &'a Looking<'a>,
    cameras: Vec<Camera>,
}

impl Surface<'_> {
    /// Looks from a block of triangles at every camera and adds what each side sees.
    fn look(&self, batch: &mut Batch, triangles: &[u32], sums: &mut [[Sum; 2]]) -> Result<()> {
        let origins: Vec<Vec<[f32; 3]>> = triangles.iter().map(|&t| self.points(t)).collect();
        let normals: Vec<DVec3> = triangles.iter().map(|&t| self.caster.normal(t)).collect();
        let mut cosines = Vec::with_capacity(triangles.len());
        for camera in &self.cameras {
            batch.rays.clear();
            cosines.clear();
            for (i, &t) in triangles.iter().enumerate() {
                let cosine = normals[i].dot(camera.direction);
                if self.counts(cosine) {
                    cosines.push((i, cosine));
                    batch.rays.extend(origins[i].iter().map(|&origin| ray(origin, camera.direction, t)));
                }
            }
            let points = self.looking.options.rays.points as usize;
            for (&(i, cosine), blocked) in cosines.iter().zip(self.caster.cast(batch)?.chunks_exact(points)) {
                let share = self.share_seen(triangles[i], camera, blocked);
                sums[i][usize::from(cosine < 0.0)].add(camera.weight * cosine.abs(), share);
            }
        }
        Ok(())
    }

    /// Whether a camera at this signed cosine from a triangle's normal is asked.
    fn counts(&self, cosine: f64) -> bool {
        cosine > EDGE_ON || (cosine < -EDGE_ON && self.looking.options.sides != Sides::One)
    }

    /// F(t, v), from which of the triangle's rays to the camera are blocked.
    fn share_seen(&self, triangle: u32, camera: &Camera, blocked: &[bool]) -> f64 {
        let free = blocked.iter().filter(|&&blocked| !blocked).count();
        if free == 0 {
            return 0.0;
        }
        if let Some(diagram) = self.looking.diagram {
            diagram.record(TriangleId(triangle), camera.number);
        }
        match self.looking.options.rays.partly_seen {
            PartlySeen::Share => free as f64 / blocked.len() as f64,
            PartlySeen::Whole => 1.0,
        }
    }

    /// Where a triangle's rays start: symmetric points while they are few, evenly spread random ones beyond.
    fn points(&self, triangle: u32) -> Vec<[f32; 3]> {
        let corners = self.caster.corners(triangle);
        let options = &self.looking.options.rays;
        let centroid = corners.iter().sum::<DVec3>() / 3.0;
        let toward_corners = corners.map(|corner| 0.5 * (centroid + corner));
        let narrow = |points: &[DVec3]| points.iter().map(|p| p.as_vec3().to_array()).collect();
        match options.points {
            1 => narrow(&[centroid]),
            3 => narrow(&toward_corners),
            4 => narrow(&[&toward_corners[..], &[centroid]].concat()),
            many => {
                let seed = stream_seed(options.seed, triangle, 0);
                (0..many).map(|i| point_inside(corners, sample(i, 0, seed), sample(i, 1, seed))).collect()
            }
        }
    }
}
