//! Where the cells of one model are worked on.

use std::fs;
use std::path::PathBuf;

use glam::DVec3;

use super::cell::{
    Cell, LevelErrors, LevelFinding, LookFinding, PicturesFinding, RunFinding, SheetFinding, ShownPicture,
    ViewerFinding,
};
use super::store::Store;
use super::{ZtModel, ZtRequest};
use crate::error::{Error, Result};
use crate::eval::geometric::{GeometricOptions, SampleCount};
use crate::eval::{Gallery, Reference, Shot};
use crate::io::{self, Attributes, Loaded, ReadOptions, WriteOptions};
use crate::mesh::TriMesh;
use crate::pipeline::compare::views_around;
use crate::pipeline::convergence::convergence_of;
use crate::pipeline::diagram::Record;
use crate::pipeline::observation::{Observation, Surrounded};
use crate::pipeline::page::{Exhibit, models};
use crate::pipeline::render::heat_picture;
use crate::pipeline::side_by_side::Captioned;
use crate::pipeline::{
    Clock, ColumnOrder, ConvergenceRequest, IndependentReference, MeshConvergence, Metric, Observer, Portrait, Preset,
    Reduction, SideBySide, VISIBILITY_POWER, simplify_seen,
};
use crate::report::colour::ColourMap;
use crate::report::legend::with_legend;
use crate::report::picture::Picture;
use crate::simplify::{Level, Target};
use crate::visibility::{Hidden, Look, MeasureOptions, Visibility};

/// Pixels along the side of a heat map.
const HEAT_MAP: u32 = 720;

/// One model on the bench.
pub(super) struct Bench<'a> {
    model: &'a ZtModel,
    request: &'a ZtRequest,
    store: &'a Store<'a>,
    observer: &'a dyn Observer,
    loaded: Loaded,
}

impl<'a> Bench<'a> {
    /// Puts the model on the bench.
    pub fn of(
        model: &'a ZtModel,
        request: &'a ZtRequest,
        store: &'a Store<'a>,
        observer: &'a dyn Observer,
    ) -> Result<Self> {
        let loaded = io::read(&model.path, &request.read)?;
        observer.mesh_read(&model.path, &loaded)?;
        let cells = store.cells();
        fs::create_dir_all(cells).map_err(|e| Error::Write { path: cells.to_owned(), message: e.to_string() })?;
        Ok(Self { model, request, store, observer, loaded })
    }

    /// Triangles of the original.
    pub fn triangles(&self) -> usize {
        self.mesh().triangle_count()
    }

    fn mesh(&self) -> &TriMesh {
        &self.loaded.mesh
    }

    /// A look at the model that is kept among its findings.
    fn observation<'b>(&'b self, options: &'b MeasureOptions) -> Result<Observation<'b>> {
        Observation::of(alone(self.mesh()), options, Some(self.store.cells()), self.observer)
    }

    /// Looks at the model, and draws what was seen.
    pub fn look(&self, preset: Preset) -> Result<LookFinding> {
        let options = self.request.measure(preset);
        let mut observation = self.observation(&options)?;
        let mut clock = Clock::start();
        // Looked at again even if a killed run had kept it: the time belongs to the finding.
        let (visibility, record) = Record::look(observation.subject()?, &options, false, self.observer)?;
        let seconds = clock.lap();
        observation.keep(&visibility, None)?;
        let [heat_map, diagram] = ["heat", "diagram"].map(|what| self.file_name(what, preset, "png"));
        let bare_heat_map = self.file_for_page(&format!("heat-{}", preset.name()));
        let picture = self.heat_map(&visibility)?;
        self.save(&heat_map, &with_legend(&picture, ColourMap::default(), "visibility V"))?;
        self.save(&bare_heat_map, &picture.drawn_area().map_or(picture.clone(), |area| picture.cropped(area)))?;
        record.write(&self.loaded, observation.subject()?, &self.path(&diagram), true)?;
        Ok(LookFinding {
            preset,
            estimator: options.estimator.name().to_owned(),
            cameras: visibility.cameras(),
            resolution: visibility.resolution(),
            visibility: visibility.of_mesh(),
            never_seen: visibility.never_seen(),
            seconds,
            heat_map,
            bare_heat_map,
            diagram,
        })
    }

