//! What VG's levels are beside QB's: by how much their pictures are better, and how many triangles QB takes for the same.

use serde::Serialize;

use super::cell::{LevelFinding, RunFinding};
use crate::pipeline::Preset;

/// Whose options: VG's, then QB's.
pub type PresetPair = (Preset, Preset);

/// The pairs that a reader may want to compare: the paper's both, the best against the paper's QB, and the best both.
pub(super) const PAIRS: [PresetPair; 3] =
    [(Preset::Paper, Preset::Paper), (Preset::Best, Preset::Paper), (Preset::Best, Preset::Best)];

/// At which of the levels that were asked for as a share two simplifiers are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Levels {
    /// At all.
    All,
    /// Where both have the triangles that were asked for, see [`LevelFinding::is_as_asked`].
    EqualCounts,
}

/// By how much one simplifier's pictures are nearer to the original than another's.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Improvement {
    /// VG with these options
    pub visibility: Preset,
    /// against QB with these.
    pub quadric: Preset,
    /// Mean over all levels, in percent of the image error of QB; `None` where QB has none.
    pub less_error: Option<f64>,
    /// Mean over the levels where both have the triangles that were asked for; `None` where there are none.
    pub less_error_at_equal_counts: Option<f64>,
    /// The number of those levels.
    pub equal_counts: usize,
    /// QB's triangles for the image error of VG, one entry per level of VG.
    pub equal_error: Vec<EqualError>,
}

/// VG and QB with the same image error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EqualError {
    /// Triangles asked of VG.
    pub asked: usize,
    /// QB's triangles.
    pub quadric: QuadricCount,
}

/// How many triangles reach an image error, as far as the levels tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum QuadricCount {
    /// So many to three digits, between two levels by the straight line of the error over the logarithm of the triangles.
    About(usize),
    /// More than the largest level has.
    MoreThan(usize),
    /// No more than the smallest level has.
    AtMost(usize),
}

/// Largest difference between the triangles that a level has and those that were asked for, as a share.
const AS_ASKED: f64 = 0.01;
/// The same in triangles: a collapse takes as many at once.
const PER_COLLAPSE: usize = 2;

impl LevelFinding {
    /// Whether it has the triangles that were asked for, within 1 % or a collapse; deleting what is hidden takes more.
    #[must_use]
    pub fn is_as_asked(&self) -> bool {
        let difference = self.triangles.abs_diff(self.asked);
        difference <= PER_COLLAPSE || difference as f64 <= AS_ASKED * self.asked as f64
    }
}

impl RunFinding {
    /// By how much the image error is below that of `other`, in percent of `other`'s, mean over the levels. A level at which
    /// `other` has no error is left out; `None` if that leaves none.
    ///
    /// Source: Zhang & Turk 2002, table 2, last column.
    #[must_use]
    pub fn less_error_than(&self, other: &Self, levels: Levels) -> Option<f64> {
        let ratios = self.beside(other, levels).map(|(a, b)| (a.errors.image_rms, b.errors.image_rms));
        let gains: Vec<f64> = ratios.filter(|&(_, b)| b > 0.0).map(|(a, b)| 100.0 * (1.0 - a / b)).collect();
        mean(&gains)
    }

    /// The levels that were asked for as a share, each beside that of `other`.
    fn beside<'a>(
        &'a self,
        other: &'a Self,
        levels: Levels,
    ) -> impl Iterator<Item = (&'a LevelFinding, &'a LevelFinding)> {
        let compared = move |(a, b): &(&LevelFinding, &LevelFinding)| match levels {
            Levels::All => true,
            Levels::EqualCounts => a.is_as_asked() && b.is_as_asked(),
        };
        self.shared_levels().zip(other.shared_levels()).filter(compared)
    }

    /// The fewest triangles that have an image error (image RMS) of `error` or less; `None` if there are no levels.
    #[must_use]
    pub fn triangles_for(&self, error: f64) -> Option<QuadricCount> {
        let (first, last) = (self.levels.first()?, self.levels.last()?);
        let Some(reached) = self.levels.iter().rposition(|level| level.errors.image_rms <= error) else {
            return Some(QuadricCount::MoreThan(first.triangles));
        };
        let Some([fine, coarse]) = self.levels.get(reached..reached + 2) else {
            return Some(QuadricCount::AtMost(last.triangles));
        };
        let (least, most) = (fine.errors.image_rms, coarse.errors.image_rms);
        let share = (most - error) / (most - least);
        let [from, to] = [coarse, fine].map(|level| libm::log(level.triangles as f64));
        Some(QuadricCount::About(to_three_digits(libm::exp(from + share * (to - from)))))
    }
}

impl Improvement {
    pub(super) fn of((visibility, quadric): PresetPair, vg: &RunFinding, qb: &RunFinding) -> Self {
        let equal = |level: &LevelFinding| {
            Some(EqualError { asked: level.asked, quadric: qb.triangles_for(level.errors.image_rms)? })
        };
        Self {
            visibility,
            quadric,
            less_error: vg.less_error_than(qb, Levels::All),
            less_error_at_equal_counts: vg.less_error_than(qb, Levels::EqualCounts),
            equal_counts: vg.beside(qb, Levels::EqualCounts).count(),
            equal_error: vg.levels.iter().filter_map(equal).collect(),
        }
    }

    pub(super) fn pair(&self) -> PresetPair {
        (self.visibility, self.quadric)
    }

    /// Mean over these levels, in percent of the image error of QB.
    #[must_use]
    pub fn at(&self, levels: Levels) -> Option<f64> {
        match levels {
            Levels::All => self.less_error,
            Levels::EqualCounts => self.less_error_at_equal_counts,
        }
    }
}

/// Rounded to as many digits as interpolation is worth.
fn to_three_digits(count: f64) -> usize {
    let unit = libm::exp10(f64::max(libm::floor(libm::log10(count)) - 2.0, 0.0));
    (libm::round(count / unit) * unit) as usize
}

/// `None` of nothing.
pub(super) fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}
