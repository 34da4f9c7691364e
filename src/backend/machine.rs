use crate::backend::{BackendKind, Brute, ItemBuffers, Occlusion};
#[cfg(feature = "embree")]
use crate::backend::{EmbreeScene, GridScratch};
use crate::camera::{UnitMesh, View, Window};
use crate::error::{Error, Result};
use crate::raster::{ItemBufferPair, Scene, Screen};

/// A mesh laid out for the backend that was asked for.
#[derive(Debug)]
pub enum Machine {
    /// For the CPU rasteriser.
    Raster(Scene),
    /// For ray casting with Embree.
    #[cfg(feature = "embree")]
    Embree(EmbreeScene),
    /// For the judge.
    Brute(Brute),
}

/// What a worker of a [`Machine`] keeps from view to view.
#[derive(Debug, Default)]
pub struct MachineScratch {
    screen: Screen,
    #[cfg(feature = "embree")]
    grid: GridScratch,
}

impl Machine {
    /// Lays out a mesh for a backend.
    ///
    /// # Errors
    /// [`Error::Unavailable`] for a backend that this build or machine does not have; what the library behind it says.
    pub fn new(kind: BackendKind, mesh: UnitMesh) -> Result<Self> {
        kind.check()?;
        match kind {
            #[cfg(feature = "embree")]
            BackendKind::Embree => Ok(Self::Embree(EmbreeScene::new(&mesh)?)),
            BackendKind::Brute => Ok(Self::Brute(Brute::new(&mesh))),
            _ => Ok(Self::Raster(Scene::new(mesh))),
        }
    }

    /// Which backend this is.
    #[must_use]
    pub fn kind(&self) -> BackendKind {
        match self {
            Self::Raster(_) => BackendKind::Raster,
            #[cfg(feature = "embree")]
            Self::Embree(_) => BackendKind::Embree,
            Self::Brute(_) => BackendKind::Brute,
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
            #[cfg(feature = "embree")]
            Self::Embree(scene) => Ok(scene),
            Self::Brute(brute) => Ok(brute),
        }
    }
}

impl ItemBuffers for Machine {
    type Scratch = MachineScratch;

    fn draw(&self, view: &View, scratch: &mut MachineScratch, buffers: &mut ItemBufferPair) -> Result<()> {
        match self {
            Self::Raster(scene) => scene.draw(view, &mut scratch.screen, buffers),
            #[cfg(feature = "embree")]
            Self::Embree(scene) => scene.draw(view, &mut scratch.grid, buffers),
            Self::Brute(brute) => brute.draw(view, &mut (), buffers),
        }
    }

    fn bytes_per_worker(&self, window: Window) -> u64 {
        match self {
            Self::Raster(scene) => scene.bytes_per_worker(window),
            #[cfg(feature = "embree")]
            Self::Embree(scene) => scene.bytes_per_worker(window),
            Self::Brute(brute) => brute.bytes_per_worker(window),
        }
    }
}
