use std::path::PathBuf;

use glam::DVec3;

use crate::error::{Error, Result};
use crate::eval::{Gallery, fitting_half_width};
use crate::io::{self, ReadOptions};
use crate::mesh::TriMesh;
use crate::pipeline::Observer;
use crate::report::colour::ColourMap;
use crate::report::legend::with_legend;
use crate::report::picture::Picture;
use crate::visibility::{self, MeasureOptions};

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
    let picture = match request.style {
        Style::Flat => flat(&loaded.mesh, toward, up, request)?,
        Style::Heat => heat(&loaded.mesh, toward, up, request, observer)?,
    };
    io::write_atomic(&request.output, request.force, |writer| picture.write_png(writer))
}

fn flat(mesh: &TriMesh, toward: DVec3, up: DVec3, request: &RenderRequest) -> Result<Picture> {
    let image = Gallery::new(mesh, mesh).picture(toward, up, request.size, fitting_half_width(mesh, toward, up))?;
    let on_white = |grey: f32| if grey == 0.0 { [255; 3] } else { [grey as u8; 3] };
    Picture::from_values(request.size, request.size, &image.pixels, on_white)
}

/// Heat colours, darkened by half where the surface turns away, so that its shape shows.
fn heat(mesh: &TriMesh, toward: DVec3, up: DVec3, request: &RenderRequest, observer: &dyn Observer) -> Result<Picture> {
    let visibility = visibility::measure(mesh, &request.measure, observer)?;
    let gallery = Gallery::new(mesh, mesh);
    let picture =
        gallery.coloured(toward, up, request.size, fitting_half_width(mesh, toward, up), |hit, brightness| {
            let colour = request.colour_map.colour(visibility.per_triangle()[hit.triangle.0 as usize]);
            colour.map(|channel| f64::from(channel) * (0.5 + 0.5 * brightness))
        })?;
    let picture = Picture::from_rgb(request.size, request.size, picture)?;
    Ok(if request.legend { with_legend(&picture, request.colour_map, "visibility V") } else { picture })
}

fn direction(name: &'static str, [x, y, z]: [f64; 3]) -> Result<DVec3> {
    DVec3::new(x, y, z).try_normalize().ok_or_else(|| Error::Option {
        name,
        message: format!("{x},{y},{z} is no direction; give three numbers that are not all 0"),
    })
}
