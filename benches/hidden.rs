//! visibility/hidden: is what `--hidden delete` removes really unseen?
//!
//! Looks at the original from 4098 cameras at twice the resolution and counts the covered pixels that have a deleted
//! triangle in front. `cargo bench --bench hidden -- MODEL...`

#![allow(clippy::print_stdout, clippy::print_stderr, clippy::unwrap_used)]

mod common;

use outsight::backend::{BackendKind, Workload};
use outsight::camera::{CameraSphere, CameraWeights, Window};
use outsight::mesh::TriMesh;
use outsight::progress::Silent;
use outsight::raster::Side;
use outsight::visibility::{CoverageCounts, Hidden, MeasureOptions, Subject, look};

fn main() {
    println!("model | triangles | deleted | share of covered pixels, 4098 cameras");
    println!("--- | ---: | ---: | ---:");
    for path in common::models() {
        let mesh = common::load(&path);
        let look = look(&mesh, &MeasureOptions::default(), Hidden::Delete, &Silent).unwrap();
        let cameras = CameraSphere::octahedral(4098, CameraWeights::Equal).unwrap();
        let window = Window::around_sphere(2 * look.visibility.resolution());
        let triangles = mesh.triangle_count();
        let counts = look_again(&mesh, &cameras, window);
        let deleted: Vec<usize> = (0..triangles).filter(|&t| look.hidden[t]).collect();
        let showing: u64 = deleted.iter().map(|&t| counts.seen(t, Side::Front) + counts.seen(t, Side::Back)).sum();
        let share = 100.0 * showing as f64 / counts.covered() as f64;
        println!("{} | {triangles} | {} | {share:.4} %", common::name(&path), deleted.len());
    }
}

fn look_again(mesh: &TriMesh, cameras: &CameraSphere, window: Window) -> CoverageCounts {
    let subject = Subject::new(mesh, BackendKind::Raster).unwrap();
    let load = Workload { window, memory_limit: None, phase: "looking", progress: &Silent };
    CoverageCounts::of(subject.machine(), mesh.triangle_count(), cameras, load, None).unwrap()
}
