mod tables;

use std::path::{Path, PathBuf};

use glam::DVec3;
use serde::Serialize;

use crate::error::Result;
use crate::eval::geometric::{Distances, GeometricError, GeometricOptions, SampleCount};
use crate::eval::{Comparison, GreyError, Reference, TriangleQuality};
use crate::io::{self, ReadOptions};
use crate::mesh::TriMesh;
use crate::pipeline::Observer;
use crate::pipeline::observation::{Observation, Surrounded};
use crate::pipeline::page::{Exhibit, PageRequest, Show, section, shown_names};
use crate::pipeline::side_by_side::{ColumnOrder, Portrait, SideBySide};
use crate::pipeline::surroundings::Surroundings;
use crate::report::page::{Content, Section};
use crate::report::picture::Picture;
use crate::visibility::{MeasureOptions, Visibility};

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
    /// How visibility is measured: the reference's, which tells the error of visible surface from that of hidden surface,
    /// and for the page every mesh's.
    pub measure: MeasureOptions,
    /// Meshes in the same coordinates that hide what is looked at.
    pub occluders: Vec<PathBuf>,
    /// Where measurements are kept from run to run: a directory, or one file that ends in `.seen`.
    pub cache: Option<PathBuf>,
    /// Contact sheet to write, PNG.
    pub sheet: Option<PathBuf>,
    /// Upward in the sheet's pictures, any length but 0.
    pub up: [f64; 3],
    /// A page that shows the meshes and what differs.
    pub page: Option<PageRequest>,
    /// Replace outputs that are there.
    pub force: bool,
}

/// Result of [`compare_files`].
#[derive(Debug, Clone, Serialize)]
pub struct CompareReport {
    /// One entry per test.
    pub tests: Vec<TestReport>,
    /// Diagonal of the reference's box, model units.
    pub diagonal: f64,
    /// V of the reference.
    pub reference_visibility: f64,
    /// Whether the look was kept by an earlier run, `hit` or `miss`; `None` without a cache.
    pub cache: Option<&'static str>,
}

/// How one test differs from the reference.
#[derive(Debug, Clone, Serialize)]
pub struct TestReport {
    /// The file.
    pub file: PathBuf,
    /// Its triangles.
    pub triangles: usize,
    /// See [`crate::eval::ImageError::image_rms`].
    pub image_rms: f64,
    /// See [`crate::eval::ImageError::image_rmse`]; grey levels.
    pub image_rmse: f64,
    /// See [`crate::eval::ImageError::silhouette_xor`]; pixels per camera.
    pub silhouette_xor: f64,
    /// Distances between the surfaces, in % of the diagonal.
    pub geometric: GeometricReport,
    /// The same in model units.
    pub distances: GeometricReport,
    /// See [`crate::eval::ImageError::fixed_light`].
    pub fixed_light: GreyError,
    /// See [`crate::eval::ImageError::smooth`].
    pub smooth: GreyError,
    /// See [`crate::eval::ImageError::ssim`].
    pub ssim: f64,
    /// See [`crate::eval::ImageError::depth_rms`]; % of the diagonal.
    pub depth: Option<f64>,
    /// The same in model units.
    pub depth_rms: Option<f64>,
    /// Triangles that went wrong; degenerate ones include those that were set aside when the file was read.
    pub quality: TriangleQuality,
    /// Points whose distance was taken, both directions together.
    pub samples: u64,
}

/// Two-sided distances, all in one unit.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct GeometricReport {
    /// Mean, of the worse direction.
    pub mean: f64,
    /// Root mean square, of the worse direction.
    pub rms: f64,
    /// Largest.
    pub max: f64,
    /// From the reference to the test: what was lost.
    pub forward: Distances,
    /// From the test to the reference: what was made up.
    pub backward: Distances,
    /// `forward` over visible surface alone; `None` where nobody looked or nothing is visible.
    pub visible: Option<Distances>,
    /// `forward` over hidden surface alone; `None` where nobody looked or nothing is hidden.
    pub hidden: Option<Distances>,
    /// Root mean square of `forward` with visibility as the weight.
    pub weighted_rms: Option<f64>,
}

