//! How visible each triangle is: the share of camera directions that see it, each counted by its cosine.
//!
//! Sources: Zhang & Turk 2002, eqs. (3.1) V of a point, (3.2) V of a mesh, (4.3) V from cameras. The estimator
//! `coverage` replaces their F(t, v), seen or not, by the share of the triangle's image that is seen; the cosines of
//! eq. (4.3) then cancel, and counting pixels is enough.

pub mod agreement;
mod convergence;
mod coverage;
mod diagram;
mod estimate;
mod explain;
mod fractions;
mod hemisphere;
mod hidden;
mod importance;
mod item_buffer;
mod kept;
mod leaks;
mod options;
pub mod outline;
mod per_vertex;
mod pieces;
mod pool;
mod ray_options;
mod rays;
mod rescue;
mod setting;
mod shapes;
mod subject;
mod surface;

pub use convergence::{NestedVisibility, mean_difference, nested_resolution, nested_visibility, surface_mean};
pub use coverage::CoverageCounts;
pub use diagram::{DiagramRecorder, VisibilityDiagram};
pub use explain::{CameraSight, Explaining, Explanation, Sight, explain};
pub use fractions::visible_fractions;
pub use importance::{Hidden, importance};
pub use kept::{KeptFault, KeptMeasurement, MeasurementKey};
pub use options::{DepthRescue, Estimator, MeasureOptions, Sides};
pub use per_vertex::per_vertex;
pub use pieces::estimated_pieces;
pub use ray_options::{MOST_SAMPLES, PartlySeen, RayOptions};
pub use setting::Setting;
pub use subject::Subject;

use serde::{Deserialize, Serialize};

use crate::error::Result;
use crate::mesh::TriMesh;
use crate::progress::Progress;
use shapes::Shapes;

/// The visibility of every triangle of a mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Visibility {
    front: Vec<f64>,
    back: Vec<f64>,
    per_triangle: Vec<f64>,
    seen: Vec<bool>,
    of_mesh: f64,
    of_mesh_sides: f64,
    resolution: u32,
    cameras: usize,
    details: Details,
}

/// What only some estimators can say.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Details {
    /// How exact the numbers are, from [`Estimator::Hemisphere`].
    pub standard_error: Option<StandardError>,
    /// Depth rescue, from [`Estimator::ItemBuffer`].
    pub rescue: Option<Rescue>,
    /// Pieces that the triangles were cut into, from [`Estimator::ItemBuffer`].
    pub pieces: Option<usize>,
    /// Rays that were cast, 0 where pictures were drawn.
    pub rays: u64,
}

/// Standard error of a measurement: one standard deviation of what it would give if repeated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StandardError {
    /// Of each triangle's V, front side.
    pub per_triangle: Vec<f64>,
    /// Of V(M).
    pub of_mesh: f64,
    /// Of the triangle that 99 of 100 are more exact than.
    pub p99: f64,
    /// Rays cast from each side of a triangle.
    pub samples: u32,
    /// Why there were not more.
    pub end: SamplingEnd,
}

/// Why [`Estimator::Hemisphere`] stopped casting rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum SamplingEnd {
    /// They are what was asked for.
    AsAsked,
    /// The errors asked for are reached.
    TargetReached,
    /// A triangle casts no more than [`MOST_SAMPLES`]; the errors asked for are not reached.
    MostSamples,
}

impl SamplingEnd {
    /// The name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::AsAsked => "samples",
            Self::TargetReached => "target",
            Self::MostSamples => "most_samples",
        }
    }
}

/// How often a triangle without a pixel was called seen by its depth; Zhang & Turk 2002, section 4.
///
/// Counted are pairs of a piece of a triangle and a camera that faces a side of it which needs rescue: the front, and the
/// back too unless [`Sides::One`] is in force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Rescue {
    /// Pairs with a pixel.
    pub with_pixel: u64,
    /// Pairs without.
    pub without_pixel: u64,
    /// Those without that the depth buffer let pass.
    pub rescued: u64,
    /// How many of those are hidden after all; `None` where no rays could be cast: the backend only draws, and Embree is not
    /// there.
    pub leaks: Option<RescueLeaks>,
}

/// A random sample of the pairs that depth rescue called seen, asked again by exact rays.
///
/// A pair leaks if rays toward the camera are blocked from all of four points of the piece: its centroid, and one near each
/// corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct RescueLeaks {
    /// Pairs asked about: all that were rescued, or 4096 of them.
    pub sampled: u64,
    /// Those that leak.
    pub leaking: u64,
}

