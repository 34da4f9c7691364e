use std::f64::consts::TAU;

use glam::{DMat3, DVec3};
use sobol_burley::sample_4d;

use crate::error::{Error, Result};
use crate::visibility::estimate::{Estimate, Looking};
use crate::visibility::rays::{Batch, Caster, point_inside, ray, stream_seed};
use crate::visibility::{Details, MOST_SAMPLES, RayOptions, SamplingEnd, Shapes, Sides, StandardError, Subject};

/// Independent scrambles of the sequence; their spread tells the error.
const SCRAMBLES: usize = 8;

/// Casts rays from random points of each triangle in directions spread by the cosine over its half-sphere:
/// [`crate::visibility::Estimator::Hemisphere`].
///
/// V(t) is the share of the rays that are free, an unbiased estimate of Zhang & Turk 2002, eq. (3.1), averaged over the
/// triangle; no cameras are asked. Points and directions come from an Owen-scrambled Sobol sequence in four dimensions
/// (Burley 2020), another one for each triangle and each of eight scrambles. The back's rays are the mirror images of
/// the front's; [`Sides::One`] does not pay for them and leaves the back at 0.
///
/// # Errors
/// [`Error::Option`] for a backend that casts no rays and for a diagram, what the backend says, [`Error::Cancelled`].
pub(super) fn estimate(subject: &Subject<'_>, shapes: &Shapes, looking: &Looking<'_>) -> Result<Estimate> {
    if looking.diagram.is_some() {
        let message = "hemisphere looks in random directions, and a diagram needs cameras; use coverage or surface";
        return Err(Error::Option { name: "--estimator", message: message.to_owned() });
    }
    let options = &looking.options.rays;
    let caster = Caster::new(subject, shapes, looking.cameras)?;
    let hemisphere = Hemisphere { caster: &caster, shapes, looking };
    let mut tallies = vec![Tally::default(); caster.order().len()];
    let mut samples = 0;
    let (errors, end) = loop {
        // The first 2^k points of a Sobol sequence are the evenest, so that rays are doubled.
        let more = if samples == 0 { options.samples.next_power_of_two() } else { samples };
        hemisphere.cast_round(&mut tallies, samples, more)?;
        samples += more;
        let errors = Errors::of(&hemisphere, &tallies, samples);
        if let Some(end) = errors.end(options, samples) {
            break (errors, end);
        }
    };
    let front = caster.in_index_order(&tallies, |tally| tally.visibility(samples));
    let back = caster.in_index_order(&tallies, |tally| f64::from(tally.back) / f64::from(samples));
    let per_triangle = caster.in_index_order(&tallies, |tally| tally.standard_error(samples));
    let standard_error = StandardError { per_triangle, of_mesh: errors.of_mesh, p99: errors.p99, samples, end };
    let details = Details { rays: caster.rays(), standard_error: Some(standard_error), ..Details::default() };
    Ok(Estimate { front, back, pooled_below: 0.0, resolution: 0, details })
}

struct Hemisphere<'a> {
    caster: &'a Caster<'a>,
    shapes: &'a Shapes,
    looking: &'a Looking<'a>,
}

impl Hemisphere<'_> {
    /// Casts `more` rays from each side of each triangle, which had `before`.
    fn cast_round(&self, tallies: &mut [Tally], before: u32, more: u32) -> Result<()> {
        self.caster.fill(tallies, 1, self.looking.progress, |batch, triangles, tallies| {
            self.cast(batch, triangles[0], &mut tallies[0], [before, before + more])
        })
    }

    fn cast(&self, batch: &mut Batch, triangle: u32, tally: &mut Tally, [from, to]: [u32; 2]) -> Result<()> {
        let scrambles = SCRAMBLES as u32;
        let per_scramble = from / scrambles..to / scrambles;
        let both = self.looking.options.sides != Sides::One;
        let corners = self.caster.corners(triangle);
        let axes = frame_about(self.caster.normal(triangle));
        batch.rays.clear();
        for scramble in 0..scrambles {
            let seed = stream_seed(self.looking.options.rays.seed, triangle, scramble);
            for i in per_scramble.clone() {
                let [u, v, xi1, xi2] = sample_4d(i, 0, seed);
                let origin = point_inside(corners, u, v);
                let local = cosine_direction(xi1, xi2);
                batch.rays.push(ray(origin, axes * local, triangle));
                if both {
                    batch.rays.push(ray(origin, axes * (local * DVec3::new(1.0, 1.0, -1.0)), triangle));
                }
            }
        }
        let sides = 1 + usize::from(both);
        let blocked = self.caster.cast(batch)?;
        for (scramble, blocked) in blocked.chunks_exact(sides * per_scramble.len()).enumerate() {
            let free = |side: usize| blocked.iter().skip(side).step_by(sides).filter(|&&blocked| !blocked).count();
            tally.front[scramble] += free(0) as u16;
            tally.back += if both { free(1) as u32 } else { 0 };
        }
        Ok(())
    }
}

/// The free rays of one triangle.
#[derive(Debug, Clone, Copy, Default)]
struct Tally {
    /// Of the front, by scramble; at most [`MOST_SAMPLES`] / [`SCRAMBLES`] each.
    front: [u16; SCRAMBLES],
    back: u32,
}

impl Tally {
    fn free(&self) -> u64 {
        self.front.iter().map(|&free| u64::from(free)).sum()
    }

    /// V of the front, out of `samples` rays.
    fn visibility(&self, samples: u32) -> f64 {
        self.free() as f64 / f64::from(samples)
    }

