//! What the findings say, model by model, and what the paper prints beside them.

use serde::Serialize;

use super::cell::{LookFinding, RunFinding};
use super::gain::{Improvement, Levels, PAIRS, PresetPair};
use super::summary::ImprovementSummary;
use super::{ModelFindings, ZtModel};
use crate::pipeline::{Metric, Preset};
use crate::report::page::MODELS_BYTES;
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

/// Where a page has no room for all models to be turned, those of which least is seen come first: there the comparison tells
/// most.
fn leave_viewers_to_the_least_visible(models: &mut [ModelReport]) {
    let viewer = |model: &ModelReport| {
        let shown = model.findings.viewer.iter().flat_map(|found| &found.models);
        (model.table_visibility().unwrap_or(1.0), shown.map(|model| model.model.bytes()).sum())
    };
    let have_room = with_room(&models.iter().map(viewer).collect::<Vec<_>>(), MODELS_BYTES);
    for (model, _) in models.iter_mut().zip(have_room).filter(|(_, has_room)| !has_room) {
        model.findings.viewer = None;
    }
}

/// Which of (V(M), bytes) have room in `free` bytes, the smallest V(M) first.
fn with_room(viewers: &[(f64, usize)], free: usize) -> Vec<bool> {
    let mut order: Vec<usize> = (0..viewers.len()).collect();
    order.sort_by(|&a, &b| viewers[a].0.total_cmp(&viewers[b].0));
    let (mut left, mut have_room) = (free, vec![false; viewers.len()]);
    for number in order {
        have_room[number] = viewers[number].1 <= left;
        left -= if have_room[number] { viewers[number].1 } else { 0 };
    }
    have_room
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

#[cfg(test)]
mod tests {
    use super::with_room;

    #[test]
    fn room_goes_to_those_of_which_least_is_seen_and_to_what_fits_beside_them() {
        let viewers = [(0.9, 2), (0.3, 6), (0.5, 5), (0.2, 3), (1.0, 1)];
        assert_eq!(with_room(&viewers, 10), [false, true, false, true, true]);
        assert_eq!(with_room(&viewers, 17), [true, true, true, true, true]);
        assert_eq!(with_room(&viewers, 0), [false; 5]);
    }
}
