//! Generated meshes: test pieces whose visibility is known in closed form, and the bundled gearbox.
//!
//! Every function returns a valid mesh, outward and counter-clockwise, and the same bytes on every machine: angles go
//! through `libm`, and nothing depends on hash order. Inner surfaces given as sheets without thickness turn their
//! normals to the inside, which is the side that is asked about.

mod builder;
mod cavity;
mod clutter;
mod facing;
mod flat;
pub mod gearbox;
mod outline;
mod revolve;
mod round;

#[cfg(test)]
mod tests;

pub use cavity::{
    cylindrical_well, nested_spheres, open_box, open_box_solid, shell_with_hole, shell_with_hole_and_ball,
    spherical_bowl,
};
pub use clutter::{cluttered_open_box, cluttered_sealed_box};
pub use facing::{coaxial_discs, parallel_squares, right_angle_squares, wedge};
pub use flat::{cuboid, sheet, tetrahedron};
pub use gearbox::{Assembly, gearbox};
pub use round::{bumpy_sphere, disc, ellipsoid, icosphere, torus, uv_sphere};

use std::ops::Range;

use glam::{DAffine3, DVec3};

use super::TriMesh;
use crate::geom;

/// A mesh whose surfaces have names, for closed forms that hold on a part of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Tagged {
    /// All surfaces together.
    pub mesh: TriMesh,
    /// Name and triangles of each surface; together they cover the mesh in order.
    pub surfaces: Vec<(&'static str, Range<usize>)>,
    /// Area of the flat opening that leads inside, of the mesh itself rather than the smooth shape; 0 without one.
    pub opening_area: f64,
}

impl Tagged {
    /// Triangles of the surface called `name`; empty where there is none.
    #[must_use]
    pub fn triangles(&self, name: &str) -> Range<usize> {
        self.surfaces.iter().find(|(n, _)| *n == name).map_or(0..0, |(_, range)| range.clone())
    }

    /// Area of the surface called `name`, in model units squared.
    #[must_use]
    pub fn area(&self, name: &str) -> f64 {
        let corners = |t: &[u32; 3]| t.map(|v| self.mesh.positions()[v as usize]);
        self.mesh.triangles()[self.triangles(name)].iter().map(|t| geom::triangle_area(corners(t))).sum()
    }

    /// Named meshes one after the other.
    fn of(pieces: &[(&'static str, TriMesh)], opening_area: f64) -> Self {
        let mut start = 0;
        let surfaces = pieces
            .iter()
            .map(|(name, mesh)| {
                let range = start..start + mesh.triangle_count();
                start = range.end;
                (*name, range)
            })
            .collect();
        let mesh = merged(pieces.iter().map(|(_, mesh)| mesh));
        Self { mesh, surfaces, opening_area }
    }
}

/// Several meshes as one, vertices and triangles in the order given; nothing is welded. `None` for no mesh.
#[must_use]
pub fn merge(meshes: &[TriMesh]) -> Option<TriMesh> {
    (!meshes.is_empty()).then(|| merged(meshes.iter()))
}

/// [`merge`] of at least one mesh.
fn merged<'a>(meshes: impl Iterator<Item = &'a TriMesh>) -> TriMesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for mesh in meshes {
        let offset = u32::try_from(positions.len()).expect("generated meshes stay far below 2^32 vertices");
        positions.extend_from_slice(mesh.positions());
        triangles.extend(mesh.triangles().iter().map(|t| t.map(|v| v + offset)));
    }
    TriMesh::new(positions, triangles).expect("meshes that are valid one by one are valid together")
}

/// The mesh moved by `placement`, its triangles turned over where the placement mirrors, so that outside stays outside.
///
/// # Errors
/// [`super::MeshError::BadCoordinate`] where the placement throws a vertex out of range.
pub fn transformed(mesh: &TriMesh, placement: &DAffine3) -> Result<TriMesh, super::MeshError> {
    let mirrors = placement.matrix3.determinant() < 0.0;
    let positions = mesh.positions().iter().map(|&p| placement.transform_point3(p)).collect();
    let triangles = mesh.triangles().iter().map(|&[a, b, c]| if mirrors { [a, c, b] } else { [a, b, c] }).collect();
    TriMesh::new(positions, triangles)
}

/// The same surface with its other side out.
fn turned_over(mesh: &TriMesh) -> TriMesh {
    let triangles = mesh.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
    TriMesh::new(mesh.positions().to_vec(), triangles).expect("turning triangles over keeps a mesh valid")
}

/// The mesh moved by `offset`.
fn moved(mesh: &TriMesh, offset: DVec3) -> TriMesh {
    transformed(mesh, &DAffine3::from_translation(offset)).expect("test pieces are small and move a little")
}
