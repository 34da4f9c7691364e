//! How visible each triangle is.
//!
//! Source: Zhang & Turk 2002, eqs. (3.1), (3.2) and (4.3).

use crate::backend::BackendKind;
use crate::camera::CameraWeights;
use crate::error::Result;
use crate::mesh::TriMesh;
use crate::progress::Progress;

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

/// Which side of a triangle makes its visibility.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sides {
    /// The front.
    One,
    /// The better one.
    #[default]
    Better,
    /// Both added, at most 1.
    Sum,
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
}

/// The visibility of every triangle of a mesh.
#[derive(Debug, Clone)]
pub struct Visibility {}

impl Visibility {
    /// One number per triangle, 0 to 1, under the rule for sides: clamped, and pooled where triangles are too small.
    #[must_use]
    pub fn per_triangle(&self) -> &[f64] {
        &[]
    }

    /// Visibility of the mesh, eq. (3.2): one-sided, area-weighted, unclamped.
    #[must_use]
    pub fn of_mesh(&self) -> f64 {
        0.0
    }

    /// The same mean under the rule for sides.
    #[must_use]
    pub fn of_mesh_sides(&self) -> f64 {
        0.0
    }

    /// Triangles that no camera sees from either side.
    #[must_use]
    pub fn never_seen(&self) -> usize {
        0
    }

    /// Pixels along an image's side that were used.
    #[must_use]
    pub fn resolution(&self) -> u32 {
        0
    }
}

/// Looks at `mesh` from all cameras.
///
/// # Errors
/// [`crate::Error::Option`], [`crate::Error::Unavailable`], [`crate::Error::Cancelled`].
pub fn measure(_mesh: &TriMesh, _options: &MeasureOptions, _progress: &dyn Progress) -> Result<Visibility> {
    Ok(Visibility {})
}
