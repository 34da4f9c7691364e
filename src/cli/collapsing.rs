//! Flags that say how edges collapse.

use clap::{Args, ValueEnum};
use outsight::pipeline::Hidden;
use outsight::simplify::{Boundary, PlaneWeight, Topology};

use super::flags::names;
use super::values;

/// How edges collapse.
#[derive(Debug, Args)]
#[command(next_help_heading = "Collapsing")]
pub struct CollapseFlags {
    /// Stop before this error, a root mean square distance in model units
    #[arg(short = 'e', long, value_name = "ERROR", value_parser = values::length, group = "size")]
    pub max_error: Option<f64>,
    /// What orders the collapses
    #[arg(long, value_name = "NAME", default_value = "visibility")]
    pub metric: MetricName,
    /// What happens to triangles no camera sees [best: delete, paper: collapse, --metric quadric: keep]
    #[arg(long, value_name = "HOW")]
    pub hidden: Option<HiddenName>,
    /// Whether holes may close and pieces vanish [default: free]
    #[arg(long, value_name = "HOW")]
    pub topology: Option<TopologyName>,
    /// Weight that holds open borders, from 0, or `locked` [best: 1, paper: 0]
    #[arg(long, value_name = "WEIGHT", value_parser = boundary)]
    pub boundary: Option<Boundary>,
    /// How planes of triangles are weighted [best: area, paper: uniform]
    #[arg(long, value_name = "WHAT")]
    pub weights_by: Option<WeightsByName>,
    /// Exponent p of visibility in the cost [default: 2]
    #[arg(long, value_name = "P", value_parser = values::non_negative)]
    pub visibility_power: Option<f64>,
    /// Fit vertices once more at the end [default: none]
    #[arg(long, value_name = "HOW", default_value = "none", hide_default_value = true)]
    pub refit: RefitName,
}

/// `--metric`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum MetricName {
    /// Quadric error, weighted by visibility
    Visibility,
    /// Quadric error alone
    Quadric,
    /// Orientation-aware half-edges (not in this version)
    Orientation,
    /// Silhouette distance (not in this version)
    Silhouette,
}

/// `--refit`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum RefitName {
    /// Leave them
    None,
    /// Where the picture gains (not in this version)
    Guarded,
}

names! {
    /// `--hidden`.
    HiddenName => Hidden {
        /// They keep their shape, roughly
        Keep => Hidden::Keep,
        /// They collapse first
        Collapse => Hidden::Collapse,
        /// They are removed at the start
        Delete => Hidden::Delete,
    }
}

names! {
    /// `--topology`.
    TopologyName => Topology {
        /// Holes may close and pieces vanish; the result counts what changed
        Free => Topology::Free,
        /// Only collapses that leave the topology alone
        Preserve => Topology::Preserve,
    }
}

names! {
    /// `--weights-by`.
    WeightsByName => PlaneWeight {
        /// By the triangle's area
        Area => PlaneWeight::Area,
        /// All alike
        Uniform => PlaneWeight::Uniform,
    }
}

fn boundary(text: &str) -> Result<Boundary, String> {
    if text == "locked" {
        return Ok(Boundary::Locked);
    }
    values::non_negative(text).map(Boundary::Weight).map_err(|m| format!("{m}, or locked"))
}
