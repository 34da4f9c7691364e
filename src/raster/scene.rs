use crate::camera::{UnitMesh, View, Window};
use crate::error::Result;
use crate::raster::cluster::Clusters;
use crate::raster::draw::Screen;
use crate::raster::item_buffer::ItemBufferPair;
use crate::raster::project::Projection;

/// A mesh laid out for drawing from many sides.
#[derive(Debug)]
pub struct Scene {
    clusters: Clusters,
    extent: f64,
}

impl Scene {
    /// Lays out a mesh.
    #[must_use]
    pub fn new(mesh: UnitMesh) -> Self {
        Self { clusters: Clusters::new(&mesh.positions, &mesh.triangles), extent: mesh.extent }
    }

    /// Bytes that a worker needs to draw views through this window: a pair of buffers, mostly.
    #[must_use]
    pub fn bytes_per_worker(&self, window: Window) -> u64 {
        ItemBufferPair::bytes(window) + size_of::<Screen>() as u64
    }

    /// Draws both item buffers of a view, over what they held; triangles outside the window are clipped.
    ///
    /// `screen` is room to work in, kept by the caller from view to view.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] if the mesh is so much larger than the window that its vertices cannot be told apart.
    pub fn draw(&self, view: &View, screen: &mut Screen, buffers: &mut ItemBufferPair) -> Result<()> {
        let projection = Projection::new(view, self.extent).ok_or_else(|| view.window.too_small_for(self.extent))?;
        buffers.clear();
        for cluster in self.clusters.iter() {
            screen.draw(cluster, &projection, buffers);
        }
        Ok(())
    }
}
