use crate::mesh::TriMesh;

/// Which triangles meet at each vertex: the way from a triangle to its neighbours.
#[derive(Debug, Clone)]
pub struct VertexTriangles {
    /// Where each vertex's triangles start in `triangles`; one entry more than vertices.
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl VertexTriangles {
    /// The triangles around every vertex of `mesh`.
    #[must_use]
    pub fn of(mesh: &TriMesh) -> Self {
        let mut starts = vec![0; mesh.vertex_count() + 1];
        for &v in mesh.triangles().iter().flatten() {
            starts[v as usize + 1] += 1;
        }
        for v in 1..starts.len() {
            starts[v] += starts[v - 1];
        }
        let mut free = starts.clone();
        let mut triangles = vec![0; 3 * mesh.triangle_count()];
        for (t, corners) in (0..).zip(mesh.triangles()) {
            for &v in corners {
                triangles[free[v as usize] as usize] = t;
                free[v as usize] += 1;
            }
        }
        Self { starts, triangles }
    }

    /// Numbers of the triangles around a vertex, ascending.
    #[must_use]
    pub fn around(&self, vertex: u32) -> &[u32] {
        let v = vertex as usize;
        &self.triangles[self.starts[v] as usize..self.starts[v + 1] as usize]
    }

    /// The triangles that share a vertex with any of `triangles`, these included; sorted.
    ///
    /// Of a vertex with more than `most` triangles only the first `most` count.
    #[must_use]
    pub fn around_all(&self, mesh: &TriMesh, triangles: &[u32], most: usize) -> Vec<u32> {
        let corners = triangles.iter().flat_map(|&t| mesh.triangles()[t as usize]);
        let mut around: Vec<u32> = corners.flat_map(|v| self.around(v).iter().take(most)).copied().collect();
        around.sort_unstable();
        around.dedup();
        around
    }
}
