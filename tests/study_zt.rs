//! The study that makes Zhang & Turk's tables and figures again: known answers, and going on where it was stopped.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::sync::Mutex;

use glam::{DAffine3, DVec3};
use outsight::Error;
use outsight::io::{self, Attributes, ReadOptions, WriteOptions};
use outsight::mesh::{TriMesh, shapes};
use outsight::pipeline::{
    Cell, Levels, Metric, ModelReport, Observer, Preset, QuadricCount, RunFinding, ZtModel, ZtReport, ZtRequest,
    plan_zt, study_zt,
};
use outsight::progress::{Progress, Silent};
use outsight::report::paper::PaperModel;

/// Models of the study, few cameras, small pictures.
fn request(home: &Path, meshes: &[(&str, TriMesh)]) -> ZtRequest {
    let model = |(name, mesh): &(&str, TriMesh)| {
        let path = home.join(format!("{name}.ply"));
        let overwrite = WriteOptions { force: true, format: None };
        io::write(&path, mesh, &Attributes::default(), &overwrite).unwrap();
        ZtModel { name: (*name).to_owned(), path, paper: None, stand_in: false, up: [0.0, 0.0, 1.0] }
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
        memory_limit: None,
        output: home.join("zt"),
        machine: "on a slide rule".to_owned(),
        page: None,
    }
}

fn model<'a>(report: &'a ZtReport, name: &str) -> &'a ModelReport {
    report.models.iter().find(|model| model.findings.name == name).unwrap()
}

const SAME_PAPER: (Preset, Preset) = (Preset::Paper, Preset::Paper);
const SAME_BEST: (Preset, Preset) = (Preset::Best, Preset::Best);

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
    assert!(ball.less_error(SAME_PAPER, Levels::All).unwrap().abs() < TIES);
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
    assert!(nested.less_error(SAME_BEST, Levels::All).unwrap() > 50.0);
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
                map.retain(|key, _| !key.ends_with("seconds"));
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
    fs::write(request.output.join("cells/ball/viewer.json"), b"\xff\xfe").unwrap();
    assert_eq!(left(&request), ["look-best", "qb-best", "viewer"]);
    study_zt(&request, &Silent).unwrap();
    assert!(left(&request).is_empty());
    // What somebody made of its files since is not what it found.
    fs::write(request.output.join("cells/ball/heat-best.png"), "garbage").unwrap();
    let mesh = fs::read_dir(&request.output).unwrap().map(|entry| entry.unwrap().path());
    let mesh = mesh.into_iter().find(|path| path.to_string_lossy().contains("vg-best")).unwrap();
    fs::write(&mesh, &fs::read(&mesh).unwrap()[..100]).unwrap();
    assert_eq!(left(&request), ["look-best", "vg-best"]);
    study_zt(&request, &Silent).unwrap();
    // A run that is killed while it writes them anew, with other options, leaves none that seems to be the first's.
    let mut turned = request.clone();
    turned.models[0].up = [1.0, 0.0, 0.0];
    let killed = Counting { stop_at: Some("look-best"), ..Counting::default() };
    assert!(matches!(study_zt(&turned, &killed), Err(Error::Cancelled)));
    assert_eq!(left(&request), ["look-best"]);
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

/// By how much less image error `vg` has than `qb` at a level, in percent.
fn gain_at(vg: &RunFinding, qb: &RunFinding, level: usize) -> f64 {
    100.0 * (1.0 - vg.levels[level].errors.image_rms / qb.levels[level].errors.image_rms)
}

/// Deleting the inner sphere leaves VG half of the triangles where 60 % were asked for.
#[test]
fn levels_with_other_counts_than_asked_for_are_told_apart() {
    let home = tempfile::tempdir().unwrap();
    let nested = shapes::nested_spheres(0.5, 3).mesh;
    let request = ZtRequest { levels: vec![0.6, 0.25, 0.1], ..request(home.path(), &[("nested", nested)]) };
    let report = study_zt(&request, &Silent).unwrap();
    let nested = model(&report, "nested");
    let run = |metric| nested.run(Preset::Best, metric).unwrap();
    let (vg, qb) = (run(Metric::Visibility), run(Metric::Quadric));
    let gains = [0, 1, 2].map(|level| gain_at(vg, qb, level));
    let improvement = nested.improvement(SAME_BEST).unwrap();
    assert_eq!(improvement.equal_counts, 2);
    assert_eq!(improvement.less_error, Some(gains.iter().sum::<f64>() / 3.0));
    assert_eq!(improvement.less_error_at_equal_counts, Some((gains[1] + gains[2]) / 2.0));
    let left = vg.levels[0].triangles;
    assert_eq!(left * 2, nested.findings.triangles);
    assert!(nested.remarks().contains("At 60 % VG best has 1,280 triangles, since hidden triangles are deleted first"));
    let table = nested.level_table();
    assert_eq!(table.rows()[0][2], "0 with 1,280");
    assert!(!table.rows()[1][2].contains("with"));
    assert!(report.table2().to_string().contains("2 of 3"));
}

