//! visibility/raster/coverage: seconds to look from 258 cameras, on two threads.
//!
//! `cargo bench --bench coverage -- MODEL...`

#![allow(clippy::print_stdout, clippy::print_stderr, clippy::unwrap_used)]

mod common;

use outsight::progress::Silent;
use outsight::visibility::{MeasureOptions, measure};

const THREADS: usize = 2;

fn main() {
    println!("model | triangles | pixels | V(M) | never seen | CPU s / {THREADS} threads, median of 5");
    println!("--- | ---: | ---: | ---: | ---: | ---:");
    for path in common::models() {
        let mesh = common::load(&path);
        let mut resolutions = vec![480, MeasureOptions::default().resolution_for(mesh.triangle_count())];
        resolutions.dedup();
        for resolution in resolutions {
            let options = MeasureOptions { resolution: Some(resolution), ..MeasureOptions::default() };
            common::on_threads(THREADS, || {
                let seconds = common::median_seconds(THREADS, || measure(&mesh, &options, &Silent).unwrap());
                let v = measure(&mesh, &options, &Silent).unwrap();
                println!(
                    "{} | {} | {resolution} | {:.4} | {} | {seconds:.2}",
                    common::name(&path),
                    mesh.triangle_count(),
                    v.of_mesh(),
                    v.never_seen()
                );
            });
        }
    }
}
