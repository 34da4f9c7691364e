//! Quadric error: Q places the new vertex, Q_v, weighted by importance, orders the collapses.
//!
//! Sources: Garland & Heckbert 1997 (accumulated quadrics); Zhang & Turk 2002, eqs. 5.5 to 5.10 (the two quadrics).

use super::{Candidate, Metric};
use crate::geom::area_vector_doubled;
use crate::mesh::adjacency::Edges;
use crate::simplify::placement::Placement;
use crate::simplify::quadric::Quadric;
use crate::simplify::surface::Surface;
use crate::simplify::{Boundary, PlaneWeight, SimplifyOptions};

/// Smallest area of a triangle that has a plane, in unit-sphere units squared.
const MIN_AREA: f64 = 1e-14;

/// A sum of squares below this share of the sum of its weights is rounding, and counts as 0.
const NOISE: f64 = 1e-14;

/// Quadric error metric with separate quadrics for position and cost.
#[derive(Debug)]
pub struct QuadricMetric {
    placement: Placement,
    /// Q of each vertex, or Q and Q_v by turns: side by side they are fetched together.
    quadrics: Vec<Quadric>,
    /// Whether Q_v differs from Q.
    is_weighted: bool,
    /// The part of Q that is in Q_v without being error; see [`SimplifyOptions::importance_floor`].
    importance_floor: f64,
}

impl QuadricMetric {
    /// The quadrics of the untouched `surface`.
    ///
    /// `triangles` names every triangle once; sums run in this order. `importance` has a factor for each of its places.
    pub fn new(
        surface: &Surface,
        edges: &Edges,
        triangles: &[u32],
        importance: Option<&[f64]>,
        options: &SimplifyOptions,
    ) -> Self {
        let count = surface.positions.len();
        let mut metric = Self {
            placement: Placement { max_distance: options.max_placement_distance, regulariser: options.regulariser },
            quadrics: vec![Quadric::default(); if importance.is_some() { 2 * count } else { count }],
            is_weighted: importance.is_some(),
            importance_floor: options.importance_floor,
        };
        let boundary_weight = match options.boundary {
            Boundary::Weight(weight) => weight,
            Boundary::Locked => 0.0,
        };
        for (place, &t) in triangles.iter().enumerate() {
            let importance = importance.map_or(1.0, |factors| factors[place]);
            metric.add_triangle(
                surface,
                edges,
                t,
                PlaneTerms { by: options.plane_weight, boundary_weight, importance },
            );
        }
        metric
    }

    /// Adds the plane of a triangle, and those across its boundary edges, to its corners.
    fn add_triangle(&mut self, surface: &Surface, edges: &Edges, t: u32, terms: PlaneTerms) {
        let corners = surface.corners_of(t);
        let vertices = surface.triangle(t).vertices;
        let area_vector = area_vector_doubled(corners);
        let area = 0.5 * area_vector.length();
        if area < MIN_AREA {
            return;
        }
        let normal = area_vector / (2.0 * area);
        let weight = match terms.by {
            PlaneWeight::Area => area,
            PlaneWeight::Uniform => 1.0,
        };
        self.add_plane(&vertices, &Quadric::of_plane(normal, -normal.dot(corners[0]), weight), terms.importance);
        if terms.boundary_weight == 0.0 {
            return;
        }
        for k in 0..3 {
            if edges.triangle_counts[edges.of_triangle[t as usize][k] as usize] != 1 {
                continue;
            }
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            if let Some(across) = (corners[b] - corners[a]).cross(normal).try_normalize() {
                let plane = Quadric::of_plane(across, -across.dot(corners[a]), terms.boundary_weight * weight);
                self.add_plane(&[vertices[a], vertices[b]], &plane, terms.importance);
            }
        }
    }

    fn add_plane(&mut self, vertices: &[u32], plane: &Quadric, importance: f64) {
        let weighted = plane.scaled(importance);
        for &v in vertices {
            match self.of_vertex_mut(v) {
                [q, q_v] => {
                    q.add(plane);
                    q_v.add(&weighted);
                }
                all => all.iter_mut().for_each(|q| q.add(plane)),
            }
        }
    }

    /// Q of a vertex, and Q_v where it differs.
    fn of_vertex(&self, vertex: u32) -> &[Quadric] {
        let stride = 1 + usize::from(self.is_weighted);
        &self.quadrics[stride * vertex as usize..][..stride]
    }

    fn of_vertex_mut(&mut self, vertex: u32) -> &mut [Quadric] {
        let stride = 1 + usize::from(self.is_weighted);
        &mut self.quadrics[stride * vertex as usize..][..stride]
    }
}

/// How the planes of a triangle count.
#[derive(Clone, Copy)]
struct PlaneTerms {
    by: PlaneWeight,
    boundary_weight: f64,
    importance: f64,
}

impl Metric for QuadricMetric {
    fn has_second_cost(&self) -> bool {
        self.is_weighted
    }

    fn candidate(&self, surface: &Surface, ends: [u32; 2], pinned: Option<u32>) -> Candidate {
        let at = |v: u32| surface.positions[v as usize];
        let [of_u, of_v] = ends.map(|v| self.of_vertex(v));
        let position = match pinned {
            Some(vertex) => at(vertex),
            None => self.placement.place(ends.map(at), [&of_u[0], &of_v[0]]),
        };
        let unweighted = error(&of_u[0].plus(&of_v[0]), position);
        let (weighted, floor) = match (of_u.get(1), of_v.get(1)) {
            (Some(q_u), Some(q_v)) => (error(&q_u.plus(q_v), position), self.importance_floor),
            _ => (unweighted, 0.0),
        };
        let mean_square = mean_above_floor(weighted, unweighted, floor);
        Candidate { position, cost: weighted.0, second_cost: unweighted.0, mean_square }
    }

    fn merge(&mut self, gone: u32, kept: u32) {
        let stride = 1 + usize::from(self.is_weighted);
        for k in 0..stride {
            let gone = self.quadrics[stride * gone as usize + k];
            self.quadrics[stride * kept as usize + k].add(&gone);
        }
    }
}

/// Mean of a sum over its weight, after `floor` times the unweighted sum and weight is taken off; 0 where all is floor.
fn mean_above_floor((sum, weight): (f64, f64), unweighted: (f64, f64), floor: f64) -> f64 {
    let floor_weight = floor * unweighted.1;
    let counted_weight = weight - floor_weight;
    // What is left of equal numbers is their rounding.
    if counted_weight <= 1e-6 * floor_weight {
        return 0.0;
    }
    (sum - floor * unweighted.0).max(0.0) / counted_weight
}

/// The error of `q` at `x`, 0 where it is rounding, and the sum of its weights.
fn error(q: &Quadric, x: glam::DVec3) -> (f64, f64) {
    let weight = q.total_weight();
    let value = q.value(x);
    (if value < NOISE * weight { 0.0 } else { value.max(0.0) }, weight)
}
