//! How often depth rescue is wrong: a sample of the pairs that it calls seen, asked again by rays.

use std::collections::BinaryHeap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use glam::DVec3;

use crate::backend::{BackendKind, Ray};
use crate::camera::CameraSphere;
use crate::error::Result;
use crate::mesh::TriangleId;
use crate::visibility::pieces::Pieces;
use crate::visibility::{RescueLeaks, Subject, rays};

/// Pairs that are asked about: a share p of them is known to √(p (1 − p) / 4096), 0.8 % at most.
const SAMPLE: usize = 4096;

/// Points of a piece that are asked about, by weight of the corners: its centroid, and nine tenths of the way from there to
/// each corner, since corners are what rescue goes by. A piece of which none is seen leaks.
const POINTS: [[f64; 3]; 4] = {
    const NEAR: f64 = 14.0 / 15.0;
    const FAR: f64 = 1.0 / 30.0;
    [[1.0 / 3.0; 3], [NEAR, FAR, FAR], [FAR, NEAR, FAR], [FAR, FAR, NEAR]]
};

/// A random choice of the pairs of a piece and a camera that were rescued, the same in whatever order they come.
pub(super) struct RescuedSample {
    seed: u64,
    /// Pairs draw lots; these have the smallest, the greatest of them first.
    chosen: Mutex<BinaryHeap<(u64, Pair)>>,
    /// No pair with a greater lot is chosen any more.
    greatest: AtomicU64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Pair {
    pub piece: u32,
    pub camera: u32,
}

impl RescuedSample {
    pub fn new(seed: u64) -> Self {
        Self { seed, chosen: Mutex::new(BinaryHeap::new()), greatest: AtomicU64::new(u64::MAX) }
    }

    /// Takes part in the choice.
    pub fn offer(&self, pair: Pair) {
        let lot = self.lot(pair);
        if lot > self.greatest.load(Ordering::Relaxed) {
            return;
        }
        let mut chosen = self.chosen.lock().unwrap_or_else(PoisonError::into_inner);
        chosen.push((lot, pair));
        if chosen.len() > SAMPLE {
            chosen.pop();
            chosen.peek().into_iter().for_each(|&(lot, _)| self.greatest.store(lot, Ordering::Relaxed));
        }
    }

    /// The finaliser of SplitMix64: different for all pairs.
    fn lot(&self, pair: Pair) -> u64 {
        let z = (u64::from(pair.piece) << 32 | u64::from(pair.camera)) ^ self.seed.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// The chosen ones, in an order that depends on them alone.
    fn into_pairs(self) -> Vec<Pair> {
        let chosen = self.chosen.into_inner().unwrap_or_else(PoisonError::into_inner);
        chosen.into_sorted_vec().into_iter().map(|(_, pair)| pair).collect()
    }

    /// Rays from the points of each chosen piece to its camera, those of one pair together.
    pub fn into_rays(self, pieces: &Pieces<'_>, subject: &Subject<'_>, cameras: &CameraSphere) -> Vec<Ray> {
        let of_pair = |Pair { piece, camera }| {
            let piece = TriangleId(piece);
            let narrowed = |p: DVec3| subject.frame().to_unit(p).as_vec3().as_dvec3();
            let [a, b, c] = pieces.cut.mesh().corners(piece).map(narrowed);
            let (toward, own) = (cameras.directions()[camera as usize], pieces.cut.parent(piece).0);
            POINTS.map(|[u, v, w]| rays::ray((u * a + v * b + w * c).as_vec3().to_array(), toward, own))
        };
        self.into_pairs().into_iter().flat_map(of_pair).collect()
    }
}

/// Asks the rays of [`RescuedSample::into_rays`]: of the subject's own machine, or of Embree where that draws only; `None`
/// where it is not there.
///
/// # Errors
/// As [`Subject::among`], and what the machine says.
pub(super) fn leaks(rays: &[Ray], subject: &Subject<'_>) -> Result<Option<RescueLeaks>> {
    let mut blocked = vec![false; rays.len()];
    if subject.machine().kind().casts_rays() {
        subject.machine().occlusion()?.blocked(rays, &mut blocked)?;
    } else if rays.is_empty() {
        // Nothing to lay the mesh out for.
    } else if BackendKind::Embree.check().is_ok() {
        let casting = Subject::among(subject.mesh(), subject.occluders(), BackendKind::Embree)?;
        casting.machine().occlusion()?.blocked(rays, &mut blocked)?;
    } else {
        return Ok(None);
    }
    let leaking = blocked.chunks(POINTS.len()).filter(|points| points.iter().all(|&blocked| blocked)).count();
    Ok(Some(RescueLeaks { sampled: (rays.len() / POINTS.len()) as u64, leaking: leaking as u64 }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_choice_does_not_depend_on_the_order_and_favours_nobody() {
        let pairs = || (0..300_000).map(|i| Pair { piece: i / 100, camera: i % 100 });
        let chosen = |pairs: &mut dyn Iterator<Item = Pair>, seed| {
            let sample = RescuedSample::new(seed);
            pairs.for_each(|pair| sample.offer(pair));
            sample.into_pairs()
        };
        let forward = chosen(&mut pairs(), 1);
        let backward: Vec<Pair> = pairs().collect();
        assert_eq!(forward, chosen(&mut backward.into_iter().rev(), 1));
        assert_ne!(forward, chosen(&mut pairs(), 2));
        assert_eq!(forward.len(), SAMPLE);
        // Half of them from the first half: 2048, give or take five standard deviations of √4096 / 2.
        let early = forward.iter().filter(|pair| pair.piece < 1500).count();
        assert!(early.abs_diff(2048) < 160, "{early}");
        assert_eq!(chosen(&mut pairs().take(7), 1).len(), 7);
    }
}
