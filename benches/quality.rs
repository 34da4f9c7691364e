//! simplify/quality: image error of QB and VG at seven levels, and the mean improvement over QB as the paper prints it.
//!
//! `cargo bench --bench quality -- MODEL...`

#![allow(clippy::print_stdout, clippy::print_stderr, clippy::unwrap_used)]

mod common;

use outsight::eval::image_errors;
use outsight::mesh::TriMesh;
use outsight::progress::Silent;
use outsight::simplify::{PlaneWeight, SimplifyOptions, Target, simplify};
use outsight::visibility::{Hidden, Look, MeasureOptions, importance, look};

fn main() {
    println!("model | V(M) | variant | 20 % | 10 % | 5 % | 3 % | 2 % | 1 % | 0.5 % | less error than QB, mean");
    println!("--- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---:");
    for path in common::models() {
        let mesh = common::load(&path);
        let paper = look(&mesh, &MeasureOptions::paper(), Hidden::Delete, &Silent).unwrap();
        let best = look(&mesh, &MeasureOptions::default(), Hidden::Delete, &Silent).unwrap();
        let row = Row { model: common::name(&path), v: best.visibility.of_mesh() };
        let printed = SimplifyOptions::paper();
        let qb = errors(&mesh, None, &printed);
        row.print("QB, preset paper", &qb, &qb);
        // The printed method, with one option of the other preset at a time: which of them it lacks where it loses.
        let area = SimplifyOptions { plane_weight: PlaneWeight::Area, ..printed.clone() };
        let borders = SimplifyOptions { boundary: SimplifyOptions::default().boundary, ..printed.clone() };
        for (variant, hidden, options) in [
            ("VG, preset paper", Hidden::Collapse, &printed),
            ("VG, paper + hidden deleted", Hidden::Delete, &printed),
            ("VG, paper + borders held", Hidden::Collapse, &borders),
            ("VG, paper + planes by area", Hidden::Collapse, &area),
        ] {
            row.print(variant, &errors(&mesh, Some((&paper, hidden)), options), &qb);
        }
        let options = SimplifyOptions::default();
        row.print("QB, area + borders", &errors(&mesh, None, &options), &qb);
        row.print("VG, hidden kept in", &errors(&mesh, Some((&best, Hidden::Collapse)), &options), &qb);
        row.print("VG, preset best", &errors(&mesh, Some((&best, Hidden::Delete)), &options), &qb);
    }
}

struct Row {
    model: String,
    v: f64,
}

impl Row {
    fn print(&self, variant: &str, errors: &[f64], qb: &[f64]) {
        let gain: f64 = errors.iter().zip(qb).map(|(e, q)| 100.0 * (1.0 - e / q)).sum::<f64>() / errors.len() as f64;
        let cells: Vec<String> = errors.iter().map(|e| format!("{e:.2}")).collect();
        println!("{} | {:.3} | {variant} | {} | {gain:.1} %", self.model, self.v, cells.join(" | "));
    }
}

/// Image RMSE at each level; with `Hidden::Delete`, of the mesh without its hidden triangles.
fn errors(mesh: &TriMesh, seen: Option<(&Look, Hidden)>, options: &SimplifyOptions) -> Vec<f64> {
    let targets = common::LEVELS.map(|share| Target::Triangles((share * mesh.triangle_count() as f64) as usize));
    let options = options.clone().with_targets(targets.to_vec());
    let levels = match seen {
        None => simplify(mesh, None, &options, &Silent),
        Some((look, hidden)) => {
            let weights = importance(&look.visibility, hidden, 2.0).unwrap();
            let gone: Vec<bool> = look.hidden.iter().map(|&h| h && hidden == Hidden::Delete).collect();
            let weights: Vec<f64> = weights.iter().zip(&gone).filter(|(_, gone)| !**gone).map(|(&w, _)| w).collect();
            let rest = mesh.without_triangles(&gone).unwrap().expect("something is seen").mesh;
            simplify(&rest, Some(&weights), &options, &Silent)
        }
    }
    .unwrap();
    let meshes: Vec<&TriMesh> = levels.iter().map(|level| &level.mesh).collect();
    image_errors(mesh, &meshes, &Silent).unwrap().iter().map(|error| error.image_rmse).collect()
}
