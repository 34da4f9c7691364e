//! GLB files are what they should be: the Khronos validator has nothing to say, and another reader finds the mesh.

#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

#[path = "web/node.rs"]
mod node;

use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use glam::DVec3;
use outsight::Error;
use outsight::geom::Aabb;
use outsight::io::{self, Attributes, Glb, ReadOptions, WriteOptions};
use outsight::mesh::{TriMesh, shapes};
use serde_json::Value;

const GEARBOX: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/gearbox.ply.zst");

/// Two triangles on a common edge.
///
/// ```text
///   2--3
///   | \|
///   0--1
/// ```
fn square() -> TriMesh {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.0)];
    TriMesh::new(positions, vec![[0, 1, 2], [1, 3, 2]]).unwrap()
}

fn moved(mesh: &TriMesh, by: impl Fn(DVec3) -> DVec3) -> TriMesh {
    TriMesh::new(mesh.positions().iter().map(|&p| by(p)).collect(), mesh.triangles().to_vec()).unwrap()
}

/// What the crate `gltf` finds in a file: corners where the node puts them, their linear colours, vertices.
struct Found {
    corners: Vec<DVec3>,
    colours: Vec<[f32; 4]>,
    vertices: usize,
}

fn found(glb: &Glb) -> Found {
    let mut bytes = Vec::new();
    glb.write(&mut bytes).unwrap();
    let gltf = gltf::Gltf::from_slice(&bytes).unwrap();
    let blob = gltf.blob.as_deref().unwrap();
    let node = gltf.nodes().next().unwrap();
    let offset = node.transform().decomposed().0;
    let primitive = node.mesh().unwrap().primitives().next().unwrap();
    let reader = primitive.reader(|_| Some(blob));
    let place = |p: [f32; 3]| DVec3::from(p.map(f64::from)) + DVec3::from(offset.map(f64::from));
    let places: Vec<DVec3> = reader.read_positions().unwrap().map(place).collect();
    let indices: Vec<usize> = reader.read_indices().unwrap().into_u32().map(|i| i as usize).collect();
    let levels: Vec<[f32; 4]> = reader.read_colors(0).map(|c| c.into_rgba_f32().collect()).unwrap_or_default();
    let colours = if levels.is_empty() { Vec::new() } else { indices.iter().map(|&i| levels[i]).collect() };
    Found { corners: indices.iter().map(|&i| places[i]).collect(), colours, vertices: places.len() }
}

fn corners(mesh: &TriMesh) -> Vec<DVec3> {
    mesh.triangles().iter().flatten().map(|&v| mesh.positions()[v as usize]).collect()
}

#[test]
fn another_reader_finds_the_same_triangles() {
    let mesh = shapes::nested_spheres(0.5, 3).mesh;
    let centred = moved(&mesh, |p| p.as_vec3().as_dvec3());
    assert_eq!(
        found(&Glb::of(&centred, None).unwrap()).corners,
        corners(&centred),
        "32-bit coordinates stay as they are"
    );
    assert_eq!(found(&Glb::of(&centred, None).unwrap()).vertices, centred.vertex_count());
}

#[test]
fn far_from_the_origin_nothing_is_lost_but_32_bits_of_the_size() {
    // A part in the coordinates of a map: metres by the thousand kilometres.
    let far = DVec3::new(4_512_345.678, 5_345_678.912, 312.345);
    let mesh = moved(&shapes::nested_spheres(0.5, 3).mesh, |p| p / 3.0 + far);
    let hull = Aabb::around(mesh.positions().iter().copied()).unwrap();
    let found = found(&Glb::of(&mesh, None).unwrap());
    // The centre is off the middle by half a step of 32 bits at most, and coordinates around it by another.
    let step = f64::from(f32::EPSILON);
    let reach = 0.5 * hull.diagonal() + step * far.length();
    let worst = found.corners.iter().zip(corners(&mesh)).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
    assert!(worst <= step * reach, "{worst}");
    assert!(worst < 1e-6, "32 bits alone would be off by up to 0.25 here");
}

#[test]
fn every_corner_has_the_linear_colour_of_its_triangle() {
    let found = found(&Glb::of(&square(), Some(&[[255, 128, 0], [0, 255, 51]])).unwrap());
    // IEC 61966-2-1: 128/255 is 0.215861 of the light, 51/255 is 0.033105.
    let expected = [[1.0, 0.215_861, 0.0, 1.0], [0.0, 1.0, 0.033_105, 1.0]];
    // Half a step of 16 bits.
    let rounding = 0.5 / 65535.0 + 1e-6;
    assert_eq!(found.colours.len(), 6);
    for (corner, colour) in found.colours.iter().enumerate() {
        for (got, want) in colour.iter().zip(expected[corner / 3]) {
            assert!((got - want).abs() < rounding, "corner {corner}: {colour:?}");
        }
    }
}

