//! Cameras and occluders.

use std::fs;

use serde_json::Value;

use crate::runner::{CUBE, SMALL, directory, json, run};

#[test]
fn cameras_in_force_are_named() {
    let home = directory();
    fs::write(home.path().join("ring.csv"), "x,y,z,weight\n1,0,0,2\n0,1,0,1\n0,0,1,1\n").unwrap();
    let options = |flags: &[&str]| {
        let object = json(home.path(), &[&["measure", "cube.off", "--json", "--resolution", "64"], flags].concat());
        (object["cameras"].clone(), object["options"].clone())
    };
    let (looking, named) = options(&["--camera-file", "ring.csv"]);
    assert_eq!((looking, &named["cameras"], &named["camera_pattern"]), (3.into(), &3.into(), &"file".into()));
    assert_eq!(named["camera_file"], "ring.csv");
    let (looking, named) = options(&["--camera-pattern", "fibonacci", "--cameras", "50", "--camera-rotation", "7"]);
    assert_eq!((looking, &named["camera_pattern"]), (50.into(), &"fibonacci".into()));
    assert_eq!((&named["camera_rotation"], &named["hemisphere"]), (&7.into(), &Value::Null));
    let (looking, named) = options(&["--camera-pattern", "latlong", "--hemisphere", "-z"]);
    assert_eq!((looking, &named["cameras"]), ((133 + 12).into(), &266.into()), "the equator is kept, and counts half");
    assert_eq!(named["hemisphere"], serde_json::json!([0.0, 0.0, -1.0]));
}

#[test]
fn cameras_that_cannot_look_are_refused_before_the_work() {
    let home = directory();
    let list = |text: &str| {
        fs::write(home.path().join("c.txt"), text).unwrap();
        run(home.path(), &["measure", "cube.off", "--camera-file", "c.txt"])
    };
    for (text, message) in [
        ("1 0 0\n0 0 0\n", "error: c.txt, line 2: 0 0 0 is no direction"),
        ("1 0 0\n", "error: c.txt: a single camera"),
        ("1 0 0\n0 nan 0\n", "error: c.txt, line 2: the coordinate `nan` is not finite"),
        ("1 0 0\n0 1\n", "error: c.txt, line 2: a camera is x y z"),
        ("", "error: c.txt: no cameras"),
    ] {
        let ended = list(text);
        assert_eq!(ended.code, 3, "{text}");
        assert!(ended.err.starts_with(message), "{}", ended.err);
    }
    let many = list(&"1 0 0\n".repeat(2_000_000));
    assert_eq!(many.err, "error: c.txt, line 65537: this is camera 65537; at most 65536 can look\n");
    let usage = |flags: &[&str]| {
        let ended = run(home.path(), &[&["measure", "cube.off"], flags].concat());
        assert_eq!(ended.code, 2, "{flags:?}");
        ended.err
    };
    assert!(usage(&["--cameras", "100"]).contains("6, 18, 66"));
    assert!(usage(&["--cameras", "7", "--camera-pattern", "fibonacci"]).contains("an even one"));
    assert!(usage(&["--cameras", "18", "--camera-pattern", "latlong"]).contains("266"));
    assert!(usage(&["--camera-file", "c.txt", "--cameras", "18"]).contains("cannot be used with"));
    assert!(usage(&["--hemisphere", "up"]).contains("+y or -z"));
    for resolution in ["0", "16385"] {
        assert!(usage(&["--resolution", resolution]).contains("16..=16384"));
    }
    assert_eq!(run(home.path(), &["measure", "cube.off", "--camera-file", "missing.txt"]).code, 3);
}

