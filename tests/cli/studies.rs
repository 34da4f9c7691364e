//! `study convergence` and `study zt`.

use std::fs;

use crate::runner::{SMALL, directory, json, names, run};

#[test]
fn convergence_is_written_whole_and_shows_both_weights() {
    let home = directory();
    let small = ["--resolution", "32", "--against", "fibonacci"];
    let study = [&["study", "convergence", "cube.off", "-o", "study", "--json"], &small[..]].concat();
    let object = json(home.path(), &study);
    let errors = object["meshes"][0]["errors"].as_array().unwrap();
    assert_eq!(errors.len(), 12);
    assert_eq!((&errors[0]["cameras"], &errors[1]["weights"]), (&6.into(), &"area".into()));
    assert!(errors[11]["against_4098"].is_null());
    assert_eq!(object["reference"], "coverage@raster");
    assert!(object["reference_samples"].is_null() && object["meshes"][0]["reference_error"].is_null());
    assert_eq!(names(&home.path().join("study")), ["convergence.csv", "convergence.json", "convergence.svg"]);
    let csv = fs::read_to_string(home.path().join("study/convergence.csv")).unwrap();
    assert_eq!(csv.lines().count(), 13);
    assert!(fs::read_to_string(home.path().join("study/convergence.svg")).unwrap().contains("cube.off, area"));
    let again = run(home.path(), &study);
    assert_eq!(again.code, 4, "nothing is overwritten without --force");
    let other = [&["study", "convergence", "cube.off", "-o", "other", "--time-limit", "0.000001"], &small[..]].concat();
    assert_eq!(run(home.path(), &other).code, 5);
    assert!(!home.path().join("other").exists(), "no empty directory is left");
}

#[test]
fn convergence_needs_rays_unless_another_reference_is_named() {
    let home = directory();
    let study = ["study", "convergence", "cube.off", "-o", "study", "--resolution", "32"];
    let ended = run(home.path(), &study);
    if cfg!(feature = "embree") {
        assert!(ended.out.contains("against hemisphere@embree, 4096 rays a triangle"), "{}", ended.out);
        assert!(ended.out.contains("standard error of the reference"), "{}", ended.out);
    } else {
        assert_eq!(ended.code, 6);
        assert!(ended.err.contains("or use --against fibonacci"), "{}", ended.err);
        assert!(!home.path().join("study").exists());
    }
    let idle = run(home.path(), &[&study[..], &["--against", "fibonacci", "--samples", "64"]].concat());
    assert_eq!(idle.code, 2);
    assert!(idle.err.contains("casts no rays"), "{}", idle.err);
}

/// Everything that a study of one model leaves, but for its cells.
const FILES_OF_ONE: [&str; 13] = [
    "cube-diagram-best.png",
    "cube-errors-best.svg",
    "cube-heat-best.png",
    "cube-pictures-best-1.png",
    "cube-qb-best-1.ply",
    "cube-vg-best-1.ply",
    "levels.csv",
    "models.csv",
    "outline.png",
    "report.html",
    "tables.md",
    "zt.json",
    "cells",
];

#[test]
fn zt_plans_then_writes_tables_pictures_and_a_page() {
    let home = directory();
    let study =
        ["study", "zt", "motor=cube.off", "-o", "zt", "--preset", "best", "--levels", "0.5", "--no-convergence"];
    let study = [&study[..], &SMALL, &["--samples", "100", "--report", "page.html", "--json"]].concat();
    let plan = json(home.path(), &[&study[..], &["--dry-run"]].concat());
    let cells: Vec<&str> =
        plan["cells"].as_array().unwrap().iter().map(|cell| cell["cell"].as_str().unwrap()).collect();
    assert_eq!(cells, ["look-best", "qb-best", "vg-best", "pictures-best", "viewer"]);
    assert!(plan["estimated_seconds"].as_f64().unwrap() > 0.0);
    assert!(!home.path().join("zt").exists(), "a plan writes nothing");

    let object = json(home.path(), &study);
    let model = &object["models"][0];
    assert_eq!((&model["stand"]["stand"], &model["stand"]["paper"]["name"]), (&"stand_in".into(), &"Motor".into()));
    assert_eq!(model["runs"][1]["levels"][0]["triangles"], 6);
    let mut files = FILES_OF_ONE;
    files.sort_unstable();
    assert_eq!(names(&home.path().join("zt")), files);
    let done = json(home.path(), &[&study[..], &["--dry-run", "--force"]].concat());
    assert_eq!(done["estimated_seconds"], 0.0);
    let page = |file: &str| fs::read_to_string(home.path().join(file)).unwrap();
    assert!(page("zt/report.html").contains("Stand-in for Motor"));
    assert!(page("zt/report.html").contains("outsight study zt 'motor=cube.off' --output zt --preset best"));
    assert_eq!(page("page.html"), page("zt/report.html"));
}

