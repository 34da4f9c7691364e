//! Which pixel centres a triangle owns: exact integer edge functions and the top-left rule.

use std::ops::Range;

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
///
/// Values are in steps of a subpixel times a pixel, rounded down: from pixel to pixel they change by whole steps, so that
/// rounding changes no sign.
pub(super) struct Edges {
    /// At the block's first pixel; less on edges that do not own the pixels on them.
    values: [i64; 3],
    per_column: [i64; 3],
    per_row: [i64; 3],
    /// Heights of the corners over the block's first row, in subpixels. Edge i goes from corner i to the next.
    heights: [i64; 3],
    bits: u32,
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
        let value = |i: usize| (turn(areas[i]) - i64::from(!owns(sides[i]))) >> bits;
        Self {
            values: [value(0), value(1), value(2)],
            per_column: sides.map(|(_, dy)| -dy),
            per_row: sides.map(|(dx, _)| dx),
            heights: [a.1, b.1, c.1],
            bits,
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

    /// Hands over each row with pixels inside: the row, its first and its last column, counted from the block's first.
    ///
    /// A row of a triangle is one interval. Between the heights of two corners two edges bound it; all three do at the
    /// height of the middle corner.
    pub fn spans(&self, block: &Block, mut take: impl FnMut(i32, i32, i32)) {
        let last = block.columns.1 - block.columns.0;
        let end = block.rows.1 - block.rows.0 + 1;
        let [lowest, middle, highest] = self.corners_by_height();
        let edge_between = |p: usize, q: usize| if (p + 1) % 3 == q { p } else { q };
        let long = edge_between(lowest, highest);
        let height = self.heights[middle];
        let middle_row = (height >> self.bits).clamp(-1, i64::from(end)) as i32;
        let is_on_row = height == i64::from(middle_row) << self.bits;

        self.between(
            long,
            edge_between(lowest, middle),
            0..(middle_row + i32::from(!is_on_row)).min(end),
            last,
            &mut take,
        );
        if is_on_row && (0..end).contains(&middle_row) {
            self.row(middle_row, last, &mut take);
        }
        self.between(long, edge_between(middle, highest), (middle_row + 1).max(0)..end, last, &mut take);
    }

    /// The corners, by height.
    fn corners_by_height(&self) -> [usize; 3] {
        let mut corners = [0, 1, 2];
        corners.sort_unstable_by_key(|&i| self.heights[i]);
        corners
    }

    /// The spans of rows that two edges bound, neither of them level.
    #[inline]
    fn between(&self, p: usize, q: usize, rows: Range<i32>, last: i32, take: &mut impl FnMut(i32, i32, i32)) {
        let (left, right) = if self.per_column[p] > 0 { (p, q) } else { (q, p) };
        for start in rows.clone().step_by(Crossing::ROWS) {
            let mut from = Crossing::new(self, left, start);
            let mut to = Crossing::new(self, right, start);
            for row in start..rows.end.min(start + Crossing::ROWS as i32) {
                let (column, end) = ((-from.column()).max(0), to.column().min(i64::from(last)));
                if column <= end {
                    take(row, column as i32, end as i32);
                }
                from.next_row();
                to.next_row();
            }
        }
    }

    /// The span of one row, whatever the edges.
    fn row(&self, row: i32, last: i32, take: &mut impl FnMut(i32, i32, i32)) {
        let (mut from, mut to) = (0, i64::from(last));
        for i in 0..3 {
            let value = self.values[i] + i64::from(row) * self.per_row[i];
            match self.per_column[i] {
                0 if value < 0 => return,
                0 => (),
                step if step > 0 => from = from.max(-value.div_euclid(step)),
                step => to = to.min(value.div_euclid(-step)),
            }
        }
        if from <= to {
            take(row, from as i32, to as i32);
        }
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

/// Where an edge crosses a row of pixels: its value divided by its step, in fixed-point numbers carried from row to row.
///
/// Value v and step d are whole numbers and d is below 2²⁸, so that (v + ½) / d, which has the same whole part as v / d, is
/// 2⁻²⁹ or more away from whole numbers. Fewer steps of rounding than that are made before the edge is set up anew: 2⁻⁴⁰ in
/// each of 256 rows, and 2⁻³¹ for the slope in `f64`, which carries the edge over 2²² columns at most.
struct Crossing {
    place: i64,
    per_row: i64,
}

impl Crossing {
    const DIGITS: u32 = 40;
    const ROWS: usize = 256;

    #[inline]
    fn new(edges: &Edges, i: usize, row: i32) -> Self {
        const ONE: f64 = (1_i64 << Crossing::DIGITS) as f64;
        let value = edges.values[i] + i64::from(row) * edges.per_row[i];
        let step = edges.per_column[i].abs();
        let (whole, rest) = (value.div_euclid(step), value.rem_euclid(step));
        let per_step = ONE / step as f64;
        Self {
            place: (whole << Self::DIGITS) + ((rest as f64 + 0.5) * per_step) as i64,
            per_row: (edges.per_row[i] as f64 * per_step) as i64,
        }
    }

    /// The whole part.
    #[inline]
    fn column(&self) -> i64 {
        self.place >> Self::DIGITS
    }

    /// Goes on to the next row; beyond the edge's end the place means nothing.
    #[inline]
    fn next_row(&mut self) {
        self.place = self.place.wrapping_add(self.per_row);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rows between the corners, within those of the window.
    fn rows_of(corners: &[ScreenVertex; 3], bits: u32, last: i32) -> (i32, i32) {
        let [a, b, c] = corners.map(|corner| corner.row);
        (((a.min(b).min(c) + (1 << bits) - 1) >> bits).max(0), (a.max(b).max(c) >> bits).min(last))
    }

    /// Corners on a grid of quarter pixels, so that many edges are level, upright or pass through pixel centres.
    #[test]
    fn spans_are_the_pixels_that_cover_finds_one_by_one() {
        let mut covered = 0;
        for seed in 0..20_000_u64 {
            let bits = |shift: u64| (seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> shift) as i32 & 63;
            let vertex = |i: u64| ScreenVertex { column: bits(64 - 6 * i) - 16, row: bits(46 - 6 * i) - 16, depth: 0 };
            let corners = [vertex(1), vertex(2), vertex(3)];
            let block = Block { columns: (0, 7), rows: rows_of(&corners, 2, 6) };
            let edges = Edges::new(corners.each_ref(), &block, 2);
            if edges.doubled_area == 0 || block.is_empty() {
                continue;
            }
            let mut mask = 0;
            edges.spans(&block, |row, from, to| (from..=to).for_each(|column| mask |= 1_u64 << (8 * row + column)));
            assert_eq!(mask, edges.cover(&block), "{corners:?}");
            covered += mask.count_ones();
        }
        assert!(covered > 10_000, "{covered} pixels say little");
    }

    /// Slivers and large triangles, with corners on pixel rows and beyond the window, over more rows than are carried.
    #[test]
    fn spans_of_tall_triangles_end_where_the_edge_functions_say() {
        const BITS: u32 = 12;
        let (mut spans, mut random) = (0, 1_u64);
        let mut number = |bits: u32| {
            random = random.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
            (random >> (64 - bits)) as i32
        };
        for case in 0..400 {
            let mut vertex = |spread: u32| ScreenVertex {
                column: number(10 + BITS) + number(spread) - number(spread),
                row: (number(11 + BITS) - (600 << BITS)) & if case % 3 == 0 { -1 << BITS } else { -1 },
                depth: 0,
            };
            let spread = if case % 2 == 0 { 4 } else { 11 + BITS };
            let corners = [vertex(spread), vertex(spread), vertex(spread)];
            let block = Block { columns: (0, 899), rows: rows_of(&corners, BITS, 699) };
            let edges = Edges::new(corners.each_ref(), &block, BITS);
            if edges.doubled_area == 0 || block.is_empty() {
                continue;
            }
            let is_inside = |row: i32, column: i32| {
                let value = |i: usize| {
                    edges.values[i] + i64::from(row) * edges.per_row[i] + i64::from(column) * edges.per_column[i]
                };
                (0..3).all(|i| value(i) >= 0)
            };
            let mut next = 0;
            let empty =
                |rows: Range<i32>| rows.flat_map(|row| (0..900).map(move |c| (row, c))).all(|(r, c)| !is_inside(r, c));
            edges.spans(&block, |row, from, to| {
                assert!(empty(next..row), "rows {next} to {row} of {corners:?}");
                assert!(is_inside(row, from) && is_inside(row, to), "{corners:?}, row {row}: {from} to {to}");
                assert!(from == 0 || !is_inside(row, from - 1), "{corners:?}, row {row}: {from}");
                assert!(to == 899 || !is_inside(row, to + 1), "{corners:?}, row {row}: {to}");
                (next, spans) = (row + 1, spans + 1);
            });
            assert!(empty(next..block.rows.1 - block.rows.0 + 1), "rows from {next} of {corners:?}");
        }
        assert!(spans > 50_000, "{spans} spans say little");
    }
}