    /// Simplifies through all levels, and says how far each is from the original.
    pub fn run(&self, preset: Preset, metric: Metric) -> Result<RunFinding> {
        let (look, hidden_seconds) = match metric {
            Metric::Quadric => (None, None),
            Metric::Visibility => {
                let (look, seconds) = self.seen(preset)?;
                (Some(look), (preset.hidden() == Hidden::Delete).then_some(seconds))
            }
        };
        let counts = self.request.counts(self.model, self.triangles());
        let targets = counts.iter().map(|&(_, count)| Target::Triangles(count)).collect();
        let options = preset.simplify().with_targets(targets);
        let reduction = Reduction { hidden: preset.hidden(), visibility_power: VISIBILITY_POWER, options };
        let mut clock = Clock::start();
        let simplified = simplify_seen(self.mesh().clone(), look, &reduction, self.observer)?;
        let seconds = clock.lap();
        let errors = self.errors(&simplified.levels, preset)?;
        let pictured = self.model.picture_counts(self.triangles());
        let mut levels = Vec::new();
        for ((level, errors), (share, asked)) in simplified.levels.iter().zip(errors).zip(counts) {
            let mesh = match pictured.contains(&asked) {
                true => Some(self.save_mesh(&level.mesh, Cell::Run(preset, metric), asked)?),
                false => None,
            };
            let (triangles, topology) = (level.mesh.triangle_count(), level.topology);
            levels.push(LevelFinding { share, asked, triangles, errors, topology, mesh });
        }
        Ok(RunFinding { preset, metric, hidden_deleted: simplified.hidden_deleted, hidden_seconds, seconds, levels })
    }

    /// What the cell that looks has kept, and what is hidden for sure; with the seconds that this took.
    fn seen(&self, preset: Preset) -> Result<(Look, f64)> {
        let options = self.request.measure(preset);
        let mut observation = self.observation(&options)?;
        let visibility = observation.visibility(self.observer)?;
        let subject = observation.subject()?;
        let mut clock = Clock::start();
        // Not kept for another run: the time belongs to the finding.
        let hidden = preset.hidden().marks(subject, &visibility, &options, self.observer)?;
        let seconds = clock.lap();
        Ok((Look { visibility, hidden }, seconds))
    }

    fn errors(&self, levels: &[Level], preset: Preset) -> Result<Vec<LevelErrors>> {
        let look = self.request.measure(preset);
        let seen = self.observation(&look)?.visibility(self.observer)?;
        let options = GeometricOptions { samples: SampleCount::Exactly(self.request.samples), seed: self.request.seed };
        let original = Reference::new(self.mesh(), Some(seen.per_triangle()), options, self.observer)?;
        let compare = |level: &Level| Ok(LevelErrors::of(&original.compare(&level.mesh, self.observer)?));
        levels.iter().map(compare).collect()
    }

    /// Draws what `runs`, QB and VG, made of the model, as Figs. 5 to 8 do.
    pub fn pictures(&self, preset: Preset, runs: &[&RunFinding]) -> Result<PicturesFinding> {
        let counts = self.model.picture_counts(self.triangles()).into_iter();
        let sheets = counts.map(|triangles| {
            let name = format!("{}-{triangles}", Cell::Pictures(preset).name());
            self.sheet(&name, triangles, runs)
        });
        Ok(PicturesFinding { preset, sheets: sheets.collect::<Result<_>>()? })
    }

