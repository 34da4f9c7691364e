use crate::camera::View;
use crate::raster::item_buffer::depth_step;

/// A vertex as a view sees it.
///
/// Column and row are in units of 2^-`bits` pixels, 0 at the centre of pixel 0; depth is in steps of
/// [`depth_step`] and grows toward the near camera.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[repr(C, align(16))]
pub(super) struct ScreenVertex {
    pub column: i32,
    pub row: i32,
    pub depth: i32,
}

/// Snaps unit-sphere coordinates to the integer grid of a view.
#[derive(Debug, Clone, Copy)]
pub(super) struct Projection {
    /// Rows of the map: (direction, offset) for column, row and depth.
    column: ([f64; 3], f64),
    row: ([f64; 3], f64),
    depth: [f64; 3],
    /// Binary digits below a pixel.
    pub bits: u32,
}

/// Screen coordinates stay below 2^27, so that an edge function, a difference of two products of differences, stays
/// below 2^58 and is exact in `i64`.
const COORDINATE_BITS: u32 = 27;

/// Finer than this brings nothing over `f32` input.
const MAX_SUBPIXEL_BITS: u32 = 20;

/// With fewer the picture would no longer be the mesh's; see [`Projection::new`].
const MIN_SUBPIXEL_BITS: u32 = 6;

impl Projection {
    /// The map for a mesh that reaches `extent` from the centre; `None` where that is so much larger than the window
    /// that pixels can no longer be told apart.
    pub fn new(view: &View, extent: f64) -> Option<Self> {
        let (s, h) = (view.window.pixel_size(), view.window.half_width);
        // Rounding to `f32` may carry a vertex a little past the extent.
        let reach = 1.0001 * extent.max(h);
        let pixels = (reach + h) / s + 1.0;
        let whole_bits = (0..=COORDINATE_BITS).find(|&b| pixels <= f64::from(1_u32 << b))?;
        let bits = (COORDINATE_BITS - whole_bits).min(MAX_SUBPIXEL_BITS);
        if bits < MIN_SUBPIXEL_BITS {
            return None;
        }
        let per_unit = f64::from(1_u32 << bits) / s;
        let offset = (h / s - 0.5) * f64::from(1_u32 << bits);
        Some(Self {
            column: ((view.right * per_unit).to_array(), offset),
            row: ((view.up * per_unit).to_array(), offset),
            depth: (view.toward / depth_step(view.window, extent)).to_array(),
            bits,
        })
    }

    #[inline]
    pub fn apply(&self, p: [f32; 3]) -> ScreenVertex {
        let [x, y, z] = p.map(f64::from);
        let dot = |d: [f64; 3]| d[0] * x + d[1] * y + d[2] * z;
        ScreenVertex {
            column: round_to_i32(dot(self.column.0) + self.column.1),
            row: round_to_i32(dot(self.row.0) + self.row.1),
            depth: round_to_i32(dot(self.depth)),
        }
    }
}

/// Nearest integer (ties to even) of a number below 2³¹ in magnitude.
///
/// Adding 1.5 · 2⁵² leaves the integer in the low bits of the sum; unlike `as`, it needs no range check and vectorises.
#[inline]
pub(super) fn round_to_i32(x: f64) -> i32 {
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    (x + SHIFT).to_bits() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_by_shift_is_rounding() {
        for x in [0.0, 0.49, 0.5, 1.5, -0.5, -1.5, -7.51, 123_456_789.4, -2_147_483_000.0, 2_147_483_000.0] {
            assert_eq!(round_to_i32(x), x.round_ties_even() as i32, "{x}");
        }
    }
}
