//! Outsight measures how well each triangle of a mesh can be seen from outside, and spends triangles where they are
//! seen.
//!
//! The straight path, from mesh file to result, is written out in [`pipeline`]; every module stands on those above it:
//! [`error`], [`progress`], [`geom`] · [`mesh`] · [`io`], [`camera`], [`simplify`] · [`raster`] · [`backend`] ·
//! [`visibility`], [`eval`] · [`report`], [`pipeline`].

pub mod backend;
pub mod camera;
pub mod error;
pub mod eval;
pub mod geom;
pub mod io;
pub mod mesh;
pub mod pipeline;
pub mod progress;
pub mod raster;
pub mod report;
pub mod simplify;
pub mod visibility;

pub use error::{Error, Result};
