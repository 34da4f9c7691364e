//! A picture in memory: pixels, boxes, text, PNG.

mod crop;
mod smaller;

use std::io::{self, Write};

use crate::error::{Error, Result};

pub use super::font::Font;

/// White, the paper of all pictures.
pub const WHITE: [u8; 3] = [255; 3];

/// Dark grey, for text.
pub const INK: [u8; 3] = [51, 51, 51];

/// Medium grey, for what should not speak loudly.
pub const FAINT: [u8; 3] = [110, 110, 110];

/// Light grey, for frames and ticks.
pub const LINE: [u8; 3] = [205, 205, 205];

/// An image of 8-bit red, green and blue.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    width: u32,
    height: u32,
    /// Rows from the top, pixels from the left, three bytes each.
    rgb: Vec<u8>,
}

/// A box of pixels; its right and lower edge lie outside it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Area {
    /// Column of its left edge.
    pub left: u32,
    /// Row of its upper edge.
    pub top: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// How text looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TextStyle {
    /// Size of the letters.
    pub font: Font,
    /// Pixels a side of each of the font's dots, 1 and up.
    pub scale: u32,
    /// Colour of the letters.
    pub colour: [u8; 3],
}

impl Default for TextStyle {
    /// Small dark grey letters.
    fn default() -> Self {
        Self { font: Font::Small, scale: 1, colour: INK }
    }
}

impl TextStyle {
    /// Width of a line of text, in pixels.
    #[must_use]
    pub fn width_of(&self, text: &str) -> u32 {
        let letters = u32::try_from(text.chars().count()).unwrap_or(u32::MAX);
        letters.saturating_mul(self.font.cell()[0]).saturating_mul(self.scale)
    }

    /// Height of a line of text, in pixels.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.font.cell()[1].saturating_mul(self.scale)
    }
}

impl Picture {
    /// A picture of one colour.
    #[must_use]
    pub fn filled(width: u32, height: u32, colour: [u8; 3]) -> Self {
        let rgb = colour.repeat(width as usize * height as usize);
        Self { width, height, rgb }
    }

    /// A picture of these bytes: rows from the top, pixels from the left, red, green, blue.
    ///
    /// # Errors
    /// [`Error::ShapeMismatch`] unless there are `width` · `height` · 3.
    pub fn from_rgb(width: u32, height: u32, rgb: Vec<u8>) -> Result<Self> {
        check_length("rgb", rgb.len(), width as usize * height as usize * 3)?;
        Ok(Self { width, height, rgb })
    }

    /// A picture of these grey levels, 0 black to 255 white, rounded and clamped; NaN is black.
    ///
    /// # Errors
    /// [`Error::ShapeMismatch`] unless there are `width` · `height`.
    pub fn from_grey(width: u32, height: u32, grey: &[f32]) -> Result<Self> {
        Self::from_values(width, height, grey, |level| [level.round() as u8; 3])
    }

    /// A picture of numbers, one a pixel, each turned into a colour.
    ///
    /// # Errors
    /// [`Error::ShapeMismatch`] unless there are `width` · `height`.
    pub fn from_values(width: u32, height: u32, values: &[f32], colour: impl Fn(f32) -> [u8; 3]) -> Result<Self> {
        check_length("values", values.len(), width as usize * height as usize)?;
        let rgb = values.iter().flat_map(|&v| colour(v)).collect();
        Ok(Self { width, height, rgb })
    }

