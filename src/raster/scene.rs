use crate::camera::{UnitMesh, View, Window};
use crate::error::{Error, Result};
use crate::raster::draw::{Triangle, draw};
use crate::raster::item_buffer::ItemBufferPair;
use crate::raster::project::{Projection, ScreenVertex};

/// A mesh laid out for drawing from many sides.
#[derive(Debug)]
pub struct Scene {
    positions: Vec<[f32; 3]>,
    triangles: Vec<Triangle>,
    extent: f64,
}

impl Scene {
    /// Lays out a mesh.
    #[must_use]
    pub fn new(mesh: UnitMesh) -> Self {
        let triangles = mesh.triangles.iter().map(|&(corners, id)| Triangle::new(corners, id, &mesh.positions));
        Self { triangles: triangles.collect(), extent: mesh.extent, positions: mesh.positions }
    }

    /// Bytes that a worker needs to draw views through this window: a pair of buffers and the projected vertices.
    #[must_use]
    pub fn bytes_per_worker(&self, window: Window) -> u64 {
        ItemBufferPair::bytes(window) + (self.positions.len() * size_of::<ScreenVertex>()) as u64
    }

    /// Draws both item buffers of a view, over what they held; triangles outside the window are clipped.
    ///
    /// `screen` is room for the projected vertices, kept by the caller from view to view.
    ///
    /// # Errors
    /// [`Error::Limit`] if the mesh is so much larger than the window that its vertices cannot be told apart.
    pub fn draw(&self, view: &View, screen: &mut Screen, buffers: &mut ItemBufferPair) -> Result<()> {
        let projection = Projection::new(view, self.extent).ok_or_else(|| Error::Limit {
            message: format!(
                "a mesh {:.0} times larger than the picture cannot be drawn; are the units the same?",
                self.extent / view.window.half_width
            ),
        })?;
        screen.0.clear();
        screen.0.extend(self.positions.iter().map(|&p| projection.apply(p)));
        buffers.clear();
        draw(&self.triangles, &screen.0, projection.bits, buffers);
        Ok(())
    }
}

/// The vertices of a scene as a view sees them.
#[derive(Debug, Default)]
pub struct Screen(Vec<ScreenVertex>);
