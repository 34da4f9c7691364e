//! What the findings say together: improvements, correlations, what the paper prints beside them.

use serde::Serialize;

use super::cell::{LookFinding, RunFinding};
use super::{ModelFindings, ZtModel};
use crate::pipeline::{Metric, Preset};
use crate::report::paper::Stand;
use crate::report::rank::spearman;

/// Result of [`super::study_zt`].
#[derive(Debug, Clone, Serialize)]
pub struct ZtReport {
    /// One entry per model.
    pub models: Vec<ModelReport>,
    /// How V(M) and the improvement go together, one entry per preset.
    pub correlations: Vec<Correlation>,
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

/// By how much one simplifier's pictures are nearer to the original than another's.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Improvement {
    /// VG with these options
    pub visibility: Preset,
    /// against QB with these.
    pub quadric: Preset,
    /// Mean over the levels, in percent of the image error of QB; `None` where QB has none.
    pub less_error: Option<f64>,
}

/// Spearman's rank correlation of V(M) with the improvement over QB `paper`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Correlation {
    /// VG with these options.
    pub preset: Preset,
    /// -1 to 1; negative where less visible models gain more. `None` for fewer than 3 models.
    pub rank_correlation: Option<f64>,
    /// Models.
    pub models: usize,
}

impl ZtReport {
    pub(super) fn of(models: &[ZtModel], findings: Vec<ModelFindings>) -> Self {
        let models: Vec<_> = models.iter().zip(findings).map(|(model, found)| ModelReport::of(model, found)).collect();
        let correlations = Preset::ALL.iter().filter_map(|&preset| Correlation::of(preset, &models)).collect();
        Self { models, correlations }
    }
}

impl ModelReport {
    fn of(model: &ZtModel, findings: ModelFindings) -> Self {
        let stand = Stand::of(model.paper, findings.triangles);
        let stand_in_words = stand.sentence(findings.triangles);
        let improvements = PAIRS.iter().filter_map(|&pair| improvement(&findings.runs, pair)).collect();
        Self { stand, stand_in_words, improvements, findings }
    }

    /// V(M) as the preset finds it.
    #[must_use]
    pub fn visibility(&self, preset: Preset) -> Option<f64> {
        self.look(preset).map(|look| look.visibility)
    }

    /// How the preset saw it.
    #[must_use]
    pub fn look(&self, preset: Preset) -> Option<&LookFinding> {
        self.findings.looks.iter().find(|look| look.preset == preset)
    }

    /// The improvement of VG over QB, with the options of these presets.
    #[must_use]
    pub fn less_error(&self, visibility: Preset, quadric: Preset) -> Option<f64> {
        let same = |i: &&Improvement| (i.visibility, i.quadric) == (visibility, quadric);
        self.improvements.iter().find(same).and_then(|i| i.less_error)
    }

    /// A simplifier's findings.
    #[must_use]
    pub fn run(&self, preset: Preset, metric: Metric) -> Option<&RunFinding> {
        run(&self.findings.runs, preset, metric)
    }
}

/// VG and QB: the paper's both, the best against the paper's QB, and the best both.
pub(super) const PAIRS: [(Preset, Preset); 3] =
    [(Preset::Paper, Preset::Paper), (Preset::Best, Preset::Paper), (Preset::Best, Preset::Best)];

fn improvement(runs: &[RunFinding], (visibility, quadric): (Preset, Preset)) -> Option<Improvement> {
    let vg = run(runs, visibility, Metric::Visibility)?;
    let qb = run(runs, quadric, Metric::Quadric)?;
    Some(Improvement { visibility, quadric, less_error: vg.less_error_than(qb) })
}

fn run(runs: &[RunFinding], preset: Preset, metric: Metric) -> Option<&RunFinding> {
    runs.iter().find(|run| (run.preset, run.metric) == (preset, metric))
}

impl Correlation {
    fn of(preset: Preset, models: &[ModelReport]) -> Option<Self> {
        let known = |model: &ModelReport| Some((model.visibility(preset)?, model.less_error(preset, Preset::Paper)?));
        let (visibility, gain): (Vec<f64>, Vec<f64>) = models.iter().filter_map(known).unzip();
        let rank_correlation = spearman(&visibility, &gain);
        (!gain.is_empty()).then_some(Self { preset, rank_correlation, models: gain.len() })
    }
}
