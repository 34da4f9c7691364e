use rayon::prelude::*;

use crate::error::Result;
use crate::mesh::{TriMesh, VertexTriangles};
use crate::progress::Progress;
use crate::visibility::Shapes;

/// Visibility of triangles too small to be counted alone, taken over their neighbourhood.
///
/// Who is pooled depends on size alone, never on the count, or else hidden triangles would borrow visibility from
/// visible ones; a neighbourhood that nobody sees stays at exactly 0.
pub(super) struct Pools {
    /// Per triangle the pooled (front, back); `None` where the triangle stands for itself.
    values: Vec<Option<(f64, f64)>>,
}

impl Pools {
    pub fn front(&self, t: usize, own: &[f64]) -> f64 {
        self.value(t).map_or(own[t], |(front, _)| front)
    }

    pub fn back(&self, t: usize, own: &[f64]) -> f64 {
        self.value(t).map_or(own[t], |(_, back)| back)
    }

    fn value(&self, t: usize) -> Option<(f64, f64)> {
        self.values.get(t).copied().flatten()
    }
}

/// Neighbours count only if their normal is within 60°, so that nothing leaks around an edge.
const MIN_COSINE: f64 = 0.5;

/// A neighbourhood stops growing here even if it is still too small: beyond, it no longer tells about the triangle.
const MAX_TRIANGLES: usize = 256;

/// Pools every triangle below `smallest_area` over the smallest ring neighbourhood that reaches it.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn pool_small(
    mesh: &TriMesh,
    shapes: &Shapes,
    smallest_area: f64,
    sides: [&[f64]; 2],
    progress: &dyn Progress,
) -> Result<Pools> {
    let is_small = |t: usize| shapes.areas[t] > 0.0 && shapes.areas[t] < smallest_area;
    let triangles = 0..mesh.triangle_count();
    if !triangles.clone().any(is_small) {
        return Ok(Pools { values: Vec::new() });
    }
    let neighbours = VertexTriangles::of(mesh);
    let pooled = |t: usize| {
        // Far too small triangles need large neighbourhoods; someone may not want to wait for them.
        (is_small(t) && !progress.is_cancelled()).then(|| {
            let set = neighbourhood(t as u32, mesh, shapes, &neighbours, smallest_area);
            (mean(&set, shapes, sides[0]), mean(&set, shapes, sides[1]))
        })
    };
    let values = triangles.into_par_iter().map(pooled).collect();
    progress.check()?;
    Ok(Pools { values })
}

/// Triangles around `t`, sorted, ring by ring until their area suffices.
fn neighbourhood(t: u32, mesh: &TriMesh, shapes: &Shapes, neighbours: &VertexTriangles, smallest: f64) -> Vec<u32> {
    let normal = shapes.normal(t as usize);
    let mut set = vec![t];
    let mut ring = vec![t];
    let mut area = shapes.areas[t as usize];
    while area < smallest && set.len() < MAX_TRIANGLES {
        ring = neighbours.around_all(mesh, &ring, MAX_TRIANGLES);
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

fn mean(set: &[u32], shapes: &Shapes, values: &[f64]) -> f64 {
    let area: f64 = set.iter().map(|&t| shapes.areas[t as usize]).sum();
    set.iter().map(|&t| shapes.areas[t as usize] * values[t as usize]).sum::<f64>() / area
}
