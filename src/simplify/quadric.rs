//! Sums of squared distances to planes.

use glam::DVec3;

/// A weighted sum of squared distances to planes, as a function of the point: x·Ax + 2 b·x + c.
///
/// Source: Garland & Heckbert 1997; A, b and c are the blocks of their 4 x 4 matrix.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Quadric {
    /// Upper triangle of the symmetric A: xx, xy, xz, yy, yz, zz.
    pub a: [f64; 6],
    /// b.
    pub b: DVec3,
    /// c.
    pub c: f64,
}

impl Quadric {
    /// `weight` times the squared distance to the plane n·x + d = 0, where `normal` has length 1.
    #[must_use]
    pub fn of_plane(normal: DVec3, d: f64, weight: f64) -> Self {
        let n = normal;
        let wn = weight * n;
        Self {
            a: [wn.x * n.x, wn.x * n.y, wn.x * n.z, wn.y * n.y, wn.y * n.z, wn.z * n.z],
            b: d * wn,
            c: d * d * weight,
        }
    }

    /// Adds the distances of `other`.
    pub fn add(&mut self, other: &Self) {
        for (mine, theirs) in self.a.iter_mut().zip(other.a) {
            *mine += theirs;
        }
        self.b += other.b;
        self.c += other.c;
    }

    /// Every weight times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self { a: self.a.map(|entry| factor * entry), b: factor * self.b, c: factor * self.c }
    }

    /// This quadric and `other` together.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        let mut sum = *self;
        sum.add(other);
        sum
    }

    /// A times `x`.
    #[must_use]
    pub fn a_times(&self, x: DVec3) -> DVec3 {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        DVec3::new(xx * x.x + xy * x.y + xz * x.z, xy * x.x + yy * x.y + yz * x.z, xz * x.x + yz * x.y + zz * x.z)
    }

    /// The weighted sum of squared distances of `x`; rounding can bring it slightly below 0.
    #[must_use]
    pub fn value(&self, x: DVec3) -> f64 {
        (self.a_times(x) + 2.0 * self.b).dot(x) + self.c
    }

    /// Sum of the weights of the planes: the trace of A, since each normal has length 1.
    #[must_use]
    pub fn total_weight(&self) -> f64 {
        self.a[0] + self.a[3] + self.a[5]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of a few products and sums of numbers near 1.
    const ROUNDING: f64 = 1e-14;

    #[test]
    fn planted_planes_give_their_weighted_squared_distances() {
        // Planes x = 1, y = 2, and the one through the origin with normal (2, 2, 1) / 3.
        let planes =
            [(DVec3::X, -1.0, 2.0), (DVec3::Y, -2.0, 3.0), (DVec3::new(2.0 / 3.0, 2.0 / 3.0, 1.0 / 3.0), 0.0, 0.5)];
        let mut q = Quadric::default();
        planes.iter().for_each(|&(n, d, w)| q.add(&Quadric::of_plane(n, d, w)));
        for x in [DVec3::ZERO, DVec3::new(1.0, 2.0, -6.0), DVec3::new(-0.3, 0.7, 0.2)] {
            let expected: f64 = planes.iter().map(|(n, d, w)| w * (n.dot(x) + d).powi(2)).sum();
            assert!((q.value(x) - expected).abs() < 100.0 * ROUNDING, "{} for {expected}", q.value(x));
        }
        assert!((q.total_weight() - 5.5).abs() < ROUNDING);
    }

    #[test]
    fn scaling_and_adding_are_those_of_the_weights() {
        let q = Quadric::of_plane(DVec3::Z, -0.5, 3.0);
        assert_eq!(q.scaled(2.0), Quadric::of_plane(DVec3::Z, -0.5, 6.0));
        assert_eq!(q.plus(&q), q.scaled(2.0));
        assert_eq!(q.scaled(1.0), q);
    }
}
