use glam::DVec3;

/// Bits of each coordinate in a Morton code.
const BITS: u32 = 20;

/// Place of a point of the unit sphere on a Morton curve: neighbours on the curve are neighbours in space.
///
/// The coordinates' bits by turns, 20 of each. Points outside the cube round the sphere go to its border.
#[must_use]
pub fn morton_code(x: DVec3) -> u64 {
    let cells = f64::from(1u32 << BITS);
    let cell = |x: f64| spread((0.5 * (x + 1.0) * cells).clamp(0.0, cells - 1.0) as u64);
    cell(x.x) | cell(x.y) << 1 | cell(x.z) << 2
}

/// Moves bit i of a number of 20 bits to bit 3 i.
fn spread(bits: u64) -> u64 {
    let mut x = bits;
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_moves_every_bit_to_thrice_its_place() {
        for i in 0..BITS {
            assert_eq!(spread(1 << i), 1 << (3 * i));
        }
        assert_eq!(spread((1 << BITS) - 1), (0..BITS).map(|i| 1 << (3 * i)).sum::<u64>());
    }
}
