//! Write then read is the same mesh, in every format and compression; and every layout that a reader must know, each
//! built here, reads as the same cube.

#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

use std::path::Path;

use glam::DVec3;
use outsight::io::{self, Attributes, Dropped, Format, Loaded, ReadOptions, WriteOptions};
use outsight::mesh::TriMesh;

/// Corners of the unit cube, number 4x + 2y + z.
fn cube_corner(i: u32) -> [u32; 3] {
    [i >> 2, (i >> 1) & 1, i & 1]
}

/// Its sides, counter-clockwise from outside.
const SIDES: [[u32; 4]; 6] = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];

/// The sides along the diagonal from their first corner, as the readers cut squares.
fn cube_triangles() -> Vec<[u32; 3]> {
    SIDES.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
}

fn cube() -> TriMesh {
    let positions = (0..8).map(|i| DVec3::from(cube_corner(i).map(f64::from))).collect();
    TriMesh::new(positions, cube_triangles()).unwrap()
}

/// A cube whose coordinates no 32-bit number holds.
fn fine_cube() -> TriMesh {
    let (positions, triangles) = cube().into_parts();
    let moved = |p: DVec3| p / 3.0 + DVec3::new(0.1, -1e-9, 12_345.678_9);
    TriMesh::new(positions.into_iter().map(moved).collect(), triangles).unwrap()
}

fn parse(name: &str, bytes: &[u8]) -> Loaded {
    io::parse(bytes, name, &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn written(folder: &Path, name: &str, mesh: &TriMesh) -> Loaded {
    let path = folder.join(name);
    io::write(&path, mesh, &Attributes::default(), &WriteOptions::default()).unwrap();
    io::read(&path, &ReadOptions::default()).unwrap()
}

/// Corner positions of each triangle: what a format without indices keeps.
fn corners(mesh: &TriMesh) -> Vec<[DVec3; 3]> {
    mesh.triangles().iter().map(|t| t.map(|v| mesh.positions()[v as usize])).collect()
}

/// The bytes of a file are those of the cube, by whichever way.
fn assert_is_cube(loaded: &Loaded, dropped: &[Dropped]) {
    assert_eq!(corners(&loaded.mesh), corners(&cube()));
    assert_eq!(loaded.mesh.vertex_count(), 8);
    assert_eq!(loaded.dropped, dropped);
    assert_eq!(loaded.set_aside.count(), 0);
}

#[test]
fn formats_with_indices_give_the_same_mesh_back() {
    let folder = tempfile::tempdir().unwrap();
    for mesh in [cube(), fine_cube()] {
        let folder = tempfile::tempdir_in(folder.path()).unwrap();
        for name in ["a.ply", "a.obj", "a.off"] {
            for packed in [
                "",
                ".gz",
                #[cfg(feature = "zstd")]
                ".zst",
            ] {
                let loaded = written(folder.path(), &format!("{name}{packed}"), &mesh);
                assert_eq!(loaded.mesh, mesh, "{name}{packed}");
                assert_eq!((loaded.dropped.len(), loaded.set_aside.count(), loaded.welded), (0, 0, None));
            }
        }
    }
}

#[test]
fn stl_gives_back_corners_rounded_to_32_bits() {
    let folder = tempfile::tempdir().unwrap();
    for packed in ["", ".gz"] {
        let loaded = written(folder.path(), &format!("cube.stl{packed}"), &cube());
        assert_is_cube(&loaded, &[]);
        assert_eq!(loaded.welded, Some(36 - 8));
        let fine = written(folder.path(), &format!("fine.STL{packed}"), &fine_cube());
        let rounded = corners(&fine_cube()).into_iter().map(|t| t.map(|p| p.as_vec3().as_dvec3()));
        assert!(corners(&fine.mesh).into_iter().eq(rounded));
    }
}

#[test]
fn same_mesh_is_written_in_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.ply", "a.obj.gz", "a.stl", "a.off"] {
        let path = folder.path().join(name);
        let write = || {
            let options = WriteOptions { force: true, ..WriteOptions::default() };
            io::write(&path, &fine_cube(), &Attributes::default(), &options).unwrap();
            std::fs::read(&path).unwrap()
        };
        assert_eq!(write(), write());
    }
}