    /// A picture of the bytes of a PNG file of 8-bit RGB, as [`Self::write_png`] writes them.
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn from_png(bytes: &[u8]) -> Result<Self> {
        let wrong = |message: String| Error::Parse { place: "a PNG picture".to_owned(), message };
        let mut reader = png::Decoder::new(io::Cursor::new(bytes)).read_info().map_err(|e| wrong(e.to_string()))?;
        let mut rgb = vec![0; reader.output_buffer_size().unwrap_or(0)];
        let frame = reader.next_frame(&mut rgb).map_err(|e| wrong(e.to_string()))?;
        if (frame.color_type, frame.bit_depth) != (png::ColorType::Rgb, png::BitDepth::Eight) {
            return Err(wrong("it is not of 8-bit RGB".to_owned()));
        }
        Self::from_rgb(frame.width, frame.height, rgb)
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The bytes: rows from the top, pixels from the left, red, green, blue.
    #[must_use]
    pub fn as_rgb(&self) -> &[u8] {
        &self.rgb
    }

    /// The colour of a pixel, `None` outside the picture.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        let at = self.offset(x, y)?;
        Some([self.rgb[at], self.rgb[at + 1], self.rgb[at + 2]])
    }

    /// Gives a pixel a colour; outside the picture nothing happens.
    pub fn set(&mut self, x: u32, y: u32, colour: [u8; 3]) {
        if let Some(at) = self.offset(x, y) {
            self.rgb[at..at + 3].copy_from_slice(&colour);
        }
    }

    /// Fills a box; what lies outside the picture is left out.
    pub fn fill(&mut self, area: Area, colour: [u8; 3]) {
        for y in area.top..area.top.saturating_add(area.height).min(self.height) {
            for x in area.left..area.left.saturating_add(area.width).min(self.width) {
                self.set(x, y, colour);
            }
        }
    }

    /// Draws a line one pixel wide just around a box.
    pub fn frame(&mut self, area: Area, colour: [u8; 3]) {
        let Area { left, top, width, height } = area;
        let (before, above) = (left.saturating_sub(1), top.saturating_sub(1));
        let (right, below) = (left.saturating_add(width), top.saturating_add(height));
        let (across, down) = ((right - before).saturating_add(1), (below - above).saturating_add(1));
        self.fill(Area { left: before, top: above, width: across, height: 1 }, colour);
        self.fill(Area { left: before, top: below, width: across, height: 1 }, colour);
        self.fill(Area { left: before, top: above, width: 1, height: down }, colour);
        self.fill(Area { left: right, top: above, width: 1, height: down }, colour);
    }

    /// Copies `other` so that its upper left corner comes to `left`, `top`; what sticks out is left out.
    pub fn blit(&mut self, other: &Self, left: u32, top: u32) {
        let columns = other.width.min(self.width.saturating_sub(left)) as usize;
        let rows = other.height.min(self.height.saturating_sub(top));
        for row in 0..rows {
            let Some(to) = self.offset(left, top + row) else { return };
            let from = row as usize * other.width as usize * 3;
            self.rgb[to..to + 3 * columns].copy_from_slice(&other.rgb[from..from + 3 * columns]);
        }
    }

    /// Writes one line of text with its upper left corner at `left`, `top`; what sticks out is left out.
    pub fn text(&mut self, text: &str, left: u32, top: u32, style: TextStyle) {
        let TextStyle { font, scale, colour } = style;
        font.for_each_pixel(text, |x, y| {
            let dot = Area {
                left: left.saturating_add(x.saturating_mul(scale)),
                top: top.saturating_add(y.saturating_mul(scale)),
                width: scale,
                height: scale,
            };
            self.fill(dot, colour);
        });
    }

    /// Writes the picture as a PNG file of 8-bit RGB.
    ///
    /// # Errors
    /// What `writer` says; also for a picture without pixels, which PNG does not allow.
    pub fn write_png(&self, writer: impl Write) -> io::Result<()> {
        let mut encoder = png::Encoder::new(writer, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut file = encoder.write_header()?;
        file.write_image_data(&self.rgb)?;
        file.finish()?;
        Ok(())
    }

    /// Where a pixel's bytes begin, `None` outside the picture.
    fn offset(&self, x: u32, y: u32) -> Option<usize> {
        (x < self.width && y < self.height).then(|| (y as usize * self.width as usize + x as usize) * 3)
    }
}

fn check_length(what: &'static str, got: usize, expected: usize) -> Result<()> {
    if got == expected { Ok(()) } else { Err(Error::ShapeMismatch { what, got, expected }) }
}

#[cfg(test)]
mod tests;