#[test]
fn zt_leaves_foreign_directories_alone_and_knows_the_papers_models() {
    let home = directory();
    let foreign = run(home.path(), &["study", "zt", "cube.off", "-o", "."]);
    assert_eq!(foreign.code, 4);
    assert!(foreign.err.contains("holds files that no study made"), "{}", foreign.err);
    fs::create_dir_all(home.path().join("mine/cells")).unwrap();
    fs::write(home.path().join("mine/cells/battery.txt"), "").unwrap();
    let alike = run(home.path(), &["study", "zt", "cube.off", "-o", "mine", "--dry-run"]);
    assert_eq!(alike.code, 4, "somebody else's cells: {}", alike.out);
    let long = format!("{}.off", "x".repeat(240));
    fs::copy(home.path().join("cube.off"), home.path().join(&long)).unwrap();
    let long = run(home.path(), &["study", "zt", "cube.off", &long, "-o", "zt"]);
    assert!(long.code == 2 && long.err.contains("is too long"), "{}", long.err);
    let endless = run(home.path(), &["study", "zt", "/dev/zero", "-o", "zt"]);
    assert!(endless.code == 3 && endless.err.contains("is no ordinary file"), "{}", endless.err);
    let unknown = run(home.path(), &["study", "zt", "engine=cube.off", "-o", "zt"]);
    assert_eq!(unknown.code, 2);
    assert!(unknown.err.contains("the paper has no model 'engine'; it has bunny"), "{}", unknown.err);
    let alike = run(home.path(), &["study", "zt", "cube.off", "motor=cube.off", "-o", "zt"]);
    assert_eq!(alike.code, 2);
    let file = run(home.path(), &["study", "zt", "cube.off", "-o", "cube.off"]);
    assert_eq!(file.code, 4);
    assert!(file.err.contains("cube.off: is a file"), "{}", file.err);
    let percent = run(home.path(), &["study", "zt", "cube.off", "-o", "zt", "--levels", "1.5"]);
    assert_eq!(percent.code, 2);
    assert!(percent.err.contains("for 1.5 % write 0.015"), "{}", percent.err);
    let over = run(home.path(), &["study", "zt", "cube.off", "-o", "zt", "--report", "page.htm"]);
    assert!(over.code == 2 && over.err.contains("ends in .html"), "{}", over.err);
    assert!(!home.path().join("zt").exists());
}

#[test]
fn zt_turns_one_model_up_and_keeps_what_was_found_of_the_others() {
    let home = directory();
    fs::copy(home.path().join("cube.off"), home.path().join("box.off")).unwrap();
    let study = ["study", "zt", "cube.off", "box.off", "-o", "zt", "--preset", "best", "--levels", "0.5"];
    let study = [&study[..], &SMALL, &["--samples", "100", "--no-convergence", "--json"]].concat();
    json(home.path(), &study);
    let turned = [&study[..], &["--up", "0,0,1", "--up", "box=0,1,0"]].concat();
    let plan = json(home.path(), &[&turned[..], &["--dry-run"]].concat());
    let anew = |name: &str| {
        let cells = plan["cells"].as_array().unwrap().iter().filter(|cell| cell["model"] == name);
        cells.filter(|cell| cell["done"] == false).count()
    };
    assert_eq!((anew("cube"), anew("box")), (0, 2), "heat map and pictures; no simplifier knows what is up");
    let object = json(home.path(), &turned);
    assert_eq!((&object["models"][0]["up"][2], &object["models"][1]["up"][1]), (&1.0.into(), &1.0.into()));

    let stranger = run(home.path(), &[&study[..], &["--up", "ball=0,1,0"]].concat());
    assert_eq!(stranger.code, 2);
    assert!(stranger.err.contains("no model is called ball; there is cube, box"), "{}", stranger.err);
    let stranger = run(home.path(), &[&study[..], &["--stand-in", "ball"]].concat());
    assert!(stranger.err.contains("--stand-in: no model is called ball"), "{}", stranger.err);
}
