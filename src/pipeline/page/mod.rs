//! The page that `--report` asks for: the same for every command, an original and what was made of it, if anything.

mod figures;
mod names;
mod shown;

use std::path::PathBuf;

use glam::DVec3;

use crate::error::{Error, Result};
use crate::eval::ImageError;
use crate::io;
use crate::mesh::TriMesh;
use crate::pipeline::compare::views_around;
use crate::pipeline::observation::Surrounded;
use crate::progress::Progress;
use crate::report::colour::ColourMap;
use crate::report::page::{Content, Fact, Legend, MODELS_BYTES, Page, Section, Table, Viewer};
use crate::report::table::thousands;
use crate::visibility::{MeasureOptions, Subject, Visibility};
use figures::{histograms, pictures};
pub(super) use names::shown_name;
pub use names::shown_names;
pub(super) use shown::models;

/// Colours of every page: brightness grows with visibility, for every eye and on grey paper.
pub(super) const MAP: ColourMap = ColourMap::Cividis;

/// A page to write beside a result.
#[derive(Debug, Clone, PartialEq)]
pub struct PageRequest {
    /// The HTML file.
    pub output: PathBuf,
    /// Upward in its pictures and views, any length but 0.
    pub up: [f64; 3],
    /// What was typed to make it, one a line, as the page tells; empty tells nothing.
    pub commands: Vec<String>,
    /// What results are called on it, in their order; their files' names where it is empty.
    pub names: Vec<String>,
}

impl PageRequest {
    /// What results are called: as asked, or else by these names of their files.
    pub(super) fn named(&self, files: Vec<String>) -> Vec<String> {
        let asked = self.names.iter().cloned().map(Some).chain(std::iter::repeat(None));
        files.into_iter().zip(asked).map(|(file, name)| name.unwrap_or(file)).collect()
    }
}

/// A mesh that a page shows, coloured by its own visibility.
pub(super) struct Exhibit<'a> {
    pub name: String,
    pub mesh: &'a TriMesh,
    pub visibility: Visibility,
}

impl<'a> Exhibit<'a> {
    /// Looks at a mesh among occluders.
    pub fn look(
        name: String,
        scene: Surrounded<'a>,
        options: &MeasureOptions,
        progress: &dyn Progress,
    ) -> Result<Self> {
        let visibility = Subject::among(scene.mesh, scene.occluders, options.backend)?.measure(options, progress)?;
        Ok(Self { name, mesh: scene.mesh, visibility })
    }

    /// Triangles that no camera sees, in %.
    fn never_seen_percent(&self) -> f64 {
        100.0 * self.visibility.never_seen() as f64 / self.mesh.triangle_count() as f64
    }

    /// Triangles, in % of the original's.
    fn kept_percent(&self, original: &Self) -> f64 {
        100.0 * self.mesh.triangle_count() as f64 / original.mesh.triangle_count() as f64
    }
}

/// A column of the table of meshes that only one command has.
pub(super) struct Column {
    pub head: &'static str,
    /// One cell for each result.
    pub cells: Vec<String>,
}

/// What a page shows.
pub(super) struct Show<'a> {
    /// What was done: `simplified`.
    pub deed: &'static str,
    pub original: Exhibit<'a>,
    pub results: Vec<Exhibit<'a>>,
    /// One for each result.
    pub errors: Vec<ImageError>,
    /// What came of it in a sentence, above everything; may be empty.
    pub verdict: String,
    /// More of the table of meshes.
    pub columns: Vec<Column>,
    /// What only one command has, below that table.
    pub sections: Vec<Section>,
    pub measure: &'a MeasureOptions,
    /// Sentences below everything.
    pub notes: Vec<String>,
}