#[test]
fn an_enclosure_hides_all_and_is_never_written() {
    let home = directory();
    let shell: String = CUBE
        .lines()
        .map(|l| {
            let is_vertex = l.split(' ').count() == 3 && l.contains('1') && !l.starts_with("8 ");
            if is_vertex { l.replace('1', "3") + "\n" } else { l.to_owned() + "\n" }
        })
        .collect();
    fs::write(home.path().join("shell.off"), shell).unwrap();
    let object =
        json(home.path(), &[&["measure", "cube.off", "--json", "--occluder", "shell.off"][..], &SMALL].concat());
    assert_eq!((&object["visibility"]["mesh"], &object["visibility"]["never_seen"]), (&0.0.into(), &12.into()));
    assert_eq!((&object["triangles"], &object["occluder_triangles"]), (&12.into(), &12.into()));
    let ended = run(
        home.path(),
        &["simplify", "cube.off", "-o", "x.ply", "-t", "6", "--metric", "quadric", "--occluder", "shell.off"],
    );
    assert_eq!(ended.code, 2);
    assert!(ended.err.contains("--occluder: --metric quadric does not look"), "{}", ended.err);
}

/// A square floor just below `cube.off`.
fn floor(half_width: &str) -> String {
    let w = half_width;
    format!("OFF\n4 2 0\n-{w} -{w} -1.01\n{w} -{w} -1.01\n{w} {w} -1.01\n-{w} {w} -1.01\n3 0 1 2\n3 0 2 3\n")
}

#[test]
fn an_occluder_that_reaches_too_far_is_named_by_every_command_and_backend() {
    let home = directory();
    fs::write(home.path().join("huge.off"), floor("1e19")).unwrap();
    let mut commands = vec![
        vec!["measure", "cube.off"],
        vec!["simplify", "cube.off", "-o", "x.ply", "-r", "0.5"],
        vec!["explain", "cube.off", "0"],
        vec!["verify", "cube.off", "--backends", "raster,raster"],
        vec!["study", "convergence", "cube.off", "-o", "study", "--against", "fibonacci"],
    ];
    if cfg!(feature = "embree") {
        commands.push(vec!["measure", "cube.off", "--backend", "embree"]);
        commands.push(vec!["measure", "cube.off", "--backend", "embree", "--estimator", "hemisphere"]);
    }
    for command in commands {
        let ended = run(home.path(), &[&command[..], &["--occluder", "huge.off"]].concat());
        let message = "error: huge.off: reaches 8.2e18 times as far as the mesh, an occluder at most 1000 times";
        assert_eq!((ended.code, ended.err.starts_with(message)), (5, true), "{command:?}: {}", ended.err);
    }
}

#[test]
fn verify_and_study_look_past_the_same_floor() {
    let home = directory();
    fs::write(home.path().join("floor.off"), floor("100")).unwrap();
    let around = ["--occluder", "floor.off", "--json"];
    let backends = if cfg!(feature = "embree") { "raster,embree,hemisphere" } else { "raster,item-buffer" };
    let few = ["--cameras", "66", "--resolution", "100", "--camera-rotation", "3"];
    let verified = json(home.path(), &[&["verify", "cube.off", "--backends", backends][..], &few, &around].concat());
    for pair in verified["pairs"].as_array().unwrap() {
        for v in pair["visibility"].as_array().unwrap() {
            // Top 1, bottom 0, walls a half.
            assert!((v.as_f64().unwrap() - 0.5).abs() < 0.03, "{pair}");
        }
        assert_ne!(pair["pass"], false, "{pair}");
    }
    assert_eq!(verified["occluders"], serde_json::json!(["floor.off"]));
    let small = ["--resolution", "32", "--against", "fibonacci"];
    let study = |output: &str, more: &[&str]| {
        let all = [&["study", "convergence", "cube.off", "-o", output, "--json"][..], &small, more].concat();
        json(home.path(), &all)["meshes"][0]["errors"][0]["against_reference"].as_f64().unwrap()
    };
    // Six cameras look along the floor; those of the reference do not.
    assert!(study("floor", &around[..2]) > study("open", &[]) + 0.05);
}
