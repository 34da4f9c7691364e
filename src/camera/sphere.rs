use std::collections::BTreeMap;

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// How much each camera counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CameraWeights {
    /// By the solid angle it owns.
    #[default]
    Area,
    /// All alike, as Zhang & Turk count.
    Equal,
}

impl CameraWeights {
    /// The name on the command line and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Area => "area",
            Self::Equal => "equal",
        }
    }
}

/// A line of sight with the cameras at its ends: opposite cameras see along the same lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// Unit vector from the object toward the near camera.
    pub direction: DVec3,
    /// Number of the camera at `direction`, if one looks from there.
    pub near: Option<u32>,
    /// Number of the camera at −`direction`, if one looks from there.
    pub far: Option<u32>,
}

/// The cameras that look at the object, each with the weight it has in a mean over directions.
///
/// They come from a pattern all around, closed under d → −d unless it was listed camera by camera. Restricted to a
/// hemisphere, the others are gone from here but still count as cameras that see nothing: see [`Self::cosine_sum`].
#[derive(Debug, Clone)]
pub struct CameraSphere {
    directions: Vec<DVec3>,
    weights: Vec<u64>,
    axes: Vec<Axis>,
    whole: Pattern,
    hemisphere: Option<DVec3>,
}

/// Every camera of a pattern, those that a hemisphere leaves out included.
#[derive(Debug, Clone)]
struct Pattern {
    cameras: Vec<(DVec3, u64)>,
    lines: Vec<Line>,
    total_weight: u64,
}

/// A line of sight with the weights of the pattern's cameras at its two ends.
#[derive(Debug, Clone, Copy)]
struct Line {
    direction: DVec3,
    near: f64,
    far: f64,
}

/// Cosines up to this are 0: a camera at a right angle to a direction, up to rounding.
const RIGHT_ANGLE: f64 = 1e-9;

/// Least share of the weights that a sum of cosines may have; a pattern all around has about a quarter.
///
/// Only a few listed cameras come near it, for triangles that all of them see edge-on. Dividing the one pixel that
/// rounding may give such a triangle by a sum near 0 would drown the mean over the mesh.
const LEAST_COSINE_SHARE: f64 = 1e-4;

impl CameraSphere {
    /// Cameras at unit vectors, each with its weight.
    pub(super) fn of(cameras: Vec<(DVec3, u64)>) -> Self {
        let (directions, weights): (Vec<DVec3>, Vec<u64>) = cameras.iter().copied().unzip();
        let axes = pair_up(&directions);
        let weight_at = |camera: Option<u32>| camera.map_or(0.0, |v| weights[v as usize] as f64);
        let line = |a: &Axis| Line { direction: a.direction, near: weight_at(a.near), far: weight_at(a.far) };
        let lines = axes.iter().map(line).collect();
        let whole = Pattern { lines, total_weight: weights.iter().sum(), cameras };
        Self { directions, weights, axes, whole, hemisphere: None }
    }

    /// The cameras on the side toward which `hemisphere` points, as if an endless wall stood behind the others.
    ///
    /// Those exactly on the bounding plane count half, since half of the directions that they stand for are on this side:
    /// a wall at right angles to the plane sees half of all it could see. To keep weights whole, all are doubled.
    ///
    /// # Errors
    /// [`Error::Option`] if no camera is left, or if `hemisphere` is no direction.
    pub fn within(&self, hemisphere: DVec3) -> Result<Self> {
        let refused = |message: &str| Error::Option { name: "--hemisphere", message: message.to_owned() };
        let toward =
            hemisphere.try_normalize().ok_or_else(|| refused("0,0,0 is no direction; write +y or three numbers"))?;
        let within = Self::of(self.whole.cameras.iter().map(|&(d, weight)| (d, 2 * weight)).collect()).keep(toward);
        if within.directions.is_empty() { Err(refused("no camera stands on that side")) } else { Ok(within) }
    }

    /// The pattern without the cameras behind the plane; `self` is whole, its weights are even.
    fn keep(self, toward: DVec3) -> Self {
        let seen = |&(d, weight): &(DVec3, u64)| {
            let cosine = d.dot(toward);
            let on_plane = cosine.abs() <= RIGHT_ANGLE;
            (cosine >= -RIGHT_ANGLE).then_some((d, if on_plane { weight / 2 } else { weight }))
        };
        let (directions, weights): (Vec<DVec3>, Vec<u64>) = self.whole.cameras.iter().filter_map(seen).unzip();
        let axes = pair_up(&directions);
        Self { directions, weights, axes, hemisphere: Some(toward), ..self }
    }

