//! `outsight doctor`: what works on this machine, and why the rest does not.

use clap::Args;
use glam::DVec3;
use outsight::Error;
use outsight::backend::BackendKind;
#[cfg(feature = "embree")]
use outsight::backend::EmbreeScene;
use outsight::mesh::TriMesh;
use outsight::visibility::{self, MeasureOptions};
use serde::Serialize;

use super::console::Console;
use super::failure::Failure;
use super::flags::LookingFlags;
use super::presets;
use super::system;
use super::text::{memory, pairs};

/// How far the visibility of a cube may be from 1: the spread of the sum over 258 cameras is 0.8 %, most of it on the
/// coordinate axes.
const CUBE_TOLERANCE: f64 = 0.01;

#[derive(Debug, Args)]
pub struct Flags {}

#[derive(Debug, Serialize)]
struct Report {
    version: &'static str,
    target: &'static str,
    profile: &'static str,
    threads: usize,
    memory_mb: Option<u64>,
    memory_available_mb: Option<u64>,
    zstd: bool,
    backends: Vec<BackendState>,
    self_check: SelfCheck,
}

#[derive(Debug, Serialize)]
struct BackendState {
    name: &'static str,
    works: bool,
    note: String,
}

#[derive(Debug, Serialize)]
struct SelfCheck {
    what: &'static str,
    visibility: Option<f64>,
    passed: bool,
    error: Option<String>,
}

/// Looks, prints; fails if the self-check does.
pub fn run(_flags: &Flags, console: &Console) -> Result<(), Failure> {
    let memory = system::memory_bytes();
    let report = Report {
        version: env!("CARGO_PKG_VERSION"),
        target: env!("OUTSIGHT_BUILD_TARGET"),
        profile: env!("OUTSIGHT_BUILD_PROFILE"),
        threads: rayon::current_num_threads(),
        memory_mb: memory.map(|(all, _)| all >> 20),
        memory_available_mb: memory.map(|(_, available)| available >> 20),
        zstd: cfg!(feature = "zstd"),
        backends: backends(),
        self_check: self_check(console),
    };
    console.result(&report, &text(&report), true)?;
    if report.self_check.passed { Ok(()) } else { Err(Failure::ConditionFalse) }
}

fn backends() -> Vec<BackendState> {
    let state = |name, note: Result<String, Error>| BackendState {
        name,
        works: note.is_ok(),
        note: note.unwrap_or_else(|reason| reason.to_string()),
    };
    vec![
        state("raster", Ok("CPU rasteriser, the default".to_owned())),
        state("embree", embree()),
        state("gpu", BackendKind::Gpu.check().map(|()| String::new())),
    ]
}

/// Which library was loaded, as it says itself.
#[cfg(feature = "embree")]
fn embree() -> Result<String, Error> {
    EmbreeScene::library_version().map(|version| format!("ray casting, Embree {version}"))
}

#[cfg(not(feature = "embree"))]
fn embree() -> Result<String, Error> {
    BackendKind::Embree.check().map(|()| String::new())
}

/// Measures a cube: nothing hides any of it, so that every visibility must be 1.
fn self_check(console: &Console) -> SelfCheck {
    let what = "visibility of a cube, which must be 1";
    let measured = presets::measure_options(&LookingFlags::default(), &console.global)
        .and_then(|options: MeasureOptions| visibility::measure(&cube(), &options, console));
    match measured {
        Ok(seen) => {
            let lowest = seen.per_triangle().iter().copied().fold(f64::INFINITY, f64::min);
            let passed = (seen.of_mesh() - 1.0).abs() <= CUBE_TOLERANCE && lowest >= 1.0 - CUBE_TOLERANCE;
            SelfCheck { what, visibility: Some(seen.of_mesh()), passed, error: None }
        }
        Err(error) => SelfCheck { what, visibility: None, passed: false, error: Some(error.to_string()) },
    }
}

/// A cube of side 2 around the origin, its triangles counter-clockwise from outside; vertex bits are x, y, z.
fn cube() -> TriMesh {
    let corner = |i: u32| DVec3::from([0, 1, 2].map(|bit| f64::from((i >> bit) & 1) * 2.0 - 1.0));
    let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriMesh::new((0..8).map(corner).collect(), triangles).expect("eight corners, twelve triangles with area")
}

fn text(report: &Report) -> String {
    let memory = match (report.memory_mb, report.memory_available_mb) {
        (Some(all), Some(free)) => format!("{}, {} available", memory(all << 20), memory(free << 20)),
        _ => "unknown on this system".to_owned(),
    };
    let mut rows = vec![
        ("outsight", format!("{}, {} build for {}", report.version, report.profile, report.target)),
        ("threads", report.threads.to_string()),
        ("memory", memory),
        (".zst files", if report.zstd { "yes" } else { "no; built without the feature zstd" }.to_owned()),
    ];
    for backend in &report.backends {
        rows.push((backend.name, format!("{}: {}", if backend.works { "works" } else { "no" }, backend.note)));
    }
    rows.push(("self-check", self_check_in_words(&report.self_check)));
    pairs(&rows)
}

fn self_check_in_words(check: &SelfCheck) -> String {
    let verdict = if check.passed { "passed" } else { "FAILED, do not trust this build" };
    match (&check.error, check.visibility) {
        (Some(error), _) => format!("{verdict}: {error}"),
        (None, Some(value)) => format!("{verdict}: {}, within 0.01 ({value:.4})", check.what),
        (None, None) => verdict.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use outsight::geom;

    #[test]
    fn cube_of_the_self_check_faces_outward() {
        let cube = super::cube();
        for t in 0..12 {
            let corners = cube.corners(outsight::mesh::TriangleId(t));
            let outward = corners[0] + corners[1] + corners[2];
            assert!(geom::area_vector_doubled(corners).dot(outward) > 0.0, "triangle {t}");
        }
    }
}
