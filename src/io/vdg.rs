use std::io::{self, Write};
use std::path::Path;

use super::encode::write_encoded;
use super::fault::Fault;
use super::format::FileName;
use super::source;
use crate::error::{Error, Result};

/// First bytes of a diagram file.
const MAGIC: &[u8; 4] = b"VDG1";
/// Flag: the file holds a bit per triangle and camera.
const BITS: u32 = 1;
/// Flag: the file holds a byte per triangle and camera, behind the bits if it holds both.
const FRACTIONS: u32 = 2;
/// Bytes of a camera: direction and solid angle.
const CAMERA_BYTES: usize = 16;

/// A visibility diagram as plain rows: which camera sees which triangle of a file.
///
/// A file begins with `VDG1`, the number of rows T and of cameras N (u32 each), and for each camera its direction and solid
/// angle (4 × f32). Then come flags (u32; 1: bits, 2: fractions), T rows of bits, and T rows of one byte per camera where
/// there are fractions; every row is padded to 8 bytes, camera v is bit v % 8 of byte v / 8. All numbers are little-endian.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagram {
    /// For each camera the unit vector toward it (x, y, z), and the solid angle it stands for; the angles add up to 4π.
    pub cameras: Vec<[f32; 4]>,
    /// Number of rows.
    pub triangles: usize,
    /// Row after row of whole words; camera v is bit v % 64 of word v / 64.
    pub words: Vec<u64>,
    /// Row after row, a byte per camera: the visible share of the triangle's image, 255 is all of it; 0 where the bit is 0.
    pub fractions: Option<Vec<u8>>,
}

impl Diagram {
    /// Whether a camera sees a triangle.
    ///
    /// # Panics
    /// If the diagram has no such row or column.
    #[must_use]
    pub fn sees(&self, triangle: usize, camera: usize) -> bool {
        sees(self.row(triangle), camera)
    }

    fn row(&self, triangle: usize) -> &[u64] {
        let width = self.cameras.len().div_ceil(64);
        &self.words[triangle * width..][..width]
    }

    fn fractions_row(&self, triangle: usize) -> Option<&[u8]> {
        let width = self.cameras.len();
        self.fractions.as_ref().map(|all| &all[triangle * width..][..width])
    }

    fn check(&self) -> Result<()> {
        let check = |what, got, expected| {
            if got == expected { Ok(()) } else { Err(Error::ShapeMismatch { what, got, expected }) }
        };
        check("words", self.words.len(), self.triangles * self.cameras.len().div_ceil(64))?;
        let fractions = self.fractions.as_ref().map(Vec::len);
        fractions.map_or(Ok(()), |got| check("fractions", got, self.triangles * self.cameras.len()))
    }
}

fn sees(row: &[u64], camera: usize) -> bool {
    row[camera / 64] >> (camera % 64) & 1 == 1
}

/// Writes a diagram file; `.zst` or `.gz` behind the name compresses.
///
/// # Errors
/// As [`super::write_atomic`]; [`Error::ShapeMismatch`] for rows of another size; [`Error::Unavailable`] for `.zst` without
/// the feature `zstd`.
pub fn write_vdg(path: &Path, diagram: &Diagram, force: bool) -> Result<()> {
    diagram.check()?;
    write_encoded(path, force, |output| {
        output.write_all(MAGIC)?;
        // A mesh has fewer than 2³¹ triangles, and cameras are thousands at most.
        output.write_all(&(diagram.triangles as u32).to_le_bytes())?;
        output.write_all(&(diagram.cameras.len() as u32).to_le_bytes())?;
        for number in diagram.cameras.iter().flatten() {
            output.write_all(&number.to_le_bytes())?;
        }
        let flags = if diagram.fractions.is_some() { BITS | FRACTIONS } else { BITS };
        output.write_all(&flags.to_le_bytes())?;
        for word in &diagram.words {
            output.write_all(&word.to_le_bytes())?;
        }
        write_fractions(output, diagram)
    })
}

fn write_fractions(output: &mut dyn Write, diagram: &Diagram) -> io::Result<()> {
    let width = diagram.cameras.len();
    let padding = &[0; 8][..width.next_multiple_of(8) - width];
    for row in (0..diagram.triangles).filter_map(|t| diagram.fractions_row(t)) {
        output.write_all(row)?;
        output.write_all(padding)?;
    }
    Ok(())
}

