//! Truncated, lying and garbage files: each ends in an error that names the file and what is wrong with it, or in a
//! valid mesh; never in a panic, a long wait or a large allocation.

#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

use std::time::{Duration, Instant};

use outsight::io::{self, Loaded, ReadOptions};
use outsight::{Error, Result};
use proptest::prelude::*;

fn parse(name: &str, bytes: &[u8]) -> Result<Loaded> {
    io::parse(bytes, name, &ReadOptions::default())
}

/// A small good file of each kind.
fn good_files() -> Vec<(&'static str, Vec<u8>)> {
    let ascii = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                 property list uchar int extra\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n\
                 0 0 0 0\n1 0 0 1 9\n1 1 0 0\n0 1 0 0\n3 0 1 2\n4 0 1 2 3\n";
    let strips = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                  element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
                  0 0 0\n1 0 0\n1 1 0\n0 1 0\n7 0 1 2 -1 1 2 3\n";
    let obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\ng a\nf 1/1 2/1 3/1\ng b\nf -4 -3 -2 \\\n-1\n";
    let off = "COFF\n4 2 0\n0 0 0 1 0 0\n1 0 0 1 0 0\n1 1 0 1 0 0\n0 1 0 1 0 0\n3 0 1 2\n4 0 1 2 3 255 0 0\n";
    let stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\n\
               endsolid a\n";
    vec![
        ("a.ply", ascii.into()),
        ("b.ply", strips.into()),
        ("c.ply", binary_ply("little", 4, 2, |n| n)),
        ("d.ply", binary_ply("big", 4, 2, |n| n.iter().rev().copied().collect())),
        ("a.obj", obj.into()),
        ("a.off", off.into()),
        ("a.stl", stl.into()),
        ("b.stl", binary_stl(2, 2)),
    ]
}

