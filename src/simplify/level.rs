//! From the shrunken surface back to a mesh, with maps from old numbers to new ones.

use super::collapser::State;
use super::frame::Frame;
use super::{Level, Stop, TopologyChange};
use crate::error::{Error, Result};
use crate::mesh::adjacency::{CornerLists, Edges, TopologyCounts, find_root};
use crate::mesh::{TriMesh, number_marked};

/// What levels are measured against.
#[derive(Debug, Clone, Copy)]
pub struct Origin<'a> {
    /// The input.
    pub mesh: &'a TriMesh,
    /// Its frame.
    pub frame: Frame,
    /// Its topology.
    pub topology: TopologyCounts,
}

/// The level of detail that `collapser` has reached.
///
/// Vertices and triangles keep their order; a vertex that never moved keeps its coordinates to the last bit.
pub fn level_of(state: &State, origin: &Origin<'_>, target: Option<usize>, stop: Stop) -> Result<Level> {
    let State { surface, vertices, tally } = state;
    let numbers = number_marked(origin.mesh.vertex_count(), |v| surface.is_used(v as u32));
    let position = |v: usize| {
        if vertices.moved[v] { origin.frame.to_model(surface.positions[v]) } else { origin.mesh.positions()[v] }
    };
    let positions = (0..numbers.len()).filter(|&v| numbers[v].is_some()).map(position).collect();
    let alive = || surface.triangles.iter().filter(|t| t.is_alive());
    let triangles = alive().map(|t| t.vertices.map(|v| numbers[v as usize].unwrap_or(0))).collect();
    let mesh = TriMesh::new(positions, triangles)
        .map_err(|source| Error::Mesh { place: "the simplified mesh".to_owned(), source })?;
    let mut parent = vertices.parent.clone();
    Ok(Level {
        target,
        stop,
        error: tally.mean_square.sqrt() * origin.frame.radius,
        topology: change(&origin.topology, &counts(&mesh), tally.cancelled_pairs),
        mesh,
        vertex_map: (0..parent.len() as u32).map(|v| numbers[find_root(&mut parent, v) as usize]).collect(),
        triangle_map: number_marked(surface.triangles.len(), |t| surface.triangles[t].is_alive()),
    })
}

fn counts(mesh: &TriMesh) -> TopologyCounts {
    let lists = CornerLists::of(mesh);
    TopologyCounts::of(mesh, &lists, &Edges::of(mesh, &lists))
}

fn change(before: &TopologyCounts, after: &TopologyCounts, cancelled_pairs: usize) -> TopologyChange {
    let difference = |count: fn(&TopologyCounts) -> usize| count(after) as i64 - count(before) as i64;
    TopologyChange {
        cancelled_pairs,
        non_manifold_edges: difference(|c| c.non_manifold_edges),
        components: difference(|c| c.components),
        boundary_edges: difference(|c| c.boundary_edges),
        euler_characteristic: after.euler_characteristic - before.euler_characteristic,
    }
}
