//! The castings: case and cover, their bosses, ribs, fins and feet.

use std::f64::consts::FRAC_PI_2;

use glam::{DAffine3, DVec2, DVec3};

use super::super::builder::{Builder, at_height};
use super::super::outline::{BeltOutline, bent_slot, circle, rounded_rectangle};
use super::super::revolve::{arc, direction, revolve_closed};
use super::solid::{at, extrude, facing, mirrored};
use super::{AXLES, Axle, CASE_END, COVER_END, Detail, FLANGE, JOINT, Parts, WALL, belt};
use crate::mesh::TriMesh;

/// Radius of the rounded edge between end face and wall, outside and inside.
const OUTER_FILLET: f64 = 10.0;
const INNER_FILLET: f64 = 5.0;
/// Bolts round the joint, their distance from the wall and the radius of their holes.
const BOLTS: usize = 18;
const BOLT_OFFSET: f64 = 11.0;
const BOLT_HOLE: f64 = 4.5;
/// The straight side of the belt that faces up: from the output shaft back to the input shaft.
pub(super) const TOP: usize = 2;
/// The straight sides that face down, towards the input shaft and towards the output shaft.
const LOWER_LEFT: usize = 0;
const LOWER_RIGHT: usize = 1;
/// Half length along the wall, half width along w, and corner radius of the inspection port.
pub(super) const PORT: [f64; 3] = [60.0, 40.0, 12.0];
/// Middle of the port: along the top side from its corner at the output shaft, and above the case's end.
pub(super) const PORT_AT: DVec2 = DVec2::new(72.0, 61.0);

pub(super) fn add(parts: &mut Parts, detail: Detail) {
    let belt = belt(detail);
    parts.add("case", &case(&belt, detail), &DAffine3::from_translation(DVec3::Z * CASE_END));
    parts.add("cover", &cover(&belt, detail), &mirrored(COVER_END));
    for axle in &AXLES {
        parts.add(format!("case boss {}", axle.name), &boss(axle, detail), &at(axle.centre, CASE_END));
        let on_cover = at(axle.centre, 0.0) * mirrored(COVER_END);
        parts.add(format!("cover boss {}", axle.name), &boss(axle, detail), &on_cover);
    }
    add_end_ribs(parts);
    add_fins(parts, &belt);
    add_feet(parts, &belt, detail);
    add_port_frame(parts, &belt, detail);
    add_inside(parts, &belt, detail);
}

/// One half of the housing: a cup with its floor at 0 and its flange at `depth`.
struct Cup<'a> {
    belt: &'a BeltOutline,
    depth: f64,
    floor_holes: Vec<Vec<DVec2>>,
    /// Holes in straight sides of the belt: the side, and outlines in (along the side, height).
    wall_holes: Vec<(usize, Vec<Vec<DVec2>>)>,
}

fn case(belt: &BeltOutline, detail: Detail) -> TriMesh {
    let mut top = vec![port_outline(PORT_AT, 0.0, detail)];
    for i in 0..3 {
        // Each slot a little shorter and higher than the last, so that no three corners of the side lie in line.
        let i = f64::from(i);
        let middle = DVec2::new(153.0 + 8.0 * i, 58.0 + 0.7 * i);
        top.push(rounded_rectangle(middle, DVec2::new(2.5, 34.0 - 1.7 * i), 2.4, detail.steps(4.0)));
    }
    let mut floor_holes = bores(detail);
    floor_holes.extend(end_vents(detail));
    let wall_holes = vec![(LOWER_LEFT, wall_vents(78.0, detail)), (LOWER_RIGHT, wall_vents(102.0, detail)), (TOP, top)];
    cup(&Cup { belt, depth: JOINT - CASE_END, floor_holes, wall_holes }, detail)
}

fn cover(belt: &BeltOutline, detail: Detail) -> TriMesh {
    let mut floor_holes = bores(detail);
    floor_holes.extend(end_vents(detail));
    cup(&Cup { belt, depth: COVER_END - JOINT, floor_holes, wall_holes: Vec::new() }, detail)
}

