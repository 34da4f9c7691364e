//! The cells that a study is made of: what is computed at one go, and found again by the next run.

use serde::{Deserialize, Serialize};

use super::ZtRequest;
use crate::eval::geometric::Distances;
use crate::eval::{Comparison, GreyError, TriangleQuality};
use crate::pipeline::{MeshConvergence, Metric, Preset};
use crate::report::page::Model;
use crate::simplify::TopologyChange;

/// One cell of one model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cell {
    /// Visibility, its heat map, its diagram.
    Look(Preset),
    /// One simplifier through all levels, and how far each is from the original.
    Run(Preset, Metric),
    /// What the simplifiers made of it, side by side.
    Pictures(Preset),
    /// Original and result, to be turned on the page.
    Viewer,
    /// How V depends on the number of cameras.
    Convergence,
}

impl Cell {
    /// The cells of each model, in the order in which they are computed.
    #[must_use]
    pub fn all(request: &ZtRequest) -> Vec<Self> {
        let of_preset = |&preset: &Preset| {
            let runs = [Metric::Quadric, Metric::Visibility].map(|metric| Self::Run(preset, metric));
            [Self::Look(preset), runs[0], runs[1], Self::Pictures(preset)]
        };
        let convergence = request.convergence.then_some(Self::Convergence);
        request.presets.iter().flat_map(of_preset).chain([Self::Viewer]).chain(convergence).collect()
    }

    /// A name for files and people.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Look(preset) => format!("look-{}", preset.name()),
            Self::Run(preset, Metric::Quadric) => format!("qb-{}", preset.name()),
            Self::Run(preset, Metric::Visibility) => format!("vg-{}", preset.name()),
            Self::Pictures(preset) => format!("pictures-{}", preset.name()),
            Self::Viewer => "viewer".to_owned(),
            Self::Convergence => "convergence".to_owned(),
        }
    }
}

/// What a cell found. The files that it wrote beside are part of it.
pub(super) trait Finding: Serialize + serde::de::DeserializeOwned {
    /// Names of its files in the study's directory.
    fn files(&self) -> Vec<&str>;
}

/// How well a model is seen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LookFinding {
    /// Who says so.
    pub preset: Preset,
    /// What was counted.
    pub estimator: String,
    /// Cameras.
    pub cameras: usize,
    /// Pixels along an image's side.
    pub resolution: u32,
    /// V(M), one-sided, eq. (3.2).
    pub visibility: f64,
    /// Triangles that no camera sees.
    pub never_seen: usize,
    /// Wall time of the looking.
    pub seconds: f64,
    /// The heat map (Fig. 2), PNG.
    pub heat_map: String,
    /// The same without legend and margins, for the page.
    pub bare_heat_map: String,
    /// The visibility diagram (Fig. 1), PNG.
    pub diagram: String,
}

/// One simplifier through all levels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunFinding {
    /// Whose options.
    pub preset: Preset,
    /// What ordered the collapses.
    pub metric: Metric,
    /// Hidden triangles that were removed first.
    pub hidden_deleted: usize,
    /// Wall time of making sure that they are hidden; `None` where none are removed.
    pub hidden_seconds: Option<f64>,
    /// Wall time of collapsing; looking is not in it.
    pub seconds: f64,
    /// From large to small.
    pub levels: Vec<LevelFinding>,
}

/// One level of detail.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LevelFinding {
    /// Share of the triangles that was asked for; `None` for a count that the paper names.
    pub share: Option<f64>,
    /// Triangles asked for.
    pub asked: usize,
    /// Triangles reached.
    pub triangles: usize,
    /// What the pictures and the geometry lost.
    pub errors: LevelErrors,
    /// What changed in the topology.
    pub topology: TopologyChange,
    /// The mesh, PLY, where pictures are made of it.
    pub mesh: Option<String>,
}

