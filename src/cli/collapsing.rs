//! Flags that say how edges collapse.

use clap::{Args, ValueEnum};
use outsight::simplify::{Boundary, PlaneWeight, Topology};
use outsight::visibility::Hidden;

use super::flags::names;
use super::values;

/// How edges collapse.
#[derive(Debug, Args)]
#[command(next_help_heading = "Collapsing")]
pub struct CollapseFlags {
    /// Order collapses by error weighted with visibility, or by error alone
    #[arg(long, value_name = "NAME", default_value = "visibility")]
    pub metric: MetricName,
    /// Triangles that no camera sees [best: delete, paper: collapse, --metric quadric: keep]
    #[arg(long, value_name = "HOW")]
    pub hidden: Option<HiddenName>,
    /// Free: holes may close and pieces vanish, and are counted [default: free]
    #[arg(long, value_name = "HOW")]
    pub topology: Option<TopologyName>,
    /// How strongly open borders are held: a number from 0, or locked [best: 1, paper: 0]
    #[arg(long, value_name = "WEIGHT", value_parser = boundary)]
    pub boundary: Option<Boundary>,
    /// Weigh the planes of triangles [best: area, paper: uniform]
    #[arg(long, value_name = "WHAT")]
    pub weights_by: Option<WeightsByName>,
    /// Exponent p of visibility in the cost [default: 2]
    #[arg(long, value_name = "P", value_parser = values::non_negative)]
    pub visibility_power: Option<f64>,
    /// Fit vertices once more at the end
    #[arg(long, value_name = "HOW", default_value = "none", hide = true)]
    pub refit: RefitName,
}

/// `--metric`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum MetricName {
    // Quadric error, weighted by visibility
    Visibility,
    // Quadric error alone
    Quadric,
    // Orientation-aware half-edges, not there yet
    #[value(hide = true)]
    Orientation,
    // Silhouette distance, not there yet
    #[value(hide = true)]
    Silhouette,
}

/// `--refit`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum RefitName {
    // Leave them
    None,
    // Where the picture gains, not there yet
    #[value(hide = true)]
    Guarded,
}

names! {
    /// `--hidden`.
    HiddenName => Hidden {
        // They keep their shape, roughly
        Keep => Hidden::Keep,
        // They collapse first
        Collapse => Hidden::Collapse,
        // They are removed at the start
        Delete => Hidden::Delete,
    }
}

names! {
    /// `--topology`.
    TopologyName => Topology {
        // Holes may close and pieces vanish; the result counts what changed
        Free => Topology::Free,
        // Only collapses that leave the topology alone
        Preserve => Topology::Preserve,
    }
}

names! {
    /// `--weights-by`.
    WeightsByName => PlaneWeight {
        // By the triangle's area
        Area => PlaneWeight::Area,
        // All alike
        Uniform => PlaneWeight::Uniform,
    }
}

fn boundary(text: &str) -> Result<Boundary, String> {
    if text == "locked" {
        return Ok(Boundary::Locked);
    }
    values::non_negative(text).map(Boundary::Weight).map_err(|m| format!("{m}, or locked"))
}
