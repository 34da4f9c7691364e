//! Helical gears with involute teeth, their webs, hubs and keyways.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::super::builder::{Builder, at_height};
use super::super::outline::{circle, keyed_circle};
use super::super::revolve::direction;
use super::{AXLES, Detail, Parts};
use crate::mesh::TriMesh;

/// Pressure angle of the teeth, 20°.
const PRESSURE_ANGLE: f64 = 20.0 * PI / 180.0;
/// Helix angle at the pitch circle, 12°.
const HELIX_ANGLE: f64 = 12.0 * PI / 180.0;

/// A gear on its shaft.
struct Gear {
    name: &'static str,
    /// Which of [`AXLES`] it sits on.
    axle: usize,
    teeth: usize,
    module: f64,
    /// Faces of the rim along w.
    face: [f64; 2],
    /// Radius of the shaft it sits on.
    bore: f64,
    /// +1 for a right-hand helix, −1 for a left-hand one.
    hand: f64,
    /// Radii of hub and rim with the web between them; `None` for a solid disc.
    web: Option<[f64; 2]>,
}

/// Two pairs: 19 on 47 teeth of module 2.5 (82.5 mm apart), 17 on 53 of module 3 (105 mm apart).
const PAIRS: [[Gear; 2]; 2] = [
    [
        Gear {
            name: "input pinion",
            axle: 0,
            teeth: 19,
            module: 2.5,
            face: [10.0, 38.0],
            bore: 15.9,
            hand: 1.0,
            web: None,
        },
        Gear {
            name: "layshaft wheel",
            axle: 1,
            teeth: 47,
            module: 2.5,
            face: [12.0, 36.0],
            bore: 18.9,
            hand: -1.0,
            web: Some([29.0, 47.0]),
        },
    ],
    [
        Gear {
            name: "layshaft pinion",
            axle: 1,
            teeth: 17,
            module: 3.0,
            face: [-50.0, -12.0],
            bore: 15.9,
            hand: 1.0,
            web: None,
        },
        Gear {
            name: "output wheel",
            axle: 2,
            teeth: 53,
            module: 3.0,
            face: [-47.0, -15.0],
            bore: 26.9,
            hand: -1.0,
            web: Some([39.0, 64.0]),
        },
    ],
];

pub(super) fn add(parts: &mut Parts, detail: Detail) {
    let mut phase = 0.13;
    for [driving, driven] in &PAIRS {
        let way = AXLES[driven.axle].centre - AXLES[driving.axle].centre;
        let driven_phase = meshing_phase([driving.teeth, driven.teeth], phase, libm::atan2(way.y, way.x));
        for (gear, at) in [(driving, phase), (driven, driven_phase)] {
            parts.add(gear.name, &solid(gear, detail), &placed(gear, at));
        }
        phase = 0.4;
    }
}

/// On its axle, its rim centred at the height of its faces, turned by `phase_rad`.
fn placed(gear: &Gear, phase_rad: f64) -> DAffine3 {
    let across = direction(phase_rad);
    let turned = DMat3::from_cols(across.extend(0.0), across.perp().extend(0.0), DVec3::Z);
    let middle = 0.5 * (gear.face[0] + gear.face[1]);
    DAffine3::from_mat3_translation(turned, AXLES[gear.axle].centre.extend(middle))
}

/// Turn of the driven gear at which a gap of its teeth meets a tooth of the driving gear on the line between them.
///
/// A tooth counts 1; from the line, the driving gear is p = (β − φ)·z/2π teeth on, and the driven gear, which turns the
/// other way and stands on the other side, must be ½ − p.
fn meshing_phase([z1, z2]: [usize; 2], phase_rad: f64, line_rad: f64) -> f64 {
    let on = (line_rad - phase_rad) * z1 as f64 / TAU;
    line_rad + PI - (0.5 - on) * TAU / z2 as f64
}

fn solid(gear: &Gear, detail: Detail) -> TriMesh {
    let mut builder = Builder::default();
    let half = 0.5 * (gear.face[1] - gear.face[0]);
    let layers = detail.steps(4.0);
    let twist = gear.hand * libm::tan(HELIX_ANGLE) / (0.5 * gear.module * gear.teeth as f64);
    let outline = tooth_outline(gear.teeth, gear.module, detail);
    let rim = |layer: usize| {
        let z = half * (2.0 * layer as f64 / layers as f64 - 1.0);
        let turned: Vec<DVec2> = outline.iter().map(|p| direction(twist * z).rotate(*p)).collect();
        at_height(&turned, z)
    };
    (0..layers).for_each(|i| builder.band(&rim(i), &rim(i + 1)));
    let bore = keyed_circle(gear.bore, 8.0, 3.3, FRAC_PI_2, detail.around(gear.bore));
    match gear.web {
        None => disc_faces(&mut builder, &bore, [&rim(0), &rim(layers)], half),
        Some(radii) => web_faces(&mut builder, &bore, [&rim(0), &rim(layers)], [half, radii[0], radii[1]], detail),
    }
    builder.finish()
}