/// A mesh to compare, as read.
struct Test {
    mesh: TriMesh,
    /// Triangles of the file that were set aside: they have no area or repeat a vertex.
    set_aside: usize,
}

/// Compares meshes with a reference: pictures, silhouettes, distances, triangles.
///
/// # Errors
/// As its steps.
pub fn compare_files(request: &CompareRequest, observer: &dyn Observer) -> Result<CompareReport> {
    let read = |path: &PathBuf| {
        let loaded = io::read(path, &request.read)?;
        observer.mesh_read(path, &loaded)?;
        Ok(Test { mesh: loaded.mesh, set_aside: loaded.set_aside.count() })
    };
    let options = GeometricOptions {
        samples: request.samples.map_or(SampleCount::default(), SampleCount::Exactly),
        seed: request.seed,
    };
    let mesh = read(&request.reference)?.mesh;
    let tests: Vec<Test> = request.tests.iter().map(read).collect::<Result<_>>()?;
    let occluders = Surroundings::read(&request.occluders, &request.read)?;
    let (visibility, cache) = look(occluders.around(&mesh)?, request, observer)?;
    let reference = Reference::new(&mesh, Some(visibility.per_triangle()), options, observer)?;
    let comparisons: Vec<Comparison> =
        tests.iter().map(|test| reference.compare(&test.mesh, observer)).collect::<Result<_>>()?;
    drop(reference);
    let (reference_name, names) = request.shown_names();
    if let Some(sheet) = &request.sheet {
        let portrait = |name: &String, mesh, image_rmse| Portrait { name: name.clone(), mesh, image_rmse };
        let tests = names.iter().zip(&tests).zip(&comparisons);
        let tests = tests.map(|((name, test), found)| portrait(name, &test.mesh, Some(found.image.image_rmse)));
        let drawn = contact_sheet(portrait(&reference_name, &mesh, None), tests.collect(), request.up)?;
        io::write_atomic(sheet, request.force, |writer| drawn.write_png(writer))?;
    }
    let results = request.tests.iter().zip(&tests).zip(&comparisons);
    let report = CompareReport {
        tests: results.map(|((file, test), comparison)| TestReport::new(file, test, comparison)).collect(),
        diagonal: mesh.bounds().diagonal(),
        reference_visibility: visibility.of_mesh(),
        cache,
    };
    if let Some(page) = &request.page {
        let names = page.named(names);
        let show = Show {
            deed: "compared",
            original: Exhibit { name: reference_name.clone(), mesh: &mesh, visibility },
            results: exhibits(request, names.iter().zip(&tests), &occluders, observer)?,
            errors: comparisons.iter().map(|comparison| comparison.image).collect(),
            verdict: report.verdict(&names),
            columns: Vec::new(),
            sections: sections(&report, &reference_name, &names),
            measure: &request.measure,
            notes: Vec::new(),
        };
        show.write(page, request.force, observer)?;
    }
    Ok(report)
}

impl CompareRequest {
    /// What the reference and the tests are called in pictures and on the page.
    fn shown_names(&self) -> (String, Vec<String>) {
        let paths: Vec<&Path> = std::iter::once(&self.reference).chain(&self.tests).map(PathBuf::as_path).collect();
        let mut names = shown_names(&paths);
        (names.remove(0), names)
    }
}

/// The tests as the page shows them, each looked at among the same occluders.
fn exhibits<'a>(
    request: &CompareRequest,
    tests: impl Iterator<Item = (&'a String, &'a Test)>,
    occluders: &'a Surroundings,
    observer: &dyn Observer,
) -> Result<Vec<Exhibit<'a>>> {
    let look = |(name, test): (&String, &'a Test)| {
        Exhibit::look(name.clone(), occluders.around(&test.mesh)?, &request.measure, observer)
    };
    tests.map(look).collect()
}

/// V of the reference, and what of it a cache had.
fn look(
    scene: Surrounded<'_>,
    request: &CompareRequest,
    observer: &dyn Observer,
) -> Result<(Visibility, Option<&'static str>)> {
    let mut observation = Observation::of(scene, &request.measure, request.cache.as_deref(), observer)?;
    let visibility = observation.visibility(observer)?;
    observation.keep(&visibility, None)?;
    Ok((visibility, observation.reused()))
}

