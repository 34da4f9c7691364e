//! The pictures of a study on its page: their files where they fit, else as JPEG, else all smaller by the same share.

use std::collections::BTreeMap;
use std::fs;

use super::ZtRequest;
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
            Self::Side => 400.0,
            Self::HeatMap => 600.0,
            // Half of its cameras. Its columns are as many as the triangles and mean little one by one.
            Self::Diagram => return [800.0, 130.0],
            Self::Outline => return [picture.width(), picture.height()].map(f64::from),
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
        let plots: usize = plots.iter().flat_map(|plot| &plot.figures).map(|plot| plot.image.embedded_bytes()).sum();
        let free = (FIGURES_BYTES + MODELS_BYTES).saturating_sub(models + plots);
        let sources = sources(report, request)?;
        let images = fitted(&sources, free)?;
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
        names.extend(findings.looks.first().map(|look| (look.diagram.as_str(), Part::Diagram)));
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

/// The pictures' files as they are, or all as JPEG, and smaller, until together they take no more than `free` bytes.
fn fitted(sources: &[Source], free: usize) -> Result<Vec<Image>> {
    let mut images: Vec<Image> = sources.iter().map(|source| Image::Png(source.bytes.clone())).collect();
    let mut scale: Option<f64> = None;
    loop {
        let taken: usize = images.iter().map(Image::embedded_bytes).sum();
        if taken <= free || scale.is_some_and(|scale| scale < SMALLEST) {
            return Ok(images);
        }
        // Bytes go with the pixels.
        let shrink = libm::sqrt(CAUTION * free as f64 / taken as f64).min(CAUTION);
        let next = scale.map_or(1.0, |scale| shrink * scale);
        images = sources.iter().map(|source| source.smaller(next)).collect::<Result<_>>()?;
        scale = Some(next);
    }
}

impl Source {
    /// The picture as JPEG, at a share of its size on the page; of the outline its file, since nobody could read its words.
    fn smaller(&self, scale: f64) -> Result<Image> {
        if self.part == Part::Outline {
            return Ok(Image::Png(self.bytes.clone()));
        }
        let picture = Picture::from_png(&self.bytes)?;
        let [width, height] = self.part.most(&picture).map(|pixels| (scale * pixels) as u32);
        let mut file = Vec::new();
        let written = picture.scaled_down(width, height).write_jpeg(&mut file);
        written.map_err(|e| Error::Limit { message: format!("{} for the page: {e}", self.name) })?;
        Ok(Image::Jpeg(file))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// A shaded picture with some grain.
    fn shaded(part: Part, width: u32, height: u32) -> Source {
        let level = |i: u32| 100.0 + (i % width) as f32 / 8.0 + (i.wrapping_mul(2_654_435_761) >> 29) as f32;
        let grey: Vec<f32> = (0..width * height).map(level).collect();
        let mut bytes = Vec::new();
        Picture::from_grey(width, height, &grey).unwrap().write_png(&mut bytes).unwrap();
        Source { name: "shaded.png".to_owned(), part, bytes }
    }

    fn sizes(images: &[Image]) -> Vec<[u32; 2]> {
        let size = |image: &Image| {
            match image {
                // The header of a PNG file has width and height behind 16 bytes,
                Image::Png(file) => [16, 20].map(|at| u32::from_be_bytes(file[at..at + 4].try_into().unwrap())),
                // a JPEG file's frame height and width behind 5.
                Image::Jpeg(file) => {
                    let frame = file.windows(2).position(|pair| pair == [0xff, 0xc0]).unwrap();
                    [7, 5].map(|at| u32::from(u16::from_be_bytes([file[frame + at], file[frame + at + 1]])))
                }
                Image::Svg(_) => [0, 0],
            }
        };
        images.iter().map(size).collect()
    }

    fn bytes(images: &[Image]) -> usize {
        images.iter().map(Image::embedded_bytes).sum()
    }

    #[test]
    fn pictures_stay_whole_where_they_fit_and_shrink_together_where_they_do_not() {
        let sources = [shaded(Part::Side, 400, 200), shaded(Part::HeatMap, 700, 700), shaded(Part::Diagram, 900, 258)];
        let whole = fitted(&sources, usize::MAX).unwrap();
        assert_eq!(sizes(&whole), [[400, 200], [700, 700], [900, 258]]);
        let page = fitted(&sources, bytes(&whole) - 1).unwrap();
        assert_eq!(sizes(&page), [[400, 200], [600, 600], [800, 130]], "as large as the page shows them");
        let free = bytes(&page) / 2;
        let small = fitted(&sources, free).unwrap();
        assert!(bytes(&small) <= free && bytes(&small) > free / 2, "{} of {free}", bytes(&small));
        let [side, heat_map, _] = sizes(&small).try_into().unwrap();
        let [a, b] = [f64::from(side[0]) / 400.0, f64::from(heat_map[0]) / 600.0];
        assert!((a - b).abs() < 0.01 && a < 1.0, "{a} {b}");
        assert!(!fitted(&sources, 1).unwrap().is_empty(), "ends even where nothing fits");
    }
}
