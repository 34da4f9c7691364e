//! Where the vertex goes that replaces an edge.

use glam::DVec3;

use super::quadric::Quadric;

/// Smallest pivot of the 3 x 3 system, as a share of a third of its trace: below it the planes do not fix a point.
const MIN_PIVOT: f64 = 1e-7;

/// Smallest curvature of the quadric along an edge, as a share of its trace: below it every point is as good.
const MIN_CURVATURE: f64 = 1e-12;

/// How the position of a new vertex is chosen.
#[derive(Debug, Clone, Copy)]
pub struct Placement {
    /// Farthest the position may be from the middle of the edge, in edge lengths.
    pub max_distance: f64,
    /// Strength of the pull toward the balance point of the two ends, as a share of the quadric's weight.
    pub regulariser: f64,
}

impl Placement {
    /// The position that replaces edge `uv`, whose ends have the quadrics `q_u` and `q_v`.
    ///
    /// The minimum of q_u + q_v where that is one point near the edge, else the minimum on the edge, else the best of
    /// the middle and the two ends.
    #[must_use]
    pub fn place(&self, [u, v]: [DVec3; 2], [q_u, q_v]: [&Quadric; 2]) -> DVec3 {
        let q = q_u.plus(q_v);
        let middle = 0.5 * (u + v);
        let balance = balance_point([u, v], [q_u.total_weight(), q_v.total_weight()]);
        let limit = self.max_distance * self.max_distance * u.distance_squared(v);
        minimum(&q, balance, self.regulariser)
            .filter(|x| x.distance_squared(middle) <= limit)
            .or_else(|| minimum_on_segment(&q, [u, v]))
            .unwrap_or_else(|| best_of(&q, [middle, u, v]))
    }
}

/// The mean of two points by these weights, their middle where both weigh nothing.
fn balance_point([u, v]: [DVec3; 2], [w_u, w_v]: [f64; 2]) -> DVec3 {
    let total = w_u + w_v;
    let share = if total > 0.0 { w_v / total } else { 0.5 };
    u + share * (v - u)
}

/// The point of least `q`, with a pull of `regulariser` toward `anchor`; `None` where no single point is least.
fn minimum(q: &Quadric, anchor: DVec3, regulariser: f64) -> Option<DVec3> {
    let pull = regulariser * q.total_weight();
    let factors = Ldlt::of(&q.a, pull)?;
    let mut x = factors.solve(pull * anchor - q.b);
    if pull > 0.0 {
        // The pull is felt only where the planes say nothing: each repetition from the last answer shrinks its effect
        // on a direction of curvature k by pull / (k + pull).
        for _ in 0..PULL_REPETITIONS {
            x = factors.solve(pull * x - q.b);
        }
    }
    x.is_finite().then_some(x)
}

/// After two, corners of right angle are met to the rounding error with the strongest pull allowed.
const PULL_REPETITIONS: usize = 2;

/// A symmetric 3 x 3 matrix as L D Lᵀ; of D the reciprocals.
struct Ldlt {
    l: [f64; 3],
    inverse_d: [f64; 3],
}

impl Ldlt {
    /// Factors of `a` + `shift` I; `None` where a pivot is too small.
    fn of(a: &[f64; 6], shift: f64) -> Option<Self> {
        let &[xx, xy, xz, yy, yz, zz] = a;
        let smallest = MIN_PIVOT * (xx + yy + zz) / 3.0;
        let d0 = xx + shift;
        if d0 <= smallest {
            return None;
        }
        let inverse_d0 = d0.recip();
        let (l10, l20) = (xy * inverse_d0, xz * inverse_d0);
        let d1 = yy + shift - l10 * xy;
        if d1 <= smallest {
            return None;
        }
        let inverse_d1 = d1.recip();
        let yz_left = yz - l20 * xy;
        let l21 = yz_left * inverse_d1;
        let d2 = zz + shift - l20 * xz - l21 * yz_left;
        (d2 > smallest).then(|| Self { l: [l10, l20, l21], inverse_d: [inverse_d0, inverse_d1, d2.recip()] })
    }

    fn solve(&self, right: DVec3) -> DVec3 {
        let ([l10, l20, l21], [inverse_d0, inverse_d1, inverse_d2]) = (self.l, self.inverse_d);
        let y0 = right.x;
        let y1 = right.y - l10 * y0;
        let y2 = right.z - l20 * y0 - l21 * y1;
        let x2 = y2 * inverse_d2;
        let x1 = y1 * inverse_d1 - l21 * x2;
        let x0 = y0 * inverse_d0 - l10 * x1 - l20 * x2;
        DVec3::new(x0, x1, x2)
    }
}