/// Ventilation slots across a side of the given length, between the webs of the feet.
fn wall_vents(length: f64, detail: Detail) -> Vec<Vec<DVec2>> {
    const PITCH: f64 = 11.0;
    let count = (length / PITCH) as usize - 1;
    let slot = |i: usize| {
        // Slots swell towards the middle of the row, so that no three of their corners lie in line.
        let from_middle = i as f64 - 0.5 * (count as f64 - 1.0);
        let half = DVec2::new(3.3, 29.0 - 0.3 * from_middle * from_middle);
        let middle = DVec2::new(0.5 * length + PITCH * from_middle, 58.0 + 0.2 * from_middle);
        rounded_rectangle(middle, half, 3.1, detail.steps(4.0))
    };
    (0..count).map(slot).collect()
}

/// Outline of the inspection port round `middle`, `wider` than the hole in the wall.
pub(super) fn port_outline(middle: DVec2, wider: f64, detail: Detail) -> Vec<DVec2> {
    let [half_length, half_width, radius] = PORT;
    let half = DVec2::new(half_length, half_width) + DVec2::splat(wider);
    rounded_rectangle(middle, half, radius + wider, detail.steps(8.0))
}

/// Holes of the end faces for the bosses, which overlap their edges.
fn bores(detail: Detail) -> Vec<Vec<DVec2>> {
    let bore = |axle: &Axle| circle(axle.centre, axle.bearing + 5.0, detail.around(axle.bearing), 0.1);
    AXLES.iter().map(bore).collect()
}

/// Bent ventilation slots of the end faces, round the output shaft and between the ribs.
fn end_vents(detail: Detail) -> Vec<Vec<DVec2>> {
    let slot = |i: usize| {
        let middle = (40.0 * (i as f64 - 1.0)).to_radians();
        let half = 10.0_f64.to_radians();
        bent_slot(AXLES[2].centre, 72.0, [middle - half, middle + half], 8.5, detail.steps(7.0))
    };
    (0..5).map(slot).collect()
}

fn cup(cup: &Cup<'_>, detail: Detail) -> TriMesh {
    let mut builder = Builder::default();
    let bolts = bolt_circles(cup.belt, detail);
    let rim = flange_outline(cup.belt, detail);
    let flange = cup.depth - FLANGE;
    let at = |[offset, z]: [f64; 2]| at_height(&cup.belt.offset(offset), z);

    // Outside: end face, rounded edge, wall.
    let outer = outer_edge(detail);
    cap(&mut builder, &at(outer[0]), &cup.floor_holes, 0.0, DVec3::NEG_Z);
    outer.windows(2).for_each(|pair| builder.band(&at(pair[0]), &at(pair[1])));
    let foot = outer[outer.len() - 1];
    wall(&mut builder, cup, [&at(foot), &at([0.0, flange])], 0.0);

    // Flange: underside, rim, joint face, bolt holes.
    let mut holes = vec![cup.belt.offset(0.0)];
    holes.extend(bolts.iter().cloned());
    cap(&mut builder, &at_height(&rim, flange), &holes, flange, DVec3::NEG_Z);
    builder.band(&at_height(&rim, flange), &at_height(&rim, cup.depth));
    holes[0] = cup.belt.offset(-WALL);
    cap(&mut builder, &at_height(&rim, cup.depth), &holes, cup.depth, DVec3::Z);
    bolts.iter().for_each(|b| builder.band(&at_height(b, cup.depth), &at_height(b, flange)));

    // Inside: wall, rounded edge, floor.
    let inner = inner_edge(detail);
    wall(&mut builder, cup, [&at([-WALL, cup.depth]), &at(inner[0])], WALL);
    inner.windows(2).for_each(|pair| builder.band(&at(pair[0]), &at(pair[1])));
    cap(&mut builder, &at(inner[inner.len() - 1]), &cup.floor_holes, WALL, DVec3::Z);
    cup.floor_holes.iter().for_each(|h| builder.band(&at_height(h, WALL), &at_height(h, 0.0)));
    wall_hole_sides(&mut builder, cup);
    builder.finish()
}

/// Sections of the rounded edges as (offset from the belt, height), in the direction of the surface.
fn outer_edge(detail: Detail) -> Vec<[f64; 2]> {
    let centre = DVec2::new(-OUTER_FILLET, OUTER_FILLET);
    arc(centre, OUTER_FILLET, [-FRAC_PI_2, 0.0], detail.steps(6.0)).iter().map(|p| p.to_array()).collect()
}

fn inner_edge(detail: Detail) -> Vec<[f64; 2]> {
    let centre = DVec2::new(-WALL - INNER_FILLET, WALL + INNER_FILLET);
    arc(centre, INNER_FILLET, [0.0, -FRAC_PI_2], detail.steps(4.0)).iter().map(|p| p.to_array()).collect()
}

