//! What Zhang & Turk print, to stand beside what is measured here, and what a given model is to them.
//!
//! Source: E. Zhang, G. Turk, Visibility-Guided Simplification, IEEE Visualization 2002: tables 1 and 2, figures 2 to 8.
//! Numbers are kept as printed, also where they contradict each other; [`PaperModel::notes`] says where.

mod argument;
mod models;
mod stand;

pub use argument::{ModelArgument, parse_model_argument};
pub use models::MODELS;
pub use stand::Stand;

use serde::Serialize;

/// What holds for every model of the paper, or for the paper itself.
pub const NOTES: [&str; 3] = [
    "the improvement of table 2 is the mean over seven levels, and does not say which",
    "the caption of figure 3 says 4096 cameras; the sixth octahedral pattern has 4098",
    "the prose calls the error of eq. (5.8) a mean projected distance, but visibility enters squared",
];

/// A model of the paper and what is printed about it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PaperModel {
    /// As in the tables: `Locking Tori`.
    pub name: &'static str,
    /// Triangles, the paper's polygons.
    pub triangles: usize,
    /// Its row of table 1.
    pub table1: Option<Table1Row>,
    /// Its row of table 2.
    pub table2: Option<Table2Row>,
    /// Figures that show it, ascending.
    pub figures: &'static [u8],
    /// How many triangles it has in the pictures of QB and VG side by side.
    pub pictures: &'static [PaperPicture],
    /// Two results whose image errors the paper calls alike.
    pub equal_error: Option<EqualError>,
    /// What contradicts itself, one sentence each.
    pub notes: &'static [&'static str],
}

/// Table 1: visibility from 258 cameras of 480 × 480 pixels, on an SGI Octane of 195 MHz.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Table1Row {
    /// V(M), eq. (3.2).
    pub visibility: f64,
    /// Time for it, in seconds.
    pub measure_seconds: u32,
}

/// Table 2: simplification guided by visibility (VG) against plain quadrics (QB).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Table2Row {
    /// V(M), eq. (3.2).
    pub visibility: f64,
    /// Time for V, in seconds.
    pub measure_seconds: u32,
    /// Time for simplifying, in seconds; QB and VG differ by less than 1 %.
    pub simplify_seconds: u32,
    /// By how much the image error of VG is below that of QB, mean over seven levels, in percent of QB's.
    pub less_error: f64,
}

/// A picture of QB, original and VG side by side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct PaperPicture {
    /// Number of the figure.
    pub figure: u8,
    /// Triangles of the simplified models.
    pub triangles: usize,
}

/// VG with fewer triangles has about the image error of QB with more.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct EqualError {
    /// Triangles of VG.
    pub visibility: usize,
    /// Triangles of QB.
    pub quadric: usize,
}

impl PaperModel {
    /// The model of this name; case does not count, and `_`, `-`, a space or nothing between words are the same.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        let wanted = letters(name);
        MODELS.iter().find(|model| letters(model.name) == wanted)
    }

    /// V(M): table 1's, else table 2's.
    #[must_use]
    pub fn visibility(&self) -> Option<f64> {
        self.table1.map(|row| row.visibility).or(self.table2.map(|row| row.visibility))
    }

    /// Seconds for V: table 1's, else table 2's, which agree.
    #[must_use]
    pub fn measure_seconds(&self) -> Option<u32> {
        self.table1.map(|row| row.measure_seconds).or(self.table2.map(|row| row.measure_seconds))
    }
}

/// A name without what separates its words, in lower case.
fn letters(name: &str) -> String {
    name.chars().filter(|c| !matches!(c, ' ' | '_' | '-')).flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn names_are_found_however_their_words_are_joined() {
        for name in ["Locking Tori", "locking_tori", "LOCKING-TORI", "lockingtori"] {
            assert_eq!(PaperModel::named(name).unwrap().triangles, 9_708, "{name}");
        }
        for name in ["", "torus", "locking", "buddha100k"] {
            assert_eq!(PaperModel::named(name), None, "{name}");
        }
    }

    /// Sums over the columns, taken from the printed tables by hand, catch a digit mistyped in any row.
    #[test]
    fn the_columns_of_both_tables_have_the_sums_of_the_printed_ones() {
        let first: Vec<(&PaperModel, Table1Row)> = MODELS.iter().filter_map(|m| Some((m, m.table1?))).collect();
        let second: Vec<(&PaperModel, Table2Row)> = MODELS.iter().filter_map(|m| Some((m, m.table2?))).collect();
        let hundredths = |value: f64| (100.0 * value).round() as u32;
        let thousandths = |value: f64| (1000.0 * value).round() as u32;
        assert_eq!((first.len(), second.len()), (9, 6));
        assert_eq!(first.iter().map(|(m, _)| m.triangles).sum::<usize>(), 5_074_177);
        assert_eq!(first.iter().map(|(_, row)| thousandths(row.visibility)).sum::<u32>(), 6_042);
        assert_eq!(first.iter().map(|(_, row)| row.measure_seconds).sum::<u32>(), 182 * 60 + 4);
        assert_eq!(second.iter().map(|(m, _)| m.triangles).sum::<usize>(), 5_140_934);
        assert_eq!(second.iter().map(|(_, row)| thousandths(row.visibility)).sum::<u32>(), 3_260);
        assert_eq!(second.iter().map(|(_, row)| row.measure_seconds).sum::<u32>(), 173 * 60 + 5);
        assert_eq!(second.iter().map(|(_, row)| row.simplify_seconds).sum::<u32>(), 17 * 60 + 27);
        assert_eq!(second.iter().map(|(_, row)| hundredths(row.less_error)).sum::<u32>(), 8_547);
    }

    #[test]
    fn only_the_blade_has_two_visibilities() {
        let differs = |m: &&PaperModel| m.table1.zip(m.table2).is_some_and(|(a, b)| a.visibility != b.visibility);
        let names: Vec<_> = MODELS.iter().filter(differs).map(|m| m.name).collect();
        assert_eq!(names, ["Blade"]);
        let times = |m: &PaperModel| m.table1.zip(m.table2).is_none_or(|(a, b)| a.measure_seconds == b.measure_seconds);
        assert!(MODELS.iter().all(times));
    }
}
