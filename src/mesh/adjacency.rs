//! Which triangles meet at a vertex, and which edges there are.

use super::TriMesh;

/// Stands for "no corner" and "no edge".
pub const NONE: u32 = u32::MAX;

/// For each vertex the corners that use it, as singly linked lists.
///
/// Corner `3 t + k` is the k-th corner of triangle `t`. The list of vertex `v` starts at `first[v]`, goes on with
/// `next[corner]`, ends at [`NONE`], and is in ascending order.
#[derive(Debug, Clone)]
pub struct CornerLists {
    /// First corner of each vertex, [`NONE`] for a vertex that no triangle uses.
    pub first: Vec<u32>,
    /// The corner after each corner.
    pub next: Vec<[u32; 3]>,
}

impl CornerLists {
    /// The corner lists of `mesh`, which has at most `u32::MAX / 3` triangles.
    #[must_use]
    pub fn of(mesh: &TriMesh) -> Self {
        debug_assert!(mesh.triangle_count() <= (u32::MAX / 3) as usize, "corners are numbered in 32 bits");
        let mut first = vec![NONE; mesh.vertex_count()];
        let mut next = vec![[NONE; 3]; mesh.triangle_count()];
        for (t, triangle) in mesh.triangles().iter().enumerate().rev() {
            for k in 0..3 {
                let head = &mut first[triangle[k] as usize];
                next[t][k] = *head;
                *head = (3 * t + k) as u32;
            }
        }
        Self { first, next }
    }

    /// The corners of `vertex`, as (triangle, corner 0 to 2 in it).
    pub fn corners(&self, vertex: u32) -> impl Iterator<Item = (usize, usize)> + '_ {
        let mut corner = self.first[vertex as usize];
        std::iter::from_fn(move || {
            if corner == NONE {
                return None;
            }
            let (t, k) = ((corner / 3) as usize, (corner % 3) as usize);
            corner = self.next[t][k];
            Some((t, k))
        })
    }
}

/// The edges of a mesh: unordered pairs of vertices that at least one triangle joins.
#[derive(Debug, Clone)]
pub struct Edges {
    /// The two vertices of each edge, smaller first; edges are in ascending order of the smaller.
    pub ends: Vec<[u32; 2]>,
    /// How many triangles lie on each edge.
    pub triangle_counts: Vec<u32>,
    /// Per triangle the edges opposite its corners.
    pub of_triangle: Vec<[u32; 3]>,
}

impl Edges {
    /// The edges of `mesh`, whose corner lists are `lists`. Time and memory are linear.
    #[must_use]
    pub fn of(mesh: &TriMesh, lists: &CornerLists) -> Self {
        let expected = mesh.triangle_count() + mesh.triangle_count() / 2;
        let mut edges = Self {
            ends: Vec::with_capacity(expected),
            triangle_counts: Vec::with_capacity(expected),
            of_triangle: vec![[NONE; 3]; mesh.triangle_count()],
        };
        // The edge last found at each larger end; it is one of the current smaller end if the edge says so.
        let mut latest = vec![NONE; mesh.vertex_count()];
        for vertex in 0..mesh.vertex_count() as u32 {
            for (t, k) in lists.corners(vertex) {
                let triangle = mesh.triangles()[t];
                for (to, opposite) in [((k + 1) % 3, (k + 2) % 3), ((k + 2) % 3, (k + 1) % 3)] {
                    if triangle[to] > vertex {
                        let edge = edges.find_or_add(vertex, triangle[to], &mut latest);
                        edges.of_triangle[t][opposite] = edge;
                    }
                }
            }
        }
        edges
    }

    fn find_or_add(&mut self, smaller: u32, larger: u32, latest: &mut [u32]) -> u32 {
        let known = latest[larger as usize];
        if known != NONE && self.ends[known as usize][0] == smaller {
            self.triangle_counts[known as usize] += 1;
            return known;
        }
        let edge = self.ends.len() as u32;
        self.ends.push([smaller, larger]);
        self.triangle_counts.push(1);
        latest[larger as usize] = edge;
        edge
    }
}

