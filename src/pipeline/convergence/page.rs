//! The study of convergence as a page.

use crate::camera::{CameraWeights, Cameras};
use crate::error::{Error, Result};
use crate::pipeline::page::{how_made, section};
use crate::pipeline::{ConvergenceError, ConvergenceReport, MeshConvergence, shown_names};
use crate::report::page::{self, Content, Fact, Figure, Figures, Image, Page, Section};
use crate::report::plot::LogLogPlot;
use crate::report::table::{Table, thousands};

const SUBTITLE: &str = "How far visibility from few cameras is from what it should be: the mean over the surface of the error of V, \
    which goes from 0 to 1.";
const PLOTS: &str = "Cameras count alike (equal), or by the solid angle that they own (area). Against the same pattern both seem to \
    converge; only the independent reference shows the error that equal weights keep.";

/// Meshes that the summary names.
const SUMMED_UP: usize = 4;

impl ConvergenceReport {
    /// The study as one page: what the default cameras reach, the errors as plots and as a table for each mesh.
    ///
    /// `commands` is what was typed to make it.
    ///
    /// # Errors
    /// [`Error::Limit`] for a plot that cannot be drawn.
    pub fn page(&self, commands: &[String]) -> Result<Page> {
        let names = self.names();
        let facts = self.meshes.iter().zip(&names).take(SUMMED_UP).filter_map(|(mesh, name)| mesh.fact(name)).collect();
        let summary = format!(
            "Mean error of V with {} cameras, the default, each counted by its solid angle:",
            Cameras::DEFAULT_COUNT
        );
        let mut sections = vec![section("Summary", &summary, Content::Summary(facts)), self.plots()?];
        sections.extend(self.meshes.iter().zip(&names).map(|(mesh, name)| mesh.section(name)));
        sections.push(section("How to read this", "", Content::Notes(self.notes())));
        sections.extend(how_made(commands));
        let title = format!("{}, convergence of visibility", names.join(", "));
        Ok(Page { title, subtitle: SUBTITLE.to_owned(), sections })
    }

    /// What the meshes are called: their files' names, with folders where names repeat.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        shown_names(&self.meshes.iter().map(|mesh| mesh.file.as_path()).collect::<Vec<_>>())
    }

    fn plots(&self) -> Result<Section> {
        let figures = Figures { columns: 2, figures: self.figures()?, legend: None };
        Ok(section("Error by the number of cameras", PLOTS, Content::Figures(figures)))
    }

    /// A plot for each panel, so that phones put one below the other.
    pub(in crate::pipeline) fn figures(&self) -> Result<Vec<Figure>> {
        let LogLogPlot { panels, x, y, slope } = self.plot();
        let figure = |panel| {
            let plot = LogLogPlot { panels: vec![panel], x: x.clone(), y: y.clone(), slope };
            let caption = format!("Error {}", plot.panels[0].title);
            let svg = plot.to_svg().map_err(|e| Error::Limit { message: format!("a plot for the page: {e}") })?;
            Ok(Figure { image: Image::Svg(svg), caption })
        };
        panels.into_iter().map(figure).collect()
    }

    fn notes(&self) -> Vec<String> {
        vec![
            "Same pattern: against 4098 octahedral cameras of the same weights.".to_owned(),
            format!("Independent: against {}.", self.reference_in_words()),
            "Visibility of fronts of triangles only (Zhang & Turk 2002, eq. 3.2; figure 3 is the first plot)."
                .to_owned(),
        ]
    }
}

impl MeshConvergence {
    /// The errors: a row for each number of cameras.
    #[must_use]
    pub fn table(&self) -> Table {
        let cell = |error: Option<f64>| error.map_or("-".to_owned(), |e| format!("{e:.5}"));
        let row = |pair: &[ConvergenceError]| {
            let same = pair.iter().map(|e| cell(e.against_4098));
            let independent = pair.iter().map(|e| cell(Some(e.against_reference)));
            std::iter::once(pair[0].cameras.to_string()).chain(same).chain(independent).collect::<Vec<_>>()
        };
        let heads = ["cameras", "same pattern, equal", "same pattern, area", "independent, equal", "independent, area"];
        // Errors come in pairs of the same cameras: equal weights, then area weights.
        self.errors.chunks_exact(2).map(row).fold(Table::new(heads), Table::row)
    }

    fn section(&self, name: &str) -> Section {
        let known =
            self.reference_error.map_or(String::new(), |e| format!("; standard error of the reference: {e:.5}"));
        let pixels = self.resolution;
        let text =
            format!("{} triangles, pictures of {pixels} × {pixels} pixels{known}.", thousands(self.triangles as u64));
        let table = self.table();
        let table = page::Table { heads: table.heads(), rows: table.rows().to_vec(), ..page::Table::default() };
        section(name, &text, Content::Table(table))
    }

    /// What the default cameras reach.
    fn fact(&self, name: &str) -> Option<Fact> {
        let error = |weights| {
            let found = |e: &&ConvergenceError| e.cameras == Cameras::DEFAULT_COUNT && e.weights == weights;
            self.errors.iter().find(found).map(|e| e.against_reference)
        };
        let [area, equal] = [error(CameraWeights::Area)?, error(CameraWeights::Equal)?];
        Some(Fact { name: name.to_owned(), value: format!("{area:.4}"), note: format!("counted alike: {equal:.4}") })
    }
}
