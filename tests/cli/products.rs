//! What a measurement leaves besides its numbers, as users meet it: diagrams, kept measurements, explanations.

use std::fs;

use outsight::io::{self, Attributes, WriteOptions};
use outsight::mesh::shapes;
use serde_json::Value;
use tempfile::TempDir;

use crate::runner::{Ended, GEARBOX, SMALL, json, names, run};

/// A sheet and a larger plate above it; between them in the file, a triangle that repeats a vertex.
const COVERED: &str = "OFF\n7 3 0\n-1 -1 0\n1 -1 0\n0 1 0\n-9 -9 1\n9 -9 1\n0 9 1\n5 5 5\n\
    3 0 1 2\n3 6 6 0\n3 3 4 5\n";

/// A directory with `covered.off`.
fn directory() -> TempDir {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("covered.off"), COVERED).unwrap();
    directory
}

#[test]
fn diagrams_have_a_row_per_triangle_of_the_file() {
    let home = directory();
    for (name, more) in [("d.vdg", None), ("d.npy", None), ("f.npy", Some("--diagram-fractions")), ("d.png", None)] {
        let arguments = ["measure", "covered.off", "--diagram", name, "--cameras", "6", "--resolution", "512"];
        let ended = run(home.path(), &[&arguments[..], more.as_slice()].concat());
        assert_eq!(ended.code, 0, "{}", ended.err);
    }
    let bytes = |name: &str| fs::read(home.path().join(name)).unwrap();
    // Cameras +x −x +y −y +z −z: the plate hides the sheet from +z, and both are edge-on from the sides.
    let rows = [[0, 0, 0, 0, 0, 1], [0; 6], [0, 0, 0, 0, 1, 1]].concat();
    assert_eq!(bytes("d.npy")[128..], rows);
    let [sheet, aside, plate] = [0, 1, 2].map(|row| bytes("f.npy")[128..][6 * row..][..6].to_vec());
    assert_eq!(sheet[..5], [0; 5], "{sheet:?}");
    assert_eq!(aside, [0; 6]);
    // The sheet covers 2 of the plate's 162: 252 of 255 are left, up to pixels.
    assert!(sheet[5] > 200 && plate[4] > 250 && (240..255).contains(&plate[5]), "{sheet:?} {plate:?}");
    let diagram = bytes("d.vdg");
    assert!(diagram.starts_with(b"VDG1\x03\0\0\0\x06\0\0\0"));
    assert_eq!(diagram[16 + 16 * 6..], [[32_u64, 0, 48].map(u64::to_le_bytes).concat()].concat());
    let decoder = png::Decoder::new(std::io::Cursor::new(bytes("d.png")));
    assert_eq!(decoder.read_info().unwrap().info().size(), (3, 6));
}

#[test]
fn diagrams_that_cannot_be_are_refused_before_the_work() {
    let home = directory();
    let refused = |more: &[&str]| {
        let ended = run(home.path(), &[&["measure", "covered.off"][..], more].concat());
        (ended.code, ended.err)
    };
    assert_eq!(refused(&["--diagram", "d.ply"]).0, 2, "not the ending of a diagram");
    assert_eq!(refused(&["--diagram-fractions"]).0, 2, "fractions of what?");
    assert_eq!(refused(&["--diagram", "x.npy", "-o", "x.npy"]).0, 2, "two outputs, one name");
    let (code, message) = refused(&["--diagram", "x.png", "--diagram-fractions"]);
    assert_eq!((code, message.contains(".vdg or .npy")), (2, true), "{message}");
    // 133,276 rows of 4098 bits are 66 MiB; of 6 bits, 1 MiB.
    let limited = |cameras: &str| {
        let arguments = ["measure", GEARBOX, "--diagram", "x.vdg", "--memory-limit", "100M", "--resolution", "480"];
        run(home.path(), &[&arguments[..], &["--cameras", cameras, "--threads", "2"]].concat())
    };
    let ended = limited("4098");
    assert_eq!((ended.code, ended.err.contains("raise the limit")), (5, true), "{}", ended.err);
    assert_eq!(names(home.path()), ["covered.off"]);
    assert_eq!(limited("6").code, 0);
}