/// The point of least `q` on the segment; `None` where `q` hardly changes along it.
fn minimum_on_segment(q: &Quadric, [u, v]: [DVec3; 2]) -> Option<DVec3> {
    let along = v - u;
    let curvature = along.dot(q.a_times(along));
    if curvature <= MIN_CURVATURE * q.total_weight() * along.length_squared() {
        return None;
    }
    let share = -along.dot(q.a_times(u) + q.b) / curvature;
    Some(if share <= 0.0 {
        u
    } else if share >= 1.0 {
        v
    } else {
        u + share * along
    })
}

/// The point of least `q` among `points`, the first of equals.
fn best_of(q: &Quadric, points: [DVec3; 3]) -> DVec3 {
    let mut best = (q.value(points[0]).max(0.0), points[0]);
    for &p in &points[1..] {
        let value = q.value(p).max(0.0);
        if value < best.0 {
            best = (value, p);
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    const PLAIN: Placement = Placement { max_distance: 2.0, regulariser: 0.0 };
    const PULLED: Placement = Placement { max_distance: 2.0, regulariser: 1e-6 };

    /// Rounding of a 3 x 3 system of condition 1, and of the pull's last remainder.
    const ROUNDING: f64 = 1e-14;

    fn planes(list: &[(DVec3, f64)]) -> Quadric {
        let mut q = Quadric::default();
        list.iter().for_each(|&(normal, d)| q.add(&Quadric::of_plane(normal, d, 1.0)));
        q
    }

    #[test]
    fn three_planes_place_the_vertex_where_they_meet() {
        let corner = DVec3::new(0.25, 0.5, -0.75);
        let q = planes(&[(DVec3::X, -corner.x), (DVec3::Y, -corner.y), (DVec3::Z, -corner.z)]);
        for placement in [PLAIN, PULLED] {
            let x = placement.place([corner + DVec3::X, corner + DVec3::Y], [&q, &Quadric::default()]);
            assert!(x.distance(corner) < ROUNDING, "{x}");
        }
    }

    #[test]
    fn minimum_too_far_away_is_not_taken() {
        let q = planes(&[(DVec3::X, 0.0), (DVec3::Y, 0.0), (DVec3::Z, 0.0)]);
        let ends = [DVec3::new(5.0, 0.0, 0.0), DVec3::new(6.0, 0.0, 0.0)];
        // The best point on the edge is its end nearest to the origin.
        assert_eq!(PLAIN.place(ends, [&q, &Quadric::default()]), ends[0]);
        let far = Placement { max_distance: 10.0, ..PLAIN };
        assert!(far.place(ends, [&q, &Quadric::default()]).length() < ROUNDING);
    }

    #[test]
    fn one_plane_places_the_vertex_in_the_middle() {
        let q = planes(&[(DVec3::Z, 0.0)]);
        assert_eq!(PLAIN.place([DVec3::ZERO, DVec3::X], [&q, &q]), 0.5 * DVec3::X);
        assert!(PULLED.place([DVec3::ZERO, DVec3::X], [&q, &q]).distance(0.5 * DVec3::X) < ROUNDING);
    }

    #[test]
    fn crease_is_met_where_the_edge_crosses_it() {
        // The crease is the x axis; the edge comes from above onto it and goes on below.
        let q = planes(&[(DVec3::Z, 0.0), (DVec3::Y, 0.0)]);
        let x = PLAIN.place([DVec3::new(0.0, 1.0, 1.0), DVec3::new(3.0, -2.0, -2.0)], [&q, &Quadric::default()]);
        assert!(x.distance(DVec3::X) < ROUNDING, "{x}");
    }

    #[test]
    fn pull_shares_by_weight_where_planes_say_nothing() {
        let (light, heavy) = (planes(&[(DVec3::Z, 0.0)]), planes(&[(DVec3::Z, 0.0); 3]));
        let x = PULLED.place([DVec3::ZERO, DVec3::X], [&light, &heavy]);
        assert!(x.distance(0.75 * DVec3::X) < ROUNDING, "{x}");
    }

    #[test]
    fn edge_without_length_and_quadrics_without_planes_stay_in_place() {
        let nothing = Quadric::default();
        for placement in [PLAIN, PULLED] {
            assert_eq!(placement.place([DVec3::ONE, DVec3::ONE], [&nothing, &nothing]), DVec3::ONE);
            assert_eq!(placement.place([DVec3::ZERO, DVec3::X], [&nothing, &nothing]), 0.5 * DVec3::X);
        }
    }
}
