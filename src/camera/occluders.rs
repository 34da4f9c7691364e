use glam::DVec3;

use crate::camera::Frame;
use crate::error::{Error, Result};
use crate::mesh::{TriMesh, TriangleId};

/// How far the sheets of an occluder stand apart, as a share of the reach of the scene: hundreds of times what positions
/// and depths are rounded by, and a hundredth of a pixel.
const CONTACT: f64 = 4e-6;

/// How far an occluder may reach, in radii of the mesh. There its sheets stand 0.4 % of the radius apart, about a pixel; at
/// 100,000 a floor would swallow a fifth of what stands on it, at 1,000,000 all, and beyond 10³⁸ it would leave `f32`.
const MOST_REACH: f64 = 1000.0;

/// Occluders as the mesh among them is seen: in its frame, each as three sheets.
///
/// The sheets, the occluder itself and a shifted copy to either side, stand a few millionths of the scene apart: surface
/// that lies on an occluder, as a part on a floor, is between them and hidden, whatever rounding says.
#[derive(Debug, Clone, Copy)]
pub struct Occluders<'a> {
    frame: Frame,
    meshes: &'a [TriMesh],
    extent: f64,
}

impl<'a> Occluders<'a> {
    /// Puts occluders around the mesh of a frame.
    ///
    /// # Errors
    /// As [`Occluders::check`].
    pub fn around(frame: Frame, meshes: &'a [TriMesh]) -> Result<Self> {
        let mut extent = 1.0_f64;
        for (number, mesh) in (1..).zip(meshes) {
            extent = extent.max(Self::check(frame, mesh, &format!("occluder {number}"))?);
        }
        Ok(Self { frame, meshes, extent })
    }

    /// How far an occluder, called `name` in messages, reaches from the centre of the frame, in unit-sphere units.
    ///
    /// # Errors
    /// [`Error::Limit`] for one that reaches more than a thousand times as far as the mesh of the frame.
    pub fn check(frame: Frame, mesh: &TriMesh, name: &str) -> Result<f64> {
        let reach = frame.reach(mesh);
        // Not a number where the mesh is far smaller than any that is read from a file.
        if reach <= MOST_REACH {
            return Ok(reach);
        }
        let message = format!(
            "{name}: reaches {reach:.1e} times as far as the mesh, an occluder at most {MOST_REACH} times; are the units the \
             same? for an endless floor use --hemisphere"
        );
        Err(Error::Limit { message })
    }

    /// Triangles of all occluders, degenerate ones included.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.meshes.iter().map(TriMesh::triangle_count).sum()
    }

    /// How far they reach from the centre, sheets included; at least 1.
    #[must_use]
    pub fn extent(&self) -> f64 {
        if self.meshes.is_empty() { self.extent } else { self.extent + self.shift() }
    }

    fn shift(&self) -> f64 {
        CONTACT * self.extent
    }

    /// Corners of every sheet, in unit-sphere units, with the number of its triangle among those of all occluders, from 0.
    pub fn sheets(&self) -> impl Iterator<Item = (u32, [DVec3; 3])> {
        let Self { frame, meshes, .. } = *self;
        let shift = self.shift();
        let triangles =
            meshes.iter().flat_map(|mesh| (0..mesh.triangle_count() as u32).map(move |t| (mesh, TriangleId(t))));
        (0..).zip(triangles).flat_map(move |(number, (mesh, id))| {
            let normal = frame.area_and_normal(mesh, id).map(|(_, normal)| normal);
            let corners = mesh.corners(id).map(|p| frame.to_unit(p));
            let distances = if normal.is_some() { &[-1.0, 0.0, 1.0][..] } else { &[] };
            let normal = normal.unwrap_or_default();
            distances.iter().map(move |sheet| (number, corners.map(|p| p + sheet * shift * normal)))
        })
    }
}