impl RescueLeaks {
    /// The share that leaks; `None` where nothing was rescued.
    #[must_use]
    pub fn rate(&self) -> Option<f64> {
        (self.sampled > 0).then(|| self.leaking as f64 / self.sampled as f64)
    }
}

impl Rescue {
    /// The share of the pairs called seen that have no pixel; 0 where none are seen.
    #[must_use]
    pub fn rate(&self) -> f64 {
        self.rescued as f64 / (self.with_pixel + self.rescued).max(1) as f64
    }
}

impl Visibility {
    /// One number per triangle, 0 to 1, under the rule for sides: clamped, and pooled where triangles are too small.
    #[must_use]
    pub fn per_triangle(&self) -> &[f64] {
        &self.per_triangle
    }

    /// V of each triangle's front side as counted: neither clamped nor pooled, so that it may pass 1 on tiny triangles.
    #[must_use]
    pub fn front(&self) -> &[f64] {
        &self.front
    }

    /// V of each triangle's back side as counted; 0 where [`Sides::One`] spared the rays.
    #[must_use]
    pub fn back(&self) -> &[f64] {
        &self.back
    }

    /// Whether any camera sees the triangle, or the neighbourhood it was pooled with, from either side.
    #[must_use]
    pub fn seen(&self) -> &[bool] {
        &self.seen
    }

    /// Visibility of the mesh: one-sided, area-weighted, unclamped. Source: Zhang & Turk 2002, eq. (3.2).
    #[must_use]
    pub fn of_mesh(&self) -> f64 {
        self.of_mesh
    }

    /// The same mean under the rule for sides.
    #[must_use]
    pub fn of_mesh_sides(&self) -> f64 {
        self.of_mesh_sides
    }

    /// Number of triangles that no camera sees from either side; see [`Visibility::seen`].
    #[must_use]
    pub fn never_seen(&self) -> usize {
        self.seen.iter().filter(|&&s| !s).count()
    }

    /// Pixels along an image's side that were used; 0 where rays were cast instead.
    #[must_use]
    pub fn resolution(&self) -> u32 {
        self.resolution
    }

    /// Number of cameras that looked; 0 where rays went in random directions.
    #[must_use]
    pub fn cameras(&self) -> usize {
        self.cameras
    }

    /// What only some estimators can say.
    #[must_use]
    pub fn details(&self) -> &Details {
        &self.details
    }
}

/// Looks at `mesh` from all cameras.
///
/// # Errors
/// [`crate::Error::Mesh`] if no triangle is large enough to be seen at all,
/// [`crate::Error::Option`] for a resolution or a number of cameras outside its range, [`crate::Error::Unavailable`] for
/// a backend or estimator that is not there, [`crate::Error::Limit`] if it does not fit the memory limit,
/// [`crate::Error::Cancelled`].
///
/// # Examples
/// ```
/// use outsight::mesh::TriMesh;
/// use outsight::progress::Silent;
/// use outsight::visibility::{measure, MeasureOptions};
///
/// let corners = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]].map(Into::into).to_vec();
/// let tetrahedron = TriMesh::new(corners, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])?;
/// let visibility = measure(&tetrahedron, &MeasureOptions::default(), &Silent)?;
/// assert!((visibility.of_mesh() - 1.0).abs() < 1e-2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn measure(mesh: &TriMesh, options: &MeasureOptions, progress: &dyn Progress) -> Result<Visibility> {
    Subject::new(mesh, options.backend)?.measure(options, progress)
}

/// What the simplifier needs to know of a mesh: how visible each triangle is, and which may go unseen.
#[derive(Debug, Clone)]
pub struct Look {
    /// The visibility.
    pub visibility: Visibility,
    /// The triangles to remove, one entry per triangle; none are marked unless [`Hidden::Delete`] asks for it.
    pub hidden: Vec<bool>,
}

/// Measures `mesh`, and finds what can be removed unseen where `hidden` asks for it.
///
/// # Errors
/// As [`measure`].
pub fn look(mesh: &TriMesh, options: &MeasureOptions, hidden: Hidden, progress: &dyn Progress) -> Result<Look> {
    let subject = Subject::new(mesh, options.backend)?;
    let visibility = subject.measure(options, progress)?;
    let hidden = hidden.marks(&subject, &visibility, options, progress)?;
    Ok(Look { visibility, hidden })
}
