//! What Zhang & Turk 2002 print, made again: tables 1 and 2, figures 1 to 8.
//!
//! A study is a table of cells, model by model. Each finding is kept in a file as soon as it is made, so that a run
//! which was killed goes on where it was; tables, plots and the page are made of the findings at the end.

mod bench;
mod cell;
mod csv;
mod figures;
mod gain;
mod page;
mod plots;
mod report;
mod store;
mod summary;
mod tables;
mod words;
mod write;

use std::path::PathBuf;

use serde::Serialize;

pub use cell::{
    Cell, LevelErrors, LevelFinding, LookFinding, PicturesFinding, RunFinding, SheetFinding, ShownPicture,
    ViewerFinding,
};
pub use gain::{EqualError, Improvement, Levels, PresetPair, QuadricCount};
pub use report::{ModelReport, ZtReport};
pub use summary::{Correlation, ImprovementSummary, MeanImprovement};

use crate::camera::Cameras;
use crate::error::{Error, Result};
use crate::io::{self, ReadOptions};
use crate::mesh::TriMesh;
use crate::pipeline::{MeshConvergence, Metric, Observer, Preset};
use crate::report::page::MODELS_BYTES;
use crate::report::paper::PaperModel;
use crate::simplify::Target;
use crate::visibility::{Estimator, MeasureOptions, estimated_pieces};

use bench::Bench;
use cell::Finding;
use store::Store;

/// Shares of the triangles at the seven levels of table 2 and figure 4. The paper does not say which it took; halves spread
/// evenly over the logarithmic axis of figure 4.
pub const LEVELS: [f64; 7] = [0.5, 0.25, 0.125, 0.0625, 0.031_25, 0.015_625, 0.007_812_5];

/// Of how many large models there is room on a page to be turned whole, originals of 150,000 triangles beside their results.
const WHOLE_VIEWERS: usize = 3;

/// Bytes of a model's name; file systems end at 255 for a whole name.
const LONGEST_NAME: usize = 200;

/// What [`study_zt`] does.
#[derive(Debug, Clone)]
pub struct ZtRequest {
    /// The models.
    pub models: Vec<ZtModel>,
    /// How they are read.
    pub read: ReadOptions,
    /// Whose options, each by itself.
    pub presets: Vec<Preset>,
    /// Shares of the triangles, descending, in (0, 1).
    pub levels: Vec<f64>,
    /// Samples on each mesh for the geometric error.
    pub samples: u64,
    /// Seed of the samples.
    pub seed: u64,
    /// Octahedral cameras, where the presets' are not wanted.
    pub cameras: Option<usize>,
    /// Pixels along an image's side, where the presets' are not wanted.
    pub resolution: Option<u32>,
    /// Also how V depends on the number of cameras (Fig. 3).
    pub convergence: bool,
    /// Bytes that the images of all threads together may take.
    pub memory_limit: Option<u64>,
    /// The study's directory.
    pub output: PathBuf,
    /// What page and tables say of the machine beside times: threads, processor; may be empty.
    pub machine: String,
    /// Another place for the page, beside `report.html` in the directory.
    pub page: Option<PathBuf>,
}

/// A model of the study.
#[derive(Debug, Clone)]
pub struct ZtModel {
    /// What it is called in tables and in files' names; no two are called alike.
    pub name: String,
    /// The file.
    pub path: PathBuf,
    /// Which of the paper's models it is or stands for.
    pub paper: Option<&'static PaperModel>,
    /// It is another file than the paper's, whatever its number of triangles says.
    pub stand_in: bool,
    /// Upward in its pictures, any length but 0.
    pub up: [f64; 3],
}

/// A cell that a study needs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlannedCell {
    /// The model's name.
    pub model: String,
    /// Its triangles.
    pub triangles: usize,
    /// Levels at which it is compared, those that the paper names included.
    pub levels: usize,
    /// About how many pieces its triangles are cut into where the cell looks by [`Estimator::ItemBuffer`].
    pub pieces: Option<f64>,
    /// What is to be found.
    pub cell: Cell,
    /// An earlier run found it.
    pub done: bool,
}

/// All that was found about one model.
#[derive(Debug, Clone, Serialize)]
pub struct ModelFindings {
    /// The model's name.
    pub name: String,
    /// The file.
    pub file: PathBuf,
    /// Its triangles.
    pub triangles: usize,
    /// Upward in its pictures.
    pub up: [f64; 3],
    /// Visibility, one entry per preset.
    pub looks: Vec<LookFinding>,
    /// The simplifiers, QB and VG of each preset.
    pub runs: Vec<RunFinding>,
    /// Pictures, one entry per preset.
    pub pictures: Vec<PicturesFinding>,
    /// Models of the page.
    #[serde(skip)]
    pub viewer: Option<ViewerFinding>,
    /// How V depends on the number of cameras.
    pub convergence: Option<MeshConvergence>,
}

