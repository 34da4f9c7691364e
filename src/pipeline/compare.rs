use std::path::PathBuf;

use glam::DVec3;
use serde::Serialize;

use crate::error::Result;
use crate::eval::geometric::{GeometricOptions, SampleCount, geometric_error};
use crate::eval::{Gallery, ImageError, fitting_half_width, image_errors};
use crate::io::{self, ReadOptions};
use crate::mesh::TriMesh;
use crate::pipeline::Observer;
use crate::raster::GreyImage;
use crate::report::contact_sheet::{Column, ContactSheet, Images, mesh_caption};

/// What [`compare_files`] does.
#[derive(Debug, Clone)]
pub struct CompareRequest {
    /// What the others are compared with.
    pub reference: PathBuf,
    /// The others.
    pub tests: Vec<PathBuf>,
    /// How they are read.
    pub read: ReadOptions,
    /// Samples on each mesh for the geometric error; `None` chooses.
    pub samples: Option<u64>,
    /// Seed of the samples.
    pub seed: u64,
    /// Contact sheet to write, PNG.
    pub sheet: Option<PathBuf>,
    /// Upward in the sheet's pictures, any length but 0.
    pub up: [f64; 3],
    /// Replace a sheet that is there.
    pub force: bool,
}

/// Result of [`compare_files`].
#[derive(Debug, Clone, Serialize)]
pub struct CompareReport {
    /// One entry per test.
    pub tests: Vec<TestReport>,
}

/// How one test differs from the reference.
#[derive(Debug, Clone, Serialize)]
pub struct TestReport {
    /// The file.
    pub file: PathBuf,
    /// Its triangles.
    pub triangles: usize,
    /// See [`ImageError::image_rms`].
    pub image_rms: f64,
    /// See [`ImageError::image_rmse`]; grey levels.
    pub image_rmse: f64,
    /// See [`ImageError::silhouette_xor`]; pixels per camera.
    pub silhouette_xor: f64,
    /// Distances between the surfaces.
    pub geometric: GeometricReport,
}

/// Two-sided distances in % of the diagonal of the reference's box.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct GeometricReport {
    /// Mean, of the worse direction.
    pub mean: f64,
    /// Root mean square, of the worse direction.
    pub rms: f64,
    /// Largest.
    pub max: f64,
}

/// Compares meshes with a reference: pictures, silhouettes, distances.
///
/// # Errors
/// As its steps.
pub fn compare_files(request: &CompareRequest, observer: &dyn Observer) -> Result<CompareReport> {
    let read = |path: &PathBuf| {
        let loaded = io::read(path, &request.read)?;
        observer.mesh_read(path, &loaded)?;
        Ok(loaded.mesh)
    };
    let reference = read(&request.reference)?;
    let tests: Vec<TriMesh> = request.tests.iter().map(read).collect::<Result<_>>()?;
    let images = image_errors(&reference, &tests.iter().collect::<Vec<_>>(), observer)?;
    if let Some(sheet) = &request.sheet {
        let drawn = contact_sheet(&reference, &tests, &images, request)?;
        io::write_atomic(sheet, request.force, |writer| drawn.write_png(writer))?;
    }
    let options = GeometricOptions {
        samples: request.samples.map_or(SampleCount::default(), SampleCount::Exactly),
        seed: request.seed,
    };
    let report = |((file, mesh), image): ((&PathBuf, &TriMesh), &ImageError)| {
        let distance = geometric_error(&reference, mesh, options, observer)?.percent();
        Ok(TestReport {
            file: file.clone(),
            triangles: mesh.triangle_count(),
            image_rms: image.image_rms,
            image_rmse: image.image_rmse,
            silhouette_xor: image.silhouette_xor,
            geometric: GeometricReport { mean: distance.mean, rms: distance.rms, max: distance.max },
        })
    };
    let reports = request.tests.iter().zip(&tests).zip(&images).map(report);
    Ok(CompareReport { tests: reports.collect::<Result<_>>()? })
}

/// Pixels along the side of a picture on the sheet.
const PICTURE_WIDTH: u32 = 400;

/// Pictures of the reference and of every test, with what differs in red.
fn contact_sheet(
    reference: &TriMesh,
    tests: &[TriMesh],
    errors: &[ImageError],
    request: &CompareRequest,
) -> Result<crate::report::picture::Picture> {
    let up = DVec3::from_array(request.up);
    let directions = views_around(up);
    let pictures = |mesh: &TriMesh| -> Result<Vec<GreyImage>> {
        let gallery = Gallery::new(mesh, reference);
        let reach = |toward: DVec3| fitting_half_width(reference, toward, up);
        directions.iter().map(|&toward| gallery.picture(toward, up, PICTURE_WIDTH, reach(toward))).collect()
    };
    let original = pictures(reference)?;
    let others: Vec<Vec<GreyImage>> = tests.iter().map(pictures).collect::<Result<_>>()?;
    let name = |path: &PathBuf| path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let mut columns = vec![Column {
        heading: name(&request.reference),
        caption: mesh_caption(reference.triangle_count(), None),
        images: Images::Shaded(original.iter().map(|image| image.pixels.as_slice()).collect()),
    }];
    for (((path, mesh), error), images) in request.tests.iter().zip(tests).zip(errors).zip(&others) {
        let pairs = original.iter().zip(images).map(|(a, b)| [a.pixels.as_slice(), b.pixels.as_slice()]);
        columns.push(Column {
            heading: name(path),
            caption: mesh_caption(mesh.triangle_count(), Some(error.image_rmse)),
            images: Images::Shaded(images.iter().map(|image| image.pixels.as_slice()).collect()),
        });
        columns.push(Column {
            heading: "difference".to_owned(),
            caption: String::new(),
            images: Images::Difference(pairs.collect()),
        });
    }
    ContactSheet { image_size: [PICTURE_WIDTH; 2], columns, ..ContactSheet::default() }.draw()
}

/// Three views for people: from the front right above, from the back left above, from below.
fn views_around(up: DVec3) -> [DVec3; 3] {
    let up = up.normalize();
    let right = up.any_orthonormal_vector();
    let front = right.cross(up);
    [1.0 * right + 1.3 * front + 0.8 * up, -1.3 * right - 1.0 * front + 0.6 * up, 0.4 * right - 0.9 * front - 0.9 * up]
        .map(DVec3::normalize)
}
