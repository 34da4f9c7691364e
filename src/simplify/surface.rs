//! The mesh while it shrinks.

use glam::DVec3;

use super::frame::Frame;
use crate::mesh::TriMesh;
use crate::mesh::adjacency::{CornerLists, Edges, NONE};

/// A triangle, together so that a step around a vertex touches one place in memory.
#[derive(Debug, Clone, Copy)]
pub struct Triangle {
    /// Its vertices; all [`NONE`] once it is gone.
    pub vertices: [u32; 3],
    /// The edges opposite its corners.
    pub edges: [u32; 3],
    /// For each corner the next corner at the same vertex.
    next: [u32; 3],
}

impl Triangle {
    /// Whether it is still part of the surface.
    pub fn is_alive(&self) -> bool {
        self.vertices[0] != NONE
    }
}

/// A corner of a triangle: the triangle's number and 0 to 2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Corner {
    /// The triangle.
    pub triangle: u32,
    /// Which of its corners.
    pub k: u8,
}

impl Corner {
    /// The two other corners of the triangle, in its winding.
    pub fn others(self) -> [usize; 2] {
        [(self.k as usize + 1) % 3, (self.k as usize + 2) % 3]
    }
}

/// Triangles, positions and who meets whom; edges are known by number only.
#[derive(Debug)]
pub struct Surface {
    /// Positions in unit-sphere coordinates.
    pub positions: Vec<DVec3>,
    /// Triangles by their number in the input.
    pub triangles: Vec<Triangle>,
    /// Triangles that are still there.
    pub alive: usize,
    first: Vec<u32>,
}

impl Surface {
    /// The surface of `mesh`, in the coordinates of `frame`.
    pub fn new(mesh: TriMesh, frame: &Frame, lists: CornerLists, edges: &Edges) -> Self {
        let (mut positions, triangles) = mesh.into_parts();
        positions.iter_mut().for_each(|p| *p = frame.to_unit(*p));
        let alive = triangles.len();
        let triangles = triangles.into_iter().zip(&edges.of_triangle).zip(lists.next);
        let triangles = triangles.map(|((vertices, &edges), next)| Triangle { vertices, edges, next }).collect();
        Self { positions, triangles, alive, first: lists.first }
    }

    /// The triangle's number `triangle`.
    pub fn triangle(&self, triangle: u32) -> &Triangle {
        &self.triangles[triangle as usize]
    }

    /// Positions of the corners of a triangle.
    pub fn corners_of(&self, triangle: u32) -> [DVec3; 3] {
        self.triangle(triangle).vertices.map(|v| self.positions[v as usize])
    }

    /// Whether any triangle uses the vertex.
    pub fn is_used(&self, vertex: u32) -> bool {
        self.first[vertex as usize] != NONE
    }

    /// The corners at a vertex.
    pub fn corners(&self, vertex: u32) -> impl Iterator<Item = Corner> + '_ {
        let mut at = self.first[vertex as usize];
        std::iter::from_fn(move || {
            if at == NONE {
                return None;
            }
            let corner = Corner { triangle: at / 3, k: (at % 3) as u8 };
            at = self.triangle(corner.triangle).next[corner.k as usize];
            Some(corner)
        })
    }

    /// Takes a triangle away, also from the lists of its vertices except `ends`, whose lists are about to be rewritten.
    pub fn remove_triangle(&mut self, triangle: u32, ends: [u32; 2]) {
        let vertices = self.triangle(triangle).vertices;
        for (k, vertex) in vertices.into_iter().enumerate() {
            if !ends.contains(&vertex) {
                self.unlink(vertex, 3 * triangle + k as u32);
            }
        }
        self.triangles[triangle as usize].vertices = [NONE; 3];
        self.alive -= 1;
    }

    fn unlink(&mut self, vertex: u32, corner: u32) {
        let next_of = |triangles: &[Triangle], c: u32| triangles[(c / 3) as usize].next[(c % 3) as usize];
        let after = next_of(&self.triangles, corner);
        let mut at = self.first[vertex as usize];
        if at == corner {
            self.first[vertex as usize] = after;
            return;
        }
        while at != NONE {
            let following = next_of(&self.triangles, at);
            if following == corner {
                self.triangles[(at / 3) as usize].next[(at % 3) as usize] = after;
                return;
            }
            at = following;
        }
    }

    /// Makes the list of `vertex` empty.
    pub fn clear_corners(&mut self, vertex: u32) {
        self.first[vertex as usize] = NONE;
    }

    /// Gives a corner to `vertex`.
    pub fn attach(&mut self, corner: Corner, vertex: u32) {
        let head = std::mem::replace(&mut self.first[vertex as usize], 3 * corner.triangle + u32::from(corner.k));
        let triangle = &mut self.triangles[corner.triangle as usize];
        triangle.vertices[corner.k as usize] = vertex;
        triangle.next[corner.k as usize] = head;
    }
}
