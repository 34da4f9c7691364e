//! Smaller copies of pictures, for pages.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::ops::Range;

use super::{Picture, WHITE};

/// Steps of each channel between none and full: less is visible in even shades, more takes more bytes.
const STEPS: u32 = 31;

/// Colours of the largest palette of a PNG file.
const PALETTE: usize = 256;

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

    /// Writes the picture with 32 levels of each channel, by a palette if that holds its colours: a shaded picture takes a
    /// third of the bytes.
    ///
    /// # Errors
    /// As `writer`.
    pub fn write_coarse_png(&self, writer: impl Write) -> io::Result<()> {
        let coarse = |level: u8| ((u32::from(level) * STEPS + 127) / 255 * 255 / STEPS) as u8;
        let rgb: Vec<u8> = self.rgb.iter().map(|&level| coarse(level)).collect();
        let coarse = Self { rgb, ..*self };
        coarse.write_palette_png(writer)
    }

    /// Writes the picture by a palette, or without where that does not hold its colours.
    fn write_palette_png(&self, writer: impl Write) -> io::Result<()> {
        let (pixels, _) = self.rgb.as_chunks::<3>();
        let mut places = BTreeMap::new();
        for pixel in pixels {
            let next = places.len();
            places.entry(pixel).or_insert(next);
            if places.len() > PALETTE {
                return self.write_png(writer);
            }
        }
        let mut palette = vec![[0; 3]; places.len()];
        places.iter().for_each(|(&&colour, &place)| palette[place] = colour);
        let indices: Vec<u8> = pixels.iter().map(|pixel| places[pixel] as u8).collect();
        let mut encoder = png::Encoder::new(writer, self.width, self.height);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_palette(palette.concat());
        encoder.set_compression(png::Compression::High);
        // Neighbours in a palette need not be like colours.
        encoder.set_filter(png::Filter::NoFilter);
        let mut file = encoder.write_header()?;
        file.write_image_data(&indices)?;
        file.finish()?;
        Ok(())
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

    fn decoded(file: &[u8]) -> (png::ColorType, Vec<u8>) {
        let mut decoder = png::Decoder::new(io::Cursor::new(file));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let colours = reader.info().color_type;
        let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut rgb).unwrap();
        (colours, rgb)
    }

    #[test]
    fn a_coarse_file_is_within_half_a_step_and_keeps_black_and_white() {
        let shaded = Picture::from_rgb(16, 16, (0..=255_u8).flat_map(|i| [i; 3]).collect()).unwrap();
        let coloured =
            Picture::from_rgb(256, 64, (0..256 * 64_u32).flat_map(|i| [i as u8, (i >> 8) as u8 * 4, 255]).collect());
        let mut kinds = Vec::new();
        for picture in [shaded, coloured.unwrap()] {
            let mut file = Vec::new();
            picture.write_coarse_png(&mut file).unwrap();
            let (kind, rgb) = decoded(&file);
            kinds.push(kind);
            for (&coarse, &exact) in rgb.iter().zip(&picture.rgb) {
                // Half a step of 255 / 31, and rounding.
                assert!(coarse.abs_diff(exact) <= 5, "{exact} became {coarse}");
                assert!(!matches!(exact, 0 | 255) || coarse == exact);
            }
        }
        assert_eq!(kinds, [png::ColorType::Indexed, png::ColorType::Rgb]);
    }
}
