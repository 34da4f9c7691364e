//! Tables 1 and 2, who gains, and the levels of each model, for people.

use super::cell::{LevelFinding, RunFinding};
use super::gain::{EqualError, Levels, PresetPair, QuadricCount};
use super::report::{ModelReport, ZtReport};
use super::summary::{HALF, ImprovementSummary, MeanImprovement};
use super::words::{percent_of, short};
use crate::pipeline::{Metric, Preset};
use crate::report::paper::{self, Stand};
use crate::report::rank::spearman;
use crate::report::table::{Table, thousands};

/// The simplifiers in the order of the tables.
const RUNS: [(Preset, Metric); 4] = [
    (Preset::Paper, Metric::Quadric),
    (Preset::Paper, Metric::Visibility),
    (Preset::Best, Metric::Quadric),
    (Preset::Best, Metric::Visibility),
];

impl ZtReport {
    /// Table 1: how well the models are seen, and how long it takes; what the paper prints in brackets.
    #[must_use]
    pub fn table1(&self) -> Table {
        let presets = self.presets();
        let sure = |model: &ModelReport| model.findings.runs.iter().find_map(|run| run.hidden_seconds);
        let is_sure = self.models.iter().any(|model| sure(model).is_some());
        let heads = presets.iter().flat_map(|p| [format!("V(M), {}", p.name()), format!("time, {}", p.name())]);
        let last = is_sure.then(|| "sure of what is hidden".to_owned());
        let first = ["model", "of the paper", "triangles"].map(str::to_owned);
        let mut table = Table::new(first.into_iter().chain(heads).chain(last)).left(1);
        for model in &self.models {
            let printed = model.stand.model();
            let mut row = vec![
                model.findings.name.clone(),
                of_the_paper(model),
                beside(thousands(model.findings.triangles as u64), printed.map(|p| thousands(p.triangles as u64))),
            ];
            for look in presets.iter().filter_map(|&preset| model.look(preset)) {
                let visibility = printed.and_then(|p| p.visibility()).map(|v| format!("{v:.3}"));
                let printed_seconds = printed.and_then(|p| p.measure_seconds()).map(minutes);
                row.push(beside(format!("{:.3}", look.visibility), visibility));
                row.push(beside(format!("{} s", seconds(look.seconds)), printed_seconds));
            }
            let seconds = sure(model).map_or_else(dash, |s| format!("{} s", seconds(s)));
            row.extend(is_sure.then_some(seconds));
            table = table.row(row);
        }
        table
    }

    /// Table 2: by how much VG's pictures are nearer to the original than QB's; what the paper prints in brackets. Where some
    /// levels have other counts than were asked for, the improvement over the rest, and how many these are.
    #[must_use]
    pub fn table2(&self) -> Table {
        let columns = self.columns();
        let heads = columns.iter().map(|column| column.head.clone());
        let units = columns.iter().map(|column| column.unit.clone());
        let first = ["model", "of the paper", "V(M)"].map(str::to_owned);
        let empty = Table::new(first.into_iter().chain(heads)).left(1);
        let empty = empty.units(vec![String::new(); 3].into_iter().chain(units));
        self.models.iter().fold(empty, |table, model| {
            let cells = columns.iter().map(|column| (column.cell)(model));
            let visibility = model.table_visibility().map_or_else(dash, |v| format!("{v:.3}"));
            table.row([model.findings.name.clone(), of_the_paper(model), visibility].into_iter().chain(cells))
        })
    }

    fn columns(&self) -> Vec<Column> {
        let ran = |(preset, metric): &(Preset, Metric)| self.models.iter().any(|m| m.run(*preset, *metric).is_some());
        let mut columns: Vec<Column> = RUNS.into_iter().filter(ran).map(Column::of_seconds).collect();
        for summary in self.summary.iter().filter(|summary| summary.levels == Levels::All) {
            let pair = (summary.visibility, summary.quadric);
            columns.push(Column::of_gain(pair));
        }
        columns
    }

