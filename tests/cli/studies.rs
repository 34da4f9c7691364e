//! `study convergence`.

use std::fs;

use crate::runner::{directory, json, names, run};

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
