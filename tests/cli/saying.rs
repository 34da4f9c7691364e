//! What the program says besides its results: warnings, progress, help.

use std::fs;

use crate::runner::{SMALL, directory, json, run};

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