#[test]
fn a_kept_look_gives_the_same_bytes_without_looking() {
    let home = directory();
    // The inner ball is what is hidden.
    let nested = shapes::nested_spheres(0.5, 2).mesh;
    let path = home.path().join("nested.ply");
    io::write(&path, &nested, &Attributes::default(), &WriteOptions::default()).unwrap();
    let simplify = |output: &str, more: &[&str]| {
        let arguments = ["simplify", "nested.ply", "-o", output, "-r", "0.1", "--hidden", "delete", "--json"];
        json(home.path(), &[&arguments[..], &SMALL, more].concat())
    };
    let plain = simplify("plain.ply", &[]);
    assert_eq!(plain["cache"], Value::Null);
    assert!(plain["hidden_deleted"].as_u64().unwrap() > 200, "{plain}");
    let measured = json(home.path(), &[&["measure", "nested.ply", "--json", "--cache", "kept"], &SMALL[..]].concat());
    assert_eq!(measured["cache"], "miss");
    let runs = ["a.ply", "b.ply"].map(|output| simplify(output, &["--cache", "kept"]));
    assert_eq!(runs[0]["cache"], "partial", "what is hidden was not asked for before");
    assert_eq!(runs[1]["cache"], "hit");
    let bytes = |name: &str| fs::read(home.path().join(name)).unwrap();
    for name in ["a.ply", "b.ply"] {
        assert_eq!(bytes(name), bytes("plain.ply"), "{name}");
    }
    for run in &runs {
        assert_eq!(run["hidden_deleted"], plain["hidden_deleted"]);
    }
    assert_eq!(names(&home.path().join("kept")).len(), 1, "one file, nothing beside it");
    let other =
        json(home.path(), &["measure", GEARBOX, "--json", "--cache", "kept", "--cameras", "6", "--resolution", "64"]);
    assert_eq!(other["cache"], "miss", "other options, another file");
    assert_eq!(names(&home.path().join("kept")).len(), 2);
}

#[test]
fn a_kept_look_at_another_mesh_or_a_damaged_one_is_an_error() {
    let home = directory();
    let moved = COVERED.replace("0 9 1", "0 9 1.5");
    fs::write(home.path().join("moved.off"), moved).unwrap();
    let measure = |mesh: &str, more: &[&str]| {
        let ended = run(home.path(), &[&["measure", mesh, "--cache", "one.seen"][..], &SMALL, more].concat());
        (ended.code, ended.err)
    };
    assert_eq!(measure("covered.off", &[]).0, 0);
    let kept = fs::read(home.path().join("one.seen")).unwrap();
    let (code, message) = measure("moved.off", &[]);
    assert_eq!(code, 3);
    assert!(message.contains("error: one.seen: this measurement is of another mesh; give --cache"), "{message}");
    let (code, message) = measure("covered.off", &["--sides", "one"]);
    assert_eq!((code, message.contains("other options")), (3, true), "{message}");
    assert_eq!(fs::read(home.path().join("one.seen")).unwrap(), kept, "errors change nothing");
    fs::write(home.path().join("one.seen"), &kept[..kept.len() - 1]).unwrap();
    let (code, message) = measure("covered.off", &[]);
    assert_eq!(
        (code, message.contains("one.seen: this measurement is damaged or truncated; delete it")),
        (3, true),
        "{message}"
    );
    fs::write(home.path().join("one.seen"), COVERED).unwrap();
    let (code, message) = measure("covered.off", &[]);
    assert_eq!((code, message.contains("no measurement")), (3, true), "{message}");
    assert_eq!(fs::read_to_string(home.path().join("one.seen")).unwrap(), COVERED, "nothing foreign is overwritten");
}

#[test]
fn a_damaged_look_in_a_directory_is_taken_again() {
    let home = directory();
    let measure = |more: &[&str]| {
        run(home.path(), &[&["measure", "covered.off", "--cache", "kept", "--json"][..], &SMALL, more].concat())
    };
    let cache_of = |ended: &Ended| serde_json::from_str::<Value>(&ended.out).unwrap()["cache"].clone();
    assert_eq!(measure(&[]).code, 0);
    let file = home.path().join("kept").join(&names(&home.path().join("kept"))[0]);
    let whole = fs::read(&file).unwrap();
    let foreign = b"not what it was".to_vec();
    for damaged in [whole[..whole.len() - 1].to_vec(), whole[..20].to_vec(), Vec::new(), foreign] {
        fs::write(&file, &damaged).unwrap();
        let strict = measure(&["--strict"]);
        assert_eq!((strict.code, fs::read(&file).unwrap()), (3, damaged), "{}", strict.err);
        let ended = measure(&[]);
        assert_eq!((ended.code, cache_of(&ended)), (0, "miss".into()), "{}", ended.err);
        let warns = |line: &str| line.starts_with("warning: kept/") && line.ends_with("; the mesh is looked at again");
        assert_eq!(ended.err.lines().filter(|line| warns(line)).count(), 1, "{}", ended.err);
        assert_eq!(fs::read(&file).unwrap(), whole);
        assert_eq!(cache_of(&measure(&[])), "hit");
    }
}

