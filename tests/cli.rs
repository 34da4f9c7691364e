//! The program as its users meet it: exit codes, messages, JSON, files.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command as Process, Stdio};
use std::time::{Duration, Instant};

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

/// A cube of twelve triangles.
const CUBE: &str = "OFF\n8 12 0\n-1 -1 -1\n1 -1 -1\n-1 1 -1\n1 1 -1\n-1 -1 1\n1 -1 1\n-1 1 1\n1 1 1\n\
    3 0 4 6\n3 0 6 2\n3 1 3 7\n3 1 7 5\n3 0 1 5\n3 0 5 4\n3 2 6 7\n3 2 7 3\n3 0 2 3\n3 0 3 1\n3 4 5 7\n3 4 7 6\n";

/// Fewer pixels than any default, for speed.
const SMALL: [&str; 4] = ["--cameras", "18", "--resolution", "64"];

const GEARBOX: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/gearbox.ply.zst");

/// A directory with `cube.off` and `bumps.off`, an open sheet of 2·40·40 triangles.
fn directory() -> TempDir {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("cube.off"), CUBE).unwrap();
    fs::write(directory.path().join("bumps.off"), bumps(40)).unwrap();
    directory
}

/// A square sheet of 2·n·n triangles over a landscape of integer heights.
fn bumps(n: usize) -> String {
    let side = n + 1;
    let mut text = format!("OFF\n{} {} 0\n", side * side, 2 * n * n);
    for i in 0..side * side {
        text += &format!("{} {} {}\n", i % side, i / side, (i * 7919) % 5);
    }
    for i in (0..n * side).filter(|i| i % side < n) {
        text += &format!("3 {} {} {}\n3 {} {} {}\n", i, i + 1, i + side, i + 1, i + side + 1, i + side);
    }
    text
}

fn outsight(directory: &Path) -> Command {
    let mut command = Command::cargo_bin("outsight").unwrap();
    command.current_dir(directory);
    command
}

/// What a run left: its exit code, standard output and standard error.
struct Ended {
    code: i32,
    out: String,
    err: String,
}

