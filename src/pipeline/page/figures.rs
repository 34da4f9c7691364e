use glam::DVec3;

use crate::camera::Frame;
use crate::error::{Error, Result};
use crate::eval::{Gallery, Shot};
use crate::mesh::TriangleId;
use crate::pipeline::compare::{VIEW_NAMES, views_around};
use crate::pipeline::page::{Exhibit, MAP, section};
use crate::pipeline::render::heat_picture;
use crate::pipeline::side_by_side::Pictures;
use crate::report::histogram::Histogram;
use crate::report::page::{Content, FIGURES_BYTES, Figure, Figures, Image, Section};
use crate::report::picture::Picture;

/// Bars of a histogram.
const CLASSES: usize = 20;

/// Histograms side by side at most.
const HISTOGRAM_COLUMNS: usize = 3;

/// Pixels along the side of a picture: the first that keeps all of them within [`FIGURES_BYTES`].
const WIDTHS: [u32; 5] = [420, 300, 210, 150, 100];

/// Heading and text of the rows of pictures.
const HEAT: (&str, &str) = ("Pictures", "The same colours from three sides.");
const ORIGINAL: (&str, &str) = ("Pictures of the original", "");
const RESULTS: (&str, &str) = (
    "Pictures of the results",
    "From the same sides, each beside what differs from the original: white where the pictures are equal, full red from 64 grey \
     levels of 255.",
);

/// How the surface of each mesh is spread over visibility, on one scale.
pub(super) fn histograms(exhibits: &[&Exhibit<'_>]) -> Result<Figures> {
    let spread: Vec<Vec<f64>> = exhibits.iter().map(|exhibit| spread(exhibit)).collect();
    // Whole tens, so that the scale ends on a number.
    let top = 10.0 * (spread.iter().flatten().fold(0.0_f64, |most, &p| most.max(p)) / 10.0).ceil().max(1.0);
    let figure = |(exhibit, percents): (&&Exhibit, Vec<f64>)| {
        let (x, y) = ("visibility".to_owned(), "share of the surface".to_owned());
        let svg = Histogram { percents, x, y, top, map: MAP }.to_svg();
        let svg = svg.map_err(|e| Error::Limit { message: format!("a histogram of {}: {e}", exhibit.name) })?;
        Ok(Figure { image: Image::Svg(svg), caption: exhibit.name.clone() })
    };
    let figures = exhibits.iter().zip(spread).map(figure).collect::<Result<Vec<_>>>()?;
    Ok(Figures { columns: figures.len().clamp(2, HISTOGRAM_COLUMNS), figures, legend: None })
}

/// The share of the surface in each class of visibility, in %.
fn spread(exhibit: &Exhibit<'_>) -> Vec<f64> {
    let frame = Frame::of(exhibit.mesh);
    let area = |t| frame.area_and_normal(exhibit.mesh, TriangleId(t)).map_or(0.0, |(area, _)| area);
    let areas: Vec<f64> = (0..exhibit.mesh.triangle_count() as u32).map(area).collect();
    Histogram::percents_of(exhibit.visibility.per_triangle(), &areas, CLASSES)
}

/// The original from three sides, a column each: its heat map where it is alone, else below it a row for each result, every
/// picture with what differs.
pub(super) fn pictures(original: &Exhibit<'_>, results: &[Exhibit<'_>], up: DVec3) -> Result<Vec<Section>> {
    let mut drawn = Vec::new();
    for width in WIDTHS {
        let shots = views_around(up).map(|toward| Shot::fitting(original.mesh, toward, up, width));
        drawn = if results.is_empty() { vec![heat(original, &shots)?] } else { compared(original, results, &shots)? };
        if drawn.iter().flatten().map(|figure| figure.image.embedded_bytes()).sum::<usize>() <= FIGURES_BYTES {
            break;
        }
    }
    let headings = if results.is_empty() { [HEAT, RESULTS] } else { [ORIGINAL, RESULTS] };
    let columns = [VIEW_NAMES.len(), 2 * VIEW_NAMES.len()];
    let rows = headings.into_iter().zip(columns).zip(drawn);
    let rows = rows.map(|(((heading, text), columns), figures)| {
        section(heading, text, Content::Figures(Figures { columns, figures, legend: None }))
    });
    Ok(rows.collect())
}

fn heat(exhibit: &Exhibit<'_>, shots: &[Shot; 3]) -> Result<Vec<Figure>> {
    let gallery = Gallery::new(exhibit.mesh, exhibit.mesh);
    let draw = |(shot, side): (&Shot, &str)| {
        let picture = heat_picture(&gallery, shot, exhibit.visibility.per_triangle(), MAP)?;
        figure(&picture, format!("{} {side}", exhibit.name))
    };
    shots.iter().zip(VIEW_NAMES).map(draw).collect()
}

/// The pictures of the original, and those of all results.
fn compared(original: &Exhibit<'_>, results: &[Exhibit<'_>], shots: &[Shot; 3]) -> Result<Vec<Vec<Figure>>> {
    let reference = Pictures::of(original.mesh, original.mesh, shots)?;
    let whole = VIEW_NAMES.iter().enumerate();
    let whole = whole.map(|(view, side)| figure(&reference.shaded(view)?, format!("{} {side}", original.name)));
    let mut figures = vec![whole.collect::<Result<Vec<_>>>()?, Vec::new()];
    for result in results {
        let sheet = Pictures::of(result.mesh, original.mesh, shots)?;
        for (view, side) in VIEW_NAMES.into_iter().enumerate() {
            figures[1].push(figure(&sheet.shaded(view)?, format!("{} {side}", result.name))?);
            let caption = format!("{}: difference {side}", result.name);
            figures[1].push(figure(&reference.red(&sheet, view)?, caption)?);
        }
    }
    Ok(figures)
}

fn figure(picture: &Picture, caption: String) -> Result<Figure> {
    let mut png = Vec::new();
    picture.write_png(&mut png).map_err(|e| Error::Limit { message: format!("a picture of {caption}: {e}") })?;
    Ok(Figure { image: Image::Png(png), caption })
}
