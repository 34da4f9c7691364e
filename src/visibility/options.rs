use crate::backend::BackendKind;
use crate::camera::{CameraSphere, CameraWeights, Cameras};
use crate::error::{Error, Result};
use crate::visibility::RayOptions;

/// What is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Estimator {
    /// Pixels, weighted: unbiased at any triangle size.
    #[default]
    Coverage,
    /// The paper's: a camera sees a piece of a triangle or it does not.
    ItemBuffer,
    /// Rays from points on the triangle to the cameras: no pixel to miss it.
    Surface,
    /// Cosine-distributed rays from all over the triangle: the definition itself, with an error bar.
    Hemisphere,
}

impl Estimator {
    /// The name on the command line and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Coverage => "coverage",
            Self::ItemBuffer => "item-buffer",
            Self::Surface => "surface",
            Self::Hemisphere => "hemisphere",
        }
    }

    /// Checks that the estimator is there, and that `backend` can serve it.
    fn check(self, backend: BackendKind) -> Result<()> {
        match self {
            Self::Coverage | Self::ItemBuffer => Ok(()),
            Self::Surface | Self::Hemisphere if backend.casts_rays() => Ok(()),
            Self::Surface | Self::Hemisphere => {
                let (name, backend) = (self.name(), backend.name());
                let message = format!("{name} needs rays, which backend {backend} does not cast; add --backend embree");
                Err(Error::Option { name: "--estimator", message })
            }
        }
    }
}

/// Which side of a triangle makes its visibility.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sides {
    /// The front.
    One,
    /// The better one: nothing visible is lost on open sheets and where windings disagree.
    #[default]
    Better,
    /// Both added, at most 1.
    Sum,
}

impl Sides {
    /// The name on the command line and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::One => "one",
            Self::Better => "better",
            Self::Sum => "sum",
        }
    }

    /// The visibility that front and back make together.
    pub(super) fn combine(self, front: f64, back: f64) -> f64 {
        match self {
            Self::One => front,
            Self::Better => front.max(back),
            Self::Sum => (front + back).min(1.0),
        }
    }
}

/// What [`Estimator::ItemBuffer`] does for a triangle that faces a camera but has no pixel in its picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DepthRescue {
    /// It counts as seen if one of its corners is not clearly behind the farthest of the four pixels around it, or if one
    /// of them is empty: what the paper describes, with tolerances of ours. Walls of up to three pixels leak.
    #[default]
    Plain,
    /// Only the nearest pixel counts, and only if it is empty or shows the same surface.
    Strict,
    /// It counts as hidden: biased low where triangles are smaller than pixels.
    None,
}

impl DepthRescue {
    /// The name on the command line and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Strict => "strict",
            Self::None => "none",
        }
    }
}

/// How visibility is measured. `Default` is the preset `best`.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasureOptions {
    /// Which cameras look.
    pub cameras: Cameras,
    /// How much each camera counts.
    pub camera_weights: CameraWeights,
    /// Pixels along an image's side, 16 to 16384; `None` chooses by the number of triangles.
    pub resolution: Option<u32>,
    /// Who looks.
    pub backend: BackendKind,
    /// What is counted.
    pub estimator: Estimator,
    /// Which side counts.
    pub sides: Sides,
    /// How rays are cast, where the estimator casts any.
    pub rays: RayOptions,
    /// What happens to triangles without a pixel; only [`Estimator::ItemBuffer`] asks.
    pub rescue: DepthRescue,
    /// Bytes that the images of all threads together may take; `None` for no limit.
    pub memory_limit: Option<u64>,
}

impl Default for MeasureOptions {
    fn default() -> Self {
        Self {
            cameras: Cameras::default(),
            camera_weights: CameraWeights::Area,
            resolution: None,
            backend: BackendKind::Raster,
            estimator: Estimator::Coverage,
            sides: Sides::Better,
            rays: RayOptions::default(),
            rescue: DepthRescue::Plain,
            memory_limit: None,
        }
    }
}

/// Up to this many triangles the paper's 480 pixels give the mean triangle about 170 counts.
const TRIANGLES_AT_480: f64 = 250_000.0;

impl MeasureOptions {
    /// The options of Zhang & Turk: their estimator, 480 pixels, equal weights, front side.
    #[must_use]
    pub fn paper() -> Self {
        Self {
            camera_weights: CameraWeights::Equal,
            resolution: Some(480),
            estimator: Estimator::ItemBuffer,
            sides: Sides::One,
            ..Self::default()
        }
    }

    /// Pixels along an image's side for a mesh of so many triangles: what was asked, or enough for about 170 counts on
    /// the mean triangle, between 480 and 4096, in steps of 32.
    #[must_use]
    pub fn resolution_for(&self, triangles: usize) -> u32 {
        self.resolution.unwrap_or_else(|| {
            let pixels = 480.0 * (triangles as f64 / TRIANGLES_AT_480).sqrt();
            (pixels.clamp(480.0, 4096.0).ceil() as u32).next_multiple_of(32)
        })
    }

    /// Whether the seed says where rays start or go.
    #[must_use]
    pub fn is_random(&self) -> bool {
        match self.estimator {
            Estimator::Coverage | Estimator::ItemBuffer => false,
            Estimator::Surface => self.rays.spreads_points(),
            Estimator::Hemisphere => true,
        }
    }

    /// The cameras that look.
    ///
    /// # Errors
    /// [`Error::Option`] for a number of cameras that no pattern has.
    pub fn camera_sphere(&self) -> Result<CameraSphere> {
        self.cameras.sphere(self.camera_weights)
    }

    /// Checks every option.
    ///
    /// # Errors
    /// [`Error::Option`] for a value outside its range, [`Error::Unavailable`] for what this version cannot do.
    pub fn check(&self) -> Result<()> {
        if let Some(resolution) = self.resolution
            && !(16..=16384).contains(&resolution)
        {
            return Err(Error::Option {
                name: "--resolution",
                message: format!("{resolution} pixels; an image has 16 to 16384 along a side"),
            });
        }
        self.cameras.check()?;
        self.backend.check()?;
        self.estimator.check(self.backend)?;
        self.rays.check()
    }
}
