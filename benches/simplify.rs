//! simplify/quadric: speed and memory of the collapser to 5 %, visibility given, on one thread.
//!
//! `cargo bench --bench simplify -- MODEL...`

#![allow(clippy::print_stdout, clippy::print_stderr, clippy::unwrap_used)]

mod common;

use std::path::{Path, PathBuf};

use common::memory;
use outsight::mesh::TriMesh;
use outsight::progress::Silent;
use outsight::simplify::{SimplifyOptions, Target, simplify};
use outsight::visibility::{Hidden, MeasureOptions, importance, measure};

const MEMORY_OF: &str = "OUTSIGHT_BENCH_MEMORY_OF";

fn main() {
    if let Ok(path) = std::env::var(MEMORY_OF) {
        return print_memory(&PathBuf::from(path));
    }
    println!("model | triangles | QB s | QB M triangles/s | VG s | VG M triangles/s | VG / QB | bytes per triangle");
    println!("--- | ---: | ---: | ---: | ---: | ---: | ---: | ---:");
    for path in common::models() {
        let mesh = common::load(&path);
        let visibility = measure(&mesh, &MeasureOptions::default(), &Silent).unwrap();
        let weights = importance(&visibility, Hidden::Collapse, 2.0).unwrap();
        let (qb, vg) = common::on_threads(1, || {
            (
                common::median_seconds(1, || to_five_percent(&mesh, None)),
                common::median_seconds(1, || to_five_percent(&mesh, Some(&weights))),
            )
        });
        let million = mesh.triangle_count() as f64 / 1e6;
        println!(
            "{} | {} | {qb:.2} | {:.2} | {vg:.2} | {:.2} | {:.2} | {}",
            common::name(&path),
            mesh.triangle_count(),
            million / qb,
            million / vg,
            vg / qb,
            memory::in_a_process_of_its_own(MEMORY_OF, &path)
        );
    }
}

fn to_five_percent(mesh: &TriMesh, importance: Option<&[f64]>) -> TriMesh {
    let options = SimplifyOptions::default().with_targets(vec![Target::Ratio(0.05)]);
    simplify(mesh, importance, &options, &Silent).unwrap().swap_remove(0).mesh
}

/// Peak above the memory that the process had with the mesh read and weights made, plus the mesh itself, per triangle.
fn print_memory(path: &Path) {
    let mesh = common::load(path);
    let weights = vec![0.25; mesh.triangle_count()];
    let mesh_bytes = 12 * mesh.triangle_count() + 24 * mesh.vertex_count() + 8 * mesh.triangle_count();
    let before = memory::resident();
    let peak = memory::peak_of(|| to_five_percent(&mesh, Some(&weights))).saturating_sub(before);
    println!("{}", (peak as usize + mesh_bytes) / mesh.triangle_count());
}
