//! Who looks: the machines that draw item buffers and that say whether rays are blocked.
//!
//! A backend implements [`ItemBuffers`], [`Occlusion`] or both; [`Machine`] is the one that was asked for. [`draw_all`]
//! runs item buffers over many views in parallel. [`Brute`] is the judge: a page of slow, obvious code that tests compare
//! the others with.

mod brute;
mod coincident;
#[cfg(feature = "embree")]
mod embree;
mod machine;
mod parallel;
mod raster;

pub use brute::Brute;
#[cfg(feature = "embree")]
pub use embree::{EmbreeScene, GridScratch};
pub use machine::{Machine, MachineScratch};
pub use parallel::{Workload, draw_all};

use crate::camera::{View, Window};
use crate::error::{Error, Result};
use crate::mesh::TriangleId;
use crate::raster::ItemBufferPair;

/// The machine that looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BackendKind {
    /// The CPU rasteriser, always there.
    #[default]
    Raster,
    /// Ray casting with Embree.
    Embree,
    /// Rasterisation through wgpu.
    Gpu,
    /// The judge, far too slow for anything but tests.
    Brute,
}

impl BackendKind {
    /// The name on the command line and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Raster => "raster",
            Self::Embree => "embree",
            Self::Gpu => "gpu",
            Self::Brute => "brute",
        }
    }

    /// Whether it can say that a ray is blocked; all can draw pictures.
    #[must_use]
    pub fn casts_rays(self) -> bool {
        matches!(self, Self::Embree | Self::Brute)
    }

    /// Says whether this build and machine have the backend.
    ///
    /// # Errors
    /// [`Error::Unavailable`], saying what to use instead.
    pub fn check(self) -> Result<()> {
        match self {
            Self::Raster | Self::Brute => Ok(()),
            #[cfg(feature = "embree")]
            Self::Embree => embree::check(),
            #[cfg(not(feature = "embree"))]
            Self::Embree => Err(Error::Unavailable {
                message:
                    "backend embree is not available: this program was built without the feature `embree`; install \
                          Embree (Debian, Ubuntu: apt-get install libembree-dev libclang-dev) and build with \
                          `--features embree`, or use --backend raster"
                        .to_owned(),
            }),
            Self::Gpu => Err(Error::Unavailable {
                message: format!(
                    "backend {} is not available: this version does not have it yet; use --backend raster",
                    self.name()
                ),
            }),
        }
    }
}

/// Draws the near and far item buffer of a view of one mesh.
pub trait ItemBuffers: Sync {
    /// What a worker keeps from view to view.
    type Scratch: Default + Send;

    /// Draws both item buffers, over what they held.
    ///
    /// # Errors
    /// [`Error::Limit`] where the mesh cannot be drawn through the view's window.
    fn draw(&self, view: &View, scratch: &mut Self::Scratch, buffers: &mut ItemBufferPair) -> Result<()>;

    /// Bytes that one worker needs, its buffers included.
    fn bytes_per_worker(&self, window: Window) -> u64;
}

/// A ray from a point to infinity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Where it starts, in unit-sphere units.
    pub origin: [f32; 3],
    /// Unit vector along it.
    pub direction: [f32; 3],
    /// The triangle that it starts on, which does not block it.
    pub own: Option<TriangleId>,
}

/// Answers in batches whether rays are blocked.
pub trait Occlusion: Sync {
    /// Says for each ray whether a triangle other than its own crosses it, whichever side it shows; `blocked` is as long as
    /// `rays`.
    ///
    /// # Errors
    /// What the library behind the backend says.
    fn blocked(&self, rays: &[Ray], blocked: &mut [bool]) -> Result<()>;
}
