//! Visibility in the plane: which camera on a circle around an outline sees which point of it.
//!
//! Source: Zhang & Turk 2002, figure 1: the picture that explains what is measured on meshes.

mod harbour;

#[cfg(test)]
mod tests;

use std::f64::consts::TAU;

use glam::DVec2;
use rayon::prelude::*;
use robust::{Coord, orient2d};

use crate::error::{Error, Result};

/// A closed outline of straight segments around something solid, counter-clockwise: outside lies to the right.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    corners: Vec<DVec2>,
    /// Length of the boundary from the first corner to each of them, and all the way round.
    lengths: Vec<f64>,
}

/// Least turn of the boundary at a corner that has a name; a round part turns by less from segment to segment.
const SHARP_RAD: f64 = 0.35;

/// Least cosine between a camera's direction and the normal that counts as in front, as on meshes.
const IN_FRONT: f64 = 1e-9;

impl Outline {
    /// The outline through these corners, and from the last back to the first.
    ///
    /// It should not cross itself; this is not checked.
    ///
    /// # Errors
    /// [`Error::Option`] for fewer than three corners, corners that are not finite or lie on the one before, and where the
    /// corners do not run counter-clockwise.
    pub fn new(corners: Vec<DVec2>) -> Result<Self> {
        let refused = |message: String| Err(Error::Option { name: "outline", message });
        if corners.len() < 3 || corners.iter().any(|c| !c.is_finite()) {
            return refused(format!("{} corners; an outline has three or more, all finite", corners.len()));
        }
        let next = |i: usize| corners[(i + 1) % corners.len()];
        if let Some(i) = (0..corners.len()).find(|&i| corners[i] == next(i)) {
            return refused(format!("corner {i} and the next are the same point; leave one out"));
        }
        let double_area: f64 =
            (0..corners.len()).map(|i| (corners[i] - corners[0]).perp_dot(next(i) - corners[0])).sum();
        if double_area <= 0.0 {
            return refused("the corners run clockwise or around nothing; give them counter-clockwise".to_owned());
        }
        let mut lengths = vec![0.0];
        (0..corners.len()).for_each(|i| lengths.push(lengths[i] + (next(i) - corners[i]).length()));
        Ok(Self { corners, lengths })
    }

    /// An outline with a bay behind a narrow mouth, a step, a notch and a round part: what the figure needs.
    #[must_use]
    pub fn harbour() -> Self {
        Self::new(harbour::corners()).expect("its corners run counter-clockwise")
    }

    /// Its corners, counter-clockwise.
    #[must_use]
    pub fn corners(&self) -> &[DVec2] {
        &self.corners
    }

    /// Length of the boundary.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.lengths[self.corners.len()]
    }

    /// Corners where the boundary turns by 20° or more: their numbers, in order.
    #[must_use]
    pub fn sharp_corners(&self) -> Vec<usize> {
        let count = self.corners.len();
        let turn = |i: usize| {
            let (before, after) = (self.along((i + count - 1) % count), self.along(i));
            libm::atan2(before.perp_dot(after), before.dot(after)).abs()
        };
        (0..count).filter(|&i| turn(i) >= SHARP_RAD).collect()
    }

    /// Length of the boundary from the first corner to corner `corner`.
    #[must_use]
    pub fn length_to(&self, corner: usize) -> f64 {
        self.lengths[corner]
    }

    /// First and last corner of a segment; the last segment closes the outline.
    #[must_use]
    pub fn segment(&self, i: usize) -> [DVec2; 2] {
        [self.corners[i], self.corners[(i + 1) % self.corners.len()]]
    }

    /// Outward unit normal of a segment.
    #[must_use]
    pub fn normal(&self, i: usize) -> DVec2 {
        -self.along(i).perp()
    }

    /// How squarely each camera looks at the point of the boundary `at` from the first corner: the cosine of its direction
    /// and the normal, 0 for those that do not see it.
    ///
    /// Camera k of `cameras` stands in direction 2πk / `cameras` from the first axis, infinitely far away.
    #[must_use]
    pub fn seen_from(&self, at: f64, cameras: usize) -> Vec<f64> {
        let last = self.corners.len() - 1;
        let own = self.lengths[1..=last].partition_point(|&length| length <= at);
        let point = self.corners[own] + self.along(own) * (at - self.lengths[own]);
        let normal = self.normal(own);
        let look = |k: usize| {
            let toward = direction(k, cameras);
            let cosine = toward.dot(normal);
            if cosine > IN_FRONT && self.is_free(point, own, toward) { cosine } else { 0.0 }
        };
        (0..cameras).map(look).collect()
    }

    /// Looks from all cameras at `samples` points, evenly spaced along the boundary, each in the middle of its share.
    #[must_use]
    pub fn diagram(&self, samples: usize, cameras: usize) -> OutlineDiagram {
        let at = |i: usize| self.length() * (i as f64 + 0.5) / samples as f64;
        let rows: Vec<Vec<f64>> = (0..samples).into_par_iter().map(|i| self.seen_from(at(i), cameras)).collect();
        OutlineDiagram { samples, cameras, cosines: rows.concat() }
    }

    /// True if nothing lies between a point of segment `own` and a camera.
    fn is_free(&self, point: DVec2, own: usize, toward: DVec2) -> bool {
        // No corner is farther away than the boundary is long.
        let far = point + toward * self.length();
        (0..self.corners.len()).all(|i| i == own || !cross([point, far], self.segment(i)))
    }

    /// Unit vector along a segment.
    fn along(&self, i: usize) -> DVec2 {
        let [from, to] = self.segment(i);
        (to - from).normalize()
    }
}

/// Which camera sees which point of an outline, and how squarely.
#[derive(Debug, Clone, PartialEq)]
pub struct OutlineDiagram {
    /// Points along the boundary.
    pub samples: usize,
    /// Cameras around it.
    pub cameras: usize,
    /// One row per sample, one number per camera.
    cosines: Vec<f64>,
}

impl OutlineDiagram {
    /// Cosine between the direction of a camera and the normal of a sample, 0 where the camera does not see it.
    #[must_use]
    pub fn cosine(&self, sample: usize, camera: usize) -> f64 {
        self.cosines[sample * self.cameras + camera]
    }

    /// Visibility of a sample: eq. (4.3) in the plane, that is ½ ∫ F(p,d) d·n dω over the directions in front.
    #[must_use]
    pub fn visibility(&self, sample: usize) -> f64 {
        let seen: f64 = self.cosines[sample * self.cameras..][..self.cameras].iter().sum();
        // The cosines of the half circle in front have the mean 2/π.
        let all = self.cameras as f64 * 2.0 / TAU;
        (seen / all).min(1.0)
    }
}

/// Direction of camera `k` of `cameras`, counter-clockwise from the first axis.
fn direction(k: usize, cameras: usize) -> DVec2 {
    let angle = TAU * k as f64 / cameras as f64;
    DVec2::new(libm::cos(angle), libm::sin(angle))
}

/// True if two segments cross. Signs are exact; a line through a corner crosses one of the two segments there if it passes
/// from one side to the other, and both or none if it only touches.
fn cross([p, q]: [DVec2; 2], [a, b]: [DVec2; 2]) -> bool {
    let is_left = |from: DVec2, to: DVec2, of: DVec2| {
        let coord = |p: DVec2| Coord { x: p.x, y: p.y };
        orient2d(coord(from), coord(to), coord(of)) >= 0.0
    };
    is_left(p, q, a) != is_left(p, q, b) && is_left(a, b, p) != is_left(a, b, q)
}
