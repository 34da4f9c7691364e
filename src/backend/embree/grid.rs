//! The ray grid: item buffers by one ray per pixel.

use glam::DVec3;

use crate::backend::ItemBuffers;
use crate::backend::embree::EmbreeScene;
use crate::backend::embree::scene::{Crossing, Line};
use crate::camera::{View, Window};
use crate::error::Result;
use crate::raster::{Hit, ItemBufferPair, Side, depth_step};

/// Rays of a packet: pixels side by side in a row.
const PACKET: u32 = 8;

/// Rays may start this much farther out than the mesh reaches: rounding to `f32` moves vertices a little.
const MARGIN: f64 = 1.001;

/// A pixel must be this many times wider than the rounding of a ray's origin.
const PIXEL_OVER_ROUNDING: f64 = 64.0;

/// Room for what a worker's rays cross, kept from view to view.
#[derive(Debug, Default)]
pub struct GridScratch(Vec<Crossing>);

/// One ray per pixel, from the near camera through everything to the far one.
///
/// Nearest and farthest of its crossings are what rays from the two ends of the line would hit first, so one pass through
/// the tree does for both. Embree decides only *whether* a line crosses a triangle; the depth is computed here, in `f64`
/// from the triangle's plane and like the raster's, so that coincident triangles tie exactly and the smaller number wins.
/// The `f32` distance that Embree reports would leave such ties to rounding.
///
/// Embree lets a line pass an edge by 2⁻²³ of the triangle's height. Beyond an outline that may be one triangle of the two
/// there, whose other side is then seen: one of two million pixels of a tetrahedron, none of six million of a sphere. It
/// stays so: to leave out what `f64` finds outside would open holes, for neighbours share an edge without gap in Embree's
/// rounding alone.
impl ItemBuffers for EmbreeScene {
    type Scratch = GridScratch;

    fn draw(&self, view: &View, scratch: &mut GridScratch, buffers: &mut ItemBufferPair) -> Result<()> {
        let lines = Lines::new(view, self.extent)?;
        let width = view.window.width;
        buffers.clear();
        for row in 0..width {
            for column in (0..width).step_by(PACKET as usize) {
                let count = PACKET.min(width - column) as usize;
                let packet: [Line; PACKET as usize] = std::array::from_fn(|i| lines.through(column + i as u32, row));
                scratch.0.clear();
                self.scene.crossings(&packet[..count], &mut scratch.0)?;
                for &crossing in &scratch.0 {
                    self.offer(crossing, view, buffers);
                }
            }
        }
        Ok(())
    }

    fn bytes_per_worker(&self, window: Window) -> u64 {
        ItemBufferPair::bytes(window)
    }
}

impl EmbreeScene {
    fn offer(&self, crossing: Crossing, view: &View, buffers: &mut ItemBufferPair) {
        let width = view.window.width;
        let centre = view.pixel_centre(crossing.line % width, crossing.line / width);
        let corners = self.scene.triangles()[crossing.primitive as usize]
            .map(|v| DVec3::from_array(self.scene.positions()[v as usize].map(f64::from)));
        let (triangle, reversed) = self.primitives[crossing.primitive as usize];
        if let Some((depth, counter_clockwise)) = depth_at(centre, view.toward, corners) {
            let depth = (depth / depth_step(view.window, self.extent)).round() as i32;
            let side = if counter_clockwise == reversed { Side::Back } else { Side::Front };
            buffers.offer(crossing.line as usize, depth, Hit { triangle, side });
        }
    }
}

/// Depth of a triangle's plane at a pixel centre, and whether its corners appear counter-clockwise; `None` edge-on.
///
/// A centre that rounding put just outside the triangle gets no depth outside that of its corners.
fn depth_at(centre: DVec3, toward: DVec3, [a, b, c]: [DVec3; 3]) -> Option<(f64, bool)> {
    let normal = (b - a).cross(c - a);
    let facing = normal.dot(toward);
    let corner_depths = [a, b, c].map(|p| p.dot(toward));
    let low = corner_depths.into_iter().fold(f64::INFINITY, f64::min);
    let high = corner_depths.into_iter().fold(f64::NEG_INFINITY, f64::max);
    (facing != 0.0).then(|| (((a - centre).dot(normal) / facing).clamp(low, high), facing > 0.0))
}

/// The lines through a view's pixel centres, from the near camera.
struct Lines<'a> {
    view: &'a View,
    direction: [f32; 3],
    /// From a pixel centre to where its ray starts.
    back: DVec3,
}

impl<'a> Lines<'a> {
    fn new(view: &'a View, extent: f64) -> Result<Self> {
        let reach = MARGIN * extent.max(view.window.half_width);
        if reach * f64::from(f32::EPSILON) * PIXEL_OVER_ROUNDING > view.window.pixel_size() {
            return Err(view.window.too_small_for(extent));
        }
        let direction = (-view.toward).as_vec3();
        // Back along the rounded direction, so that the line still goes through the pixel centre.
        Ok(Self { view, direction: direction.to_array(), back: -reach * direction.as_dvec3() })
    }

    fn through(&self, column: u32, row: u32) -> Line {
        let origin = (self.view.pixel_centre(column, row) + self.back).as_vec3().to_array();
        Line { origin, direction: self.direction, number: row * self.view.window.width + column }
    }
}
