use crate::mesh::{TriMesh, VertexTriangles};
use crate::visibility::Shapes;

/// Visibility of triangles too small to be counted alone, taken over their neighbourhood.
///
/// Who is pooled depends on size alone, never on the count, or else hidden triangles would borrow visibility from
/// visible ones; a neighbourhood that nobody sees stays at exactly 0.
pub(super) struct Pools<'a> {
    mesh: &'a TriMesh,
    shapes: &'a Shapes,
    smallest_area: f64,
    /// `None` where no triangle is small.
    neighbours: Option<VertexTriangles>,
}

/// Neighbours count only if their normal is within 60°, so that nothing leaks around an edge.
const MIN_COSINE: f64 = 0.5;

/// A neighbourhood stops growing here even if it is still too small: beyond, it no longer tells about the triangle.
const MAX_TRIANGLES: usize = 256;

impl<'a> Pools<'a> {
    /// Pools triangles of less than `smallest_area` (unit-sphere units).
    pub fn new(mesh: &'a TriMesh, shapes: &'a Shapes, smallest_area: f64) -> Self {
        let mut pools = Self { mesh, shapes, smallest_area, neighbours: None };
        if (0..mesh.triangle_count()).any(|t| pools.is_small(t)) {
            pools.neighbours = Some(VertexTriangles::of(mesh));
        }
        pools
    }

    /// Each of `values` of triangle `t`: its own, or the mean over its neighbourhood if it is small.
    pub fn at(&self, t: usize, values: [&[f64]; 2]) -> [f64; 2] {
        match &self.neighbours {
            Some(neighbours) if self.is_small(t) => {
                let set = self.neighbourhood(t as u32, neighbours);
                values.map(|values| self.mean(&set, values))
            }
            _ => values.map(|values| values[t]),
        }
    }

    fn is_small(&self, t: usize) -> bool {
        let area = self.shapes.areas[t];
        area > 0.0 && area < self.smallest_area
    }

    /// Triangles around `t`, sorted, from the smallest number of rings whose area suffices.
    fn neighbourhood(&self, t: u32, neighbours: &VertexTriangles) -> Vec<u32> {
        let shapes = self.shapes;
        let normal = shapes.normal(t as usize);
        let mut set = vec![t];
        let mut ring = vec![t];
        let mut area = shapes.areas[t as usize];
        while area < self.smallest_area && set.len() < MAX_TRIANGLES {
            ring = neighbours.around_all(self.mesh, &ring, MAX_TRIANGLES);
            ring.retain(|&n| set.binary_search(&n).is_err() && shapes.normal(n as usize).dot(normal) >= MIN_COSINE);
            if ring.is_empty() {
                break;
            }
            area += ring.iter().map(|&n| shapes.areas[n as usize]).sum::<f64>();
            set.extend(&ring);
            set.sort_unstable();
        }
        set
    }

    fn mean(&self, set: &[u32], values: &[f64]) -> f64 {
        let areas = &self.shapes.areas;
        let area: f64 = set.iter().map(|&t| areas[t as usize]).sum();
        set.iter().map(|&t| areas[t as usize] * values[t as usize]).sum::<f64>() / area
    }
}
