//! What hangs on the housing: lifting eyes, breather, dipstick, drain plug, sight glass, name plate, oil pipe.

use glam::{DVec2, DVec3};

use super::super::outline::rounded_rectangle;
use super::super::revolve::{arc, direction, revolve_closed};
use super::super::round::torus;
use super::fasteners::{hex_screw, on_circle};
use super::solid::{along, at, bar, extrude, facing, ring, stepped};
use super::{AXLES, Axle, COVER_END, Detail, Parts, WALL};

pub(super) fn add(parts: &mut Parts, detail: Detail) {
    add_lifting_eye(parts, "output", &AXLES[2], 62.0, detail);
    add_lifting_eye(parts, "input", &AXLES[0], 128.0, detail);
    add_breather(parts, detail);
    add_dipstick(parts, detail);
    add_drain_plug(parts, detail);
    add_sight_glass(parts, detail);
    add_name_plate(parts, detail);
    add_oil_pipe(parts, detail);
}

/// Point on the wall round a shaft and the outward direction there.
fn on_wall(axle: &Axle, angle_deg: f64, w: f64) -> (DVec3, DVec3) {
    let outward = direction(angle_deg.to_radians());
    ((axle.centre + outward * (axle.chamber + WALL)).extend(w), outward.extend(0.0))
}

fn add_lifting_eye(parts: &mut Parts, name: &str, axle: &Axle, angle_deg: f64, detail: Detail) {
    let (foot, outward) = on_wall(axle, angle_deg, 5.0);
    let stem = stepped(&[[-5.0, 9.0, 13.0], [9.0, 13.0, 9.0], [13.0, 22.0, 6.0]], 1.0, detail.around(13.0));
    parts.add(format!("lifting eye {name} stem"), &stem, &along(foot, outward));
    let eye = torus(13.0, 4.5, detail.around(13.0), detail.steps(16.0).max(6));
    parts.add(format!("lifting eye {name} ring"), &eye, &facing(foot + outward * 32.0, outward, DVec3::Z));
}

fn add_breather(parts: &mut Parts, detail: Detail) {
    let (foot, outward) = on_wall(&AXLES[2], 80.0, -48.0);
    let body = stepped(
        &[[-5.0, 4.0, 10.0], [4.0, 16.0, 5.5], [16.0, 18.0, 12.0], [18.0, 28.0, 14.0], [28.0, 31.0, 10.0]],
        0.8,
        detail.around(14.0),
    );
    parts.add("breather", &body, &along(foot, outward));
}

/// A bent tube from the case with a stick whose ring stands out of it.
fn add_dipstick(parts: &mut Parts, detail: Detail) {
    let (foot, outward) = on_wall(&AXLES[0], 168.0, -30.0);
    let collar = stepped(&[[-5.0, 6.0, 10.0], [6.0, 14.0, 8.0]], 1.0, detail.around(10.0));
    parts.add("dipstick collar", &collar, &along(foot, outward));
    let bend = 26.0;
    let centre = foot + outward * 12.0 + DVec3::Y * bend;
    let mut path = vec![foot - outward * 3.0];
    let down = DVec2::new(0.0, -1.0);
    for p in arc(
        DVec2::ZERO,
        bend,
        [libm::atan2(down.y, down.x), libm::atan2(0.0, -1.0) - std::f64::consts::TAU],
        detail.steps(10.0),
    ) {
        // The arc turns from outward to up: its x runs against `outward`.
        path.push(centre - outward * p.x + DVec3::Y * p.y);
    }
    let top = path[path.len() - 1] + DVec3::Y * 62.0;
    path.push(top);
    parts.add("dipstick tube", &bar(&path, 5.0, detail.around(5.0)), &glam::DAffine3::IDENTITY);
    parts.add(
        "dipstick stop",
        &stepped(&[[-2.0, 8.0, 7.5], [8.0, 14.0, 3.0]], 0.8, detail.around(7.5)),
        &along(top, DVec3::Y),
    );
    let handle = torus(9.0, 1.8, detail.around(9.0), detail.steps(8.0).max(5));
    parts.add("dipstick handle", &handle, &facing(top + DVec3::Y * 22.0, DVec3::X, DVec3::Z));
}

