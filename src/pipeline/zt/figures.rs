//! The pictures of a study on its page, each as large as its share of the page allows.

use std::fs;
use std::io;
use std::path::Path;

use super::plots::Plot;
use super::report::ZtReport;
use crate::error::{Error, Result};
use crate::report::page::{FIGURES_BYTES, Figure, Image, MODELS_BYTES};
use crate::report::picture::Picture;

/// What a picture takes of a page.
#[derive(Debug, Clone, Copy)]
pub(super) enum Part {
    /// A sheet of pictures side by side.
    Sheet = 8,
    /// A heat map.
    HeatMap = 4,
    /// A visibility diagram.
    Diagram = 5,
}

/// Bytes for the pictures of a page.
#[derive(Debug, Clone, Copy)]
pub(super) struct Room {
    /// Of a part of 1.
    unit: usize,
}

/// Pixels that the widest column of a page shows.
const WIDEST: u32 = 1184;
/// A picture is made no narrower than this, and a strip no lower, however little room there is.
const NARROWEST: u32 = 160;
const LOWEST: u32 = 48;
/// Aims a little below the share, so that it is met at once.
const CAUTION: f64 = 0.9;

impl Room {
    /// What plots and models leave, in equal shares.
    pub fn of(report: &ZtReport, plots: &[Plot]) -> Self {
        let viewers = report.models.iter().flat_map(|model| &model.findings.viewer);
        let models: usize = viewers.flat_map(|viewer| &viewer.models).map(|model| model.model.bytes()).sum();
        let plots: usize = plots.iter().map(|plot| plot.figure().image.embedded_bytes()).sum();
        let free = (FIGURES_BYTES + MODELS_BYTES).saturating_sub(models + plots);
        let parts = report.models.iter().map(|model| {
            let sheets: usize = model.findings.pictures.iter().map(|pictures| pictures.sheets.len()).sum();
            Part::Sheet as usize * sheets + Part::HeatMap as usize * model.findings.looks.len() + Part::Diagram as usize
        });
        Self { unit: free / (parts.sum::<usize>() + Part::Diagram as usize) }
    }

    /// A picture of the study as a figure.
    pub fn figure(self, part: Part, path: &Path, caption: String) -> Result<Figure> {
        let bytes = fs::read(path).map_err(|source| Error::Read { path: path.to_owned(), source })?;
        let image =
            fitted(bytes, self.unit * part as usize).map_err(|source| Error::Read { path: path.to_owned(), source })?;
        Ok(Figure { image, caption })
    }
}

/// A picture as it is, or coarser and smaller, until it takes no more than `share` bytes.
fn fitted(file: Vec<u8>, share: usize) -> io::Result<Image> {
    let as_is = Image::Png(file);
    let Image::Png(file) = &as_is else { return Ok(as_is) };
    if as_is.embedded_bytes() <= share {
        return Ok(as_is);
    }
    let whole = Picture::from_png(file).map_err(io::Error::other)?;
    let mut width = whole.width().min(WIDEST);
    loop {
        let height = (whole.height() * width / whole.width()).max(whole.height().min(LOWEST));
        let mut smaller = Vec::new();
        whole.scaled_down(width, height).write_coarse_png(&mut smaller)?;
        let image = Image::Png(smaller);
        if image.embedded_bytes() <= share || width <= NARROWEST {
            return Ok(image);
        }
        // Bytes go with the pixels.
        let shrink = libm::sqrt(CAUTION * share as f64 / image.embedded_bytes() as f64);
        width = ((shrink * f64::from(width)) as u32).max(NARROWEST);
    }
}
