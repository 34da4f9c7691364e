//! `outsight render`: a picture of a mesh.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use outsight::pipeline::{RenderRequest, Style, render_file};
use serde::Serialize;

use super::cache::CacheFlags;
use super::console::Console;
use super::estimate::{Task, cameras_drawing};
use super::failure::Failure;
use super::flags::{ColourMapName, InputFlags, LookingFlags, UpFlags, names};
use super::outputs::{self, Kind, Planned};
use super::presets;
use super::values;
use super::watch::Watch;

#[derive(Debug, Args)]
pub struct Flags {
    #[command(flatten)]
    input: InputFlags,
    /// Where the picture goes
    #[arg(short, long, value_name = "PNG")]
    output: PathBuf,
    /// Flat triangles under a head light, or visibility as heat colours
    #[arg(long, value_name = "HOW", default_value = "flat")]
    style: StyleName,
    /// Direction from the mesh to the camera
    #[arg(long, value_name = "X,Y,Z", default_value = "1,-2,1", allow_hyphen_values = true)]
    #[arg(value_parser = values::direction)]
    camera: [f64; 3],
    #[command(flatten)]
    up: UpFlags,
    /// Pixels along the side
    #[arg(long, value_name = "W", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(16..=8192))]
    size: u32,
    /// Heat colours: as in the paper, or readable for every eye
    #[arg(long, value_name = "NAME", default_value = "paper")]
    colour_map: ColourMapName,
    /// Draw the colour scale, the default for --style heat
    #[arg(long, overrides_with = "no_legend")]
    legend: bool,
    /// Draw no colour scale
    #[arg(long, overrides_with = "legend")]
    no_legend: bool,
    #[command(flatten)]
    looking: LookingFlags,
    #[command(flatten)]
    cache: CacheFlags,
}

names! {
    /// `--style`.
    StyleName => Style {
        // Flat triangles under a head light
        Flat => Style::Flat,
        // Coloured by visibility
        Heat => Style::Heat,
    }
}

#[derive(Debug, Serialize)]
struct Report<'a> {
    file: &'a PathBuf,
    style: &'static str,
    size: u32,
    camera: [f64; 3],
}

/// Draws, writes, prints.
pub fn run(flags: &Flags, console: &Console) -> Result<(), Failure> {
    let request = request(flags, console)?;
    let planned = Planned { path: &request.output, kind: Kind::Picture, format: None };
    outputs::check(planned, &[&request.input], request.force)?;
    let heat = request.style == Style::Heat;
    let resolution = request.measure.resolution.unwrap_or(0);
    let cameras = cameras_drawing(&request.measure)?;
    let task = if heat { Task::Measure { resolution, cameras } } else { Task::Read };
    render_file(&request, &Watch::new(console, task))?;
    let style = if heat { "heat" } else { "flat" };
    let report = Report { file: &request.output, style, size: request.size, camera: request.camera };
    console.result(&report, &format!("written  {}\n", request.output.display()), true)
}

fn request(flags: &Flags, console: &Console) -> outsight::Result<RenderRequest> {
    let style = Style::from(flags.style);
    Ok(RenderRequest {
        input: flags.input.mesh.clone(),
        read: flags.input.reading.options(&console.global),
        output: flags.output.clone(),
        style,
        camera: flags.camera,
        up: flags.up.up,
        size: flags.size,
        colour_map: flags.colour_map.into(),
        legend: flags.legend || (style == Style::Heat && !flags.no_legend),
        measure: presets::measure_options(&flags.looking, &console.global)?,
        cache: flags.cache.place()?,
        force: console.global.force,
    })
}