    /// Variance of [`Tally::visibility`], from the spread of the scrambles: unbiased, and 0 where all are alike.
    fn variance(&self, samples: u32) -> f64 {
        let scrambles = SCRAMBLES as u64;
        let squares: u64 = self.front.iter().map(|&free| u64::from(free).pow(2)).sum();
        // S Σ h² − (Σ h)² is S (S − 1) times the variance of one scramble's count, in integers.
        let spread = (scrambles * squares - self.free().pow(2)) as f64;
        spread / (scrambles - 1) as f64 / f64::from(samples).powi(2)
    }

    /// Standard error of [`Tally::visibility`]. Scrambles that are all alike, as when no ray or every ray is free, do not
    /// tell it; then it is the one-sided 95 % bound for a share that never showed, 3 / samples.
    fn standard_error(&self, samples: u32) -> f64 {
        let variance = self.variance(samples);
        if variance > 0.0 { variance.sqrt() } else { 3.0 / f64::from(samples) }
    }
}

/// How exact a round's numbers are.
struct Errors {
    of_mesh: f64,
    p99: f64,
}

impl Errors {
    fn of(hemisphere: &Hemisphere<'_>, tallies: &[Tally], samples: u32) -> Self {
        let mut errors: Vec<f64> = tallies.iter().map(|tally| tally.standard_error(samples)).collect();
        errors.sort_unstable_by(f64::total_cmp);
        let p99 = errors[(errors.len() * 99).div_ceil(100) - 1];
        Self { of_mesh: Self::of_mean(hemisphere, tallies, samples), p99 }
    }

    /// Of the mean over the surface; triangles have streams of their own, so that variances add up. A triangle whose rays
    /// are all alike counts with its bound: a small hole in the sky of a large one is easily missed.
    fn of_mean(hemisphere: &Hemisphere<'_>, tallies: &[Tally], samples: u32) -> f64 {
        let areas = || hemisphere.caster.order().iter().map(|&t| hemisphere.shapes.areas[t as usize]);
        let total: f64 = areas().sum();
        let square = |(area, tally): (f64, &Tally)| (area * tally.standard_error(samples)).powi(2);
        areas().zip(tallies).map(square).sum::<f64>().sqrt() / total
    }

    /// Why to stop here; `None` to go on.
    fn end(&self, options: &RayOptions, samples: u32) -> Option<SamplingEnd> {
        let targets = [(options.target_error, self.of_mesh), (options.target_error_p99, self.p99)];
        let reached = targets.iter().all(|&(target, error)| target.is_none_or(|target| error <= target));
        match reached {
            true if targets.iter().all(|(target, _)| target.is_none()) => Some(SamplingEnd::AsAsked),
            true => Some(SamplingEnd::TargetReached),
            false => (samples >= MOST_SAMPLES).then_some(SamplingEnd::MostSamples),
        }
    }
}

/// A right-handed basis whose third axis is the normal.
fn frame_about(normal: DVec3) -> DMat3 {
    let (first, second) = normal.any_orthonormal_pair();
    DMat3::from_cols(first, second, normal)
}

/// The direction of the half-sphere about +z that (ξ₁, ξ₂) of the unit square is mapped to, by the cosine.
fn cosine_direction(xi1: f32, xi2: f32) -> DVec3 {
    let xi1 = f64::from(xi1);
    let (sin, cos) = libm::sincos(TAU * f64::from(xi2));
    DVec3::new(xi1.sqrt() * cos, xi1.sqrt() * sin, (1.0 - xi1).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stream_of_samples_is_the_one_that_results_were_made_with() {
        assert_eq!(sample_4d(0, 0, stream_seed(0, 0, 0)), [0.262_153_63, 0.536_894_3, 0.715_602_3, 0.816_672_56]);
    }

    /// Means of z, z² and x² under the cosine: 2/3, 1/2 and 1/4.
    #[test]
    fn directions_are_unit_vectors_spread_by_the_cosine() {
        /// 65,536 points of a scrambled Sobol sequence.
        const EVEN: f64 = 1e-4;
        let all: Vec<DVec3> = (0..1 << 16)
            .map(|i| {
                let [_, _, xi1, xi2] = sample_4d(i, 0, 9);
                cosine_direction(xi1, xi2)
            })
            .collect();
        assert!(all.iter().all(|d| (d.length() - 1.0).abs() < 1e-12 && d.z > 0.0));
        let mean = |f: fn(&DVec3) -> f64| all.iter().map(f).sum::<f64>() / all.len() as f64;
        approx::assert_abs_diff_eq!(mean(|d| d.z), 2.0 / 3.0, epsilon = EVEN);
        approx::assert_abs_diff_eq!(mean(|d| d.z * d.z), 0.5, epsilon = EVEN);
        approx::assert_abs_diff_eq!(mean(|d| d.x * d.x), 0.25, epsilon = EVEN);
        approx::assert_abs_diff_eq!(mean(|d| d.x * d.y), 0.0, epsilon = EVEN);
    }

    #[test]
    fn spread_of_the_scrambles_is_the_standard_error_of_their_mean() {
        // Shares 0.25 and 0.75 by turns: deviation 0.25 · √(8/7), over √8.
        let tally = Tally { front: [2, 6, 2, 6, 2, 6, 2, 6], back: 0 };
        assert_eq!(tally.visibility(64), 0.5);
        approx::assert_relative_eq!(tally.standard_error(64), 0.25 / 7.0_f64.sqrt(), max_relative = 1e-12);
        for alike in [0, 5, 8] {
            assert_eq!(Tally { front: [alike; 8], back: 0 }.standard_error(64), 3.0 / 64.0);
        }
    }
}
