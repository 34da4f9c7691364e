//! What a collapse costs and where it puts the new vertex.

mod quadric;

pub use quadric::QuadricMetric;

use glam::DVec3;

use super::surface::Surface;

/// What would become of an edge.
#[derive(Debug, Clone, Copy)]
pub struct Candidate {
    /// Position of the new vertex, in unit-sphere coordinates.
    pub position: DVec3,
    /// What the queue sorts by, at least 0.
    pub cost: f64,
    /// What it sorts equal costs by.
    pub second_cost: f64,
    /// Mean square distance that the collapse adds up to, in unit-sphere units squared.
    pub mean_square: f64,
}

/// A rule that says what a collapse costs. It keeps its own records per vertex.
///
/// The cost of an edge may depend on the records and positions of its two ends and on the triangles around them.
pub trait Metric {
    /// Whether [`Candidate::second_cost`] says more than the cost.
    fn has_second_cost(&self) -> bool;

    /// What would become of the edge between `ends`; `pinned` is the end that must keep its position, if any.
    fn candidate(&self, surface: &Surface, ends: [u32; 2], pinned: Option<u32>) -> Candidate;

    /// `gone` has become part of `kept`.
    fn merge(&mut self, gone: u32, kept: u32);
}
