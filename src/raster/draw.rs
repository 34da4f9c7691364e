//! The inner loop: from projected vertices to pixels.

use crate::mesh::TriangleId;
use crate::raster::item_buffer::{Hit, ItemBufferPair, Side, offer, tag};
use crate::raster::project::{ScreenVertex, round_to_i32};

/// A triangle to draw, its corners ordered by position.
///
/// The order makes the depth of coincident triangles bitwise equal whatever order, winding or vertex numbers they are
/// stored with, so that the tie goes to the smaller triangle number.
#[derive(Debug, Clone, Copy)]
pub(super) struct Triangle {
    corners: [u32; 3],
    /// Twice the triangle's number, plus 1 if ordering the corners reversed the winding.
    code: u32,
}

impl Triangle {
    pub fn new(corners: [u32; 3], id: TriangleId, positions: &[[f32; 3]]) -> Self {
        let mut ordered = corners;
        let mut reversed = false;
        for (i, j) in [(0, 1), (1, 2), (0, 1)] {
            if precedes(ordered[j], ordered[i], positions) {
                ordered.swap(i, j);
                reversed = !reversed;
            }
        }
        Self { corners: ordered, code: id.0 << 1 | u32::from(reversed) }
    }

    /// What the near camera sees of it, given whether the ordered corners appear counter-clockwise.
    fn seen(self, counter_clockwise: bool) -> Hit {
        let reversed = self.code & 1 == 1;
        let side = if counter_clockwise == reversed { Side::Back } else { Side::Front };
        Hit { triangle: TriangleId(self.code >> 1), side }
    }
}

fn precedes(a: u32, b: u32, positions: &[[f32; 3]]) -> bool {
    let (pa, pb) = (positions[a as usize], positions[b as usize]);
    let differing = pa.iter().zip(&pb).find(|(x, y)| x != y);
    differing.is_some_and(|(x, y)| x < y)
}

/// Offers every pixel centre of every triangle to the buffers.
pub(super) fn draw(triangles: &[Triangle], vertices: &[ScreenVertex], bits: u32, buffers: &mut ItemBufferPair) {
    let last_pixel = buffers.window().width as i32 - 1;
    for &triangle in triangles {
        let corners = triangle.corners.map(|v| vertices[v as usize]);
        let columns = pixel_range(corners.map(|c| c.column), bits, last_pixel);
        let rows = pixel_range(corners.map(|c| c.row), bits, last_pixel);
        // On a fine mesh most triangles fall between the pixel centres and end here.
        if columns.0 <= columns.1 && rows.0 <= rows.1 {
            fill(triangle, corners, Block { columns, rows, bits }, buffers);
        }
    }
}

/// First and last pixel whose centre lies within the span of three coordinates.
#[inline]
fn pixel_range([a, b, c]: [i32; 3], bits: u32, last_pixel: i32) -> (i32, i32) {
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    (((low + (1 << bits) - 1) >> bits).max(0), (high >> bits).min(last_pixel))
}

/// The pixels around a triangle.
#[derive(Clone, Copy)]
struct Block {
    columns: (i32, i32),
    rows: (i32, i32),
    bits: u32,
}

/// Up to this many columns each pixel is tested; beyond, the span of a row is computed by division.
const TESTED_COLUMNS: i32 = 4;

fn fill(triangle: Triangle, corners: [ScreenVertex; 3], block: Block, buffers: &mut ItemBufferPair) {
    let doubled_area = edge_function(corners[0], corners[1], corners[2].column, corners[2].row);
    if doubled_area == 0 {
        return;
    }
    let hit = tag(triangle.seen(doubled_area > 0));
    let [a, b, c] = corners;
    let (second, third) = if doubled_area > 0 { (b, c) } else { (c, b) };
    let mut edges = [(a, second), (second, third), (third, a)].map(|(p, q)| Edge::new(p, q, block));
    let plane = DepthPlane::new(corners, doubled_area, block.bits);
    let (first, last) = block.columns;
    for row in block.rows.0..=block.rows.1 {
        let span = if last - first < TESTED_COLUMNS {
            tested_span(&edges, last - first)
        } else {
            computed_span(&edges, last - first)
        };
        if let Some((from, to)) = span {
            let depth = plane.along_row(row);
            let pixels = &mut buffers.row_mut(row as usize)[(first + from) as usize..=(first + to) as usize];
            for (column, pixel) in (first + from..).zip(pixels) {
                offer(pixel, depth.at(column), hit);
            }
        }
        edges.iter_mut().for_each(Edge::next_row);
    }
}