/// Writes a diagram as a NumPy array of T rows and N columns: `bool`, or `uint8` where it has fractions.
///
/// # Errors
/// As [`write_vdg`].
pub fn write_diagram_npy(path: &Path, diagram: &Diagram, force: bool) -> Result<()> {
    diagram.check()?;
    let kind = if diagram.fractions.is_some() { "|u1" } else { "|b1" };
    let cameras = diagram.cameras.len();
    write_encoded(path, force, |output| {
        super::table::write_npy_header(output, kind, &format!("({}, {cameras})", diagram.triangles))?;
        let mut bits = vec![0; cameras];
        for t in 0..diagram.triangles {
            let row = diagram.row(t);
            bits.iter_mut().enumerate().for_each(|(camera, bit)| *bit = u8::from(sees(row, camera)));
            output.write_all(diagram.fractions_row(t).unwrap_or(&bits))?;
        }
        Ok(())
    })
}

/// Reads a diagram file, compressed or not.
///
/// `memory_limit` bounds the bytes of the unpacked file; `None` sets no limit but the one for compressed files, see
/// [`super::ReadOptions::memory_limit`].
///
/// # Errors
/// [`Error::Read`]; [`Error::Parse`] for what is no such file or not a whole one; [`Error::Limit`];
/// [`Error::Unavailable`] for `.zst` without the feature `zstd`.
pub fn read_vdg(path: &Path, memory_limit: Option<u64>) -> Result<Diagram> {
    let name = FileName::of(path);
    let bytes = source::read_all(path, &name, memory_limit)?;
    parse(&bytes).map_err(|fault| fault.named(&name.shown))
}

fn parse(bytes: &[u8]) -> std::result::Result<Diagram, Fault> {
    let Some(rest) = bytes.strip_prefix(MAGIC) else {
        return Err(Fault::new(
            "this is no visibility diagram, which begins with VDG1; was it made by `measure --diagram`?",
        ));
    };
    let ([triangles, cameras], rest) = numbers(rest, bytes.len())?;
    let (triangles, cameras) = (triangles as usize, cameras as usize);
    let (table, rest) = split(rest, cameras as u128 * CAMERA_BYTES as u128, bytes.len(), "its cameras")?;
    let ([flags], rest) = numbers(rest, bytes.len())?;
    if flags & BITS == 0 || flags & !(BITS | FRACTIONS) != 0 {
        return Err(Fault::new(format!("flags {flags} (byte {}) are unknown; 1 and 3 are", 12 + table.len())));
    }
    // Before anything of a promised size is made, the file must have it.
    let (rows, width) = (triangles as u128, cameras.next_multiple_of(8));
    let (bits, rest) = split(rest, rows * cameras.div_ceil(64) as u128 * 8, bytes.len(), "its bits")?;
    let of_fractions = if flags & FRACTIONS == 0 { 0 } else { rows * width as u128 };
    let (shares, rest) = split(rest, of_fractions, bytes.len(), "its fractions")?;
    if !rest.is_empty() {
        let wanted = bytes.len() - rest.len();
        return Err(Fault::new(format!("the header promises {wanted} bytes, the file has {}", bytes.len())));
    }
    let fractions = || shares.chunks_exact(width.max(1)).flat_map(|row| &row[..cameras]).copied().collect();
    Ok(Diagram {
        cameras: table.chunks_exact(CAMERA_BYTES).map(camera).collect(),
        triangles,
        words: bits.as_chunks().0.iter().map(|&word| u64::from_le_bytes(word)).collect(),
        fractions: (flags & FRACTIONS != 0).then(fractions),
    })
}

fn camera(bytes: &[u8]) -> [f32; 4] {
    [0, 4, 8, 12].map(|at| f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]))
}

/// The next N numbers, and the rest.
fn numbers<const N: usize>(rest: &[u8], total: usize) -> std::result::Result<([u32; N], &[u8]), Fault> {
    let (head, rest) = split(rest, 4 * N as u128, total, "its header")?;
    let number = |i: usize| u32::from_le_bytes([head[4 * i], head[4 * i + 1], head[4 * i + 2], head[4 * i + 3]]);
    Ok((std::array::from_fn(number), rest))
}

/// The first `count` bytes, and the rest; `total` is the length of the file.
fn split<'a>(
    rest: &'a [u8],
    count: u128,
    total: usize,
    what: &str,
) -> std::result::Result<(&'a [u8], &'a [u8]), Fault> {
    let whole = usize::try_from(count).ok().and_then(|count| rest.split_at_checked(count));
    whole.ok_or_else(|| {
        let start = total - rest.len();
        Fault::new(format!("{what} need {count} bytes from byte {start}, the file ends at {total}; is it truncated?"))
    })
}

#[cfg(test)]
mod tests;
