//! Surfaces that stand before each other without enclosing anything.

use glam::{DAffine3, DVec3};

use super::builder::Builder;
use super::revolve::direction;
use super::{Tagged, disc, moved, sheet, transformed, turned_over};
use crate::mesh::TriMesh;

/// Two unit squares face to face at distance `gap`, each in `n` × `n` cells: "lower" faces up, "upper" faces down.
#[must_use]
pub fn parallel_squares(gap: f64, n: usize) -> Tagged {
    facing(&sheet(1.0, 1.0, [n, n]), gap)
}

/// Two discs of the given radius on one axis, face to face at distance `gap`: "lower" faces up, "upper" faces down.
#[must_use]
pub fn coaxial_discs(radius: f64, gap: f64, [segments, rings]: [usize; 2]) -> Tagged {
    facing(&disc(radius, segments, rings), gap)
}

fn facing(lower: &TriMesh, gap: f64) -> Tagged {
    let upper = turned_over(&moved(lower, DVec3::Z * gap));
    Tagged::of(&[("lower", lower.clone()), ("upper", upper)], 0.0)
}

/// Two strips of width 1 that share an edge along y of the given length, at `angle_rad` to each other, inner sides in
/// front: "floor" and "wall". Cells: `across` on each width, `along` on the length.
///
/// The closed form for endless strips needs `length` far above 1; the ends lose about 1 / `length` of it.
#[must_use]
pub fn wedge(angle_rad: f64, length: f64, [across, along]: [usize; 2]) -> Tagged {
    let away = direction(angle_rad);
    let slope = DVec3::new(away.x, 0.0, away.y);
    let corner = DVec3::Y * (-0.5 * length);
    let strip = |edges: [DVec3; 2], cells: [usize; 2]| {
        let mut builder = Builder::default();
        builder.sheet(corner, edges, cells.map(|c| c.max(1)));
        builder.finish()
    };
    let along_y = DVec3::Y * length;
    let floor = strip([DVec3::X, along_y], [across, along]);
    let wall = strip([along_y, slope], [along, across]);
    Tagged::of(&[("floor", floor), ("wall", wall)], 0.0)
}

/// Two unit squares at 90° that share an edge, inner sides in front, `n` × `n` cells each: "floor" and "wall".
#[must_use]
pub fn right_angle_squares(n: usize) -> Tagged {
    let floor = moved(&sheet(1.0, 1.0, [n, n]), DVec3::new(0.5, 0.0, 0.0));
    // Turns the floor's +x into +z and its +z into +x, so that the wall stands on the shared edge and faces the floor.
    let upright = DAffine3::from_cols(DVec3::Z, DVec3::Y, DVec3::X, DVec3::ZERO);
    let wall = transformed(&floor, &upright).expect("a unit square stays one");
    Tagged::of(&[("floor", floor), ("wall", wall)], 0.0)
}
