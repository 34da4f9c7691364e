//! Boxes filled with random closed solids: no closed form is disturbed by what lies inside.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::cavity::together;
use super::{Tagged, cuboid, icosphere, moved, open_box, transformed};
use crate::mesh::TriMesh;

/// [`open_box`] with `count` random boxes and balls inside: "inside" (the box) and "clutter".
///
/// The pieces may run into each other, but stay inside the box; what is buried in another piece is seen by nobody.
#[must_use]
pub fn cluttered_open_box(seed: u64, count: usize, n: usize) -> Tagged {
    let open = open_box(n);
    Tagged::of(&[("inside", open.mesh), ("clutter", clutter(seed, count))], open.opening_area)
}

/// A closed unit cube with `count` random boxes and balls inside: "outside" and "clutter".
#[must_use]
pub fn cluttered_sealed_box(seed: u64, count: usize, n: usize) -> Tagged {
    let sealed = moved(&cuboid(DVec3::ONE, n), DVec3::splat(0.5));
    Tagged::of(&[("outside", sealed), ("clutter", clutter(seed, count))], 0.0)
}

/// At least one random closed solid, all within the unit cube from (0,0,0) to (1,1,1).
fn clutter(seed: u64, count: usize) -> TriMesh {
    let mut random = Pcg32::new(seed);
    let pieces: Vec<TriMesh> = (0..count.max(1)).map(|i| piece(i, &mut random)).collect();
    together(&pieces)
}

/// Piece `i`: boxes and balls by turns, with a circumscribed radius between 0.03 and 0.12.
fn piece(i: usize, random: &mut Pcg32) -> TriMesh {
    let radius = 0.03 + 0.09 * random.unit();
    let centre = DVec3::new(random.unit(), random.unit(), random.unit());
    let centre = DVec3::splat(0.13) + 0.74 * centre;
    let placed = |mesh: &TriMesh, scale: DVec3| {
        let turned = DMat3::from_quat(random.rotation()) * DMat3::from_diagonal(scale);
        transformed(mesh, &DAffine3::from_mat3_translation(turned, centre)).expect("clutter stays inside the unit cube")
    };
    if i.is_multiple_of(2) { boxed(radius, placed) } else { ball(radius, placed) }
}

fn boxed(radius: f64, placed: impl FnOnce(&TriMesh, DVec3) -> TriMesh) -> TriMesh {
    let edges = DVec3::new(1.0, 0.8, 0.5);
    placed(&cuboid(edges, 2), DVec3::splat(2.0 * radius / edges.length()))
}

fn ball(radius: f64, placed: impl FnOnce(&TriMesh, DVec3) -> TriMesh) -> TriMesh {
    placed(&icosphere(2), DVec3::splat(radius))
}

/// PCG-XSH-RR 64/32, the small generator of O'Neill, *PCG: A Family of Simple Fast Space-Efficient Statistically Good
/// Algorithms for Random Number Generation*, 2014.
struct Pcg32 {
    state: u64,
}

impl Pcg32 {
    const MULTIPLIER: u64 = 6_364_136_223_846_793_005;
    const INCREMENT: u64 = 1_442_695_040_888_963_407;

    fn new(seed: u64) -> Self {
        let mut random = Self { state: seed.wrapping_add(Self::INCREMENT) };
        random.next();
        random
    }

    fn next(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(Self::MULTIPLIER).wrapping_add(Self::INCREMENT);
        let mixed = (((old >> 18) ^ old) >> 27) as u32;
        mixed.rotate_right((old >> 59) as u32)
    }

    /// Uniform in `0.0..1.0`.
    fn unit(&mut self) -> f64 {
        f64::from(self.next()) / 4_294_967_296.0
    }

    /// A rotation without trigonometry: a random quaternion, kept away from zero by its last part.
    fn rotation(&mut self) -> DQuat {
        let mut part = || 2.0 * self.unit() - 1.0;
        let (x, y, z) = (part(), part(), part());
        DQuat::from_xyzw(x, y, z, 1.0).normalize()
    }
}
