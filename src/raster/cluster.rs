//! Triangles in groups that fit the fastest cache.

use crate::mesh::TriangleId;

/// Most vertices of a cluster, so that a corner is one byte.
pub(super) const CLUSTER_VERTICES: usize = 256;

/// Most triangles of a cluster.
pub(super) const CLUSTER_TRIANGLES: usize = 512;

/// A triangle of a cluster, its corners ordered by position.
///
/// The order makes the depth of coincident triangles bitwise equal whatever order, winding or vertex numbers they are
/// stored with, so that the tie goes to the smaller triangle number.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Triangle {
    /// Places among the cluster's vertices.
    pub corners: [u8; 3],
    /// Twice the triangle's number, plus 1 if ordering the corners reversed the winding.
    pub code: u32,
}

/// Neighbouring triangles and the vertices they use.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cluster<'a> {
    pub positions: &'a [[f32; 3]],
    pub triangles: &'a [Triangle],
}

/// Where a cluster begins in the lists of [`Clusters`].
#[derive(Debug, Clone, Copy, Default)]
struct Start {
    vertex: usize,
    triangle: usize,
}

/// A mesh as clusters: few enough vertices each to be projected and read back within the fastest cache.
///
/// Vertices on the border between clusters are stored, and projected, once for each.
#[derive(Debug)]
pub(super) struct Clusters {
    positions: Vec<[f32; 3]>,
    triangles: Vec<Triangle>,
    /// One for each cluster, and the end of the last.
    starts: Vec<Start>,
}

impl Clusters {
    /// Cuts the list of triangles, in its order, into clusters.
    pub fn new(positions: &[[f32; 3]], triangles: &[([u32; 3], TriangleId)]) -> Self {
        let mut clusters = Self {
            positions: Vec::with_capacity(positions.len()),
            triangles: Vec::with_capacity(triangles.len()),
            starts: vec![Start::default()],
        };
        // Where the mesh's vertices were put last; those before the open cluster have to be put again.
        let mut places = vec![usize::MAX; positions.len()];
        let mut open = Start::default();
        for &(corners, id) in triangles {
            if clusters.is_full(open) {
                open = clusters.close();
            }
            let (corners, reversed) = in_order(corners, positions);
            let corners = corners.map(|v| {
                let place = &mut places[v as usize];
                if !(open.vertex..clusters.positions.len()).contains(place) {
                    *place = clusters.positions.len();
                    clusters.positions.push(positions[v as usize]);
                }
                (*place - open.vertex) as u8
            });
            clusters.triangles.push(Triangle { corners, code: id.0 << 1 | u32::from(reversed) });
        }
        clusters.close();
        clusters.positions.shrink_to_fit();
        clusters
    }

    /// Whether another triangle might find no room.
    fn is_full(&self, open: Start) -> bool {
        self.positions.len() + 3 > open.vertex + CLUSTER_VERTICES
            || self.triangles.len() == open.triangle + CLUSTER_TRIANGLES
    }

    /// Ends a cluster; returns the start of the next.
    fn close(&mut self) -> Start {
        let end = Start { vertex: self.positions.len(), triangle: self.triangles.len() };
        self.starts.push(end);
        end
    }

    /// The clusters, one after the other.
    pub fn iter(&self) -> impl Iterator<Item = Cluster<'_>> {
        self.starts.windows(2).map(|bounds| Cluster {
            positions: &self.positions[bounds[0].vertex..bounds[1].vertex],
            triangles: &self.triangles[bounds[0].triangle..bounds[1].triangle],
        })
    }
}

/// The corners ordered by position, and whether that reversed the winding.
fn in_order(corners: [u32; 3], positions: &[[f32; 3]]) -> ([u32; 3], bool) {
    let (mut ordered, mut reversed) = (corners, false);
    for (i, j) in [(0, 1), (1, 2), (0, 1)] {
        if precedes(ordered[j], ordered[i], positions) {
            ordered.swap(i, j);
            reversed = !reversed;
        }
    }
    (ordered, reversed)
}

fn precedes(a: u32, b: u32, positions: &[[f32; 3]]) -> bool {
    let (pa, pb) = (positions[a as usize], positions[b as usize]);
    let differing = pa.iter().zip(&pb).find(|(x, y)| x != y);
    differing.is_some_and(|(x, y)| x < y)
}
