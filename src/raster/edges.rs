//! Which pixel centres a triangle owns: exact integer edge functions and the top-left rule.

use crate::raster::project::ScreenVertex;

/// Pixels around a triangle, within the window.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Block {
    /// First and last column.
    pub columns: (i32, i32),
    /// First and last row.
    pub rows: (i32, i32),
}

impl Block {
    /// Up to this many columns and rows a block is small: its pixels are the bits of a word.
    const SMALL: i32 = 8;

    #[inline]
    pub fn is_empty(&self) -> bool {
        (self.columns.0 > self.columns.1) | (self.rows.0 > self.rows.1)
    }

    #[inline]
    pub fn is_small(&self) -> bool {
        (self.columns.1 - self.columns.0 < Self::SMALL) & (self.rows.1 - self.rows.0 < Self::SMALL)
    }
}

/// The edges of a triangle over a block; a pixel is inside where no value is negative.
pub(super) struct Edges {
    /// At the block's first pixel; 1 less on edges that do not own the pixels on them.
    values: [i64; 3],
    per_column: [i64; 3],
    per_row: [i64; 3],
    /// Twice the signed area of the triangle, positive where its corners appear counter-clockwise.
    pub doubled_area: i64,
}

impl Edges {
    /// The edges of a triangle whose coordinates have `bits` binary digits below a pixel.
    #[inline]
    pub fn new(corners: [&ScreenVertex; 3], block: &Block, bits: u32) -> Self {
        let (column, row) = (block.columns.0 << bits, block.rows.0 << bits);
        let [a, b, c] = corners.map(|p| (i64::from(p.column - column), i64::from(p.row - row)));
        // Seen from the block's first pixel, an edge function is the cross product of the edge's ends.
        let cross = |p: (i64, i64), q: (i64, i64)| p.0 * q.1 - p.1 * q.0;
        let areas = [cross(a, b), cross(b, c), cross(c, a)];
        let doubled_area = areas[0] + areas[1] + areas[2];
        // All ones where the corners appear clockwise and the edges must be turned around.
        let clockwise = doubled_area >> 63;
        let turn = |x: i64| (x ^ clockwise) - clockwise;
        let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| (turn(q.0 - p.0), turn(q.1 - p.1)));
        // Top-left rule, rows going up: left edges run downward, top edges run leftward.
        let owns = |(dx, dy): (i64, i64)| (dy < 0) | ((dy == 0) & (dx < 0));
        let value = |i: usize| turn(areas[i]) - i64::from(!owns(sides[i]));
        Self {
            values: [value(0), value(1), value(2)],
            per_column: sides.map(|(_, dy)| -dy << bits),
            per_row: sides.map(|(dx, _)| dx << bits),
            doubled_area,
        }
    }

    /// The pixels of a small block that are inside: bit 8 · row + column, counted from its first.
    #[inline]
    pub fn cover(&self, block: &Block) -> u64 {
        let (columns, rows) = (block.columns.1 - block.columns.0, block.rows.1 - block.rows.0);
        let (mut mask, mut row_values) = (0, self.values);
        for row in 0..=rows {
            let mut values = row_values;
            for column in 0..=columns {
                let inside = (values[0] | values[1] | values[2]) >= 0;
                mask |= u64::from(inside) << (Block::SMALL * row + column);
                add(&mut values, &self.per_column);
            }
            add(&mut row_values, &self.per_row);
        }
        mask
    }

    /// For each row of the block, from its first: first and last column inside, counted from the block's first.
    ///
    /// A row of a triangle is one interval.
    pub fn spans(&self, block: &Block) -> impl Iterator<Item = Option<(i32, i32)>> {
        let last = i64::from(block.columns.1 - block.columns.0);
        let mut crossings = [0, 1, 2].map(|i| Crossing::new(self.values[i], self.per_column[i], self.per_row[i]));
        (block.rows.0..=block.rows.1).map(move |_| {
            let (mut from, mut to, mut inside) = (0, last, true);
            for crossing in &mut crossings {
                match crossing.bound {
                    Bound::First => from = from.max(-crossing.quotient),
                    Bound::Last => to = to.min(crossing.quotient),
                    Bound::Row => inside &= crossing.quotient >= 0,
                }
                crossing.next_row();
            }
            (inside & (from <= to)).then_some((from as i32, to as i32))
        })
    }
}

#[inline]
fn add(values: &mut [i64; 3], steps: &[i64; 3]) {
    for (value, step) in values.iter_mut().zip(steps) {
        *value += step;
    }
}

/// The pixels that bits of [`Edges::cover`] stand for, (column, row) counted from the block's first.
#[inline]
pub(super) fn pixels_of(mut mask: u64) -> impl Iterator<Item = (i32, i32)> {
    std::iter::from_fn(move || {
        let bit = mask.trailing_zeros() as i32;
        (mask != 0).then(|| {
            mask &= mask - 1;
            (bit % Block::SMALL, bit / Block::SMALL)
        })
    })
}

/// What an edge bounds in a row of pixels.
#[derive(Clone, Copy)]
enum Bound {
    First,
    Last,
    /// All of the row, for it is level.
    Row,
}

/// Where an edge crosses a row of pixels: its value divided by its step, carried from row to row without dividing.
struct Crossing {
    bound: Bound,
    divisor: i64,
    quotient: i64,
    remainder: i64,
    /// Quotient and remainder of what a row adds to the value.
    per_row: (i64, i64),
}

impl Crossing {
    fn new(value: i64, per_column: i64, per_row: i64) -> Self {
        let bound = match per_column {
            0 => Bound::Row,
            step if step > 0 => Bound::First,
            _ => Bound::Last,
        };
        let divisor = per_column.abs().max(1);
        let divide = |x: i64| (x.div_euclid(divisor), x.rem_euclid(divisor));
        let (quotient, remainder) = divide(value);
        Self { bound, divisor, quotient, remainder, per_row: divide(per_row) }
    }

    #[inline]
    fn next_row(&mut self) {
        self.remainder += self.per_row.1;
        let carry = self.remainder >= self.divisor;
        self.remainder -= if carry { self.divisor } else { 0 };
        self.quotient += self.per_row.0 + i64::from(carry);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Corners on a grid of quarter pixels, so that many edges are level, upright or pass through pixel centres.
    #[test]
    fn spans_are_the_pixels_that_cover_finds_one_by_one() {
        let block = Block { columns: (0, 7), rows: (0, 6) };
        let mut covered = 0;
        for seed in 0..20_000_u64 {
            let bits = |shift: u64| (seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> shift) as i32 & 63;
            let vertex = |i: u64| ScreenVertex { column: bits(64 - 6 * i) - 16, row: bits(46 - 6 * i) - 16, depth: 0 };
            let corners = [vertex(1), vertex(2), vertex(3)];
            let edges = Edges::new(corners.each_ref(), &block, 2);
            if edges.doubled_area == 0 {
                continue;
            }
            let mut mask = 0;
            for (row, span) in edges.spans(&block).enumerate() {
                for column in span.map_or(0..0, |(from, to)| from..to + 1) {
                    mask |= 1_u64 << (8 * row as i32 + column);
                }
            }
            assert_eq!(mask, edges.cover(&block), "{corners:?}");
            covered += mask.count_ones();
        }
        assert!(covered > 10_000, "{covered} pixels say little");
    }
}
