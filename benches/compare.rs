//! compare: seconds on two threads of the picture comparison (20 views, three lights, SSIM) and of the geometric
//! error with a million samples each way, of a mesh and a copy whose vertices are moved a little.
//!
//! `cargo bench --bench compare -- MODEL...`

#![allow(clippy::print_stdout, clippy::print_stderr, clippy::unwrap_used)]

mod common;

use glam::DVec3;
use outsight::eval::ReferencePictures;
use outsight::eval::geometric::{GeometricOptions, SampleCount, geometric_error};
use outsight::mesh::TriMesh;
use outsight::progress::Silent;

const THREADS: usize = 2;

/// The largest shift of a vertex, as a share of the box's diagonal.
const NOISE: f64 = 1e-3;

fn main() {
    println!("model | triangles | pictures s | of it the reference s | distances s | head light | SSIM | rms %");
    println!("--- | ---: | ---: | ---: | ---: | ---: | ---: | ---:");
    for path in common::models() {
        let mesh = common::load(&path);
        let moved = noisy(&mesh);
        let pictures = || ReferencePictures::new(&mesh, &Silent).unwrap().compare(&moved, &Silent).unwrap();
        let options = GeometricOptions { samples: SampleCount::Exactly(1_000_000), seed: 0 };
        let distances = || geometric_error(&mesh, &moved, options, &Silent).unwrap();
        common::on_threads(THREADS, || {
            let found = (pictures(), distances());
            println!(
                "{} | {} | {:.2} | {:.2} | {:.2} | {:.3} | {:.4} | {:.4}",
                common::name(&path),
                mesh.triangle_count(),
                common::least_seconds(THREADS, pictures),
                common::least_seconds(THREADS, || ReferencePictures::new(&mesh, &Silent).unwrap()),
                common::least_seconds(THREADS, distances),
                found.0.image_rmse,
                found.0.ssim,
                found.1.percent().rms,
            );
        });
    }
}

/// The mesh with every vertex moved by a fixed pattern that looks like noise.
fn noisy(mesh: &TriMesh) -> TriMesh {
    let reach = NOISE * mesh.bounds().diagonal();
    let (positions, triangles) = mesh.clone().into_parts();
    let shift = |i: usize| {
        let part = |k: usize| ((i * 7919 + k * 104_729) % 1009) as f64 / 504.5 - 1.0;
        reach / 3.0_f64.sqrt() * DVec3::new(part(1), part(2), part(3))
    };
    let positions = positions.into_iter().enumerate().map(|(i, p)| p + shift(i)).collect();
    TriMesh::new(positions, triangles).unwrap()
}
