//! Which collapses are not allowed. Guards look and never change anything.

use glam::DVec3;

use super::ring::Ring;
use super::surface::Surface;
use super::{Boundary, SimplifyOptions, Topology};
use crate::geom::area_vector_doubled;

/// The rules a collapse has to keep, from the options.
#[derive(Debug, Clone, Copy)]
pub struct Guards {
    topology: Topology,
    keeps_boundary: bool,
    min_normal_cosine: f64,
    min_compactness: f64,
    max_valence: Option<usize>,
}

impl Guards {
    /// The rules that `options` ask for.
    pub fn new(options: &SimplifyOptions) -> Self {
        Self {
            topology: options.topology,
            keeps_boundary: options.boundary == Boundary::Locked,
            min_normal_cosine: options.min_normal_cosine,
            min_compactness: options.min_compactness,
            max_valence: options.max_valence,
        }
    }

    /// Whether the edge of `ring` may become a vertex at `x`. `is_free` says that the collapse costs nothing.
    pub fn allow(&self, surface: &Surface, ring: &Ring, locked: &[bool], x: DVec3, is_free: bool) -> bool {
        ring.removed_count() < surface.alive
            && self.keeps_topology(ring)
            && self.keeps_locked_vertices(ring, surface, locked)
            && (is_free || self.keeps_valence(ring))
            && self.keeps_shape(surface, ring, x)
    }

    fn keeps_topology(&self, ring: &Ring) -> bool {
        self.topology == Topology::Free || (links_meet_only_at_edge(ring) && boundary_links_meet_only_at_edge(ring))
    }

    /// Whether no locked vertex loses its last triangle.
    fn keeps_locked_vertices(&self, ring: &Ring, surface: &Surface, locked: &[bool]) -> bool {
        if !self.keeps_boundary {
            return true;
        }
        let is_removed = |t: u32| ring.on_edge.contains(&t) || ring.covered.contains(&t);
        let touched = ring.on_edge.iter().chain(&ring.covered).flat_map(|&t| surface.triangle(t).vertices);
        touched.filter(|&v| locked[v as usize]).all(|v| {
            let is_end = ring.ends.contains(&v);
            (is_end && ring.lasting().next().is_some())
                || (!is_end && surface.corners(v).any(|corner| !is_removed(corner.triangle)))
        })
    }

    fn keeps_valence(&self, ring: &Ring) -> bool {
        self.max_valence.is_none_or(|max| ring.neighbours.len() <= max)
    }

    /// Whether no lasting triangle turns over, loses its area or becomes a needle.
    fn keeps_shape(&self, surface: &Surface, ring: &Ring, x: DVec3) -> bool {
        ring.lasting().all(|(_, corner)| {
            let before = surface.corners_of(corner.triangle);
            let mut after = before;
            after[corner.k as usize] = x;
            self.keeps_normal(before, after) && self.keeps_compactness(before, after)
        })
    }

    /// A triangle without area has no normal to keep, and may become anything.
    fn keeps_normal(&self, before: [DVec3; 3], after: [DVec3; 3]) -> bool {
        let (before, after) = (area_vector_doubled(before), area_vector_doubled(after));
        let lengths = (before.length_squared() * after.length_squared()).sqrt();
        before == DVec3::ZERO || (lengths > 0.0 && before.dot(after) >= self.min_normal_cosine * lengths)
    }

    /// A needle may stay one, as long as it gets no thinner.
    fn keeps_compactness(&self, before: [DVec3; 3], after: [DVec3; 3]) -> bool {
        if self.min_compactness <= 0.0 {
            return true;
        }
        let after = compactness(after);
        after >= self.min_compactness || after >= compactness(before)
    }
}

/// 4 √3 A / (sum of squared edge lengths): 1 for an equilateral triangle, 0 for one without area.
fn compactness([a, b, c]: [DVec3; 3]) -> f64 {
    let squares = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
    let twelve_area_squared = 3.0 * area_vector_doubled([a, b, c]).length_squared();
    if squares > 0.0 { 2.0 * twelve_area_squared.sqrt() / squares } else { 0.0 }
}

/// The link condition: u and v share no neighbour and no link edge but those of the triangles on the edge.
///
/// With it a collapse keeps the homotopy type of any complex of triangles, edges with three of them included.
/// The link-edge part is what keeps a tetrahedron.
///
/// Source: Dey, Edelsbrunner, Guha & Nekhayev 1999.
fn links_meet_only_at_edge(ring: &Ring) -> bool {
    ring.covered.is_empty() && ring.neighbours.iter().all(|n| n.wing_count == u32::from(n.is_common()))
}

/// The same with a virtual vertex that makes a triangle with every boundary edge.
fn boundary_links_meet_only_at_edge(ring: &Ring) -> bool {
    let is_boundary = |side: usize| ring.neighbours.iter().any(|n| n.triangle_counts[side] == 1);
    let edge_is_boundary = ring.on_edge.len() == 1;
    // The virtual vertex is a common neighbour of two boundary vertices, so it must make a triangle with their edge.
    if !edge_is_boundary && is_boundary(0) && is_boundary(1) {
        return false;
    }
    // The link edge from the virtual vertex to a wing: only a triangle with no neighbour but across uv has both.
    !ring.neighbours.iter().any(|n| n.triangle_counts == [1, 1])
}
