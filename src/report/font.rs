//! Text in pictures: the bitmap font Spleen (Frederic Cambus), 8 × 16 and 12 × 24 pixels a character.

use spleen_font::{FONT_8X16, FONT_12X24, PSF2Font};

/// What is drawn for a character that the font does not have.
const UNKNOWN: char = '?';

/// Size of the letters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Font {
    /// 8 × 16 pixels.
    #[default]
    Small,
    /// 12 × 24 pixels.
    Large,
}

impl Font {
    /// Width and height of every character, in pixels.
    pub(super) fn cell(self) -> [u32; 2] {
        match self {
            Self::Small => [8, 16],
            Self::Large => [12, 24],
        }
    }

    /// Calls `ink` with the column and row of every pixel that `text`, one line, covers.
    pub(super) fn for_each_pixel(self, text: &str, mut ink: impl FnMut(u32, u32)) {
        let blob = match self {
            Self::Small => FONT_8X16,
            Self::Large => FONT_12X24,
        };
        let mut font = PSF2Font::new(blob).expect("the bundled fonts are valid");
        let [cell_width, _] = self.cell();
        let mut left = 0;
        for letter in text.chars() {
            let letter = if letter.is_control() { UNKNOWN } else { letter };
            let mut bytes = [0; 4];
            let glyph = font.glyph_for_utf8(letter.encode_utf8(&mut bytes).as_bytes());
            let glyph = glyph.or_else(|| font.glyph_for_utf8(UNKNOWN.encode_utf8(&mut bytes).as_bytes()));
            for (y, row) in (0..).zip(glyph.into_iter().flatten()) {
                for (x, _) in (0..cell_width).zip(row).filter(|&(_, is_ink)| is_ink) {
                    ink(left + x, y);
                }
            }
            left += cell_width;
        }
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
        for font in [Font::Small, Font::Large] {
            let [width, height] = font.cell();
            for letter in (32..0x3000).filter_map(char::from_u32) {
                let ink = pixels(font, &letter.to_string());
                assert!(ink.iter().all(|&(x, y)| x < width && y < height), "{letter}");
            }
        }
    }

    #[test]
    fn every_printable_ascii_letter_but_the_space_is_drawn_in_its_own_way() {
        for font in [Font::Small, Font::Large] {
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
        for font in [Font::Small, Font::Large] {
            for sign in "·×±²°≥".chars() {
                assert_ne!(pixels(font, &sign.to_string()), pixels(font, "?"), "{sign}");
            }
        }
    }

    #[test]
    fn what_the_font_lacks_and_control_characters_are_question_marks() {
        assert_eq!(pixels(Font::Small, "\u{1F600}\n"), pixels(Font::Small, "??"));
    }
}
