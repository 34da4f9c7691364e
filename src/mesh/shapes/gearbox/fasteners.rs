//! Screws, washers and nuts.

use glam::{DVec2, DVec3};

use super::super::builder::{Builder, at_height};
use super::super::outline::circle;
use super::housing::{PORT_AT, TOP, bolt_centres, port_studs, wall_frame};
use super::solid::{along, extrude, ring};
use super::{CASE_END, Detail, FLANGE, JOINT, Parts, belt};
use crate::mesh::TriMesh;

pub(super) fn add(parts: &mut Parts, detail: Detail) {
    let belt = belt(detail);
    let washer = ring([4.2, 8.0], [0.0, 1.6], detail.around(8.0));
    let bolt = socket_screw(4.0, 2.0 * FLANGE + 12.0, detail);
    let nut =
        extrude(&circle(DVec2::ZERO, 7.5, 6, 0.0), &[circle(DVec2::ZERO, 3.6, detail.around(3.6), 0.2)], [0.0, 6.5]);
    for (i, &centre) in bolt_centres(&belt).iter().enumerate() {
        let head = centre.extend(JOINT + FLANGE + 0.05);
        let tail = centre.extend(JOINT - FLANGE - 0.05);
        parts.add(format!("joint washer {i} head"), &washer, &along(head, DVec3::Z));
        parts.add(format!("joint bolt {i}"), &bolt, &along(head + DVec3::Z * 1.6, DVec3::Z));
        parts.add(format!("joint washer {i} nut"), &washer, &along(tail, DVec3::NEG_Z));
        parts.add(format!("joint nut {i}"), &nut, &along(tail - DVec3::Z * 1.6, DVec3::NEG_Z));
    }
    let frame = wall_frame(&belt, TOP, PORT_AT + DVec2::new(0.0, CASE_END), 7.0);
    // Four of the lid's studs are still in place.
    for (i, &centre) in port_studs().iter().enumerate().filter(|(i, _)| i % 3 == 0) {
        let stud = screw_body(2.4, [-12.0, 11.0], detail);
        parts.add(format!("port stud {i}"), &stud, &(frame * along(centre.extend(0.0), DVec3::Z)));
    }
}

/// Cap screw with a hexagon socket: thread radius and length; the underside of its head is at 0, the head above.
pub(super) fn socket_screw(radius: f64, length: f64, detail: Detail) -> TriMesh {
    let mut builder = Builder::default();
    let (head, height) = (1.62 * radius, 2.0 * radius);
    let chamfer = 0.12 * radius;
    let round = |r: f64, z: f64| at_height(&circle(DVec2::ZERO, r, detail.around(head), 0.0), z);
    let socket = |z: f64| at_height(&circle(DVec2::ZERO, 0.86 * radius, 6, 0.1), z);
    let floor = 0.45 * height;
    builder.band(&round(head, 0.0), &round(head, height - chamfer));
    builder.band(&round(head, height - chamfer), &round(head - chamfer, height));
    builder.polygon(&round(head - chamfer, height), &[socket(height)], DVec3::Z);
    builder.band(&socket(height), &socket(floor));
    builder.polygon(&socket(floor), &[], DVec3::Z);
    thread(&mut builder, radius, length, &round(head, 0.0), detail);
    builder.finish()
}

/// Hexagon screw: thread radius and length; the underside of its head is at 0, the head above, with a collar.
pub(super) fn hex_screw(radius: f64, length: f64, detail: Detail) -> TriMesh {
    let mut builder = Builder::default();
    let (across, height, collar) = (1.75 * radius, 1.3 * radius, 2.1 * radius);
    let round = |r: f64, z: f64| at_height(&circle(DVec2::ZERO, r, detail.around(collar), 0.0), z);
    let hexagon = |z: f64| at_height(&circle(DVec2::ZERO, across, 6, 0.1), z);
    let lip = 0.25 * radius;
    builder.band(&round(collar, 0.0), &round(collar, lip));
    builder.polygon(&round(collar, lip), &[hexagon(lip)], DVec3::Z);
    builder.band(&hexagon(lip), &hexagon(height));
    builder.polygon(&hexagon(height), &[], DVec3::Z);
    thread(&mut builder, radius, length, &round(collar, 0.0), detail);
    builder.finish()
}

/// A stud: a thread between two heights with flat ends.
fn screw_body(radius: f64, [low, high]: [f64; 2], detail: Detail) -> TriMesh {
    let section =
        [(0.0, low), (radius - 0.4, low), (radius, low + 0.4), (radius, high - 0.4), (radius - 0.4, high), (0.0, high)];
    super::super::revolve::revolve_closed(&section.map(DVec2::from), detail.around(radius))
}

/// The underside of a head with its rim `under`, and below it a shank that ends in turns of a ridged thread.
fn thread(builder: &mut Builder, radius: f64, length: f64, under: &[DVec3], detail: Detail) {
    let round = |r: f64, z: f64| at_height(&circle(DVec2::ZERO, r, detail.around(radius), 0.2), z);
    builder.polygon(under, &[round(radius, 0.0)], DVec3::NEG_Z);
    let pitch = 0.5 * radius;
    let ridges = (0.45 * length / pitch) as usize;
    let smooth = length - ridges as f64 * pitch;
    let mut above = round(radius, 0.0);
    for i in 0..ridges {
        let top = -(smooth + i as f64 * pitch);
        for (r, z) in [(radius, top), (0.86 * radius, top - 0.5 * pitch)] {
            let below = round(r, z);
            builder.band(&below, &above);
            above = below;
        }
    }
    let tip = round(0.8 * radius, -length);
    builder.band(&tip, &above);
    builder.polygon(&tip, &[], DVec3::NEG_Z);
}

/// Centres of `count` screws on a circle.
pub(super) fn on_circle(radius: f64, count: usize, phase_rad: f64) -> Vec<DVec2> {
    circle(DVec2::ZERO, radius, count, phase_rad).into_iter().take(count).collect()
}