impl Show<'_> {
    /// Makes the page and writes it.
    pub fn write(&self, request: &PageRequest, force: bool, progress: &dyn Progress) -> Result<()> {
        let html = self.page(request, progress)?.to_html()?;
        progress.check()?;
        io::write_atomic(&request.output, force, |output| output.write_all(html.as_bytes()))
    }

    fn page(&self, request: &PageRequest, progress: &dyn Progress) -> Result<Page> {
        let up = DVec3::from_array(request.up).try_normalize().ok_or_else(|| Error::Option {
            name: "--up",
            message: "0,0,0 is no direction; give three numbers that are not all 0".to_owned(),
        })?;
        let mut sections = vec![section("Summary", &self.verdict, Content::Summary(self.facts()))];
        if !self.results.is_empty() {
            let text = if self.columns.is_empty() { "" } else { ERRORS };
            sections.push(section("Meshes", text, Content::Table(self.table())));
        }
        sections.extend(self.sections.iter().cloned());
        sections.push(self.viewer(up, progress)?);
        let spread = histograms(&self.exhibits())?;
        sections.push(section("How much of the surface is seen", HISTOGRAM, Content::Figures(spread)));
        sections.extend(pictures(&self.original, &self.results, up)?);
        progress.check()?;
        sections.push(section("How to read this", "", Content::Notes(self.notes(request.up))));
        sections.extend(how_made(&request.commands));
        let title = format!("{}, {}", self.original.name, self.deed);
        Ok(Page { title, subtitle: SUBTITLE.to_owned(), sections })
    }

    fn exhibits(&self) -> Vec<&Exhibit<'_>> {
        std::iter::once(&self.original).chain(&self.results).collect()
    }

    fn facts(&self) -> Vec<Fact> {
        let seen = &self.original;
        let fact = |name: &str, value: String, note: String| Fact { name: name.to_owned(), value, note };
        let never = thousands(seen.visibility.never_seen() as u64);
        let mut facts = vec![
            fact("Triangles", thousands(seen.mesh.triangle_count() as u64), "of the original".to_owned()),
            fact(
                "Visibility",
                format!("{:.3}", seen.visibility.of_mesh()),
                "a ball has 1, a sealed inside 0".to_owned(),
            ),
            fact("Never seen", format!("{:.1} %", seen.never_seen_percent()), format!("{never} triangles")),
        ];
        if self.results.is_empty() {
            let cameras = thousands(seen.visibility.cameras() as u64);
            facts.push(fact("Cameras", cameras, "all around".to_owned()));
        }
        for (result, error) in self.results.iter().zip(&self.errors).take(3) {
            let kept = thousands(result.mesh.triangle_count() as u64);
            let note = format!("grey levels; {kept} triangles ({:.1} %)", result.kept_percent(seen));
            facts.push(fact(&format!("Image error of {}", result.name), format!("{:.2}", error.image_rmse), note));
        }
        facts
    }

    fn table(&self) -> Table {
        let heads = ["Mesh", "Triangles", "Kept", "Visibility", "Never seen"];
        let heads = heads.into_iter().chain(self.columns.iter().map(|column| column.head)).map(str::to_owned).collect();
        let row = |exhibit: &Exhibit| {
            vec![
                exhibit.name.clone(),
                thousands(exhibit.mesh.triangle_count() as u64),
                format!("{:.1} %", exhibit.kept_percent(&self.original)),
                format!("{:.3}", exhibit.visibility.of_mesh()),
                format!("{:.1} %", exhibit.never_seen_percent()),
            ]
        };
        let mut rows = vec![row(&self.original)];
        rows[0].extend(self.columns.iter().map(|_| "–".to_owned()));
        for (number, result) in self.results.iter().enumerate() {
            let mut cells = row(result);
            cells.extend(self.columns.iter().map(|column| column.cells[number].clone()));
            rows.push(cells);
        }
        Table { heads, rows, ..Table::default() }
    }

    fn viewer(&self, up: DVec3, progress: &dyn Progress) -> Result<Section> {
        let models = models(&self.exhibits(), MODELS_BYTES, progress)?;
        let [toward, ..] = views_around(up).map(|d| d.to_array());
        let viewer = Viewer { models, legend: Some(legend(MAP)), toward, up: up.to_array() };
        Ok(section("In three dimensions", VIEWER, Content::Viewer(viewer)))
    }

    fn notes(&self, up: [f64; 3]) -> Vec<String> {
        let seen = &self.original.visibility;
        let (backend, estimator) = (self.measure.backend.name(), self.measure.estimator.name());
        let looked = match seen.cameras() {
            0 => "rays in all directions".to_owned(),
            n => format!("{} cameras", thousands(n as u64)),
        };
        let pixels =
            if seen.resolution() > 0 { format!(" of {0} × {0} pixels", seen.resolution()) } else { String::new() };
        let mut notes = vec![
            format!(
                "Visibility: estimator {estimator} on backend {backend}, {looked}{pixels}. Every mesh is looked at by itself."
            ),
            "Visibility of a mesh is the mean over its surface, fronts of triangles only (Zhang & Turk 2002, eq. 3.2)."
                .to_owned(),
            format!("Up in pictures is {}; --up chooses another direction.", in_words(up)),
        ];
        notes.extend(self.notes.iter().cloned());
        notes
    }
}

const SUBTITLE: &str = "Visibility is the share of directions from which a piece of surface is seen from outside, each counted \
    by its cosine: 1 on a ball, 0 in a sealed inside.";
const VIEWER: &str = "Each triangle has the colour of its visibility, darker where it turns away from you.";
const HISTOGRAM: &str = "Share of the surface by its visibility. The first bar is what is hidden, or nearly.";
const ERRORS: &str = "Image error: root mean square difference of pictures from 20 sides, in grey levels of 255. Outline error: \
    pixels per picture, of 512 by 512, that only one of the two outlines covers.";

/// What the colours of `map` mean.
pub(super) fn legend(map: ColourMap) -> Legend {
    Legend {
        title: "Visibility V".to_owned(),
        map,
        low: "no camera sees it".to_owned(),
        high: "all of it sees open sky".to_owned(),
    }
}

/// How to make a page again; nothing where nobody said what was typed.
pub(super) fn how_made(commands: &[String]) -> Option<Section> {
    let text =
        format!("By Outsight {}. Folders are left out, except where they tell files apart.", env!("CARGO_PKG_VERSION"));
    (!commands.is_empty()).then(|| section("How this was made", &text, Content::Commands(commands.to_vec())))
}

/// A direction: `z`, `-y`, `1,0,0.5`.
fn in_words(direction: [f64; 3]) -> String {
    let axis = |sign: f64| {
        ["x", "y", "z"].into_iter().zip(DVec3::AXES).find(|(_, axis)| *axis * sign == DVec3::from_array(direction))
    };
    match (axis(1.0), axis(-1.0)) {
        (Some((name, _)), _) => name.to_owned(),
        (_, Some((name, _))) => format!("-{name}"),
        _ => direction.map(|number| number.to_string()).join(","),
    }
}

/// A section of a page.
pub(super) fn section(heading: &str, text: &str, content: Content) -> Section {
    Section { heading: heading.to_owned(), text: text.to_owned(), content, within: false }
}