    /// Who gains: the improvement of all models, of those with V(M) below and from a half, and its rank correlation with
    /// V(M), by the ways in which simplifiers, levels and V may be chosen. How many models, in brackets. The first row is
    /// the paper's own.
    #[must_use]
    pub fn gains_table(&self) -> Table {
        let presets = self.presets();
        let ranks = presets.iter().map(|preset| format!("rank, V {}", preset.name()));
        let heads = ["compared", "levels", "all models", "V(M) < 0.5", "V(M) ≥ 0.5"].map(str::to_owned);
        let empty = Table::new(heads.into_iter().chain(ranks)).left(1).row(printed_row(&presets));
        self.summary.iter().fold(empty, |table, summary| {
            let ranks = presets.iter().map(|&preset| rank(summary.rank_correlation(preset)));
            table.row(means(summary).into_iter().chain(ranks))
        })
    }
}

/// A column of table 2.
struct Column {
    head: String,
    unit: String,
    cell: Box<dyn Fn(&ModelReport) -> String>,
}

impl Column {
    fn of_seconds((preset, metric): (Preset, Metric)) -> Self {
        let cell = move |model: &ModelReport| {
            let printed = printed(model).filter(|_| preset == Preset::Paper).map(|row| minutes(row.simplify_seconds));
            model.run(preset, metric).map_or_else(dash, |run| beside(seconds(run.seconds), printed))
        };
        Self { head: short(preset, metric), unit: "s".to_owned(), cell: Box::new(cell) }
    }

    fn of_gain(pair: PresetPair) -> Self {
        let cell = move |model: &ModelReport| {
            let printed = printed(model).filter(|_| pair == (Preset::Paper, Preset::Paper));
            let gain = model.less_error(pair, Levels::All).map_or_else(dash, percent);
            let equal = at_equal_counts(model, pair).map(|gain| format!("; {gain}")).unwrap_or_default();
            beside(gain, printed.map(|row| format!("{:.2}", row.less_error))) + &equal
        };
        Self { head: short(pair.0, Metric::Visibility), unit: percent_of(pair), cell: Box::new(cell) }
    }
}

/// `48.5 at 6 of 7`: the improvement over the levels with equal counts; `None` where these are all.
fn at_equal_counts(model: &ModelReport, pair: PresetPair) -> Option<String> {
    let improvement = model.improvement(pair)?;
    let levels = model.run(pair.0, Metric::Visibility)?.shared_levels().count();
    let gain = improvement.less_error_at_equal_counts.map_or_else(dash, percent);
    (improvement.equal_counts < levels).then(|| format!("{gain} at {} of {levels}", improvement.equal_counts))
}

impl ModelReport {
    /// Errors level by level, by simplifier, and how many triangles QB takes for VG's image error. A level that has not the
    /// triangles that were asked for says how many it has.
    #[must_use]
    pub fn level_table(&self) -> Table {
        let runs: Vec<&RunFinding> = RUNS.iter().filter_map(|&(preset, metric)| self.run(preset, metric)).collect();
        let names = || runs.iter().map(|run| short(run.preset, run.metric));
        let equal = self.improvements.iter().map(|i| {
            let [vg, qb] = [(i.visibility, Metric::Visibility), (i.quadric, Metric::Quadric)].map(|(p, m)| short(p, m));
            format!("{qb} like {vg}")
        });
        let heads = ["triangles asked for".to_owned()].into_iter().chain(names()).chain(equal).chain(names());
        let unit = |unit: &'static str, columns: usize| std::iter::repeat_n(unit, columns);
        let units = unit("", 1).chain(unit("grey levels", runs.len()));
        let units = units.chain(unit("triangles", self.improvements.len())).chain(unit("% of diagonal", runs.len()));
        let empty = Table::new(heads).units(units);
        let rows = runs.first().map_or(0, |run| run.levels.len());
        (0..rows).fold(empty, |table, row| table.row(self.level_row(&runs, row)))
    }

