use crate::raster::project::{ScreenVertex, round_to_i32};

/// Depth over the screen, from corners in canonical order.
pub(super) struct DepthPlane {
    origin: [f64; 3],
    per_column: f64,
    per_row: f64,
    least: f64,
    most: f64,
    pixel: f64,
}

impl DepthPlane {
    #[inline]
    pub fn new([a, b, c]: [&ScreenVertex; 3], doubled_area: i64, bits: u32) -> Self {
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
    pub fn along_row(&self, row: i32) -> RowDepth {
        let start = self.origin[2] + self.per_row * (f64::from(row) * self.pixel - self.origin[1])
            - self.per_column * self.origin[0];
        RowDepth { start, per_pixel: self.per_column * self.pixel, least: self.least, most: self.most }
    }
}

/// Depth along one row of pixels.
pub(super) struct RowDepth {
    start: f64,
    per_pixel: f64,
    least: f64,
    most: f64,
}

impl RowDepth {
    /// Depth at the centre of a pixel; kept between the corners, where a triangle seen edge-on would overshoot.
    #[inline]
    pub fn at(&self, column: i32) -> i32 {
        let depth = self.start + f64::from(column) * self.per_pixel;
        // Spelled out because `f64::max` also looks after NaN, which cannot be here.
        let depth = if depth < self.least { self.least } else { depth };
        round_to_i32(if depth > self.most { self.most } else { depth })
    }
}
