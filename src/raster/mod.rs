//! A CPU rasteriser that draws both item buffers of an axis in one pass over the triangles.
//!
//! For every pixel centre of a [`View`](crate::camera::View) it finds the triangle nearest to the camera at +d and the one nearest to the
//! camera at −d: an item buffer (Zhang & Turk 2002, section 4) for each of the two.
//!
//! The answer is exact and watertight for the vertices as snapped to a grid far finer than a pixel (2⁻¹⁸ of one at 480
//! pixels): edge functions are integers, a pixel centre on an edge belongs to one of the two triangles (top-left rule),
//! and triangles at equal depth are ordered by number.

mod cluster;
mod depth;
mod draw;
mod edges;
mod item_buffer;
mod project;
mod scene;
mod shade;

pub use draw::Screen;
pub use item_buffer::{Hit, ItemBufferPair, Side, depth_step};
pub use scene::Scene;
pub use shade::{GreyImage, shade};