/// A square of two triangles whose header promises so many vertices and triangles.
fn binary_ply(order: &str, vertices: u64, triangles: u64, in_order: impl Fn(Vec<u8>) -> Vec<u8>) -> Vec<u8> {
    let mut file = format!(
        "ply\nformat binary_{order}_endian 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\n\
         property float z\nelement face {triangles}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    .into_bytes();
    for c in [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0] {
        file.extend(in_order(f32::to_le_bytes(c).to_vec()));
    }
    for triangle in [[0, 1, 2], [0, 2, 3]] {
        file.push(3);
        triangle.iter().for_each(|&v| file.extend(in_order(i32::to_le_bytes(v).to_vec())));
    }
    file
}

fn binary_stl(promised: u32, written: usize) -> Vec<u8> {
    let mut file = vec![b' '; 80];
    file.extend(promised.to_le_bytes());
    for i in 0..written {
        let mut triangle = [0; 50];
        triangle[24..28].copy_from_slice(&1.0_f32.to_le_bytes());
        triangle[40..44].copy_from_slice(&(1.0 + i as f32).to_le_bytes());
        file.extend(triangle);
    }
    file
}

fn is_input_error(error: &Error) -> bool {
    matches!(error, Error::Parse { .. } | Error::Mesh { .. })
}

#[test]
fn good_files_are_good() {
    for (name, file) in good_files() {
        let loaded = parse(name, &file).unwrap_or_else(|e| panic!("{e}"));
        assert!(loaded.mesh.triangle_count() > 0);
    }
}

#[test]
fn file_cut_at_any_byte_is_an_error_or_a_smaller_mesh() {
    for (name, file) in good_files() {
        let whole = parse(name, &file).unwrap().mesh.triangle_count();
        for end in 0..file.len() {
            match parse(name, &file[..end]) {
                Ok(loaded) => assert!(loaded.mesh.triangle_count() <= whole),
                Err(error) => assert!(is_input_error(&error) && error.to_string().starts_with(name), "{error}"),
            }
        }
    }
}

/// Formats that say how much there is notice when something is missing, but for blanks and the last word's end.
#[test]
fn file_cut_short_is_noticed_where_the_format_has_counts() {
    for (name, file) in good_files().into_iter().filter(|(name, _)| !name.ends_with("obj")) {
        let binary = name == "b.stl" || name == "c.ply" || name == "d.ply";
        let needed = if binary { file.len() } else { file.len() - 20 };
        for end in 0..needed {
            assert!(parse(name, &file[..end]).is_err(), "{name} cut at {end} of {}", file.len());
        }
    }
}

#[test]
fn messages_say_what_where_and_what_next() {
    let ply = |vertices: &str, faces: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             element face 1\nproperty list uchar int vertex_indices\nend_header\n{vertices}{faces}"
        )
        .into_bytes()
    };
    let triangle = "0 0 0\n1 0 0\n0 1 0\n";
    let cases: Vec<(&str, Vec<u8>, &str)> = vec![
        // Nothing at all, and points without triangles.
        ("a.ply", b"".into(), "a.ply: no data; is the file empty?"),
        ("a.stl", b"".into(), "a.stl: no data; is the file empty?"),
        ("a.off", b"".into(), "a.off: no data; is the file empty?"),
        ("a.obj", b"".into(), "a.obj: no vertices and no triangles; is the file empty?"),
        ("-", b"".into(), "-: no data; is the file empty?"),
        (
            "a.obj",
            b"v 0 0 0\nv 1 1 1\n".into(),
            "a.obj: 2 vertices but no triangles; a point cloud must be meshed first",
        ),
        (
            "a.off",
            b"OFF\n1 0 0\n0 0 0\n".into(),
            "a.off: 1 vertices but no triangles; a point cloud must be meshed first",
        ),
        ("a.stl", binary_stl(0, 0), "a.stl: no vertices and no triangles; is the file empty?"),
        ("a.stl", b"solid a\nendsolid a".into(), "a.stl: no vertices and no triangles; is the file empty?"),
        (
            "a.obj",
            b"v 0 0 0\nf 1 1 1\n".into(),
            "a.obj: all 1 triangles have zero area or repeat a vertex; nothing is left to look at",
        ),
        // Another format than the name says, or none.
        (
            "a.stl",
            ply(triangle, "3 0 1 2\n"),
            "a.stl: the extension says STL, but the content looks like PLY; rename it to .ply",
        ),
        (
            "a.ply",
            b"OFF\n3 1 0\n".into(),
            "a.ply: the extension says PLY, but the content looks like OFF; rename it to .off",
        ),
        ("a.off", binary_stl(2, 2), "a.off: the extension says OFF, but the content looks like STL; rename it to .stl"),
        ("a.ply", b"\x7fELF".into(), "a.ply, line 1: a PLY file begins with `ply`, found `\\x7fELF`"),
        (
            "-",
            b"\x7fELF".into(),
            "-: this looks like none of PLY, OBJ, STL and OFF; name the format with --input-format",
        ),
        ("a.obj", b"\x7fELF\0".into(), "a.obj, line 1: this is no text; name the format, or convert the file to PLY"),
        // Counts that lie.
        ("a.ply", binary_ply("little", 4, 3, |n| n), "the header promises 3 triangles, the file ends after 2 (byte "),
        (
            "a.ply",
            binary_ply("little", 4, u64::MAX >> 1, |n| n),
            "the header promises 9223372036854775807 triangles, the file ends after 2 (byte ",
        ),
        (
            "a.ply",
            binary_ply("little", 1 << 40, 2, |n| n),
            "the header promises 1099511627776 vertices, the file ends after 6 (byte ",
        ),
        ("a.ply", binary_ply("little", 4, 1, |n| n), "the file goes on behind all that the header promises"),
        ("a.ply", ply(triangle, "3 0 1 2\n3 0 1 2\n"), "the file goes on behind all that the header promises"),
        ("a.ply", ply(triangle, "3 0 1\n"), "the header promises 1 triangles, the file ends after 0 (byte "),
        ("a.ply", ply(triangle, "-3 0 1 2\n"), "a.ply, line 13: a list cannot have -3 items"),
        (
            "a.ply",
            ply("0 0 0\n1 0\n0 1 0\n", "3 0 1 2\n"),
            "a.ply, line 12: the row that began in line 11 ends before `1`",
        ),
        (
            "a.off",
            b"OFF\n99999999999 1 0\n0 0 0\n".into(),
            "a.off: the header promises 99999999999 vertices, the file ends after 1 (line 3, byte ",
        ),
        (
            "a.off",
            b"OFF\n1 0 0\n0 0 0\n1 1 1\n".into(),
            "a.off, line 4: the file goes on behind all that its header promises; its counts are wrong",
        ),
        ("a.off", b"OFF\n-1 0 0\n".into(), "a.off, line 2: expected a count, found `-1`"),
        (
            "a.stl",
            binary_stl(3, 2),
            "a.stl: the header promises 3 triangles (234 bytes), the file ends after 2 (byte 184); is it truncated?",
        ),
        (
            "a.stl",
            binary_stl(u32::MAX, 2),
            "a.stl: the header promises 4294967295 triangles (214748364834 bytes), the file ends after 2 (byte 184); is it truncated?",
        ),
        (
            "a.stl",
            binary_stl(1, 2),
            "a.stl: the header promises 1 triangles (134 bytes), the file has 184 bytes; its count is wrong",
        ),
        (
            "a.stl",
            b"solid a\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex".into(),
            "a.stl: the file ends within a solid, after 0 triangles (byte 57); is it truncated?",
        ),
        // Indices out of range.
        (
            "a.ply",
            ply(triangle, "3 0 1 3\n"),
            "a.ply, line 13: triangle 0 uses vertex 3, but the file has 3 vertices (counted from 0)",
        ),
        (
            "a.ply",
            ply(triangle, "3 0 1 -1\n"),
            "a.ply, line 13: triangle 0 uses vertex -1, but the file has 3 vertices (counted from 0)",
        ),
        (
            "a.ply",
            ply(triangle, "3 0 1 99999999999999999999\n"),
            "a.ply, line 13: expected a whole number, found `99999999999999999999`",
        ),
        (
            "a.obj",
            b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9001\nv 1 1 1\n".into(),
            "a.obj, line 4: triangle uses vertex 9001, but the file has 4 vertices",
        ),
        (
            "a.obj",
            b"v 0 0 0\nf 1 -2 1\n".into(),
            "a.obj, line 2: triangle uses vertex -2, but the file has 1 vertices up to this line",
        ),
        ("a.obj", b"v 0 0 0\nf 0 1 1\n".into(), "a.obj, line 2: vertex 0 is used, but OBJ counts from 1"),
        ("a.obj", b"v 0 0 0\nf 1 2 9999999999\n".into(), "a.obj, line 2: triangle uses vertex 9999999999"),
        (
            "a.obj",
            b"v 0 0 0\nf 1 -9223372036854775808 1\n".into(),
            "a.obj, line 2: triangle uses vertex -9223372036854775808",
        ),
        (
            "a.off",
            b"OFF\n1 1 0\n0 0 0\n3 0 1 -7\n".into(),
            "a.off, line 4: triangle 0 uses vertex 1, but the file has 1 vertices (counted from 0)",
        ),
        ("a.off", b"OFF\n1 1 0\n0 0 0\n3 0 0\n".into(), "a.off, line 4: triangle 0 has 2 corners of 3"),
        // Numbers that are none.
        ("a.obj", b"v 0 nan 0\n".into(), "a.obj, line 1: the coordinate `nan` is not finite"),
        ("a.obj", b"v 0 1e999 0\n".into(), "a.obj, line 1: the coordinate `1e999` is not finite"),
        ("a.obj", b"v 0,5 1 0\n".into(), "a.obj, line 1: expected a coordinate, found `0,5`"),
        ("a.obj", b"v 0 1\n".into(), "a.obj, line 1: a vertex needs three coordinates"),
        ("a.off", b"OFF\n1 1 0\n0 inf 0\n3 0 0 0\n".into(), "a.off, line 3: the coordinate `inf` is not finite"),
        ("a.ply", ply("0 0 0\n1 NaN 0\n0 1 0\n", "3 0 1 2\n"), "a.ply, line 11: the coordinate `NaN` is not finite"),
        // Headers.
        (
            "a.ply",
            b"ply\nformat ascii 1.0\nelement vertex 1\n".into(),
            "a.ply: the header has no `end_header`, the file ends at byte 38; is it truncated?",
        ),
        ("a.ply", b"ply\nend_header\n".into(), "a.ply, line 2: the header has no line `format "),
        (
            "a.ply",
            b"ply\nformat ascii 1.0\nproperty float x\n".into(),
            "a.ply, line 3: a property stands before the first element",
        ),
        (
            "a.ply",
            b"ply\nformat ascii 1.0\nelement face 1\nproperty half x\n".into(),
            "a.ply, line 4: `half` is no PLY type",
        ),
        (
            "a.ply",
            b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n".into(),
            "a.ply: the header gives vertices no property y",
        ),
        (
            "a.off",
            b"4OFF\n1 1 1\n".into(),
            "a.off, line 1: `4OFF` is a kind of OFF that Outsight does not read; convert it to PLY",
        ),
        (
            "a.off",
            b"OFF BINARY\n\0\0".into(),
            "a.off, line 1: this is a binary OFF file, which Outsight does not read; convert it to PLY",
        ),
    ];
    for (name, file, message) in cases {
        let error = parse(name, &file).unwrap_err();
        assert!(is_input_error(&error), "{error}");
        assert_eq!(error.exit_code(), 3);
        assert!(error.to_string().contains(message), "{name}: {error}\nexpected {message}");
    }
}

