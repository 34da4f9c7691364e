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
    assert_eq!(views("upAgain"), first, "the axis that was up at first gives the first view again");
    for state in ["dragged", "arrow", "plain", "edges", "up", "upTurned"] {
        let changed = views(state).iter().zip(&first).filter(|(now, then)| now["sum"] != then["sum"]).count();
        assert_eq!(changed, 2, "{state} changes both views");
    }
    assert_eq!(found["focused"], "CANVAS", "the Tab key reaches the views");

    let paper = &found["paper"];
    assert_ne!(paper["light"], paper["dark"]);
    assert_eq!(paper["light"], paper["chosen"], "the switch overrides what the system prefers");

    let phone = &found["phone"];
    assert_eq!(phone["wider"], 0, "nothing makes a phone's page wider than the phone");
    assert_eq!((&phone["onView"]["turned"], &phone["onView"]["scrolled"]), (&2.into(), &0.into()), "a finger turns");
    assert_eq!(phone["beside"]["turned"], 0);
    assert!(phone["beside"]["scrolled"].as_f64().unwrap() > 0.0, "beside the views a finger scrolls: {phone}");
    assert!(phone["tallest"].as_f64().unwrap() <= 0.7, "there is room for it: {phone}");
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
    assert!(!html.contains("<b>") && !html.contains("<img src=x"));
}

#[test]
fn compare_shows_all_that_it_prints_marks_the_best_and_says_who_wins() {
    let folder = reported();
    let cube = shapes::cuboid(glam::DVec3::ONE, 1);
    io::write(&folder.path().join("cube.ply"), &cube, &Attributes::default(), &WriteOptions::default()).unwrap();
    let compare = |meshes: &[&str]| {
        let more = ["--surface-samples", "1000", "--report", "c.html", "--force"];
        let ended = outsight(folder.path(), &[&["compare"], meshes, &more, &SMALL].concat()).success();
        let printed = String::from_utf8(ended.get_output().stdout.clone()).unwrap();
        (printed, fs::read_to_string(folder.path().join("c.html")).unwrap())
    };
    let (printed, html) = compare(&[HOSTILE, "<b>small.ply", "cube.ply"]);
    let words = printed.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
    let rows: Vec<Vec<&str>> = words.filter(|words| words.first() == Some(&"<b>small.ply")).collect();
    assert_eq!(rows.iter().map(Vec::len).collect::<Vec<_>>(), [8, 9, 7], "three tables, one with a unit: {printed}");
    for number in rows.iter().flat_map(|row| &row[1..]).filter(|word| **word != "%") {
        assert!(html.contains(&format!(">{number}")), "{number} is printed and not on the page");
    }
    // The smaller gearbox is nearer to the gearbox than a cube is, by every measure of pictures.
    let small: f64 = rows[0][2].parse().unwrap();
    let verdict = format!("&lt;b&gt;small.ply has the least image error: {small:.2} grey levels, ");
    assert!(html.contains(&verdict) && html.contains(" % less than cube.ply, with "), "{verdict}");
    assert!(html.contains(&format!("<td><strong>{small:.3}</strong></td>")));
    let (_, alone) = compare(&["cube.ply", "cube.ply"]);
    assert!(!alone.contains("<td><strong>") && !alone.contains("least image error"), "nobody to win against");
}

#[test]
fn files_of_one_name_are_told_apart_by_their_folders_and_no_others_show() {
    let folder = reported();
    for name in ["qb", "vg"] {
        fs::create_dir(folder.path().join(name)).unwrap();
        fs::copy(folder.path().join("<b>small.ply"), folder.path().join(name).join("x.ply")).unwrap();
    }
    let whole = folder.path().join("vg/x.ply").display().to_string();
    let arguments = ["compare", HOSTILE, "qb/x.ply", &whole, "--surface-samples", "1000", "--report", "c.html"];
    outsight(folder.path(), &[&arguments[..], &SMALL].concat()).success();
    let html = fs::read_to_string(folder.path().join("c.html")).unwrap();
    for text in ["Image error of qb/x.ply", "Image error of vg/x.ply", "vg/x.ply: difference from below"] {
        assert!(html.contains(text), "{text}");
    }
    assert!(html.contains("qb/x.ply vg/x.ply --surface-samples 1000 --report c.html --cameras 18"), "how it was made");
    assert!(!html.contains(&folder.path().display().to_string()), "folders are nobody's business");
}

#[test]
fn several_levels_have_a_plot_of_their_errors() {
    let folder = reported();
    let simplify = |lods: &str| {
        let arguments = ["simplify", HOSTILE, "-o", "x.ply", "--lods", lods, "--report", "l.html", "--force"];
        outsight(folder.path(), &[&arguments[..], &SMALL].concat()).success();
        let html = fs::read_to_string(folder.path().join("l.html")).unwrap();
        html.contains("Error over triangles")
    };
    assert!(simplify("0.5,0.2"));
    assert!(!simplify("0.5"), "a point is no curve");
}

#[test]
fn convergence_has_a_page_with_its_plots_and_numbers() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("b")).unwrap();
    for file in ["t.off", "b/t.off"] {
        fs::write(folder.path().join(file), "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").unwrap();
    }
    let study = ["study", "convergence", "t.off", "b/t.off", "-o", "s", "--against", "fibonacci", "--resolution", "64"];
    let ended = outsight(folder.path(), &[&study[..], &["--report", "r.html", "--json"]].concat()).success();
    let object: Value = serde_json::from_slice(&ended.get_output().stdout).unwrap();
    assert_eq!(object["page"], "r.html");
    let html = fs::read_to_string(folder.path().join("r.html")).unwrap();
    for error in object["meshes"][1]["errors"].as_array().unwrap() {
        let shown = format!("<td>{:.5}</td>", error["against_reference"].as_f64().unwrap());
        assert!(html.contains(&shown), "{shown}");
    }
    assert!(html.contains("t.off, b/t.off, convergence of visibility"));
    assert_eq!(html.matches("data:image/svg+xml").count(), 2);
    let found: Value = serde_json::from_str(&node::node("page.mjs", &[&folder.path().join("r.html")])).unwrap();
    assert_eq!((&found["requests"], &found["console"]), (&serde_json::json!([]), &serde_json::json!([])));
    assert_eq!((&found["broken"], &found["phone"]["wider"]), (&0.into(), &0.into()));
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
