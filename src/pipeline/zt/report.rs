//! What the findings say, model by model, and what the paper prints beside them.

use serde::Serialize;

use super::cell::{LookFinding, RunFinding};
use super::gain::{Improvement, Levels, PAIRS, PresetPair};
use super::summary::ImprovementSummary;
use super::{MOST_VIEWERS, ModelFindings, ZtModel};
use crate::pipeline::{Metric, Preset};
use crate::report::paper::Stand;

/// Result of [`super::study_zt`].
#[derive(Debug, Clone, Serialize)]
pub struct ZtReport {
    /// One entry per model.
    pub models: Vec<ModelReport>,
    /// All models together, one entry per pair of simplifiers and choice of levels.
    pub summary: Vec<ImprovementSummary>,
    /// Models that earlier runs left findings of in the same directory, and that this run was not asked about.
    pub left_out: Vec<String>,
}

/// One model, what was found about it, and what it is to the paper.
#[derive(Debug, Clone, Serialize)]
pub struct ModelReport {
    /// What the paper prints of the model in whose place it stands.
    pub stand: Stand,
    /// The same in words.
    pub stand_in_words: String,
    /// The last column of table 2, for each pair of simplifiers that a reader may want to compare.
    pub improvements: Vec<Improvement>,
    /// All that was found.
    #[serde(flatten)]
    pub findings: ModelFindings,
}

impl ZtReport {
    pub(super) fn of(models: &[ZtModel], findings: Vec<ModelFindings>, left_out: Vec<String>) -> Self {
        let mut models: Vec<_> =
            models.iter().zip(findings).map(|(model, found)| ModelReport::of(model, found)).collect();
        leave_viewers_to_the_least_visible(&mut models);
        let summary = ImprovementSummary::of_all(&models);
        Self { models, summary, left_out }
    }

    /// The presets that were studied.
    #[must_use]
    pub fn presets(&self) -> Vec<Preset> {
        let studied = |preset: &Preset| self.models.iter().any(|model| model.look(*preset).is_some());
        Preset::ALL.into_iter().filter(studied).collect()
    }
}

/// Of more than [`MOST_VIEWERS`] models only those of which least is seen can be turned: there the comparison tells most.
fn leave_viewers_to_the_least_visible(models: &mut [ModelReport]) {
    let seen = |model: &ModelReport| model.table_visibility().unwrap_or(1.0);
    let mut order: Vec<usize> = (0..models.len()).collect();
    order.sort_by(|&a, &b| seen(&models[a]).total_cmp(&seen(&models[b])));
    for number in order.into_iter().skip(MOST_VIEWERS) {
        models[number].findings.viewer = None;
    }
}

impl ModelReport {
    fn of(model: &ZtModel, findings: ModelFindings) -> Self {
        let stand = match Stand::of(model.paper, findings.triangles) {
            Stand::Original(paper) if model.stand_in => Stand::StandIn(paper),
            stand => stand,
        };
        let stand_in_words = stand.sentence(findings.triangles);
        let mut report = Self { stand, stand_in_words, improvements: Vec::new(), findings };
        let improvement = |&(visibility, quadric): &PresetPair| {
            let vg = report.run(visibility, Metric::Visibility)?;
            Some(Improvement::of((visibility, quadric), vg, report.run(quadric, Metric::Quadric)?))
        };
        report.improvements = PAIRS.iter().filter_map(improvement).collect();
        report
    }

    /// V(M) as the preset finds it.
    #[must_use]
    pub fn visibility(&self, preset: Preset) -> Option<f64> {
        self.look(preset).map(|look| look.visibility)
    }

    /// V(M) as the paper counts it, or else as it was counted.
    #[must_use]
    pub fn table_visibility(&self) -> Option<f64> {
        self.visibility(Preset::Paper).or(self.visibility(Preset::Best))
    }

    /// How the preset saw it.
    #[must_use]
    pub fn look(&self, preset: Preset) -> Option<&LookFinding> {
        self.findings.looks.iter().find(|look| look.preset == preset)
    }

    /// VG beside QB with these options.
    #[must_use]
    pub fn improvement(&self, pair: PresetPair) -> Option<&Improvement> {
        self.improvements.iter().find(|improvement| improvement.pair() == pair)
    }

    /// The improvement of VG over QB with these options, mean over the levels, in percent of the image error of QB.
    #[must_use]
    pub fn less_error(&self, pair: PresetPair, levels: Levels) -> Option<f64> {
        self.improvement(pair).and_then(|improvement| improvement.at(levels))
    }

    /// A simplifier's findings.
    #[must_use]
    pub fn run(&self, preset: Preset, metric: Metric) -> Option<&RunFinding> {
        self.findings.runs.iter().find(|run| (run.preset, run.metric) == (preset, metric))
    }
}
