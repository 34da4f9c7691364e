//! What stands beside the tables and figures: the same words on the page and in Markdown.

use super::ZtRequest;
use super::cell::{LevelFinding, RunFinding};
use super::gain::{Improvement, Levels, PresetPair, QuadricCount};
use super::report::{ModelReport, ZtReport};
use super::summary::MeanImprovement;
use crate::pipeline::{Metric, Preset};
use crate::report::paper;
use crate::report::table::thousands;

pub(super) const SUBTITLE: &str = "The tables and figures of E. Zhang and G. Turk, Visibility-Guided Simplification, IEEE \
    Visualization 2002, made again. Numbers in brackets are the paper's own.";
pub(super) const TABLE1: &str = "V(M) is the share of directions from which the surface is seen from outside, each counted by \
    its cosine (eq. 3.2); column heads name the options. VG best, before it deletes what is hidden, looks again from other directions \
    until it is sure: the last column, where there is one.";
pub(super) const TABLE2: &str = "QB collapses by quadric error alone, VG also by visibility: seconds first, without looking. The \
    last columns tell by how much the image error of VG is below that of QB, mean over the levels; below zero VG is worse. Behind a \
    semicolon: over those levels alone at which both have the triangles that were asked for, and how many these are. VG best \
    deletes hidden triangles first and can be left with fewer; having fewer is no help to its pictures.";
pub(super) const GAINS: &str = "By how much the image error of VG is below that of QB (%), mean over the models, how many in \
    brackets; V(M) is as VG's options count it. Then Spearman's rank correlation of V(M), as either preset counts it, with that \
    improvement; -1: the less visible a model is, the more is gained. Fewer than five models have none: their order says nothing.";
pub(super) const LEVELS: &str = "First the image error (RMSE, grey levels), then how many triangles QB takes for the image error \
    of VG in this row, between levels by interpolation, then the geometric error (RMS, % of the diagonal). “With”: the triangles \
    of a level that has not as many as were asked for.";

/// `VG best`
pub(super) fn short(preset: Preset, metric: Metric) -> String {
    let metric = if metric == Metric::Quadric { "QB" } else { "VG" };
    format!("{metric} {}", preset.name())
}

/// `% less than QB paper`
pub(super) fn percent_of((_, quadric): PresetPair) -> String {
    format!("% less than {}", short(quadric, Metric::Quadric))
}

impl ZtReport {
    /// What to know about all of it, a sentence each.
    pub(super) fn notes(&self, request: &ZtRequest) -> Vec<String> {
        let mut notes: Vec<String> = self.left_out_in_words().into_iter().collect();
        notes.push(format!(
            "Levels: {} % of the triangles. The paper has seven and does not say which; unless --levels names others they \
             are halves down to 1/128, which spread evenly over the logarithmic axis of its figure 4.",
            shares(&request.levels)
        ));
        notes.push(format!(
            "Image error: 20 views of 512 × 512 pixels from the corners of a dodecahedron, head light. Geometric error: {} \
             samples on each mesh.",
            thousands(request.samples)
        ));
        if !request.presets.contains(&Preset::Paper) {
            notes.push(
                "The paper's QB and VG were not studied (--preset paper, or both), so nothing is compared with them."
                    .to_owned(),
            );
        }
        if self.models.iter().any(|model| model.findings.viewer.is_none()) {
            let words = "Where the page has no room for all models to be turned, those of which least is seen come first; a study of \
                fewer shows the others so, too.";
            notes.push(words.to_owned());
        }
        let machine = if request.machine.is_empty() { "of this machine" } else { &request.machine };
        notes.push(format!(
            "Times are wall time {machine}, or of the machine on which an earlier run found them; the paper's, in minutes, are \
             of an SGI Octane with 195 MHz."
        ));
        notes.extend(paper::NOTES.iter().map(|note| format!("In the paper, {note}.")));
        notes
    }

    /// What came out, for who reads no further; then what is left out.
    pub(super) fn summary_in_words(&self) -> String {
        let verdict = self.summary.iter().rfind(|summary| summary.levels == Levels::All).map(|summary| {
            let sides = [
                ("where less than half of a model is seen", summary.below_half),
                ("where half or more is seen", summary.from_half),
            ];
            let side = |(place, mean): (&str, MeanImprovement)| {
                let gain = mean.less_error?;
                let side = if gain < 0.0 { "above" } else { "below" };
                Some(format!("{:.1} % {side} that of QB {place} (models: {})", gain.abs(), mean.models))
            };
            let sides: Vec<String> = sides.into_iter().filter_map(side).collect();
            format!(
                "VG collapses by shape and visibility, QB by shape alone. With the options of preset {}, the image error of VG is \
                 {}; mean over the levels.",
                summary.visibility.name(),
                sides.join(", and ")
            )
        });
        verdict.into_iter().chain(self.left_out_in_words()).collect::<Vec<_>>().join(" ")
    }

    /// Which models of the directory this report leaves out; `None` if it leaves out none.
    #[must_use]
    pub fn left_out_in_words(&self) -> Option<String> {
        (!self.left_out.is_empty()).then(|| {
            let names = self.left_out.join(", ");
            format!("Not in this report, though found earlier in the same directory: {names}. Name all files to have all of them.")
        })
    }
}

