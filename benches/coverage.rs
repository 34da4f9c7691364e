//! visibility/coverage: processor time and memory to look from 258 cameras on two threads, and Embree's time to do the same.
//!
//! `cargo bench --bench coverage -- MODEL...`
//!
//! Memory is the most that was resident while `measure` ran, in a process of its own, less what was resident in it before
//! the mesh was read (two threads and all code warm, from measuring a tetrahedron) and less the mesh itself (24 bytes a
//! vertex, 12 a triangle); then also less the item buffers, 16 bytes a pixel for each thread. Blocks that are freed
//! are not counted; see `memory::in_a_process_of_its_own`.

#![allow(clippy::print_stdout, clippy::print_stderr, clippy::unwrap_used)]

mod common;

use std::path::{Path, PathBuf};

use common::memory;
use outsight::backend::BackendKind;
use outsight::mesh::{TriMesh, shapes};
use outsight::progress::Silent;
use outsight::visibility::{MeasureOptions, Visibility, measure};

const THREADS: usize = 2;
const MEMORY_OF: &str = "OUTSIGHT_BENCH_MEMORY_OF";

/// Resolution that backends are compared at.
const COMPARED: u32 = 480;

fn main() {
    if let Some(path) = std::env::var_os(MEMORY_OF) {
        return print_memory(&PathBuf::from(path));
    }
    println!(
        "model | triangles | pixels | V(M) | never seen | CPU s / {THREADS} threads, median of 5 | Embree, once | ratio | \
         bytes per triangle | less buffers"
    );
    println!("--- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---:");
    for path in common::models() {
        let mesh = common::load(&path);
        let memory = memory::in_a_process_of_its_own(MEMORY_OF, &path);
        for (resolution, memory) in resolutions(&mesh).into_iter().zip(memory.lines()) {
            common::on_threads(THREADS, || {
                let seconds = common::median_seconds(THREADS, || look(&mesh, BackendKind::Raster, resolution));
                let v = look(&mesh, BackendKind::Raster, resolution);
                println!(
                    "{} | {} | {resolution} | {:.4} | {} | {seconds:.2} | {} | {memory}",
                    common::name(&path),
                    mesh.triangle_count(),
                    v.of_mesh(),
                    v.never_seen(),
                    against_embree(&mesh, resolution, seconds),
                );
            });
        }
    }
}

fn resolutions(mesh: &TriMesh) -> Vec<u32> {
    let mut resolutions = vec![COMPARED, MeasureOptions::default().resolution_for(mesh.triangle_count())];
    resolutions.dedup();
    resolutions
}

fn look(mesh: &TriMesh, backend: BackendKind, resolution: u32) -> Visibility {
    let options = MeasureOptions { resolution: Some(resolution), backend, ..MeasureOptions::default() };
    measure(mesh, &options, &Silent).unwrap()
}

fn against_embree(mesh: &TriMesh, resolution: u32, raster: f64) -> String {
    if resolution != COMPARED || BackendKind::Embree.check().is_err() {
        return "– | –".to_owned();
    }
    let embree = common::seconds(THREADS, || look(mesh, BackendKind::Embree, resolution));
    format!("{embree:.2} | {:.2}", raster / embree)
}

/// A line for each resolution: bytes per triangle, with and without the item buffers.
fn print_memory(path: &Path) {
    common::on_threads(THREADS, || {
        look(&shapes::tetrahedron(), BackendKind::Raster, COMPARED);
        let floor = memory::resident();
        let mesh = common::load(path);
        let mesh_bytes = (24 * mesh.vertex_count() + 12 * mesh.triangle_count()) as u64;
        for resolution in resolutions(&mesh) {
            let peak = memory::peak_of(|| look(&mesh, BackendKind::Raster, resolution));
            let above = peak as f64 - (floor + mesh_bytes) as f64;
            let buffers = (THREADS * 16 * (resolution as usize).pow(2)) as f64;
            let per_triangle = |bytes: f64| bytes / mesh.triangle_count() as f64;
            println!("{:.0} | {:.0}", per_triangle(above), per_triangle(above - buffers));
        }
    });
}
