//! The bar that says which colour means which number.

use super::colour::ColourMap;
use super::picture::{Area, FAINT, INK, LINE, Picture, TextStyle, WHITE};

/// Narrowest legend that is drawn: five labels side by side.
pub const MIN_WIDTH: u32 = 240;

/// Room beside the bar, half a label.
pub(super) const SIDE: u32 = 24;
const BAR_HEIGHT: u32 = 14;
const TICK_HEIGHT: u32 = 5;
const GAP: u32 = 6;

/// Room around a picture that a legend is put under.
const MARGIN: u32 = 16;

/// Numbers beside the bar, from 0 at its left end to 1 at its right end, and how they are written.
const UNIT_TICKS: [(f64, &str); 5] = [(0.0, "0"), (0.25, "0.25"), (0.5, "0.5"), (0.75, "0.75"), (1.0, "1")];

/// A legend for numbers from 0 to 1: title, bar, ticks; `width` pixels wide, or as wide as its text needs.
#[must_use]
pub fn legend(map: ColourMap, title: &str, width: u32) -> Picture {
    let ticks = UNIT_TICKS.map(|(place, label)| (place, label.to_owned()));
    gradient(|value| map.colour(value), &ticks, title, width)
}

/// `picture` on white with the legend of `map` under it.
#[must_use]
pub fn with_legend(picture: &Picture, map: ColourMap, title: &str) -> Picture {
    above(picture, &legend(map, title, picture.width().min(480)))
}

/// `picture` on white with a scale of its own under it: `colour` for places from 0 to 1, `ticks` at such places.
#[must_use]
pub fn with_scale(picture: &Picture, colour: impl Fn(f64) -> [u8; 3], ticks: &[(f64, String)], title: &str) -> Picture {
    above(picture, &gradient(colour, ticks, title, picture.width().min(480)))
}

fn above(picture: &Picture, bar: &Picture) -> Picture {
    let width = picture.width().max(bar.width()) + 2 * MARGIN;
    let mut page = Picture::filled(width, picture.height() + bar.height() + 3 * MARGIN, WHITE);
    page.blit(picture, (width - picture.width()) / 2, MARGIN);
    page.blit(bar, (width - bar.width()) / 2, picture.height() + 2 * MARGIN);
    page
}

/// A bar of the colours of 0 to 1 with a title above and ticks (place from 0 to 1, label) below.
pub(super) fn gradient(colour: impl Fn(f64) -> [u8; 3], ticks: &[(f64, String)], title: &str, width: u32) -> Picture {
    let text = TextStyle::default();
    let bar = bar_of(width.max(MIN_WIDTH).max(text.width_of(title).saturating_add(2 * SIDE)));
    let height = bar.top + bar.height + TICK_HEIGHT + 2 + text.height();
    let mut picture = Picture::filled(bar.width + 2 * SIDE, height, WHITE);

    picture.text(title, bar.left, 0, TextStyle { colour: INK, ..text });
    for column in 0..bar.width {
        let value = f64::from(column) / f64::from(bar.width - 1);
        picture.fill(Area { left: bar.left + column, width: 1, ..bar }, colour(value));
    }
    picture.frame(bar, LINE);
    for (place, label) in ticks {
        let left = bar.left + (place * f64::from(bar.width - 1)).round() as u32;
        let top = bar.top + bar.height;
        picture.fill(Area { left, top, width: 1, height: TICK_HEIGHT }, FAINT);
        let label_left = left.saturating_sub(text.width_of(label) / 2);
        picture.text(label, label_left, top + TICK_HEIGHT + 2, TextStyle { colour: FAINT, ..text });
    }
    picture
}

/// Where the bar lies in a legend of this width.
fn bar_of(width: u32) -> Area {
    let top = TextStyle::default().height() + GAP;
    Area { left: SIDE, top, width: width - 2 * SIDE, height: BAR_HEIGHT }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bar_has_the_colours_of_0_and_1_at_its_ends() {
        for map in ColourMap::ALL {
            let picture = legend(map, "visibility", 300);
            let bar = bar_of(300);
            assert_eq!(picture.width(), 300);
            for row in [bar.top, bar.top + bar.height - 1] {
                assert_eq!(picture.pixel(bar.left, row), Some(map.colour(0.0)));
                assert_eq!(picture.pixel(bar.left + bar.width - 1, row), Some(map.colour(1.0)));
            }
            assert_eq!(picture.pixel(bar.left - 1, bar.top), Some(LINE));
        }
    }

    #[test]
    fn title_ticks_and_labels_are_where_they_belong() {
        let picture = legend(ColourMap::Paper, "V", 240);
        let bar = bar_of(240);
        let is_inked = |left: u32, top: u32, width: u32, height: u32| {
            (left..left + width).any(|x| (top..top + height).any(|y| picture.pixel(x, y).is_some_and(|p| p != WHITE)))
        };
        assert!(is_inked(bar.left, 0, 8, 16), "title");
        assert!(!is_inked(bar.left + 8, 0, 240 - SIDE - 8, 16), "beside the title");
        for (place, label) in UNIT_TICKS {
            let tick = bar.left + (place * f64::from(bar.width - 1)).round() as u32;
            let foot = bar.top + bar.height;
            assert_eq!(picture.pixel(tick, foot + TICK_HEIGHT - 1), Some(FAINT));
            assert!(is_inked(tick - 4, foot + TICK_HEIGHT + 2, 8, 16), "{label}");
        }
        let last = UNIT_TICKS.len() as u32 - 1;
        assert!(!is_inked(0, bar.top + bar.height + 8, bar.left - 4, 16), "{last} labels stay inside");
    }

    #[test]
    fn a_narrow_legend_is_widened_and_a_picture_keeps_its_pixels() {
        assert_eq!(legend(ColourMap::Paper, "", 3).width(), MIN_WIDTH);
        let title = "a title that is wider than the narrowest legend";
        let title_width = TextStyle::default().width_of(title);
        assert_eq!(legend(ColourMap::Paper, title, 3).width(), title_width + 2 * SIDE);
        let red = Picture::filled(40, 30, [255, 0, 0]);
        let page = with_legend(&red, ColourMap::Cividis, "visibility");
        assert_eq!(page.width(), MIN_WIDTH + 2 * MARGIN);
        let found = page.as_rgb().chunks(3).filter(|p| *p == [255, 0, 0]).count();
        assert_eq!(found, 1200);
    }
}
