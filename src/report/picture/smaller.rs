//! Smaller copies of pictures, for pages.

use std::io::{self, Write};
use std::ops::Range;

use super::{Picture, WHITE};

/// Of 100; where squares of eight pixels begin to show is about 60.
const JPEG_QUALITY: u8 = 82;

impl Picture {
    /// The picture at a smaller size, each pixel the mean of what it covers, parts of pixels included. It never grows: a
    /// side that is asked to be longer stays, and none is shorter than a pixel.
    #[must_use]
    pub fn scaled_down(&self, width: u32, height: u32) -> Self {
        let (width, height) = (width.clamp(1, self.width), height.clamp(1, self.height));
        let covered = |pixels: u32, of: u32| (0..pixels).map(|i| Cover::of(i, pixels, of)).collect::<Vec<_>>();
        let (columns, rows) = (covered(width, self.width), covered(height, self.height));
        let mut small = Self::filled(width, height, WHITE);
        for (y, row) in (0..).zip(&rows) {
            for (x, column) in (0..).zip(&columns) {
                small.set(x, y, self.mean(column, row));
            }
        }
        small
    }

    fn mean(&self, columns: &Cover, rows: &Cover) -> [u8; 3] {
        let (mut sums, mut whole) = ([0_u64; 3], 0_u64);
        for y in rows.pixels.clone() {
            for x in columns.pixels.clone() {
                let share = rows.share(y) * columns.share(x);
                let pixel = self.pixel(x, y).unwrap_or(WHITE);
                sums.iter_mut().zip(pixel).for_each(|(sum, channel)| *sum += share * u64::from(channel));
                whole += share;
            }
        }
        sums.map(|sum| ((sum + whole / 2) / whole) as u8)
    }

    /// Writes the picture as a JPEG file, without losing sharpness of its colours: a shaded picture takes a fraction of its
    /// PNG file's bytes, and looks the same.
    ///
    /// # Errors
    /// As `writer`; for a side of more than 65,535 pixels.
    pub fn write_jpeg(&self, writer: impl Write) -> io::Result<()> {
        let side = |pixels: u32| u16::try_from(pixels).map_err(io::Error::other);
        let (width, height) = (side(self.width)?, side(self.height)?);
        let mut encoder = jpeg_encoder::Encoder::new(writer, JPEG_QUALITY);
        // Red differences are thin lines on white.
        encoder.set_sampling_factor(jpeg_encoder::SamplingFactor::F_1_1);
        encoder.set_optimized_huffman_tables(true);
        encoder.encode(&self.rgb, width, height, jpeg_encoder::ColorType::Rgb).map_err(io::Error::other)
    }
}

/// What a pixel of a smaller picture covers along one direction.
struct Cover {
    pixels: Range<u32>,
    /// From and to, in parts of a pixel.
    ends: Range<u64>,
    /// Parts of a pixel.
    parts: u64,
}

impl Cover {
    /// What pixel `i` of `small` covers of `large`.
    fn of(i: u32, small: u32, large: u32) -> Self {
        // In parts of which a large pixel has `small` and a small one `large`, all ends are whole numbers.
        let (i, parts, length) = (u64::from(i), u64::from(small), u64::from(large));
        let ends = i * length..(i + 1) * length;
        Self { pixels: (ends.start / parts) as u32..ends.end.div_ceil(parts) as u32, ends, parts }
    }

    /// How much of a pixel it covers, in parts.
    fn share(&self, pixel: u32) -> u64 {
        let from = u64::from(pixel) * self.parts;
        (from + self.parts).min(self.ends.end) - from.max(self.ends.start)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn grey(width: u32, levels: &[u8]) -> Picture {
        let rgb = levels.iter().flat_map(|&level| [level; 3]).collect();
        Picture::from_rgb(width, levels.len() as u32 / width, rgb).unwrap()
    }

    #[test]
    fn a_smaller_picture_has_the_means_of_what_its_pixels_cover() {
        // Three pixels a row become two: the middle one is shared.
        let picture = grey(3, &[0, 60, 120, 30, 90, 150]);
        assert_eq!(picture.scaled_down(2, 2), grey(2, &[20, 100, 50, 130]));
        assert_eq!(picture.scaled_down(1, 1), grey(1, &[75]));
        assert_eq!(picture.scaled_down(9, 9), picture);
        assert_eq!(picture.scaled_down(0, 2), grey(1, &[60, 90]));
    }

    #[test]
    fn a_jpeg_file_is_a_fraction_of_the_png_file_and_says_its_size() {
        // Smooth, but for a grain that no prediction from neighbours foresees.
        let grain = |x: u32, y: u32| f64::from((x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(40_503)) >> 7 & 7);
        let shade = |x: u32, y: u32| (libm::sin(f64::from(x + y) / 60.0) * 100.0 + 120.0 + grain(x, y)) as u8;
        let rgb = (0..200).flat_map(|y| (0..300).flat_map(move |x| [shade(x, y); 3])).collect();
        let picture = Picture::from_rgb(300, 200, rgb).unwrap();
        let (mut jpeg, mut png) = (Vec::new(), Vec::new());
        picture.write_jpeg(&mut jpeg).unwrap();
        picture.write_png(&mut png).unwrap();
        assert!(jpeg.len() < png.len() / 3, "{} of {}", jpeg.len(), png.len());
        // Start of image; in the frame's header height and width stand behind marker, length and depth.
        assert_eq!(jpeg[..2], [0xff, 0xd8]);
        let frame = jpeg.windows(2).position(|pair| pair == [0xff, 0xc0]).unwrap();
        assert_eq!(jpeg[frame + 5..frame + 9], [0, 200, 1, 44]);
        let too_wide = Picture::filled(70_000, 1, WHITE);
        assert!(too_wide.write_jpeg(&mut Vec::new()).is_err());
    }
}
