//! The files of a finished study.

use std::io;
use std::path::Path;

use super::ZtRequest;
use super::figures::OUTLINE;
use super::plots::Plot;
use super::report::{ModelReport, ZtReport};
use super::store::remove;
use super::words;
use crate::error::{Error, Result};
use crate::io::write_atomic;
use crate::report::outline::outline_picture;
use crate::report::table::{Table, markdown};
use crate::visibility::outline::Outline;

/// Points along the outline of figure 1, and cameras around it: a pixel or more each.
const OUTLINE_SAMPLES: usize = 900;
const OUTLINE_CAMERAS: usize = 360;

impl ZtReport {
    /// Writes tables, plots, `json` and the page into the study's directory; what an earlier run wrote there is replaced.
    /// `commands` is what was typed, for the page to tell.
    ///
    /// # Errors
    /// [`crate::Error::Write`].
    pub fn write(&self, request: &ZtRequest, json: &str, commands: &[String]) -> Result<()> {
        let write = |name: &str, how: &dyn Fn(&mut dyn io::Write) -> io::Result<()>| {
            write_atomic(&request.output.join(Path::new(name)), true, |out| how(out))
        };
        write("zt.json", &|out| out.write_all(json.as_bytes()))?;
        write("models.csv", &|out| self.write_models_csv(out))?;
        write("levels.csv", &|out| self.write_levels_csv(out))?;
        if request.convergence {
            write("convergence.csv", &|out| self.write_convergence_csv(out))?;
        } else {
            remove(&request.output.join("convergence.csv"))?;
        }
        let outline = Outline::harbour();
        let picture = outline_picture(&outline, &outline.diagram(OUTLINE_SAMPLES, OUTLINE_CAMERAS));
        write(OUTLINE, &|out| picture.write_png(out))?;
        write("tables.md", &|out| out.write_all(self.to_markdown(request).as_bytes()))?;
        let plots = self.plots(&request.output)?;
        for plot in &plots {
            write(&plot.file, &|out| out.write_all(plot.svg.as_bytes()))?;
        }
        let html = self.page(request, &plots, commands)?.to_html()?;
        write("report.html", &|out| out.write_all(html.as_bytes()))?;
        request.page.iter().try_for_each(|page| write_atomic(page, true, |out| out.write_all(html.as_bytes())))
    }

    /// All tables as Markdown, with the words that belong to them.
    fn to_markdown(&self, request: &ZtRequest) -> String {
        let part =
            |heading: &str, text: &str, table: &Table| format!("## {heading}\n\n{text}\n\n{}\n", table.to_markdown());
        let of_model =
            |model: &ModelReport| part(&markdown(&model.findings.name), &model.remarks(), &model.level_table());
        let notes = self.notes(request).into_iter().map(|note| format!("- {}\n", markdown(&note)));
        [
            format!("# Visibility-guided simplification\n\n{}\n\n", words::SUBTITLE),
            part("Table 1: visibility", words::TABLE1, &self.table1()),
            part("Table 2: less image error", words::TABLE2, &self.table2()),
            part("Who gains", words::GAINS, &self.gains_table()),
            format!("# Errors by level\n\n{}\n\n", words::LEVELS),
            self.models.iter().map(of_model).collect(),
            format!("## Notes\n\n{}", notes.collect::<String>()),
        ]
        .concat()
    }

    fn plots(&self, directory: &Path) -> Result<Vec<Plot>> {
        let of_model =
            |model: &ModelReport| Ok([model.error_plots()?, model.convergence_plot()?.into_iter().collect()].concat());
        let all = || -> io::Result<Vec<Plot>> {
            let models: Vec<Vec<Plot>> = self.models.iter().map(of_model).collect::<io::Result<_>>()?;
            Ok(self.correlation_plot()?.into_iter().chain(models.into_iter().flatten()).collect())
        };
        all().map_err(|e| Error::Write { path: directory.to_owned(), message: e.to_string() })
    }
}
