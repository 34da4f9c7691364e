//! The study that makes Zhang & Turk's tables and figures again: known answers, and going on where it was stopped.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::sync::Mutex;

use outsight::Error;
use outsight::io::{self, Attributes, ReadOptions, WriteOptions};
use outsight::mesh::{TriMesh, shapes};
use outsight::pipeline::{Metric, ModelReport, Observer, Preset, ZtModel, ZtReport, ZtRequest, plan_zt, study_zt};
use outsight::progress::{Progress, Silent};

/// Models of the study, few cameras, small pictures.
fn request(home: &Path, meshes: &[(&str, TriMesh)]) -> ZtRequest {
    let model = |(name, mesh): &(&str, TriMesh)| {
        let path = home.join(format!("{name}.ply"));
        let overwrite = WriteOptions { force: true, format: None };
        io::write(&path, mesh, &Attributes::default(), &overwrite).unwrap();
        ZtModel { name: (*name).to_owned(), path, paper: None }
    };
    ZtRequest {
        models: meshes.iter().map(model).collect(),
        read: ReadOptions::default(),
        presets: vec![Preset::Best],
        levels: vec![0.5],
        samples: 1000,
        seed: 0,
        cameras: Some(18),
        resolution: Some(128),
        convergence: false,
        up: [0.0, 0.0, 1.0],
        memory_limit: None,
        output: home.join("zt"),
    }
}

fn model<'a>(report: &'a ZtReport, name: &str) -> &'a ModelReport {
    report.models.iter().find(|model| model.findings.name == name).unwrap()
}

/// On a convex body every triangle's V is 1, exactly where F is seen or not seen, so that visibility has nothing to say.
/// On a ball many edges cost the same; which of them goes first is rounding's choice and moves the image error by this many
/// percent at most.
const TIES: f64 = 1.0;

#[test]
fn on_a_convex_body_visibility_changes_nothing() {
    let home = tempfile::tempdir().unwrap();
    let request = request(home.path(), &[("ball", shapes::icosphere(3))]);
    let report = study_zt(&ZtRequest { presets: vec![Preset::Paper], ..request }, &Silent).unwrap();
    let ball = model(&report, "ball");
    assert_eq!(ball.visibility(Preset::Paper), Some(1.0));
    assert!(ball.less_error(Preset::Paper, Preset::Paper).unwrap().abs() < TIES);
}

/// Half of the triangles lie in the dark; deleting them leaves the outside whole at the first level.
#[test]
fn a_hidden_half_costs_quadrics_alone_their_pictures() {
    let home = tempfile::tempdir().unwrap();
    let nested = shapes::nested_spheres(0.5, 3).mesh;
    let report = study_zt(&request(home.path(), &[("nested", nested)]), &Silent).unwrap();
    let nested = model(&report, "nested");
    let vg = nested.run(Preset::Best, Metric::Visibility).unwrap();
    assert_eq!(vg.hidden_deleted * 2, nested.findings.triangles);
    assert_eq!(vg.levels[0].errors.image_rms, 0.0);
    assert!(nested.run(Preset::Best, Metric::Quadric).unwrap().levels[0].errors.image_rms > 0.0);
    assert!(nested.less_error(Preset::Best, Preset::Best).unwrap() > 50.0);
}

/// Counts the looks that are taken.
#[derive(Default)]
struct Counting {
    phases: Mutex<Vec<&'static str>>,
    stop_at: Option<&'static str>,
    cell: Mutex<String>,
}

impl Progress for Counting {
    fn report(&self, phase: &'static str, _done: u64, _total: u64) {
        self.phases.lock().unwrap().push(phase);
    }

    fn is_cancelled(&self) -> bool {
        self.stop_at == Some(self.cell.lock().unwrap().as_str())
    }
}

impl Observer for Counting {
    fn cell(&self, _model: &str, cell: &str, _found: bool) {
        cell.clone_into(&mut self.cell.lock().unwrap());
    }
}