/// A flat face at height `z`.
fn cap(builder: &mut Builder, outline: &[DVec3], holes: &[Vec<DVec2>], z: f64, normal: DVec3) {
    let holes: Vec<Vec<DVec3>> = holes.iter().map(|hole| at_height(hole, z)).collect();
    builder.polygon(outline, &holes, normal);
}

/// The wall between two loops, its straight sides with their holes; it lies `inset` inside the belt.
fn wall(builder: &mut Builder, cup: &Cup<'_>, [from, to]: [&[DVec3]; 2], inset: f64) {
    let count = from.len();
    for i in 0..count {
        let j = (i + 1) % count;
        let holes: Vec<Vec<DVec3>> = cup
            .wall_holes
            .iter()
            .filter(|(side, _)| cup.belt.straight(*side) == i)
            .flat_map(|(side, outlines)| outlines.iter().map(|outline| on_wall(cup.belt, *side, outline, inset)))
            .collect();
        let facing_out = if inset == 0.0 { 1.0 } else { -1.0 };
        if holes.is_empty() {
            builder.quad([from[i], from[j], to[j], to[i]]);
        } else {
            let normal = cup.belt.normal(i).extend(0.0) * facing_out;
            builder.polygon(&[from[i], from[j], to[j], to[i]], &holes, normal);
        }
    }
}

fn wall_hole_sides(builder: &mut Builder, cup: &Cup<'_>) {
    for (side, outlines) in &cup.wall_holes {
        for outline in outlines {
            builder.band(&on_wall(cup.belt, *side, outline, 0.0), &on_wall(cup.belt, *side, outline, WALL));
        }
    }
}

/// Points given as (along the straight side, height), `inset` inside the belt.
fn on_wall(belt: &BeltOutline, side: usize, outline: &[DVec2], inset: f64) -> Vec<DVec3> {
    let frame = wall_frame(belt, side, DVec2::ZERO, -inset);
    outline.iter().map(|p| frame.transform_point3(p.extend(0.0))).collect()
}

/// Frame on a straight side of the belt: x along it, y up w, z outward; `lift` above the surface at point `origin`.
pub(super) fn wall_frame(belt: &BeltOutline, side: usize, origin: DVec2, lift: f64) -> DAffine3 {
    let corner = belt.straight(side);
    let normal = belt.normal(corner);
    let right = normal.perp();
    let base = belt.offset(lift)[corner] + right * origin.x;
    facing(base.extend(origin.y), right.extend(0.0), normal.extend(0.0))
}

/// Where the bolts of the joint stand.
pub(super) fn bolt_centres(belt: &BeltOutline) -> Vec<DVec2> {
    let walk = belt.walk(1.0);
    (0..BOLTS).map(|i| walk[(2 * i + 1) * walk.len() / (2 * BOLTS)]).map(|(p, n)| p + n * BOLT_OFFSET).collect()
}

fn bolt_circles(belt: &BeltOutline, detail: Detail) -> Vec<Vec<DVec2>> {
    let hole = |(i, &c): (usize, &DVec2)| circle(c, BOLT_HOLE, detail.around(BOLT_HOLE), 0.37 * i as f64);
    bolt_centres(belt).iter().enumerate().map(hole).collect()
}

/// Rim of the flange: a parallel of the belt with a lobe round every bolt.
fn flange_outline(belt: &BeltOutline, detail: Detail) -> Vec<DVec2> {
    const NARROW: f64 = 12.0;
    const LOBE: f64 = 9.0;
    const LOBE_HALF_WIDTH: f64 = 16.0;
    let bolts = bolt_centres(belt);
    let rise = |p: DVec2, n: DVec2| {
        let to_bolt = bolts.iter().map(|b| (p + n * BOLT_OFFSET - *b).length()).fold(f64::INFINITY, f64::min);
        let share = libm::cos(FRAC_PI_2 * (to_bolt / LOBE_HALF_WIDTH).min(1.0));
        if to_bolt < LOBE_HALF_WIDTH { LOBE * share * share } else { 0.0 }
    };
    let walk = belt.walk(2.5 / detail.0.min(1.5));
    let count = walk.len();
    let turns = |i: usize| walk[i].1 != walk[(i + count - 1) % count].1 || walk[i].1 != walk[(i + 1) % count].1;
    // Between lobes on a straight side only its ends are corners: points in line would be none.
    (0..count)
        .filter(|&i| turns(i) || rise(walk[i].0, walk[i].1) > 0.0)
        .map(|i| walk[i].0 + walk[i].1 * (NARROW + rise(walk[i].0, walk[i].1)))
        .collect()
}

