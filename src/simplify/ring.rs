//! The neighbourhood of an edge, gathered once per attempt.
//!
//! ```text
//!            w            u, v   ends of the edge; the new vertex x replaces both
//!          / | \          w      wing: the third vertex of a triangle on the edge
//!     a --/  |  \-- c     a … d  further neighbours
//!      \ /   |   \ /
//!       u ---e--- v       triangles on the edge:  uvw, vuw'       (they vanish)
//!      / \   |   / \      survivors of u:         uwa, uab', …    (u becomes x)
//!     b --\  |  /-- d     survivors of v:         vcw, …          (v becomes x)
//!          \ | /
//!            w'
//! ```
//!
//! On a surface with edges of three and more triangles, or none on one side, there are as many wings as triangles.

use super::surface::{Corner, Surface};
use crate::mesh::adjacency::NONE;

/// A vertex next to u, v or both.
#[derive(Debug, Clone, Copy)]
pub struct Neighbour {
    /// The vertex.
    pub vertex: u32,
    /// Its edges to u and to v, [`NONE`] where there is none.
    pub edges: [u32; 2],
    /// The triangles on these edges.
    pub triangle_counts: [u32; 2],
    /// How many triangles on the edge uv have it for their wing.
    pub wing_count: u32,
}

impl Neighbour {
    /// Whether it is next to both ends.
    pub fn is_common(&self) -> bool {
        self.edges[0] != NONE && self.edges[1] != NONE
    }
}

/// What surrounds an edge uv. A scratch area: [`Ring::gather`] fills it anew without allocating.
#[derive(Debug)]
pub struct Ring {
    /// u and v.
    pub ends: [u32; 2],
    /// Triangles on the edge.
    pub on_edge: Vec<u32>,
    /// Corners at u and at v of the triangles around them that are not on the edge.
    pub survivors: [Vec<Corner>; 2],
    /// The vertices next to u or v.
    pub neighbours: Vec<Neighbour>,
    /// Survivors that the collapse lays onto another one, and that vanish with it.
    pub covered: Vec<u32>,
    /// How many pairs in `covered` lie back to back; every other one is a repetition of a survivor that stays.
    pub cancelled_pairs: usize,
    /// For each vertex its place in `neighbours`, if that place holds it.
    slots: Vec<u32>,
}

impl Ring {
    /// An empty ring for a surface of so many vertices.
    pub fn new(vertex_count: usize) -> Self {
        Self {
            ends: [NONE; 2],
            on_edge: Vec::new(),
            survivors: [Vec::new(), Vec::new()],
            neighbours: Vec::new(),
            covered: Vec::new(),
            cancelled_pairs: 0,
            slots: vec![0; vertex_count],
        }
    }

    /// Looks around the edge between `ends`.
    pub fn gather(&mut self, surface: &Surface, ends: [u32; 2]) {
        self.ends = ends;
        self.on_edge.clear();
        self.neighbours.clear();
        for (side, end) in ends.into_iter().enumerate() {
            self.survivors[side].clear();
            for corner in surface.corners(end) {
                self.sort_in(surface, side, corner);
            }
        }
        self.find_covered(surface);
    }

    /// Triangles that the collapse removes.
    pub fn removed_count(&self) -> usize {
        self.on_edge.len() + self.covered.len()
    }

    /// Survivors that the collapse does not remove, with the side they are on.
    pub fn lasting(&self) -> impl Iterator<Item = (usize, Corner)> + '_ {
        let side = |side: usize| self.survivors[side].iter().map(move |&corner| (side, corner));
        side(0).chain(side(1)).filter(|(_, corner)| !self.covered.contains(&corner.triangle))
    }

    /// The record of a vertex next to u or v.
    pub fn neighbour(&self, vertex: u32) -> &Neighbour {
        &self.neighbours[self.slots[vertex as usize] as usize]
    }

    fn sort_in(&mut self, surface: &Surface, side: usize, corner: Corner) {
        let triangle = surface.triangle(corner.triangle);
        let other_end = self.ends[1 - side];
        let [k1, k2] = corner.others();
        let on_edge = triangle.vertices[k1] == other_end || triangle.vertices[k2] == other_end;
        // The edge from the end to one of the two other corners lies opposite the other of them.
        for (to, opposite) in [(k1, k2), (k2, k1)] {
            if triangle.vertices[to] != other_end {
                let neighbour = self.note(side, triangle.vertices[to], triangle.edges[opposite]);
                neighbour.wing_count += u32::from(on_edge && side == 0);
            }
        }
        if !on_edge {
            self.survivors[side].push(corner);
        } else if side == 0 {
            self.on_edge.push(corner.triangle);
        }
    }

    fn note(&mut self, side: usize, vertex: u32, edge: u32) -> &mut Neighbour {
        let slot = self.slots[vertex as usize] as usize;
        let known = self.neighbours.get(slot).is_some_and(|n| n.vertex == vertex);
        let slot = if known { slot } else { self.neighbours.len() };
        if !known {
            self.slots[vertex as usize] = slot as u32;
            self.neighbours.push(Neighbour { vertex, edges: [NONE; 2], triangle_counts: [0; 2], wing_count: 0 });
        }
        let neighbour = &mut self.neighbours[slot];
        neighbour.edges[side] = edge;
        neighbour.triangle_counts[side] += 1;
        neighbour
    }

    /// Finds the triangles uab and vab (either way round) that become one and the same.
    fn find_covered(&mut self, surface: &Surface) {
        self.covered.clear();
        self.cancelled_pairs = 0;
        for i in 0..self.survivors[0].len() {
            let corner = self.survivors[0][i];
            let link = link_edge(surface, corner);
            if link.iter().all(|&vertex| self.neighbour(vertex).is_common()) {
                self.cover(surface, corner, link);
            }
        }
    }

    fn cover(&mut self, surface: &Surface, corner: Corner, [a, b]: [u32; 2]) {
        let partner = |turned: bool| {
            let wanted = if turned { [b, a] } else { [a, b] };
            self.survivors[1]
                .iter()
                .find(|&&c| link_edge(surface, c) == wanted && !self.covered.contains(&c.triangle))
                .map(|c| c.triangle)
        };
        if let Some(back) = partner(true) {
            self.covered.extend([corner.triangle, back]);
            self.cancelled_pairs += 1;
        } else if partner(false).is_some() {
            self.covered.push(corner.triangle);
        }
    }
}

/// The two other vertices of a corner's triangle, in its winding.
fn link_edge(surface: &Surface, corner: Corner) -> [u32; 2] {
    corner.others().map(|k| surface.triangle(corner.triangle).vertices[k])
}
