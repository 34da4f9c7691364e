//! A two-stage gearbox: the bundled model, an assembly as a CAD system would hand it over.
//!
//! Every part is a closed solid of its own, and parts run into each other where a casting would be one piece. Built in
//! millimetres in a frame of its own: u to the right, v up, w along the shafts; the finished model has its shafts
//! along x and stands on z.
//!
//! ```text
//!              inspection port            v
//!          ____====----------             |
//!        /  S1            S3  \           +-- u     w: towards the reader, out of the cover
//!        \____    S2         /
//!             ---______----      S1 input, S2 layshaft, S3 output
//! ```

mod fasteners;
mod fittings;
mod gears;
mod housing;
mod shafts;
mod solid;

use std::ops::Range;

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::outline::BeltOutline;
use super::transformed;
use crate::mesh::TriMesh;

/// A mesh made of named parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Assembly {
    /// All parts together.
    pub mesh: TriMesh,
    /// Name and triangles of each part, in order; together they cover the mesh. Each part is one closed solid.
    pub parts: Vec<(String, Range<usize>)>,
}

/// The gearbox, in millimetres; about 130,000 triangles at detail 1.
///
/// `detail` multiplies the corners of every circle (kept within 0.5 to 2). Coordinates are multiples of 1/1024 mm, so
/// that `f32` holds them exactly.
#[must_use]
pub fn gearbox(detail: f64) -> Assembly {
    let detail = Detail(detail.clamp(0.5, 2.0));
    let mut parts = Parts::default();
    housing::add(&mut parts, detail);
    shafts::add(&mut parts, detail);
    gears::add(&mut parts, detail);
    fasteners::add(&mut parts, detail);
    fittings::add(&mut parts, detail);
    parts.finish()
}

/// How finely circles are cut.
#[derive(Clone, Copy)]
struct Detail(f64);

impl Detail {
    /// Corners of a full circle of the given radius: more on larger ones, by the square root, a multiple of 4.
    fn around(self, radius: f64) -> usize {
        4 * self.steps(2.0 * radius.sqrt()).max(2)
    }

    /// `count` steps at detail 1, at least one.
    fn steps(self, count: f64) -> usize {
        (self.0 * count).round().max(1.0) as usize
    }
}

/// Collects parts in the finished model's frame.
#[derive(Default)]
struct Parts {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    named: Vec<(String, Range<usize>)>,
}

impl Parts {
    /// Adds a solid, placed in the (u, v, w) frame.
    fn add(&mut self, name: impl Into<String>, solid: &TriMesh, placement: &DAffine3) {
        // (u, v, w) becomes (y, z, x): a turn, exact in every coordinate.
        let standing = DAffine3::from_mat3(DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X)) * *placement;
        let placed = transformed(solid, &standing).expect("parts stay within a metre of the origin");
        let offset = u32::try_from(self.positions.len()).expect("a gearbox has far fewer vertices than 2^32");
        let start = self.triangles.len();
        self.positions.extend(placed.positions().iter().map(|&p| on_grid(p)));
        self.triangles.extend(placed.triangles().iter().map(|t| t.map(|v| v + offset)));
        self.named.push((name.into(), start..self.triangles.len()));
    }

    fn finish(self) -> Assembly {
        let mesh = TriMesh::new(self.positions, self.triangles).expect("every part is a valid mesh");
        Assembly { mesh, parts: self.named }
    }
}

/// The nearest multiple of 1/1024 mm.
fn on_grid(p: DVec3) -> DVec3 {
    (p * 1024.0).round() / 1024.0 + DVec3::ZERO
}

/// One of the three shafts: where it runs, and its bearings.
struct Axle {
    name: &'static str,
    centre: DVec2,
    /// Inner radius of the housing round this shaft.
    chamber: f64,
    /// Outer radius of its bearings.
    bearing: f64,
    /// Inner radius of its bearings.
    seat: f64,
}

/// Input, layshaft, output; the distances are those of the gear pairs in [`gears`].
const AXLES: [Axle; 3] = [
    Axle { name: "input", centre: DVec2::new(-102.5, 18.25), chamber: 44.0, bearing: 26.0, seat: 12.5 },
    Axle { name: "layshaft", centre: DVec2::new(-25.0, -10.0), chamber: 70.0, bearing: 26.0, seat: 12.5 },
    Axle { name: "output", centre: DVec2::new(79.0, 4.5), chamber: 92.0, bearing: 40.0, seat: 20.0 },
];

/// Thickness of the housing's walls.
const WALL: f64 = 8.0;
/// The case's outer end face, the joint between case and cover, and the cover's outer end face, along w.
const CASE_END: f64 = -75.0;
const JOINT: f64 = 40.0;
const COVER_END: f64 = 75.0;
/// Thickness of each of the two flanges at the joint.
const FLANGE: f64 = 10.0;

/// The outer surface of the housing, seen along the shafts.
fn belt(detail: Detail) -> BeltOutline {
    let circles = AXLES.map(|axle| (axle.centre, axle.chamber + WALL));
    BeltOutline::new(&circles, std::f64::consts::TAU / detail.around(110.0) as f64)
}