/// Ring round a bearing, through the end face.
fn boss(axle: &Axle, detail: Detail) -> TriMesh {
    let (inner, outer) = (axle.bearing - 0.05, axle.bearing + 9.0);
    let section: Vec<DVec2> = [
        [inner + 1.5, -12.0],
        [outer - 1.5, -12.0],
        [outer, -10.5],
        [outer, -4.0],
        [outer + 1.2, -1.2],
        [outer + 4.0, 0.6],
        [outer + 4.0, 6.0],
        [outer, 10.0],
        [outer, 16.0],
        [outer - 2.0, 18.0],
        [inner + 1.0, 18.0],
        [inner, 17.0],
        [inner, -10.5],
    ]
    .map(DVec2::from)
    .to_vec();
    revolve_closed(&section, detail.around(outer))
}

/// Radial ribs on the end faces, from the bosses to the edge, inside and outside.
fn add_end_ribs(parts: &mut Parts) {
    const ANGLES: [&[f64]; 3] = [&[], &[240.0, 270.0, 300.0], &[-60.0, -20.0, 20.0, 60.0, 100.0]];
    for (axle, angles) in AXLES.iter().zip(ANGLES) {
        for (i, angle) in angles.iter().enumerate() {
            let outward = direction(angle.to_radians()).extend(0.0);
            // The rib's outline lies in (distance from the shaft, w); it is pulled to its thickness sideways.
            let frame = |w: f64, up: f64| facing_up(axle.centre.extend(w), outward, DVec3::Z * up);
            let (from, to) = (axle.bearing + 6.0, axle.chamber);
            let outer = extrude(&rib_outline(from, to + 3.0, 9.0), &[], [-3.0, 3.0]);
            let inner = extrude(&rib_outline(from, to + 3.0, 7.0), &[], [-2.5, 2.5]);
            parts.add(format!("case rib {} {i}", axle.name), &outer, &frame(CASE_END + 4.0, -1.0));
            parts.add(format!("cover rib {} {i}", axle.name), &outer, &frame(COVER_END - 4.0, 1.0));
            parts.add(format!("case inner rib {} {i}", axle.name), &inner, &frame(CASE_END + 4.0, 1.0));
            parts.add(format!("cover inner rib {} {i}", axle.name), &inner, &frame(COVER_END - 4.0, -1.0));
        }
    }
}

/// A rib from radius `from` to `to`, `height` above its root 4 mm inside the face, sloping off outward.
fn rib_outline(from: f64, to: f64, height: f64) -> Vec<DVec2> {
    let top = 4.0 + height;
    [[from, 0.0], [to - 8.0, 0.0], [to - 6.0, 4.5], [to - 14.0, 0.75 * top], [from, top]].map(DVec2::from).to_vec()
}

/// Frame with x along `right`, y along `up`.
fn facing_up(origin: DVec3, right: DVec3, up: DVec3) -> DAffine3 {
    facing(origin, right, right.cross(up))
}

/// Cooling fins round the ends of the case, running off to nothing.
fn add_fins(parts: &mut Parts, belt: &BeltOutline) {
    for (side, axle) in AXLES.iter().enumerate() {
        let first = (belt.straight((side + 2) % 3) + 1) % belt.len();
        let last = belt.straight(side);
        for i in 0..5 {
            let w = -58.0 + 17.0 * f64::from(i);
            let fin = extrude(&fin_outline(belt, [first, last]), &[], [w - 1.75, w + 1.75]);
            parts.add(format!("fin {} {i}", axle.name), &fin, &DAffine3::IDENTITY);
        }
    }
}

fn fin_outline(belt: &BeltOutline, [first, last]: [usize; 2]) -> Vec<DVec2> {
    const HEIGHT: f64 = 8.0;
    const RUN_OFF: f64 = 4.0;
    let (root, top) = (belt.offset(-3.0), belt.offset(HEIGHT));
    let height = |i: usize| {
        let to_end = (i - first).min(last - i) as f64;
        libm::sin(FRAC_PI_2 * (to_end / RUN_OFF).min(1.0))
    };
    let outer = (first..=last).map(|i| root[i].lerp(top[i], 0.45 + 0.55 * height(i)));
    outer.chain((first..=last).rev().map(|i| root[i])).collect()
}

