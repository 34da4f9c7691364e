//! The findings as comma-separated values, for programs.

use std::io;

use serde::Serialize;

use super::gain::Levels;
use super::report::{ModelReport, ZtReport};
use crate::pipeline::{Metric, Preset};

impl ZtReport {
    /// The findings of every level as comma-separated values (RFC 4180), one row per model, simplifier and level.
    ///
    /// # Errors
    /// As `output`.
    pub fn write_levels_csv(&self, output: &mut dyn io::Write) -> io::Result<()> {
        write_csv(self.models.iter().flat_map(LevelRow::of), output)
    }

    /// What tables 1 and 2 say, as comma-separated values, one row per model and preset.
    ///
    /// # Errors
    /// As `output`.
    pub fn write_models_csv(&self, output: &mut dyn io::Write) -> io::Result<()> {
        let rows = self.models.iter().flat_map(|model| Preset::ALL.map(|preset| ModelRow::of(model, preset)));
        write_csv(rows.flatten(), output)
    }

    /// Figure 3 as comma-separated values, one row per model, number of cameras and weights.
    ///
    /// # Errors
    /// As `output`.
    pub fn write_convergence_csv(&self, output: &mut dyn io::Write) -> io::Result<()> {
        write_csv(self.models.iter().flat_map(ConvergenceRow::of), output)
    }
}

fn write_csv<T: Serialize>(rows: impl Iterator<Item = T>, output: &mut dyn io::Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(output);
    for row in rows {
        writer.serialize(row).map_err(io::Error::other)?;
    }
    writer.flush()
}

#[derive(Serialize)]
struct ModelRow<'a> {
    model: &'a str,
    triangles: usize,
    stands_for: Option<&'a str>,
    preset: &'a str,
    visibility: f64,
    never_seen: usize,
    measure_seconds: f64,
    qb_seconds: Option<f64>,
    vg_seconds: Option<f64>,
    hidden_deleted: Option<usize>,
    hidden_seconds: Option<f64>,
    less_error_percent: Option<f64>,
    less_error_at_equal_counts_percent: Option<f64>,
    less_error_than_qb_of_same_preset_percent: Option<f64>,
    less_error_than_qb_of_same_preset_at_equal_counts_percent: Option<f64>,
    paper_triangles: Option<usize>,
    paper_visibility: Option<f64>,
    paper_measure_seconds: Option<u32>,
    paper_simplify_seconds: Option<u32>,
    paper_less_error_percent: Option<f64>,
}

impl<'a> ModelRow<'a> {
    fn of(model: &'a ModelReport, preset: Preset) -> Option<Self> {
        let look = model.look(preset)?;
        let printed = model.stand.model();
        let run = |metric| model.run(preset, metric);
        Some(Self {
            model: &model.findings.name,
            triangles: model.findings.triangles,
            stands_for: printed.map(|p| p.name),
            preset: preset.name(),
            visibility: look.visibility,
            never_seen: look.never_seen,
            measure_seconds: look.seconds,
            qb_seconds: run(Metric::Quadric).map(|run| run.seconds),
            vg_seconds: run(Metric::Visibility).map(|run| run.seconds),
            hidden_deleted: run(Metric::Visibility).map(|run| run.hidden_deleted),
            hidden_seconds: run(Metric::Visibility).and_then(|run| run.hidden_seconds),
            less_error_percent: model.less_error((preset, Preset::Paper), Levels::All),
            less_error_at_equal_counts_percent: model.less_error((preset, Preset::Paper), Levels::EqualCounts),
            less_error_than_qb_of_same_preset_percent: model.less_error((preset, preset), Levels::All),
            less_error_than_qb_of_same_preset_at_equal_counts_percent: model
                .less_error((preset, preset), Levels::EqualCounts),
            paper_triangles: printed.map(|p| p.triangles),
            paper_visibility: printed.and_then(|p| p.visibility()),
            paper_measure_seconds: printed.and_then(|p| p.measure_seconds()),
            paper_simplify_seconds: printed.and_then(|p| p.table2).map(|row| row.simplify_seconds),
            paper_less_error_percent: printed.and_then(|p| p.table2).map(|row| row.less_error),
        })
    }
}

#[derive(Serialize)]
struct LevelRow<'a> {
    model: &'a str,
    preset: &'a str,
    metric: &'a str,
    share: Option<f64>,
    asked: usize,
    triangles: usize,
    image_rms: f64,
    image_rmse: f64,
    fixed_light_rmse: f64,
    smooth_rmse: f64,
    ssim: f64,
    silhouette_xor: f64,
    depth_rms_percent: Option<f64>,
    geometric_mean_percent: f64,
    geometric_rms_percent: f64,
    geometric_max_percent: f64,
    visible_rms_percent: Option<f64>,
    hidden_rms_percent: Option<f64>,
    weighted_rms_percent: Option<f64>,
    flipped: usize,
    degenerate: usize,
    new_non_manifold_edges: usize,
}

impl<'a> LevelRow<'a> {
    fn of(model: &'a ModelReport) -> impl Iterator<Item = Self> {
        let levels = model.findings.runs.iter().flat_map(|run| run.levels.iter().map(move |level| (run, level)));
        levels.map(|(run, level)| Self {
            model: &model.findings.name,
            preset: run.preset.name(),
            metric: run.metric.name(),
            share: level.share,
            asked: level.asked,
            triangles: level.triangles,
            image_rms: level.errors.image_rms,
            image_rmse: level.errors.image_rmse,
            fixed_light_rmse: level.errors.fixed_light.image_rmse,
            smooth_rmse: level.errors.smooth.image_rmse,
            ssim: level.errors.ssim,
            silhouette_xor: level.errors.silhouette_xor,
            depth_rms_percent: level.errors.depth_rms,
            geometric_mean_percent: level.errors.geometric_mean,
            geometric_rms_percent: level.errors.geometric_rms,
            geometric_max_percent: level.errors.geometric_max,
            visible_rms_percent: level.errors.visible_rms,
            hidden_rms_percent: level.errors.hidden_rms,
            weighted_rms_percent: level.errors.weighted_rms,
            flipped: level.errors.quality.flipped,
            degenerate: level.errors.quality.degenerate,
            new_non_manifold_edges: level.errors.quality.new_non_manifold_edges,
        })
    }
}

#[derive(Serialize)]
struct ConvergenceRow<'a> {
    model: &'a str,
    resolution: u32,
    cameras: usize,
    weights: &'a str,
    against_4098: Option<f64>,
    against_spiral: f64,
}

impl<'a> ConvergenceRow<'a> {
    fn of(model: &'a ModelReport) -> impl Iterator<Item = Self> {
        let of_all = model.findings.convergence.iter();
        of_all.flat_map(|all| all.errors.iter().map(move |e| (all.resolution, e))).map(|(resolution, e)| Self {
            model: &model.findings.name,
            resolution,
            cameras: e.cameras,
            weights: e.weights.name(),
            against_4098: e.against_4098,
            against_spiral: e.against_reference,
        })
    }
}