/// What a study would compute, and what it need not.
///
/// # Errors
/// As [`study_zt`], before the first cell.
pub fn plan_zt(request: &ZtRequest) -> Result<Vec<PlannedCell>> {
    request.check()?;
    let mut plan = Vec::new();
    for model in &request.models {
        let store = Store::of(model, request)?;
        let mesh = io::read(&model.path, &request.read)?.mesh;
        let (triangles, levels) = (mesh.triangle_count(), request.counts(model, mesh.triangle_count()).len());
        for cell in Cell::all(request) {
            let done = store.has(cell)?;
            let pieces = request.pieces(cell, &mesh).filter(|_| !done);
            plan.push(PlannedCell { model: model.name.clone(), triangles, levels, pieces, cell, done });
        }
    }
    Ok(plan)
}

/// Finds what the tables and figures of Zhang & Turk 2002 say, about each model.
///
/// Findings and pictures go into the study's directory as they are made; what an earlier run with the same options
/// found there is taken from it.
///
/// # Errors
/// [`Error::Option`] for models that are called alike, or levels outside their range; as its steps. What was found
/// before an error stays.
pub fn study_zt(request: &ZtRequest, observer: &dyn Observer) -> Result<ZtReport> {
    request.check()?;
    // All files are there and hold a mesh, before the first of them is worked on.
    request.models.iter().try_for_each(|model| look_into(model, request))?;
    let study = |model| study_model(model, request, observer);
    let findings = request.models.iter().map(study).collect::<Result<_>>()?;
    Ok(ZtReport::of(&request.models, findings, store::others(request)?))
}

/// Reads the model if there is anything to do about it, only to say what is wrong with it.
fn look_into(model: &ZtModel, request: &ZtRequest) -> Result<()> {
    let store = Store::of(model, request)?;
    for cell in Cell::all(request) {
        if !store.has(cell)? {
            return io::read(&model.path, &request.read).map(drop);
        }
    }
    Ok(())
}

fn study_model(model: &ZtModel, request: &ZtRequest, observer: &dyn Observer) -> Result<ModelFindings> {
    let store = Store::of(model, request)?;
    let bench = Bench::of(model, request, &store, observer)?;
    let mut findings = ModelFindings {
        name: model.name.clone(),
        file: model.path.clone(),
        triangles: bench.triangles(),
        up: model.up,
        looks: Vec::new(),
        runs: Vec::new(),
        pictures: Vec::new(),
        viewer: None,
        convergence: None,
    };
    for cell in Cell::all(request) {
        observer.check()?;
        observer.cell(&model.name, &cell.name(), store.has(cell)?);
        match cell {
            Cell::Look(preset) => findings.looks.push(found(&store, cell, || bench.look(preset))?),
            Cell::Run(preset, metric) => findings.runs.push(found(&store, cell, || bench.run(preset, metric))?),
            Cell::Pictures(preset) => {
                let runs: Vec<_> = findings.runs.iter().filter(|run| run.preset == preset).collect();
                findings.pictures.push(found(&store, cell, || bench.pictures(preset, &runs))?);
            }
            Cell::Viewer => {
                let preset = *request.presets.last().unwrap_or(&Preset::Best);
                let run = findings.runs.iter().find(|run| (run.preset, run.metric) == (preset, Metric::Visibility));
                findings.viewer = Some(found(&store, cell, || bench.viewer(preset, run))?);
            }
            Cell::Convergence => findings.convergence = Some(found(&store, cell, || bench.convergence())?),
        }
    }
    Ok(findings)
}

/// What an earlier run found, or else what `work` finds.
fn found<T: Finding>(store: &Store<'_>, cell: Cell, work: impl FnOnce() -> Result<T>) -> Result<T> {
    if let Some(finding) = store.find(cell)? {
        return Ok(finding);
    }
    store.forget(cell)?;
    let finding = work()?;
    store.keep(cell, &finding)?;
    Ok(finding)
}

