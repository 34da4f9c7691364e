//! From the shrunken surface back to a mesh, with maps from old numbers to new ones.

use glam::DVec3;

use super::collapser::State;
use super::frame::Frame;
use super::locality::Locality;
use super::{Level, Stop, TopologyChange};
use crate::error::{Error, Result};
use crate::mesh::adjacency::{CornerLists, Edges, TopologyCounts, find_root};
use crate::mesh::{TriMesh, number_marked};

/// What levels are measured against.
#[derive(Debug)]
pub struct Origin<'a> {
    /// The input.
    pub mesh: &'a TriMesh,
    /// Its frame.
    pub frame: Frame,
    /// The numbers that its vertices and triangles have on the surface.
    pub locality: Locality,
    /// Its topology.
    pub topology: TopologyCounts,
}

/// The level of detail that `collapser` has reached.
///
/// Vertices and triangles keep their order; a vertex that never moved keeps its coordinates to the last bit.
pub fn level_of(state: &State, origin: &Origin<'_>, target: Option<usize>, stop: Stop) -> Result<Level> {
    let State { surface, vertices, tally } = state;
    let Locality { vertices: working_vertices, triangles: working_triangles } = &origin.locality;
    let input_vertices = || origin.mesh.positions().iter().zip(working_vertices);
    let triangle_of = |t: &u32| surface.triangle(*t);

    // Number what is left in the order of the input.
    let mut numbers = vec![None; working_vertices.len()];
    let used = working_vertices.iter().filter(|&&v| surface.is_used(v));
    used.zip(0u32..).for_each(|(&v, number)| numbers[v as usize] = Some(number));
    let position = |(&p, &v): (&DVec3, &u32)| {
        if vertices.moved[v as usize] { origin.frame.to_model(surface.positions[v as usize]) } else { p }
    };
    let positions = input_vertices().filter(|&(_, &v)| surface.is_used(v)).map(position).collect();
    let alive = working_triangles.iter().map(triangle_of).filter(|t| t.is_alive());
    let triangles = alive.map(|t| t.vertices.map(|v| numbers[v as usize].unwrap_or(0))).collect();
    let mesh = TriMesh::new(positions, triangles)
        .map_err(|source| Error::Mesh { place: "the simplified mesh".to_owned(), source })?;

    let mut parent = vertices.parent.clone();
    Ok(Level {
        target,
        stop,
        error: tally.mean_square.sqrt() * origin.frame.radius,
        topology: change(&origin.topology, &counts(&mesh), tally.cancelled_pairs),
        mesh,
        vertex_map: working_vertices.iter().map(|&v| numbers[find_root(&mut parent, v) as usize]).collect(),
        triangle_map: number_marked(working_triangles.len(), |t| triangle_of(&working_triangles[t]).is_alive()),
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