/// Flat faces from the teeth to the bore.
fn disc_faces(builder: &mut Builder, bore: &[DVec2], [low, high]: [&[DVec3]; 2], half: f64) {
    builder.polygon(low, &[at_height(bore, -half)], DVec3::NEG_Z);
    builder.polygon(high, &[at_height(bore, half)], DVec3::Z);
    builder.band(&at_height(bore, half), &at_height(bore, -half));
}

/// Rim, web with lightening holes and hub, on both sides.
fn web_faces(builder: &mut Builder, bore: &[DVec2], rims: [&[DVec3]; 2], [half, hub, rim]: [f64; 3], detail: Detail) {
    let (web_half, hub_half) = (0.32 * half, 1.15 * half);
    let hub_circle = |r: f64| circle(DVec2::ZERO, r, detail.around(hub), 0.05);
    let rim_circle = |r: f64| circle(DVec2::ZERO, r, detail.around(rim), 0.02);
    let middle = 0.5 * (hub + rim);
    let hole_radius = 0.33 * (rim - hub);
    let holes: Vec<Vec<DVec2>> = (0..6)
        .map(|i| {
            circle(direction(TAU * (f64::from(i) + 0.25) / 6.0) * middle, hole_radius, detail.around(hole_radius), 0.3)
        })
        .collect();
    for (side, teeth) in [-1.0, 1.0].into_iter().zip(rims) {
        let normal = DVec3::Z * side;
        let at = |outline: &[DVec2], z: f64| at_height(outline, side * z);
        // A band from the lower loop to the upper one faces outward; on the other side, turn both.
        let mut band = |first: Vec<DVec3>, then: Vec<DVec3>| {
            if side > 0.0 { builder.band(&first, &then) } else { builder.band(&then, &first) }
        };
        band(at(&rim_circle(rim), half), at(&rim_circle(rim - 2.0), web_half));
        band(at(&hub_circle(hub + 1.5), web_half), at(&hub_circle(hub), hub_half - 1.0));
        band(at(&hub_circle(hub), hub_half - 1.0), at(&hub_circle(hub - 1.0), hub_half));
        builder.polygon(teeth, &[at(&rim_circle(rim), half)], normal);
        let mut windows = vec![at(&hub_circle(hub + 1.5), web_half)];
        windows.extend(holes.iter().map(|hole| at(hole, web_half)));
        builder.polygon(&at(&rim_circle(rim - 2.0), web_half), &windows, normal);
        builder.polygon(&at(&hub_circle(hub - 1.0), hub_half), &[at(bore, hub_half)], normal);
    }
    builder.band(&at_height(bore, hub_half), &at_height(bore, -hub_half));
    holes.iter().for_each(|h| builder.band(&at_height(h, web_half), &at_height(h, -web_half)));
}

/// Outline of a spur gear: involute flanks, tips one module above the pitch circle, roots 1.25 below.
fn tooth_outline(teeth: usize, module: f64, detail: Detail) -> Vec<DVec2> {
    let pitch = 0.5 * module * teeth as f64;
    let (base, tip, root) = (pitch * libm::cos(PRESSURE_ANGLE), pitch + module, pitch - 1.25 * module);
    let involute = |r: f64| {
        let t = libm::sqrt((r / base) * (r / base) - 1.0);
        t - libm::atan(t)
    };
    // Half of a tooth's width as an angle; a little play between the flanks.
    let half_angle = |r: f64| 0.49 * PI / teeth as f64 + involute(pitch) - involute(r);
    let steps = detail.steps(4.0);
    let start = base.max(root + 0.25 * module) * 1.0005;
    let mut flank: Vec<[f64; 2]> = vec![
        [root, half_angle(start) + 0.16 / teeth as f64 * PI],
        [0.6 * root + 0.4 * start, half_angle(start) + 0.02 * PI / teeth as f64],
    ];
    flank.extend((0..=steps).map(|i| start + (tip - start) * i as f64 / steps as f64).map(|r| [r, half_angle(r)]));
    let mut outline = Vec::new();
    for tooth in 0..teeth {
        let middle = TAU * tooth as f64 / teeth as f64;
        outline.extend(flank.iter().map(|&[r, a]| direction(middle - a) * r));
        outline.extend(flank.iter().rev().map(|&[r, a]| direction(middle + a) * r));
    }
    outline
}
