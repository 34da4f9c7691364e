//! Shafts with keys, ball bearings with shields, and the caps that close the bores.

use std::f64::consts::TAU;

use glam::{DAffine3, DVec2, DVec3};

use super::super::outline::{bent_slot, circle, rounded_rectangle};
use super::super::revolve::{arc, direction, revolve_closed};
use super::super::round::uv_sphere;
use super::super::transformed;
use super::fasteners::hex_screw;
use super::solid::{along, at, extrude, facing, mirrored, ring, stepped};
use super::{AXLES, Axle, CASE_END, COVER_END, Detail, Parts};
use crate::mesh::TriMesh;

/// Steps of the shafts as [from, to, radius] along w.
const INPUT: [[f64; 3]; 5] =
    [[-172.0, -112.0, 10.0], [-112.0, -56.0, 12.5], [-56.0, 46.0, 16.0], [46.0, 56.0, 15.0], [56.0, 78.0, 12.5]];
const LAYSHAFT: [[f64; 3]; 5] =
    [[-80.0, -58.0, 12.5], [-58.0, -4.0, 16.0], [-4.0, 8.0, 22.0], [8.0, 56.0, 19.0], [56.0, 78.0, 12.5]];
const OUTPUT: [[f64; 3]; 6] = [
    [-80.0, -58.0, 20.0],
    [-58.0, -12.5, 27.0],
    [-12.5, 2.0, 32.0],
    [2.0, 56.0, 25.0],
    [56.0, 108.0, 20.0],
    [108.0, 178.0, 17.5],
];

/// How far the bearings reach along w, from the end faces of the housing.
const BEARING: [f64; 2] = [-1.0, 16.0];

pub(super) fn add(parts: &mut Parts, detail: Detail) {
    let steps: [&[[f64; 3]]; 3] = [&INPUT, &LAYSHAFT, &OUTPUT];
    for (axle, steps) in AXLES.iter().zip(steps) {
        let thickest = steps.iter().map(|s| s[2]).fold(0.0, f64::max);
        parts.add(format!("{} shaft", axle.name), &stepped(steps, 1.0, detail.around(thickest)), &at(axle.centre, 0.0));
        for (end, placement) in
            [("case", at(axle.centre, CASE_END)), ("cover", at(axle.centre, 0.0) * mirrored(COVER_END))]
        {
            add_bearing(parts, axle, end, &placement, detail);
            let goes_through = matches!((axle.name, end), ("input", "case") | ("output", "cover"));
            add_cap(parts, axle, end, goes_through, &placement, detail);
        }
    }
    add_keys(parts, detail);
}

/// A deep-groove ball bearing with two shields, its faces at [`BEARING`].
fn add_bearing(parts: &mut Parts, axle: &Axle, end: &str, placement: &DAffine3, detail: Detail) {
    let name = |part: &str| format!("{} bearing {end} {part}", axle.name);
    let (bore, outer) = (axle.seat - 0.05, axle.bearing);
    let track = 0.5 * (bore + outer);
    let ball = 0.29 * (outer - bore);
    let half = 0.5 * (BEARING[1] - BEARING[0]);
    let centred = *placement * DAffine3::from_translation(DVec3::Z * (0.5 * (BEARING[0] + BEARING[1])));
    let segments = detail.around(outer);
    parts.add(name("outer ring"), &race(outer, [track, 0.62 * ball], [ball, half], segments, detail), &centred);
    parts.add(name("inner ring"), &race(bore, [track, -0.62 * ball], [ball, half], segments, detail), &centred);
    for (i, z) in [-half + 1.0, half - 1.8].into_iter().enumerate() {
        let shield = ring([track - 0.8 * ball, track + 0.8 * ball], [z, z + 0.8], segments);
        parts.add(name(&format!("shield {i}")), &shield, &centred);
    }
    let count = 9 + usize::from(axle.bearing > 30.0) * 2;
    let sphere = uv_sphere(detail.steps(14.0).max(6), detail.steps(7.0).max(4));
    let sized = transformed(&sphere, &DAffine3::from_scale(DVec3::splat(0.98 * ball))).expect("balls have millimetres");
    for i in 0..count {
        let centre = direction(TAU * i as f64 / count as f64) * track;
        parts.add(name(&format!("ball {i}")), &sized, &(centred * at(centre, 0.0)));
    }
}