#[test]
fn vertices_are_split_only_where_colours_differ() {
    let vertices = |colours: [[u8; 3]; 2]| found(&Glb::of(&square(), Some(&colours)).unwrap()).vertices;
    assert_eq!(vertices([[7; 3], [7; 3]]), 4);
    assert_eq!(vertices([[7; 3], [8; 3]]), 6);
}

#[test]
fn colours_of_another_mesh_are_refused() {
    assert!(matches!(Glb::of(&square(), Some(&[[0; 3]])), Err(Error::ShapeMismatch { got: 1, expected: 2, .. })));
}

#[test]
fn what_32_bits_cannot_hold_is_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.glb");
    for scale in [1e50, 1e-50] {
        let mesh = moved(&square(), |p| p * scale);
        let error = io::write(&path, &mesh, &Attributes::default(), &WriteOptions::default()).unwrap_err();
        assert_eq!((error.exit_code(), error.to_string().contains("write .ply")), (4, true), "{error}");
        assert!(!path.exists());
    }
}

#[test]
fn reading_glb_is_refused_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.glb");
    io::write(&path, &square(), &Attributes::default(), &WriteOptions::default()).unwrap();
    for name in ["a.glb", "-"] {
        let error = io::parse(&fs::read(&path).unwrap(), name, &ReadOptions::default()).unwrap_err();
        assert_eq!((error.exit_code(), error.to_string().contains("export the model as .ply")), (3, true), "{error}");
    }
}

#[test]
fn the_khronos_validator_finds_no_error_and_no_warning() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| -> PathBuf { folder.path().join(name) };
    let write = |name: &str, mesh: &TriMesh, colours: Option<&[[u8; 3]]>| {
        let attributes = Attributes { colours, ..Attributes::default() };
        io::write(&file(name), mesh, &attributes, &WriteOptions::default()).unwrap();
    };
    let far = DVec3::new(1e7 + 0.1, -3.3, 0.7);
    // One vertex less than 16 bits number, and as many as they would, were 65535 not the end of a strip.
    let fan = |vertices: u32| {
        let spoke = |i: u32| DVec3::new(f64::from(i), f64::from(i * i % 1024), f64::from(i % 7));
        let triangles = (2..vertices).map(|i| [0, i - 1, i]).collect();
        TriMesh::new((0..vertices).map(spoke).collect(), triangles).unwrap()
    };
    write("plain.glb", &square(), None);
    write("odd.glb", &TriMesh::new(square().positions().to_vec(), vec![[0, 1, 3]]).unwrap(), None);
    write("coloured.glb", &square(), Some(&[[1, 2, 3], [255, 0, 77]]));
    write("far.glb", &moved(&square(), |p| p / 7.0 + far), Some(&[[1, 2, 3], [255, 0, 77]]));
    write("narrow.glb", &fan(65_534), None);
    write("edge.glb", &fan(65_535), None);
    write("wide.glb", &fan(65_536), None);
    let outsight = |arguments: &[&str], output: &Path| {
        let small = ["--cameras", "18", "--resolution", "100", "-q", "-o"];
        Command::cargo_bin("outsight").unwrap().args(arguments).args(small).arg(output).assert().success();
    };
    outsight(&["measure", GEARBOX], &file("heat.glb"));
    outsight(&["simplify", GEARBOX, "-r", "0.02", "--hidden", "keep"], &file("small.glb"));

    let mut files: Vec<PathBuf> = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().path()).collect();
    files.sort();
    let reports = node::node("validate.mjs", &files.iter().map(PathBuf::as_path).collect::<Vec<_>>());
    let reports: Value = serde_json::from_str(&reports).unwrap();
    assert_eq!(reports.as_object().unwrap().len(), 9);
    for (name, report) in reports.as_object().unwrap() {
        assert_eq!((&report["errors"], &report["warnings"]), (&0.into(), &0.into()), "{name}: {report:#}");
    }
    assert_eq!(reports["heat.glb"]["triangles"], 133_276);
    assert_eq!((&reports["plain.glb"]["triangles"], &reports["wide.glb"]["vertices"]), (&2.into(), &65_536.into()));
}
