use std::path::{Path, PathBuf};

use glam::DVec3;
use serde::Serialize;

use crate::error::Result;
use crate::eval::geometric::{GeometricOptions, SampleCount, geometric_error};
use crate::eval::{ImageError, image_errors};
use crate::io::{self, ReadOptions};
use crate::mesh::TriMesh;
use crate::pipeline::Observer;
use crate::pipeline::observation::Surrounded;
use crate::pipeline::page::{Column, Exhibit, PageRequest, Show, shown_name};
use crate::pipeline::side_by_side::{ColumnOrder, Portrait, SideBySide};
use crate::report::picture::Picture;
use crate::visibility::MeasureOptions;

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
    /// A page that shows the meshes and what differs.
    pub page: Option<PageRequest>,
    /// How the page measures visibility.
    pub measure: MeasureOptions,
    /// Replace outputs that are there.
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
    let report = CompareReport { tests: reports.collect::<Result<_>>()? };
    if let Some(page) = &request.page {
        let show = show(&reference, &tests, request, observer)?;
        let show = Show { errors: images, columns: distances(&report.tests), ..show };
        show.write(page, request.force, observer)?;
    }
    Ok(report)
}

/// What a page shows of the meshes, each looked at by itself.
fn show<'a>(
    reference: &'a TriMesh,
    tests: &'a [TriMesh],
    request: &'a CompareRequest,
    observer: &dyn Observer,
) -> Result<Show<'a>> {
    let exhibit = |(path, mesh): (&PathBuf, &'a TriMesh)| {
        let alone = Surrounded { mesh, occluders: &[] };
        Exhibit::look(shown_name(path), alone, &request.measure, observer)
    };
    Ok(Show {
        deed: "compared",
        original: exhibit((&request.reference, reference))?,
        results: request.tests.iter().zip(tests).map(exhibit).collect::<Result<_>>()?,
        errors: Vec::new(),
        columns: Vec::new(),
        measure: &request.measure,
        notes: vec![
            "Distances between the surfaces are in % of the diagonal of the first mesh, hidden surface included."
                .to_owned(),
        ],
    })
}

fn distances(tests: &[TestReport]) -> Vec<Column> {
    let column = |head, of: fn(&GeometricReport) -> f64| {
        let cells = tests.iter().map(|test| format!("{:.4} %", of(&test.geometric))).collect();
        Column { head, cells }
    };
    vec![column("Mean distance", |g| g.mean), column("RMS distance", |g| g.rms), column("Largest", |g| g.max)]
}

/// Pictures of the reference and of every test, with what differs in red.
fn contact_sheet(
    reference: &TriMesh,
    tests: &[TriMesh],
    errors: &[ImageError],
    request: &CompareRequest,
) -> Result<Picture> {
    let portrait = |path: &Path, mesh, image_rmse| {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        Portrait { name, mesh, image_rmse }
    };
    let others = request.tests.iter().zip(tests).zip(errors);
    let sheet = SideBySide {
        title: String::new(),
        subtitle: String::new(),
        reference: portrait(&request.reference, reference, None),
        tests: others.map(|((path, mesh), error)| portrait(path, mesh, Some(error.image_rmse))).collect(),
        order: ColumnOrder::ReferenceFirst,
        up: DVec3::from_array(request.up),
    };
    sheet.draw()
}

/// Three views for people: from the front right above, from the back left above, from below.
pub(super) fn views_around(up: DVec3) -> [DVec3; 3] {
    let up = up.normalize();
    let right = up.any_orthonormal_vector();
    let front = right.cross(up);
    [1.0 * right + 1.3 * front + 0.8 * up, -1.3 * right - 1.0 * front + 0.6 * up, 0.4 * right - 0.9 * front - 0.9 * up]
        .map(DVec3::normalize)
}
