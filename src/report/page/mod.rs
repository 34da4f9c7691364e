//! A page that shows results: one HTML file that needs nothing else, and asks nobody for anything.
//!
//! A [`Page`] is plain data; [`Page::to_html`] is the only way out. Text is escaped where it is put into the markup (by
//! `maud`, which escapes whatever it is not told to trust), pictures and plots stand in data addresses, where nothing in
//! them can run, and the page's own policy forbids every script but its two and every request. Models are GLB, packed,
//! and shown by three.js, whose needed parts `scripts/vendor-viewer` puts into `vendor/`.

mod markup;
mod model;

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::report::colour::ColourMap;

pub use model::PackedModel;

/// Largest page, in bytes: mail and web servers take it, phones open it.
pub const MAX_BYTES: usize = 15_000_000;

/// What all models of a page may take together, in bytes; the rest is for scripts, pictures and plots.
pub const MODELS_BYTES: usize = 9_000_000;

/// What all pictures and plots of a page may take together, in bytes as they are embedded.
pub const FIGURES_BYTES: usize = 5_000_000;

/// A page.
#[derive(Debug, Clone, Default)]
pub struct Page {
    /// The heading, also of the window.
    pub title: String,
    /// A sentence below it; may be empty.
    pub subtitle: String,
    /// From the top.
    pub sections: Vec<Section>,
}

/// A part of a page.
#[derive(Debug, Clone)]
pub struct Section {
    /// Above it.
    pub heading: String,
    /// What a reader should know to understand it; may be empty.
    pub text: String,
    /// What it shows.
    pub content: Content,
    /// It belongs to what stands above it. A page with such sections begins with links to the others.
    pub within: bool,
}

/// What a section shows.
#[derive(Debug, Clone)]
pub enum Content {
    /// Numbers that say it all, side by side.
    Summary(Vec<Fact>),
    /// Rows and columns.
    Table(Table),
    /// Pictures and plots.
    Figures(Figures),
    /// Models to be turned.
    Viewer(Viewer),
    /// Sentences, one a line.
    Notes(Vec<String>),
    /// What was typed, one a line.
    Commands(Vec<String>),
}

/// A number of a summary.
#[derive(Debug, Clone)]
pub struct Fact {
    /// What it is: `visibility`.
    pub name: String,
    /// The number, with its unit.
    pub value: String,
    /// What it is compared with or made of; may be empty.
    pub note: String,
}

/// Rows and columns. The first column names the row, the others hold numbers.
#[derive(Debug, Clone, Default)]
pub struct Table {
    /// Above the columns.
    pub heads: Vec<String>,
    /// One cell for each head.
    pub rows: Vec<Vec<String>>,
    /// Row and column, from 0, of cells to stand out: the best of their column.
    pub best: Vec<[usize; 2]>,
}

/// Pictures and plots in rows.
#[derive(Debug, Clone, Default)]
pub struct Figures {
    /// How many stand side by side where there is room; phones show two, an odd one and plots across both.
    pub columns: usize,
    /// From the left, then down.
    pub figures: Vec<Figure>,
    /// What the colours of all of them mean, where they mean something.
    pub legend: Option<Legend>,
}

/// A picture or a plot.
#[derive(Debug, Clone)]
pub struct Figure {
    /// What is drawn.
    pub image: Image,
    /// Below it, and read out in its place.
    pub caption: String,
}

/// The file of a picture or a plot.
#[derive(Debug, Clone)]
pub enum Image {
    /// A PNG file.
    Png(Vec<u8>),
    /// A JPEG file.
    Jpeg(Vec<u8>),
    /// An SVG document on white; its colours mean something, so that the dark only dims them.
    Svg(String),
}

/// Models side by side, turned together; the reader chooses another axis to be up.
#[derive(Debug, Clone)]
pub struct Viewer {
    /// The first one is the original; all in one frame, within the unit sphere.
    pub models: Vec<Model>,
    /// What the colours of the models mean; `None` for models without colours.
    pub legend: Option<Legend>,
    /// From the models toward the eye, at first; any length but 0.
    pub toward: [f64; 3],
    /// Upward at first, any length but 0.
    pub up: [f64; 3],
}

/// A model of a viewer.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Model {
    /// Which one.
    pub name: String,
    /// Its triangles, and whether it stands for more.
    pub caption: String,
    /// The model.
    pub model: PackedModel,
}

/// Which colour means which number.
#[derive(Debug, Clone)]
pub struct Legend {
    /// What the numbers are.
    pub title: String,
    /// The colours of 0 to 1.
    pub map: ColourMap,
    /// What 0 means.
    pub low: String,
    /// What 1 means.
    pub high: String,
}

impl Page {
    /// The page as an HTML document; the same page gives the same bytes.
    ///
    /// # Errors
    /// [`Error::Limit`] past [`MAX_BYTES`].
    pub fn to_html(&self) -> Result<String> {
        let html = markup::document(self).into_string();
        if html.len() <= MAX_BYTES {
            return Ok(html);
        }
        let (got, most) = (html.len() as f64 / 1e6, MAX_BYTES as f64 / 1e6);
        let message = format!("the page would have {got:.1} MB, more than {most} MB; show fewer meshes on it");
        Err(Error::Limit { message })
    }
}

impl Image {
    /// Bytes that the picture takes in a page.
    #[must_use]
    pub fn embedded_bytes(&self) -> usize {
        let bytes = match self {
            Self::Png(bytes) | Self::Jpeg(bytes) => bytes.len(),
            Self::Svg(text) => text.len(),
        };
        4 * bytes.div_ceil(3)
    }
}

#[cfg(test)]
mod tests;
