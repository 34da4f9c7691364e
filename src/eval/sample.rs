//! Points spread evenly over the surface of a mesh.
//!
//! The surface is laid out triangle after triangle along a line of its total area, and the line is cut into equal
//! steps: point `i` lies in the triangle at step `i`, so every triangle gets its share of points, rounded up or down.
//! Within the triangle it is placed by the additive recurrence R2, whose consecutive members keep away from one
//! another. Each point depends on the seed and its own number alone.
//!
//! Source of R2: Roberts, The Unreasonable Effectiveness of Quasirandom Sequences, 2018.

use glam::DVec3;

use crate::geom;

/// 2^64 / g and 2^64 / g², rounded to odd numbers, where g = 1.3247… solves g³ = g + 1.
const R2_STEPS: [u64; 2] = [13_925_035_116_211_876_495, 10_511_698_010_929_265_437];

/// 2^-53: turns 53 random bits into a number in [0, 1).
const UNIT_OF_53_BITS: f64 = 1.0 / (1_u64 << 53) as f64;

/// Evenly spread points on triangles.
#[derive(Debug)]
pub(super) struct SurfaceSamples<'a> {
    corners: &'a [[DVec3; 3]],
    /// Area of all triangles up to and including each.
    area_up_to: Vec<f64>,
    count: u64,
    start: [u64; 2],
    /// Where in its step each point lies, in [0, 1).
    offset: f64,
}

impl<'a> SurfaceSamples<'a> {
    /// `count` points on these triangles; none where they have no area.
    pub(super) fn new(corners: &'a [[DVec3; 3]], count: u64, seed: u64) -> Self {
        let mut sum = 0.0;
        let area_up_to: Vec<f64> = corners
            .iter()
            .map(|&t| {
                sum += geom::triangle_area(t);
                sum
            })
            .collect();
        let mut state = seed;
        let mut next = || split_mix(&mut state);
        let start = [next(), next()];
        let offset = unit(next());
        Self { corners, area_up_to, count: if sum > 0.0 { count } else { 0 }, start, offset }
    }

    /// How many points there are.
    pub(super) fn count(&self) -> u64 {
        self.count
    }

    /// The points `range`, which must lie within the count, each with the number of its triangle.
    pub(super) fn points(&self, range: std::ops::Range<u64>) -> impl Iterator<Item = (usize, DVec3)> {
        let total = self.area_up_to.last().copied().unwrap_or(0.0);
        let step = total / self.count as f64;
        let mut triangle = None;
        range.map(move |i| {
            let place = (i as f64 + self.offset) * step;
            let mut t = triangle.unwrap_or_else(|| self.area_up_to.partition_point(|&area| area <= place));
            while t + 1 < self.corners.len() && self.area_up_to[t] <= place {
                t += 1;
            }
            // Rounding can put the last place at the very end, past the last triangle.
            t = t.min(self.corners.len() - 1);
            triangle = Some(t);
            (t, self.point_in(self.corners[t], i))
        })
    }

    /// Point `i` in a triangle, uniform over its area.
    fn point_in(&self, [a, b, c]: [DVec3; 3], i: u64) -> DVec3 {
        let [u, v] = [0, 1].map(|k| unit(self.start[k].wrapping_add(i.wrapping_mul(R2_STEPS[k]))));
        let from_a = u.sqrt();
        a + (b - a) * (from_a * (1.0 - v)) + (c - a) * (from_a * v)
    }
}

/// The upper 53 bits as a number in [0, 1).
fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 * UNIT_OF_53_BITS
}

/// SplitMix64 (Steele, Lea & Flood 2014): spreads a seed over all bits.
fn split_mix(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]

    use super::*;

    /// Triangles in the plane z = 0: one of area 1/2, one of none, one of area 3/2.
    fn corners() -> Vec<[DVec3; 3]> {
        let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        vec![
            [at(0., 0.), at(1., 0.), at(0., 1.)],
            [at(5., 5.), at(6., 6.), at(7., 7.)],
            [at(10., 0.), at(13., 0.), at(10., 1.)],
        ]
    }

    #[test]
    fn triangles_get_points_by_their_area() {
        let corners = corners();
        let points: Vec<_> = SurfaceSamples::new(&corners, 1000, 3).points(0..1000).collect();
        assert_eq!(points.len(), 1000);
        assert_eq!(points.iter().filter(|(t, p)| *t == 0 && p.x < 2.0).count(), 250);
        assert_eq!(points.iter().filter(|(t, p)| *t == 2 && p.x >= 10.0).count(), 750);
    }

    #[test]
    fn points_lie_in_their_triangle_and_around_its_centre() {
        let corners = corners();
        let samples = SurfaceSamples::new(&corners[..1], 4000, 0);
        let points: Vec<DVec3> = samples.points(0..4000).map(|(_, p)| p).collect();
        assert!(points.iter().all(|p| p.x >= 0.0 && p.y >= 0.0 && p.x + p.y <= 1.0 + f64::EPSILON));
        let mean = points.iter().sum::<DVec3>() / 4000.0;
        // Plain random points would be off by 0.24 / sqrt(4000) = 4e-3.
        assert!((mean - DVec3::new(1.0, 1.0, 0.0) / 3.0).length() < 5e-4, "{mean}");
    }

    #[test]
    fn a_point_depends_on_its_number_alone() {
        let corners = corners();
        let samples = SurfaceSamples::new(&corners, 100, 9);
        let whole: Vec<_> = samples.points(0..100).collect();
        let parts: Vec<_> = [0..7, 7..60, 60..100].into_iter().flat_map(|r| samples.points(r)).collect();
        assert_eq!(whole, parts);
    }

    #[test]
    fn no_area_no_points() {
        let corners = corners();
        assert_eq!(SurfaceSamples::new(&corners[1..2], 100, 0).count(), 0);
    }

    #[test]
    fn one_point_is_enough_for_any_mesh() {
        let corners = corners();
        for seed in 0..50 {
            assert_eq!(SurfaceSamples::new(&corners, 1, seed).points(0..1).count(), 1);
        }
    }
}
