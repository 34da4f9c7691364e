//! Meshes written: binary PLY, STL and GLB, text OBJ and OFF.

use std::fmt;
use std::io::{self, Write};
use std::path::Path;

use glam::DVec3;

use super::atomic::write_atomic;
use super::format::{Compression, FileName, Format};
use super::glb::Glb;
use crate::error::{Error, Result};
use crate::geom;
use crate::mesh::{TriMesh, TriangleId};

/// How a mesh is written. `Default`: format by extension, nothing is replaced.
#[derive(Debug, Clone, Copy, Default)]
pub struct WriteOptions {
    /// Replace an existing file.
    pub force: bool,
    /// The format, where the extension does not say it (standard output).
    pub format: Option<Format>,
}

/// What is written beside the geometry of a mesh.
#[derive(Debug, Clone, Copy, Default)]
pub struct Attributes<'a> {
    /// Visibility per triangle (PLY property `visibility`, 32-bit).
    pub visibility: Option<&'a [f64]>,
    /// Colour per triangle, sRGB (PLY properties `red`, `green`, `blue`; GLB `COLOR_0`).
    pub colours: Option<&'a [[u8; 3]]>,
    /// Visibility per vertex (PLY property `quality`, 32-bit, the name under which MeshLab shows it).
    pub vertex_quality: Option<&'a [f64]>,
}

impl Attributes<'_> {
    fn check(&self, mesh: &TriMesh, format: Format) -> Result<()> {
        let (triangles, vertices) = (mesh.triangle_count(), mesh.vertex_count());
        let given = [
            ("visibility", self.visibility.map(<[f64]>::len), triangles),
            ("colours", self.colours.map(<[[u8; 3]]>::len), triangles),
            ("quality", self.vertex_quality.map(<[f64]>::len), vertices),
        ];
        for (what, got, expected) in given {
            match got {
                Some(got) if got != expected => return Err(Error::ShapeMismatch { what, got, expected }),
                Some(_) if format != Format::Ply && (format, what) != (Format::Glb, "colours") => {
                    let message = format!("{} files carry no {what}; write .ply", format.extension().to_uppercase());
                    return Err(Error::Option { name: "--output", message });
                }
                _ => {}
            }
        }
        Ok(())
    }
}

/// Writes a mesh, whole or not at all; `-` is standard output. `.gz` or `.zst` behind the extension compresses.
///
/// PLY is binary little-endian with 32-bit coordinates where they hold every one exactly, else 64-bit. OBJ and OFF are
/// text whose numbers read back as the same. STL is binary: it has no vertices in common and rounds coordinates to
/// 32 bits. GLB has 32-bit coordinates around a centre, see [`Glb`].
///
/// # Errors
/// [`Error::Write`], [`Error::ClosedPipe`]; [`Error::Option`] where the path names no format, or the format cannot
/// carry an attribute; [`Error::ShapeMismatch`] for attributes of another mesh; [`Error::Unavailable`] for `.zst`
/// without the feature `zstd`.
pub fn write(path: &Path, mesh: &TriMesh, attributes: &Attributes, options: &WriteOptions) -> Result<()> {
    let format = format_to_write(path, options.format)?;
    attributes.check(mesh, format)?;
    let force = options.force;
    match format {
        Format::Ply => write_encoded(path, force, |output| write_ply(output, mesh, attributes)),
        Format::Obj => write_encoded(path, force, |output| write_obj(output, mesh)),
        Format::Off => write_encoded(path, force, |output| write_off(output, mesh)),
        Format::Stl => {
            check_fits_f32(path, mesh)?;
            write_encoded(path, force, |output| write_stl(output, mesh))
        }
        Format::Glb => write_glb(path, &Glb::of(mesh, attributes.colours)?, force),
    }
}