/// How far a level is from the original; geometric errors in % of the diagonal of the original's box.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LevelErrors {
    /// See [`crate::eval::ImageError::image_rms`].
    pub image_rms: f64,
    /// See [`crate::eval::ImageError::image_rmse`]; grey levels.
    pub image_rmse: f64,
    /// See [`crate::eval::ImageError::fixed_light`].
    pub fixed_light: GreyError,
    /// See [`crate::eval::ImageError::smooth`].
    pub smooth: GreyError,
    /// See [`crate::eval::ImageError::ssim`].
    pub ssim: f64,
    /// See [`crate::eval::ImageError::silhouette_xor`]; pixels per camera.
    pub silhouette_xor: f64,
    /// See [`crate::eval::ImageError::depth_rms`].
    pub depth_rms: Option<f64>,
    /// Mean distance of the worse direction.
    pub geometric_mean: f64,
    /// Root mean square of the same.
    pub geometric_rms: f64,
    /// Largest of the same.
    pub geometric_max: f64,
    /// Root mean square distance from visible surface to the result; `None` where nothing is visible.
    pub visible_rms: Option<f64>,
    /// The same from hidden surface; `None` where nothing is hidden.
    pub hidden_rms: Option<f64>,
    /// The same from all surface, weighted by visibility.
    pub weighted_rms: Option<f64>,
    /// Triangles that went wrong.
    pub quality: TriangleQuality,
}

impl LevelErrors {
    /// In the unit of the tables.
    pub(super) fn of(comparison: &Comparison) -> Self {
        let Comparison { image, geometric, quality } = comparison;
        let (seen, percent) = (geometric.seen, 100.0 / geometric.diagonal);
        let rms = |distances: Option<Distances>| distances.map(|d| d.rms * percent);
        Self {
            image_rms: image.image_rms,
            image_rmse: image.image_rmse,
            fixed_light: image.fixed_light,
            smooth: image.smooth,
            ssim: image.ssim,
            silhouette_xor: image.silhouette_xor,
            depth_rms: image.depth_rms.map(|depth| depth * percent),
            geometric_mean: geometric.mean * percent,
            geometric_rms: geometric.rms * percent,
            geometric_max: geometric.max * percent,
            visible_rms: rms(seen.and_then(|seen| seen.visible)),
            hidden_rms: rms(seen.and_then(|seen| seen.hidden)),
            weighted_rms: seen.and_then(|seen| seen.weighted_rms).map(|rms| rms * percent),
            quality: *quality,
        }
    }
}

impl Serialize for Cell {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.name())
    }
}

/// Pictures of both simplifiers beside the original.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PicturesFinding {
    /// Whose options.
    pub preset: Preset,
    /// One sheet per count.
    pub sheets: Vec<SheetFinding>,
}

/// One sheet of pictures.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SheetFinding {
    /// Triangles asked for.
    pub triangles: usize,
    /// All views, PNG.
    pub file: String,
    /// The first view, for the page: the original, then each simplifier's result and what differs.
    pub shown: Vec<ShownPicture>,
}

/// A picture of the page.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShownPicture {
    /// What it shows.
    pub caption: String,
    /// The picture, PNG, without words and margins.
    pub file: String,
}

impl Finding for LookFinding {
    fn files(&self) -> Vec<&str> {
        vec![&self.heat_map, &self.bare_heat_map, &self.diagram]
    }
}

impl Finding for RunFinding {
    fn files(&self) -> Vec<&str> {
        self.levels.iter().filter_map(|level| level.mesh.as_deref()).collect()
    }
}

impl Finding for PicturesFinding {
    fn files(&self) -> Vec<&str> {
        let whole = self.sheets.iter().map(|sheet| &sheet.file);
        let shown = self.sheets.iter().flat_map(|sheet| &sheet.shown).map(|shown| &shown.file);
        whole.chain(shown).map(String::as_str).collect()
    }
}

/// Models of the page.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ViewerFinding {
    /// The original, then the result.
    pub models: Vec<Model>,
}

impl Finding for ViewerFinding {
    fn files(&self) -> Vec<&str> {
        Vec::new()
    }
}

impl Finding for MeshConvergence {
    fn files(&self) -> Vec<&str> {
        Vec::new()
    }
}

impl RunFinding {
    /// The levels that were asked for as a share of the triangles, not as a count that the paper names.
    pub fn shared_levels(&self) -> impl Iterator<Item = &LevelFinding> {
        self.levels.iter().filter(|level| level.share.is_some())
    }

    /// The level with so many triangles asked for.
    #[must_use]
    pub fn level_of(&self, asked: usize) -> Option<&LevelFinding> {
        self.levels.iter().find(|level| level.asked == asked)
    }
}
