//! JSON objects: the keys that docs/json.md promises.

use serde_json::Value;

use crate::runner::{SMALL, assert_begins_with, directory, json, keys};

#[test]
fn measure_json_has_the_promised_keys() {
    let home = directory();
    let object = json(home.path(), &[&["measure", "cube.off", "--json"], &SMALL[..]].concat());
    assert_begins_with(&object, &["schema", "triangles", "cameras", "resolution", "backend", "estimator"]);
    assert_eq!(object["schema"], 1);
    assert_eq!(object["triangles"], 12);
    assert_eq!(object["backend"], "raster");
    assert_eq!(object["estimator"], "coverage");
    assert_eq!(keys(&object["visibility"]), ["mesh", "mesh_sides", "never_seen"]);
    assert_eq!(keys(&object["seconds"]), ["read", "build", "visibility", "total"]);
    assert!(object["peak_mb"].is_number() || !cfg!(target_os = "linux"));
    assert_eq!((&object["dropped"], &object["warnings"]), (&Value::Array(vec![]), &Value::Array(vec![])));
}

#[test]
fn simplify_json_has_the_promised_keys() {
    let home = directory();
    let arguments = ["simplify", "bumps.off", "-o", "x.ply", "--lods", "0.5,0.25,100", "--json"];
    let object = json(home.path(), &[&arguments[..], &SMALL].concat());
    assert_begins_with(&object, &["schema", "levels", "triangles", "metric"]);
    assert_eq!(
        (&object["schema"], &object["triangles"], &object["metric"]),
        (&1.into(), &3200.into(), &"visibility".into())
    );
    assert_eq!(keys(&object["seconds"]), ["read", "visibility", "simplify", "write", "total", "hidden"]);
    assert!(object.get("peak_mb").is_some());
    let levels = object["levels"].as_array().unwrap();
    for (level, (target, file)) in levels.iter().zip([(1600, "x-lod0.ply"), (800, "x-lod1.ply"), (100, "x-lod2.ply")]) {
        assert_begins_with(level, &["target", "output", "stop", "error", "file"]);
        assert_eq!((&level["target"], &level["file"]), (&target.into(), &file.into()));
        assert_eq!(level["stop"], "target");
        assert!(level["output"].as_u64().unwrap() <= target);
        assert_eq!(json(home.path(), &["info", file, "--json"])["triangles"], level["output"]);
    }
    assert_eq!(levels.len(), 3);
}
