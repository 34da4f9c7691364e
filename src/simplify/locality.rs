//! Numbers under which neighbours in space are neighbours in memory.
//!
//! A collapse touches a few dozen records around one edge, and the next collapse is somewhere else: what it costs is
//! mostly waiting for memory. In the order of the input these records may lie anywhere.

use glam::DVec3;

use super::frame::Frame;
use crate::error::{Error, Result};
use crate::geom::morton_code;
use crate::mesh::TriMesh;

/// The working number of each vertex and triangle of the input.
#[derive(Debug)]
pub struct Locality {
    /// Vertices along a Morton curve through the unit sphere; equal places in the order of the input.
    pub vertices: Vec<u32>,
    /// Triangles by the first of their vertices; equal ones in the order of the input.
    pub triangles: Vec<u32>,
}

impl Locality {
    /// The working numbers for `mesh`.
    pub fn of(mesh: &TriMesh, frame: &Frame) -> Self {
        let mut order: Vec<(u64, u32)> =
            mesh.positions().iter().zip(0..).map(|(&p, v)| (morton_code(frame.to_unit(p)), v)).collect();
        order.sort_unstable();
        let mut vertices = vec![0; order.len()];
        order.iter().zip(0..).for_each(|(&(_, v), number)| vertices[v as usize] = number);
        let triangles = number_by_first_vertex(mesh, &vertices);
        Self { vertices, triangles }
    }

    /// `mesh` under the working numbers.
    pub fn apply(&self, mesh: &TriMesh) -> Result<TriMesh> {
        let mut positions = vec![DVec3::ZERO; mesh.vertex_count()];
        mesh.positions().iter().zip(&self.vertices).for_each(|(&p, &v)| positions[v as usize] = p);
        let mut triangles = vec![[0; 3]; mesh.triangle_count()];
        for (triangle, &t) in mesh.triangles().iter().zip(&self.triangles) {
            triangles[t as usize] = triangle.map(|v| self.vertices[v as usize]);
        }
        TriMesh::new(positions, triangles)
            .map_err(|source| Error::Mesh { place: "the reordered mesh".to_owned(), source })
    }
}

/// Numbers triangles by the smallest working number of their vertices, by counting.
fn number_by_first_vertex(mesh: &TriMesh, vertices: &[u32]) -> Vec<u32> {
    let first = |t: &[u32; 3]| t.iter().map(|&v| vertices[v as usize] as usize).min().unwrap_or(0);
    let mut starts = vec![0u32; vertices.len() + 1];
    mesh.triangles().iter().for_each(|t| starts[first(t) + 1] += 1);
    (1..starts.len()).for_each(|v| starts[v] += starts[v - 1]);
    let next = |t: &[u32; 3]| {
        let number = &mut starts[first(t)];
        *number += 1;
        *number - 1
    };
    mesh.triangles().iter().map(next).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn working_numbers_name_each_once_and_keep_the_mesh() {
        let place = |v: u32| DVec3::new(f64::from(v * 7 % 11), f64::from(v * 5 % 11), f64::from(v * 3 % 11));
        let triangles: Vec<[u32; 3]> = (0..9).map(|t| [t, (t + 4) % 11, (t + 9) % 11]).collect();
        let mesh = TriMesh::new((0..11).map(place).collect(), triangles.clone()).unwrap();
        let locality = Locality::of(&mesh, &Frame::of(&mesh));
        let sorted = locality.apply(&mesh).unwrap();
        for (t, triangle) in triangles.iter().enumerate() {
            let now = sorted.triangles()[locality.triangles[t] as usize];
            assert_eq!(now.map(|v| sorted.positions()[v as usize]), triangle.map(place));
        }
        let mut numbers = locality.triangles.clone();
        numbers.sort_unstable();
        assert_eq!(numbers, (0..9).collect::<Vec<u32>>());
    }
}
