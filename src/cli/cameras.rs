//! Flags that say which cameras look.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use glam::DVec3;
use outsight::camera::{CameraList, CameraPattern, CameraSphere, Cameras};
use outsight::error::{Error, Result};
use outsight::io;

use super::values;

/// Which cameras look.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Looking")]
pub struct CameraFlags {
    /// Cameras around the mesh: 6, 18, 66, 258, 1026, 4098; fibonacci: an even number [default: 258]
    #[arg(long, value_name = "N")]
    cameras: Option<usize>,
    /// How cameras stand around the mesh [default: octahedral]
    #[arg(long, value_name = "NAME")]
    camera_pattern: Option<PatternName>,
    /// Cameras from a file: a line x y z each, from the mesh toward it, with a weight behind if it shall count more
    #[arg(long, value_name = "FILE", conflicts_with_all = ["cameras", "camera_pattern"])]
    camera_file: Option<PathBuf>,
    /// Only cameras on this side look, as +y: nothing is ever seen from the other, as if a floor lay there
    #[arg(long, value_name = "SIDE", allow_hyphen_values = true, value_parser = values::side)]
    hemisphere: Option<[f64; 3]>,
    /// Turn all cameras at random, by this seed [default: not turned]
    #[arg(long, value_name = "SEED")]
    camera_rotation: Option<u64>,
}

/// `--camera-pattern`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum PatternName {
    // An octahedron, subdivided
    Octahedral,
    // A spiral from pole to pole
    Fibonacci,
    // Every 15 degrees in latitude and longitude, 266 cameras
    Latlong,
}

impl CameraFlags {
    /// The flags that were given, but for `--hemisphere`, which says something to whoever looks without cameras too.
    pub fn without_side(&self) -> impl Iterator<Item = &'static str> {
        let all = [
            (self.cameras.is_some(), "--cameras"),
            (self.camera_pattern.is_some(), "--camera-pattern"),
            (self.camera_file.is_some(), "--camera-file"),
            (self.camera_rotation.is_some(), "--camera-rotation"),
        ];
        all.into_iter().filter(|(given, _)| *given).map(|(_, name)| name)
    }

    /// The cameras under these flags; those of `preset` where they say nothing.
    ///
    /// # Errors
    /// As [`io::read_cameras`]; [`Error::Option`] for a number of cameras that the pattern does not have.
    pub fn cameras(&self, preset: Cameras) -> Result<Cameras> {
        Ok(Cameras {
            pattern: self.pattern(preset.pattern)?,
            hemisphere: self.hemisphere.map(DVec3::from_array).or(preset.hemisphere),
            rotation: self.camera_rotation.or(preset.rotation),
        })
    }

    fn pattern(&self, preset: CameraPattern) -> Result<CameraPattern> {
        if let Some(file) = &self.camera_file {
            let list = CameraList { name: file.display().to_string(), cameras: io::read_cameras(file)? };
            return Ok(CameraPattern::Listed(list));
        }
        match (self.camera_pattern, self.cameras) {
            (None, None) => Ok(preset),
            (None | Some(PatternName::Octahedral), count) => Ok(CameraPattern::Octahedral(count.unwrap_or(258))),
            (Some(PatternName::Fibonacci), count) => Ok(CameraPattern::Fibonacci(count.unwrap_or(258))),
            (Some(PatternName::Latlong), None | Some(CameraSphere::LATLONG)) => Ok(CameraPattern::Latlong),
            (Some(PatternName::Latlong), Some(count)) => {
                let message = format!("latlong has {} cameras, not {count}; leave this out", CameraSphere::LATLONG);
                Err(Error::Option { name: "--cameras", message })
            }
        }
    }
}