/// How a mesh hangs together.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct TopologyCounts {
    /// Vertices that a triangle uses.
    pub used_vertices: usize,
    /// Edges.
    pub edges: usize,
    /// Edges with one triangle.
    pub boundary_edges: usize,
    /// Edges with three or more triangles.
    pub non_manifold_edges: usize,
    /// Components connected through shared vertices.
    pub components: usize,
    /// Used vertices - edges + triangles.
    pub euler_characteristic: i64,
}

impl TopologyCounts {
    /// Counts for a mesh with these corner lists and edges.
    #[must_use]
    pub fn of(mesh: &TriMesh, lists: &CornerLists, edges: &Edges) -> Self {
        let used_vertices = lists.first.iter().filter(|&&corner| corner != NONE).count();
        let count = |wanted: fn(&u32) -> bool| edges.triangle_counts.iter().copied().filter(wanted).count();
        Self {
            used_vertices,
            edges: edges.ends.len(),
            boundary_edges: count(|&n| n == 1),
            non_manifold_edges: count(|&n| n > 2),
            components: used_vertices - joins(mesh.vertex_count(), &edges.ends),
            euler_characteristic: used_vertices as i64 - edges.ends.len() as i64 + mesh.triangle_count() as i64,
        }
    }
}

/// How many of the edges join two sets that no edge before them joined.
fn joins(vertex_count: usize, ends: &[[u32; 2]]) -> usize {
    let mut parent: Vec<u32> = (0..vertex_count as u32).collect();
    ends.iter()
        .filter(|[a, b]| {
            let (a, b) = (find_root(&mut parent, *a), find_root(&mut parent, *b));
            parent[a.max(b) as usize] = a.min(b);
            a != b
        })
        .count()
}

/// The last of the chain of parents from `vertex` on; halves the chain as it goes.
pub fn find_root(parent: &mut [u32], mut vertex: u32) -> u32 {
    while parent[vertex as usize] != vertex {
        parent[vertex as usize] = parent[parent[vertex as usize] as usize];
        vertex = parent[vertex as usize];
    }
    vertex
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use glam::DVec3;

    use super::*;

    fn counts(vertex_count: usize, triangles: &[[u32; 3]]) -> TopologyCounts {
        let mesh = TriMesh::new(vec![DVec3::ZERO; vertex_count], triangles.to_vec()).unwrap();
        let lists = CornerLists::of(&mesh);
        TopologyCounts::of(&mesh, &lists, &Edges::of(&mesh, &lists))
    }

    #[test]
    fn tetrahedron_beside_an_unused_vertex_is_closed() {
        let counts = counts(5, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
        assert_eq!((counts.used_vertices, counts.edges, counts.components), (4, 6, 1));
        assert_eq!((counts.boundary_edges, counts.non_manifold_edges, counts.euler_characteristic), (0, 0, 2));
    }

    #[test]
    fn three_wings_on_one_edge_and_a_triangle_apart() {
        let counts = counts(8, &[[0, 1, 2], [1, 0, 3], [0, 1, 4], [5, 6, 7]]);
        assert_eq!((counts.boundary_edges, counts.non_manifold_edges, counts.components), (9, 1, 2));
    }

    #[test]
    fn edges_lie_opposite_their_corners() {
        let triangles = vec![[4, 2, 0], [0, 2, 1]];
        let mesh = TriMesh::new(vec![DVec3::ZERO; 5], triangles.clone()).unwrap();
        let edges = Edges::of(&mesh, &CornerLists::of(&mesh));
        for (triangle, opposite) in triangles.iter().zip(&edges.of_triangle) {
            for k in 0..3 {
                let [a, b] = edges.ends[opposite[k] as usize];
                let mut ends = [triangle[(k + 1) % 3], triangle[(k + 2) % 3]];
                ends.sort_unstable();
                assert_eq!([a, b], ends);
            }
        }
    }
}
