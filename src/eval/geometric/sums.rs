//! Distances of many points, summed so that the result is the same for any number of threads.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use super::{Distances, PHASE, SeenError, Surface};
use crate::error::Result;
use crate::eval::nearest::NearestTriangles;
use crate::eval::sample::SurfaceSamples;
use crate::progress::Progress;

/// Samples that one thread takes at a time. Part of the result's last bits, since sums are made chunk by chunk.
const CHUNK: u64 = 4096;

/// Tells the caller how far the work is, and asks whether to go on.
pub(super) struct Counter<'a> {
    pub(super) progress: &'a dyn Progress,
    pub(super) done: AtomicU64,
    pub(super) total: u64,
}

impl Counter<'_> {
    fn add(&self, count: u64) -> Result<()> {
        let done = self.done.fetch_add(count, Ordering::Relaxed) + count;
        self.progress.report(PHASE, done, self.total);
        self.progress.check()
    }
}

/// Distances from the vertices of a surface and from points on it to another.
pub(super) fn one_sided(
    (from, points): (&Surface, &SurfaceSamples),
    to: &NearestTriangles,
    counter: &Counter,
) -> Result<OneSided> {
    counter.progress.check()?;
    let vertices = |chunk: Range<u64>| from.vertices[chunk.start as usize..chunk.end as usize].iter().copied();
    let at_vertices = sum_over(from.vertices.len() as u64, counter, |chunk| Sums::over(to, vertices(chunk)))?;
    let on_area = sum_over(points.count(), counter, |chunk| {
        Sums::over(to, points.points(chunk).map(|(triangle, point)| (point, from.visibility_of(triangle))))
    })?;
    Ok(OneSided { at_vertices, on_area })
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

/// Sums over the points of one surface.
pub(super) struct OneSided {
    at_vertices: Sums,
    on_area: Sums,
}

impl OneSided {
    pub(super) fn distances(&self) -> Distances {
        let all = |sums: Sums| sums.visible.plus(sums.hidden);
        Tally::distances(all(self.at_vertices), all(self.on_area)).unwrap_or_default()
    }

    pub(super) fn seen(&self) -> SeenError {
        let part = |of: fn(&Sums) -> Tally| Tally::distances(of(&self.at_vertices), of(&self.on_area));
        let Sums { visibility, weighted_squares, .. } = self.on_area;
        SeenError {
            visible: part(|sums| sums.visible),
            hidden: part(|sums| sums.hidden),
            weighted_rms: (visibility > 0.0).then(|| (weighted_squares / visibility).sqrt()),
        }
    }
}

/// Sums over points, apart by whether their surface is visible.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    /// Where V > 0.
    visible: Tally,
    hidden: Tally,
    visibility: f64,
    weighted_squares: f64,
}

/// Sums from which mean, RMS and maximum follow.
#[derive(Debug, Clone, Copy, Default)]
struct Tally {
    count: u64,
    distance: f64,
    distance_squared: f64,
    max: f64,
}

impl Sums {
    /// Over neighbouring points: the search for each begins at the triangle nearest to the one before.
    fn over(tree: &NearestTriangles, points: impl Iterator<Item = (DVec3, f64)>) -> Self {
        let mut slot = 0;
        points.fold(Self::default(), |mut sums, (point, visibility)| {
            let nearest = tree.nearest(point, slot);
            slot = nearest.slot;
            let part = if visibility > 0.0 { &mut sums.visible } else { &mut sums.hidden };
            *part = part.plus(Tally::of(nearest.distance_squared));
            sums.visibility += visibility;
            sums.weighted_squares += visibility * nearest.distance_squared;
            sums
        })
    }

    fn plus(self, other: Self) -> Self {
        Self {
            visible: self.visible.plus(other.visible),
            hidden: self.hidden.plus(other.hidden),
            visibility: self.visibility + other.visibility,
            weighted_squares: self.weighted_squares + other.weighted_squares,
        }
    }
}

impl Tally {
    fn of(distance_squared: f64) -> Self {
        let distance = distance_squared.sqrt();
        Self { count: 1, distance, distance_squared, max: distance }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            count: self.count + other.count,
            distance: self.distance + other.distance,
            distance_squared: self.distance_squared + other.distance_squared,
            max: self.max.max(other.max),
        }
    }

    /// Mean and RMS over the area, or over the vertices of surface without any; the maximum of both.
    fn distances(at_vertices: Self, on_area: Self) -> Option<Distances> {
        let mean_of = if on_area.count > 0 { on_area } else { at_vertices };
        let (count, max) = (mean_of.count as f64, at_vertices.max.max(on_area.max));
        let rms = (mean_of.distance_squared / count).sqrt();
        (mean_of.count > 0).then(|| Distances { mean: mean_of.distance / count, rms, max })
    }
}
