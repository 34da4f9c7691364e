//! The study as one page.

use super::ZtRequest;
use super::cell::{LookFinding, SheetFinding};
use super::figures::{self, Room};
use super::gain::Levels;
use super::plots::{Plot, Shows};
use super::report::{ModelReport, ZtReport};
use super::summary::ImprovementSummary;
use super::words::{self, short};
use crate::error::Result;
use crate::pipeline::Metric;
use crate::pipeline::compare::views_around;
use crate::pipeline::page::{MAP, how_made, legend, section};
use crate::report::colour::ColourMap;
use crate::report::page::{Content, Fact, Figure, Figures, Page, Section, Table, Viewer};
use crate::report::paper::PaperModel;
use crate::report::table;

const OUTLINE: &str = "Cameras stand all around an outline. Columns of the diagram are points along the boundary, rows are \
    cameras; green where the camera sees the point.";
const CONVERGENCE: &str = "Mean error of V by the number of cameras, counted alike (equal) or by the solid angle that each owns \
    (area); the thin line falls with the number to the power of −0.75, as the latter do on closed forms. The paper prints no \
    numbers here; it chose 258 cameras.";
const VIEWER: &str =
    "Blue to yellow, colours that every eye tells apart; the paper's are those of the heat maps above.";
const DIFFERENCES: &str = "Differences are white where the pictures are equal, full red from 64 grey levels of 255. From more \
    sides:";

impl ZtReport {
    /// The page; pictures that it shows are read from the study's directory. `commands` is what was typed to make it.
    pub(super) fn page(&self, request: &ZtRequest, plots: &[Plot], commands: &[String]) -> Result<Page> {
        let room = Room::of(self, request, plots)?;
        let mut sections = vec![section("Summary", &self.summary_in_words(), Content::Summary(self.facts()))];
        let of_all = plots.iter().filter(|plot| plot.of.is_none());
        let correlation: Vec<Figure> = of_all.flat_map(|plot| plot.figures.clone()).collect();
        if !correlation.is_empty() {
            sections.push(figures("Improvement by visibility", "", 1, correlation));
        }
        sections.extend([
            section("Table 1: visibility", words::TABLE1, Content::Table(cells(&self.table1()))),
            section("Table 2: less image error", words::TABLE2, Content::Table(cells(&self.table2()))),
            section("Who gains", words::GAINS, Content::Table(cells(&self.gains_table()))),
        ]);
        let outline = room.figure(figures::OUTLINE, "visibility diagram of an outline".to_owned())?;
        sections.push(figures("Figure 1: a visibility diagram", OUTLINE, 1, vec![outline]));
        for model in &self.models {
            sections.extend(model.sections(plots, &room)?);
        }
        sections.push(section("How to read this", "", Content::Notes(self.notes(request))));
        sections.extend(how_made(commands));
        Ok(Page {
            title: "Visibility-guided simplification".to_owned(),
            subtitle: words::SUBTITLE.to_owned(),
            sections,
        })
    }

    fn facts(&self) -> Vec<Fact> {
        let models = self.models.len().to_string();
        let mut facts = vec![Fact { name: "Models".to_owned(), value: models, note: String::new() }];
        facts.extend(self.summary.iter().filter(|summary| summary.levels == Levels::All).filter_map(fact));
        facts
    }
}

impl ModelReport {
    fn sections(&self, plots: &[Plot], room: &Room) -> Result<Vec<Section>> {
        let name = &self.findings.name;
        let heat_map = |look: &LookFinding| room.figure(&look.bare_heat_map, self.heat_map_caption(look));
        let heat_maps = self.findings.looks.iter().map(heat_map).collect::<Result<_>>()?;
        let heat_maps = Figures { columns: 2, figures: heat_maps, legend: Some(legend(ColourMap::Paper)) };
        let mut sections = vec![section(name, &self.remarks(), Content::Figures(heat_maps))];
        if let Some(look) = self.findings.looks.first() {
            let diagram = room.figure(&look.diagram, diagram_caption(look))?;
            sections.push(figures(&format!("{name}: visibility diagram"), "", 1, vec![diagram]));
        }
        let levels = Content::Table(cells(&self.level_table()));
        sections.push(section(&format!("{name}: errors by level"), words::LEVELS, levels));
        sections.extend(self.plotted(plots, Shows::Errors, "errors (Fig. 4)", ""));
        sections.extend(self.plotted(plots, Shows::Convergence, "convergence (Fig. 3)", CONVERGENCE));
        for pictures in &self.findings.pictures {
            for sheet in &pictures.sheets {
                let preset = pictures.preset.name();
                let heading = format!("{name}, side by side, preset {preset}{}", self.figure_of(sheet));
                let shown = sheet.shown.iter().map(|shown| room.figure(&shown.file, shown.caption.clone()));
                let shown = shown.collect::<Result<Vec<_>>>()?;
                sections.push(figures(&heading, &format!("{DIFFERENCES} {}.", sheet.file), shown.len(), shown));
            }
        }
        sections.extend(self.viewer());
        sections.iter_mut().skip(1).for_each(|part| part.within = true);
        Ok(sections)
    }

