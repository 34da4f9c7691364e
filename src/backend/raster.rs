use crate::backend::ItemBuffers;
use crate::camera::{View, Window};
use crate::error::Result;
use crate::raster::{ItemBufferPair, Scene, Screen};

impl ItemBuffers for Scene {
    type Scratch = Screen;

    fn draw(&self, view: &View, screen: &mut Screen, buffers: &mut ItemBufferPair) -> Result<()> {
        Self::draw(self, view, screen, buffers)
    }

    fn bytes_per_worker(&self, window: Window) -> u64 {
        Self::bytes_per_worker(self, window)
    }
}