#[test]
fn visibility_and_colours_go_into_ply_alone() {
    let folder = tempfile::tempdir().unwrap();
    let visibility = [0.25; 12];
    let quality = [0.5; 8];
    let attributes =
        Attributes { visibility: Some(&visibility), colours: Some(&[[1, 2, 3]; 12]), vertex_quality: Some(&quality) };
    let path = folder.path().join("v.ply");
    io::write(&path, &cube(), &attributes, &WriteOptions::default()).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let header_end = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    assert_eq!(bytes.len(), header_end + 8 * (12 + 4) + 12 * (13 + 4 + 3));
    assert!(bytes.ends_with(&[0, 0, 0x80, 0x3e, 1, 2, 3]));
    assert_is_cube(&io::read(&path, &ReadOptions::default()).unwrap(), &[Dropped::Colours, Dropped::OtherProperties]);

    let refused = io::write(&folder.path().join("v.obj"), &cube(), &attributes, &WriteOptions::default());
    assert!(matches!(refused, Err(outsight::Error::Option { .. })));
    let short = Attributes { visibility: Some(&visibility[1..]), ..Attributes::default() };
    let refused = io::write(&path, &cube(), &short, &WriteOptions::default());
    assert!(matches!(refused, Err(outsight::Error::ShapeMismatch { got: 11, expected: 12, .. })));
    let short = Attributes { vertex_quality: Some(&quality[1..]), ..Attributes::default() };
    let refused = io::write(&path, &cube(), &short, &WriteOptions::default());
    assert!(matches!(refused, Err(outsight::Error::ShapeMismatch { got: 7, expected: 8, .. })));
}

/// Binary numbers of one byte order.
struct Bytes {
    big: bool,
    bytes: Vec<u8>,
}

impl Bytes {
    fn put(&mut self, little: &[u8]) {
        let from = self.bytes.len();
        self.bytes.extend_from_slice(little);
        if self.big {
            self.bytes[from..].reverse();
        }
    }
}

#[test]
fn binary_ply_of_both_byte_orders_with_quads_and_things_between() {
    for (big, order) in [(false, "little"), (true, "big")] {
        let header = format!(
            "ply\r\nformat binary_{order}_endian 1.0\r\ncomment made by hand\r\nobj_info none\r\n\
             element face 6\r\nproperty uint8 flags\r\nproperty list uint16 uint32 vertex_index\r\n\
             property list uchar float texcoord\r\nelement odd 2\r\nproperty list char double list\r\n\
             element vertex 8\r\nproperty short x\r\nproperty float nx\r\nproperty float64 y\r\nproperty int z\r\n\
             end_header\r\n"
        );
        let mut file = Bytes { big, bytes: header.into_bytes() };
        for side in SIDES {
            file.put(&[7]);
            file.put(&4_u16.to_le_bytes());
            side.iter().for_each(|v| file.put(&v.to_le_bytes()));
            file.put(&[2]);
            (0..2).for_each(|_| file.put(&0.5_f32.to_le_bytes()));
        }
        file.put(&[0]);
        file.put(&[1]);
        file.put(&1.0_f64.to_le_bytes());
        for [x, y, z] in (0..8).map(cube_corner) {
            file.put(&(x as i16).to_le_bytes());
            file.put(&1.0_f32.to_le_bytes());
            file.put(&f64::from(y).to_le_bytes());
            file.put(&(z as i32).to_le_bytes());
        }
        let dropped = [Dropped::Normals, Dropped::TextureCoordinates, Dropped::OtherProperties];
        assert_is_cube(&parse("a.ply", &file.bytes), &dropped);
    }
}

#[test]
fn ascii_ply_with_bit_named_types_texture_file_and_edges() {
    let mut file = "ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex 8\nproperty float32 x\n\
                    property float32 y\nproperty float32 z\nproperty float s\nproperty uint8 red\nelement face 12\n\
                    property list uint8 int32 vertex_indices\nelement edge 1\nproperty int vertex1\n\
                    property int vertex2\nend_header\n"
        .to_owned();
    for [x, y, z] in (0..8).map(cube_corner) {
        file += &format!("{x}.0 {y}e0  {z} 0.5 255 \n");
    }
    for [a, b, c] in cube_triangles() {
        file += &format!("3 {a} {b}\n {c}\n");
    }
    file += "0 1";
    let dropped = [Dropped::TextureCoordinates, Dropped::Colours, Dropped::Materials, Dropped::PointsAndLines];
    assert_is_cube(&parse("a.PLY", file.as_bytes()), &dropped);
}

