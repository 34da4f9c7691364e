use std::path::PathBuf;

use glam::DVec3;

use crate::error::{Error, Result};
use crate::eval::{Gallery, Shot};
use crate::io::{self, ReadOptions};
use crate::mesh::TriMesh;
use crate::pipeline::Observer;
use crate::pipeline::observation::{Observation, Surrounded};
use crate::report::colour::ColourMap;
use crate::report::legend::with_legend;
use crate::report::picture::Picture;
use crate::visibility::MeasureOptions;

/// How a picture is coloured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Style {
    /// Head light on flat triangles.
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
    /// The picture, PNG.
    pub output: PathBuf,
    /// How it is coloured.
    pub style: Style,
    /// From the mesh toward the camera, any length but 0.
    pub camera: [f64; 3],
    /// Upward in the picture, any length but 0.
    pub up: [f64; 3],
    /// Pixels along the side, 16 to 8192.
    pub size: u32,
    /// Heat colours.
    pub colour_map: ColourMap,
    /// Draw the colour scale below the picture.
    pub legend: bool,
    /// How visibility is measured for heat colours.
    pub measure: MeasureOptions,
    /// Where measurements are kept from run to run: a directory, or one file that ends in `.seen`.
    pub cache: Option<PathBuf>,
    /// Replace a picture that is there.
    pub force: bool,
}

/// Draws a mesh.
///
/// # Errors
/// As its steps; [`Error::Option`] for a size outside its range or a camera without a direction.
pub fn render_file(request: &RenderRequest, observer: &dyn Observer) -> Result<()> {
    let toward = direction("--camera", request.camera)?;
    let up = direction("--up", request.up)?;
    if !(16..=8192).contains(&request.size) {
        let message = format!("{} pixels; a picture has 16 to 8192 along a side", request.size);
        return Err(Error::Option { name: "--size", message });
    }
    let loaded = io::read(&request.input, &request.read)?;
    observer.mesh_read(&request.input, &loaded)?;
    let shot = Shot::fitting(&loaded.mesh, toward, up, request.size);
    let picture = match request.style {
        Style::Flat => flat(&loaded.mesh, &shot)?,
        Style::Heat => heat(&loaded.mesh, &shot, request, observer)?,
    };
    observer.check()?;
    io::write_atomic(&request.output, request.force, |writer| picture.write_png(writer))
}

const WHITE: f64 = 255.0;

fn flat(mesh: &TriMesh, shot: &Shot) -> Result<Picture> {
    let image = Gallery::new(mesh, mesh).picture(shot, WHITE)?;
    Picture::from_grey(shot.width, shot.width, &image.pixels)
}

fn heat(mesh: &TriMesh, shot: &Shot, request: &RenderRequest, observer: &dyn Observer) -> Result<Picture> {
    let scene = Surrounded { mesh, occluders: &[] };
    let mut observation = Observation::of(scene, &request.measure, request.cache.as_deref(), observer)?;
    let visibility = observation.visibility(observer)?;
    observation.keep(&visibility, None)?;
    let values = visibility.per_triangle();
    let picture = heat_picture(&Gallery::new(mesh, mesh), shot, values, request.colour_map)?;
    Ok(if request.legend { with_legend(&picture, request.colour_map, "visibility V") } else { picture })
}

/// Heat colours of `values`, one per triangle, darkened by half where the surface turns away, so that its shape shows.
pub(super) fn heat_picture(gallery: &Gallery, shot: &Shot, values: &[f64], map: ColourMap) -> Result<Picture> {
    let picture = gallery.coloured(shot, |hit, brightness| {
        let colour = map.colour(values[hit.triangle.0 as usize]);
        colour.map(|channel| f64::from(channel) * (0.5 + 0.5 * brightness))
    })?;
    Picture::from_rgb(shot.width, shot.width, picture)
}

fn direction(name: &'static str, [x, y, z]: [f64; 3]) -> Result<DVec3> {
    DVec3::new(x, y, z).try_normalize().ok_or_else(|| Error::Option {
        name,
        message: format!("{x},{y},{z} is no direction; give three numbers that are not all 0"),
    })
}
