//! Flags that several commands share. A flag means the same in every command.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, ValueEnum};

use outsight::backend::BackendKind;
use outsight::camera::CameraWeights;
use outsight::error::{Error, Result};
use outsight::io::{Format, ReadOptions};
use outsight::pipeline::{self, PageRequest};
use outsight::report::colour::ColourMap;
use outsight::visibility::{DepthRescue, Estimator, PartlySeen, Sides};

use super::cameras::CameraFlags;
use super::progress::Show;
use super::values;

/// Flags of every command.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Everywhere")]
pub struct GlobalFlags {
    /// Print one JSON object instead of text
    #[arg(long, global = true)]
    pub json: bool,
    /// Replace outputs that are there already
    #[arg(long, global = true)]
    pub force: bool,
    /// Treat warnings as errors
    #[arg(long, global = true)]
    pub strict: bool,
    /// Say nothing but errors, and what --json or - asks for
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Say more
    #[arg(short, long, global = true)]
    pub verbose: bool,
    /// Show progress on a terminal only, always, or never
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto")]
    pub progress: Show,
    /// Threads to use; any number gives the same result [default: all]
    #[arg(long, global = true, value_name = "N", value_parser = values::threads)]
    pub threads: Option<usize>,
    /// Refuse work that needs more memory than this, as in 2G or 500M
    #[arg(long, global = true, value_name = "SIZE", value_parser = values::bytes)]
    pub memory_limit: Option<u64>,
    /// Give up after this many seconds; what is whole by then stays
    #[arg(long, global = true, value_name = "SECONDS", value_parser = values::seconds)]
    pub time_limit: Option<Duration>,
    /// Seed of everything random
    #[arg(long, global = true, value_name = "N", default_value_t = 0)]
    pub seed: u64,
}

impl GlobalFlags {
    /// Starts the threads that all parallel work shares.
    ///
    /// # Errors
    /// [`Error::Limit`] if the system refuses to.
    pub fn start_threads(&self) -> Result<()> {
        let Some(threads) = self.threads else { return Ok(()) };
        rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().map_err(|e| Error::Limit {
            message: format!("--threads {threads}: the system does not start that many ({e}); ask for fewer"),
        })
    }
}

/// The mesh a command reads.
#[derive(Debug, Clone, Args)]
pub struct InputFlags {
    /// Mesh file: PLY, OBJ, STL or OFF, also with .zst or .gz behind; - is standard input
    #[arg(value_name = "MESH")]
    pub mesh: PathBuf,
    #[command(flatten)]
    pub reading: ReadingFlags,
}

/// How meshes are read.
#[derive(Debug, Clone, Args)]
pub struct ReadingFlags {
    /// Format of the input, where its name does not say it
    #[arg(long, value_name = "FORMAT")]
    input_format: Option<FormatName>,
    /// Merge vertices at exactly equal positions
    #[arg(long)]
    weld: bool,
}

impl ReadingFlags {
    /// The library's options for these flags.
    pub fn options(&self, global: &GlobalFlags) -> ReadOptions {
        ReadOptions { format: self.input_format.map(Format::from), weld: self.weld, memory_limit: global.memory_limit }
    }
}

/// What is up in pictures.
#[derive(Debug, Clone, Args)]
pub struct UpFlags {
    /// Direction that points up in pictures
    #[arg(long, value_name = "X,Y,Z", default_value = "0,0,1", allow_hyphen_values = true)]
    #[arg(value_parser = values::direction)]
    pub up: [f64; 3],
}

/// The page that shows a result.
#[derive(Debug, Clone, Args)]
pub struct PageFlags {
    /// Write a page with numbers, plots, pictures and models to turn: .html, one file that loads nothing
    #[arg(long = "report", value_name = "FILE")]
    pub page: Option<PathBuf>,
    #[command(flatten)]
    pub up: UpFlags,
}

impl PageFlags {
    /// The library's request for these flags, given in this command line.
    pub fn request(&self, command_line: &str) -> Option<PageRequest> {
        let commands = vec![command_line.to_owned()];
        self.page.clone().map(|output| PageRequest { output, up: self.up.up, commands, names: Vec::new() })
    }
}

