//! Triangle meshes that are valid by construction.
//!
//! A [`TriMesh`] owns its vertices in `f64` and its triangles as vertex indices. Whoever holds one may index without
//! checking: every index is in range, no triangle repeats a vertex, every coordinate is finite, and there is at least
//! one triangle. What a file holds beyond that is set aside, and counted, by [`TriMesh::from_triangles`].

pub mod adjacency;
mod part;
mod rings;
pub mod shapes;
mod subdivision;
mod weld;

pub(crate) use part::number_marked;
pub use part::{Remainder, compose_maps};
pub use rings::VertexTriangles;
pub use subdivision::Subdivision;
pub use weld::{Welder, weld};

use glam::DVec3;

use crate::error::short_number;
use crate::geom::{self, Aabb};

/// Number of a triangle in its mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TriangleId(pub u32);

/// Largest coordinate a mesh may have: beyond it, squared lengths would overflow.
pub const MAX_COORDINATE: f64 = 1e100;

/// Most triangles a mesh may have: an item buffer stores a triangle and its side in 32 bits.
pub const MAX_TRIANGLES: usize = (1 << 31) - 1;

/// What stops vertices and triangles from making a mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} uses vertex {vertex}, but the mesh has {vertex_count} vertices (counted from 0)")]
    IndexOutOfRange {
        /// The triangle.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// Vertices there are.
        vertex_count: usize,
    },
    /// A vertex has a coordinate that is not a number, infinite, or beyond [`MAX_COORDINATE`].
    #[error(
        "vertex {vertex} is at ({}, {}, {}); coordinates must be finite and at most 1e100",
        short_number(*x), short_number(*y), short_number(*z)
    )]
    BadCoordinate {
        /// The vertex.
        vertex: usize,
        /// Its first coordinate.
        x: f64,
        /// Its second coordinate.
        y: f64,
        /// Its third coordinate.
        z: f64,
    },
    /// A triangle names one vertex twice.
    #[error("triangle {triangle} uses vertex {vertex} twice")]
    RepeatedVertex {
        /// The triangle.
        triangle: usize,
        /// The vertex it repeats.
        vertex: u32,
    },
    /// No triangle is left.
    #[error("{}", no_triangles_message(*vertices, *set_aside))]
    NoTriangles {
        /// Vertices there are: many without a triangle are a point cloud.
        vertices: usize,
        /// Triangles that were set aside as zero-area or repeating a vertex.
        set_aside: usize,
    },
    /// Every triangle is too small or too thin, against the whole, to be drawn.
    #[error(
        "all {triangles} triangles are smaller than 1e-14 of the squared radius around them; is one vertex far away, or \
         the mesh a line?"
    )]
    NothingToSee {
        /// Triangles there are.
        triangles: usize,
    },
    /// More than [`MAX_TRIANGLES`] triangles or `u32::MAX` vertices.
    #[error("{vertices} vertices and {triangles} triangles are more than the 2147483647 that Outsight can number")]
    TooMany {
        /// Vertices given.
        vertices: usize,
        /// Triangles given.
        triangles: usize,
    },
}

fn no_triangles_message(vertices: usize, set_aside: usize) -> String {
    match (vertices, set_aside) {
        (0, 0) => "no vertices and no triangles; is the file empty?".to_owned(),
        (_, 0) => format!("{vertices} vertices but no triangles; a point cloud must be meshed first"),
        _ => format!("all {set_aside} triangles have zero area or repeat a vertex; nothing is left to look at"),
    }
}

/// Triangle mesh, valid by construction.
#[derive(Debug, Clone, PartialEq)]
pub struct TriMesh {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

/// Triangles that [`TriMesh::from_triangles`] left out, as indices into its input, ascending.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SetAside {
    /// Triangles that name one vertex twice.
    pub repeated_vertex: Vec<u32>,
    /// Triangles whose three different vertices span no area.
    pub zero_area: Vec<u32>,
}

impl SetAside {
    /// How many triangles were set aside.
    #[must_use]
    pub fn count(&self) -> usize {
        self.repeated_vertex.len() + self.zero_area.len()
    }
}

