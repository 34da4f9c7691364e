use std::path::PathBuf;

use glam::DVec3;
use serde::Serialize;

use crate::error::Result;
use crate::eval::geometric::{GeometricOptions, SampleCount, geometric_error};
use crate::eval::{Gallery, ImageError, Shot, image_errors};
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
    let shots = views_around(up).map(|toward| Shot::fitting(reference, toward, up, PICTURE_WIDTH));
    let original = Sheet::of(reference, reference, &shots)?;
    let others: Vec<Sheet> = tests.iter().map(|test| Sheet::of(test, reference, &shots)).collect::<Result<_>>()?;
    let name = |path: &PathBuf| path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let mut columns = vec![Column {
        heading: name(&request.reference),
        caption: mesh_caption(reference.triangle_count(), None),
        images: original.shown(),
    }];
    for (((path, mesh), error), pictures) in request.tests.iter().zip(tests).zip(errors).zip(&others) {
        let (heading, caption) = (name(path), mesh_caption(mesh.triangle_count(), Some(error.image_rmse)));
        columns.push(Column { heading, caption, images: pictures.shown() });
        let (heading, caption) = ("difference".to_owned(), String::new());
        columns.push(Column { heading, caption, images: original.difference(pictures) });
    }
    ContactSheet { image_size: [PICTURE_WIDTH; 2], columns, ..ContactSheet::default() }.draw()
}

/// The pictures of one mesh: over white to be looked at, over black, as the image error sees them, to be compared.
struct Sheet {
    white: Vec<GreyImage>,
    black: Vec<GreyImage>,
}

impl Sheet {
    fn of(mesh: &TriMesh, reference: &TriMesh, shots: &[Shot]) -> Result<Self> {
        let gallery = Gallery::new(mesh, reference);
        let over = |background: f64| -> Result<Vec<GreyImage>> {
            shots.iter().map(|shot| gallery.picture(shot, background)).collect()
        };
        Ok(Self { white: over(255.0)?, black: over(0.0)? })
    }

    fn shown(&self) -> Images<'_> {
        Images::Shaded(self.white.iter().map(|image| image.pixels.as_slice()).collect())
    }

    fn difference<'a>(&'a self, other: &'a Self) -> Images<'a> {
        let pairs = self.black.iter().zip(&other.black);
        Images::Difference(pairs.map(|(a, b)| [a.pixels.as_slice(), b.pixels.as_slice()]).collect())
    }
}

/// Three views for people: from the front right above, from the back left above, from below.
pub(super) fn views_around(up: DVec3) -> [DVec3; 3] {
    let up = up.normalize();
    let right = up.any_orthonormal_vector();
    let front = right.cross(up);
    [1.0 * right + 1.3 * front + 0.8 * up, -1.3 * right - 1.0 * front + 0.6 * up, 0.4 * right - 0.9 * front - 0.9 * up]
        .map(DVec3::normalize)
}
