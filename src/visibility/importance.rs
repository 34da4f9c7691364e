use crate::error::{Error, Result, short_number};
use crate::visibility::Visibility;

/// What becomes of triangles that nobody sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Hidden {
    /// They stay recognisable: no visibility counts less than 0.02.
    Keep,
    /// They collapse first, among themselves in the order of their unweighted error.
    Collapse,
    /// They are removed before simplifying; what is left is treated as in `Collapse`.
    #[default]
    Delete,
}

impl Hidden {
    /// The name on the command line and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Keep => "keep",
            Self::Collapse => "collapse",
            Self::Delete => "delete",
        }
    }

    /// What [`importance`] gives to a triangle that nobody sees without meaning that it matters.
    #[must_use]
    pub fn importance_floor(self) -> f64 {
        match self {
            Self::Keep => 0.0,
            Self::Collapse | Self::Delete => HIDDEN_WEIGHT,
        }
    }
}

/// Smallest visibility under [`Hidden::Keep`].
const KEPT_VISIBILITY: f64 = 0.02;

/// Added to the weight of every triangle, so that hidden ones collapse in the order of their error.
const HIDDEN_WEIGHT: f64 = 1e-6;

/// How much the error of each triangle counts: V^power, and a trace more where that would be nothing.
///
/// Source: Zhang & Turk 2002, eqs. (5.8) to (5.10), where V enters squared; the trace is ours.
///
/// # Errors
/// [`Error::Option`] for a power that is not a number from 0 to 16.
pub fn importance(visibility: &Visibility, hidden: Hidden, power: f64) -> Result<Vec<f64>> {
    if !(0.0..=16.0).contains(&power) {
        return Err(Error::Option {
            name: "--visibility-power",
            message: format!("{} is not a power from 0 to 16; 2 is the paper's", short_number(power)),
        });
    }
    // A square is one product; other powers go through a library that gives the same bits on every machine.
    let raised = |v: f64| if power == 2.0 { v * v } else { libm::pow(v, power) };
    let weight = |&v: &f64| match hidden {
        Hidden::Keep => raised(v.max(KEPT_VISIBILITY)),
        Hidden::Collapse | Hidden::Delete => raised(v) + HIDDEN_WEIGHT,
    };
    Ok(visibility.per_triangle().iter().map(weight).collect())
}