/// How visibility is measured.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Looking")]
pub struct LookingFlags {
    /// Defaults for the best results, or near the text of Zhang & Turk 2002
    #[arg(long, value_name = "NAME", default_value = "best")]
    pub preset: Preset,
    #[command(flatten)]
    pub cameras: CameraFlags,
    /// Cameras count by the solid angle they own, or alike [best: area, paper: equal]
    #[arg(long, value_name = "HOW")]
    pub camera_weights: Option<CameraWeightsName>,
    /// Pixels along each image's side, 16 to 16384 [best: by triangles, paper: 480]
    #[arg(long, value_name = "W", value_parser = clap::value_parser!(u32).range(16..=16384))]
    pub resolution: Option<u32>,
    /// The machine that looks [default: auto: raster, but embree for estimators that cast rays]
    #[arg(long, value_name = "NAME")]
    pub backend: Option<BackendName>,
    /// What is counted [best: coverage, paper: item-buffer]
    #[arg(long, value_name = "NAME")]
    pub estimator: Option<EstimatorName>,
    /// Visibility of a triangle's front, better side, or both added [best: better; paper and item-buffer: one]
    #[arg(long, value_name = "WHICH")]
    pub sides: Option<SidesName>,
    /// item-buffer: when a triangle without a pixel counts as seen, by its depth [default: plain]
    #[arg(long, value_name = "RULE")]
    pub rescue: Option<RescueName>,
    #[command(flatten)]
    pub rays: RayFlags,
}

/// How rays are cast; each flag belongs to one estimator.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Casting rays")]
pub struct RayFlags {
    /// surface: points of each triangle that look at the cameras, 1 to 1024 [default: 1]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub points: Option<u32>,
    /// surface: a triangle seen in part counts by its share of seen points, or as a whole [default: share]
    #[arg(long, value_name = "HOW")]
    pub partly_seen: Option<PartlySeenName>,
    /// hemisphere: rays from each side of a triangle, 8 to 65536, taken up to a power of two [default: 64]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(8..=65536))]
    pub samples: Option<u32>,
    /// hemisphere: cast more rays until the standard error of the mesh's visibility is at most this
    #[arg(long, value_name = "ERROR", value_parser = values::standard_error, allow_negative_numbers = true)]
    pub target_error: Option<f64>,
    /// hemisphere: the same for the triangle that 99 of 100 are more exact than
    #[arg(long, value_name = "ERROR", value_parser = values::standard_error, allow_negative_numbers = true)]
    pub target_error_p99: Option<f64>,
}

impl RayFlags {
    /// The flags that were given, each with the estimators that it belongs to.
    pub fn given(&self) -> impl Iterator<Item = Owned> {
        let all = [
            (self.points.is_some(), "--points", SURFACE),
            (self.partly_seen.is_some(), "--partly-seen", SURFACE),
            (self.samples.is_some(), "--samples", HEMISPHERE),
            (self.target_error.is_some(), "--target-error", HEMISPHERE),
            (self.target_error_p99.is_some(), "--target-error-p99", HEMISPHERE),
        ];
        only_given(all)
    }
}

/// A flag, and the estimators that make anything of it.
type Owned = (&'static str, &'static [Estimator]);

const SURFACE: &[Estimator] = &[Estimator::Surface];
const HEMISPHERE: &[Estimator] = &[Estimator::Hemisphere];
/// They count pixels.
const DRAWING: &[Estimator] = &[Estimator::Coverage, Estimator::ItemBuffer];
/// They look from cameras; of [`Estimator::Hemisphere`] these only say on which side they stand.
const WITH_CAMERAS: &[Estimator] = &[Estimator::Coverage, Estimator::ItemBuffer, Estimator::Surface];

fn only_given<const N: usize>(flags: [(bool, &'static str, &'static [Estimator]); N]) -> impl Iterator<Item = Owned> {
    flags.into_iter().filter(|(given, ..)| *given).map(|(_, name, owners)| (name, owners))
}