fn add_drain_plug(parts: &mut Parts, detail: Detail) {
    let (foot, outward) = on_wall(&AXLES[2], -38.0, -22.0);
    let pad = stepped(&[[-5.0, 9.5, 17.0]], 1.2, detail.around(17.0));
    parts.add("drain pad", &pad, &along(foot, outward));
    parts.add("drain seal", &ring([7.5, 13.0], [9.6, 11.4], detail.around(13.0)), &along(foot, outward));
    parts.add("drain plug", &hex_screw(6.0, 24.0, detail), &along(foot + outward * 11.45, outward));
}

fn add_sight_glass(parts: &mut Parts, detail: Detail) {
    let (foot, outward) = on_wall(&AXLES[2], -4.0, -22.0);
    let section = [[11.0, -4.0], [19.0, -4.0], [19.0, 10.5], [17.5, 12.0], [12.5, 12.0], [11.0, 9.5]].map(DVec2::from);
    parts.add("sight glass frame", &revolve_closed(&section, detail.around(19.0)), &along(foot, outward));
    parts.add("sight glass", &stepped(&[[-3.0, 7.0, 11.2]], 0.5, detail.around(11.0)), &along(foot, outward));
    for (i, centre) in on_circle(15.2, 6, 0.2).iter().enumerate() {
        let screw = along(foot + outward * 12.0, outward) * at(*centre, 0.0);
        parts.add(format!("sight glass screw {i}"), &hex_screw(1.2, 6.0, detail), &screw);
    }
}

/// Plate with two lines of raised lettering bars and four rivets, on the cover.
fn add_name_plate(parts: &mut Parts, detail: Detail) {
    let centre = DVec2::new(-4.0, 53.0);
    let half = DVec2::new(24.0, 13.0);
    let plate = extrude(&rounded_rectangle(DVec2::ZERO, half, 3.0, detail.steps(5.0)), &[], [-1.0, 1.5]);
    parts.add("name plate", &plate, &at(centre, COVER_END));
    for (i, line) in [[26.0, 4.0, 5.0], [34.0, 2.0, -1.0], [34.0, 2.0, -6.0]].into_iter().enumerate() {
        let [length, height, y] = line;
        let text = extrude(
            &rounded_rectangle(DVec2::new(0.0, y), DVec2::new(0.5 * length, 0.5 * height), 0.6, 2),
            &[],
            [1.0, 2.1],
        );
        parts.add(format!("name plate line {i}"), &text, &at(centre, COVER_END));
    }
    let rivet: Vec<DVec2> = arc(DVec2::new(0.0, 0.5), 1.8, [0.0, 1.2], 3);
    let mut section = vec![DVec2::new(0.0, -1.0), DVec2::new(1.8, -1.0)];
    section.extend(rivet);
    section.push(DVec2::new(0.0, 2.3));
    let rivet = revolve_closed(&section, detail.around(1.8));
    for (i, corner) in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].into_iter().enumerate() {
        let place = centre + DVec2::from(corner) * (half - DVec2::splat(3.5));
        parts.add(format!("name plate rivet {i}"), &rivet, &at(place, COVER_END + 1.5));
    }
}

/// Pipe inside the case that brings oil from the sump to the first pair, and its strainer.
fn add_oil_pipe(parts: &mut Parts, detail: Detail) {
    let sump = DVec3::new(-8.0, -70.0, -56.0);
    let bend = 12.0;
    let mut path = vec![sump];
    for p in arc(DVec2::new(bend, 46.0), bend, [std::f64::consts::PI, std::f64::consts::FRAC_PI_2], detail.steps(8.0)) {
        path.push(sump + DVec3::new(p.x, p.y, 0.0));
    }
    path.push(sump + DVec3::new(34.0, 46.0 + bend, 0.0));
    parts.add("oil pipe", &bar(&path, 3.2, detail.around(3.2)), &glam::DAffine3::IDENTITY);
    let strainer = stepped(&[[0.0, 10.0, 9.0], [10.0, 13.0, 5.0]], 1.0, detail.around(9.0));
    parts.add("oil strainer", &strainer, &along(sump - DVec3::Y * 6.0, DVec3::Y));
}