    /// With what the paper prints.
    fn heat_map_caption(&self, look: &LookFinding) -> String {
        let printed = self.stand.model().and_then(PaperModel::visibility);
        let printed = printed.map(|v| format!("; the paper prints {v:.3}")).unwrap_or_default();
        format!("Visibility (Fig. 2), preset {}: V(M) = {:.3}{printed}", look.preset.name(), look.visibility)
    }

    /// ` (Fig. 5)`: which of the paper's figures shows its model at this count.
    fn figure_of(&self, sheet: &SheetFinding) -> String {
        let pictures = self.stand.model().map_or(&[][..], |paper| paper.pictures);
        let shown = pictures.iter().find(|picture| picture.triangles == sheet.triangles);
        shown.map_or_else(String::new, |picture| format!(" (Fig. {})", picture.figure))
    }

    fn viewer(&self) -> Option<Section> {
        let models = self.findings.viewer.as_ref().map(|viewer| viewer.models.clone()).filter(|m| !m.is_empty())?;
        let [toward, ..] = views_around(glam::DVec3::from_array(self.findings.up)).map(|d| d.to_array());
        let viewer = Viewer { models, legend: Some(legend(MAP)), toward, up: self.findings.up };
        Some(section(&format!("{}, in three dimensions", self.findings.name), VIEWER, Content::Viewer(viewer)))
    }

    /// The model's plots of one kind, side by side.
    fn plotted(&self, plots: &[Plot], shows: Shows, what: &str, text: &str) -> Option<Section> {
        let own = plots.iter().filter(|plot| plot.of.as_ref() == Some(&(self.findings.name.clone(), shows)));
        let shown: Vec<Figure> = own.flat_map(|plot| plot.figures.clone()).collect();
        (!shown.is_empty()).then(|| figures(&format!("{}: {what}", self.findings.name), text, 2, shown))
    }
}

/// The improvement of one pair of simplifiers; `None` where no model has it.
fn fact(summary: &ImprovementSummary) -> Option<Fact> {
    let apart = [("below", summary.below_half), ("from", summary.from_half)].into_iter().filter_map(|(side, mean)| {
        let gain = mean.less_error?;
        Some(format!("{gain:.1} % for V(M) {side} 0.5 ({} models)", mean.models))
    });
    let rank = summary.rank_correlation(summary.visibility).map(|rank| format!("rank correlation with V(M) {rank:.2}"));
    let quadric = short(summary.quadric, Metric::Quadric);
    let note: Vec<String> = apart.chain(rank).collect();
    Some(Fact {
        name: format!("{} against {quadric}", short(summary.visibility, Metric::Visibility)),
        value: format!("{:.1} %", summary.all.less_error?),
        note: format!("less image error: {}", note.join("; ")),
    })
}

fn diagram_caption(look: &LookFinding) -> String {
    format!(
        "Visibility diagram of the mesh (Fig. 1), preset {}: columns are triangles in the order of the file, rows are {} cameras; \
         green where the camera sees the triangle, the brighter the more squarely",
        look.preset.name(),
        look.cameras
    )
}

fn figures(heading: &str, text: &str, columns: usize, figures: Vec<Figure>) -> Section {
    section(heading, text, Content::Figures(Figures { columns, figures, legend: None }))
}

fn cells(table: &table::Table) -> Table {
    Table { heads: table.heads(), rows: table.rows().to_vec(), ..Table::default() }
}
