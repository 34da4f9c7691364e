//! Writes the bundled model, `data/gearbox.ply.zst`, and `data/gearbox.parts.tsv` with the triangles of its parts.
//!
//! `cargo run --release --example generate_gearbox [FOLDER]`; the same bytes on every machine.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::{env, fs, io};

use outsight::mesh::TriMesh;
use outsight::mesh::shapes::gearbox;

/// Level of zstd beyond which the file hardly shrinks.
const ZSTD_LEVEL: i32 = 19;

fn main() -> io::Result<()> {
    let folder = env::args_os().nth(1).map_or_else(|| PathBuf::from("data"), PathBuf::from);
    let assembly = gearbox(1.0);
    let compressed = zstd::encode_all(&ply(&assembly.mesh)[..], ZSTD_LEVEL)?;
    fs::write(folder.join("gearbox.ply.zst"), compressed)?;
    let mut parts = String::from("part\tfirst_triangle\ttriangles\n");
    for (name, range) in &assembly.parts {
        writeln!(parts, "{name}\t{}\t{}", range.start, range.len()).map_err(io::Error::other)?;
    }
    fs::write(folder.join("gearbox.parts.tsv"), parts)
}

/// Binary little-endian PLY with `f32` coordinates, which hold the gearbox exactly.
fn ply(mesh: &TriMesh) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.vertex_count(),
        mesh.triangle_count()
    )
    .into_bytes();
    for p in mesh.positions() {
        p.as_vec3().to_array().iter().for_each(|c| bytes.extend(c.to_le_bytes()));
    }
    for t in mesh.triangles() {
        bytes.push(3);
        t.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    }
    bytes
}