impl ModelReport {
    /// What the paper's numbers beside this model's are worth, and what to know of its own.
    #[must_use]
    pub fn remarks(&self) -> String {
        let mut stand = format!("{}.", self.stand_in_words);
        stand.get_mut(..1).map(str::make_ascii_uppercase);
        let notes = self.stand.model().map_or(&[][..], |paper| paper.notes);
        let notes = notes.iter().map(|note| format!("In the paper, {note}."));
        let sentences =
            std::iter::once(stand).chain(notes).chain(self.less_error_where_shown()).chain(self.equal_error_in_words());
        let sentences = sentences.chain(self.unequal_counts());
        sentences.collect::<Vec<_>>().join(" ")
    }

    /// By how much VG's error is below that of QB in the pictures.
    fn less_error_where_shown(&self) -> Option<String> {
        let asked = self.findings.pictures.first()?.sheets.first()?.triangles;
        let clause = |improvement: &Improvement| {
            let error = |preset, metric| Some(self.run(preset, metric)?.level_of(asked)?.errors.image_rms);
            let (visibility, quadric) = improvement.pair();
            let [vg, qb] = [error(visibility, Metric::Visibility)?, error(quadric, Metric::Quadric)?];
            let gain = 100.0 * (1.0 - vg / qb);
            let side = if gain < 0.0 { "more" } else { "less" };
            let [vg, qb] = [(visibility, Metric::Visibility), (quadric, Metric::Quadric)].map(|(p, m)| short(p, m));
            gain.is_finite().then(|| format!("{vg} has {:.1} % {side} image error than {qb}", gain.abs()))
        };
        let clauses: Vec<String> = self.improvements.iter().filter_map(clause).collect();
        (!clauses.is_empty()).then(|| format!("At {} triangles {}.", thousands(asked as u64), clauses.join(", ")))
    }

    /// With how many triangles QB has the image error of VG, at a count that the paper compares or shows.
    fn equal_error_in_words(&self) -> Option<String> {
        let printed = self.stand.model().and_then(|paper| paper.equal_error);
        let shown = |level: &&LevelFinding| printed.map_or(level.mesh.is_some(), |p| level.asked == p.visibility);
        let asked = self.findings.runs.first()?.levels.iter().find(shown)?.asked;
        let clause = |improvement: &Improvement| {
            let equal = improvement.equal_error.iter().find(|equal| equal.asked == asked)?;
            let vg = short(improvement.visibility, Metric::Visibility);
            let qb = short(improvement.quadric, Metric::Quadric);
            Some(format!("{vg} has the image error of {qb} with {}", in_words(equal.quadric)))
        };
        let clauses: Vec<String> = self.improvements.iter().filter_map(clause).collect();
        let printed = printed.map(|p| format!(" In the paper it is that of QB with {}.", thousands(p.quadric as u64)));
        let all = format!("With {} triangles {}.", thousands(asked as u64), clauses.join(", "));
        (!clauses.is_empty()).then(|| all + &printed.unwrap_or_default())
    }

    /// Where a simplifier has not the triangles that it was asked for, a sentence each.
    fn unequal_counts(&self) -> impl Iterator<Item = String> {
        self.findings.runs.iter().flat_map(|run| [unequal(run, true), unequal(run, false)]).flatten()
    }
}

/// The levels at which a simplifier has fewer triangles than were asked for, or more.
fn unequal(run: &RunFinding, fewer: bool) -> Option<String> {
    let is_such = |level: &&LevelFinding| !level.is_as_asked() && (level.triangles < level.asked) == fewer;
    let levels: Vec<&LevelFinding> = run.shared_levels().filter(is_such).collect();
    let (first, last) = (levels.first()?, levels.last()?);
    let asked = shares(&levels.iter().filter_map(|level| level.share).collect::<Vec<_>>());
    let [most, least] = [first, last].map(|level| thousands(level.triangles as u64));
    let left = if most == least { most } else { format!("{most} to {least}") };
    let why = match (fewer, run.hidden_deleted) {
        (true, 1..) => "since hidden triangles are deleted first; having fewer is no help to its pictures",
        (true, 0) => "fewer than were asked for, since a collapse took more at once",
        (false, _) => "more than were asked for, since nothing else may be collapsed",
    };
    Some(format!("At {asked} % {} has {left} triangles, {why}.", short(run.preset, run.metric)))
}

fn in_words(count: QuadricCount) -> String {
    match count {
        QuadricCount::About(n) => format!("about {}", thousands(n as u64)),
        QuadricCount::MoreThan(n) => format!("more than {}", thousands(n as u64)),
        QuadricCount::AtMost(n) => format!("at most {}", thousands(n as u64)),
    }
}

/// `50, 25 and 12.5`
fn shares(levels: &[f64]) -> String {
    let percent = |share: &f64| {
        let digits = format!("{:.3}", 100.0 * share);
        digits.trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    let all: Vec<String> = levels.iter().map(percent).collect();
    match all.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        _ => all.concat(),
    }
}
