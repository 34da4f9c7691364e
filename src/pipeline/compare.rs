use std::path::{Path, PathBuf};

use glam::DVec3;
use serde::Serialize;

use super::{Observer, as_progress, read};
use crate::error::Result;
use crate::eval::geometric::{Distances, GeometricOptions, SampleCount, geometric_error};
use crate::eval::{Gallery, ImageError, image_errors};
use crate::io::{self, ReadOptions};
use crate::mesh::TriMesh;
use crate::raster::GreyImage;
use crate::report::contact_sheet::{Column, ContactSheet, Images, mesh_caption};

/// Directions that the contact sheet looks from, one row each: the front, the back, and from below.
const SHEET_CAMERAS: [DVec3; 3] = [DVec3::new(1.0, -2.0, 1.0), DVec3::new(-1.5, 2.0, 1.2), DVec3::new(0.8, 1.0, -1.5)];

/// Pixels along the side of an image on the contact sheet.
const SHEET_IMAGE: u32 = 360;

/// What [`compare_files`] does.
#[derive(Debug, Clone)]
pub struct CompareRequest {
    /// The mesh that the others are compared with.
    pub reference: PathBuf,
    /// The others.
    pub tests: Vec<PathBuf>,
    /// How they are read.
    pub read: ReadOptions,
    /// Samples on each mesh for the geometric error; `None` takes ten per triangle of the reference.
    pub samples: Option<u64>,
    /// Seed of the samples.
    pub seed: u64,
    /// Contact sheet to write, a PNG.
    pub sheet: Option<PathBuf>,
    /// Replace a sheet that is there.
    pub force: bool,
}

/// What [`compare_files`] found; its fields are the keys of the JSON object.
#[derive(Debug, Clone, Serialize)]
pub struct CompareReport {
    /// One entry per test.
    pub tests: Vec<TestReport>,
    /// The reference.
    pub reference: PathBuf,
    /// Its triangles.
    pub reference_triangles: usize,
}

/// How far one test is from the reference.
#[derive(Debug, Clone, Serialize)]
pub struct TestReport {
    /// The file.
    pub file: PathBuf,
    /// Its triangles.
    pub triangles: usize,
    /// Square root of the sum of squared grey differences over all views. Source: Zhang & Turk 2002, eq. (5.11).
    pub image_rms: f64,
    /// The same per pixel, in grey levels.
    pub image_rmse: f64,
    /// Pixels per view that one mesh covers and the other does not.
    pub silhouette_xor: f64,
    /// Two-sided sampled distances, in % of the diagonal of the reference's box.
    pub geometric: Distances,
}

/// Compares meshes with a reference, in pictures and in space.
///
/// # Errors
/// Those of reading, comparing and writing, and of the observer.
pub fn compare_files(request: &CompareRequest, observer: &dyn Observer) -> Result<CompareReport> {
    let progress = as_progress(observer);
    let load = |path: &PathBuf| Ok(read(path, &request.read, observer)?.mesh);
    let reference: TriMesh = load(&request.reference)?;
    let tests: Vec<TriMesh> = request.tests.iter().map(load).collect::<Result<_>>()?;

    let images = image_errors(&reference, &tests.iter().collect::<Vec<_>>(), progress)?;
    let samples = request.samples.map_or_else(SampleCount::default, SampleCount::Exactly);
    let options = GeometricOptions { samples, seed: request.seed };
    let distance = |test: &TriMesh| Ok(geometric_error(&reference, test, options, progress)?.percent());
    let distances: Vec<Distances> = tests.iter().map(distance).collect::<Result<_>>()?;

    if let Some(path) = &request.sheet {
        write_sheet(path, request, &reference, &tests, &images)?;
    }
    let report = |(i, test): (usize, &TriMesh)| TestReport {
        file: request.tests[i].clone(),
        triangles: test.triangle_count(),
        image_rms: images[i].image_rms,
        image_rmse: images[i].image_rmse,
        silhouette_xor: images[i].silhouette_xor,
        geometric: distances[i],
    };
    Ok(CompareReport {
        tests: tests.iter().enumerate().map(report).collect(),
        reference: request.reference.clone(),
        reference_triangles: reference.triangle_count(),
    })
}

/// Reference, then each test and its difference from the reference, as columns of a PNG.
fn write_sheet(
    path: &Path,
    request: &CompareRequest,
    reference: &TriMesh,
    tests: &[TriMesh],
    errors: &[ImageError],
) -> Result<()> {
    let original = pictures(reference, reference)?;
    let others: Vec<Vec<GreyImage>> = tests.iter().map(|test| pictures(test, reference)).collect::<Result<_>>()?;
    let mut columns = vec![Column {
        heading: name(&request.reference),
        caption: mesh_caption(reference.triangle_count(), None),
        images: Images::Shaded(original.iter().map(|p| p.pixels.as_slice()).collect()),
    }];
    for (i, other) in others.iter().enumerate() {
        columns.push(Column {
            heading: name(&request.tests[i]),
            caption: mesh_caption(tests[i].triangle_count(), Some(errors[i].image_rmse)),
            images: Images::Shaded(other.iter().map(|p| p.pixels.as_slice()).collect()),
        });
        columns.push(Column {
            heading: "difference".to_owned(),
            caption: format!("{} against {}", name(&request.tests[i]), name(&request.reference)),
            images: Images::Difference(
                original.iter().zip(other).map(|(a, b)| [a.pixels.as_slice(), b.pixels.as_slice()]).collect(),
            ),
        });
    }
    let sheet = ContactSheet { columns, image_size: [SHEET_IMAGE; 2], ..ContactSheet::default() };
    let picture = sheet.draw()?;
    io::write_atomic(path, request.force, |out| picture.write_png(out))
}

fn pictures(mesh: &TriMesh, reference: &TriMesh) -> Result<Vec<GreyImage>> {
    let gallery = Gallery::new(mesh, reference);
    let picture = |toward: &DVec3| gallery.picture(toward.normalize(), DVec3::Z, SHEET_IMAGE);
    SHEET_CAMERAS.iter().map(picture).collect()
}

/// The file's name without directories and endings.
fn name(path: &Path) -> String {
    let file = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_else(|| "-".to_owned());
    file.split('.').next().filter(|stem| !stem.is_empty()).unwrap_or(&file).to_owned()
}
