//! visibility/coverage: processor time against the number of cameras, at 480 pixels, on two threads.
//!
//! `cargo bench --bench growth -- MODEL...`

#![allow(clippy::print_stdout, clippy::print_stderr, clippy::unwrap_used)]

mod common;

use outsight::camera::Cameras;
use outsight::progress::Silent;
use outsight::visibility::{MeasureOptions, measure};

const THREADS: usize = 2;

fn main() {
    println!("model | cameras | CPU s / {THREADS} threads, once | ms a camera");
    println!("--- | ---: | ---: | ---:");
    for path in common::models() {
        let mesh = common::load(&path);
        for count in [66, 258, 1026, 4098] {
            let cameras = Cameras::octahedral(count);
            let options = MeasureOptions { cameras, resolution: Some(480), ..MeasureOptions::default() };
            let seconds =
                common::on_threads(THREADS, || common::seconds(THREADS, || measure(&mesh, &options, &Silent).unwrap()));
            println!("{} | {count} | {seconds:.2} | {:.2}", common::name(&path), 1e3 * seconds / count as f64);
        }
    }
}
