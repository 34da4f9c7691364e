use std::path::PathBuf;

use glam::DVec3;

use super::{Observer, as_progress, read};
use crate::error::{Error, Result};
use crate::eval::Gallery;
use crate::io::{self, ReadOptions};
use crate::mesh::TriMesh;
use crate::raster::Hit;
use crate::report::colour::ColourMap;
use crate::report::legend::with_legend;
use crate::report::picture::Picture;
use crate::visibility::{self, MeasureOptions};

/// Samples along a pixel's side, averaged.
const SAMPLES: u32 = 2;

/// Share of a heat colour that stays on a triangle seen edge-on; the rest goes with the head light, which shows shape.
const AMBIENT: f64 = 0.5;

/// How a picture is coloured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Style {
    /// Flat triangles in grey under a head light.
    #[default]
    Flat,
    /// Visibility as heat colours.
    Heat,
}

/// What [`render_file`] does.
#[derive(Debug, Clone)]
pub struct RenderRequest {
    /// The mesh.
    pub input: PathBuf,
    /// How it is read.
    pub read: ReadOptions,
    /// The picture, a PNG.
    pub output: PathBuf,
    /// How it is coloured.
    pub style: Style,
    /// From the mesh toward the camera, of any length but 0; the z axis points up.
    pub camera: [f64; 3],
    /// Pixels along the side, without the legend.
    pub size: u32,
    /// Heat colours.
    pub colour_map: ColourMap,
    /// Put the colour scale under the picture.
    pub legend: bool,
    /// How visibility is measured for heat colours.
    pub measure: MeasureOptions,
    /// Replace a picture that is there.
    pub force: bool,
}

/// Draws a mesh into a PNG file, on white.
///
/// # Errors
/// Those of reading, measuring and writing, and of the observer.
pub fn render_file(request: &RenderRequest, observer: &dyn Observer) -> Result<()> {
    let mesh = read(&request.input, &request.read, observer)?.mesh;
    let picture = match request.style {
        Style::Flat => draw(&mesh, request, |_, light| [light; 3].map(|l| 255.0 * l))?,
        Style::Heat => {
            let visibility = visibility::measure(&mesh, &request.measure, as_progress(observer))?;
            let values = visibility.per_triangle();
            draw(&mesh, request, |hit, light| {
                let colour = request.colour_map.colour(values[hit.triangle.0 as usize]);
                colour.map(|c| f64::from(c) * (AMBIENT + (1.0 - AMBIENT) * light))
            })?
        }
    };
    let page = if request.legend { with_legend(&picture, request.colour_map, "visibility") } else { picture };
    io::write_atomic(&request.output, request.force, |out| page.write_png(out))
}

/// Colours every sample by `paint`, which gets the head light's |n·d|, and averages the samples of a pixel.
fn draw(mesh: &TriMesh, request: &RenderRequest, paint: impl Fn(Hit, f64) -> [f64; 3]) -> Result<Picture> {
    let toward = DVec3::from(request.camera).try_normalize().ok_or_else(|| Error::Option {
        name: "--camera",
        message: "0,0,0 is no direction; give one such as 1,-2,1".to_owned(),
    })?;
    let gallery = Gallery::new(mesh, mesh);
    let width = request.size as usize;
    let hits = gallery.hits(toward, DVec3::Z, SAMPLES * request.size)?;
    let mut sums = vec![[0.0_f64; 3]; width * width];
    for (i, hit) in hits.into_iter().enumerate() {
        let colour = hit.map_or([255.0; 3], |hit| paint(hit, gallery.head_light(hit, toward) / 255.0));
        let side = SAMPLES as usize;
        let (column, row) = (i % (side * width) / side, i / (side * width) / side);
        // Hits come from the bottom, rows of a picture from the top.
        let sum = &mut sums[(width - 1 - row) * width + column];
        (0..3).for_each(|c| sum[c] += colour[c]);
    }
    let per_pixel = f64::from(SAMPLES * SAMPLES);
    let bytes = sums.iter().flatten().map(|sum| (sum / per_pixel).round() as u8).collect();
    Picture::from_rgb(request.size, request.size, bytes)
}