/// Twice the signed area of (a, b, point): positive where the point lies to the left of a → b. Exact.
#[inline]
fn edge_function(a: ScreenVertex, b: ScreenVertex, column: i32, row: i32) -> i64 {
    let wide = |x: i32, y: i32| i64::from(x) - i64::from(y);
    wide(b.column, a.column) * wide(row, a.row) - wide(b.row, a.row) * wide(column, a.column)
}

/// An edge of a counter-clockwise triangle; a pixel is inside where `value` is not negative.
#[derive(Clone, Copy)]
struct Edge {
    /// At the first column of the current row; 1 less on edges that do not own their pixels.
    value: i64,
    per_column: i64,
    per_row: i64,
}

impl Edge {
    #[inline]
    fn new(a: ScreenVertex, b: ScreenVertex, block: Block) -> Self {
        let (dx, dy) = (i64::from(b.column) - i64::from(a.column), i64::from(b.row) - i64::from(a.row));
        // Top-left rule, rows going up: left edges run downward, top edges run leftward.
        let owns = dy < 0 || (dy == 0 && dx < 0);
        let value = edge_function(a, b, block.columns.0 << block.bits, block.rows.0 << block.bits);
        Self { value: value - i64::from(!owns), per_column: -dy << block.bits, per_row: dx << block.bits }
    }

    #[inline]
    fn next_row(&mut self) {
        self.value += self.per_row;
    }
}

/// First and last column inside all edges, counted from the first, by looking at each.
#[inline]
fn tested_span(edges: &[Edge; 3], last: i32) -> Option<(i32, i32)> {
    let inside = |column: i32| edges.iter().all(|e| e.value + i64::from(column) * e.per_column >= 0);
    let from = (0..=last).find(|&c| inside(c))?;
    let to = (from..last).take_while(|&c| inside(c + 1)).count() as i32;
    Some((from, from + to))
}

/// The same by dividing: a row of a triangle is one interval.
#[inline]
fn computed_span(edges: &[Edge; 3], last: i32) -> Option<(i32, i32)> {
    let (mut from, mut to) = (0, i64::from(last));
    for edge in edges {
        match edge.per_column {
            0 if edge.value < 0 => return None,
            0 => {}
            step if step > 0 => from = from.max(div_ceil(-edge.value, step)),
            step => to = to.min(edge.value.div_euclid(-step)),
        }
    }
    (from <= to).then_some((from as i32, to as i32))
}

/// Quotient rounded up, for a positive divisor.
#[inline]
fn div_ceil(a: i64, b: i64) -> i64 {
    -(-a).div_euclid(b)
}

/// Depth over the screen, from corners in canonical order.
struct DepthPlane {
    origin: [f64; 3],
    per_column: f64,
    per_row: f64,
    least: f64,
    most: f64,
    pixel: f64,
}

impl DepthPlane {
    #[inline]
    fn new([a, b, c]: [ScreenVertex; 3], doubled_area: i64, bits: u32) -> Self {
        let difference = |x: i32, y: i32| f64::from(x) - f64::from(y);
        let (bx, by, bz) = (difference(b.column, a.column), difference(b.row, a.row), difference(b.depth, a.depth));
        let (cx, cy, cz) = (difference(c.column, a.column), difference(c.row, a.row), difference(c.depth, a.depth));
        let area = doubled_area as f64;
        Self {
            origin: [a.column, a.row, a.depth].map(f64::from),
            per_column: (bz * cy - cz * by) / area,
            per_row: (cz * bx - bz * cx) / area,
            least: f64::from(a.depth.min(b.depth).min(c.depth)),
            most: f64::from(a.depth.max(b.depth).max(c.depth)),
            pixel: f64::from(1_u32 << bits),
        }
    }

    #[inline]
    fn along_row(&self, row: i32) -> RowDepth {
        let start = self.origin[2] + self.per_row * (f64::from(row) * self.pixel - self.origin[1])
            - self.per_column * self.origin[0];
        RowDepth { start, per_pixel: self.per_column * self.pixel, least: self.least, most: self.most }
    }
}

/// Depth along one row of pixels.
struct RowDepth {
    start: f64,
    per_pixel: f64,
    least: f64,
    most: f64,
}

impl RowDepth {
    /// Depth at the centre of a pixel; kept between the corners, where a triangle seen edge-on would overshoot.
    #[inline]
    fn at(&self, column: i32) -> i32 {
        let depth = self.start + f64::from(column) * self.per_pixel;
        // Spelled out because `f64::max` also looks after NaN, which cannot be here.
        let depth = if depth < self.least { self.least } else { depth };
        round_to_i32(if depth > self.most { self.most } else { depth })
    }
}