#[test]
fn a_seed_that_nothing_uses_does_not_part_kept_looks() {
    let home = directory();
    let cache = |more: &[&str]| {
        json(home.path(), &[&["measure", "covered.off", "--cache", "kept", "--json"], more].concat())["cache"].clone()
    };
    for pictures in [["--estimator", "coverage"], ["--estimator", "item-buffer"]] {
        let all = |seed| [&SMALL[..], &pictures, &["--seed", seed]].concat();
        assert_eq!([cache(&all("1")), cache(&all("2"))], ["miss", "hit"], "{pictures:?}");
    }
    if cfg!(feature = "embree") {
        let rays = |seed| cache(&["--estimator", "hemisphere", "--backend", "embree", "--seed", seed]);
        assert_eq!([rays("1"), rays("2")], ["miss", "miss"]);
    }
}

#[test]
fn an_interrupted_run_keeps_nothing() {
    let home = directory();
    let ended = run(home.path(), &["measure", GEARBOX, "--cache", "kept", "--time-limit", "0.3", "--cameras", "4098"]);
    assert_eq!(ended.code, 5, "{}", ended.err);
    assert_eq!(names(home.path()), ["covered.off"], "no empty directory either");
}

#[test]
fn explain_names_the_triangle_in_the_way_by_its_number_in_the_file() {
    let home = directory();
    let cameras = ["--cameras", "6", "--json"];
    let explain = |more: &[&str]| json(home.path(), &[&["explain", "covered.off"], more, &cameras].concat());
    let sheet = explain(&["0"]);
    assert_eq!((&sheet["visibility"], &sheet["side"]), (&0.0.into(), &"front".into()));
    // Triangle 1 of the file repeats a vertex, so that the plate is 1 in the mesh and 2 in the file.
    assert_eq!(sheet["blockers"], serde_json::json!([{ "triangle": 2, "cameras": 1 }]));
    let up = sheet["cameras"].as_array().unwrap().iter().find(|c| c["direction"][2] == 1.0).unwrap();
    assert_eq!((&up["sight"], &up["blocked_by"]), (&"blocked".into(), &2.into()));
    assert_eq!((&sheet["blocked"], &sheet["behind"], &sheet["seen"]), (&1.into(), &5.into(), &0.into()));
    assert_eq!(explain(&["0", "--back"])["visibility"], 1.0);
    assert_eq!(explain(&["2"])["visibility"], 1.0);
    let text = run(home.path(), &["explain", "covered.off", "0"]).out;
    assert!(text.contains("blocked by 2") && text.contains("more, with --all"), "{text}");
    assert!(run(home.path(), &["explain", "covered.off", "0", "--all"]).out.contains("behind"));
}

#[test]
fn explain_names_the_occluder_in_the_way() {
    let home = directory();
    // Below the sheet, seen from whose back it hides everything; triangle 0 of the file repeats a vertex.
    let floor = "OFF\n4 3 0\n-900 -900 -1\n900 -900 -1\n900 900 -1\n-900 900 -1\n3 0 0 1\n3 0 1 2\n3 0 2 3\n";
    fs::write(home.path().join("floor.off"), floor).unwrap();
    let arguments = ["explain", "covered.off", "0", "--back", "--cameras", "6", "--occluder", "floor.off"];
    let found = json(home.path(), &[&arguments[..], &["--json"]].concat());
    assert_eq!(found["blockers"].as_array().unwrap().len(), 1);
    let (blocker, down) = (&found["blockers"][0], &found["cameras"][5]);
    assert_eq!((&blocker["occluder"], &blocker["cameras"]), (&"floor.off".into(), &1.into()));
    assert!([1, 2].contains(&blocker["triangle"].as_u64().unwrap()), "{blocker}");
    assert_eq!((&down["occluder"], &down["blocked_by"]), (&"floor.off".into(), &blocker["triangle"]));
    assert_eq!((&found["visibility"], &found["occluders"]), (&0.0.into(), &serde_json::json!(["floor.off"])));
    let text = run(home.path(), &arguments).out;
    assert!(text.contains(&format!("blocked by {} of floor.off", blocker["triangle"])), "{text}");
}

#[test]
fn explain_says_which_triangles_there_are() {
    let home = directory();
    let refused = |more: &[&str]| {
        let ended = run(home.path(), &[&["explain", "covered.off"], more].concat());
        (ended.code, ended.err)
    };
    let (code, message) = refused(&["3"]);
    assert_eq!((code, message.contains("which has 0 to 2")), (2, true), "{message}");
    let (code, message) = refused(&["1"]);
    assert_eq!((code, message.contains("repeats a vertex")), (3, true), "{message}");
    assert_eq!(refused(&["-1"]).0, 2);
    for unused in [["--estimator", "coverage"], ["--rescue", "plain"], ["--points", "3"], ["--samples", "64"]] {
        let (code, message) = refused(&[&["0"][..], &unused].concat());
        assert_eq!((code, message.contains("leave it out")), (2, true), "{message}");
    }
}
