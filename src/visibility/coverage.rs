use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use crate::backend::{ItemBuffers, Workload, draw_all};
use crate::camera::{CameraSphere, View, Window};
use crate::error::Result;
use crate::raster::{Hit, Side};
use crate::visibility::estimate::{Estimate, Looking};
use crate::visibility::{Details, DiagramRecorder, Shapes, Subject};

/// Counts pixels: [`crate::visibility::Estimator::Coverage`].
///
/// # Errors
/// As [`CoverageCounts::of`].
pub(super) fn estimate(subject: &Subject<'_>, shapes: &Shapes, looking: &Looking<'_>) -> Result<Estimate> {
    let triangles = subject.mesh().triangle_count();
    let window = Window::around_sphere(looking.options.resolution_for(triangles));
    let load = Workload {
        window,
        memory_limit: looking.options.memory_limit,
        phase: "visibility",
        progress: looking.progress,
    };
    let counts = CoverageCounts::of(subject.machine(), triangles, looking.cameras, load, looking.diagram)?;
    // Among occluders, to be hidden altogether is a result.
    if counts.covered() == 0 && subject.occluders().is_empty() {
        return Err(subject.nothing_to_see());
    }
    let (front, back) = counts.visibilities(shapes, looking.cameras);
    debug_assert!(counts.identity_holds(&front, &back, shapes, looking.cameras));
    let pooled_below = counts.smallest_area(looking.cameras);
    Ok(Estimate { front, back, pooled_below, resolution: window.width, details: Details::default() })
}

/// In how many pixels each triangle was seen, over all cameras, weighted by camera.
///
/// Integers, so that the sums do not depend on the order of cameras and threads.
#[derive(Debug, Clone)]
pub struct CoverageCounts {
    /// Two per triangle: seen from the front, seen from the back.
    counts: Vec<u64>,
    covered: u64,
    window: Window,
}

impl CoverageCounts {
    /// Draws every camera's view and counts; writes down in `diagram` who sees what.
    ///
    /// Hits of triangles from number `triangles` on are occluders: they hide, and are counted nowhere.
    ///
    /// # Errors
    /// As [`draw_all`].
    pub fn of<B: ItemBuffers>(
        backend: &B,
        triangles: usize,
        cameras: &CameraSphere,
        load: Workload<'_>,
        diagram: Option<&DiagramRecorder>,
    ) -> Result<Self> {
        let tally = Tally::new(triangles, cameras, diagram);
        let views: Vec<View> = cameras.axes().iter().map(|axis| View::along(axis, load.window)).collect();
        draw_all(backend, &views, load, |number, buffers| {
            let axis = cameras.axes()[number];
            let covered = buffers.covered();
            axis.near.into_iter().for_each(|camera| tally.add(camera, buffers.near(), covered));
            axis.far.into_iter().for_each(|camera| tally.add(camera, buffers.far(), covered));
            Ok(())
        })?;
        let counts = tally.counts.into_iter().map(AtomicU64::into_inner).collect();
        Ok(Self { counts, covered: tally.covered.into_inner(), window: load.window })
    }

    /// Weighted pixels in which the cameras saw a side of a triangle.
    #[must_use]
    pub fn seen(&self, triangle: usize, side: Side) -> u64 {
        self.counts[slot(triangle, side)]
    }

    /// Weighted pixels in which the cameras saw the mesh.
    #[must_use]
    pub fn covered(&self) -> u64 {
        self.covered
    }

    /// The window that all cameras looked through.
    #[must_use]
    pub fn window(&self) -> Window {
        self.window
    }

