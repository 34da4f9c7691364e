use crate::backend::{BackendKind, Brute, ItemBuffers, Occlusion};
use crate::camera::{UnitMesh, View, Window};
use crate::error::{Error, Result};
use crate::raster::{ItemBufferPair, Scene, Screen};

/// A mesh laid out for the backend that was asked for.
#[derive(Debug)]
pub enum Machine {
    /// For the CPU rasteriser.
    Raster(Scene),
    /// For the judge.
    Brute(Brute),
}

/// What a worker of a [`Machine`] keeps from view to view.
#[derive(Debug, Default)]
pub struct MachineScratch {
    screen: Screen,
}

impl Machine {
    /// Lays out a mesh for a backend.
    ///
    /// # Errors
    /// [`Error::Unavailable`] for a backend that this build or machine does not have.
    pub fn new(kind: BackendKind, mesh: UnitMesh) -> Result<Self> {
        kind.check()?;
        match kind {
            BackendKind::Brute => Ok(Self::Brute(Brute::new(&mesh))),
            _ => Ok(Self::Raster(Scene::new(mesh))),
        }
    }

    /// The same machine as one that casts rays.
    ///
    /// # Errors
    /// [`Error::Option`] for a backend that only draws.
    pub fn occlusion(&self) -> Result<&dyn Occlusion> {
        match self {
            Self::Raster(_) => Err(Error::Option {
                name: "--backend",
                message: "raster draws pictures and casts no rays; this estimator needs --backend embree".to_owned(),
            }),
            Self::Brute(brute) => Ok(brute),
        }
    }
}

impl ItemBuffers for Machine {
    type Scratch = MachineScratch;

    fn draw(&self, view: &View, scratch: &mut MachineScratch, buffers: &mut ItemBufferPair) -> Result<()> {
        match self {
            Self::Raster(scene) => scene.draw(view, &mut scratch.screen, buffers),
            Self::Brute(brute) => brute.draw(view, &mut (), buffers),
        }
    }

    fn bytes_per_worker(&self, window: Window) -> u64 {
        match self {
            Self::Raster(scene) => scene.bytes_per_worker(window),
            Self::Brute(brute) => brute.bytes_per_worker(window),
        }
    }
}