#[test]
fn ascii_ply_with_more_in_a_line_than_its_header_names() {
    let file = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                element face 1\nproperty list uchar int vertex_indices\nproperty uchar red\nend_header\n\
                0 0 0\n1 0 0\n0 1 0\n3 0 1 2 9 1 1 1 1 1 1 1 1 1\n";
    let loaded = parse("a.ply", file.as_bytes());
    assert_eq!(loaded.mesh.triangles(), [[0, 1, 2]]);
    assert_eq!(loaded.dropped, [Dropped::Colours, Dropped::OtherProperties]);
}

#[test]
fn tristrips_turn_every_other_triangle_and_restart() {
    //  1---3---5
    //  | \ | \ |
    //  0---2---4        and the triangle 0 4 5 by itself
    let file = "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
                element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
                0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n10 0 1 2 3 4 5 -1 0 4 5\n";
    let loaded = parse("a.ply", file.as_bytes());
    assert_eq!(loaded.mesh.triangles(), [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5], [0, 4, 5]]);
}

#[test]
fn obj_with_everything_that_is_dropped() {
    let mut file = "# a cube\nmtllib no.mtl\no first\n".to_owned();
    for [x, y, z] in (0..8).map(cube_corner) {
        file += &format!("v {x} {y} {z} 1 0 0\n");
    }
    file += "vt 0 0\nvn 0 0 1\nusemtl red\ns 1\n";
    for [a, b, c, d] in &SIDES[..3] {
        file += &format!("f {}/1/1 {}//1 \\\r\n {}/1 {} # a side\n", a + 1, b + 1, c + 1, d + 1);
    }
    file += "g second\n";
    for side in &SIDES[3..] {
        let backwards = side.map(|v| i64::from(v) - 8);
        file += &format!("f {} {} {} {}\r\n", backwards[0], backwards[1], backwards[2], backwards[3]);
    }
    file += "l 1 2 3\nf 1 2\np 1\n";
    let dropped = [
        Dropped::Normals,
        Dropped::TextureCoordinates,
        Dropped::Colours,
        Dropped::Materials,
        Dropped::Parts,
        Dropped::PointsAndLines,
        Dropped::OtherProperties,
    ];
    assert_is_cube(&parse("a.obj", file.as_bytes()), &dropped);
}

#[test]
fn obj_of_one_part_and_with_vertices_last_is_the_bare_cube() {
    let mut file = "\u{feff}g cube\n".to_owned();
    for [a, b, c] in cube_triangles() {
        file += &format!("f {} {} {}\n", a + 1, b + 1, c + 1);
    }
    for [x, y, z] in (0..8).map(cube_corner) {
        file += &format!("v\t{x} {y}  {z}\n");
    }
    assert_is_cube(&parse("a.obj", file.as_bytes()), &[]);
}

#[test]
fn concave_polygon_of_66_corners_becomes_64_triangles_of_its_area() {
    // A saw: 32 teeth of area 1/2 on a bar of area 32.
    let mut file = "v 0 -1 0\nv 32 -1 0\nv 32 0 0\n".to_owned();
    for x in (0..32).rev() {
        file += &format!("v {}.5 1 0\nv {x} 0 0\n", x);
    }
    let count = 3 + 64;
    file += "f";
    (1..count).for_each(|i| file += &format!(" {i}"));
    let loaded = parse("saw.obj", file.as_bytes());
    assert_eq!(loaded.mesh.triangle_count(), 64);
    let doubled: Vec<f64> = corners(&loaded.mesh).iter().map(|[a, b, c]| (b - a).cross(c - a).z).collect();
    assert!(doubled.iter().all(|&a| a > 0.0));
    // The saw's 67th corner, (0, 0), is left out, so its area is taken from the corners themselves.
    assert!((doubled.iter().sum::<f64>() - 2.0 * shoelace(&loaded.mesh)).abs() < 1e-12);
}

/// Area of the polygon of all vertices, in their order, in the xy plane.
fn shoelace(mesh: &TriMesh) -> f64 {
    let ring = &mesh.positions()[..66];
    (0..66).map(|i| 0.5 * ring[i].truncate().perp_dot(ring[(i + 1) % 66].truncate())).sum()
}

