//! `outsight info`: what a mesh file holds.

use std::path::Path;

use clap::Args;
use outsight::geom;
use outsight::io::{self, Loaded};
use outsight::mesh::adjacency::{CornerLists, Edges, TopologyCounts};
use outsight::mesh::{TriMesh, TriangleId};
use outsight::pipeline::Observer;
use serde::Serialize;

use super::console::Console;
use super::estimate::{self, Task};
use super::failure::Failure;
use super::flags::InputFlags;
use super::text::{count, duration, memory, pairs};
use super::watch::{Found, Watch};

/// Cameras that the estimate of time is for, the default of `measure`.
const ESTIMATED_CAMERAS: usize = 258;

#[derive(Debug, Args)]
pub struct Flags {
    #[command(flatten)]
    input: InputFlags,
}

#[derive(Debug, Serialize)]
struct Report {
    #[serde(flatten)]
    found: Found,
    format: &'static str,
    vertices: usize,
    triangles: usize,
    topology: Topology,
    size: Size,
    estimate: Estimate,
    welded: Option<usize>,
}

#[derive(Debug, Serialize)]
struct Topology {
    components: usize,
    edges: usize,
    boundary_edges: usize,
    non_manifold_edges: usize,
    euler_characteristic: i64,
    closed: bool,
    unused_vertices: usize,
}

#[derive(Debug, Serialize)]
struct Size {
    min: [f64; 3],
    max: [f64; 3],
    diagonal: f64,
    area: f64,
}

#[derive(Debug, Serialize)]
struct Estimate {
    measure_seconds: f64,
    simplify_seconds: f64,
    peak_mb: f64,
}

/// Reads the mesh, counts, prints.
pub fn run(flags: &Flags, console: &Console) -> Result<(), Failure> {
    let path = &flags.input.mesh;
    let loaded = io::read(path, &flags.input.reading.options(&console.global))?;
    Watch::new(console, Task::Read).mesh_read(path, &loaded)?;
    let report = report(path, &loaded);
    console.result(&report, &text(path, &report), true)
}

fn report(path: &Path, loaded: &Loaded) -> Report {
    let triangles = loaded.mesh.triangle_count();
    let measure = Task::Measure { resolution: 0, cameras: ESTIMATED_CAMERAS };
    let simplify = Task::Simplify { resolution: 0, cameras: ESTIMATED_CAMERAS };
    let seconds = |task| estimate::seconds(task, triangles).unwrap_or_default();
    let peak = estimate::memory_bytes(simplify, triangles);
    Report {
        found: Found::new(path, loaded),
        format: loaded.format.extension(),
        vertices: loaded.mesh.vertex_count(),
        triangles,
        topology: topology(&loaded.mesh),
        size: size(&loaded.mesh),
        estimate: Estimate {
            measure_seconds: seconds(measure),
            simplify_seconds: seconds(simplify),
            peak_mb: peak as f64 / f64::from(1 << 20),
        },
        welded: loaded.welded,
    }
}

fn topology(mesh: &TriMesh) -> Topology {
    let lists = CornerLists::of(mesh);
    let counts = TopologyCounts::of(mesh, &lists, &Edges::of(mesh, &lists));
    Topology {
        components: counts.components,
        edges: counts.edges,
        boundary_edges: counts.boundary_edges,
        non_manifold_edges: counts.non_manifold_edges,
        euler_characteristic: counts.euler_characteristic,
        closed: counts.boundary_edges == 0 && counts.non_manifold_edges == 0,
        unused_vertices: mesh.vertex_count() - counts.used_vertices,
    }
}

fn size(mesh: &TriMesh) -> Size {
    let bounds = mesh.bounds();
    let corners = (0..mesh.triangle_count()).map(|t| mesh.corners(TriangleId(t as u32)));
    Size {
        min: bounds.min.to_array(),
        max: bounds.max.to_array(),
        diagonal: bounds.diagonal(),
        area: corners.map(geom::triangle_area).sum(),
    }
}

fn text(path: &Path, report: &Report) -> String {
    let (topology, size, estimate) = (&report.topology, &report.size, &report.estimate);
    let point = |p: [f64; 3]| format!("{:.6} {:.6} {:.6}", p[0], p[1], p[2]);
    let closed = if topology.closed { "yes, every edge joins two triangles" } else { "no" };
    let mut rows = vec![
        ("file", format!("{} ({})", path.display(), report.format)),
        ("triangles", count(report.triangles)),
        ("vertices", format!("{} ({} unused)", count(report.vertices), count(topology.unused_vertices))),
        ("components", count(topology.components)),
        ("closed", closed.to_owned()),
        ("boundary edges", count(topology.boundary_edges)),
        ("non-manifold edges", count(topology.non_manifold_edges)),
        ("Euler characteristic", topology.euler_characteristic.to_string()),
        ("box", format!("{}  to  {}", point(size.min), point(size.max))),
        ("diagonal", format!("{:.6}", size.diagonal)),
        ("area", format!("{:.6}", size.area)),
        ("measure takes about", format!("{} from {ESTIMATED_CAMERAS} cameras", duration(estimate.measure_seconds))),
        ("simplify takes about", duration(estimate.simplify_seconds)),
        ("memory about", memory((estimate.peak_mb * f64::from(1 << 20)) as u64)),
    ];
    if let Some(welded) = report.welded {
        rows.push(("vertices welded", count(welded)));
    }
    if let Some(list) = report.found.dropped_list() {
        rows.push(("not carried over", list));
    }
    pairs(&rows)
}
