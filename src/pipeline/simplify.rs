use std::borrow::Cow;
use std::path::PathBuf;

use serde::Serialize;

use super::{Observer, Stopwatch, VisibilitySummary, as_progress, dropped_names, read};
use crate::camera::{CameraSphere, Frame};
use crate::error::Result;
use crate::io::{self, Format, ReadOptions, TriangleAttributes, WriteOptions};
use crate::mesh::TriMesh;
use crate::raster::Scene;
use crate::simplify::{self, Level, SimplifyOptions, Stop, Target};
use crate::visibility::{self, Hidden, MeasureOptions, Visibility, hidden_triangles};

/// What orders the collapses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Metric {
    /// Quadric error weighted by visibility (VG).
    #[default]
    Visibility,
    /// Quadric error alone (QB).
    Quadric,
}

impl Metric {
    /// The name on the command line and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Visibility => "visibility",
            Self::Quadric => "quadric",
        }
    }
}

/// One level of detail to make.
#[derive(Debug, Clone)]
pub struct LevelRequest {
    /// The one that asks for most triangles ends the level; empty only with an error bound.
    pub targets: Vec<Target>,
    /// Where it goes; `-` is standard output.
    pub output: PathBuf,
}

/// What [`run_simplify`] does.
#[derive(Debug, Clone)]
pub struct SimplifyRequest {
    /// The mesh.
    pub input: PathBuf,
    /// How it is read.
    pub read: ReadOptions,
    /// What orders the collapses.
    pub metric: Metric,
    /// How visibility is measured; only where `metric` or `hidden` needs it.
    pub measure: MeasureOptions,
    /// What becomes of triangles that nobody sees. Under [`Metric::Quadric`], `Keep` and `Collapse` change nothing.
    pub hidden: Hidden,
    /// p in V^p, the weight of a triangle's error.
    pub visibility_power: f64,
    /// How edges collapse; its targets are replaced by those of `levels`.
    pub simplify: SimplifyOptions,
    /// Levels of detail, each at most as large as the one before.
    pub levels: Vec<LevelRequest>,
    /// Format of the outputs, where their names do not say it.
    pub format: Option<Format>,
    /// Replace outputs that are there.
    pub force: bool,
}

/// What [`run_simplify`] made; its fields are the keys of the JSON object.
#[derive(Debug, Clone, Serialize)]
pub struct SimplifyReport {
    /// One entry per level.
    pub levels: Vec<LevelReport>,
    /// Triangles given.
    pub triangles: usize,
    /// What ordered the collapses.
    pub metric: &'static str,
    /// Where the time went.
    pub seconds: SimplifySeconds,
    /// What happened to triangles that nobody sees.
    pub hidden: &'static str,
    /// How many of them were deleted before simplifying.
    pub hidden_deleted: usize,
    /// Visibility of the mesh given, where it was measured.
    pub visibility: Option<VisibilitySummary>,
    /// Triangles of the file that were set aside.
    pub set_aside: usize,
    /// What the file held beyond triangles.
    pub dropped: Vec<&'static str>,
}

/// One level of detail, as made.
#[derive(Debug, Clone, Serialize)]
pub struct LevelReport {
    /// Triangles asked for; `None` where only an error bound was given.
    pub target: Option<usize>,
    /// Triangles reached.
    pub output: usize,
    /// Why it stopped: `target`, `error` or `queue_empty`.
    pub stop: &'static str,
    /// Largest root mean square distance of a collapse, in model units.
    pub error: f64,
    /// The file.
    pub file: PathBuf,
    /// What changed in the topology, against the mesh without deleted triangles.
    pub topology: TopologyReport,
}

/// What changed in the topology, result minus input.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct TopologyReport {
    /// Pairs of triangles back to back that were cancelled.
    pub cancelled_pairs: usize,
    /// Edges with three or more triangles.
    pub non_manifold_edges: i64,
    /// Connected components.
    pub components: i64,
    /// Border edges.
    pub boundary_edges: i64,
    /// Euler characteristic.
    pub euler_characteristic: i64,
}

/// Wall time of each step, in seconds.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct SimplifySeconds {
    /// Reading and checking the file.
    pub read: f64,
    /// Measuring visibility and finding what is hidden.
    pub visibility: f64,
    /// Collapsing.
    pub simplify: f64,
    /// Writing.
    pub write: f64,
    /// All of it.
    pub total: f64,
}

