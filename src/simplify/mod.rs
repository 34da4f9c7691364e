//! Edge collapse ordered by (visibility-weighted) quadric error.
//!
//! This module takes weights as plain slices. It does not know that visibility exists.
//!
//! Sources: Garland & Heckbert 1997 (quadrics); Zhang & Turk 2002, section 5 (weighted priority, unweighted placement).

mod collapser;
mod frame;
mod guards;
mod level;
mod locality;
mod metric;
mod options;
mod placement;
mod quadric;
mod queue;
mod ring;
mod surface;

pub use options::SimplifyOptions;

use crate::error::{Error, Result};
use crate::mesh::TriMesh;
use crate::mesh::adjacency::{CornerLists, Edges, TopologyCounts};
use crate::progress::Progress;
use collapser::{EdgeCollapser, Limits};
use frame::Frame;
use guards::Guards;
use level::{Origin, level_of};
use locality::Locality;
use metric::QuadricMetric;
use surface::Surface;

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

/// Why a level ended where it did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// The target was reached.
    Target,
    /// No collapse is allowed any more, and at least one was withheld because it would have passed the error bound.
    Error,
    /// No collapse is allowed any more.
    QueueEmpty,
}

/// What a run changed in the topology, against its input.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct TopologyChange {
    /// Pairs of triangles back to back that were cancelled. Where a collapse lays two triangles onto each other the
    /// same way round, one of them goes; that is not counted here.
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

impl TopologyChange {
    /// What taking triangles out of `whole` to leave `part` changed.
    #[must_use]
    pub fn between(whole: &TriMesh, part: &TriMesh) -> Self {
        let [before, after] = [whole, part].map(|mesh| {
            let lists = CornerLists::of(mesh);
            TopologyCounts::of(mesh, &lists, &Edges::of(mesh, &lists))
        });
        let more = |after: usize, before: usize| after as i64 - before as i64;
        Self {
            cancelled_pairs: 0,
            non_manifold_edges: more(after.non_manifold_edges, before.non_manifold_edges),
            components: more(after.components, before.components),
            boundary_edges: more(after.boundary_edges, before.boundary_edges),
            euler_characteristic: after.euler_characteristic - before.euler_characteristic,
        }
    }

    /// This change and an earlier one together.
    #[must_use]
    pub fn after(self, earlier: Self) -> Self {
        Self {
            cancelled_pairs: self.cancelled_pairs + earlier.cancelled_pairs,
            non_manifold_edges: self.non_manifold_edges + earlier.non_manifold_edges,
            components: self.components + earlier.components,
            boundary_edges: self.boundary_edges + earlier.boundary_edges,
            euler_characteristic: self.euler_characteristic + earlier.euler_characteristic,
        }
    }
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
    /// Largest root mean square distance of a collapse so far, in model units: sqrt(E / sum of weights), where both E
    /// and the weights include the importance, so that planes without importance do not count.
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
    mesh: &TriMesh,
    importance: Option<&[f64]>,
    options: &SimplifyOptions,
    progress: &dyn Progress,
) -> Result<Vec<Level>> {
    options.check()?;
    let targets = options.counts(mesh.triangle_count())?;
    check_mesh(mesh, importance)?;

    // Look at the input, under numbers that keep neighbours together.
    let frame = Frame::of(mesh);
    let locality = Locality::of(mesh, &frame);
    let sorted = locality.apply(mesh)?;
    let lists = CornerLists::of(&sorted);
    let edges = Edges::of(&sorted, &lists);
    let origin = Origin { mesh, frame, locality, topology: TopologyCounts::of(&sorted, &lists, &edges) };
    progress.check()?;

    // Prepare quadrics and queue, and let go of what they were made from.
    let surface = Surface::new(sorted, &frame, lists, &edges);
    let metric = QuadricMetric::new(&surface, &edges, &origin.locality.triangles, importance, options);
    let locked = locked_vertices(&edges, mesh.vertex_count(), options.boundary);
    let ends = edges.ends;
    drop((edges.of_triangle, edges.triangle_counts));
    let mut collapser = EdgeCollapser::new(surface, metric, ends, locked, limits(options, &frame));

    // Collapse from level to level; the last is made after what is needed to go on has been freed.
    let (last, before) = match targets.split_last() {
        Some((&last, before)) => (Some(last), before),
        None => (None, &[][..]),
    };
    let floor = last.unwrap_or(1);
    let mut levels = Vec::with_capacity(before.len() + 1);
    for &target in before {
        let stop = collapser.run(target, floor, progress)?;
        levels.push(level_of(collapser.state(), &origin, Some(target), stop)?);
    }
    let stop = collapser.run(floor, floor, progress)?;
    levels.push(level_of(&collapser.into_state(), &origin, last, stop)?);
    Ok(levels)
}

fn limits(options: &SimplifyOptions, frame: &Frame) -> Limits {
    let max = options.max_error.map_or(f64::INFINITY, |error| error / frame.radius);
    Limits { guards: Guards::new(options), max_mean_square: max * max }
}

/// Marks the vertices that must stay where they are.
fn locked_vertices(edges: &Edges, vertex_count: usize, boundary: Boundary) -> Vec<bool> {
    let mut locked = vec![false; vertex_count];
    if boundary == Boundary::Locked {
        let on_boundary = edges.ends.iter().zip(&edges.triangle_counts).filter(|&(_, &count)| count == 1);
        on_boundary.flat_map(|(ends, _)| ends).for_each(|&v| locked[v as usize] = true);
    }
    locked
}

/// Largest importance: sums of larger ones could overflow.
const MAX_IMPORTANCE: f64 = 1e100;

fn check_mesh(mesh: &TriMesh, importance: Option<&[f64]>) -> Result<()> {
    let triangles = mesh.triangle_count();
    if triangles > (u32::MAX / 3) as usize {
        let message =
            format!("{triangles} triangles are more than the 1431655765 that one run can simplify; split the mesh");
        return Err(Error::Limit { message });
    }
    let Some(importance) = importance else {
        return Ok(());
    };
    if importance.len() != triangles {
        return Err(Error::ShapeMismatch { what: "importance", got: importance.len(), expected: triangles });
    }
    match importance.iter().position(|i| !(0.0..=MAX_IMPORTANCE).contains(i)) {
        None => Ok(()),
        Some(t) => {
            let message = format!("triangle {t} has {}; it must be a number from 0 to 1e100", importance[t]);
            Err(Error::Option { name: "importance", message })
        }
    }
}
