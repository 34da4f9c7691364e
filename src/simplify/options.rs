//! Options, their presets and their check.

use super::{Boundary, PlaneWeight, Target, Topology};
use crate::error::{Error, Result, short_number};

/// Largest [`SimplifyOptions::regulariser`]: beyond it the pull would move corners by more than rounding.
const MAX_REGULARISER: f64 = 1e-3;

/// What one run of the simplifier does. `Default` is the preset `best`, to half of the triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct SimplifyOptions {
    /// One level of detail per target, each at most as large as the one before; empty only with `max_error`.
    pub targets: Vec<Target>,
    /// Withhold collapses whose root mean square distance would pass this, in model units; `None` for no bound.
    pub max_error: Option<f64>,
    /// Weight of a triangle's plane.
    pub plane_weight: PlaneWeight,
    /// What may happen to the topology.
    pub topology: Topology,
    /// What holds borders.
    pub boundary: Boundary,
    /// Smallest cosine between a triangle's normal before and after a collapse, -1 to 1.
    pub min_normal_cosine: f64,
    /// Smallest compactness 4 √3 A / Σ l² of a triangle that a collapse reshapes, 0 (off) to 1; a triangle that was
    /// thinner before may stay so.
    pub min_compactness: f64,
    /// Most neighbours a new vertex may have, unless its collapse costs nothing; `None` for no bound.
    pub max_valence: Option<usize>,
    /// Farthest that the minimum of the quadric may be from the middle of the edge to be taken, in edge lengths.
    pub max_placement_distance: f64,
    /// Share of every triangle's importance that orders collapses but is no part of the error, finite and at least 0: a
    /// trace given to triangles that do not matter, so that they too collapse in a good order.
    pub importance_floor: f64,
    /// Strength of the pull toward where the vertices were, as a share of the plane weight, 0 (off) to 1e-3; makes
    /// placement on near-planar surface unique. It moves positions only and is no part of any cost.
    pub regulariser: f64,
}

impl Default for SimplifyOptions {
    fn default() -> Self {
        Self {
            targets: vec![Target::Ratio(0.5)],
            max_error: None,
            plane_weight: PlaneWeight::Area,
            topology: Topology::Free,
            boundary: Boundary::Weight(1.0),
            min_normal_cosine: 0.2,
            min_compactness: 0.0,
            max_valence: None,
            max_placement_distance: 2.0,
            importance_floor: 0.0,
            regulariser: 1e-6,
        }
    }
}

impl SimplifyOptions {
    /// The preset nearest to the text of Zhang & Turk 2002: every plane alike, nothing holds borders.
    #[must_use]
    pub fn paper() -> Self {
        Self {
            plane_weight: PlaneWeight::Uniform,
            boundary: Boundary::Weight(0.0),
            max_placement_distance: 10.0,
            regulariser: 0.0,
            ..Self::default()
        }
    }

    /// The options with these targets instead.
    #[must_use]
    pub fn with_targets(self, targets: Vec<Target>) -> Self {
        Self { targets, ..self }
    }

    /// Looks at every option.
    ///
    /// # Errors
    /// [`Error::Option`] for the first that is outside its range.
    pub fn check(&self) -> Result<()> {
        if self.targets.is_empty() && self.max_error.is_none() {
            return Err(bad(
                "--ratio",
                "no target and no error bound was given; give --ratio, --triangles or --max-error",
            ));
        }
        self.targets.iter().try_for_each(|target| check_target(*target))?;
        if let Boundary::Weight(weight) = self.boundary {
            in_range("--boundary", weight, 0.0..=1e6)?;
        }
        if let Some(error) = self.max_error {
            in_range("--max-error", error, 0.0..=f64::MAX)?;
        }
        if self.max_valence.is_some_and(|max| max < 3) {
            return Err(bad("max valence", "a vertex needs at least 3 neighbours"));
        }
        in_range("min normal cosine", self.min_normal_cosine, -1.0..=1.0)?;
        in_range("min compactness", self.min_compactness, 0.0..=1.0)?;
        in_range("max placement distance", self.max_placement_distance, 0.0..=1e6)?;
        in_range("importance floor", self.importance_floor, 0.0..=1e6)?;
        in_range("regulariser", self.regulariser, 0.0..=MAX_REGULARISER)
    }

    /// The triangles that each target asks for, of `triangle_count`.
    ///
    /// # Errors
    /// [`Error::Option`] where one target asks for more than the one before it.
    pub fn counts(&self, triangle_count: usize) -> Result<Vec<usize>> {
        let counts: Vec<usize> = self.targets.iter().map(|target| target.count(triangle_count)).collect();
        match counts.windows(2).find(|pair| pair[1] > pair[0]) {
            None => Ok(counts),
            Some(pair) => {
                Err(bad("--lods", &format!("{} triangles after {}; give the largest first", pair[1], pair[0])))
            }
        }
    }
}

impl Target {
    /// The triangles that it allows of a mesh of `triangle_count`; at least 1.
    #[must_use]
    pub fn count(self, triangle_count: usize) -> usize {
        match self {
            Self::Triangles(count) => count.max(1),
            Self::Ratio(ratio) => ((ratio * triangle_count as f64).floor() as usize).max(1),
        }
    }
}

fn check_target(target: Target) -> Result<()> {
    match target {
        Target::Triangles(0) => Err(bad("--triangles", "0 triangles are no mesh; give at least 1")),
        Target::Ratio(ratio) if !(ratio > 0.0 && ratio <= 1.0) => Err(bad(
            "--ratio",
            &format!(
                "{ratio} is not in (0, 1], the share of triangles to keep; 0.05 keeps 5 %, --triangles takes a count"
            ),
        )),
        _ => Ok(()),
    }
}

fn in_range(name: &'static str, value: f64, range: std::ops::RangeInclusive<f64>) -> Result<()> {
    if range.contains(&value) {
        return Ok(());
    }
    let [value, start, end] = [value, *range.start(), *range.end()].map(short_number);
    Err(bad(name, &format!("{value} is outside {start} to {end}")))
}

fn bad(name: &'static str, message: &str) -> Error {
    Error::Option { name, message: message.to_owned() }
}