    fn sheet(&self, name: &str, triangles: usize, runs: &[&RunFinding]) -> Result<SheetFinding> {
        let mut made = Vec::new();
        for run in runs {
            let level = run.level_of(triangles).and_then(|level| level.mesh.as_ref().map(|file| (level, file)));
            if let Some((level, file)) = level {
                made.push((run, level, io::read(&self.path(file), &ReadOptions::default())?.mesh));
            }
        }
        let short = |metric| if metric == Metric::Quadric { "QB" } else { "VG" };
        let tests = made.iter().map(|(run, level, mesh)| Portrait {
            name: short(run.metric).to_owned(),
            mesh,
            image_rmse: Some(level.errors.image_rmse),
        });
        let sheet = SideBySide {
            title: String::new(),
            subtitle: String::new(),
            reference: Portrait { name: "original".to_owned(), mesh: self.mesh(), image_rmse: None },
            tests: tests.collect(),
            order: ColumnOrder::ReferenceBetween,
            up: DVec3::from_array(self.model.up),
        };
        let taken = sheet.take()?;
        let file = format!("{}-{name}.png", self.model.name);
        self.save(&file, &taken.sheet()?)?;
        let mut shown = Vec::new();
        for (number, Captioned { caption, picture }) in taken.first_view()?.into_iter().enumerate() {
            let file = self.file_for_page(&format!("{name}-{number}"));
            self.save(&file, &picture)?;
            shown.push(ShownPicture { caption, file });
        }
        Ok(SheetFinding { triangles, file, shown })
    }

    /// The original and what VG made of it, coloured by their visibility, within their share of a page.
    pub fn viewer(&self, preset: Preset, run: Option<&RunFinding>) -> Result<ViewerFinding> {
        let options = self.request.measure(preset);
        let visibility = self.observation(&options)?.visibility(self.observer)?;
        let original = Exhibit { name: "original".to_owned(), mesh: self.mesh(), visibility };
        let smallest = run.and_then(|run| run.levels.iter().rev().find_map(|level| level.mesh.as_ref()));
        let mesh = smallest.map(|file| io::read(&self.path(file), &ReadOptions::default())).transpose()?;
        let mesh = mesh.map(|loaded| loaded.mesh);
        let result = mesh.as_ref().map(|mesh| {
            let name = format!("VG {}", preset.name());
            Exhibit::look(name, alone(mesh), &options, self.observer)
        });
        let result = result.transpose()?;
        let exhibits: Vec<&Exhibit> = std::iter::once(&original).chain(&result).collect();
        Ok(ViewerFinding { models: models(&exhibits, self.request.viewer_share(), self.observer)? })
    }

    /// How V depends on the number of cameras, in the paper's pictures; the second reference shares no camera with the
    /// pattern.
    pub fn convergence(&self) -> Result<MeshConvergence> {
        let request = ConvergenceRequest {
            inputs: Vec::new(),
            occluders: Vec::new(),
            read: self.request.read.clone(),
            against: IndependentReference::Fibonacci,
            resolution: self.request.measure(Preset::Paper).resolution,
            memory_limit: self.request.memory_limit,
        };
        convergence_of(&self.model.path, alone(self.mesh()), &request, self.observer)
    }

    /// `bunny-heat-best.png`
    fn file_name(&self, what: &str, preset: Preset, extension: &str) -> String {
        format!("{}-{what}-{}.{extension}", self.model.name, preset.name())
    }

    /// `cells/bunny/heat-best.png`: a picture that the page shows; readers of the directory have a whole one.
    fn file_for_page(&self, what: &str) -> String {
        format!("{}/{what}.png", self.store.cells_name())
    }

    /// Writes the mesh that a simplifier made of the model; returns its name.
    fn save_mesh(&self, mesh: &TriMesh, cell: Cell, asked: usize) -> Result<String> {
        let file = format!("{}-{}-{asked}.ply", self.model.name, cell.name());
        io::write(&self.path(&file), mesh, &Attributes::default(), &WriteOptions { force: true, format: None })?;
        Ok(file)
    }

    fn heat_map(&self, visibility: &Visibility) -> Result<Picture> {
        let up = DVec3::from_array(self.model.up);
        let shot = Shot::fitting(self.mesh(), views_around(up)[0], up.normalize(), HEAT_MAP);
        let gallery = Gallery::new(self.mesh(), self.mesh());
        heat_picture(&gallery, &shot, visibility.per_triangle(), ColourMap::default())
    }

    fn path(&self, file: &str) -> PathBuf {
        self.request.output.join(file)
    }

    fn save(&self, file: &str, picture: &Picture) -> Result<()> {
        io::write_atomic(&self.path(file), true, |writer| picture.write_png(writer))
    }
}

/// A mesh with nothing around it.
fn alone(mesh: &TriMesh) -> Surrounded<'_> {
    Surrounded { mesh, occluders: &[] }
}