impl TestReport {
    fn new(file: &Path, test: &Test, comparison: &Comparison) -> Self {
        let Comparison { image, geometric, quality } = comparison;
        let percent = 100.0 / geometric.diagonal;
        Self {
            file: file.to_owned(),
            triangles: test.mesh.triangle_count(),
            image_rms: image.image_rms,
            image_rmse: image.image_rmse,
            silhouette_xor: image.silhouette_xor,
            geometric: GeometricReport::new(&geometric.times(percent)),
            distances: GeometricReport::new(geometric),
            fixed_light: image.fixed_light,
            smooth: image.smooth,
            ssim: image.ssim,
            depth: image.depth_rms.map(|rms| rms * percent),
            depth_rms: image.depth_rms,
            quality: TriangleQuality { degenerate: quality.degenerate + test.set_aside, ..*quality },
            samples: geometric.samples,
        }
    }
}

impl GeometricReport {
    fn new(error: &GeometricError) -> Self {
        let seen = error.seen;
        Self {
            mean: error.mean,
            rms: error.rms,
            max: error.max,
            forward: error.forward,
            backward: error.backward,
            visible: seen.and_then(|seen| seen.visible),
            hidden: seen.and_then(|seen| seen.hidden),
            weighted_rms: seen.and_then(|seen| seen.weighted_rms),
        }
    }
}

/// The tables of the page: a section for each.
fn sections(report: &CompareReport, reference: &str, names: &[String]) -> Vec<Section> {
    let bold = if names.len() > 1 { " Bold: the best of a column." } else { "" };
    let texts = [
        ("Difference of pictures", PICTURES),
        ("Distance of surfaces", DISTANCES),
        ("Triangles that went wrong", TRIANGLES),
    ];
    let tables = texts.into_iter().zip(report.tables(names));
    let tables = tables.map(|((heading, text), table)| {
        let text = text.replacen("REF", &format!("{reference} (REF)"), 1) + bold;
        section(heading, &text, Content::Table(table))
    });
    tables.collect()
}

const PICTURES: &str = "Pictures from 20 sides. Image error, root mean square in grey levels of 255: head light on flat triangles, \
    fixed light, smooth shading. SSIM: structural similarity, 1 is alike. Outline: pixels per picture, of 512 by 512, that only one \
    of the two outlines covers. Depth: in % of the diagonal.";
const DISTANCES: &str = "In % of the diagonal of REF. Mean, root mean square and largest, of the worse direction; then root mean \
    squares: from each mesh to the other, and from visible, from hidden and from all surface of REF, weighted by visibility.";
const TRIANGLES: &str = "Flipped: against the surface of REF nearest to them, and their share of the area. Edges: with three or more \
    triangles, and how many more than REF has.";

/// Pictures of the reference and of every test, with what differs in red.
fn contact_sheet(reference: Portrait<'_>, tests: Vec<Portrait<'_>>, up: [f64; 3]) -> Result<Picture> {
    let (title, subtitle, order, up) =
        (String::new(), String::new(), ColumnOrder::ReferenceFirst, DVec3::from_array(up));
    SideBySide { title, subtitle, reference, tests, order, up }.draw()
}

/// Where people stand in [`views_around`].
pub(super) const VIEW_NAMES: [&str; 3] = ["from the front", "from the back", "from below"];

/// Three views for people: from the front right above, from the back left above, from below. The front is toward z, as in
/// glTF, and toward x where z is up, as robots have it.
pub(super) fn views_around(up: DVec3) -> [DVec3; 3] {
    let up = up.normalize();
    let front = if up.z.abs() > 0.9 { DVec3::X } else { DVec3::Z };
    let right = up.cross(front).normalize();
    let front = right.cross(up);
    [1.0 * right + 1.3 * front + 0.8 * up, -1.3 * right - 1.0 * front + 0.6 * up, 0.4 * right - 0.9 * front - 0.9 * up]
        .map(DVec3::normalize)
}
