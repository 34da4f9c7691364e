//! Pages of `--report`, as a browser and their readers meet them.

#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

#[path = "web/node.rs"]
mod node;

use std::fs;
use std::path::Path;
use std::process::Command as Process;

use assert_cmd::Command;
use outsight::io::{self, Attributes, WriteOptions};
use outsight::mesh::shapes;
use serde_json::Value;

const GEARBOX: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/gearbox.ply.zst");

/// A file name that would run a script where it is not escaped.
const HOSTILE: &str = "<img src=x onerror=alert(1)>.ply";

/// Fewer pixels than any default, for speed.
const SMALL: [&str; 4] = ["--cameras", "18", "--resolution", "64"];

fn outsight(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("outsight").unwrap();
    command.current_dir(folder).env_remove("OUTSIGHT_CACHE").args(arguments).assert()
}

/// A folder with a gearbox of 2,665 triangles under a hostile name, and a page about a smaller one.
fn reported() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    outsight(folder.path(), &["simplify", GEARBOX, "-o", HOSTILE, "-r", "0.02", "--metric", "quadric"]).success();
    let arguments = ["simplify", HOSTILE, "-o", "<b>small.ply", "-r", "0.3", "--hidden", "keep", "--report", "r.html"];
    outsight(folder.path(), &[&arguments[..], &SMALL].concat()).success();
    folder
}

#[test]
fn a_browser_shows_the_page_and_turns_its_models() {
    let folder = reported();
    let found: Value = serde_json::from_str(&node::node("page.mjs", &[&folder.path().join("r.html")])).unwrap();
    assert_eq!(found["requests"], serde_json::json!([]), "no request leaves the page");
    assert_eq!(found["console"], serde_json::json!([]));
    assert_eq!((&found["dialogs"], &found["injected"], &found["broken"]), (&0.into(), &0.into(), &0.into()));
    let heading = format!("{HOSTILE}, simplified");
    assert_eq!((&found["title"], &found["heading"]), (&heading.as_str().into(), &heading.as_str().into()));

    let views = |state: &str| found["views"][state].as_array().unwrap().clone();
    let first = views("first");
    assert_eq!(first.len(), 2, "original and result");
    for view in &first {
        // The gearbox fills a quarter of its view, in the many shades of its facets.
        assert!(view["drawn"].as_f64().unwrap() > 0.1 && view["colours"].as_u64().unwrap() > 100, "{view}");
    }
    assert_eq!(views("reset"), first, "resetting undoes a drag");
    for state in ["dragged", "arrow", "plain", "edges"] {
        let changed = views(state).iter().zip(&first).filter(|(now, then)| now["sum"] != then["sum"]).count();
        assert_eq!(changed, 2, "{state} changes both views");
    }
    assert_eq!(found["focused"], "CANVAS", "the Tab key reaches the views");

    let paper = &found["paper"];
    assert_ne!(paper["light"], paper["dark"]);
    assert_eq!(paper["light"], paper["chosen"], "the switch overrides what the system prefers");
}

#[test]
fn the_same_input_gives_the_same_page_wherever_and_whenever() {
    let page = |threads: &str| {
        let folder = tempfile::tempdir().unwrap();
        outsight(folder.path(), &["simplify", GEARBOX, "-o", "a.ply", "-r", "0.02", "--metric", "quadric"]).success();
        let arguments = ["measure", "a.ply", "--report", "r.html", "--threads", threads];
        outsight(folder.path(), &[&arguments[..], &SMALL].concat()).success();
        let html = fs::read_to_string(folder.path().join("r.html")).unwrap();
        assert!(!html.contains(&folder.path().display().to_string()), "folders are nobody's business");
        html
    };
    let one = page("1");
    assert!(one.contains("a.ply, measured") && one.contains("Cameras"));
    assert!(one == page("2"), "two threads differ from one");
}

#[test]
fn more_than_150_000_triangles_are_shown_as_a_level_of_detail_that_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let spheres = shapes::nested_spheres(0.5, 6).mesh;
    io::write(&folder.path().join("s.ply"), &spheres, &Attributes::default(), &WriteOptions::default()).unwrap();
    outsight(folder.path(), &[&["measure", "s.ply", "--report", "r.html"][..], &SMALL].concat()).success();
    let html = fs::read_to_string(folder.path().join("r.html")).unwrap();
    assert!(html.contains("163,840 triangles, shown as a level of detail with 150,000"));
    assert!(html.len() <= 15_000_000, "{}", html.len());
}

#[test]
fn compare_puts_every_mesh_on_one_page() {
    let folder = reported();
    let arguments =
        ["compare", HOSTILE, "<b>small.ply", HOSTILE, "--surface-samples", "1000", "--report", "c.html", "--json"];
    let ended = outsight(folder.path(), &arguments).success();
    let object: Value = serde_json::from_slice(&ended.get_output().stdout).unwrap();
    assert_eq!(object["page"], "c.html");
    let html = fs::read_to_string(folder.path().join("c.html")).unwrap();
    assert_eq!(html.matches("<canvas").count(), 3);
    assert!(html.contains("Visible distance") && !html.contains("<b>") && !html.contains("<img src=x"));
}

#[test]
fn a_page_is_replaced_only_with_force_and_ends_in_html() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("r.html"), "mine").unwrap();
    fs::write(folder.path().join("t.off"), "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").unwrap();
    let measure = |page: &str, more: &[&str]| {
        let ended = outsight(folder.path(), &[&["measure", "t.off", "--report", page][..], &SMALL, more].concat());
        let output = ended.get_output().clone();
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    assert_eq!(measure("r.html", &[]).0, Some(4));
    assert_eq!(fs::read_to_string(folder.path().join("r.html")).unwrap(), "mine");
    assert_eq!(measure("r.html", &["--force"]).0, Some(0));
    for wrong in ["r.pdf", "-"] {
        let (code, message) = measure(wrong, &[]);
        assert_eq!((code, message.contains("--report: name a file that ends in .html")), (Some(2), true), "{message}");
    }
}

#[test]
fn the_vendored_viewer_is_what_its_script_makes() {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/vendor-viewer");
    let ended = Process::new(script).arg("--check").output().unwrap();
    let said = String::from_utf8_lossy(&ended.stderr).into_owned() + &String::from_utf8_lossy(&ended.stdout);
    assert!(ended.status.success(), "run scripts/vendor-viewer (needs scripts/install-needs --test): {said}");
}
