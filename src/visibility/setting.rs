use std::fmt;
use std::str::FromStr;

use crate::backend::BackendKind;
use crate::visibility::{Estimator, MeasureOptions};

/// What is counted, by whom: one way to measure visibility.
///
/// Written `coverage@raster`. A part that is left out is the usual one: `embree` is `coverage@embree`, `hemisphere` is
/// `hemisphere@embree`.
///
/// # Examples
/// ```
/// use outsight::visibility::Setting;
///
/// let setting: Setting = "hemisphere".parse()?;
/// assert_eq!(setting.to_string(), "hemisphere@embree");
/// # Ok::<(), String>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Setting {
    /// What is counted.
    pub estimator: Estimator,
    /// Who looks.
    pub backend: BackendKind,
}

/// The estimators that have a name on the command line.
const ESTIMATORS: [Estimator; 4] =
    [Estimator::Coverage, Estimator::ItemBuffer, Estimator::Surface, Estimator::Hemisphere];

/// The backends that have one.
const BACKENDS: [BackendKind; 3] = [BackendKind::Raster, BackendKind::Embree, BackendKind::Gpu];

/// Characters of a wrong name that the message repeats.
const MOST_QUOTED: usize = 40;

impl Setting {
    /// Whether the backend can do what the estimator needs, apart from whether it is there.
    #[must_use]
    pub fn goes_together(self) -> bool {
        self.estimator.draws() || self.backend.casts_rays()
    }

    /// `options` with this estimator and backend.
    #[must_use]
    pub fn apply(self, options: &MeasureOptions) -> MeasureOptions {
        MeasureOptions { estimator: self.estimator, backend: self.backend, ..options.clone() }
    }
}

impl Estimator {
    /// Whether it looks at pictures, pixel by pixel.
    #[must_use]
    pub fn draws(self) -> bool {
        matches!(self, Self::Coverage | Self::ItemBuffer)
    }

    /// Whether it looks from cameras, so that it can say which of them sees which triangle.
    #[must_use]
    pub fn has_cameras(self) -> bool {
        self != Self::Hemisphere
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}@{}", self.estimator.name(), self.backend.name())
    }
}

impl FromStr for Setting {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let estimator = |name: &str| ESTIMATORS.into_iter().find(|e| e.name() == name);
        let backend = |name: &str| BACKENDS.into_iter().find(|b| b.name() == name);
        let usual = |e: Estimator| if e.draws() { BackendKind::Raster } else { BackendKind::Embree };
        let found = match text.split_once('@') {
            Some((e, b)) => estimator(e).zip(backend(b)),
            None => backend(text).map(|b| (Estimator::Coverage, b)).or_else(|| estimator(text).map(|e| (e, usual(e)))),
        };
        found.map(|(estimator, backend)| Self { estimator, backend }).ok_or_else(|| {
            // Only what would work here is offered.
            let here = BACKENDS.into_iter().filter(|b| b.check().is_ok()).map(BackendKind::name).collect::<Vec<_>>();
            let text: String = text.chars().take(MOST_QUOTED).collect();
            format!(
                "{text} is neither a backend ({}), an estimator (coverage, item-buffer, surface, hemisphere) nor both, as \
                 in surface@embree",
                here.join(", ")
            )
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_name_alone_stands_for_the_usual_pair() {
        let cases = [
            ("raster", "coverage@raster"),
            ("embree", "coverage@embree"),
            ("coverage", "coverage@raster"),
            ("item-buffer", "item-buffer@raster"),
            ("surface", "surface@embree"),
            ("item-buffer@embree", "item-buffer@embree"),
        ];
        for (written, meant) in cases {
            assert_eq!(written.parse::<Setting>().unwrap().to_string(), meant);
        }
    }

    #[test]
    fn other_names_are_refused_and_the_judge_stays_in_court() {
        for wrong in ["", "@", "brute", "raster@coverage", "coverage@", "surface@brute", "Raster"] {
            assert!(wrong.parse::<Setting>().is_err(), "{wrong}");
        }
    }
}