    fn level_row(&self, runs: &[&RunFinding], row: usize) -> Vec<String> {
        let levels: Vec<&LevelFinding> = runs.iter().filter_map(|run| run.levels.get(row)).collect();
        let image = |level: &&LevelFinding| match level.is_as_asked() {
            true => significant(level.errors.image_rmse),
            false => format!("{} with {}", significant(level.errors.image_rmse), thousands(level.triangles as u64)),
        };
        let equal = self.improvements.iter().map(|i| i.equal_error.get(row).map_or_else(dash, triangles));
        let geometric = |level: &&LevelFinding| significant(level.errors.geometric_rms);
        let asked = levels.first().map_or_else(dash, |level| asked(level));
        let cells = levels.iter().map(image).chain(equal).chain(levels.iter().map(geometric));
        std::iter::once(asked).chain(cells).collect()
    }
}

/// `1,724 (1.56 %)`, or `15,000` for a count that the paper names.
fn asked(level: &LevelFinding) -> String {
    let share = level.share.map(|share| format!("{} %", significant(100.0 * share)));
    beside(thousands(level.asked as u64), share)
}

fn triangles(equal: &EqualError) -> String {
    match equal.quadric {
        QuadricCount::About(n) => thousands(n as u64),
        QuadricCount::MoreThan(n) => format!("> {}", thousands(n as u64)),
        QuadricCount::AtMost(n) => format!("≤ {}", thousands(n as u64)),
    }
}

/// What table 2 of the paper says of its own six models, in the columns of table 3.
fn printed_row(presets: &[Preset]) -> Vec<String> {
    let printed: Vec<(f64, f64)> =
        paper::MODELS.iter().filter_map(|m| m.table2).map(|row| (row.visibility, row.less_error)).collect();
    let (visibility, gain): (Vec<f64>, Vec<f64>) = printed.iter().copied().unzip();
    let row = ["as printed in the paper", "seven"].map(str::to_owned);
    let means = [
        MeanImprovement::of(&printed, |_| true),
        MeanImprovement::of(&printed, |v| v < HALF),
        MeanImprovement::of(&printed, |v| v >= HALF),
    ];
    let printed = rank(spearman(&visibility, &gain));
    let ranks = presets.iter().map(|&preset| if preset == Preset::Paper { printed.clone() } else { dash() });
    row.into_iter().chain(means.map(mean)).chain(ranks).collect()
}

fn means(summary: &ImprovementSummary) -> [String; 5] {
    let vg = short(summary.visibility, Metric::Visibility);
    let levels = match summary.levels {
        Levels::All => "all",
        Levels::EqualCounts => "equal counts",
    };
    let [all, below, from] = [summary.all, summary.below_half, summary.from_half].map(mean);
    [format!("{vg}, {}", percent_of((summary.visibility, summary.quadric))), levels.to_owned(), all, below, from]
}

/// `35.1 (12)`
fn mean(mean: MeanImprovement) -> String {
    mean.less_error.map_or_else(dash, |gain| format!("{} ({})", percent(gain), mean.models))
}

fn rank(rank: Option<f64>) -> String {
    rank.map_or_else(dash, |rank| format!("{rank:.2}"))
}

/// Three digits that matter, but no part of a millisecond.
fn seconds(value: f64) -> String {
    if value < 1.0 { format!("{value:.3}") } else { significant(value) }
}

/// Three digits that matter.
fn significant(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let before = libm::floor(libm::log10(value.abs())) as i32;
    let behind = usize::try_from(2 - before).unwrap_or(0);
    format!("{value:.behind$}")
}

fn printed(model: &ModelReport) -> Option<paper::Table2Row> {
    model.stand.model().and_then(|paper| paper.table2)
}

fn dash() -> String {
    "–".to_owned()
}

fn percent(value: f64) -> String {
    // Adding 0 takes the sign off a zero.
    format!("{:.1}", (10.0 * value).round() / 10.0 + 0.0)
}

/// Which of the paper's models it is, or stands in for.
fn of_the_paper(model: &ModelReport) -> String {
    match model.stand {
        Stand::Original(paper) => paper.name.to_owned(),
        Stand::StandIn(paper) => format!("for {}", paper.name),
        Stand::None => dash(),
    }
}

/// Ours, and the paper's in brackets.
fn beside(ours: String, printed: Option<String>) -> String {
    printed.map_or(ours.clone(), |printed| format!("{ours} ({printed})"))
}

/// As the paper prints times: minutes and seconds.
fn minutes(seconds: u32) -> String {
    format!("{}:{:02}", seconds / 60, seconds % 60)
}
