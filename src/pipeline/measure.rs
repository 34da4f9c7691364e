use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::error::Result;
use crate::io::{self, Attributes, Format, Loaded, ReadOptions, WriteOptions};
use crate::pipeline::diagram::Record;
use crate::pipeline::observation::Observation;
use crate::pipeline::page::{Exhibit, PageRequest, Show, shown_name, shown_names};
use crate::pipeline::surroundings::Surroundings;
use crate::pipeline::{Clock, DiagramRequest, Observer};
use crate::report::colour::ColourMap;
use crate::visibility::{MeasureOptions, Rescue, StandardError, Visibility, per_vertex};

/// What [`measure_file`] does.
#[derive(Debug, Clone)]
pub struct MeasureRequest {
    /// The mesh.
    pub input: PathBuf,
    /// How it is read.
    pub read: ReadOptions,
    /// How it is looked at.
    pub measure: MeasureOptions,
    /// Meshes in the same coordinates that hide and are not measured.
    pub occluders: Vec<PathBuf>,
    /// A mesh file (PLY carries visibility and heat colours, GLB the colours), `.npy` or `.csv` to write.
    pub output: Option<PathBuf>,
    /// Which camera sees which triangle, to be written too.
    pub diagram: Option<DiagramRequest>,
    /// Heat colours in a PLY or GLB output.
    pub colour_map: ColourMap,
    /// Where measurements are kept from run to run: a directory, or one file that ends in `.seen`. A run that writes a
    /// diagram leaves it alone.
    pub cache: Option<PathBuf>,
    /// A page that shows what was measured.
    pub page: Option<PageRequest>,
    /// Replace outputs that are there.
    pub force: bool,
}

/// Result of [`measure_file`].
#[derive(Debug, Clone, Serialize)]
pub struct MeasureReport {
    /// Triangles looked at.
    pub triangles: usize,
    /// Cameras; `None` where rays went in random directions.
    pub cameras: Option<usize>,
    /// Pixels along an image's side; `None` where rays were cast instead.
    pub resolution: Option<u32>,
    /// Who looked.
    pub backend: &'static str,
    /// What was counted.
    pub estimator: &'static str,
    /// The numbers.
    pub visibility: VisibilitySummary,
    /// Where the time went.
    pub seconds: MeasureSeconds,
    /// Which side of a triangle made its visibility.
    pub sides: &'static str,
    /// Rays that were cast; 0 where pictures were drawn.
    pub rays: u64,
    /// How exact the numbers are, where the estimator can say it.
    pub standard_error: Option<ErrorSummary>,
    /// Triangles of occluders.
    pub occluder_triangles: usize,
    /// Pieces that the triangles were cut into, under the estimator `item-buffer`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub subdivided: Option<usize>,
    /// How often depth stood in for a pixel, under the estimator `item-buffer`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rescue: Option<RescueSummary>,
    /// `hit` where an earlier run had kept the look, else `miss`; `None` without a cache.
    pub cache: Option<&'static str>,
}

/// How exact a measurement is.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct ErrorSummary {
    /// Standard error of V(M), one-sided.
    pub mesh: f64,
    /// Standard error of the triangle that 99 of 100 are more exact than.
    pub p99: f64,
    /// Rays cast from each side of a triangle.
    pub samples: u32,
    /// Why there were not more: `samples` as asked, `target` reached, `most_samples` that are allowed.
    pub end: &'static str,
}

impl From<&StandardError> for ErrorSummary {
    fn from(error: &StandardError) -> Self {
        Self { mesh: error.of_mesh, p99: error.p99, samples: error.samples, end: error.end.name() }
    }
}

/// Pairs of a piece and a camera that the piece faces: how many without a pixel were rescued.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct RescueSummary {
    /// Pairs without a pixel.
    pub without_pixel: u64,
    /// Those of them that count as seen.
    pub rescued: u64,
    /// The share of the rescued among all that count as seen.
    pub rate: f64,
    /// The rescued that were asked again by rays.
    pub leak_sampled: u64,
    /// The share of these that are hidden after all.
    pub leak_rate: Option<f64>,
    /// Why there is no such share.
    pub leak_unmeasured: Option<&'static str>,
}

impl From<Rescue> for RescueSummary {
    fn from(rescue: Rescue) -> Self {
        Self {
            without_pixel: rescue.without_pixel,
            rescued: rescue.rescued,
            rate: rescue.rate(),
            leak_sampled: rescue.leaks.map_or(0, |leaks| leaks.sampled),
            leak_rate: rescue.leaks.and_then(|leaks| leaks.rate()),
            leak_unmeasured: match rescue.leaks {
                None => Some("it takes rays, and Embree is not there"),
                Some(leaks) if leaks.sampled == 0 => Some("nothing was rescued"),
                Some(_) => None,
            },
        }
    }
}

/// Visibility of a whole mesh.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct VisibilitySummary {
    /// V(M), one-sided. Source: Zhang & Turk 2002, eq. (3.2).
    pub mesh: f64,
    /// The same under the rule for sides.
    pub mesh_sides: f64,
    /// Triangles that no camera sees.
    pub never_seen: usize,
}

