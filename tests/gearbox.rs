//! The bundled gearbox is what the generator makes, and a well-formed assembly.
#![cfg(feature = "zstd")]
#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::HashMap;
use std::ops::Range;
use std::sync::LazyLock;

use glam::DVec3;
use outsight::geom;
use outsight::mesh::TriMesh;
use outsight::mesh::shapes::{Assembly, gearbox};

static GEARBOX: LazyLock<Assembly> = LazyLock::new(|| gearbox(1.0));

/// Vertices and triangles of a PLY with three `f32` a vertex and three `i32` a triangle, as the generator writes it.
fn bundled() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/data/gearbox.ply.zst");
    let bytes = zstd::decode_all(std::fs::File::open(file).unwrap()).unwrap();
    let end = b"end_header\n";
    let start = bytes.windows(end.len()).position(|w| w == end).unwrap() + end.len();
    let header = std::str::from_utf8(&bytes[..start]).unwrap();
    let count = |element: &str| -> usize {
        let line = header.lines().find_map(|line| line.strip_prefix(element)).unwrap();
        line.trim().parse().unwrap()
    };
    let (positions, triangles) = bytes[start..].split_at(12 * count("element vertex "));
    assert_eq!(triangles.len(), 13 * count("element face "));
    let four = |b: &[u8]| <[u8; 4]>::try_from(b).unwrap();
    let coordinate = |b: &[u8], i: usize| f64::from(f32::from_le_bytes(four(&b[4 * i..4 * i + 4])));
    let index = |b: &[u8], i: usize| u32::from_le_bytes(four(&b[4 * i + 1..4 * i + 5]));
    let position = |b: &[u8]| DVec3::new(coordinate(b, 0), coordinate(b, 1), coordinate(b, 2));
    (
        positions.chunks_exact(12).map(position).collect(),
        triangles.chunks_exact(13).map(|b| [index(b, 0), index(b, 1), index(b, 2)]).collect(),
    )
}

/// Edges that do not lie in exactly two triangles of opposite direction.
fn unpaired_edges(triangles: &[[u32; 3]]) -> usize {
    let mut directions: HashMap<[u32; 2], [u32; 2]> = HashMap::new();
    for t in triangles {
        for i in 0..3 {
            let (a, b) = (t[i], t[(i + 1) % 3]);
            directions.entry([a.min(b), a.max(b)]).or_default()[usize::from(a > b)] += 1;
        }
    }
    directions.values().filter(|&&count| count != [1, 1]).count()
}

fn signed_volume(mesh: &TriMesh, triangles: Range<usize>) -> f64 {
    let corner = |v: u32| mesh.positions()[v as usize];
    let six_times = |&[a, b, c]: &[u32; 3]| corner(a).dot(corner(b).cross(corner(c)));
    mesh.triangles()[triangles].iter().map(six_times).sum::<f64>() / 6.0
}

#[test]
fn bundled_file_is_what_the_generator_makes() {
    let (positions, triangles) = bundled();
    let advice = "run `cargo run --release --example generate_gearbox` and look at the difference";
    assert!(positions == GEARBOX.mesh.positions(), "{advice}");
    assert!(triangles == GEARBOX.mesh.triangles(), "{advice}");
}

#[test]
fn gearbox_has_the_promised_size() {
    assert!((50_000..=150_000).contains(&GEARBOX.mesh.triangle_count()), "{}", GEARBOX.mesh.triangle_count());
}

#[test]
fn every_part_is_closed_and_faces_outward() {
    for (name, range) in &GEARBOX.parts {
        assert_eq!(unpaired_edges(&GEARBOX.mesh.triangles()[range.clone()]), 0, "{name}");
        assert!(signed_volume(&GEARBOX.mesh, range.clone()) > 0.0, "{name}");
    }
}

#[test]
fn no_triangle_of_the_gearbox_lacks_area() {
    let positions = GEARBOX.mesh.positions();
    for (i, t) in GEARBOX.mesh.triangles().iter().enumerate() {
        assert!(geom::triangle_area(t.map(|v| positions[v as usize])) > 0.0, "triangle {i}");
    }
}

#[test]
fn parts_cover_the_gearbox_in_order_under_different_names() {
    let mut end = 0;
    for (_, range) in &GEARBOX.parts {
        assert_eq!(range.start, end);
        end = range.end;
    }
    assert_eq!(end, GEARBOX.mesh.triangle_count());
    let mut names: Vec<&str> = GEARBOX.parts.iter().map(|(name, _)| name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), GEARBOX.parts.len());
}

#[test]
fn other_details_give_closed_gearboxes_too() {
    for detail in [0.5, 0.7, 1.5, 2.0] {
        let coarse = gearbox(detail);
        for (name, range) in &coarse.parts {
            assert_eq!(unpaired_edges(&coarse.mesh.triangles()[range.clone()]), 0, "{name} at detail {detail}");
        }
    }
}
