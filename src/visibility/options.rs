use crate::backend::BackendKind;
use crate::camera::{CameraSphere, CameraWeights};
use crate::error::{Error, Result};

/// What is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Estimator {
    /// Pixels, weighted: unbiased at any triangle size.
    #[default]
    Coverage,
    /// The paper's: a camera sees a triangle or it does not.
    ItemBuffer,
    /// Rays from points on the triangle to the cameras.
    Surface,
    /// Cosine-distributed rays.
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

    pub(super) fn unavailable(self) -> Error {
        let message = format!(
            "estimator {} is not available: this version does not have it yet; use --estimator coverage",
            self.name()
        );
        Error::Unavailable { message }
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

/// How visibility is measured. `Default` is the preset `best`.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasureOptions {
    /// Number of octahedral cameras: 6, 18, 66, 258, 1026 or 4098.
    pub cameras: usize,
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
    /// Bytes that the images of all threads together may take; `None` for no limit.
    pub memory_limit: Option<u64>,
}

impl Default for MeasureOptions {
    fn default() -> Self {
        Self {
            cameras: 258,
            camera_weights: CameraWeights::Area,
            resolution: None,
            backend: BackendKind::Raster,
            estimator: Estimator::Coverage,
            sides: Sides::Better,
            memory_limit: None,
        }
    }
}

/// Up to this many triangles the paper's 480 pixels give the mean triangle about 170 counts.
const TRIANGLES_AT_480: f64 = 250_000.0;

impl MeasureOptions {
    /// The options nearest to the text of Zhang & Turk that this version can do: 480 pixels, equal weights, front side.
    ///
    /// Their estimator, [`Estimator::ItemBuffer`], is not there yet; the preset counts coverage.
    #[must_use]
    pub fn paper() -> Self {
        Self { camera_weights: CameraWeights::Equal, resolution: Some(480), sides: Sides::One, ..Self::default() }
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

    /// The cameras that look.
    ///
    /// # Errors
    /// [`Error::Option`] for a number of cameras that no pattern has.
    pub fn camera_sphere(&self) -> Result<CameraSphere> {
        CameraSphere::octahedral(self.cameras, self.camera_weights)
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
        self.backend.check()?;
        match self.estimator {
            Estimator::Coverage => Ok(()),
            other => Err(other.unavailable()),
        }
    }
}
