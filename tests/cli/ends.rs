//! How runs end: exit codes, errors, signals, closed pipes.

use std::fs;
use std::path::PathBuf;
use std::process::{Command as Process, Stdio};
use std::time::{Duration, Instant};

use crate::runner::{directory, names, run};

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
fn a_mesh_too_thin_to_be_seen_is_an_error() {
    let home = directory();
    fs::write(home.path().join("line.off"), "OFF\n3 1 0\n0 0 0\n1 0 0\n0.5 1e-15 0\n3 0 1 2\n").unwrap();
    let ended = run(home.path(), &["measure", "line.off"]);
    assert_eq!(ended.code, 3);
    assert!(ended.err.contains("1e-14"), "{}", ended.err);
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
        assert!(String::from_utf8_lossy(&output.stderr).contains("no file is left half-written"));
        assert_eq!(names(home.path()), ["bumps.off", "cube.off"]);
    }
}
