//! What a comparison says, in numbers and in a sentence: the command prints the tables, the page shows all of it.

use crate::pipeline::{CompareReport, TestReport};
use crate::report::page::Table;
use crate::report::table::thousands;

/// A number of every test.
struct Column {
    head: &'static str,
    better: Better,
    value: fn(&TestReport) -> Option<f64>,
    show: fn(f64) -> String,
}

/// Which of several numbers is the best.
#[derive(Clone, Copy)]
enum Better {
    Least,
    Most,
    Neither,
}
use Better::{Least, Most, Neither};

const fn column(
    head: &'static str,
    better: Better,
    value: fn(&TestReport) -> Option<f64>,
    show: fn(f64) -> String,
) -> Column {
    Column { head, better, value, show }
}

const PICTURES: [Column; 7] = [
    column("triangles", Neither, |t| Some(t.triangles as f64), whole),
    column("head light", Least, |t| Some(t.image_rmse), |grey| format!("{grey:.3}")),
    column("fixed", Least, |t| Some(t.fixed_light.image_rmse), |grey| format!("{grey:.3}")),
    column("smooth", Least, |t| Some(t.smooth.image_rmse), |grey| format!("{grey:.3}")),
    column("SSIM", Most, |t| Some(t.ssim), fine),
    column("outline", Least, |t| Some(t.silhouette_xor), |pixels| format!("{pixels:.1}")),
    column("depth", Least, |t| t.depth, fine),
];

const DISTANCES: [Column; 8] = [
    column("mean", Least, |t| Some(t.geometric.mean), fine),
    column("RMS", Least, |t| Some(t.geometric.rms), fine),
    column("max", Least, |t| Some(t.geometric.max), fine),
    column("REF to test", Least, |t| Some(t.geometric.forward.rms), fine),
    column("test to REF", Least, |t| Some(t.geometric.backward.rms), fine),
    column("visible", Least, |t| t.geometric.visible.map(|d| d.rms), fine),
    column("hidden", Least, |t| t.geometric.hidden.map(|d| d.rms), fine),
    column("weighted", Least, |t| t.geometric.weighted_rms, fine),
];

const TRIANGLES: [Column; 5] = [
    column("flipped", Least, |t| Some(t.quality.flipped as f64), whole),
    column("of area", Least, |t| Some(100.0 * t.quality.flipped_area), |percent| format!("{percent:.3} %")),
    column("degenerate", Least, |t| Some(t.quality.degenerate as f64), whole),
    column("edges", Least, |t| Some(t.quality.non_manifold_edges as f64), whole),
    column("more", Least, |t| Some(t.quality.new_non_manifold_edges as f64), whole),
];

fn whole(number: f64) -> String {
    thousands(number as u64)
}

/// Four digits behind the point.
fn fine(number: f64) -> String {
    format!("{number:.4}")
}

impl CompareReport {
    /// How pictures differ, how far the surfaces are from each other, and which triangles went wrong: a row for each test,
    /// under these names. Where there are several, the best of each column is marked, unless all are alike.
    #[must_use]
    pub fn tables(&self, names: &[String]) -> [Table; 3] {
        [("pictures", &PICTURES[..]), ("distances", &DISTANCES), ("triangles", &TRIANGLES)]
            .map(|(head, columns)| table(head, columns, names, &self.tests))
    }

    /// Which test looks most like the reference, under these names; empty for a single one.
    #[must_use]
    pub fn verdict(&self, names: &[String]) -> String {
        let mut ranked: Vec<(&TestReport, &String)> = self.tests.iter().zip(names).collect();
        ranked.sort_by(|(a, _), (b, _)| a.image_rmse.total_cmp(&b.image_rmse));
        let [(best, name), (next, other), ..] = ranked[..] else { return String::new() };
        let error = format!("{:.2} grey levels", best.image_rmse);
        let less = 100.0 * (1.0 - best.image_rmse / next.image_rmse);
        // Equal errors of 0 have no quotient.
        if less.is_nan() || less < 0.5 {
            return format!("{name} and {other} have practically the same image error: {error}.");
        }
        let unfair = match (best.triangles, next.triangles) {
            (own, others) if own > others => {
                format!(", with {} triangles against {}", thousands(own as u64), thousands(others as u64))
            }
            _ => String::new(),
        };
        format!("{name} has the least image error: {error}, {less:.0} % less than {other}{unfair}.")
    }
}

fn table(head: &str, columns: &[Column], names: &[String], tests: &[TestReport]) -> Table {
    let show = |column: &Column, test: &TestReport| (column.value)(test).map_or("-".to_owned(), column.show);
    let row = |(test, name): (&TestReport, &String)| {
        std::iter::once(name.clone()).chain(columns.iter().map(|column| show(column, test))).collect()
    };
    let rows: Vec<Vec<String>> = tests.iter().zip(names).map(row).collect();
    let best = (1..).zip(columns).flat_map(|(place, column)| {
        let shown: Vec<&String> = rows.iter().map(|row| &row[place]).collect();
        best_of(column, tests, &shown).into_iter().map(move |row| [row, place])
    });
    let best = best.collect();
    let heads = std::iter::once(head).chain(columns.iter().map(|column| column.head)).map(str::to_owned).collect();
    Table { heads, rows, best }
}

/// Rows that show the best number of a column; none where all show the same.
fn best_of(column: &Column, tests: &[TestReport], shown: &[&String]) -> Vec<usize> {
    let numbers = tests.iter().enumerate().filter_map(|(row, test)| Some((row, (column.value)(test)?)));
    let best = match column.better {
        Least => numbers.min_by(|(_, a), (_, b)| a.total_cmp(b)),
        Most => numbers.max_by(|(_, a), (_, b)| a.total_cmp(b)),
        Neither => None,
    };
    let Some((best, _)) = best else { return Vec::new() };
    let rows: Vec<usize> = (0..shown.len()).filter(|&row| shown[row] == shown[best]).collect();
    if rows.len() < shown.len() { rows } else { Vec::new() }
}
