use glam::DVec3;

use crate::camera::{CameraSphere, CameraWeights, random_rotation};
use crate::error::Result;

/// Which cameras look. `Default` is the octahedral pattern of 258, all around and not turned.
#[derive(Debug, Clone, PartialEq)]
pub struct Cameras {
    /// Where they stand.
    pub pattern: CameraPattern,
    /// Only those on the side toward which this direction points look, any length but 0; `None` for all around.
    ///
    /// The others count as cameras that see nothing, as if an endless floor lay in their way: see
    /// [`CameraSphere::within`].
    pub hemisphere: Option<DVec3>,
    /// Seed of a random rotation of the whole pattern; `None` leaves it as it is.
    pub rotation: Option<u64>,
}

/// Where cameras stand.
#[derive(Debug, Clone, PartialEq)]
pub enum CameraPattern {
    /// So many cameras of Zhang & Turk's pattern: 6, 18, 66, 258, 1026 or 4098.
    Octahedral(usize),
    /// So many cameras on a spiral: an even number, 6 to 65,536.
    Fibonacci(usize),
    /// 266 cameras, every 15 degrees in latitude and longitude.
    Latlong,
    /// Cameras one by one.
    Listed(CameraList),
}

/// Cameras one by one, and who says so.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraList {
    /// The file they come from, or another name.
    pub name: String,
    /// Directions of any length from the object toward the camera, with weights above 0.
    pub cameras: Vec<(DVec3, f64)>,
}

impl CameraPattern {
    /// The name on the command line and in reports.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Octahedral(_) => "octahedral",
            Self::Fibonacci(_) => "fibonacci",
            Self::Latlong => "latlong",
            Self::Listed(_) => "file",
        }
    }
}

impl Default for Cameras {
    fn default() -> Self {
        Self::octahedral(Self::DEFAULT_COUNT)
    }
}

/// Seeds of rotations that users ask for start here, those of the looks for hidden triangles at 0: the looks must not
/// repeat the directions that the measurement used.
const FIRST_SEED: u64 = 1 << 32;

impl Cameras {
    /// Cameras of the default.
    pub const DEFAULT_COUNT: usize = 258;

    /// So many cameras of the octahedral pattern, all around.
    #[must_use]
    pub fn octahedral(count: usize) -> Self {
        Self { pattern: CameraPattern::Octahedral(count), hemisphere: None, rotation: None }
    }

    /// The cameras themselves.
    ///
    /// # Errors
    /// As [`Self::check`].
    pub fn sphere(&self, weights: CameraWeights) -> Result<CameraSphere> {
        let pattern = match &self.pattern {
            CameraPattern::Octahedral(count) => CameraSphere::octahedral(*count, weights)?,
            CameraPattern::Fibonacci(count) => CameraSphere::fibonacci(*count)?,
            CameraPattern::Latlong => CameraSphere::latlong(weights),
            CameraPattern::Listed(list) => CameraSphere::listed(&list.cameras, weights)?,
        };
        let turned = match self.rotation {
            Some(seed) => pattern.rotated(random_rotation(FIRST_SEED.wrapping_add(seed))),
            None => pattern,
        };
        match self.hemisphere {
            Some(toward) => turned.within(toward),
            None => Ok(turned),
        }
    }

    /// Checks that there are such cameras.
    ///
    /// # Errors
    /// [`crate::Error::Option`] for a number that the pattern does not have, a list of a single camera or with a
    /// direction of no length, a hemisphere without cameras.
    pub fn check(&self) -> Result<()> {
        self.sphere(CameraWeights::Equal).map(drop)
    }
}
