//! `simplify`: levels, targets, topology.

use serde_json::Value;

use crate::runner::{GEARBOX, SMALL, directory, json, names, run};

#[test]
fn a_target_that_held_from_the_start_is_told() {
    let home = directory();
    let simplify = |more: &[&str]| {
        let all = [&["simplify", "cube.off", "-o", "x.ply", "--force"][..], &SMALL, more].concat();
        run(home.path(), &all)
    };
    let ended = simplify(&["-t", "50", "--json"]);
    let object: Value = serde_json::from_str(&ended.out).unwrap();
    let warning = "x.ply: 12 triangles were there to begin with, not 50: nothing was collapsed";
    assert_eq!((&object["levels"][0]["stop"], &object["warnings"]), (&"target".into(), &serde_json::json!([warning])));
    assert_eq!(ended.err, format!("warning: {warning}\n"));
    assert!(simplify(&["-t", "50"]).out.contains("fewer than that to begin with"));
    assert_eq!(simplify(&["-t", "12"]).err, "", "exactly what was asked for");
}

#[test]
fn preserving_topology_keeps_closed_meshes_closed() {
    let home = directory();
    let ended = run(
        home.path(),
        &["simplify", GEARBOX, "-o", "x.ply", "-r", "0.3", "--topology", "preserve", "--hidden", "delete"],
    );
    assert_eq!(ended.code, 2);
    assert!(ended.err.contains("--hidden collapse"), "{}", ended.err);
    let quick = ["--cameras", "66", "--resolution", "100"];
    let kept =
        [&["simplify", GEARBOX, "-o", "x.ply", "-r", "0.3", "--topology", "preserve", "--json"][..], &quick].concat();
    let topology = json(home.path(), &kept)["levels"][0]["topology"].clone();
    for unchanged in ["components", "boundary_edges", "non_manifold_edges", "euler_characteristic"] {
        assert_eq!(topology[unchanged], 0, "{unchanged}");
    }
    let info = json(home.path(), &["info", "x.ply", "--json"]);
    assert_eq!(info["topology"]["closed"], true);
}

#[test]
fn topology_is_counted_from_the_mesh_as_read() {
    let home = directory();
    let options = ["-o", "x.ply", "-r", "0.1", "--cameras", "66", "--resolution", "100", "--json"];
    let report = json(home.path(), &[&["simplify", GEARBOX][..], &options].concat());
    assert!(report["hidden_deleted"].as_u64().unwrap() > 0);
    let [before, after] =
        [GEARBOX, "x.ply"].map(|file| json(home.path(), &["info", file, "--json"])["topology"].clone());
    for key in ["components", "boundary_edges", "non_manifold_edges", "euler_characteristic"] {
        let change = after[key].as_i64().unwrap() - before[key].as_i64().unwrap();
        assert_eq!(report["levels"][0]["topology"][key], change, "{key}");
    }
}

#[test]
fn several_levels_do_not_fit_one_pipe() {
    let home = directory();
    let ended = run(home.path(), &["simplify", "bumps.off", "-o", "-", "--output-format", "ply", "--lods", "0.5,0.1"]);
    assert_eq!(ended.code, 2);
    assert_eq!(names(home.path()), ["bumps.off", "cube.off"]);
}

#[test]
fn who_looks_again_for_what_is_hidden_is_told_where_anybody_does() {
    let home = directory();
    let options = |flags: &[&str]| {
        let common = ["simplify", "cube.off", "-o", "x.ply", "-r", "0.5", "--resolution", "64", "--force", "--json"];
        json(home.path(), &[&common, flags].concat())["options"].clone()
    };
    assert_eq!(options(&["--hidden", "delete"])["hidden_backend"], "raster");
    assert!(options(&["--hidden", "keep"])["hidden_backend"].is_null());
    assert!(options(&["--metric", "quadric"])["hidden_backend"].is_null());
}
