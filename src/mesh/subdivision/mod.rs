use std::collections::HashMap;

use glam::DVec3;

use super::{MAX_TRIANGLES, TriMesh, TriangleId};
use crate::error::{Error, Result};

#[cfg(test)]
mod tests;

/// A mesh cut into pieces with short edges, each piece with the triangle that it is a part of.
///
/// Source: Zhang & Turk 2002, section 4, says that large triangles are subdivided, not how. An edge is halved or not by
/// its length alone, so both triangles beside it agree and the pieces meet edge to edge.
#[derive(Debug, Clone, PartialEq)]
pub struct Subdivision {
    mesh: TriMesh,
    origins: Vec<Origin>,
}

/// Where a piece comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Origin {
    parent: TriangleId,
    /// The piece has 2^-`halvings` of its parent's area.
    halvings: u8,
}

impl Subdivision {
    /// Cuts `mesh` until no edge is longer than `longest` (model units), into at most `most` pieces.
    ///
    /// The vertices of `mesh` keep their numbers; the pieces of a triangle stand together, in the order of the triangles.
    ///
    /// # Errors
    /// [`Error::Limit`] if that makes more than `most` pieces, or more than can be numbered; found out by counting, before
    /// the memory is taken.
    pub fn of(mesh: &TriMesh, longest: f64, most: usize) -> Result<Self> {
        let origin = |t| Origin { parent: TriangleId(t), halvings: 0 };
        let mut cut = Self { mesh: mesh.clone(), origins: (0..mesh.triangle_count() as u32).map(origin).collect() };
        loop {
            let positions = cut.mesh.positions();
            let long = |&t: &[u32; 3]| edges(t).into_iter().filter(|&e| is_long(e, positions, longest)).count();
            let added: usize = cut.mesh.triangles().iter().map(long).sum();
            if added == 0 {
                return Ok(cut);
            }
            cut.check(added, most)?;
            cut.halve_long_edges(longest, added);
        }
    }

    /// About how many pieces cutting `mesh` makes, without cutting it: as if every cut of a triangle shortened all its edges
    /// alike.
    #[must_use]
    pub fn estimate(mesh: &TriMesh, longest: f64) -> f64 {
        let of_triangle = |&triangle: &[u32; 3]| {
            let positions = mesh.positions();
            let mut lengths = edges(triangle).map(|[a, b]| (positions[a as usize] - positions[b as usize]).length());
            let mut pieces = 1.0;
            loop {
                // Each long edge of a piece makes one piece more.
                let long = lengths.iter().filter(|&&length| length > longest).count();
                if long == 0 || !f64::is_finite(pieces) {
                    return pieces;
                }
                pieces *= 1.0 + long as f64;
                lengths = lengths.map(|length| 0.5 * length);
            }
        };
        mesh.triangles().iter().map(of_triangle).sum()
    }

    /// The pieces as a mesh.
    #[must_use]
    pub fn mesh(&self) -> &TriMesh {
        &self.mesh
    }

    /// The triangle that a piece is a part of; a piece of a lower number never has a higher parent.
    #[must_use]
    pub fn parent(&self, piece: TriangleId) -> TriangleId {
        self.origins[piece.0 as usize].parent
    }

    /// The share of its parent's area that a piece has: a power of two, so that the shares of a triangle add up to
    /// exactly 1.
    #[must_use]
    pub fn share(&self, piece: TriangleId) -> f64 {
        0.5_f64.powi(i32::from(self.origins[piece.0 as usize].halvings))
    }

    /// Every long edge of every piece makes one piece more, and at most one vertex.
    fn check(&self, added: usize, most: usize) -> Result<()> {
        let (pieces, vertices) = (self.mesh.triangle_count() + added, self.mesh.vertex_count() + added);
        if pieces <= most.min(MAX_TRIANGLES) && vertices <= u32::MAX as usize {
            return Ok(());
        }
        let message = format!(
            "cutting the triangles for pictures this fine makes more than {} pieces of them, of which {} are allowed; \
             lower --resolution, raise --memory-limit, or take --estimator coverage, which cuts nothing",
            pieces - 1,
            most.min(MAX_TRIANGLES)
        );
        Err(Error::Limit { message })
    }

