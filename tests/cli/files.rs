//! Files and pipes: what is written where, and never over something else.

use std::fs;

use crate::runner::{CUBE, SMALL, directory, outsight, run};

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
    let arguments = ["compare", "cube.off", "cube.off", "-o", "c.png", "--surface-samples", "100"];
    let compared = run(home.path(), &[&arguments[..], &SMALL].concat());
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
fn pipes_carry_meshes_and_nothing_else() {
    let home = directory();
    let output =
        outsight(home.path()).args(["convert", "-", "-", "--output-format", "stl"]).write_stdin(CUBE).output().unwrap();
    assert_eq!(output.stdout.len(), 84 + 12 * 50, "{}", String::from_utf8_lossy(&output.stderr));
    let nameless = run(home.path(), &["convert", "cube.off", "-"]);
    assert_eq!(nameless.code, 2);
    assert_eq!(run(home.path(), &["convert", "cube.off", "-", "--output-format", "ply", "--json"]).code, 2);
}
