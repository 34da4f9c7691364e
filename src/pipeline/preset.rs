use serde::{Deserialize, Serialize};

use crate::simplify::SimplifyOptions;
use crate::visibility::{Hidden, MeasureOptions};

/// p in V^p: both presets square, as the paper does.
pub const VISIBILITY_POWER: f64 = 2.0;

/// Defaults for looking and for simplifying that belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Preset {
    /// Nearest to the text of Zhang & Turk 2002.
    Paper,
    /// The best results.
    Best,
}

impl Preset {
    /// Both, the paper's first.
    pub const ALL: [Self; 2] = [Self::Paper, Self::Best];

    /// The name on the command line and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Best => "best",
        }
    }

    /// How visibility is measured.
    #[must_use]
    pub fn measure(self) -> MeasureOptions {
        match self {
            Self::Paper => MeasureOptions::paper(),
            Self::Best => MeasureOptions::default(),
        }
    }

    /// How edges are collapsed.
    #[must_use]
    pub fn simplify(self) -> SimplifyOptions {
        match self {
            Self::Paper => SimplifyOptions::paper(),
            Self::Best => SimplifyOptions::default(),
        }
    }

    /// What happens to hidden triangles where visibility orders the collapses.
    #[must_use]
    pub fn hidden(self) -> Hidden {
        match self {
            Self::Paper => Hidden::Collapse,
            Self::Best => Hidden::Delete,
        }
    }
}
