//! Flags and values: what is refused, and what the refusal says.

use std::fs;

use crate::runner::{directory, json, run};

#[test]
fn flags_of_rays_say_what_they_need() {
    let home = directory();
    let cases: [(&[&str], &str); 5] = [
        (
            &["--estimator", "surface", "--backend", "raster"],
            "surface needs rays, which backend raster does not cast; add --backend embree",
        ),
        (&["--estimator", "hemisphere", "--backend", "raster"], "add --backend embree"),
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
#[cfg(feature = "embree")]
fn who_asks_for_rays_need_not_name_who_casts_them() {
    let home = directory();
    for chosen in [&["--estimator", "surface"][..], &["--estimator", "surface", "--backend", "auto"]] {
        let object = json(home.path(), &[&["measure", "cube.off", "--cameras", "18", "--json"], chosen].concat());
        assert_eq!(object["backend"], "embree");
    }
}

/// Beyond a factor of 100 `coverage` would say 0.70 of a ball that every camera sees rightly at 0.875.
#[test]
fn cameras_of_hopelessly_unequal_weights_are_refused() {
    let home = directory();
    fs::write(home.path().join("unequal.txt"), "1 0 0 1e5\n0 1 0 1\n0 0 1 1\n").unwrap();
    let ended = run(home.path(), &["measure", "cube.off", "--camera-file", "unequal.txt"]);
    assert_eq!(ended.code, 2);
    assert!(
        ended.err.contains("the weights go from 1e0 to 1e5; the largest may be 100 times the smallest"),
        "{}",
        ended.err
    );
}

/// Nobody sees a cube from inside; depth rescue would say otherwise of the backs along its outline.
#[test]
fn the_item_buffer_looks_at_fronts_unless_told() {
    let home = directory();
    let look = ["measure", "cube.off", "--estimator", "item-buffer", "--cameras", "18", "--resolution", "64", "--json"];
    assert_eq!(json(home.path(), &look)["sides"], "one");
    assert_eq!(json(home.path(), &[&look[..], &["--sides", "sum"]].concat())["sides"], "sum");
}
