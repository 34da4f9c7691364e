//! Plane outlines, counter-clockwise: what the gearbox's parts are extruded from.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec2;

use super::revolve::{arc, direction, turn};

/// Circle in `corners` steps, the first corner at `phase_rad`.
pub(super) fn circle(centre: DVec2, radius: f64, corners: usize, phase_rad: f64) -> Vec<DVec2> {
    (0..corners).map(|i| centre + direction(phase_rad + turn(i, corners)) * radius).collect()
}

/// Rectangle with rounded corners, `steps` segments a corner.
pub(super) fn rounded_rectangle(centre: DVec2, half: DVec2, radius: f64, steps: usize) -> Vec<DVec2> {
    let inner = half - DVec2::splat(radius);
    let corners = [DVec2::new(1.0, 1.0), DVec2::new(-1.0, 1.0), DVec2::new(-1.0, -1.0), DVec2::new(1.0, -1.0)];
    let corner = |i: usize| {
        let from = FRAC_PI_2 * i as f64;
        arc(centre + corners[i] * inner, radius, [from, from + FRAC_PI_2], steps)
    };
    (0..4).flat_map(corner).collect()
}

/// Bent slot: the band of half width `half_width` round an arc about `centre`, with round ends.
pub(super) fn bent_slot(centre: DVec2, radius: f64, angles_rad: [f64; 2], half_width: f64, steps: usize) -> Vec<DVec2> {
    let [from, to] = angles_rad;
    let end = |angle: f64, start: f64| {
        let tip = centre + direction(angle) * radius;
        arc(tip, half_width, [start, start + PI], steps)
    };
    let mut outline = arc(centre, radius + half_width, [from, to], 2 * steps);
    outline.extend(end(to, to).into_iter().skip(1));
    outline.extend(arc(centre, radius - half_width, [to, from], 2 * steps).into_iter().skip(1));
    let closing = end(from, from + PI);
    outline.extend(closing[1..closing.len() - 1].iter());
    outline
}

/// Circle with a keyway: a notch of the given width that reaches `depth` beyond the circle, at angle `at_rad`.
pub(super) fn keyed_circle(radius: f64, width: f64, depth: f64, at_rad: f64, corners: usize) -> Vec<DVec2> {
    let half_angle = libm::asin(0.5 * width / radius);
    let along = direction(at_rad);
    let across = along.perp();
    let mut outline = arc(DVec2::ZERO, radius, [at_rad + half_angle, at_rad + TAU - half_angle], corners);
    let bottom = along * (radius + depth);
    outline.push(bottom - across * (0.5 * width));
    outline.push(bottom + across * (0.5 * width));
    outline
}

/// The convex hull of circles, each touched in the order given (counter-clockwise), and its parallels at any distance.
pub(super) struct BeltOutline {
    /// Corners as (centre, radius, unit normal): the point at offset d is centre + (radius + d) · normal.
    corners: Vec<(DVec2, f64, DVec2)>,
    /// First corner of each straight stretch, which ends at the next corner.
    straights: Vec<usize>,
}

impl BeltOutline {
    /// A belt round the circles (centre, radius), at most `step_rad` from corner to corner.
    pub(super) fn new(circles: &[(DVec2, f64)], step_rad: f64) -> Self {
        let count = circles.len();
        let leave = |i: usize| tangent_angle(circles[i], circles[(i + 1) % count]);
        let (mut corners, mut straights) = (Vec::new(), Vec::new());
        for (i, &(centre, radius)) in circles.iter().enumerate() {
            let from = leave((i + count - 1) % count);
            let to = from + (leave(i) - from).rem_euclid(TAU);
            let steps = libm::ceil((to - from) / step_rad).max(1.0) as usize;
            let normals = arc(DVec2::ZERO, 1.0, [from, to], steps);
            corners.extend(normals.into_iter().map(|normal| (centre, radius, normal)));
            straights.push(corners.len() - 1);
        }
        Self { corners, straights }
    }

    /// The outline `distance` outside the belt (negative: inside); corner i belongs to corner i of every other
    /// distance.
    pub(super) fn offset(&self, distance: f64) -> Vec<DVec2> {
        self.corners.iter().map(|&(centre, radius, normal)| centre + normal * (radius + distance)).collect()
    }

    /// Points all the way round, at most `step` apart on straights and arcs alike, with their outward normals.
    pub(super) fn walk(&self, step: f64) -> Vec<(DVec2, DVec2)> {
        let belt = self.offset(0.0);
        let mut points = Vec::new();
        for (i, &(.., normal)) in self.corners.iter().enumerate() {
            let j = (i + 1) % belt.len();
            let steps = libm::ceil((belt[j] - belt[i]).length() / step).max(1.0) as usize;
            let (centre, radius, next) = self.corners[j];
            for k in 0..steps {
                let share = k as f64 / steps as f64;
                let chord = belt[i].lerp(belt[j], share);
                let straight = normal.abs_diff_eq(next, 1e-9);
                // On an arc the point is pushed out from the chord to the circle.
                let bent = (chord - centre).normalize();
                points.push(if straight { (chord, normal) } else { (centre + bent * radius, bent) });
            }
        }
        points
    }

    /// Number of corners.
    pub(super) fn len(&self) -> usize {
        self.corners.len()
    }

    /// Outward normal at a corner.
    pub(super) fn normal(&self, corner: usize) -> DVec2 {
        self.corners[corner % self.corners.len()].2
    }

    /// Corner at which straight stretch `i` begins: the one that leaves circle `i`.
    pub(super) fn straight(&self, i: usize) -> usize {
        self.straights[i]
    }
}

/// Direction of the outer normal of the belt from one circle to the next, counter-clockwise.
fn tangent_angle((from, r0): (DVec2, f64), (to, r1): (DVec2, f64)) -> f64 {
    let way = to - from;
    // The normal n keeps n·way = r0 - r1 and lies to the right of the way.
    let towards = libm::acos((r0 - r1) / way.length());
    libm::atan2(way.y, way.x) - towards
}
