//! Who looks: the machines that draw item buffers.
//!
//! A backend implements [`ItemBuffers`]; [`draw_all`] runs it over many views in parallel. [`Brute`] is the judge: a
//! page of slow, obvious code that tests compare the others with.

mod brute;
mod parallel;
mod raster;

pub use brute::Brute;
pub use parallel::{Workload, draw_all};

use crate::camera::{View, Window};
use crate::error::{Error, Result};
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
}

impl BackendKind {
    /// The name on the command line and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Raster => "raster",
            Self::Embree => "embree",
            Self::Gpu => "gpu",
        }
    }

    /// Says whether this build and machine have the backend.
    ///
    /// # Errors
    /// [`Error::Unavailable`], saying what to use instead.
    pub fn check(self) -> Result<()> {
        match self {
            Self::Raster => Ok(()),
            Self::Embree | Self::Gpu => Err(Error::Unavailable {
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
