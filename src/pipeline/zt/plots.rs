//! Figures 3 and 4 and the correlation of V(M) with the improvement, as plots.

use std::io;

use super::cell::{LevelErrors, LevelFinding, RunFinding};
use super::gain::Levels;
use super::report::{ModelReport, ZtReport};
use super::words::short;
use crate::pipeline::{ConvergenceReport, IndependentReference, MeshConvergence, Metric, Preset};
use crate::report::page::{Figure, Image};
use crate::report::plot::{LogLogPlot, MethodCurves, NamedPoint, ScatterGroup, ScatterPlot, TwoAxisPlot};

/// A plot, as a file and on the page.
#[derive(Clone)]
pub(super) struct Plot {
    pub file: String,
    pub svg: String,
    /// What it shows of which model; `None` for one of all models.
    pub of: Option<(String, Shows)>,
    /// The same, a panel each.
    pub figures: Vec<Figure>,
}

/// What a plot of a model shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shows {
    /// Figure 4.
    Errors,
    /// Figure 3.
    Convergence,
}

impl Plot {
    fn of_one_panel(file: String, svg: String, of: Option<(String, Shows)>, caption: String) -> Self {
        let figures = vec![Figure { image: Image::Svg(svg.clone()), caption }];
        Self { file, svg, of, figures }
    }
}

impl ZtReport {
    /// How V(M) goes with the improvement over QB of the same preset, a group of points per preset; `None` where fewer than two
    /// models have both.
    pub(super) fn correlation_plot(&self) -> io::Result<Option<Plot>> {
        let group = |preset: Preset| {
            let point = |model: &ModelReport| {
                let (x, y) = (model.visibility(preset)?, model.less_error((preset, preset), Levels::All)?);
                Some(NamedPoint { name: model.findings.name.clone(), x, y })
            };
            let [vg, qb] = [Metric::Visibility, Metric::Quadric].map(|metric| short(preset, metric));
            ScatterGroup { name: format!("{vg} against {qb}"), points: self.models.iter().filter_map(point).collect() }
        };
        let groups: Vec<ScatterGroup> = self.presets().into_iter().map(group).collect();
        if groups.iter().all(|group| group.points.len() < 2) {
            return Ok(None);
        }
        let plot = ScatterPlot {
            title: "Image error of VG below that of QB with the same options".to_owned(),
            x: "visibility of the model, V(M), as these options count it".to_owned(),
            y: "less image error, mean over the levels (%)".to_owned(),
            groups,
        };
        let caption = "Less image error than QB with the same options, by the visibility of the model".to_owned();
        Ok(Some(Plot::of_one_panel("correlation.svg".to_owned(), plot.to_svg()?, None, caption)))
    }
}

impl ModelReport {
    /// Figure 4: both errors of QB and VG by the number of triangles, a plot per preset.
    pub(super) fn error_plots(&self) -> io::Result<Vec<Plot>> {
        let presets = self.findings.looks.iter().map(|look| look.preset);
        presets.map(|preset| self.error_plot(preset)).collect()
    }

    fn error_plot(&self, preset: Preset) -> io::Result<Plot> {
        let name = &self.findings.name;
        let runs = [("QB", Metric::Quadric), ("VG", Metric::Visibility)];
        let method = |(name, metric): (&str, Metric)| Some(curves(name, self.run(preset, metric)?));
        let plot = TwoAxisPlot {
            title: format!("{name}, preset {}", preset.name()),
            left: "image error, RMSE (grey levels)".to_owned(),
            right: "geometric error, RMS (% of the diagonal)".to_owned(),
            methods: runs.into_iter().filter_map(method).collect(),
        };
        let caption = format!("Image and geometric error of QB and VG, preset {} (Fig. 4)", preset.name());
        let file = format!("{name}-errors-{}.svg", preset.name());
        Ok(Plot::of_one_panel(file, plot.to_svg()?, Some((name.clone(), Shows::Errors)), caption))
    }

    /// Figure 3: how exact V is by the number of cameras.
    pub(super) fn convergence_plot(&self) -> io::Result<Option<Plot>> {
        let Some(convergence) = &self.findings.convergence else { return Ok(None) };
        let name = &self.findings.name;
        let named = MeshConvergence { file: name.into(), ..convergence.clone() };
        let of_one = ConvergenceReport::of(IndependentReference::Fibonacci, vec![named]);
        let plot: LogLogPlot = of_one.plot();
        let file = format!("{name}-convergence.svg");
        let figures = of_one.figures().map_err(io::Error::other)?;
        Ok(Some(Plot { file, svg: plot.to_svg()?, of: Some((name.clone(), Shows::Convergence)), figures }))
    }
}

fn curves(name: &str, run: &RunFinding) -> MethodCurves {
    let points = |error: fn(&LevelErrors) -> f64| -> Vec<(usize, f64)> {
        run.shared_levels().map(|level: &LevelFinding| (level.triangles, error(&level.errors))).collect()
    };
    MethodCurves { name: name.to_owned(), left: points(|e| e.image_rmse), right: points(|e| e.geometric_rms) }
}