/// The format that `path` is written in.
fn format_to_write(path: &Path, asked: Option<Format>) -> Result<Format> {
    let name = FileName::of(path);
    match (asked, name.format) {
        (Some(asked), Some(named)) if asked != named => Err(Error::Option {
            name: "--output",
            message: format!("{} is not the extension of {} files", name.shown, asked.extension().to_uppercase()),
        }),
        (Some(format), _) | (None, Some(format)) => Ok(format),
        (None, None) => Err(Error::Option {
            name: "--output",
            message: format!("{} names no mesh format; write to .ply, .obj, .stl, .off or .glb", name.shown),
        }),
    }
}

/// [`write_atomic`], compressed if the extension says so.
pub(super) fn write_encoded(
    path: &Path,
    force: bool,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<()> {
    match FileName::of(path).compression {
        None => write_atomic(path, force, write),
        Some(Compression::Gzip) => write_atomic(path, force, |output| {
            let mut packer = flate2::write::GzEncoder::new(output, flate2::Compression::default());
            write(&mut packer)?;
            packer.finish().map(drop)
        }),
        Some(Compression::Zstd) => write_zstd(path, force, write),
    }
}

#[cfg(feature = "zstd")]
fn write_zstd(path: &Path, force: bool, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    /// The library's own default; level 19 is ten times slower for a few per cent.
    const LEVEL: i32 = 3;
    write_atomic(path, force, |output| {
        let mut packer = zstd::stream::write::Encoder::new(output, LEVEL)?;
        packer.include_checksum(true)?;
        write(&mut packer)?;
        packer.finish().map(drop)
    })
}

#[cfg(not(feature = "zstd"))]
fn write_zstd(path: &Path, _force: bool, _write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    let path = path.display();
    Err(Error::Unavailable { message: format!("{path}: built without the `zstd` feature; write .gz instead") })
}

fn write_ply(output: &mut dyn Write, mesh: &TriMesh, attributes: &Attributes) -> io::Result<()> {
    let is_exact_in_f32 = |p: &DVec3| p.to_array().iter().all(|&c| f64::from(c as f32).to_bits() == c.to_bits());
    let narrow = mesh.positions().iter().all(is_exact_in_f32);
    write_ply_header(output, mesh, narrow, attributes)?;
    for (i, p) in mesh.positions().iter().enumerate() {
        if narrow {
            output.write_all(bytemuck::bytes_of(&p.as_vec3().to_array().map(|c| c.to_le_bytes())))?;
        } else {
            output.write_all(bytemuck::bytes_of(&p.to_array().map(f64::to_le_bytes)))?;
        }
        if let Some(quality) = attributes.vertex_quality {
            output.write_all(&(quality[i] as f32).to_le_bytes())?;
        }
    }
    for (i, triangle) in mesh.triangles().iter().enumerate() {
        output.write_all(&[3])?;
        output.write_all(bytemuck::bytes_of(&triangle.map(u32::to_le_bytes)))?;
        if let Some(visibility) = attributes.visibility {
            output.write_all(&(visibility[i] as f32).to_le_bytes())?;
        }
        if let Some(colours) = attributes.colours {
            output.write_all(&colours[i])?;
        }
    }
    Ok(())
}

fn write_ply_header(output: &mut dyn Write, mesh: &TriMesh, narrow: bool, attributes: &Attributes) -> io::Result<()> {
    let real = if narrow { "float" } else { "double" };
    // A vertex number past 2³¹ would be negative as `int`, which is what all programs read.
    let index = if mesh.vertex_count() <= i32::MAX as usize { "int" } else { "uint" };
    writeln!(output, "ply\nformat binary_little_endian 1.0\ncomment written by Outsight")?;
    writeln!(output, "element vertex {}", mesh.vertex_count())?;
    writeln!(output, "property {real} x\nproperty {real} y\nproperty {real} z")?;
    if attributes.vertex_quality.is_some() {
        writeln!(output, "property float quality")?;
    }
    writeln!(output, "element face {}\nproperty list uchar {index} vertex_indices", mesh.triangle_count())?;
    if attributes.visibility.is_some() {
        writeln!(output, "property float visibility")?;
    }
    if attributes.colours.is_some() {
        writeln!(output, "property uchar red\nproperty uchar green\nproperty uchar blue")?;
    }
    writeln!(output, "end_header")
}

fn write_obj(output: &mut dyn Write, mesh: &TriMesh) -> io::Result<()> {
    for p in mesh.positions() {
        writeln!(output, "v {} {} {}", Shortest(p.x), Shortest(p.y), Shortest(p.z))?;
    }
    for [a, b, c] in mesh.triangles().iter().map(|t| t.map(|v| u64::from(v) + 1)) {
        writeln!(output, "f {a} {b} {c}")?;
    }
    Ok(())
}

fn write_off(output: &mut dyn Write, mesh: &TriMesh) -> io::Result<()> {
    writeln!(output, "OFF\n{} {} 0", mesh.vertex_count(), mesh.triangle_count())?;
    for p in mesh.positions() {
        writeln!(output, "{} {} {}", Shortest(p.x), Shortest(p.y), Shortest(p.z))?;
    }
    for [a, b, c] in mesh.triangles() {
        writeln!(output, "3 {a} {b} {c}")?;
    }
    Ok(())
}

fn write_glb(path: &Path, glb: &Glb, force: bool) -> Result<()> {
    if glb.fits() {
        return write_encoded(path, force, |output| glb.write(output));
    }
    let message = "the mesh is too large or too small for the 32-bit numbers of GLB; write .ply".to_owned();
    Err(Error::Write { path: path.to_owned(), message })
}

fn write_stl(output: &mut dyn Write, mesh: &TriMesh) -> io::Result<()> {
    // The text must not begin with `solid`, which some readers take for ASCII.
    let mut header = [b' '; 80];
    header[..19].copy_from_slice(b"written by Outsight");
    output.write_all(&header)?;
    output.write_all(&(mesh.triangle_count() as u32).to_le_bytes())?;
    for triangle in 0..mesh.triangle_count() as u32 {
        let corners = mesh.corners(TriangleId(triangle));
        let normal = geom::triangle_normal(corners).unwrap_or(DVec3::ZERO);
        for vector in [normal, corners[0], corners[1], corners[2]] {
            output.write_all(bytemuck::bytes_of(&vector.as_vec3().to_array().map(f32::to_le_bytes)))?;
        }
        output.write_all(&[0, 0])?;
    }
    Ok(())
}

/// Below this the digits of 32-bit numbers run out.
pub(super) const SMALLEST_IN_F32: f64 = 1e-30;

fn check_fits_f32(path: &Path, mesh: &TriMesh) -> Result<()> {
    let largest = mesh.positions().iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    if largest < SMALLEST_IN_F32 {
        let message = format!("a mesh within {largest:e} of 0 vanishes in the 32-bit numbers of STL; write .ply");
        return Err(Error::Write { path: path.to_owned(), message });
    }
    let too_large = |p: &&DVec3| !p.as_vec3().is_finite();
    match mesh.positions().iter().find(too_large) {
        None => Ok(()),
        Some(p) => Err(Error::Write {
            path: path.to_owned(),
            message: format!(
                "a vertex at {:e}, {:e}, {:e} is beyond the 32-bit numbers of STL; write .ply",
                p.x, p.y, p.z
            ),
        }),
    }
}

/// A number in the fewest digits that read back as the same number.
pub(super) struct Shortest(pub(super) f64);

impl fmt::Display for Shortest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        // `{}` never uses an exponent and would write 1e-300 with all its zeros.
        if size == 0.0 || (1e-5..1e16).contains(&size) || !size.is_finite() {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_exact() {
        let numbers = [0.1, -0.0, 1.0, 123_456.789, 1e-300, -2.5e-7, 1.797e308, 1.0 / 3.0, 1e16];
        let shown = numbers.map(|n| Shortest(n).to_string());
        assert_eq!(shown[..6], ["0.1", "-0", "1", "123456.789", "1e-300", "-2.5e-7"]);
        for (n, text) in numbers.iter().zip(&shown) {
            assert_eq!(text.parse::<f64>().map(f64::to_bits), Ok(n.to_bits()));
        }
    }
}