fn run(directory: &Path, arguments: &[&str]) -> Ended {
    let output = outsight(directory).args(arguments).output().unwrap();
    Ended {
        code: output.status.code().unwrap(),
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        err: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

fn json(directory: &Path, arguments: &[&str]) -> Value {
    let ended = run(directory, arguments);
    assert_eq!(ended.code, 0, "{}", ended.err);
    assert_eq!(ended.out.lines().count(), 1, "one object and nothing else: {}", ended.out);
    serde_json::from_str(&ended.out).unwrap()
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

/// All of `wanted`, in that order, at the head of the object.
fn assert_begins_with(value: &Value, wanted: &[&str]) {
    assert_eq!(&keys(value)[..wanted.len()], wanted);
}

fn names(directory: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(directory).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn every_exit_code_has_its_cause() {
    let home = directory();
    fs::write(home.path().join("bad.off"), "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n").unwrap();
    let code = |arguments: &[&str]| run(home.path(), arguments).code;
    assert_eq!(code(&["info", "cube.off"]), 0);
    assert_eq!(code(&["--help"]), 0);
    assert_eq!(code(&["--version"]), 0);
    assert_eq!(code(&[]), 2, "no command");
    assert_eq!(code(&["simplify", "cube.off", "-o", "x.ply"]), 2, "no target");
    assert_eq!(code(&["simplify", "cube.off", "-o", "x.png", "-t", "4"]), 2, "unknown ending");
    assert_eq!(code(&["info", "missing.ply"]), 3);
    assert_eq!(code(&["info", "bad.off"]), 3);
    assert_eq!(code(&["convert", "cube.off", "no/such/x.ply"]), 4);
    assert_eq!(code(&["convert", "bumps.off", "x.ply", "--memory-limit", "1k"]), 5);
    assert_eq!(code(&["measure", "bumps.off", "--time-limit", "0.000001"]), 5);
    assert_eq!(code(&["measure", "cube.off", "--backend", "gpu"]), 6);
    let embree = if cfg!(feature = "embree") { 0 } else { 6 };
    assert_eq!(code(&["measure", "cube.off", "--backend", "embree"]), embree);
    assert_eq!(names(home.path()), ["bad.off", "bumps.off", "cube.off"], "nothing is written on the way");
}

#[test]
fn what_this_version_lacks_is_named_with_what_to_use_instead() {
    let home = directory();
    let cases: [(&[&str], &str); 4] = [
        (&["measure", "cube.off", "--backend", "gpu"], "--backend raster"),
        (&["simplify", "cube.off", "-o", "x.ply", "-t", "4", "--metric", "orientation"], "--metric visibility"),
        (&["simplify", "cube.off", "-o", "x.ply", "-t", "4", "--metric", "silhouette"], "--metric visibility"),
        (&["simplify", "cube.off", "-o", "x.ply", "-t", "4", "--refit", "guarded"], "--refit none"),
    ];
    for (arguments, instead) in cases {
        let ended = run(home.path(), arguments);
        assert_eq!(ended.code, 6, "{arguments:?}: {}", ended.err);
        assert!(ended.err.contains(instead), "{arguments:?}: {}", ended.err);
    }
}

#[test]
fn flags_of_rays_say_what_they_need() {
    let home = directory();
    let cases: [(&[&str], &str); 5] = [
        (&["--estimator", "surface"], "surface needs rays, which backend raster does not cast; add --backend embree"),
        (&["--estimator", "hemisphere", "--backend", "auto"], "add --backend embree"),
        (&["--samples", "64"], "--samples: belongs to the estimator hemisphere, and what looks is coverage"),
        (&["--points", "0"], "--points"),
        (&["--target-error", "2"], "write a standard error above 0 and below 1"),
    ];
    for (flags, message) in cases {
        let ended = run(home.path(), &[&["measure", "cube.off"], flags].concat());
        assert_eq!(ended.code, 2, "{flags:?}: {}", ended.err);
        assert!(ended.err.contains(message), "{flags:?}: {}", ended.err);
    }
}

#[cfg(feature = "embree")]
#[test]
fn flags_that_the_estimator_cannot_use_are_refused_with_who_can() {
    let home = directory();
    fs::write(home.path().join("two.txt"), "1 0 0\n0 1 0\n").unwrap();
    let hemisphere = ["--estimator", "hemisphere", "--backend", "embree"];
    let surface = ["--estimator", "surface", "--backend", "embree"];
    let ended = |command: &[&str], flags: &[&str]| run(home.path(), &[command, flags].concat());
    for foreign in [
        ["--cameras", "18"],
        ["--camera-weights", "equal"],
        ["--camera-file", "two.txt"],
        ["--camera-pattern", "latlong"],
        ["--camera-rotation", "3"],
    ] {
        let refused = ended(&["measure", "cube.off"], &[&hemisphere[..], &foreign].concat());
        let message = format!(
            "{}: belongs to the estimators coverage, item-buffer, surface, and what looks is hemisphere",
            foreign[0]
        );
        assert_eq!((refused.code, refused.err.contains(&message)), (2, true), "{}", refused.err);
        assert_eq!(ended(&["measure", "cube.off"], &[&surface[..], &foreign].concat()).code, 0, "{foreign:?}");
        assert_eq!(ended(&["verify", "cube.off", "--backends", "hemisphere,surface"], &foreign).code, 0, "{foreign:?}");
    }
    for rays in [hemisphere, surface] {
        let refused = ended(&["measure", "cube.off", "--resolution", "64"], &rays);
        assert!(refused.err.contains("--resolution: belongs to the estimators coverage, item-buffer, and"));
        assert_eq!(refused.code, 2);
        // What is hidden is looked for in pictures.
        let simplify = ["simplify", "cube.off", "-o", "x.ply", "-r", "0.5", "--force", "--resolution", "64"];
        assert_eq!(ended(&simplify, &[&rays[..], &["--hidden", "delete"]].concat()).code, 0);
        assert_eq!(ended(&simplify, &[&rays[..], &["--hidden", "keep"]].concat()).code, 2);
    }
    let half = json(home.path(), &[&["measure", "cube.off", "--json", "--hemisphere", "+y"], &hemisphere[..]].concat());
    assert!((half["visibility"]["mesh"].as_f64().unwrap() - 0.5).abs() < 0.05, "the side means something to rays");
}

#[test]
fn wrong_sizes_say_what_was_meant() {
    let home = directory();
    let message = |size: &[&str]| {
        let ended = run(home.path(), &[&["simplify", "cube.off", "-o", "x.ply"], size].concat());
        assert_eq!(ended.code, 2, "{size:?}");
        ended.err
    };
    assert!(message(&["--ratio", "5"]).contains("for 5 % write --ratio 0.05"));
    assert!(message(&["-r", "5000"]).contains("write --triangles 5000"));
    assert!(message(&["-t", "0"]).contains("at least 1 triangle"));
    assert!(message(&["-t", "0.1"]).contains("write --ratio 0.1"));
    assert!(message(&["--lods", "0.1,0.5"]).contains("--lods"));
    assert!(message(&["-r", "0.5", "--hidden", "delete", "--metric", "quadric"]).contains("--metric visibility"));
}

#[test]
fn numbers_in_messages_are_as_short_as_they_can_be() {
    /// A message and the longest number of 16 digits in it.
    const LINE: usize = 160;
    let home = directory();
    let nines = "9".repeat(200);
    fs::write(home.path().join("far.off"), format!("OFF\n3 1 0\n0 0 0\n{nines} 0 0\n0 1 0\n3 0 1 2\n")).unwrap();
    fs::write(home.path().join("c.txt"), format!("1 0 0\n0 1 0 -{nines}\n")).unwrap();
    let simplify = ["simplify", "cube.off", "-o", "x.ply", "-r", "0.5"];
    for arguments in [
        &["info", "far.off"][..],
        &["measure", "cube.off", "--camera-file", "c.txt"],
        &[&simplify[..], &["--boundary", "1e300"]].concat(),
        &[&simplify[..], &["--visibility-power", &nines]].concat(),
    ] {
        let ended = run(home.path(), arguments);
        assert!(ended.code > 0 && ended.err.lines().all(|line| line.len() < LINE), "{}", ended.err);
        assert!(ended.err.contains("1e200") || ended.err.contains("1e300"), "{}", ended.err);
    }
    // What the user wrote is quoted as it is, and once.
    let ended = run(home.path(), &["simplify", "cube.off", "-o", "x.ply", "-r", &nines]);
    assert!(ended.err.lines().all(|line| line.len() < LINE + nines.len()), "{}", ended.err);
}

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
fn limits_and_costs_are_told_in_numbers_that_say_something() {
    let home = directory();
    let ended = run(home.path(), &["measure", "cube.off", "--memory-limit", "1k"]);
    assert_eq!(
        (ended.code, ended.err.starts_with("error: --memory-limit 1 KiB: 12 triangles")),
        (5, true),
        "{}",
        ended.err
    );
    let costly = ["measure", "cube.off", "--resolution", "16384", "--threads", "1"];
    let ended = run(home.path(), &[&costly[..], &["--memory-limit", "2G"]].concat());
    assert_eq!((ended.code, ended.err.contains("need about 4.0 GiB")), (5, true), "{}", ended.err);
    let ended = run(home.path(), &[&costly[..], &["--time-limit", "0.000001"]].concat());
    assert!(ended.err.contains("this takes about 9 min; fewer --cameras or a smaller --resolution"), "{}", ended.err);
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
fn a_mesh_too_thin_to_be_seen_is_an_error() {
    let home = directory();
    fs::write(home.path().join("line.off"), "OFF\n3 1 0\n0 0 0\n1 0 0\n0.5 1e-15 0\n3 0 1 2\n").unwrap();
    let ended = run(home.path(), &["measure", "line.off"]);
    assert_eq!(ended.code, 3);
    assert!(ended.err.contains("1e-14"), "{}", ended.err);
}

#[test]
fn errors_say_what_and_where_in_one_line() {
    let home = directory();
    fs::write(home.path().join("bad.off"), "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n").unwrap();
    let ended = run(home.path(), &["info", "bad.off"]);
    assert!(ended.out.is_empty());
    assert!(ended.err.starts_with("error: bad.off"), "{}", ended.err);
    assert_eq!(ended.err.lines().count(), 1, "{}", ended.err);
    let ended = run(home.path(), &["info", "missing.ply"]);
    assert!(ended.err.starts_with("error: missing.ply: "), "{}", ended.err);
}

#[test]
fn measure_json_has_the_promised_keys() {
    let home = directory();
    let object = json(home.path(), &[&["measure", "cube.off", "--json"], &SMALL[..]].concat());
    assert_begins_with(&object, &["schema", "triangles", "cameras", "resolution", "backend", "estimator"]);
    assert_eq!(object["schema"], 1);
    assert_eq!(object["triangles"], 12);
    assert_eq!(object["backend"], "raster");
    assert_eq!(object["estimator"], "coverage");
    assert_eq!(keys(&object["visibility"]), ["mesh", "mesh_sides", "never_seen"]);
    assert_eq!(keys(&object["seconds"]), ["read", "build", "visibility", "total"]);
    assert!(object["peak_mb"].is_number() || !cfg!(target_os = "linux"));
    assert_eq!((&object["dropped"], &object["warnings"]), (&Value::Array(vec![]), &Value::Array(vec![])));
}

#[test]
fn simplify_json_has_the_promised_keys() {
    let home = directory();
    let arguments = ["simplify", "bumps.off", "-o", "x.ply", "--lods", "0.5,0.25,100", "--json"];
    let object = json(home.path(), &[&arguments[..], &SMALL].concat());
    assert_begins_with(&object, &["schema", "levels", "triangles", "metric"]);
    assert_eq!(
        (&object["schema"], &object["triangles"], &object["metric"]),
        (&1.into(), &3200.into(), &"visibility".into())
    );
    assert_eq!(keys(&object["seconds"]), ["read", "visibility", "simplify", "write", "total", "hidden"]);
    assert!(object.get("peak_mb").is_some());
    let levels = object["levels"].as_array().unwrap();
    for (level, (target, file)) in levels.iter().zip([(1600, "x-lod0.ply"), (800, "x-lod1.ply"), (100, "x-lod2.ply")]) {
        assert_begins_with(level, &["target", "output", "stop", "error", "file"]);
        assert_eq!((&level["target"], &level["file"]), (&target.into(), &file.into()));
        assert_eq!(level["stop"], "target");
        assert!(level["output"].as_u64().unwrap() <= target);
        assert_eq!(json(home.path(), &["info", file, "--json"])["triangles"], level["output"]);
    }
    assert_eq!(levels.len(), 3);
}

#[test]
fn compare_json_has_the_promised_keys() {
    let home = directory();
    let object = json(home.path(), &["compare", "cube.off", "cube.off", "bumps.off", "--samples", "100", "--json"]);
    assert_begins_with(&object, &["schema", "tests"]);
    let tests = object["tests"].as_array().unwrap();
    assert_eq!(tests.len(), 2);
    for test in tests {
        let promised = ["file", "triangles", "image_rms", "image_rmse", "silhouette_xor", "geometric"];
        assert_eq!(keys(test), promised);
        assert_eq!(keys(&test["geometric"]), ["mean", "rms", "max"]);
    }
    assert_eq!(tests[0]["image_rmse"], 0.0, "a mesh equals itself");
}

#[test]
fn measure_writes_what_the_ending_says() {
    let home = directory();
    for name in ["v.ply", "v.npy", "v.csv"] {
        let ended = run(home.path(), &[&["measure", "cube.off", "-o", name], &SMALL[..]].concat());
        assert_eq!(ended.code, 0, "{}", ended.err);
    }
    let start = |name: &str| String::from_utf8_lossy(&fs::read(home.path().join(name)).unwrap()).into_owned();
    assert!(start("v.ply").contains("visibility"));
    assert!(start("v.npy").contains("NUMPY"));
    assert_eq!(start("v.csv").lines().count(), 13, "a head and twelve triangles");
}

#[test]
fn pictures_are_png_files() {
    let home = directory();
    let arguments = ["render", "cube.off", "-o", "r.png", "--style", "heat", "--size", "64", "--camera", "-1,-1,1"];
    assert_eq!(run(home.path(), &[&arguments[..], &SMALL].concat()).code, 0);
    let compared = run(home.path(), &["compare", "cube.off", "cube.off", "-o", "c.png", "--samples", "100"]);
    assert_eq!(compared.code, 0, "{}", compared.err);
    for name in ["r.png", "c.png"] {
        assert!(fs::read(home.path().join(name)).unwrap().starts_with(b"\x89PNG"), "{name}");
    }
}

#[test]
fn nothing_is_overwritten_without_force_and_no_input_with_it() {
    let home = directory();
    fs::write(home.path().join("old.ply"), "old").unwrap();
    let refused = run(home.path(), &["convert", "cube.off", "old.ply"]);
    assert_eq!(refused.code, 4);
    assert!(refused.err.contains("--force"), "{}", refused.err);
    assert_eq!(fs::read_to_string(home.path().join("old.ply")).unwrap(), "old");
    assert_eq!(run(home.path(), &["convert", "cube.off", "old.ply", "--force"]).code, 0);
    assert_eq!(run(home.path(), &["convert", "cube.off", "./cube.off", "--force"]).code, 2);
    assert_eq!(fs::read_to_string(home.path().join("cube.off")).unwrap(), CUBE);
}

#[test]
fn outputs_are_checked_before_the_input_is_read() {
    let home = directory();
    fs::write(home.path().join("old.ply"), "old").unwrap();
    let ended = run(home.path(), &["simplify", "missing.off", "-o", "old.ply", "-r", "0.5"]);
    assert_eq!(ended.code, 4, "the output, not the missing input, is named: {}", ended.err);
}

#[test]
fn warnings_are_lines_and_entries_and_errors_under_strict() {
    let home = directory();
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1 1 2\n";
    fs::write(home.path().join("n.obj"), mesh).unwrap();
    let ended = run(home.path(), &["convert", "n.obj", "n.ply"]);
    assert_eq!(ended.code, 0, "{}", ended.err);
    assert_eq!(ended.err.lines().filter(|l| l.starts_with("warning: n.obj: ")).count(), 2, "{}", ended.err);
    assert!(ended.err.contains("normals"), "{}", ended.err);

    let object = json(home.path(), &["convert", "n.obj", "m.ply", "--json"]);
    assert_eq!(object["dropped"], serde_json::json!(["normals"]));
    assert_eq!(object["set_aside"], 1);
    assert_eq!(object["warnings"].as_array().unwrap().len(), 2);

    let strict = run(home.path(), &["convert", "n.obj", "s.ply", "--strict"]);
    assert_eq!(strict.code, 3);
    assert!(!home.path().join("s.ply").exists());
}

#[cfg(feature = "embree")]
#[test]
fn an_error_out_of_reach_is_a_warning_and_under_strict_the_end() {
    let home = directory();
    let exact = ["cube.off", "--target-error", "1e-9", "--target-error-p99", "0.5"];
    let rays = ["--estimator", "hemisphere", "--backend", "embree"];
    let warning = "--target-error 1.000e-9 is not reached, 1.321e-5 is: 65,536 rays are the most a triangle casts";
    let measure = [&["measure"], &exact[..], &rays, &["--cache", "cube.seen"]].concat();
    for seen in ["now", "kept"] {
        let ended = run(home.path(), &measure);
        assert_eq!((ended.code, ended.err), (0, format!("warning: {warning}\n")), "{seen}");
    }
    let object = json(home.path(), &[&measure[..], &["--json"]].concat());
    assert_eq!(
        (&object["warnings"], &object["standard_error"]["end"]),
        (&serde_json::json!([warning]), &"most_samples".into())
    );
    let simplify = [&["simplify"], &exact[..], &rays, &["-o", "x.ply", "-r", "0.5", "--strict"]].concat();
    let strict = run(home.path(), &simplify);
    assert_eq!((strict.code, strict.err), (5, format!("error: {warning} (--strict makes this an error)\n")));
    assert!(!home.path().join("x.ply").exists());
    let verify = [&["verify"], &exact[..], &["--backends", "embree,hemisphere", "--cameras", "18"]].concat();
    assert!(run(home.path(), &verify).err.contains(warning));
    let reached = [&measure[..2], &rays, &["--target-error", "0.01"]].concat();
    assert_eq!(run(home.path(), &reached).err, "");
}

#[test]
fn pipes_carry_meshes_and_nothing_else() {
    let home = directory();
    let output =
        outsight(home.path()).args(["convert", "-", "-", "--output-format", "stl"]).write_stdin(CUBE).output().unwrap();
    assert_eq!(output.stdout.len(), 84 + 12 * 50, "{}", String::from_utf8_lossy(&output.stderr));
    let nameless = run(home.path(), &["convert", "cube.off", "-"]);
    assert_eq!(nameless.code, 2);
    assert_eq!(run(home.path(), &["convert", "cube.off", "-", "--output-format", "ply", "--json"]).code, 2);
}

#[test]
fn quiet_says_nothing() {
    let home = directory();
    let ended = run(home.path(), &["convert", "-q", "cube.off", "x.ply"]);
    assert_eq!((ended.code, ended.out.as_str(), ended.err.as_str()), (0, "", ""));
}

#[test]
fn progress_is_shown_only_where_asked() {
    let home = directory();
    let measure = |more: &[&str]| run(home.path(), &[&["measure", "cube.off"], &SMALL[..], more].concat()).err;
    assert_eq!(measure(&[]), "", "no terminal, no bars");
    assert!(measure(&["--progress", "always"]).contains("100 %"));
    assert_eq!(measure(&["--progress", "always", "-q"]), "");
}

#[test]
fn verify_reports_every_statistic_of_each_pair() {
    let home = directory();
    let object =
        json(home.path(), &[&["verify", "bumps.off", "--backends", "raster,coverage", "--json"][..], &SMALL].concat());
    assert_begins_with(&object, &["schema", "pairs"]);
    let pair = &object["pairs"][0];
    let statistics = [
        "a",
        "b",
        "agreement",
        "agreement_weighted",
        "kappa",
        "n11",
        "n10",
        "n01",
        "n00",
        "mean_abs_dv",
        "bias",
        "p99",
        "dvm",
        "pass",
    ];
    assert_begins_with(pair, &statistics);
    assert_eq!((&pair["a"], &pair["b"]), (&"coverage@raster".into(), &"coverage@raster".into()));
    assert_eq!((&pair["pass"], &pair["kappa"], &pair["mean_abs_dv"]), (&true.into(), &1.0.into(), &0.0.into()));
    assert!(pair["n11"].as_u64().unwrap() > 0);
    assert_eq!(pair["limits"]["kappa"], 0.999);
}

#[test]
fn verify_refuses_what_it_cannot_compare() {
    let home = directory();
    let verify = |more: &[&str]| run(home.path(), &[&["verify", "cube.off"], &SMALL[..], more].concat());
    let cases: [(&[&str], i32, &str); 4] = [
        (&["--backends", "raster"], 2, "at least two"),
        (&["--backends", "raster,magic"], 2, "surface@embree"),
        (&["--backends", "raster,raster", "--backend", "raster"], 2, "--backends"),
        (&["--backends", "raster,gpu"], 6, "leave coverage@gpu out of --backends"),
    ];
    for (arguments, code, message) in cases {
        let ended = verify(arguments);
        assert_eq!(ended.code, code, "{arguments:?}: {}", ended.err);
        assert!(ended.err.contains(message), "{arguments:?}: {}", ended.err);
    }
    let little = verify(&["--backends", "raster,raster", "--memory-limit", "1M"]);
    assert_eq!((little.code, little.err.contains("raise the limit")), (5, true), "{}", little.err);
}

#[test]
fn verify_speaks_of_its_own_flags_and_offers_what_works_here() {
    let home = directory();
    let ended = run(home.path(), &["verify", "cube.off", "--backends", "surface@raster,raster"]);
    assert_eq!(ended.code, 2);
    let message = "--backends: surface@raster: surface needs rays, which raster does not cast; name surface@embree";
    assert!(ended.err.contains(message), "{}", ended.err);
    let ended = run(home.path(), &["verify", "cube.off", "--backends", "foo,raster"]);
    assert!(ended.err.contains("neither a backend (raster") && !ended.err.contains("gpu"), "{}", ended.err);
    assert_eq!(ended.code, 2);
}

#[test]
fn verify_draws_where_two_differ_and_overwrites_nothing() {
    let home = directory();
    let arguments = [&["verify", "cube.off", "--backends", "raster,raster", "-o", "pictures"], &SMALL[..]].concat();
    assert_eq!(run(home.path(), &arguments).code, 0);
    let drawn = names(&home.path().join("pictures"));
    assert_eq!(drawn, ["coverage-raster-coverage-raster-values.png"], "no pixel differs");
    assert_eq!(run(home.path(), &arguments).code, 4);
    assert_eq!(run(home.path(), &[&arguments[..], &["--force"]].concat()).code, 0);
}

#[test]
fn doctor_checks_itself() {
    let home = directory();
    let object = json(home.path(), &["doctor", "--json"]);
    assert_eq!(object["self_check"]["passed"], true);
    assert_eq!(object["backends"][0]["works"], true);
}

#[test]
fn manual_and_completions_cover_every_command() {
    let home = directory();
    assert!(run(home.path(), &["man"]).out.contains(".TH outsight 1"));
    assert_eq!(run(home.path(), &["man", "--dir", "."]).code, 0);
    assert!(fs::read_to_string(home.path().join("outsight-simplify.1")).unwrap().contains("lods"));
    assert_eq!(run(home.path(), &["man", "--dir", "."]).code, 4, "pages are not overwritten");
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(run(home.path(), &["completions", shell]).out.contains("simplify"), "{shell}");
    }
}

#[test]
fn help_of_every_command_ends_with_examples() {
    let home = directory();
    let commands = [
        "demo",
        "info",
        "measure",
        "explain",
        "verify",
        "simplify",
        "compare",
        "render",
        "convert",
        "doctor",
        "completions",
        "man",
    ];
    for command in commands {
        let help = run(home.path(), &[command, "--help"]).out;
        let examples = help.split("Example").nth(1).unwrap_or_default();
        assert!(examples.contains(&format!("outsight {command}")), "{command}");
        assert!(help.lines().all(|line| line.chars().count() <= 120), "{command}");
    }
}

#[cfg(unix)]
#[test]
fn closed_pipe_ends_quietly() {
    let home = directory();
    // Neither text, help nor a mesh finds a reader: `true` has ended before the program begins.
    for command in ["completions bash", "info cube.off", "--help", "convert bumps.off - --output-format obj"] {
        let binary = assert_cmd::cargo::cargo_bin("outsight");
        let script = format!("set -o pipefail; (sleep 0.3; {} {command}) | true", binary.display());
        let output = Process::new("bash").args(["-c", &script]).current_dir(home.path()).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{command}");
        assert!(output.stderr.is_empty(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

#[cfg(unix)]
#[test]
fn signals_end_the_work_and_leave_no_file() {
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let home = directory();
        let binary: PathBuf = assert_cmd::cargo::cargo_bin("outsight");
        // Long enough to be interrupted: 4098 cameras at 4096 pixels are minutes of work.
        let child = Process::new(binary)
            .args(["measure", "bumps.off", "-o", "v.ply", "--cameras", "4098", "--resolution", "4096"])
            .current_dir(home.path())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(700));
        let start = Instant::now();
        Process::new("kill").args(["-s", signal, &child.id().to_string()]).status().unwrap();
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(code));
        assert!(start.elapsed() < Duration::from_secs(20), "it stops between two images");
        assert!(String::from_utf8_lossy(&output.stderr).contains("nothing was written"));
        assert_eq!(names(home.path()), ["bumps.off", "cube.off"]);
    }
}

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
