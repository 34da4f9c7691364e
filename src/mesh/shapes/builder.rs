//! Collects triangles over welded vertices: patches that meet at equal positions become one surface.

use std::collections::HashMap;

use earcut::Earcut;
use glam::{DVec2, DVec3};

use crate::mesh::TriMesh;

/// Grows a mesh patch by patch; vertices at exactly equal positions are one.
#[derive(Default)]
pub(super) struct Builder {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    at: HashMap<[u64; 3], u32>,
}

impl Builder {
    /// Triangles so far.
    pub(super) fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The vertex at `p`, made where it is new.
    fn vertex(&mut self, p: DVec3) -> u32 {
        // Adding zero turns -0 into +0, so that both give one key.
        let p = p + DVec3::ZERO;
        let next = u32::try_from(self.positions.len()).expect("generated meshes stay far below 2^32 vertices");
        let vertex = *self.at.entry(p.to_array().map(f64::to_bits)).or_insert(next);
        if vertex == next {
            self.positions.push(p);
        }
        vertex
    }

    /// Adds a triangle, unless two of its corners are one vertex (at a pole, on an axis).
    pub(super) fn triangle(&mut self, corners: [DVec3; 3]) {
        let t = corners.map(|p| self.vertex(p));
        if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
            self.triangles.push(t);
        }
    }

    /// Adds a flat or nearly flat quad, counter-clockwise from outside, cut along its first diagonal.
    pub(super) fn quad(&mut self, [a, b, c, d]: [DVec3; 4]) {
        self.triangle([a, b, c]);
        self.triangle([a, c, d]);
    }

    /// Adds `n` × `m` quads spanned by the corner and two edges; its front side is that of `along_n` × `along_m`.
    pub(super) fn sheet(&mut self, corner: DVec3, [along_n, along_m]: [DVec3; 2], [n, m]: [usize; 2]) {
        let far = corner + along_n + along_m;
        self.patch([corner, corner + along_n, far, corner + along_m], [n, m]);
    }

    /// Adds `n` × `m` quads between four corners, counter-clockwise from outside; `n` counts along the first edge.
    pub(super) fn patch(&mut self, [a, b, c, d]: [DVec3; 4], [n, m]: [usize; 2]) {
        // Each side is interpolated from its own two ends alone, so that neighbours with the same corners share
        // vertices.
        let at = |i: usize, j: usize| between(between(a, b, i, n), between(d, c, i, n), j, m);
        for j in 0..m {
            for i in 0..n {
                self.quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }

    /// Adds the band between two closed loops of equal length; a loop of one point is the tip of a fan.
    ///
    /// Its front side is to the right of the way from `from` to `to`, for loops that turn counter-clockwise seen
    /// from ahead.
    pub(super) fn band(&mut self, from: &[DVec3], to: &[DVec3]) {
        let count = from.len().max(to.len());
        let at = |ring: &[DVec3], i: usize| ring[i % ring.len()];
        for i in 0..count {
            self.quad([at(from, i), at(from, i + 1), at(to, i + 1), at(to, i)]);
        }
    }

    /// Adds a flat polygon with holes, its front side along `normal`; the loops may turn either way.
    pub(super) fn polygon(&mut self, outline: &[DVec3], holes: &[Vec<DVec3>], normal: DVec3) {
        let (right, up) = normal.normalize().any_orthonormal_pair();
        let mut points: Vec<DVec3> = outline.to_vec();
        let mut hole_starts = Vec::new();
        for hole in holes {
            hole_starts.push(u32::try_from(points.len()).expect("a face has few vertices"));
            points.extend_from_slice(hole);
        }
        let flat = points.iter().map(|p| [p.dot(right), p.dot(up)]);
        let mut corners: Vec<u32> = Vec::new();
        Earcut::new().earcut(flat, &hole_starts, &mut corners);
        for t in corners.chunks_exact(3) {
            let [a, b, c] = [points[t[0] as usize], points[t[1] as usize], points[t[2] as usize]];
            let faces_along = (b - a).cross(c - a).dot(normal) > 0.0;
            self.triangle(if faces_along { [a, b, c] } else { [a, c, b] });
        }
    }

    /// The mesh.
    pub(super) fn finish(self) -> TriMesh {
        TriMesh::new(self.positions, self.triangles)
            .expect("builders are given finite points and at least one triangle")
    }
}

/// Point `i` of `n` on the way from `a` to `b`; exactly `a` and `b` at the ends, and the same from either end.
fn between(a: DVec3, b: DVec3, i: usize, n: usize) -> DVec3 {
    match i {
        0 => a,
        _ if i == n => b,
        _ => (a * (n - i) as f64 + b * i as f64) / n as f64,
    }
}

/// A plane loop at height `z`.
pub(super) fn at_height(outline: &[DVec2], z: f64) -> Vec<DVec3> {
    outline.iter().map(|p| p.extend(z)).collect()
}