/// Seconds of wall time per step.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct MeasureSeconds {
    /// Reading and checking the file.
    pub read: f64,
    /// Preparing to look.
    pub build: f64,
    /// Looking.
    pub visibility: f64,
    /// All of it, writing included.
    pub total: f64,
}

/// Reads a mesh, looks at it, writes how visible each triangle is.
///
/// # Errors
/// As its steps.
pub fn measure_file(request: &MeasureRequest, observer: &dyn Observer) -> Result<MeasureReport> {
    let mut clock = Clock::start();
    request.measure.check()?;
    let occluders = Surroundings::read(&request.occluders, &request.read)?;
    request.diagram.as_ref().map_or(Ok(()), |diagram| diagram.check(&request.measure))?;
    let loaded = io::read(&request.input, &request.read)?;
    observer.mesh_read(&request.input, &loaded)?;
    let read = clock.lap();
    // A cache keeps no diagram: who wants one must look.
    let cache = request.cache.as_deref().filter(|_| request.diagram.is_none());
    let mut observation = Observation::of(occluders.around(&loaded.mesh)?, &request.measure, cache, observer)?;
    let build = clock.lap();
    let (visibility, record) = look(&mut observation, request, observer)?;
    let looked = clock.lap();
    observation.keep(&visibility, None)?;
    if let Some(output) = &request.output {
        write(output, &loaded, &visibility, request)?;
    }
    if let (Some(record), Some(diagram)) = (record, &request.diagram) {
        record.write(&loaded, observation.subject()?, &diagram.output, request.force)?;
    }
    if let Some(page) = &request.page {
        let name = shown_name(&request.input);
        show(Exhibit { name, mesh: &loaded.mesh, visibility: visibility.clone() }, request).write(
            page,
            request.force,
            observer,
        )?;
    }
    Ok(MeasureReport {
        triangles: loaded.mesh.triangle_count(),
        cameras: Some(visibility.cameras()).filter(|&n| n > 0),
        resolution: Some(visibility.resolution()).filter(|&n| n > 0),
        backend: request.measure.backend.name(),
        estimator: request.measure.estimator.name(),
        sides: request.measure.sides.name(),
        occluder_triangles: occluders.triangle_count(),
        cache: observation.reused(),
        visibility: VisibilitySummary {
            mesh: visibility.of_mesh(),
            mesh_sides: visibility.of_mesh_sides(),
            never_seen: visibility.never_seen(),
        },
        subdivided: visibility.details().pieces,
        rescue: visibility.details().rescue.map(Into::into),
        seconds: MeasureSeconds { read, build, visibility: looked, total: clock.total() },
        rays: visibility.details().rays,
        standard_error: visibility.details().standard_error.as_ref().map(ErrorSummary::from),
    })
}

/// What a page shows of a measurement.
fn show<'a>(original: Exhibit<'a>, request: &'a MeasureRequest) -> Show<'a> {
    Show {
        deed: "measured",
        original,
        results: Vec::new(),
        errors: Vec::new(),
        verdict: String::new(),
        columns: Vec::new(),
        sections: Vec::new(),
        measure: &request.measure,
        notes: hiding_too(&request.occluders),
    }
}

/// A sentence about occluders, where there are any.
pub(super) fn hiding_too(occluders: &[PathBuf]) -> Vec<String> {
    let names = shown_names(&occluders.iter().map(PathBuf::as_path).collect::<Vec<_>>());
    if names.is_empty() {
        Vec::new()
    } else {
        vec![format!("Hidden also by {}, which is not shown.", names.join(", "))]
    }
}

fn look(
    observation: &mut Observation<'_>,
    request: &MeasureRequest,
    observer: &dyn Observer,
) -> Result<(Visibility, Option<Record>)> {
    match &request.diagram {
        None => Ok((observation.visibility(observer)?, None)),
        Some(diagram) => {
            let subject = observation.subject()?;
            let (visibility, record) = Record::look(subject, &request.measure, diagram.fractions, observer)?;
            Ok((visibility, Some(record)))
        }
    }
}

fn write(path: &Path, loaded: &Loaded, visibility: &Visibility, request: &MeasureRequest) -> Result<()> {
    let values = visibility.per_triangle();
    match path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("npy") => io::write_npy_f64(path, &loaded.in_file_order(values, 0.0), request.force),
        Some("csv") => {
            let columns = [values, visibility.front(), visibility.back()].map(|v| loaded.in_file_order(v, 0.0));
            let named = ["visibility", "front", "back"].into_iter().zip(columns.iter().map(Vec::as_slice));
            io::write_visibility_csv(path, &named.collect::<Vec<_>>(), request.force)
        }
        _ => {
            let colours: Vec<[u8; 3]> = values.iter().map(|&v| request.colour_map.colour(v)).collect();
            let quality = per_vertex(&loaded.mesh, values);
            let colours = Some(&colours[..]);
            let attributes = match Format::of_path(path) {
                Some(Format::Glb) => Attributes { colours, ..Attributes::default() },
                _ => Attributes { visibility: Some(values), colours, vertex_quality: Some(&quality) },
            };
            io::write(path, &loaded.mesh, &attributes, &WriteOptions { force: request.force, format: None })
        }
    }
}