impl LookingFlags {
    /// The flags that were given and that not every estimator uses.
    pub fn owned(&self) -> impl Iterator<Item = Owned> {
        let own = [
            (self.camera_weights.is_some(), "--camera-weights", WITH_CAMERAS),
            (self.resolution.is_some(), "--resolution", DRAWING),
            (self.rescue.is_some(), "--rescue", &[Estimator::ItemBuffer]),
        ];
        let cameras = self.cameras.without_side().map(|name| (name, WITH_CAMERAS));
        cameras.chain(only_given(own)).chain(self.rays.given())
    }
}

/// What stands around the mesh.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Looking")]
pub struct OccluderFlags {
    /// Mesh in the same coordinates that hides and is not measured, as a floor; may be given several times
    #[arg(long = "occluder", value_name = "FILE")]
    pub occluders: Vec<PathBuf>,
}

/// A set of defaults.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Preset {
    // The best results.
    #[default]
    Best,
    // Nearest to the text of Zhang & Turk 2002.
    Paper,
}

impl From<Preset> for pipeline::Preset {
    fn from(preset: Preset) -> Self {
        match preset {
            Preset::Best => Self::Best,
            Preset::Paper => Self::Paper,
        }
    }
}

/// Declares an enum of flag values, each standing for a value of the library.
macro_rules! names {
    ($(#[$meta:meta])* $name:ident => $target:ty { $($(#[$doc:meta])* $variant:ident => $value:expr),+ $(,)? }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
        pub enum $name { $($(#[$doc])* $variant),+ }

        impl From<$name> for $target {
            fn from(name: $name) -> Self {
                match name { $($name::$variant => $value),+ }
            }
        }
    };
}

pub(super) use names;

names! {
    /// A mesh format that is read.
    FormatName => Format { Ply => Format::Ply, Obj => Format::Obj, Stl => Format::Stl, Off => Format::Off }
}

names! {
    /// A mesh format that is written.
    OutputFormatName => Format {
        Ply => Format::Ply,
        Obj => Format::Obj,
        Stl => Format::Stl,
        Off => Format::Off,
        Glb => Format::Glb,
    }
}

names! {
    /// `--camera-weights`.
    CameraWeightsName => CameraWeights {
        // By the solid angle it owns
        Area => CameraWeights::Area,
        // All alike
        Equal => CameraWeights::Equal,
    }
}

names! {
    /// `--backend`.
    BackendName => BackendKind {
        // raster, but embree for estimators that cast rays: the same everywhere
        Auto => BackendKind::Raster,
        // CPU rasteriser, always there
        Raster => BackendKind::Raster,
        // Ray casting with Embree
        Embree => BackendKind::Embree,
        // GPU rasteriser, not there yet
        #[value(hide = true)]
        Gpu => BackendKind::Gpu,
    }
}

names! {
    /// `--estimator`.
    EstimatorName => Estimator {
        // Weighted pixels: unbiased at any triangle size
        Coverage => Estimator::Coverage,
        // The paper's: a camera sees a triangle or not
        ItemBuffer => Estimator::ItemBuffer,
        // Rays from the triangle to the cameras; by Embree
        Surface => Estimator::Surface,
        // Rays spread by the cosine, with a standard error; by Embree
        Hemisphere => Estimator::Hemisphere,
    }
}

names! {
    /// `--partly-seen`.
    PartlySeenName => PartlySeen {
        // Seen points ÷ all points
        Share => PartlySeen::Share,
        // 1 if any point is seen, as in the paper
        Whole => PartlySeen::Whole,
    }
}

names! {
    /// `--sides`.
    SidesName => Sides {
        // The front
        One => Sides::One,
        // The better one
        Better => Sides::Better,
        // Both added
        Sum => Sides::Sum,
    }
}

names! {
    /// `--rescue`.
    RescueName => DepthRescue {
        // Seen unless the depth buffer is clearly in front; walls of up to three pixels leak
        Plain => DepthRescue::Plain,
        // Seen only where the nearest pixel is empty or shows the same surface
        Strict => DepthRescue::Strict,
        // Hidden
        None => DepthRescue::None,
    }
}

names! {
    /// `--colour-map`.
    ColourMapName => ColourMap {
        // White, red, yellow, green, as in the paper
        Paper => ColourMap::Paper,
        // Dark blue to yellow, readable for every eye
        Cividis => ColourMap::Cividis,
    }
}
