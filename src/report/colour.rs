//! Colours for numbers between 0 and 1.

/// How a number from 0 to 1 becomes a colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColourMap {
    /// White at 0, red at 1/3, yellow at 2/3, green at 1, linear between: the map of Zhang & Turk 2002, figure 2.
    #[default]
    Paper,
    /// Dark blue over grey to yellow, for readers with and without colour vision deficiency alike.
    ///
    /// Source: Nuñez, Anderton & Renslow, Optimizing colormaps with consideration for color vision deficiency, 2018.
    Cividis,
}

/// Colours of the paper's map at 0, 1/3, 2/3 and 1.
const PAPER_KNOTS: [[u8; 3]; 4] = [[255, 255, 255], [255, 0, 0], [255, 255, 0], [0, 255, 0]];

impl ColourMap {
    /// All maps, in the order in which they are listed to users.
    pub const ALL: [Self; 2] = [Self::Paper, Self::Cividis];

    /// The name on the command line and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Cividis => "cividis",
        }
    }

    /// The colour of `value` as red, green, blue; below 0 and NaN count as 0, above 1 as 1.
    #[must_use]
    pub fn colour(self, value: f64) -> [u8; 3] {
        let value = if value.is_nan() { 0.0 } else { value.clamp(0.0, 1.0) };
        match self {
            Self::Paper => paper(value),
            Self::Cividis => colorous::CIVIDIS.eval_continuous(value).into_array(),
        }
    }
}

fn paper(value: f64) -> [u8; 3] {
    let place = 3.0 * value;
    let segment = (place as usize).min(PAPER_KNOTS.len() - 2);
    mix(PAPER_KNOTS[segment], PAPER_KNOTS[segment + 1], place - segment as f64)
}

/// The colour `share` of the way from one colour to another; `share` is in 0 to 1.
#[must_use]
pub fn mix(from: [u8; 3], to: [u8; 3], share: f64) -> [u8; 3] {
    [0, 1, 2].map(|i| {
        let (a, b) = (f64::from(from[i]), f64::from(to[i]));
        (a + (b - a) * share).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paper_map_is_exact_at_its_knots() {
        let colours = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(|v| ColourMap::Paper.colour(v));
        assert_eq!(colours, [[255, 255, 255], [255, 0, 0], [255, 255, 0], [0, 255, 0]]);
    }

    #[test]
    fn the_paper_map_is_linear_between_its_knots() {
        let colours = [1.0 / 6.0, 0.5, 5.0 / 6.0].map(|v| ColourMap::Paper.colour(v));
        assert_eq!(colours, [[255, 128, 128], [255, 128, 0], [128, 255, 0]]);
    }

    #[test]
    fn cividis_grows_brighter_all_the_way() {
        let brightness = |i: u32| {
            let [r, g, b] = ColourMap::Cividis.colour(f64::from(i) / 64.0).map(u32::from);
            299 * r + 587 * g + 114 * b
        };
        assert!((0..64).all(|i| brightness(i) < brightness(i + 1)));
    }

    #[test]
    fn numbers_outside_the_range_get_the_colour_of_its_end() {
        for map in ColourMap::ALL {
            for low in [-1.0, f64::NEG_INFINITY, f64::NAN, -0.0] {
                assert_eq!(map.colour(low), map.colour(0.0));
            }
            for high in [1.5, f64::INFINITY] {
                assert_eq!(map.colour(high), map.colour(1.0));
            }
        }
    }
}