    /// V of the front and of the back of each triangle, as counted.
    ///
    /// V(t) = s² Σ_v a_v c(t,v) / (A_t Σ_v a_v (d_v·n_t)⁺): Zhang & Turk 2002, eq. (4.3) with F(t,v) replaced by the
    /// share of the triangle's image that is seen, c(t,v) s² / (A_t d_v·n_t). A degenerate triangle gets 0.
    pub(super) fn visibilities(&self, shapes: &Shapes, cameras: &CameraSphere) -> (Vec<f64>, Vec<f64>) {
        let pixel_area = self.window.pixel_size() * self.window.pixel_size();
        let sides = |t: usize| {
            let area = shapes.areas[t];
            let (front, back) = (self.seen(t, Side::Front), self.seen(t, Side::Back));
            // Sums of cosines are dear, and most triangles show one side.
            let share = |count: u64, n: DVec3| match count {
                0 => 0.0,
                _ => pixel_area * count as f64 / (area * cameras.cosine_sum(n)),
            };
            (share(front, shapes.normal(t)), share(back, -shapes.normal(t)))
        };
        (0..shapes.areas.len()).into_par_iter().map(sides).unzip()
    }

    /// The book-keeping identity: Σ A_t (V⁺ D(n_t) + V⁻ D(−n_t)) is the area that the cameras saw covered, to 1e-9.
    pub(super) fn identity_holds(&self, front: &[f64], back: &[f64], shapes: &Shapes, cameras: &CameraSphere) -> bool {
        let term = |t: usize| {
            let [before, behind] = [shapes.normal(t), -shapes.normal(t)].map(|n| cameras.cosine_sum(n));
            shapes.areas[t] * (front[t] * before + back[t] * behind)
        };
        let from_triangles: f64 = (0..front.len()).map(term).sum();
        let from_pixels = self.window.pixel_size().powi(2) * self.covered as f64;
        (from_triangles - from_pixels).abs() <= 1e-9 * from_pixels
    }

    /// The smallest area whose mean count, were it fully visible, reaches 16; smaller triangles are pooled.
    ///
    /// A triangle of area A collects about N A / (4 s²) pixels if all N cameras of the pattern see it.
    pub(super) fn smallest_area(&self, cameras: &CameraSphere) -> f64 {
        const MIN_COUNT: f64 = 16.0;
        4.0 * MIN_COUNT * self.window.pixel_size().powi(2) / (cameras.count() + cameras.left_out()) as f64
    }
}

/// Counts that many threads add to.
struct Tally<'a> {
    counts: Vec<AtomicU64>,
    covered: AtomicU64,
    cameras: &'a CameraSphere,
    diagram: Option<&'a DiagramRecorder>,
}

impl<'a> Tally<'a> {
    fn new(triangles: usize, cameras: &'a CameraSphere, diagram: Option<&'a DiagramRecorder>) -> Self {
        let counts = (0..2 * triangles).map(|_| AtomicU64::new(0)).collect();
        Self { counts, covered: AtomicU64::new(0), cameras, diagram }
    }

    /// Adds the pixels of a camera's image, of which `covered` are not empty.
    fn add(&self, camera: u32, image: impl Iterator<Item = Option<Hit>>, covered: u64) {
        let weight = self.cameras.weight(camera);
        let mut of_occluders = 0;
        for_each_run(image, |hit, pixels| {
            // Occluders have the numbers behind the mesh's own.
            let Some(count) = self.counts.get(slot(hit.triangle.0 as usize, hit.side)) else {
                of_occluders += pixels;
                return;
            };
            count.fetch_add(pixels * weight, Ordering::Relaxed);
            if let Some(diagram) = self.diagram {
                diagram.record(hit.triangle, camera as usize);
            }
        });
        self.covered.fetch_add(weight * (covered - of_occluders), Ordering::Relaxed);
    }
}

fn slot(triangle: usize, side: Side) -> usize {
    2 * triangle + usize::from(side == Side::Back)
}

/// Hands over each hit with its number of pixels; neighbouring pixels of one triangle come together.
pub(super) fn for_each_run(pixels: impl Iterator<Item = Option<Hit>>, mut take: impl FnMut(Hit, u64)) {
    let (mut current, mut run) = (None, 0);
    for hit in pixels {
        if hit != current {
            current.into_iter().for_each(|hit| take(hit, run));
            (current, run) = (hit, 0);
        }
        run += 1;
    }
    current.into_iter().for_each(|hit| take(hit, run));
}