    /// The same cameras turned by a rotation matrix, and with them the hemisphere they are restricted to.
    ///
    /// Octahedral cameras look exactly along the walls of axis-aligned geometry; turn them where that is a special case.
    #[must_use]
    pub fn rotated(&self, rotation: DMat3) -> Self {
        let turned = |&(d, weight): &(DVec3, u64)| ((rotation * d).normalize(), weight);
        let whole = Self::of(self.whole.cameras.iter().map(turned).collect());
        match self.hemisphere {
            Some(toward) => whole.keep((rotation * toward).normalize()),
            None => whole,
        }
    }

    /// Number of cameras that look.
    #[must_use]
    pub fn count(&self) -> usize {
        self.directions.len()
    }

    /// Number of cameras that stand behind the hemisphere's plane and see nothing, besides those that look.
    #[must_use]
    pub fn left_out(&self) -> usize {
        self.whole.cameras.len() - self.directions.len()
    }

    /// The unit vector into the hemisphere that the cameras are restricted to.
    #[must_use]
    pub fn hemisphere(&self) -> Option<DVec3> {
        self.hemisphere
    }

    /// Unit vectors from the object toward each camera; the index is the camera's number.
    #[must_use]
    pub fn directions(&self) -> &[DVec3] {
        &self.directions
    }

    /// How much a camera counts, an integer: sums of integers do not depend on their order.
    #[must_use]
    pub fn weight(&self, camera: u32) -> u64 {
        self.weights[camera as usize]
    }

    /// Directions and weights of all cameras of the pattern, those left out included.
    #[must_use]
    pub fn pattern(&self) -> &[(DVec3, u64)] {
        &self.whole.cameras
    }

    /// The lines of sight, ascending by the smaller number of their cameras.
    #[must_use]
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Sum of the weights of all cameras of the pattern, those left out included.
    #[must_use]
    pub fn total_weight(&self) -> u64 {
        self.whole.total_weight
    }

    /// The weighted sum of d·n over the cameras in front of a triangle with unit normal `n`: the denominator of eq. (4.3).
    ///
    /// Cameras that a hemisphere leaves out count in it: they see nothing, but nobody can be seen from there either. The
    /// denominator of the back is that of −`n`, the same number for a pattern closed under d → −d. A sum below 10⁻⁴ of
    /// the weights is raised to that, so that it never is 0.
    ///
    /// Source: Zhang & Turk 2002, eq. (4.3).
    #[must_use]
    pub fn cosine_sum(&self, n: DVec3) -> f64 {
        let term = |line: &Line| {
            let cosine = line.direction.dot(n);
            cosine.abs() * if cosine > 0.0 { line.near } else { line.far }
        };
        let sum: f64 = self.whole.lines.iter().map(term).sum();
        sum.max(LEAST_COSINE_SHARE * self.whole.total_weight as f64)
    }
}

/// Joins each camera with one exactly opposite, where there is one.
fn pair_up(directions: &[DVec3]) -> Vec<Axis> {
    // Adding 0.0 turns −0.0 into 0.0, so that exact negatives have exactly equal keys.
    let key = |d: DVec3| (d + 0.0).to_array().map(f64::to_bits);
    let mut axes: Vec<Axis> = Vec::with_capacity(directions.len().div_ceil(2));
    let mut single: BTreeMap<[u64; 3], Vec<usize>> = BTreeMap::new();
    for (camera, &direction) in (0..).zip(directions) {
        if let Some(axis) = single.get_mut(&key(-direction)).and_then(Vec::pop) {
            axes[axis].far = Some(camera);
        } else {
            single.entry(key(direction)).or_default().push(axes.len());
            axes.push(Axis { direction, near: Some(camera), far: None });
        }
    }
    axes.into_iter().map(oriented).collect()
}

/// The same line, with the camera whose last non-zero coordinate is positive as the near one.
fn oriented(axis: Axis) -> Axis {
    let d = axis.direction;
    let last = [d.z, d.y, d.x].into_iter().find(|&c| c != 0.0);
    if last.is_some_and(|c| c < 0.0) { Axis { direction: -d, near: axis.far, far: axis.near } } else { axis }
}

#[cfg(test)]
mod tests;
