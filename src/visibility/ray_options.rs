use crate::error::{Error, Result};

/// How the part of a triangle that a camera sees makes the F(t, v) of Zhang & Turk 2002, eq. (4.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PartlySeen {
    /// As its share: the points that the camera sees ÷ all points.
    #[default]
    Share,
    /// As the whole, like the paper: 1 if the camera sees any point.
    Whole,
}

impl PartlySeen {
    /// The name on the command line and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Share => "share",
            Self::Whole => "whole",
        }
    }
}

/// How [`super::Estimator::Surface`] and [`super::Estimator::Hemisphere`] cast rays.
#[derive(Debug, Clone, PartialEq)]
pub struct RayOptions {
    /// Points on each triangle from which `surface` looks at the cameras, 1 to 1024.
    pub points: u32,
    /// What `surface` makes of a triangle that a camera sees in part.
    pub partly_seen: PartlySeen,
    /// Rays that `hemisphere` casts from each side of a triangle, 8 to [`MOST_SAMPLES`]; taken up to a power of two.
    pub samples: u32,
    /// `hemisphere` adds rays until the standard error of V(M) is at most this; `None` casts what was asked for.
    pub target_error: Option<f64>,
    /// The same for the triangle that 99 of 100 are more exact than.
    pub target_error_p99: Option<f64>,
    /// Seed of where random points and rays go.
    pub seed: u64,
}

/// Most rays that `hemisphere` casts from each side of a triangle, whatever error was asked for.
pub const MOST_SAMPLES: u32 = 1 << 16;

impl Default for RayOptions {
    fn default() -> Self {
        Self {
            points: 1,
            partly_seen: PartlySeen::Share,
            samples: 64,
            target_error: None,
            target_error_p99: None,
            seed: 0,
        }
    }
}

impl RayOptions {
    /// Whether `surface` starts from points spread at random: 1, 3 and 4 stand where symmetry puts them.
    pub(super) fn spreads_points(&self) -> bool {
        ![1, 3, 4].contains(&self.points)
    }

    /// Checks every option.
    ///
    /// # Errors
    /// [`Error::Option`] for a value outside its range.
    pub(super) fn check(&self) -> Result<()> {
        if !(1..=1024).contains(&self.points) {
            let message = format!("{} points; a triangle has 1 to 1024", self.points);
            return Err(Error::Option { name: "--points", message });
        }
        if !(8..=MOST_SAMPLES).contains(&self.samples) {
            let message = format!("{} rays; a triangle casts 8 to {MOST_SAMPLES}", self.samples);
            return Err(Error::Option { name: "--samples", message });
        }
        check_error("--target-error", self.target_error)?;
        check_error("--target-error-p99", self.target_error_p99)
    }
}

fn check_error(name: &'static str, target: Option<f64>) -> Result<()> {
    match target {
        Some(error) if !(error > 0.0 && error < 1.0) => {
            let message = format!("{error}; a standard error lies above 0 and below 1, such as 0.001");
            Err(Error::Option { name, message })
        }
        _ => Ok(()),
    }
}