/// Reads a mesh, looks at it, simplifies it where nobody looks, writes every level.
///
/// # Errors
/// Those of reading, measuring, simplifying and writing, and of the observer.
pub fn run_simplify(request: &SimplifyRequest, observer: &dyn Observer) -> Result<SimplifyReport> {
    let mut clock = Stopwatch::start();
    let mut seconds = SimplifySeconds::default();

    let loaded = read(&request.input, &request.read, observer)?;
    let given = loaded.mesh.triangle_count();
    let options = options(request, given);
    options.check()?;
    seconds.read = clock.lap_s();

    let seen = look(&loaded.mesh, request, observer)?;
    let work = weigh(&loaded.mesh, seen.as_ref(), request)?;
    let hidden_deleted = given - work.mesh.triangle_count();
    if hidden_deleted > 0 {
        observer.hidden_deleted(hidden_deleted, given)?;
    }
    seconds.visibility = clock.lap_s();

    let levels = simplify::simplify(&work.mesh, work.importance.as_deref(), &options, as_progress(observer))?;
    seconds.simplify = clock.lap_s();

    write(&levels, request, observer)?;
    seconds.write = clock.lap_s();
    seconds.total = clock.total_s();
    Ok(SimplifyReport {
        levels: levels.iter().zip(&request.levels).map(|(level, asked)| report(level, asked)).collect(),
        triangles: given,
        metric: request.metric.name(),
        seconds,
        hidden: request.hidden.name(),
        hidden_deleted,
        visibility: seen.as_ref().map(|s| VisibilitySummary::of(&s.visibility)),
        set_aside: loaded.set_aside.count(),
        dropped: dropped_names(&loaded),
    })
}

/// The collapser's options, with one count per level: of several targets the one reached first, which is the largest.
fn options(request: &SimplifyRequest, given: usize) -> SimplifyOptions {
    let largest = |level: &LevelRequest| level.targets.iter().map(|target| target.count(given)).max();
    let targets = request.levels.iter().filter_map(largest).map(Target::Triangles).collect();
    request.simplify.clone().with_targets(targets)
}

/// What looking at a mesh found.
struct Seen {
    visibility: Visibility,
    /// Triangles to delete, where that was asked.
    hidden: Option<Vec<bool>>,
}

fn look(mesh: &TriMesh, request: &SimplifyRequest, observer: &dyn Observer) -> Result<Option<Seen>> {
    let deletes = request.hidden == Hidden::Delete;
    if request.metric == Metric::Quadric && !deletes {
        return Ok(None);
    }
    let (options, progress) = (&request.measure, as_progress(observer));
    options.check()?;
    let cameras = CameraSphere::octahedral(options.cameras, options.camera_weights)?;
    let scene = Scene::new(Frame::of(mesh).unit_copy(mesh));
    let visibility = visibility::measure_with(&scene, mesh, &cameras, options, progress)?;
    let hidden = if deletes { Some(hidden_triangles(&scene, mesh, &visibility, options, progress)?) } else { None };
    Ok(Some(Seen { visibility, hidden }))
}

/// The mesh to simplify, and how much the error of each of its triangles counts.
struct Work<'a> {
    mesh: Cow<'a, TriMesh>,
    importance: Option<Vec<f64>>,
}

fn weigh<'a>(mesh: &'a TriMesh, seen: Option<&Seen>, request: &SimplifyRequest) -> Result<Work<'a>> {
    let Some(seen) = seen else { return Ok(Work { mesh: Cow::Borrowed(mesh), importance: None }) };
    let all = match request.metric {
        Metric::Visibility => Some(visibility::importance(&seen.visibility, request.hidden, request.visibility_power)?),
        Metric::Quadric => None,
    };
    let some_hidden = seen.hidden.as_ref().filter(|hidden| hidden.contains(&true));
    let part = some_hidden.and_then(|hidden| Some((hidden, mesh.subset(|t| !hidden[t])?)));
    Ok(match part {
        None => Work { mesh: Cow::Borrowed(mesh), importance: all },
        Some((hidden, part)) => {
            let kept = |all: Vec<f64>| all.iter().zip(hidden).filter(|(_, h)| !**h).map(|(&w, _)| w).collect();
            Work { mesh: Cow::Owned(part.mesh), importance: all.map(kept) }
        }
    })
}

fn write(levels: &[Level], request: &SimplifyRequest, observer: &dyn Observer) -> Result<()> {
    let options = WriteOptions { force: request.force, format: request.format };
    for (level, asked) in levels.iter().zip(&request.levels) {
        observer.check()?;
        io::write(&asked.output, &level.mesh, &TriangleAttributes::default(), &options)?;
    }
    Ok(())
}

fn report(level: &Level, asked: &LevelRequest) -> LevelReport {
    let change = level.topology;
    LevelReport {
        target: level.target,
        output: level.mesh.triangle_count(),
        stop: match level.stop {
            Stop::Target => "target",
            Stop::Error => "error",
            Stop::QueueEmpty => "queue_empty",
        },
        error: level.error,
        file: asked.output.clone(),
        topology: TopologyReport {
            cancelled_pairs: change.cancelled_pairs,
            non_manifold_edges: change.non_manifold_edges,
            components: change.components,
            boundary_edges: change.boundary_edges,
            euler_characteristic: change.euler_characteristic,
        },
    }
}
