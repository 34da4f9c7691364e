use std::collections::BTreeMap;

use glam::{DMat3, DVec3};

use crate::error::{Error, Result};
use crate::geom::OctahedralSphere;

/// How much each camera counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CameraWeights {
    /// By the solid angle it owns.
    #[default]
    Area,
    /// All alike, as Zhang & Turk count.
    Equal,
}

/// Integer weight of a camera that owns the mean solid angle: integer sums do not depend on their order.
const MEAN_WEIGHT: f64 = 4096.0;

/// Finest subdivision offered (4098 cameras).
const MAX_LEVEL: u32 = 5;

/// A pair of opposite cameras.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// Unit vector from the object toward the near camera.
    pub direction: DVec3,
    /// Number of the near camera, at `direction`.
    pub near: u32,
    /// Number of the far camera, at −`direction`.
    pub far: u32,
    /// How much each of the two counts, an integer.
    pub weight: u64,
}

/// Cameras all around the object, closed under d → −d, each with the weight it has in a mean over directions.
#[derive(Debug, Clone)]
pub struct CameraSphere {
    directions: Vec<DVec3>,
    axes: Vec<Axis>,
}

impl CameraSphere {
    /// The octahedral pattern of `count` cameras: 6, 18, 66, 258, 1026 or 4098.
    ///
    /// The six axes come first, then the cameras by level of subdivision, so that the cameras of a coarser pattern are
    /// the first ones of a finer.
    ///
    /// # Errors
    /// [`Error::Option`] for another count.
    pub fn octahedral(count: usize, weights: CameraWeights) -> Result<Self> {
        let level = (0..=MAX_LEVEL).find(|&k| 4_usize.pow(k + 1) + 2 == count).ok_or_else(|| Error::Option {
            name: "--cameras",
            message: format!("{count} is not a number of octahedral cameras; take 6, 18, 66, 258, 1026 or 4098"),
        })?;
        let sphere = OctahedralSphere::new(level);
        let angles = sphere.vertex_solid_angles();
        let mean = 4.0 * std::f64::consts::PI / count as f64;
        let weight_of = |camera: usize| match weights {
            CameraWeights::Area => libm::round(MEAN_WEIGHT * angles[camera] / mean) as u64,
            CameraWeights::Equal => 1,
        };
        let axes = pair_up(&sphere.vertices, weight_of);
        Ok(Self { directions: sphere.vertices, axes })
    }

    /// The same cameras turned by a rotation matrix.
    ///
    /// Octahedral cameras look exactly along the walls of axis-aligned geometry; turn them where that is a special case.
    #[must_use]
    pub fn rotated(&self, rotation: DMat3) -> Self {
        let directions: Vec<DVec3> = self.directions.iter().map(|&d| (rotation * d).normalize()).collect();
        let axes = self.axes.iter().map(|&a| oriented(directions[a.near as usize], a)).collect();
        Self { directions, axes }
    }

    /// Number of cameras.
    #[must_use]
    pub fn count(&self) -> usize {
        self.directions.len()
    }

    /// Unit vectors from the object toward each camera; the index is the camera's number.
    #[must_use]
    pub fn directions(&self) -> &[DVec3] {
        &self.directions
    }

    /// How much a camera counts, an integer.
    ///
    /// # Panics
    /// If there is no such camera.
    #[must_use]
    pub fn weight(&self, camera: u32) -> u64 {
        let mine = self.axes.iter().find(|axis| axis.near == camera || axis.far == camera);
        mine.expect("every camera belongs to an axis").weight
    }

    /// The pairs of opposite cameras, ascending by the smaller number.
    #[must_use]
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Sum of the weights of all cameras.
    #[must_use]
    pub fn total_weight(&self) -> u64 {
        self.axes.iter().map(|a| 2 * a.weight).sum()
    }

    /// Half the weighted sum of |d·n| over all cameras: the denominator of eq. (4.3) for a triangle with unit normal `n`.
    ///
    /// Source: Zhang & Turk 2002, eq. (4.3); the set is closed under d → −d, so half of all is the front-facing part.
    #[must_use]
    pub fn cosine_sum(&self, n: DVec3) -> f64 {
        self.axes.iter().map(|a| a.weight as f64 * a.direction.dot(n).abs()).sum()
    }
}

fn pair_up(directions: &[DVec3], weight_of: impl Fn(usize) -> u64) -> Vec<Axis> {
    // Adding 0.0 turns −0.0 into 0.0, so that exact negatives have exactly equal keys.
    let key = |d: DVec3| (d + 0.0).to_array().map(f64::to_bits);
    let by_direction: BTreeMap<_, _> = directions.iter().enumerate().map(|(i, &d)| (key(d), i)).collect();
    let mut axes = Vec::with_capacity(directions.len() / 2);
    for (i, &direction) in directions.iter().enumerate() {
        let opposite = by_direction[&key(-direction)];
        if i < opposite {
            let pair = Axis { direction, near: i as u32, far: opposite as u32, weight: weight_of(i) };
            axes.push(oriented(direction, pair));
        }
    }
    axes
}

/// The same pair, with the camera whose last non-zero coordinate is positive as the near one.
fn oriented(near_direction: DVec3, pair: Axis) -> Axis {
    let last = [near_direction.z, near_direction.y, near_direction.x].into_iter().find(|&c| c != 0.0);
    if last.is_some_and(|c| c < 0.0) {
        Axis { direction: -near_direction, near: pair.far, far: pair.near, ..pair }
    } else {
        Axis { direction: near_direction, ..pair }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn every_camera_belongs_to_one_axis_and_its_opposite_is_exact() {
        for count in [6, 18, 66, 258, 1026, 4098] {
            let sphere = CameraSphere::octahedral(count, CameraWeights::Area).unwrap();
            let mut seen = vec![0; count];
            for axis in sphere.axes() {
                assert_eq!(sphere.directions()[axis.near as usize], axis.direction);
                assert_eq!(sphere.directions()[axis.far as usize], -axis.direction);
                seen[axis.near as usize] += 1;
                seen[axis.far as usize] += 1;
            }
            assert!(seen.iter().all(|&n| n == 1));
        }
    }

    #[test]
    fn weights_at_258_take_few_values_and_keep_the_mean() {
        let sphere = CameraSphere::octahedral(258, CameraWeights::Area).unwrap();
        let mut weights: Vec<u64> = sphere.axes().iter().map(|a| a.weight).collect();
        approx::assert_relative_eq!(sphere.total_weight() as f64, 258.0 * MEAN_WEIGHT, max_relative = 1e-4);
        weights.sort_unstable();
        weights.dedup();
        assert!(weights.len() <= 10, "{weights:?}");
    }

    #[test]
    fn cosine_sum_is_a_quarter_of_the_weight_within_the_published_spread() {
        let sphere = CameraSphere::octahedral(258, CameraWeights::Equal).unwrap();
        for n in OctahedralSphere::new(4).vertices {
            let share = sphere.cosine_sum(n) / sphere.total_weight() as f64;
            assert!((0.243..=0.2526).contains(&share), "{share}");
        }
    }

    #[test]
    fn other_counts_are_refused_by_name() {
        let error = CameraSphere::octahedral(100, CameraWeights::Equal).unwrap_err();
        assert!(error.to_string().starts_with("--cameras: 100 is not"));
    }
}