/// What a study says, without its times.
fn numbers(report: &ZtReport) -> serde_json::Value {
    fn forget(value: &mut serde_json::Value) {
        match value {
            serde_json::Value::Object(map) => {
                map.remove("seconds");
                map.values_mut().for_each(forget);
            }
            serde_json::Value::Array(list) => list.iter_mut().for_each(forget),
            _ => {}
        }
    }
    let mut value = serde_json::to_value(report).unwrap();
    forget(&mut value);
    value
}

#[test]
fn a_stopped_study_goes_on_with_the_cell_it_was_at() {
    let home = tempfile::tempdir().unwrap();
    let request = request(home.path(), &[("bowl", shapes::spherical_bowl(0.5, [24, 12]).mesh)]);
    let stopped = Counting { stop_at: Some("vg-best"), ..Counting::default() };
    assert!(matches!(study_zt(&request, &stopped), Err(Error::Cancelled)));
    let done: Vec<String> =
        plan_zt(&request).unwrap().iter().filter(|cell| cell.done).map(|cell| cell.cell.name()).collect();
    assert_eq!(done, ["look-best", "qb-best"]);

    let continued = study_zt(&request, &Silent).unwrap();
    let elsewhere = ZtRequest { output: home.path().join("whole"), ..request.clone() };
    assert!(numbers(&continued) == numbers(&study_zt(&elsewhere, &Silent).unwrap()), "the same numbers in one go");

    let again = Counting::default();
    assert!(numbers(&study_zt(&request, &again).unwrap()) == numbers(&continued), "to the last bit");
    assert!(again.phases.lock().unwrap().is_empty(), "a finished study looks at nothing");
}

#[test]
fn a_cell_is_found_again_only_with_its_options_its_mesh_and_its_files() {
    let home = tempfile::tempdir().unwrap();
    let request = request(home.path(), &[("ball", shapes::icosphere(2))]);
    study_zt(&request, &Silent).unwrap();
    let left = |request: &ZtRequest| -> Vec<String> {
        plan_zt(request).unwrap().iter().filter(|cell| !cell.done).map(|cell| cell.cell.name()).collect()
    };
    assert!(left(&request).is_empty());
    let of_levels = ["qb-best", "vg-best", "pictures-best", "viewer"];
    assert_eq!(left(&ZtRequest { levels: vec![0.4], ..request.clone() }), of_levels);
    assert_eq!(left(&ZtRequest { resolution: Some(64), ..request.clone() }).len(), 5);

    fs::remove_file(request.output.join("ball-heat-best.png")).unwrap();
    assert_eq!(left(&request), ["look-best"]);
    fs::write(request.output.join("cells/ball/qb-best.json"), "{").unwrap();
    assert_eq!(left(&request), ["look-best", "qb-best"]);
    let other = shapes::bumpy_sphere(2, 0.1);
    let overwrite = WriteOptions { force: true, format: None };
    io::write(&request.models[0].path, &other, &Attributes::default(), &overwrite).unwrap();
    assert_eq!(left(&request).len(), 5);
}

#[test]
fn models_called_alike_and_levels_out_of_order_are_refused() {
    let home = tempfile::tempdir().unwrap();
    let alike = request(home.path(), &[("a", shapes::tetrahedron()), ("a", shapes::tetrahedron())]);
    assert!(study_zt(&alike, &Silent).unwrap_err().to_string().contains("two files are called a"));
    for levels in [vec![], vec![0.1, 0.5], vec![1.0], vec![0.0]] {
        let request = ZtRequest { levels, ..request(home.path(), &[("a", shapes::tetrahedron())]) };
        assert!(matches!(study_zt(&request, &Silent), Err(Error::Option { name: "--levels", .. })));
    }
    assert!(!home.path().join("zt").exists(), "a refused study writes nothing");
}