/// Base plate, two webs across and gussets along the shafts.
fn add_feet(parts: &mut Parts, belt: &BeltOutline, detail: Detail) {
    const SOLE: f64 = -128.0;
    let middle = DVec2::new(4.0, -20.0);
    let half = DVec2::new(151.0, 66.0);
    let holes: Vec<Vec<DVec2>> = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .iter()
        .map(|s| circle(middle + DVec2::from(*s) * (half - DVec2::splat(17.0)), 7.0, detail.around(7.0), 0.2))
        .collect();
    let plate = extrude(&rounded_rectangle(middle, half, 14.0, detail.steps(8.0)), &holes, [0.0, 12.0]);
    // The plate is drawn in (u, w) and pulled up along v.
    let lying = facing(DVec3::Y * (SOLE + 12.0), DVec3::X, DVec3::NEG_Y);
    parts.add("base plate", &plate, &lying);
    let web = web_outline(belt, SOLE + 6.0);
    for (i, w) in [-60.0, 14.0].into_iter().enumerate() {
        parts.add(format!("foot web {i}"), &extrude(&web, &[], [w, w + 12.0]), &DAffine3::IDENTITY);
    }
    for axle in &AXLES[1..] {
        let top = axle.centre.y - axle.chamber - 0.5 * WALL;
        let outline = [[-5.0, SOLE + 6.0], [5.0, SOLE + 6.0], [5.0, top + 0.3], [-5.0, top + 0.3]].map(DVec2::from);
        let gusset = extrude(&outline, &[], [-72.0, 28.0]);
        parts.add(format!("foot gusset {}", axle.name), &gusset, &at(DVec2::new(axle.centre.x, 0.0), 0.0));
    }
}

/// A web from the sole to the middle of the wall above it.
fn web_outline(belt: &BeltOutline, sole: f64) -> Vec<DVec2> {
    let wall: Vec<DVec2> = belt.offset(-0.4 * WALL);
    let first = belt.straight(0);
    let last = belt.straight(1) + belt.len() / 8;
    let mut outline: Vec<DVec2> = (first..=last).rev().map(|i| wall[i]).collect();
    outline.push(DVec2::new(wall[first].x - 14.0, sole));
    outline.push(DVec2::new(wall[last].x + 4.0, sole));
    outline
}

/// Raised frame round the inspection port, with threaded holes for the lid that has been taken off.
fn add_port_frame(parts: &mut Parts, belt: &BeltOutline, detail: Detail) {
    let mut holes = vec![port_outline(DVec2::ZERO, -0.05, detail)];
    holes.extend(port_studs().iter().map(|&c| circle(c, 2.5, detail.around(2.5), 0.3)));
    let frame = extrude(&port_outline(DVec2::ZERO, 14.0, detail), &holes, [0.0, 9.0]);
    parts.add("port frame", &frame, &wall_frame(belt, TOP, PORT_AT + DVec2::new(0.0, CASE_END), -2.0));
}

/// Screw holes of the port frame.
pub(super) fn port_studs() -> Vec<DVec2> {
    let (x, y) = (PORT[0] + 7.0, PORT[1] + 7.0);
    let side = |i: i32| 0.5 * f64::from(i);
    let mut studs: Vec<DVec2> = (-1..=1).flat_map(|i| [[x * side(i), -y], [x * side(i), y]]).map(DVec2::from).collect();
    studs.extend([-1, 1].into_iter().flat_map(|i| [[-x, y * side(i)], [x, y * side(i)]]).map(DVec2::from));
    studs
}

/// What strengthens and guides inside: a frame round the case, and an oil trough under the output wheel.
fn add_inside(parts: &mut Parts, belt: &BeltOutline, detail: Detail) {
    let frame = extrude(&belt.offset(-0.75 * WALL), &[belt.offset(-WALL - 9.0)], [29.0, 33.0]);
    parts.add("inner frame", &frame, &DAffine3::IDENTITY);
    let angles = [205.0_f64, 325.0].map(f64::to_radians);
    let steps = detail.steps(28.0);
    let mut trough = arc(DVec2::ZERO, 88.0, angles, steps);
    trough.extend(arc(DVec2::ZERO, 86.0, [angles[1], angles[0]], steps));
    parts.add("oil trough", &extrude(&trough, &[], [-52.0, -8.0]), &at(AXLES[2].centre, 0.0));
}