#[test]
fn not_a_number_in_binary_files_names_its_vertex() {
    let mut ply = binary_ply("little", 4, 2, |n| n);
    let numbers = ply.len() - 2 * 13 - 4 * 12;
    ply[numbers + 12..numbers + 16].copy_from_slice(&f32::NAN.to_le_bytes());
    let error = parse("a.ply", &ply).unwrap_err().to_string();
    assert_eq!(error, "a.ply: vertex 1 is at (NaN, 0, 0); coordinates must be finite and at most 1e100");
    let mut stl = binary_stl(2, 2);
    stl[96..100].copy_from_slice(&f32::INFINITY.to_le_bytes());
    assert!(parse("a.stl", &stl).unwrap_err().to_string().starts_with("a.stl: vertex 0 is at (inf, 0, 0)"));
}

#[test]
fn paths_that_are_no_mesh_files_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let read = |path: &std::path::Path| io::read(path, &ReadOptions::default()).unwrap_err();
    let missing = read(&folder.path().join("no.ply"));
    assert!(matches!(missing, Error::Read { .. }) && missing.exit_code() == 3);
    let directory = folder.path().join("dir.ply");
    std::fs::create_dir(&directory).unwrap();
    assert!(matches!(read(&directory), Error::Read { .. }));
    let other = read(&folder.path().join("mesh.docx"));
    assert!(other.to_string().contains("the extension names no mesh format"), "{other}");
}

