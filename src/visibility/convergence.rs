//! How V depends on the number of cameras.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::backend::{Workload, draw_all};
use crate::camera::{CameraSphere, CameraWeights, View};
use crate::error::Result;
use crate::raster::{Hit, Side};
use crate::visibility::coverage::for_each_run;
use crate::visibility::{Shapes, Subject};

/// Octahedral patterns, each of which holds the cameras of those before it.
const NESTED: [usize; 6] = [6, 18, 66, 258, 1026, 4098];

/// V of each triangle's front by coverage, neither clamped nor pooled, from one of several nested patterns.
#[derive(Debug, Clone, PartialEq)]
pub struct NestedVisibility {
    /// Cameras of the pattern.
    pub cameras: usize,
    /// How they counted.
    pub weights: CameraWeights,
    /// One number per triangle.
    pub front: Vec<f64>,
}

/// Measures from the octahedral patterns of 6 to 4098 cameras, under equal and under area weights, in one sweep.
///
/// The cameras of a pattern are the first ones of the next, so that the finest alone is drawn; what a camera sees counts
/// for every pattern that has it, by its weight there. Results ascend by the number of cameras, equal weights first.
///
/// # Errors
/// As [`draw_all`].
pub fn nested_visibility(subject: &Subject<'_>, load: Workload<'_>) -> Result<Vec<NestedVisibility>> {
    let both =
        |count| [CameraWeights::Equal, CameraWeights::Area].map(|w| Ok((w, CameraSphere::octahedral(count, w)?)));
    let spheres: Vec<(CameraWeights, CameraSphere)> = NESTED.into_iter().flat_map(both).collect::<Result<_>>()?;
    let tally = NestedTally::new(subject.mesh().triangle_count(), &spheres);
    let axes = spheres.last().map_or(&[][..], |(_, finest)| finest.axes());
    let views: Vec<View> = axes.iter().map(|axis| View::along(axis, load.window)).collect();
    draw_all(subject.machine(), &views, load, |number, buffers| {
        let axis = axes[number];
        axis.near.into_iter().for_each(|camera| tally.add(camera, buffers.near()));
        axis.far.into_iter().for_each(|camera| tally.add(camera, buffers.far()));
        Ok(())
    })?;
    let shapes = Shapes::of(subject.mesh(), subject.frame());
    let pixel_area = load.window.pixel_size().powi(2);
    let visibility = |(number, (weights, sphere)): (usize, &(CameraWeights, CameraSphere))| {
        let share = |t: usize| match tally.of(t, number) {
            0 => 0.0,
            count => pixel_area * count as f64 / (shapes.areas[t] * sphere.cosine_sum(shapes.normal(t))),
        };
        let front = (0..shapes.areas.len()).into_par_iter().map(share).collect();
        NestedVisibility { cameras: sphere.count(), weights: *weights, front }
    };
    Ok(spheres.iter().enumerate().map(visibility).collect())
}

/// Mean over the surface of the difference between two visibilities: Σ A |a − b| / Σ A.
#[must_use]
pub fn mean_difference(subject: &Subject<'_>, a: &[f64], b: &[f64]) -> f64 {
    surface_mean(subject, |t| (a[t] - b[t]).abs())
}

/// Mean over the surface of a value of each triangle: Σ A x / Σ A.
#[must_use]
pub fn surface_mean(subject: &Subject<'_>, value: impl Fn(usize) -> f64) -> f64 {
    Shapes::of(subject.mesh(), subject.frame()).area_mean(value)
}

/// Pixels of an image for each triangle, at which counting them costs V less than having 1026 cameras does: on a scan of
/// 69,451 triangles 480 pixels along the side (3 a triangle) hid all that area weights gain, 1920 do not.
const PIXELS_PER_TRIANGLE: f64 = 53.0;

/// Pixels along an image's side at which [`nested_visibility`] of so many triangles shows its cameras rather than its
/// pixels: 480 to 1920, in steps of 32. Beyond 69,000 triangles more of them would help, but the time is not worth it.
#[must_use]
pub fn nested_resolution(triangles: usize) -> u32 {
    let pixels = (PIXELS_PER_TRIANGLE * triangles as f64).sqrt();
    (pixels.clamp(480.0, 1920.0).ceil() as u32).next_multiple_of(32)
}

/// Weighted pixels of each triangle's front, one count per pattern.
struct NestedTally<'a> {
    counts: Vec<AtomicU64>,
    spheres: &'a [(CameraWeights, CameraSphere)],
}

impl<'a> NestedTally<'a> {
    fn new(triangles: usize, spheres: &'a [(CameraWeights, CameraSphere)]) -> Self {
        Self { counts: (0..triangles * spheres.len()).map(|_| AtomicU64::new(0)).collect(), spheres }
    }

    fn of(&self, triangle: usize, sphere: usize) -> u64 {
        self.counts[triangle * self.spheres.len() + sphere].load(Ordering::Relaxed)
    }

    /// Adds a camera's image to every pattern that has the camera: from some on, all.
    fn add(&self, camera: u32, image: impl Iterator<Item = Option<Hit>>) {
        let first = self.spheres.partition_point(|(_, sphere)| sphere.count() <= camera as usize);
        let weights: Vec<u64> = self.spheres[first..].iter().map(|(_, sphere)| sphere.weight(camera)).collect();
        for_each_run(image, |hit, pixels| {
            let start = hit.triangle.0 as usize * self.spheres.len() + first;
            let counts = self.counts.get(start..start + weights.len()).filter(|_| hit.side == Side::Front);
            for (count, weight) in counts.into_iter().flatten().zip(&weights) {
                count.fetch_add(pixels * weight, Ordering::Relaxed);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::backend::BackendKind;
    use crate::camera::{Cameras, Window};
    use crate::mesh::shapes;
    use crate::progress::Silent;
    use crate::visibility::{MeasureOptions, measure};

    #[test]
    fn one_sweep_gives_what_each_pattern_gives_alone() {
        let well = shapes::cylindrical_well(1.0, [12, 4]).mesh;
        let subject = Subject::new(&well, BackendKind::Raster).unwrap();
        let window = Window::around_sphere(40);
        let load = Workload { window, memory_limit: None, phase: "visibility", progress: &Silent };
        let nested = nested_visibility(&subject, load).unwrap();
        assert_eq!(nested.iter().map(|n| n.cameras).collect::<Vec<_>>(), NESTED.map(|n| [n; 2]).concat());
        for of_one in nested {
            let cameras = Cameras::octahedral(of_one.cameras);
            let resolution = Some(window.width);
            let options =
                MeasureOptions { cameras, camera_weights: of_one.weights, resolution, ..MeasureOptions::default() };
            let alone = measure(&well, &options, &Silent).unwrap();
            assert_eq!(alone.front(), of_one.front, "{} cameras, {:?}", of_one.cameras, of_one.weights);
        }
    }
}
