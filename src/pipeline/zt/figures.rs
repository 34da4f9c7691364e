//! The pictures of a study on its page: whole where they fit, else all smaller by the same share.

use std::collections::BTreeMap;
use std::fs;
use std::io;

use super::ZtRequest;
use super::cell::LookFinding;
use super::plots::Plot;
use super::report::ZtReport;
use crate::error::{Error, Result};
use crate::report::page::{FIGURES_BYTES, Figure, Image, MODELS_BYTES};
use crate::report::picture::Picture;

/// Figure 1 of an outline, in the study's directory.
pub(super) const OUTLINE: &str = "outline.png";

/// What a picture is on the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    /// One of five pictures side by side.
    Side,
    /// One of two heat maps.
    HeatMap,
    /// A visibility diagram of a mesh.
    Diagram,
    /// A visibility diagram of an outline, with words in it.
    Outline,
}

/// Pictures of a page, by their files' names.
pub(super) struct Room {
    images: BTreeMap<String, Image>,
}

/// A picture from the study's directory.
struct Source {
    name: String,
    part: Part,
    bytes: Vec<u8>,
}

/// Aims a little below what is free, so that it is met at once.
const CAUTION: f64 = 0.95;
/// Pictures are made no smaller than this; what is too much then is left to the limit of the whole page.
const SMALLEST: f64 = 0.2;

impl Part {
    /// Pixels that a picture has at most where they are made smaller; a wide page shows about as many.
    fn most(self, picture: &Picture) -> [f64; 2] {
        let widest: f64 = match self {
            Self::Side => 320.0,
            Self::HeatMap => 560.0,
            // Half of its cameras. Its columns are as many as the triangles and mean little one by one.
            Self::Diagram => return [640.0, 130.0],
            Self::Outline => 1184.0,
        };
        let [width, height] = [picture.width(), picture.height()].map(f64::from);
        let shrink = (widest / width.max(height)).min(1.0);
        [shrink * width, shrink * height]
    }
}

impl Room {
    /// All pictures of `report` within what plots and models leave of a page.
    pub fn of(report: &ZtReport, request: &ZtRequest, plots: &[Plot]) -> Result<Self> {
        let viewers = report.models.iter().flat_map(|model| &model.findings.viewer);
        let models: usize = viewers.flat_map(|viewer| &viewer.models).map(|model| model.model.bytes()).sum();
        let plots: usize = plots.iter().map(|plot| plot.figure().image.embedded_bytes()).sum();
        let free = (FIGURES_BYTES + MODELS_BYTES).saturating_sub(models + plots);
        let sources = sources(report, request)?;
        let as_is = sources.iter().map(|source| Image::Png(source.bytes.clone())).collect();
        let images = fitted(&sources, as_is, free)?;
        Ok(Self { images: sources.into_iter().map(|source| source.name).zip(images).collect() })
    }

    /// A picture as a figure.
    ///
    /// # Errors
    /// [`Error::Limit`] for a file that the report did not name.
    pub fn figure(&self, file: &str, caption: String) -> Result<Figure> {
        let image = self.images.get(file).cloned();
        let image = image.ok_or_else(|| Error::Limit { message: format!("no room was kept for {file}") })?;
        Ok(Figure { image, caption })
    }
}

/// The pictures that the page shows.
fn sources(report: &ZtReport, request: &ZtRequest) -> Result<Vec<Source>> {
    let mut names = vec![(OUTLINE, Part::Outline)];
    for findings in report.models.iter().map(|model| &model.findings) {
        names.extend(findings.looks.iter().map(|look| (look.bare_heat_map.as_str(), Part::HeatMap)));
        names.extend(findings.looks.first().map(|look: &LookFinding| (look.diagram.as_str(), Part::Diagram)));
        let sheets = findings.pictures.iter().flat_map(|pictures| &pictures.sheets);
        names.extend(sheets.flat_map(|sheet| &sheet.shown).map(|shown| (shown.file.as_str(), Part::Side)));
    }
    let read = |(name, part): (&str, Part)| {
        let path = request.output.join(name);
        let bytes = fs::read(&path).map_err(|source| Error::Read { path, source })?;
        Ok(Source { name: name.to_owned(), part, bytes })
    };
    names.into_iter().map(read).collect()
}

/// `images`, which show the sources, or coarser and smaller ones, until all together take no more than `free` bytes.
fn fitted(sources: &[Source], mut images: Vec<Image>, free: usize) -> Result<Vec<Image>> {
    let mut scale = 1.0;
    loop {
        let taken: usize = images.iter().map(Image::embedded_bytes).sum();
        if taken <= free || scale < SMALLEST {
            return Ok(images);
        }
        let smaller = |source: &Source| {
            let fault = |e: io::Error| Error::Limit { message: format!("{} for the page: {e}", source.name) };
            smaller(&Picture::from_png(&source.bytes)?, source.part, scale).map_err(fault)
        };
        images = sources.iter().map(smaller).collect::<Result<_>>()?;
        let taken: usize = images.iter().map(Image::embedded_bytes).sum();
        // Bytes go with the pixels.
        scale *= libm::sqrt(CAUTION * free as f64 / taken as f64).min(CAUTION);
    }
}

/// A picture in coarser shades, at a share of its size on the page.
fn smaller(picture: &Picture, part: Part, scale: f64) -> io::Result<Image> {
    let [width, height] = part.most(picture).map(|pixels| (scale * pixels) as u32);
    let mut file = Vec::new();
    picture.scaled_down(width, height).write_coarse_png(&mut file)?;
    Ok(Image::Png(file))
}