#[test]
fn memory_limit_is_kept() {
    let (name, file) = &good_files()[2];
    let limited = |limit| io::parse(file, name, &ReadOptions { memory_limit: Some(limit), ..ReadOptions::default() });
    assert!(matches!(limited(100), Err(Error::Limit { .. })));
    assert!(limited(100_000).is_ok());
}

/// Each of these once cost, or could cost, time or memory beyond its size.
#[test]
fn costly_files_end_within_a_second() {
    let header = "ply\nformat ascii 1.0\n";
    let empty_rows = format!("{header}element a {}\nend_header\n", i64::MAX);
    let many_elements: String = (0..100_000).map(|i| format!("element a{i} 0\n")).collect();
    let long_list = "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\n\
                     property float z\nelement face 9\nproperty list uint int vertex_indices\nend_header\n\u{1}\u{1}\u{1}\u{1}";
    let many_corners = format!("v 0 0 0\nf{}\n", " 1".repeat(200_000));
    let files = [
        ("a.ply", empty_rows.into_bytes()),
        ("b.ply", format!("{header}{many_elements}end_header\n").into_bytes()),
        ("c.ply", long_list.into()),
        ("d.ply", [b"ply\n", &vec![b'x'; 10_000_000][..]].concat()),
        ("a.obj", many_corners.into_bytes()),
        ("b.obj", "\\\n".repeat(1_000_000).into_bytes()),
        ("c.obj", vec![b'/'; 10_000_000]),
        ("a.off", [b"OFF\n".to_vec(), vec![b'9'; 10_000_000]].concat()),
        ("a.stl", [b"solid ".to_vec(), vec![b' '; 10_000_000]].concat()),
    ];
    for (name, file) in files {
        let start = Instant::now();
        let error = parse(name, &file).unwrap_err();
        assert!(is_input_error(&error) && error.to_string().len() < 300, "{name}: {error}");
        assert!(start.elapsed() < Duration::from_secs(1), "{name}: {:?}", start.elapsed());
    }
}

#[test]
fn polygon_of_many_corners_is_cut_within_a_second() {
    // A comb of 19,998 corners with every second one on a straight line, the worst that the limit lets through.
    let teeth = 9_998;
    let mut file = format!("v 0 -1 0\nv {teeth} -1 0\n");
    (0..teeth).rev().for_each(|x| file += &format!("v {x}.5 1 0\nv {x} 0 0\n"));
    file += "f";
    (1..=2 * teeth + 2).for_each(|i| file += &format!(" {i}"));
    let start = Instant::now();
    let loaded = parse("comb.obj", file.as_bytes()).unwrap();
    assert!(loaded.mesh.triangle_count() > teeth);
    assert!(start.elapsed() < Duration::from_secs(1), "{:?}", start.elapsed());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever a few changed bytes do, the answer is a valid mesh or an error of the input.
    #[test]
    fn changed_bytes_never_panic(which in 0_usize..8, changes in prop::collection::vec((any::<usize>(), any::<u8>()), 1..5)) {
        let (name, mut file) = good_files().swap_remove(which);
        let length = file.len();
        changes.iter().for_each(|&(at, byte)| file[at % length] = byte);
        match parse(name, &file) {
            Ok(loaded) => prop_assert!(loaded.mesh.triangle_count() > 0),
            Err(error) => prop_assert!(is_input_error(&error)),
        }
    }

    /// Random bytes and random words under every name.
    #[test]
    fn garbage_never_panics(bytes in prop::collection::vec(any::<u8>(), 0..300), words in "(ply|v|f|OFF|solid|facet|-?[0-9]{1,3}|/|\n| ){0,60}") {
        for name in ["a.ply", "a.obj", "a.stl", "a.off", "-"] {
            for file in [&bytes[..], words.as_bytes(), &[b"OFF\n3 1 0\n", words.as_bytes()].concat()] {
                if let Err(error) = parse(name, file) {
                    prop_assert!(is_input_error(&error));
                }
            }
        }
    }
}
