use std::collections::BTreeSet;

use glam::DVec3;

use super::fault::Fault;
use super::polygon::Polygons;
use super::{Dropped, Format, Loaded};
use crate::mesh::{self, TriMesh};

/// What every reader ends in: vertices and polygons in the order of the file, indices not yet checked.
#[derive(Debug, Default)]
pub(super) struct Soup {
    pub(super) positions: Vec<DVec3>,
    pub(super) polygons: Polygons,
    pub(super) dropped: BTreeSet<Dropped>,
    /// Vertices that the reader merged, where the format has no indices.
    pub(super) welded: Option<usize>,
}

impl Soup {
    /// Memory it takes, in bytes.
    pub(super) fn bytes(&self) -> u64 {
        size_of_val(self.positions.as_slice()) as u64 + self.polygons.bytes()
    }

    /// The mesh: polygons become triangles, welded if asked for; what is no triangle is set aside.
    pub(super) fn into_loaded(mut self, format: Format, weld: bool) -> Result<Loaded, Fault> {
        let mut triangles = self.polygons.into_triangles(&self.positions)?;
        if weld && self.welded.is_none() {
            let merged;
            (self.positions, triangles, merged) = mesh::weld(self.positions, triangles);
            self.welded = Some(merged);
        }
        let (mesh, set_aside) = TriMesh::from_triangles(self.positions, triangles)?;
        let dropped = self.dropped.into_iter().collect();
        Ok(Loaded { mesh, format, dropped, set_aside, welded: self.welded })
    }
}
