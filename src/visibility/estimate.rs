use rayon::prelude::*;

use crate::camera::CameraSphere;
use crate::error::Result;
use crate::progress::Progress;
use crate::visibility::pool::Pools;
use crate::visibility::{
    Details, DiagramRecorder, Estimator, MeasureOptions, Shapes, Subject, Visibility, coverage, hemisphere,
    item_buffer, surface,
};

/// Who looks how, for every estimator alike.
pub(super) struct Looking<'a> {
    pub cameras: &'a CameraSphere,
    pub options: &'a MeasureOptions,
    /// Where to write down which camera sees which triangle.
    pub diagram: Option<&'a DiagramRecorder>,
    pub progress: &'a dyn Progress,
}

/// What an estimator finds: V of each triangle's front and back as counted, neither clamped nor pooled.
pub(super) struct Estimate {
    pub front: Vec<f64>,
    pub back: Vec<f64>,
    /// Triangles of a smaller area (unit-sphere units) are too small for their own count; 0 where none are.
    pub pooled_below: f64,
    /// Pixels along an image's side; 0 where nothing was drawn.
    pub resolution: u32,
    pub details: Details,
}

/// Runs the estimator that the options name and makes its counts a [`Visibility`].
///
/// # Errors
/// As [`super::measure`].
pub(super) fn estimate(subject: &Subject<'_>, looking: &Looking<'_>) -> Result<Visibility> {
    let shapes = Shapes::of(subject.mesh(), subject.frame());
    if shapes.areas.iter().all(|&area| area == 0.0) {
        return Err(subject.nothing_to_see());
    }
    let found = match looking.options.estimator {
        Estimator::Coverage => coverage::estimate(subject, &shapes, looking)?,
        Estimator::Surface => surface::estimate(subject, &shapes, looking)?,
        Estimator::Hemisphere => hemisphere::estimate(subject, &shapes, looking)?,
        Estimator::ItemBuffer => item_buffer::estimate(subject, &shapes, looking)?,
    };
    finish(subject, &shapes, found, looking)
}

/// Pools, clamps and averages.
fn finish(subject: &Subject<'_>, shapes: &Shapes, found: Estimate, looking: &Looking<'_>) -> Result<Visibility> {
    let Estimate { front, back, pooled_below, resolution, details } = found;
    let sides = looking.options.sides;
    let pools = Pools::new(subject.mesh(), shapes, pooled_below);
    let value_and_seen = |t: usize| {
        // Far too small triangles need large neighbourhoods; someone may not want to wait for them.
        let [front, back] = if looking.progress.is_cancelled() { [0.0; 2] } else { pools.at(t, [&front, &back]) };
        (sides.combine(front, back).clamp(0.0, 1.0), front > 0.0 || back > 0.0)
    };
    let (per_triangle, seen) = (0..front.len()).into_par_iter().map(value_and_seen).unzip();
    looking.progress.check()?;
    let raw_sides = |t: usize| sides.combine(front[t], back[t]);
    Ok(Visibility {
        of_mesh: shapes.area_mean(|t| front[t]),
        of_mesh_sides: shapes.area_mean(raw_sides),
        per_triangle,
        seen,
        resolution,
        cameras: if looking.options.estimator == Estimator::Hemisphere { 0 } else { looking.cameras.count() },
        front,
        back,
        details,
    })
}