    fn halve_long_edges(&mut self, longest: f64, added: usize) {
        let mut triangles = Vec::with_capacity(self.mesh.triangle_count() + added);
        let mut origins = Vec::with_capacity(triangles.capacity());
        let mut midpoints = Midpoints { positions: &mut self.mesh.positions, known: HashMap::new() };
        for (&triangle, &origin) in self.mesh.triangles.iter().zip(&self.origins) {
            for (corners, halvings) in pieces(triangle, &mut midpoints, longest) {
                triangles.push(corners);
                origins.push(Origin { halvings: origin.halvings + halvings, ..origin });
            }
        }
        self.mesh.triangles = triangles;
        self.origins = origins;
    }
}

fn edges([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// The same answer for an edge from either end.
fn is_long([a, b]: [u32; 2], positions: &[DVec3], longest: f64) -> bool {
    let (a, b) = (positions[a as usize], positions[b as usize]);
    // Divided before it is squared: squares of very small or large lengths would leave the range of numbers. Far from the
    // origin there may be no number between two ends; halving would never come to an end.
    ((a - b) / longest).length_squared() > 1.0 && ![a, b].contains(&(0.5 * a + 0.5 * b))
}

/// The vertices in the middle of edges: one for each edge, whichever triangle asks.
struct Midpoints<'a> {
    positions: &'a mut Vec<DVec3>,
    known: HashMap<[u32; 2], u32>,
}

impl Midpoints<'_> {
    /// The vertex in the middle of an edge that is too long.
    fn of(&mut self, [a, b]: [u32; 2], longest: f64) -> Option<u32> {
        is_long([a, b], self.positions, longest).then(|| {
            *self.known.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                self.positions.push(0.5 * self.positions[a as usize] + 0.5 * self.positions[b as usize]);
                self.positions.len() as u32 - 1
            })
        })
    }
}

/// The pieces that halving a triangle's long edges makes of it, each with how often its area was halved.
///
/// ```text
///        a              a                a
///       / \            / \              / \
///      m---\--        m---n            m---n
///     /  `  \        / `   \          / \ / \
///    b-------c      b-------c        b---k---c
///   one: m–c       two: the shorter    three
///                  of m–c and b–n
/// ```
fn pieces([a, b, c]: [u32; 3], midpoints: &mut Midpoints<'_>, longest: f64) -> impl Iterator<Item = ([u32; 3], u8)> {
    let [ab, bc, ca] = edges([a, b, c]).map(|edge| midpoints.of(edge, longest));
    let made = match (ab, bc, ca) {
        (None, None, None) => [Some(([a, b, c], 0)), None, None, None],
        (Some(m), None, None) => halves([a, b, c], m),
        (None, Some(m), None) => halves([b, c, a], m),
        (None, None, Some(m)) => halves([c, a, b], m),
        (Some(m), None, Some(n)) => thirds([a, b, c], [m, n], midpoints.positions),
        (Some(n), Some(m), None) => thirds([b, c, a], [m, n], midpoints.positions),
        (None, Some(n), Some(m)) => thirds([c, a, b], [m, n], midpoints.positions),
        (Some(m), Some(k), Some(n)) => {
            [Some(([a, m, n], 2)), Some(([m, b, k], 2)), Some(([n, k, c], 2)), Some(([m, k, n], 2))]
        }
    };
    made.into_iter().flatten()
}

type Made = [Option<([u32; 3], u8)>; 4];

fn halves([a, b, c]: [u32; 3], m: u32) -> Made {
    [Some(([a, m, c], 1)), Some(([m, b, c], 1)), None, None]
}

/// Cuts off the corner `a` at the midpoints `m` of a–b and `n` of c–a, and the rest along its shorter diagonal; of equal
/// ones along that which holds the smallest vertex number.
fn thirds([a, b, c]: [u32; 3], [m, n]: [u32; 2], positions: &[DVec3]) -> Made {
    let length = |p: u32, q: u32| (positions[p as usize] - positions[q as usize]).length();
    let (from_m, from_n) = (length(m, c), length(n, b));
    // Midpoints have higher numbers than the corners.
    let rest = if from_m < from_n || (from_m == from_n && c < b) {
        [([m, b, c], 1), ([m, c, n], 2)]
    } else {
        [([b, c, n], 1), ([m, b, n], 2)]
    };
    [Some(([a, m, n], 2)), Some(rest[0]), Some(rest[1]), None]
}
