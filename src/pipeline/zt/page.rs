//! The study as one page.

use std::fs;
use std::path::Path;

use super::ZtRequest;
use super::plots::Plot;
use super::report::{ModelReport, PAIRS, ZtReport};
use crate::error::{Error, Result};
use crate::pipeline::compare::views_around;
use crate::pipeline::page::{legend, section};
use crate::report::page::{Content, FIGURES_BYTES, Fact, Figure, Figures, Image, Page, Section, Table, Viewer};
use crate::report::paper;
use crate::report::picture::Picture;
use crate::report::table;

const SUBTITLE: &str = "The tables and figures of E. Zhang and G. Turk, Visibility-Guided Simplification, IEEE Visualization \
    2002, made again. Numbers in brackets are the paper's own.";
const TABLE1: &str = "V(M) is the share of directions from which the surface is seen from outside, each counted by its cosine \
    (eq. 3.2). Options: the paper's, then the best.";
const TABLE2: &str = "QB collapses by quadric error alone, VG also by visibility: seconds first, without looking. The last columns tell \
    by how much the image error of VG is below that of QB with the paper's options, mean over the levels; below zero VG is \
    worse.";
const OUTLINE: &str = "Cameras stand all around an outline. Columns of the diagram are points along the boundary, rows are \
    cameras; green where the camera sees the point.";

impl ZtReport {
    /// The page; pictures that it shows are read from the study's directory.
    pub(super) fn page(&self, request: &ZtRequest, plots: &[Plot]) -> Result<Page> {
        let share = FIGURES_BYTES / (2 * self.models.len() + 1);
        let mut sections = vec![
            section("Summary", "", Content::Summary(self.facts())),
            section("Table 1: visibility", TABLE1, Content::Table(cells(&self.table1()))),
            section("Table 2: less image error", TABLE2, Content::Table(cells(&self.table2()))),
        ];
        let correlation: Vec<Figure> = plots.iter().filter(|plot| plot.model.is_none()).map(Plot::figure).collect();
        if !correlation.is_empty() {
            sections.push(figures("Who gains", "", 1, correlation));
        }
        let outline = picture(&request.output.join("outline.png"), share, "visibility diagram of an outline")?;
        sections.push(figures("Figure 1: a visibility diagram", OUTLINE, 1, vec![outline]));
        for model in &self.models {
            sections.extend(model.sections(request, plots, share)?);
        }
        sections.push(section("How to read this", "", Content::Notes(self.notes(request))));
        Ok(Page { title: "Visibility-guided simplification".to_owned(), subtitle: SUBTITLE.to_owned(), sections })
    }

    fn facts(&self) -> Vec<Fact> {
        let fact = |name: &str, value: String, note: String| Fact { name: name.to_owned(), value, note };
        let mut facts = vec![fact("Models", self.models.len().to_string(), String::new())];
        for (visibility, quadric) in PAIRS {
            let gains: Vec<f64> = self.models.iter().filter_map(|m| m.less_error(visibility, quadric)).collect();
            if !gains.is_empty() {
                let mean = gains.iter().sum::<f64>() / gains.len() as f64;
                let note = format!("less image error than QB {}, mean over the models", quadric.name());
                facts.push(fact(&format!("VG {}", visibility.name()), format!("{mean:.1} %"), note));
            }
        }
        for correlation in &self.correlations {
            if let Some(rank) = correlation.rank_correlation {
                let note = "of V(M) and less error; -1: the less visible, the more is gained".to_owned();
                facts.push(fact(
                    &format!("Rank correlation, {}", correlation.preset.name()),
                    format!("{rank:.2}"),
                    note,
                ));
            }
        }
        facts
    }

    fn notes(&self, request: &ZtRequest) -> Vec<String> {
        let levels: Vec<String> = request.levels.iter().map(|share| format!("{:.3} %", 100.0 * share)).collect();
        let mut notes = vec![
            format!("Levels: {} of the triangles.", levels.join(", ")),
            format!(
                "Image error: 20 views of 512 × 512 pixels from the corners of a dodecahedron, head light. Geometric error: \
                 {} samples on each mesh.",
                table::thousands(request.samples)
            ),
            "Times are wall time of this machine; the paper's, in minutes, are of an SGI Octane with 195 MHz."
                .to_owned(),
        ];
        notes.extend(paper::NOTES.iter().map(|note| format!("In the paper, {note}.")));
        notes
    }
}

impl ModelReport {
    fn sections(&self, request: &ZtRequest, plots: &[Plot], share: usize) -> Result<Vec<Section>> {
        let name = &self.findings.name;
        let file = |file: &str| request.output.join(file);
        let mut shown = Vec::new();
        if let Some(look) = self.findings.looks.last() {
            let caption = format!("visibility (Fig. 2), preset {}", look.preset.name());
            shown.push(picture(&file(&look.heat_map), share / 2, &caption)?);
        }
        shown.extend(plots.iter().filter(|plot| plot.model.as_ref() == Some(name)).map(Plot::figure));
        let mut sections = vec![figures(name, &self.sentences(), 2, shown)];
        if let Some(pictures) = self.findings.pictures.last() {
            for sheet in &pictures.sheets {
                let caption = format!(
                    "{} triangles, preset {}: difference of QB, QB, original, VG, difference of VG",
                    table::thousands(sheet.triangles as u64),
                    pictures.preset.name()
                );
                sections.push(figures(
                    &format!("{name}, side by side"),
                    "",
                    1,
                    vec![picture(&file(&sheet.file), share, &caption)?],
                ));
            }
        }
        let models = self.findings.viewer.iter().flat_map(|viewer| viewer.models.clone()).collect::<Vec<_>>();
        if !models.is_empty() {
            let up = glam::DVec3::from_array(request.up);
            let [toward, ..] = views_around(up).map(|d| d.to_array());
            let viewer = Viewer { models, legend: Some(legend()), toward, up: request.up };
            sections.push(section(&format!("{name}, in three dimensions"), "", Content::Viewer(viewer)));
        }
        Ok(sections)
    }

    /// What the paper's numbers beside this model's are worth.
    fn sentences(&self) -> String {
        let notes = self.stand.model().map_or(&[][..], |paper| paper.notes);
        let notes: String = notes.iter().map(|note| format!(" In the paper, {note}.")).collect();
        let mut words = self.stand_in_words.clone();
        words.get_mut(..1).map(str::make_ascii_uppercase);
        format!("{words}.{notes}")
    }
}

impl Plot {
    fn figure(&self) -> Figure {
        Figure { image: Image::Svg(self.svg.clone()), caption: self.caption.clone() }
    }
}

fn figures(heading: &str, text: &str, columns: usize, figures: Vec<Figure>) -> Section {
    section(heading, text, Content::Figures(Figures { columns, figures }))
}

/// A picture of the study, smaller by halves until it takes no more than `share` bytes.
fn picture(path: &Path, share: usize, caption: &str) -> Result<Figure> {
    let bytes = fs::read(path).map_err(|source| Error::Read { path: path.to_owned(), source })?;
    let mut image = Image::Png(bytes);
    while image.embedded_bytes() > share {
        let Image::Png(bytes) = &image else { break };
        let mut smaller = Vec::new();
        Picture::from_png(bytes)?
            .halved()
            .write_png(&mut smaller)
            .map_err(|source| Error::Read { path: path.to_owned(), source })?;
        image = Image::Png(smaller);
    }
    Ok(Figure { image, caption: caption.to_owned() })
}

fn cells(table: &table::Table) -> Table {
    Table { heads: table.heads(), rows: table.rows().to_vec() }
}
