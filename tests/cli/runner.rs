//! Runs the program in a directory of its own, and looks at what the run left.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

/// A cube of twelve triangles.
pub const CUBE: &str = "OFF\n8 12 0\n-1 -1 -1\n1 -1 -1\n-1 1 -1\n1 1 -1\n-1 -1 1\n1 -1 1\n-1 1 1\n1 1 1\n\
    3 0 4 6\n3 0 6 2\n3 1 3 7\n3 1 7 5\n3 0 1 5\n3 0 5 4\n3 2 6 7\n3 2 7 3\n3 0 2 3\n3 0 3 1\n3 4 5 7\n3 4 7 6\n";

/// Fewer pixels than any default, for speed.
pub const SMALL: [&str; 4] = ["--cameras", "18", "--resolution", "64"];

/// The bundled model.
pub const GEARBOX: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/gearbox.ply.zst");

/// A directory with `cube.off` and `bumps.off`, an open sheet of 2·40·40 triangles.
pub fn directory() -> TempDir {
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

/// The program, to be run in `directory` with no cache but one that a flag names.
pub fn outsight(directory: &Path) -> Command {
    let mut command = Command::cargo_bin("outsight").unwrap();
    command.current_dir(directory).env_remove("OUTSIGHT_CACHE");
    command
}

/// What a run left: its exit code, standard output and standard error.
pub struct Ended {
    pub code: i32,
    pub out: String,
    pub err: String,
}

/// Runs the program to its end.
pub fn run(directory: &Path, arguments: &[&str]) -> Ended {
    let output = outsight(directory).args(arguments).output().unwrap();
    Ended {
        code: output.status.code().unwrap(),
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        err: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

/// The object that a run under `--json` ends well with.
pub fn json(directory: &Path, arguments: &[&str]) -> Value {
    let ended = run(directory, arguments);
    assert_eq!(ended.code, 0, "{}", ended.err);
    assert_eq!(ended.out.lines().count(), 1, "one object and nothing else: {}", ended.out);
    serde_json::from_str(&ended.out).unwrap()
}

/// The keys of an object, in their order.
pub fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

/// All of `wanted`, in that order, at the head of the object.
pub fn assert_begins_with(value: &Value, wanted: &[&str]) {
    assert_eq!(&keys(value)[..wanted.len()], wanted);
}

/// What a directory holds, in order.
pub fn names(directory: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(directory).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}
