//! The inner loop: from the triangles of a cluster to pixels.
//!
//! Each step goes over all triangles and leaves a list for the next, so that which of them go on, which nobody can
//! foresee, costs no mispredicted branch.

use crate::mesh::TriangleId;
use crate::raster::cluster::{CLUSTER_TRIANGLES, CLUSTER_VERTICES, Cluster, Triangle};
use crate::raster::depth::DepthPlane;
use crate::raster::edges::{Block, Edges, pixels_of};
use crate::raster::item_buffer::{Hit, ItemBufferPair, Side, offer, raise, tag};
use crate::raster::project::{Projection, ScreenVertex};

/// Room to draw a cluster in, small enough for the fastest cache; kept by the caller from view to view.
#[derive(Debug)]
pub struct Screen {
    vertices: [ScreenVertex; CLUSTER_VERTICES],
    /// First column and row of pixel centres not below a vertex, and minus the last ones not above it: the least of
    /// three gives a triangle's block.
    bounds: [[i32; 4]; CLUSTER_VERTICES],
    candidates: [Candidate; CLUSTER_TRIANGLES],
    covering: [Covering; CLUSTER_TRIANGLES],
}

/// A triangle with pixel centres in its bounding box.
#[derive(Debug, Clone, Copy, Default)]
struct Candidate {
    triangle: u32,
    block: Block,
}

/// A small triangle that covers pixels.
#[derive(Debug, Clone, Copy, Default)]
struct Covering {
    triangle: u32,
    /// Column and row of the first pixel of its block.
    first: (i32, i32),
    mask: u64,
    doubled_area: i64,
}

impl Default for Screen {
    fn default() -> Self {
        Self {
            vertices: [ScreenVertex::default(); CLUSTER_VERTICES],
            bounds: [[0; 4]; CLUSTER_VERTICES],
            candidates: [Candidate::default(); CLUSTER_TRIANGLES],
            covering: [Covering::default(); CLUSTER_TRIANGLES],
        }
    }
}

impl Screen {
    /// Offers every pixel centre of every triangle to the buffers.
    pub(super) fn draw(&mut self, cluster: Cluster<'_>, projection: &Projection, buffers: &mut ItemBufferPair) {
        let (triangles, bits) = (cluster.triangles, projection.bits);
        self.project(cluster.positions, projection, buffers.window().width as i32 - 1);
        let candidates = self.select(triangles);
        let covering = self.cover(candidates, triangles, bits, buffers);
        self.fill_small(covering, triangles, bits, buffers);
    }

    fn project(&mut self, positions: &[[f32; 3]], projection: &Projection, last_pixel: i32) {
        let bits = projection.bits;
        let first = |x: i32| ((x + (1 << bits) - 1) >> bits).max(0);
        let last = |x: i32| (x >> bits).min(last_pixel);
        for ((vertex, bounds), &position) in self.vertices.iter_mut().zip(&mut self.bounds).zip(positions) {
            *vertex = projection.apply(position);
            *bounds = [first(vertex.column), first(vertex.row), -last(vertex.column), -last(vertex.row)];
        }
    }

    /// Lists the candidates; returns how many there are. On a fine mesh most triangles fall between the pixel centres.
    fn select(&mut self, triangles: &[Triangle]) -> usize {
        let mut count = 0;
        for (number, triangle) in (0..).zip(triangles) {
            let [a, b, c] = triangle.corners.map(|v| &self.bounds[v as usize]);
            let least = |i: usize| a[i].min(b[i]).min(c[i]);
            let block = Block { columns: (least(0), -least(2)), rows: (least(1), -least(3)) };
            self.candidates[count] = Candidate { triangle: number, block };
            count += usize::from(!block.is_empty());
        }
        count
    }

    /// Lists the small triangles that cover pixels, returns how many there are, and draws the large ones.
    fn cover(&mut self, count: usize, triangles: &[Triangle], bits: u32, buffers: &mut ItemBufferPair) -> usize {
        let mut covering = 0;
        for Candidate { triangle: number, block } in &self.candidates[..count] {
            let triangle = triangles[*number as usize];
            let corners = triangle.corners.map(|v| &self.vertices[v as usize]);
            if !block.is_small() {
                fill_large(triangle, corners, block, bits, buffers);
                continue;
            }
            let edges = Edges::new(corners, block, bits);
            let (mask, doubled_area) = (edges.cover(block), edges.doubled_area);
            let first = (block.columns.0, block.rows.0);
            self.covering[covering] = Covering { triangle: *number, first, mask, doubled_area };
            covering += usize::from((mask != 0) & (doubled_area != 0));
        }
        covering
    }

    fn fill_small(&self, count: usize, triangles: &[Triangle], bits: u32, buffers: &mut ItemBufferPair) {
        for covering in &self.covering[..count] {
            let triangle = triangles[covering.triangle as usize];
            let corners = triangle.corners.map(|v| &self.vertices[v as usize]);
            let hit = tag(seen(triangle, covering.doubled_area > 0));
            let plane = DepthPlane::new(corners, covering.doubled_area, bits);
            for (column, row) in pixels_of(covering.mask) {
                let (column, row) = (covering.first.0 + column, covering.first.1 + row);
                raise(&mut buffers.row_mut(row as usize)[column as usize], plane.along_row(row).at(column), hit);
            }
        }
    }
}

/// Draws a triangle row by row.
#[inline(never)]
fn fill_large(triangle: Triangle, corners: [&ScreenVertex; 3], block: &Block, bits: u32, buffers: &mut ItemBufferPair) {
    let edges = Edges::new(corners, block, bits);
    if edges.doubled_area == 0 {
        return;
    }
    let hit = tag(seen(triangle, edges.doubled_area > 0));
    let plane = DepthPlane::new(corners, edges.doubled_area, bits);
    let first = block.columns.0;
    edges.spans(block, |row, from, to| {
        let row = block.rows.0 + row;
        let depth = plane.along_row(row);
        let pixels = &mut buffers.row_mut(row as usize)[(first + from) as usize..=(first + to) as usize];
        for (column, pixel) in (first + from..).zip(pixels) {
            offer(pixel, depth.at(column), hit);
        }
    });
}

/// What the near camera sees of a triangle, given whether its ordered corners appear counter-clockwise.
fn seen(triangle: Triangle, counter_clockwise: bool) -> Hit {
    let reversed = triangle.code & 1 == 1;
    let side = if counter_clockwise == reversed { Side::Back } else { Side::Front };
    Hit { triangle: TriangleId(triangle.code >> 1), side }
}