/// A bearing ring from `seat` to a shoulder beside the track, with a groove for the balls.
fn race(seat: f64, [track, shoulder]: [f64; 2], [ball, half]: [f64; 2], segments: usize, detail: Detail) -> TriMesh {
    let outward = shoulder.signum();
    let edge = track + shoulder;
    let depth = libm::acos(shoulder.abs() / ball);
    let mut section: Vec<DVec2> = arc(DVec2::new(0.0, 0.0), ball, [-depth, depth], detail.steps(6.0))
        .iter()
        .map(|p| DVec2::new(track + outward * p.x, p.y))
        .collect();
    section.push(DVec2::new(edge, half));
    section.push(DVec2::new(seat - outward * 0.8, half));
    section.push(DVec2::new(seat, half - 0.8));
    section.push(DVec2::new(seat, 0.8 - half));
    section.push(DVec2::new(seat - outward * 0.8, -half));
    section.push(DVec2::new(edge, -half));
    // The list runs up the groove: clockwise for the outer ring, whose body lies outside the track.
    if outward > 0.0 {
        section.reverse();
    }
    revolve_closed(&section, segments)
}

/// The cap on a boss: closed, or with a seal round the shaft that leaves; held by hexagon screws.
fn add_cap(parts: &mut Parts, axle: &Axle, end: &str, goes_through: bool, placement: &DAffine3, detail: Detail) {
    let rim = axle.bearing + 8.0;
    let neck = axle.bearing - 4.0;
    let hole = axle.seat + 0.4;
    let mut section: Vec<DVec2> =
        [[rim, -12.2], [rim, -16.0], [rim - 1.5, -17.5], [neck, -17.5], [neck - 2.0, -21.0]].map(DVec2::from).to_vec();
    if goes_through {
        section.extend(
            [[hole + 5.0, -21.0], [hole + 5.0, -19.0], [hole, -19.0], [hole, -2.0], [neck - 4.0, -2.0]]
                .map(DVec2::from),
        );
    } else {
        section.extend([[0.0, -21.0], [0.0, -7.0], [neck - 4.0, -7.0]].map(DVec2::from));
    }
    section.extend([[axle.bearing - 0.3, -2.0], [axle.bearing - 0.3, -12.2]].map(DVec2::from));
    section.reverse();
    parts.add(format!("{} cap {end}", axle.name), &revolve_closed(&section, detail.around(rim)), placement);
    let count = if axle.bearing > 30.0 { 8 } else { 6 };
    for i in 0..count {
        let centre = direction(TAU * (i as f64 + 0.35) / count as f64) * (axle.bearing + 2.5);
        let screw = *placement * along(centre.extend(-17.4), DVec3::NEG_Z);
        parts.add(format!("{} cap {end} screw {i}", axle.name), &hex_screw(2.6, 14.0, detail), &screw);
    }
}

/// Keys of the shaft ends, and of the two wheels.
fn add_keys(parts: &mut Parts, detail: Detail) {
    let key = |length: f64, width: f64, height: f64| {
        let half = DVec2::new(0.5 * length, 0.5 * width);
        extrude(&rounded_rectangle(DVec2::ZERO, half, 0.499 * width, detail.steps(5.0)), &[], [-height, height])
    };
    let on =
        |axle: usize, radius: f64, w: f64| facing(AXLES[axle].centre.extend(w) + DVec3::Y * radius, DVec3::Z, DVec3::Y);
    parts.add("input key", &key(40.0, 6.0, 2.8), &on(0, 10.0, -143.0));
    parts.add("output key", &key(48.0, 10.0, 3.5), &on(2, 17.5, 144.0));
    // A retaining ring behind the layshaft wheel, open at the top.
    let snap =
        extrude(&bent_slot(DVec2::ZERO, 20.5, [2.0, 1.2 + TAU - 0.6], 2.0, detail.steps(18.0)), &[], [41.0, 42.5]);
    parts.add("layshaft retaining ring", &snap, &at(AXLES[1].centre, 0.0));
    let spacer = extrude(
        &circle(DVec2::ZERO, 23.5, detail.around(23.5), 0.0),
        &[circle(DVec2::ZERO, 15.95, detail.around(16.0), 0.1)],
        [39.0, 45.0],
    );
    parts.add("input spacer", &spacer, &at(AXLES[0].centre, 0.0));
}