/// Levels of 1000, 500 and 100 triangles with an image error of 1, 2 and 4.
fn known_run(home: &Path) -> RunFinding {
    let request = ZtRequest { levels: vec![0.8, 0.5, 0.2], ..request(home, &[("ball", shapes::icosphere(2))]) };
    let report = study_zt(&request, &Silent).unwrap();
    let mut run = model(&report, "ball").run(Preset::Best, Metric::Quadric).unwrap().clone();
    // The level that the pictures show is a fourth.
    run.levels.truncate(3);
    for (level, (triangles, error)) in run.levels.iter_mut().zip([(1000, 1.0), (500, 2.0), (100, 4.0)]) {
        level.triangles = triangles;
        level.errors.image_rms = error;
    }
    run
}

#[test]
fn the_triangles_for_an_error_lie_between_the_levels_around_it() {
    let home = tempfile::tempdir().unwrap();
    let run = known_run(home.path());
    let expected = [
        (0.5, QuadricCount::MoreThan(1000)),
        (1.0, QuadricCount::About(1000)),
        // The square root of 1000 · 500 is 707.1, that of 500 · 100 is 223.6.
        (1.5, QuadricCount::About(707)),
        (3.0, QuadricCount::About(224)),
        (4.0, QuadricCount::AtMost(100)),
        (9.0, QuadricCount::AtMost(100)),
    ];
    for (error, triangles) in expected {
        assert_eq!(run.triangles_for(error), Some(triangles), "{error}");
    }
    assert_eq!(RunFinding { levels: Vec::new(), ..run }.triangles_for(1.0), None);
}

/// Spheres around each other, of these radii: only the first is seen.
fn onion(radii: &[f64]) -> TriMesh {
    let shell = |&radius: &f64| {
        shapes::transformed(&shapes::icosphere(2), &DAffine3::from_scale(DVec3::splat(radius))).unwrap()
    };
    shapes::merge(&radii.iter().map(shell).collect::<Vec<_>>()).unwrap()
}

#[test]
fn models_that_hide_more_than_half_are_summed_up_apart() {
    let home = tempfile::tempdir().unwrap();
    // V(M) is about 1, 0.55 and 0.41, the seen share of the area.
    let meshes = [("ball", onion(&[1.0])), ("two", onion(&[1.0, 0.9])), ("three", onion(&[1.0, 0.9, 0.8]))];
    let request = ZtRequest { levels: vec![0.2], ..request(home.path(), &meshes) };
    let report = study_zt(&request, &Silent).unwrap();
    let gain = |name| model(&report, name).less_error(SAME_BEST, Levels::All).unwrap();
    let levels: Vec<Levels> = report.summary.iter().map(|summary| summary.levels).collect();
    assert_eq!(levels, [Levels::All, Levels::EqualCounts]);
    let of_best = &report.summary[0];
    assert_eq!((of_best.below_half.models, of_best.below_half.less_error), (1, Some(gain("three"))));
    assert_eq!((of_best.from_half.models, of_best.from_half.less_error), (2, Some((gain("ball") + gain("two")) / 2.0)));
    assert_eq!(of_best.all.models, 3);
}

