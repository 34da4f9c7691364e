mod page;

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::io::{Format, ReadOptions};
use crate::mesh::{Remainder, TriMesh, compose_maps};
use crate::pipeline::Observer;
use crate::pipeline::page::PageRequest;
use crate::simplify::{Level, SimplifyOptions, Stop, Target, Topology, TopologyChange, simplify};
use crate::visibility::{Hidden, Look, MeasureOptions, importance};
pub(super) use page::{Before, show};

/// What orders the collapses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
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
    /// The first one reached ends the level; empty only with an error bound.
    pub targets: Vec<Target>,
    /// Where it goes.
    pub output: PathBuf,
}

/// What [`super::run_simplify`] does.
#[derive(Debug, Clone)]
pub struct SimplifyRequest {
    /// The mesh.
    pub input: PathBuf,
    /// How it is read.
    pub read: ReadOptions,
    /// What orders the collapses.
    pub metric: Metric,
    /// How visibility is measured, where it is needed.
    pub measure: MeasureOptions,
    /// Meshes in the same coordinates that hide and are no part of the result; with [`Metric::Visibility`] only.
    pub occluders: Vec<PathBuf>,
    /// What happens to hidden triangles; counts with [`Metric::Visibility`] only.
    pub hidden: Hidden,
    /// p in V^p, 0 to 16.
    pub visibility_power: f64,
    /// The collapser's options; `targets` comes from `levels`, `importance_floor` from `hidden`.
    pub simplify: SimplifyOptions,
    /// Levels of detail, each at most as large as the one before.
    pub levels: Vec<LevelRequest>,
    /// Format of the outputs, where their names do not say it.
    pub format: Option<Format>,
    /// Where measurements are kept from run to run: a directory, or one file that ends in `.seen`.
    pub cache: Option<PathBuf>,
    /// A page that shows the mesh and every level.
    pub page: Option<PageRequest>,
    /// Replace outputs that are there.
    pub force: bool,
}

impl SimplifyRequest {
    /// Checks what can be checked before the mesh is read.
    pub(super) fn check(&self) -> Result<()> {
        self.measure.check()?;
        if self.metric == Metric::Quadric && !self.occluders.is_empty() {
            let message =
                "--metric quadric does not look, so nothing can be hidden; use --metric visibility".to_owned();
            return Err(Error::Option { name: "--occluder", message });
        }
        if self.metric == Metric::Visibility
            && self.hidden == Hidden::Delete
            && self.simplify.topology == Topology::Preserve
        {
            let message =
                "delete opens what is closed, which --topology preserve forbids; use --hidden collapse".to_owned();
            return Err(Error::Option { name: "--hidden", message });
        }
        if self.levels.len() > 1 && self.levels.iter().any(|level| level.targets.is_empty()) {
            let message = "several levels need a target each; an error bound alone makes one".to_owned();
            return Err(Error::Option { name: "--lods", message });
        }
        // The targets are checked against 1 triangle here, and again with the mesh's own count.
        let targets: Vec<Target> = self.levels.iter().flat_map(|level| level.targets.iter().copied()).collect();
        SimplifyOptions { targets, ..self.simplify.clone() }.check()
    }

    /// Checks that each level is at most as large as the one before, before any long work.
    pub(super) fn check_levels(&self, given: usize) -> Result<()> {
        SimplifyOptions { targets: self.targets(given), ..self.simplify.clone() }.counts(given).map(drop)
    }

    /// What is to be done with the mesh, which has `given` triangles.
    pub(super) fn reduction(&self, given: usize) -> Reduction {
        Reduction {
            hidden: self.hidden,
            visibility_power: self.visibility_power,
            options: SimplifyOptions { targets: self.targets(given), ..self.simplify.clone() },
        }
    }

    /// One triangle count per level, of `given` triangles; none where only an error bound ends the run.
    fn targets(&self, given: usize) -> Vec<Target> {
        let first_reached = |level: &LevelRequest| level.targets.iter().map(|target| target.count(given)).max();
        self.levels.iter().filter_map(first_reached).map(Target::Triangles).collect()
    }
}

/// How a mesh that was looked at is reduced.
#[derive(Debug, Clone)]
pub struct Reduction {
    /// What happens to hidden triangles; counts only where someone looked.
    pub hidden: Hidden,
    /// p in V^p, 0 to 16; counts only where someone looked.
    pub visibility_power: f64,
    /// The collapser's options, targets included; `importance_floor` comes from `hidden`.
    pub options: SimplifyOptions,
}

