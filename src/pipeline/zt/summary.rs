//! What all models say together: means, and who gains.

use serde::Serialize;

use super::gain::{Levels, PAIRS, mean};
use super::report::ModelReport;
use crate::pipeline::Preset;
use crate::report::rank;

/// V(M) that parts models which hide much from those which hide little.
pub(super) const HALF: f64 = 0.5;

/// The improvement of VG over QB of all models.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ImprovementSummary {
    /// VG with these options
    pub visibility: Preset,
    /// against QB with these,
    pub quadric: Preset,
    /// at these levels.
    pub levels: Levels,
    /// Mean over all models.
    pub all: MeanImprovement,
    /// Over those with V(M) < 0.5, as VG's options count it.
    pub below_half: MeanImprovement,
    /// Over the others.
    pub from_half: MeanImprovement,
    /// How V(M) and the improvement go together, one entry per preset that counted V.
    pub correlations: Vec<Correlation>,
}

/// Mean of the improvements of several models.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MeanImprovement {
    /// In percent of the image error of QB; `None` of no model.
    pub less_error: Option<f64>,
    /// Models.
    pub models: usize,
}

/// Spearman's rank correlation of V(M) with the improvement.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Correlation {
    /// V as these options count it.
    pub preset: Preset,
    /// -1 to 1; negative where less visible models gain more. `None` for fewer than 5 models, which say nothing.
    pub rank_correlation: Option<f64>,
    /// Models.
    pub models: usize,
}

impl ImprovementSummary {
    /// One entry per pair of simplifiers that was studied and choice of levels.
    pub(super) fn of_all(models: &[ModelReport]) -> Vec<Self> {
        let studied = |pair| models.iter().any(|model| model.improvement(pair).is_some());
        let both = |pair| [Levels::All, Levels::EqualCounts].map(|levels| (pair, levels));
        let of = |((visibility, quadric), levels)| {
            let gain = |model: &ModelReport| model.less_error((visibility, quadric), levels);
            let known = |model: &ModelReport| Some((model.visibility(visibility)?, gain(model)?));
            let known: Vec<(f64, f64)> = models.iter().filter_map(known).collect();
            let correlation = |&preset: &Preset| Correlation::of(preset, models, gain);
            Self {
                visibility,
                quadric,
                levels,
                all: MeanImprovement::of(&known, |_| true),
                below_half: MeanImprovement::of(&known, |v| v < HALF),
                from_half: MeanImprovement::of(&known, |v| v >= HALF),
                correlations: Preset::ALL.iter().filter_map(correlation).collect(),
            }
        };
        PAIRS.into_iter().filter(|&pair| studied(pair)).flat_map(both).map(of).collect()
    }

    /// The rank correlation with V as `preset` counts it.
    #[must_use]
    pub fn rank_correlation(&self, preset: Preset) -> Option<f64> {
        self.correlations.iter().find(|c| c.preset == preset).and_then(|c| c.rank_correlation)
    }
}

impl MeanImprovement {
    /// Over the models (V(M), improvement) of such a V(M).
    pub(super) fn of(models: &[(f64, f64)], such: impl Fn(f64) -> bool) -> Self {
        let gains: Vec<f64> = models.iter().filter(|&&(v, _)| such(v)).map(|&(_, gain)| gain).collect();
        Self { less_error: mean(&gains), models: gains.len() }
    }
}

impl Correlation {
    fn of(preset: Preset, models: &[ModelReport], gain: impl Fn(&ModelReport) -> Option<f64>) -> Option<Self> {
        let known = |model: &ModelReport| Some((model.visibility(preset)?, gain(model)?));
        let (visibility, gains): (Vec<f64>, Vec<f64>) = models.iter().filter_map(known).unzip();
        let rank_correlation = rank::rank_correlation(&visibility, &gains);
        (!gains.is_empty()).then_some(Self { preset, rank_correlation, models: gains.len() })
    }
}