impl TriMesh {
    /// A mesh of these vertices (model units) and triangles (vertex indices from 0, counter-clockwise from outside).
    ///
    /// Vertices that no triangle uses are kept.
    ///
    /// # Errors
    /// [`MeshError`], naming the first vertex or triangle that is wrong.
    pub fn new(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        check_counts(&positions, &triangles)?;
        check_positions(&positions)?;
        check_indices(&positions, &triangles)?;
        if let Some((triangle, t)) = triangles.iter().enumerate().find(|(_, t)| repeats_vertex(t)) {
            let vertex = if t[0] == t[1] { t[0] } else { t[2] };
            return Err(MeshError::RepeatedVertex { triangle, vertex });
        }
        if triangles.is_empty() {
            return Err(MeshError::NoTriangles { vertices: positions.len(), set_aside: 0 });
        }
        Ok(Self { positions, triangles })
    }

    /// Like [`TriMesh::new`], but sets aside triangles that repeat a vertex or have no area, and says which.
    ///
    /// # Errors
    /// [`MeshError`] for what cannot be set aside: wrong indices, wrong coordinates, no triangle left.
    pub fn from_triangles(positions: Vec<DVec3>, mut triangles: Vec<[u32; 3]>) -> Result<(Self, SetAside), MeshError> {
        check_counts(&positions, &triangles)?;
        check_positions(&positions)?;
        check_indices(&positions, &triangles)?;
        let mut aside = SetAside::default();
        let mut index = 0;
        triangles.retain(|t| {
            let list = if repeats_vertex(t) {
                Some(&mut aside.repeated_vertex)
            } else if has_no_area(t.map(|v| positions[v as usize])) {
                Some(&mut aside.zero_area)
            } else {
                None
            };
            let keep = list.is_none();
            list.into_iter().for_each(|l| l.push(index));
            index += 1;
            keep
        });
        if triangles.is_empty() {
            return Err(MeshError::NoTriangles { vertices: positions.len(), set_aside: aside.count() });
        }
        Ok((Self { positions, triangles }, aside))
    }

    /// Vertex positions in model units.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Vertex indices of each triangle.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Number of vertices, those that no triangle uses included.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// Number of triangles, at least 1.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Corner positions of a triangle.
    ///
    /// # Panics
    /// If the mesh has no such triangle.
    #[must_use]
    pub fn corners(&self, triangle: TriangleId) -> [DVec3; 3] {
        self.triangles[triangle.0 as usize].map(|v| self.positions[v as usize])
    }

    /// Box around all triangles; vertices that no triangle uses do not count.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        let corners = self.triangles.iter().flatten().map(|&v| self.positions[v as usize]);
        Aabb::around(corners).expect("a mesh has at least one triangle")
    }

    /// Its vertices and triangles.
    #[must_use]
    pub fn into_parts(self) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        (self.positions, self.triangles)
    }
}

fn repeats_vertex(&[a, b, c]: &[u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// No area in `f64`, at any scale: edges are divided by the longest coordinate first, so that tiny triangles count.
fn has_no_area([a, b, c]: [DVec3; 3]) -> bool {
    let (u, v) = (b - a, c - a);
    let scale = u.abs().max_element().max(v.abs().max_element());
    scale == 0.0 || geom::area_vector_doubled([DVec3::ZERO, u / scale, v / scale]) == DVec3::ZERO
}

fn check_counts(positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<(), MeshError> {
    if positions.len() > u32::MAX as usize || triangles.len() > MAX_TRIANGLES {
        return Err(MeshError::TooMany { vertices: positions.len(), triangles: triangles.len() });
    }
    Ok(())
}

fn check_positions(positions: &[DVec3]) -> Result<(), MeshError> {
    // `<=` is false for NaN, so that one comparison catches NaN, infinities and giants.
    let bad = positions.iter().position(|p| !p.to_array().iter().all(|c| c.abs() <= MAX_COORDINATE));
    match bad {
        None => Ok(()),
        Some(vertex) => {
            let [x, y, z] = positions[vertex].to_array();
            Err(MeshError::BadCoordinate { vertex, x, y, z })
        }
    }
}

fn check_indices(positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<(), MeshError> {
    let vertex_count = positions.len();
    for (triangle, t) in triangles.iter().enumerate() {
        if let Some(&vertex) = t.iter().find(|&&v| v as usize >= vertex_count) {
            return Err(MeshError::IndexOutOfRange { triangle, vertex, vertex_count });
        }
    }
    Ok(())
}