#[test]
fn page_and_tables_show_both_presets_and_what_they_leave_out() {
    let home = tempfile::tempdir().unwrap();
    let both = ZtRequest { presets: Preset::ALL.to_vec(), ..request(home.path(), &[("ball", shapes::icosphere(2))]) };
    let read = |file: &str| fs::read_to_string(both.output.join(file)).unwrap();
    let report = study_zt(&both, &Silent).unwrap();
    report.write(&both, "{}", &["outsight study zt <ball>".to_owned()]).unwrap();
    assert!(report.left_out.is_empty());
    assert_eq!(report.summary.len(), 6, "three pairs of simplifiers at two choices of levels");
    assert!(report.summary.iter().all(|summary| summary.correlations.len() == 2), "as either preset counts V");
    let page = read("report.html");
    for text in [
        "Visibility (Fig. 2), preset paper",
        "Visibility (Fig. 2), preset best",
        "Visibility diagram of the mesh (Fig. 1), preset paper: columns are triangles",
        "ball, side by side, preset paper",
        "ball, side by side, preset best",
        "ball: errors by level",
        "original: 320 triangles",
        "difference of VG",
        "0: no camera sees it",
        "<code>outsight study zt &lt;ball&gt;</code>",
    ] {
        assert!(page.contains(text), "{text}");
    }
    let tables = read("tables.md");
    for text in ["## Table 1", "## Table 2", "## Who gains", "## ball", "halves down to 1/128"] {
        assert!(tables.contains(text), "{text}");
    }

    // An earlier run's.
    fs::create_dir(both.output.join("cells/bumps")).unwrap();
    let alone = ZtRequest { presets: vec![Preset::Best], ..both.clone() };
    let report = study_zt(&alone, &Silent).unwrap();
    report.write(&alone, "{}", &[]).unwrap();
    assert_eq!(report.left_out, ["bumps"]);
    for file in ["report.html", "tables.md"] {
        assert!(
            read(file).contains("Not in this report, though found earlier in the same directory: bumps."),
            "{file}"
        );
    }
    let heads = report.table2().heads();
    assert_eq!(heads, ["model", "of the paper", "V(M)", "QB best (s)", "VG best (s)", "VG best (% less than QB best)"]);
    assert!(read("tables.md").contains("QB and VG were not studied"));
}

/// A strip with the triangles of the paper's interlocking tori, and nothing else of them.
#[test]
fn a_stand_in_of_the_same_count_is_one_where_somebody_says_so() {
    let home = tempfile::tempdir().unwrap();
    let corner = |i: u32| DVec3::new(f64::from(i), f64::from(i % 2) * 100.0, 0.0);
    let triangles = (0..9_708).map(|i| [i, i + 1, i + 2]).collect();
    let strip = TriMesh::new((0..9_710).map(corner).collect(), triangles).unwrap();
    let mut request = request(home.path(), &[("strip", strip)]);
    request.models[0].paper = PaperModel::named("locking_tori");
    let remarks = |request: &ZtRequest| model(&study_zt(request, &Silent).unwrap(), "strip").remarks();
    assert!(remarks(&request).starts_with("Has the name and the count of the paper's Locking Tori"));
    request.models[0].stand_in = true;
    assert!(remarks(&request).starts_with("Stand-in for Locking Tori: 9,708 triangles, as many as printed;"));
}

#[test]
fn few_models_have_no_rank_correlation() {
    let home = tempfile::tempdir().unwrap();
    let radii = [1.0, 0.9, 0.8, 0.7, 0.6];
    let meshes = ["a", "b", "c", "d", "e"].map(|name| (name, onion(&radii[..=usize::from(name.as_bytes()[0] - b'a')])));
    let ranked = |meshes: &[(&str, TriMesh)]| {
        let request = ZtRequest { levels: vec![0.2], ..request(home.path(), meshes) };
        study_zt(&request, &Silent).unwrap().summary[0].rank_correlation(Preset::Best)
    };
    assert_eq!(ranked(&meshes[..4]), None);
    // The more shells are hidden, the more VG has left for the one that is seen.
    assert_eq!(ranked(&meshes), Some(-1.0));
}

#[test]
fn a_plan_counts_levels_and_the_pieces_of_what_is_still_to_be_cut() {
    let home = tempfile::tempdir().unwrap();
    let request = ZtRequest { presets: Preset::ALL.to_vec(), ..request(home.path(), &[("a", shapes::tetrahedron())]) };
    let plan = plan_zt(&request).unwrap();
    let looks: Vec<_> = plan.iter().filter(|planned| matches!(planned.cell, Cell::Look(_))).collect();
    // Four triangles with edges of 1.63 radii, 126 pixels for a diameter: 103 pixels, cut four times to less than 8.
    assert_eq!(looks.iter().map(|planned| planned.pieces).collect::<Vec<_>>(), [Some(4.0 * 256.0), None]);
    assert!(plan.iter().all(|planned| planned.levels == 2), "one that was asked for, one in pictures");
}