/// Levels of detail of a mesh.
#[derive(Debug, Clone)]
pub struct Simplified {
    /// From large to small. Their maps start from the mesh given, hidden triangles included.
    pub levels: Vec<Level>,
    /// Hidden triangles that were removed before simplifying.
    pub hidden_deleted: usize,
}

/// Simplifies a mesh that was looked at; `look` is `None` for [`Metric::Quadric`].
///
/// # Errors
/// As [`simplify`] and [`importance`]; [`Error::ShapeMismatch`] if `look` was taken at another mesh.
pub fn simplify_seen(
    mesh: TriMesh,
    look: Option<Look>,
    reduction: &Reduction,
    observer: &dyn Observer,
) -> Result<Simplified> {
    let given = mesh.triangle_count();
    let importance_floor = reduction.hidden.importance_floor();
    // Shares are of the mesh given, whatever leaves it before the collapser begins.
    let targets = reduction.options.counts(given)?.into_iter().map(Target::Triangles).collect();
    let options = SimplifyOptions { targets, importance_floor, ..reduction.options.clone() };
    let Some(look) = look else {
        return Ok(Simplified { levels: simplify(&mesh, None, &options, observer)?, hidden_deleted: 0 });
    };
    let weights = importance(&look.visibility, reduction.hidden, reduction.visibility_power)?;
    let removes = look.hidden.iter().any(|&h| h);
    let seen = if removes { mesh.without_triangles(&look.hidden)? } else { None };
    let Some(seen) = seen else {
        return Ok(Simplified { levels: simplify(&mesh, Some(&weights), &options, observer)?, hidden_deleted: 0 });
    };
    let deleted = TopologyChange::between(&mesh, &seen.mesh);
    drop(mesh);
    let hidden_deleted = given - seen.mesh.triangle_count();
    observer.hidden_deleted(hidden_deleted, given)?;
    let weights: Vec<f64> = weights.iter().zip(&look.hidden).filter(|(_, hidden)| !**hidden).map(|(&w, _)| w).collect();
    drop(look);
    let mut levels = simplify(&seen.mesh, Some(&weights), &options, observer)?;
    for level in &mut levels {
        start_from_whole(level, &seen);
        level.topology = level.topology.after(deleted);
    }
    Ok(Simplified { levels, hidden_deleted })
}

/// Puts the way from the whole mesh to its seen part before the maps of a level.
fn start_from_whole(level: &mut Level, seen: &Remainder) {
    level.vertex_map = compose_maps(&seen.vertex_map, &level.vertex_map);
    level.triangle_map = compose_maps(&seen.triangle_map, &level.triangle_map);
}

/// Result of [`super::run_simplify`].
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
    /// Hidden triangles that were removed before simplifying.
    pub hidden_deleted: usize,
    /// What of the look an earlier run had kept: `hit`, `partial` (not what is hidden) or `miss`; `None` without a cache.
    pub cache: Option<&'static str>,
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
    /// Largest root mean square distance of a collapse from the planes of visible surface, in model units.
    pub error: f64,
    /// The file.
    pub file: PathBuf,
    /// What changed in the topology since the mesh was read.
    pub topology: TopologyChange,
}

/// Seconds of wall time per step.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct SimplifySeconds {
    /// Reading and checking the file.
    pub read: f64,
    /// Measuring visibility.
    pub visibility: f64,
    /// Collapsing.
    pub simplify: f64,
    /// Writing.
    pub write: f64,
    /// All of it.
    pub total: f64,
    /// Looking again, to make sure of what is hidden.
    pub hidden: f64,
}

impl SimplifyReport {
    pub(super) fn new(
        request: &SimplifyRequest,
        triangles: usize,
        simplified: &Simplified,
        seconds: SimplifySeconds,
    ) -> Self {
        let level = |(level, wanted): (&Level, &LevelRequest)| LevelReport {
            target: level.target,
            output: level.mesh.triangle_count(),
            stop: stop_name(level.stop),
            error: level.error,
            file: wanted.output.clone(),
            topology: level.topology,
        };
        Self {
            levels: simplified.levels.iter().zip(&request.levels).map(level).collect(),
            triangles,
            metric: request.metric.name(),
            seconds,
            hidden_deleted: simplified.hidden_deleted,
            cache: None,
        }
    }
}

fn stop_name(stop: Stop) -> &'static str {
    match stop {
        Stop::Target => "target",
        Stop::Error => "error",
        Stop::QueueEmpty => "queue_empty",
    }
}