impl ZtRequest {
    fn check(&self) -> Result<()> {
        let mut names: Vec<&str> = self.models.iter().map(|model| model.name.as_str()).collect();
        names.sort_unstable();
        if let Some(pair) = names.windows(2).find(|pair| pair[0] == pair[1]) {
            let message = format!("two files are called {}, and so would be their tables; rename one", pair[0]);
            return Err(Error::Option { name: "MODELS", message });
        }
        if let Some(long) = names.iter().find(|name| name.len() > LONGEST_NAME) {
            let message = format!("the name {long} is too long for the files that are named after it; rename its file");
            return Err(Error::Option { name: "MODELS", message });
        }
        let shrink = self.levels.windows(2).all(|pair| pair[1] < pair[0]);
        if self.levels.is_empty() || !shrink || !self.levels.iter().all(|&share| share > 0.0 && share < 1.0) {
            let message = "levels are shares of the triangles between 0 and 1, the largest first".to_owned();
            return Err(Error::Option { name: "--levels", message });
        }
        self.presets.iter().try_for_each(|&preset| self.measure(preset).check())
    }

    /// Bytes of the page for a model that can be turned.
    fn viewer_share(&self) -> usize {
        MODELS_BYTES / self.models.len().clamp(1, WHOLE_VIEWERS)
    }

    /// How a model is looked at.
    fn measure(&self, preset: Preset) -> MeasureOptions {
        let options = preset.measure();
        MeasureOptions {
            cameras: self.cameras.map_or(options.cameras.clone(), Cameras::octahedral),
            resolution: self.resolution.or(options.resolution),
            memory_limit: self.memory_limit,
            ..options
        }
    }

    /// About how many pieces a look cuts the triangles into; `None` for what cuts nothing.
    fn pieces(&self, cell: Cell, mesh: &TriMesh) -> Option<f64> {
        let Cell::Look(preset) = cell else { return None };
        let options = self.measure(preset);
        (options.estimator == Estimator::ItemBuffer).then(|| estimated_pieces(mesh, &options))
    }

    /// Triangles of a level: asked for as a share, or as a count that the paper names.
    fn counts(&self, model: &ZtModel, triangles: usize) -> Vec<(Option<f64>, usize)> {
        let shares = self.levels.iter().map(|&share| (Some(share), Target::Ratio(share).count(triangles)));
        let named = model.named_counts(triangles).into_iter().map(|count| (None, count));
        let mut counts: Vec<_> = shares.chain(named).collect();
        // The collapser goes down only. Of equal counts the share stays first, and both are told.
        counts.sort_by_key(|&(_, count)| std::cmp::Reverse(count));
        counts
    }

    /// Every option that changes what a cell finds.
    fn words(&self, model: &ZtModel, cell: Cell) -> String {
        let read = ReadOptions { memory_limit: None, ..self.read.clone() };
        let look = |preset| format!("{:?}", MeasureOptions { memory_limit: None, ..self.measure(preset) });
        let paper = model.paper.map(|paper| (paper.pictures, paper.equal_error));
        let run =
            || format!("levels {:?}, counts {paper:?}, {} samples, seed {}", self.levels, self.samples, self.seed);
        match cell {
            Cell::Look(preset) => format!("{read:?} {} up {:?}", look(preset), model.up),
            Cell::Run(preset, _) => format!("{read:?} {} {:?} {}", look(preset), preset.simplify(), run()),
            Cell::Pictures(preset) => {
                format!("{read:?} {} {:?} {} up {:?}", look(preset), preset.simplify(), run(), model.up)
            }
            Cell::Viewer => {
                let presets: Vec<String> = self.presets.iter().map(|&preset| look(preset)).collect();
                format!("{read:?} {presets:?} {} {} bytes", run(), self.viewer_share())
            }
            Cell::Convergence => format!("{read:?} {:?}", self.measure(Preset::Paper).resolution),
        }
    }
}

/// Share of the triangles in the pictures of a model for which the paper names no count.
const PICTURE_SHARE: f64 = 0.03;

impl ZtModel {
    /// Triangles of the simplified models in pictures.
    fn picture_counts(&self, triangles: usize) -> Vec<usize> {
        let named = self.paper.map_or(&[][..], |paper| paper.pictures);
        let counts: Vec<usize> = named.iter().map(|p| p.triangles).filter(|&n| n < triangles).collect();
        if counts.is_empty() { vec![Target::Ratio(PICTURE_SHARE).count(triangles)] } else { counts }
    }

    /// Triangles of pictures, and of results that the paper compares.
    fn named_counts(&self, triangles: usize) -> Vec<usize> {
        let equal = self.paper.and_then(|paper| paper.equal_error);
        let compared = equal.into_iter().flat_map(|pair| [pair.visibility, pair.quadric]).filter(|&n| n < triangles);
        let mut counts: Vec<usize> = self.picture_counts(triangles).into_iter().chain(compared).collect();
        counts.sort_unstable();
        counts.dedup();
        counts
    }
}
