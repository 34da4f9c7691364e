//! Pictures of where two measurements differ.

use std::path::{Path, PathBuf};

use glam::DVec3;

use crate::backend::{ItemBuffers, MachineScratch};
use crate::camera::{View, Window};
use crate::error::Result;
use crate::eval::{Gallery, Shot};
use crate::io;
use crate::pipeline::VerifyRequest;
use crate::pipeline::compare::views_around;
use crate::raster::{Hit, ItemBufferPair};
use crate::report::colour::mix;
use crate::report::contact_sheet::RED;
use crate::report::legend::with_scale;
use crate::report::picture::{Picture, WHITE};
use crate::visibility::agreement::{Agreement, Comparing, Measurement};

/// Where the pictures of one pair go.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PairPictures {
    /// |V_a − V_b| on the mesh, from three sides.
    pub values: PathBuf,
    /// The camera with the most triangles that only one of the two sees: their pixels in red. Only where both draw and
    /// differ.
    pub pixels: PathBuf,
}

impl PairPictures {
    /// Files in `directory` named after the two.
    #[must_use]
    pub fn new(directory: &Path, a: &str, b: &str) -> Self {
        let file = |what: &str| directory.join(format!("{a}-{b}-{what}.png"));
        Self { values: file("values"), pixels: file("pixels") }
    }
}

/// Writes the pictures of a pair and returns their names.
pub(super) fn write_pictures(
    files: &PairPictures,
    pair: [&Measurement<'_>; 2],
    agreement: &Agreement,
    comparing: Comparing<'_>,
    request: &VerifyRequest,
) -> Result<Vec<PathBuf>> {
    let mut written = Vec::new();
    let mut write = |path: &PathBuf, picture: &Picture| {
        written.push(path.clone());
        io::write_atomic_in_directory(path, request.force, |writer| picture.write_png(writer))
    };
    write(&files.values, &values_picture(pair[0], agreement, DVec3::from_array(request.up))?)?;
    if let Some(picture) = pixels_picture(pair, agreement, comparing)? {
        write(&files.pixels, &picture)?;
    }
    Ok(written)
}

/// Pixels along the side of a picture of values.
const PICTURE_WIDTH: u32 = 400;

/// |V_a − V_b| in red on the mesh, darkened where the surface turns away, beside a scale that fits 99 % of the area.
fn values_picture(a: &Measurement<'_>, agreement: &Agreement, up: DVec3) -> Result<Picture> {
    let mesh = a.subject.mesh();
    let gallery = Gallery::new(mesh, mesh);
    let full = full_scale(agreement.values.p99);
    let red = |share: f64| mix(WHITE, RED, share.clamp(0.0, 1.0));
    let mut row = Picture::filled(3 * PICTURE_WIDTH, PICTURE_WIDTH, WHITE);
    for (place, toward) in (0..).zip(views_around(up)) {
        let shot = Shot::fitting(mesh, toward, up, PICTURE_WIDTH);
        let rgb = gallery.coloured(&shot, |hit, brightness| {
            let difference = agreement.values.per_triangle[hit.triangle.0 as usize].abs();
            red(difference / full).map(|channel| f64::from(channel) * (0.5 + 0.5 * brightness))
        })?;
        row.blit(&Picture::from_rgb(PICTURE_WIDTH, PICTURE_WIDTH, rgb)?, place * PICTURE_WIDTH, 0);
    }
    let ticks = [(0.0, "0".to_owned()), (0.5, format!("{}", 0.5 * full)), (1.0, format!("{full}+"))];
    Ok(with_scale(&row, red, &ticks, "difference of visibility"))
}

/// The power of ten at or above `value`, from 0.0001 to 1.
fn full_scale(value: f64) -> f64 {
    [1e-4, 1e-3, 1e-2, 1e-1].into_iter().find(|&full| value <= full).unwrap_or(1.0)
}

/// What the worst camera sees, pale, with the pixels that differ in red; `None` where the two do not both draw, or agree.
fn pixels_picture(
    pair: [&Measurement<'_>; 2],
    agreement: &Agreement,
    comparing: Comparing<'_>,
) -> Result<Option<Picture>> {
    let both_draw = pair.iter().all(|m| m.setting.estimator.draws());
    let widths = pair.map(|m| m.visibility.resolution());
    let Some(camera) = agreement.seen.as_ref().and_then(|s| s.worst_camera).filter(|_| both_draw) else {
        return Ok(None);
    };
    if widths[0] != widths[1] {
        return Ok(None);
    }
    // A view of its own, so that the camera is the near one and its picture is not mirrored.
    let view = View::toward(comparing.cameras.directions()[camera], Window::around_sphere(widths[0]));
    let [a, b] = [drawn(pair[0], &view)?, drawn(pair[1], &view)?];
    let mut picture = Picture::filled(widths[0], widths[0], WHITE);
    for (pixel, (a, b)) in (0..).zip(a.into_iter().zip(b)) {
        if a != b || a.is_some() {
            let colour = if a == b { PALE } else { RED };
            picture.set(pixel % widths[0], widths[0] - 1 - pixel / widths[0], colour);
        }
    }
    Ok(Some(picture))
}

/// Colour of pixels on which both agree.
const PALE: [u8; 3] = [225; 3];

fn drawn(measurement: &Measurement<'_>, view: &View) -> Result<Vec<Option<Hit>>> {
    let mut buffers = ItemBufferPair::new(view.window);
    measurement.subject.machine().draw(view, &mut MachineScratch::default(), &mut buffers)?;
    Ok(buffers.near().collect())
}
