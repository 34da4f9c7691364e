//! `verify`: statistics, refusals, pictures.

use crate::runner::{SMALL, assert_begins_with, directory, json, names, run};

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
