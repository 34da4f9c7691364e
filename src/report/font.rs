//! Text in pictures: bitmap fonts of the X Window System (Misc-Fixed, public domain), as `embedded-graphics` brings
//! them, with the letters of ISO 8859-1.

use std::convert::Infallible;

use embedded_graphics::Drawable;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{Dimensions, Point, Size};
use embedded_graphics::mono_font::iso_8859_1::{FONT_8X13, FONT_9X15_BOLD, FONT_10X20};
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::text::{Baseline, Text};

/// Size and weight of the letters. What a font does not have is drawn as `?`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Font {
    /// 8 × 13 pixels.
    #[default]
    Small,
    /// 9 × 15 pixels, bold.
    Bold,
    /// 10 × 20 pixels.
    Large,
}

impl Font {
    /// All fonts.
    #[cfg(test)]
    const ALL: [Self; 3] = [Self::Small, Self::Bold, Self::Large];

    fn glyphs(self) -> &'static MonoFont<'static> {
        match self {
            Self::Small => &FONT_8X13,
            Self::Bold => &FONT_9X15_BOLD,
            Self::Large => &FONT_10X20,
        }
    }

    /// Width and height of every character, in pixels.
    pub(super) fn cell(self) -> [u32; 2] {
        let Size { width, height } = self.glyphs().character_size;
        [width, height]
    }

    /// Calls `ink` with the column and row of every pixel that `text`, one line, covers.
    pub(super) fn for_each_pixel(self, text: &str, ink: impl FnMut(u32, u32)) {
        let mut target = Ink(ink);
        let style = MonoTextStyle::new(self.glyphs(), BinaryColor::On);
        let [width, _] = self.cell();
        for (letter, column) in text.chars().zip(0..) {
            // Control characters would move the pen; every letter gets its own cell instead.
            let letter = if letter.is_control() { '?' } else { letter };
            let left = i32::try_from(width.saturating_mul(column)).unwrap_or(i32::MAX);
            let mut bytes = [0; 4];
            let text = Text::with_baseline(letter.encode_utf8(&mut bytes), Point::new(left, 0), style, Baseline::Top);
            let Ok(_) = text.draw(&mut target);
        }
    }
}

/// Receives the pixels of letters.
struct Ink<F>(F);

impl<F> Dimensions for Ink<F> {
    fn bounding_box(&self) -> Rectangle {
        Rectangle::new(Point::zero(), Size::new_equal(i32::MAX.unsigned_abs()))
    }
}

impl<F: FnMut(u32, u32)> DrawTarget for Ink<F> {
    type Color = BinaryColor;
    type Error = Infallible;

    fn draw_iter<I>(&mut self, pixels: I) -> Result<(), Infallible>
    where
        I: IntoIterator<Item = embedded_graphics::Pixel<BinaryColor>>,
    {
        for embedded_graphics::Pixel(Point { x, y }, colour) in pixels {
            if let (true, Ok(x), Ok(y)) = (colour.is_on(), u32::try_from(x), u32::try_from(y)) {
                (self.0)(x, y);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixels(font: Font, text: &str) -> Vec<(u32, u32)> {
        let mut pixels = Vec::new();
        font.for_each_pixel(text, |x, y| pixels.push((x, y)));
        pixels
    }

    #[test]
    fn letters_stay_in_their_cells() {
        for font in Font::ALL {
            let [width, height] = font.cell();
            for letter in (32..0x3000).filter_map(char::from_u32) {
                let ink = pixels(font, &letter.to_string());
                assert!(ink.iter().all(|&(x, y)| x < width && y < height), "{letter}");
            }
        }
    }

    #[test]
    fn every_printable_ascii_letter_but_the_space_is_drawn_in_its_own_way() {
        for font in Font::ALL {
            let mut shapes: Vec<_> = ('!'..='~').map(|c| pixels(font, &c.to_string())).collect();
            assert!(shapes.iter().all(|s| !s.is_empty()));
            shapes.sort();
            shapes.dedup();
            assert_eq!(shapes.len(), 94);
            assert!(pixels(font, " ").is_empty());
        }
    }

    #[test]
    fn the_signs_that_reports_use_are_there() {
        for font in Font::ALL {
            for sign in "·×±²°µ".chars() {
                assert_ne!(pixels(font, &sign.to_string()), pixels(font, "?"), "{sign}");
            }
        }
    }

    #[test]
    fn what_the_font_lacks_and_control_characters_are_question_marks() {
        assert_eq!(pixels(Font::Small, "\u{1F600}\n"), pixels(Font::Small, "??"));
    }
}
