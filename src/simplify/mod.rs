//! Edge collapse ordered by (visibility-weighted) quadric error.
//!
//! This module takes weights as plain slices. It does not know that visibility exists.
//!
//! Sources: Garland & Heckbert 1997 (quadrics); Zhang & Turk 2002, section 5 (weighted priority, unweighted placement).

use crate::error::Result;
use crate::mesh::TriMesh;
use crate::progress::Progress;

/// When to stop. Several given: the first one reached stops, and the result says which.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// At most this many triangles, at least 1.
    Triangles(usize),
    /// At most this share of the input's triangles, in (0, 1].
    Ratio(f64),
}

/// How much the plane of a triangle counts in the quadrics of its corners.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PlaneWeight {
    /// By the triangle's area.
    #[default]
    Area,
    /// Every triangle alike, as Zhang & Turk print it.
    Uniform,
}

/// What happens to the topology of the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Topology {
    /// Collapses may close holes, drop components and pinch; the result counts what changed.
    #[default]
    Free,
    /// Only collapses that pass the link condition.
    Preserve,
}

/// What holds the open borders of the surface in place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Boundary {
    /// Planes through the border edges, perpendicular to their triangles, with this weight times the triangle's own.
    Weight(f64),
    /// Border vertices never move and never vanish.
    Locked,
}

/// What one run of the simplifier does. `Default` is the preset `best`.
#[derive(Debug, Clone, PartialEq)]
pub struct SimplifyOptions {
    /// One level of detail per target, each at most as large as the one before; empty only with `max_error`.
    pub targets: Vec<Target>,
    /// Stop before the root mean square distance of a collapse passes this, in model units; `None` for no bound.
    pub max_error: Option<f64>,
    /// Weight of a triangle's plane.
    pub plane_weight: PlaneWeight,
    /// What may happen to the topology.
    pub topology: Topology,
    /// What holds borders.
    pub boundary: Boundary,
    /// Smallest cosine between a triangle's normal before and after a collapse, -1 to 1.
    pub min_normal_cosine: f64,
    /// Strength of the pull toward the original vertices, as a share of the plane weight; makes placement on
    /// near-planar surface unique. 0 for none.
    pub regulariser: f64,
}

/// Why a level ended where it did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// The target was reached.
    Target,
    /// The next collapse would have passed the error bound.
    Error,
    /// No collapse is allowed any more.
    QueueEmpty,
}

/// What a run changed in the topology, against its input.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct TopologyChange {
    /// Pairs of triangles back to back that were cancelled.
    pub cancelled_pairs: usize,
    /// Edges with three or more triangles that the input did not have (can be negative).
    pub non_manifold_edges: i64,
    /// Connected components, result minus input.
    pub components: i64,
    /// Border edges, result minus input.
    pub boundary_edges: i64,
    /// Euler characteristic, result minus input.
    pub euler_characteristic: i64,
}

/// One level of detail.
#[derive(Debug, Clone)]
pub struct Level {
    /// The simplified mesh; vertices that no triangle uses are gone.
    pub mesh: TriMesh,
    /// Triangles asked for, `None` where only an error bound was given.
    pub target: Option<usize>,
    /// Why the level ended.
    pub stop: Stop,
    /// Largest root mean square distance of a collapse so far, sqrt(E / sum of weights), in model units.
    pub error: f64,
    /// What changed in the topology.
    pub topology: TopologyChange,
    /// For each input vertex the vertex it became part of, `None` where that vanished.
    pub vertex_map: Vec<Option<u32>>,
    /// For each input triangle its number in `mesh`, `None` where it was removed.
    pub triangle_map: Vec<Option<u32>>,
}

/// Simplifies `mesh` to each target of `options` in one run.
///
/// `importance` holds one factor per triangle, finite and at least 0 (visibility squared, say): the cost that orders
/// the collapses multiplies each plane's weight with it, the position of the new vertex does not. `None` counts as 1
/// everywhere and gives the same bytes.
///
/// # Errors
/// [`crate::Error::Option`] for an option outside its range, [`crate::Error::ShapeMismatch`] if `importance` is not one
/// number per triangle, [`crate::Error::Cancelled`].
pub fn simplify(
    _mesh: &TriMesh,
    _importance: Option<&[f64]>,
    _options: &SimplifyOptions,
    _progress: &dyn Progress,
) -> Result<Vec<Level>> {
    Ok(Vec::new())
}

impl Default for SimplifyOptions {
    fn default() -> Self {
        Self {
            targets: Vec::new(),
            max_error: None,
            plane_weight: PlaneWeight::Area,
            topology: Topology::Free,
            boundary: Boundary::Weight(1.0),
            min_normal_cosine: 0.2,
            regulariser: 1e-6,
        }
    }
}
