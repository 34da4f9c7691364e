//! The straight path, from mesh file to result.
//!
//! [`run_simplify`] is the whole of it:
//!
//! ```text
//! mesh file → io → mesh → camera → backend → visibility → weights → simplify → io → mesh file
//! ```
//!
//! [`measure_file`], [`explain_file`], [`verify_file`], [`study_convergence`], [`compare_files`] and [`render_file`] leave
//! it early or look at its two ends; [`study_zt`] walks it for many meshes and says what came of it.

mod compare;
mod convergence;
mod diagram;
mod disagreement;
mod explain;
mod measure;
mod observation;
mod page;
mod preset;
mod render;
mod side_by_side;
mod simplify;
mod surroundings;
mod verify;
mod zt;

pub use compare::{CompareReport, CompareRequest, GeometricReport, TestReport, compare_files};
pub use convergence::{
    ConvergenceError, ConvergenceReport, ConvergenceRequest, IndependentReference, MeshConvergence, study_convergence,
};
pub use diagram::DiagramRequest;
pub use disagreement::PairPictures;
pub use explain::{BlockerReport, ExplainReport, ExplainRequest, SightReport, explain_file};
pub use measure::{
    ErrorSummary, MeasureReport, MeasureRequest, MeasureSeconds, RescueSummary, VisibilitySummary, measure_file,
};
pub use observation::cache_is_file;
pub use page::{PageRequest, shown_names};
pub use preset::{Preset, VISIBILITY_POWER};
pub use render::{RenderRequest, Style, render_file};
pub use side_by_side::{ColumnOrder, Portrait, SideBySide};
pub use simplify::{
    LevelReport, LevelRequest, Metric, Reduction, Simplified, SimplifyReport, SimplifyRequest, SimplifySeconds,
    simplify_seen,
};
pub use verify::{PairReport, VerifyReport, VerifyRequest, verify_file};
pub use zt::{
    Cell, Correlation, EqualError, Improvement, ImprovementSummary, LEVELS, LevelErrors, LevelFinding, Levels,
    LookFinding, MeanImprovement, ModelFindings, ModelReport, PicturesFinding, PlannedCell, PresetPair, QuadricCount,
    RunFinding, SheetFinding, ShownPicture, ViewerFinding, ZtModel, ZtReport, ZtRequest, plan_zt, study_zt,
};

use std::path::Path;
use std::time::Instant;

use crate::error::Result;
use crate::io::{self, Attributes, Loaded, WriteOptions};
use crate::pipeline::observation::Observation;
use crate::pipeline::simplify::{Before, show};
use crate::pipeline::surroundings::Surroundings;
use crate::progress::{CancelFlag, Progress, Silent};
use crate::visibility::{Hidden, KeptFault, Look, MeasureOptions, Visibility};

/// Reads a mesh, looks at it, simplifies it where nobody looks, writes every level.
///
/// # Errors
/// As its steps. What was written before an error stays; each file is whole or not there.
pub fn run_simplify(request: &SimplifyRequest, observer: &dyn Observer) -> Result<SimplifyReport> {
    let mut clock = Clock::start();
    request.check()?;
    let occluders = Surroundings::read(&request.occluders, &request.read)?;
    let mesh = {
        let loaded = io::read(&request.input, &request.read)?;
        observer.mesh_read(&request.input, &loaded)?;
        loaded.mesh
    };
    request.check_levels(mesh.triangle_count())?;
    let mut seconds = SimplifySeconds { read: clock.lap(), ..SimplifySeconds::default() };
    let mut reused = None;
    let look = match request.metric {
        Metric::Visibility => {
            let mut observation =
                Observation::of(occluders.around(&mesh)?, &request.measure, request.cache.as_deref(), observer)?;
            let visibility = observation.visibility(observer)?;
            seconds.visibility = clock.lap();
            let hidden = observation.hidden(request.hidden, &visibility, observer)?;
            seconds.hidden = clock.lap();
            observation.keep(&visibility, (request.hidden == Hidden::Delete).then_some(&hidden))?;
            reused = observation.reused();
            Some(Look { visibility, hidden })
        }
        Metric::Quadric => None,
    };
    let triangles = mesh.triangle_count();
    let before = request.page.as_ref().map(|_| (mesh.clone(), look.as_ref().map(|look| look.visibility.clone())));
    let simplified = simplify_seen(mesh, look, &request.reduction(triangles), observer)?;
    seconds.simplify = clock.lap();
    observer.check()?;
    for (level, wanted) in simplified.levels.iter().zip(&request.levels) {
        let options = WriteOptions { force: request.force, format: request.format };
        io::write(&wanted.output, &level.mesh, &Attributes::default(), &options)?;
    }
    if let (Some(page), Some((mesh, visibility))) = (&request.page, before) {
        let before = Before { mesh: &mesh, visibility, occluders: &occluders };
        show(before, &simplified, request, observer)?.write(page, request.force, observer)?;
    }
    seconds.write = clock.lap();
    seconds.total = clock.total();
    Ok(SimplifyReport { cache: reused, ..SimplifyReport::new(request, triangles, &simplified, seconds) })
}

/// Follows a run: its progress, and what its user should know before the long work starts.
pub trait Observer: Progress {
    /// A mesh was read; an error ends the run.
    ///
    /// # Errors
    /// Whatever the observer decides.
    fn mesh_read(&self, _path: &Path, _loaded: &Loaded) -> Result<()> {
        Ok(())
    }

    /// What a file of the cache's directory should keep cannot be used; the mesh is looked at again.
    ///
    /// # Errors
    /// Whatever the observer decides.
    fn kept_look_unusable(&self, _file: &Path, _fault: KeptFault) -> Result<()> {
        Ok(())
    }

    /// The mesh was looked at under `options`, by this run or by an earlier one that kept the look.
    ///
    /// # Errors
    /// Whatever the observer decides.
    fn measured(&self, _options: &MeasureOptions, _seen: &Visibility) -> Result<()> {
        Ok(())
    }

    /// A study comes to a cell of a model; `found` if an earlier run has done it.
    fn cell(&self, _model: &str, _cell: &str, _found: bool) {}

    /// `deleted` of `given` triangles are hidden and leave the mesh before it is simplified.
    ///
    /// # Errors
    /// Whatever the observer decides.
    fn hidden_deleted(&self, _deleted: usize, _given: usize) -> Result<()> {
        Ok(())
    }
}

impl Observer for Silent {}
impl Observer for CancelFlag {}

/// Wall time, lap by lap.
struct Clock {
    start: Instant,
    lap: Instant,
}

impl Clock {
    fn start() -> Self {
        let now = Instant::now();
        Self { start: now, lap: now }
    }

    /// Seconds since the last lap.
    fn lap(&mut self) -> f64 {
        let now = Instant::now();
        let seconds = now.duration_since(self.lap).as_secs_f64();
        self.lap = now;
        seconds
    }

    fn total(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }
}
