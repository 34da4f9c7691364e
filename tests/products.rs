//! What a measurement leaves besides its numbers, as users meet it: diagrams.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use tempfile::TempDir;

const GEARBOX: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/gearbox.ply.zst");

/// A sheet and a larger plate above it; between them in the file, a triangle that repeats a vertex.
const COVERED: &str = "OFF\n7 3 0\n-1 -1 0\n1 -1 0\n0 1 0\n-9 -9 1\n9 -9 1\n0 9 1\n5 5 5\n\
    3 0 1 2\n3 6 6 0\n3 3 4 5\n";

/// A directory with `covered.off`.
fn directory() -> TempDir {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("covered.off"), COVERED).unwrap();
    directory
}

/// What a run left: its exit code and standard error.
struct Ended {
    code: i32,
    err: String,
}

fn run(directory: &Path, arguments: &[&str]) -> Ended {
    let mut command = Command::cargo_bin("outsight").unwrap();
    let output = command.current_dir(directory).env_remove("OUTSIGHT_CACHE").args(arguments).output().unwrap();
    Ended {
        code: output.status.code().unwrap(),
        err: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

fn names(directory: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(directory).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
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