#[test]
fn off_with_counts_beside_the_word_colours_and_comments() {
    let mut plain = "# made by hand\nOFF 8 6 12 # vertices, sides, edges\n\n".to_owned();
    let mut coloured = "STCNOFF\n8 6\n".to_owned();
    for [x, y, z] in (0..8).map(cube_corner) {
        plain += &format!("  {x} {y} {z}\r\n");
        coloured += &format!("{x} {y} {z}  0 0 1  0.5 0.5 0.5 1  0 0\n");
    }
    for [a, b, c, d] in SIDES {
        plain += &format!("4 {a} {b} {c} {d} # side\n\n");
        coloured += &format!("4 {a} {b} {c} {d} 255 0 0\n");
    }
    assert_is_cube(&parse("a.off", plain.as_bytes()), &[]);
    let dropped = [Dropped::Normals, Dropped::TextureCoordinates, Dropped::Colours];
    assert_is_cube(&parse("a.off", coloured.as_bytes()), &dropped);
    let bare = plain.replace("OFF ", "");
    assert_is_cube(&parse("a.off", bare.as_bytes()), &[]);
}

#[test]
fn ascii_stl_of_several_solids_in_odd_dress() {
    let mut file = "\n  SOLID facet vertex name\n".to_owned();
    for (i, corners) in corners(&cube()).iter().enumerate() {
        if i == 6 {
            file += "endsolid\nsolid\tsecond\n";
        }
        file += "FACET Normal nan 0 0 outer\n\tloop\r\n";
        corners.iter().for_each(|p| file += &format!("  vertex {:e} {} -0.0{}\n", p.x, p.y, p.z));
        file += "endloop endfacet\n";
    }
    file += "endsolid second\n\n";
    let loaded = parse("a.stl", file.replace("-0.01", "1").as_bytes());
    assert_is_cube(&loaded, &[Dropped::Parts]);
}

#[test]
fn binary_stl_that_begins_with_solid_and_has_colours() {
    let mut file = b"solid, says this binary header".to_vec();
    file.resize(80, b' ');
    file.extend(12_u32.to_le_bytes());
    for corners in corners(&cube()) {
        let numbers = [DVec3::ZERO, corners[0], corners[1], corners[2]].map(|p| p.as_vec3().to_array());
        numbers.iter().flatten().for_each(|c| file.extend(c.to_le_bytes()));
        file.extend([0x1f, 0x80]);
    }
    assert_is_cube(&parse("a.stl", &file), &[Dropped::Colours]);
}

#[test]
fn degenerate_triangles_are_set_aside_by_their_number_after_cutting() {
    // A square (triangles 0, 1), a repeated vertex (2), three vertices on a line (3), a good one (4).
    let file = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nf 1 2 3 4\nf 1 1 2\nf 1 2 5\nf 2 5 3\n";
    let loaded = parse("a.obj", file.as_bytes());
    assert_eq!(loaded.set_aside.repeated_vertex, [2]);
    assert_eq!(loaded.set_aside.zero_area, [3]);
    assert_eq!(loaded.mesh.triangles(), [[0, 1, 2], [0, 2, 3], [1, 4, 2]]);
}

#[test]
fn welding_is_done_on_request() {
    let file = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 -0.0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";
    assert_eq!(parse("a.obj", file.as_bytes()).welded, None);
    let options = ReadOptions { weld: true, ..ReadOptions::default() };
    let welded = io::parse(file.as_bytes(), "a.obj", &options).unwrap();
    assert_eq!((welded.welded, welded.mesh.triangles()), (Some(2), &[[0, 1, 2], [1, 3, 2]][..]));
}

#[test]
fn pipe_is_read_by_its_content() {
    let folder = tempfile::tempdir().unwrap();
    for format in Format::ALL.into_iter().filter(|&format| format != Format::Glb) {
        let path = folder.path().join(format!("a.{}", format.extension()));
        io::write(&path, &cube(), &Attributes::default(), &WriteOptions::default()).unwrap();
        let loaded = parse("-", &std::fs::read(&path).unwrap());
        assert_eq!(loaded.format, format);
        assert_is_cube(&loaded, &[]);
    }
}
