//! Numbers per triangle, as `.npy` and `.csv`; `.gz` or `.zst` behind the name compresses.

use std::io::{self, Write};
use std::path::Path;

use super::encode::{Shortest, write_encoded};
use crate::error::{Error, Result};

/// Writes a NumPy array of one dimension, little-endian 64-bit floats (format version 1.0).
///
/// # Errors
/// As [`super::write_atomic`].
pub fn write_npy_f64(path: &Path, values: &[f64], force: bool) -> Result<()> {
    write_encoded(path, force, |output| {
        write_npy_header(output, "<f8", &format!("({},)", values.len()))?;
        values.iter().try_for_each(|v| output.write_all(&v.to_le_bytes()))
    })
}

/// Writes a NumPy array of one dimension, little-endian 32-bit floats (format version 1.0).
///
/// # Errors
/// As [`super::write_atomic`].
pub fn write_npy_f32(path: &Path, values: &[f32], force: bool) -> Result<()> {
    write_encoded(path, force, |output| {
        write_npy_header(output, "<f4", &format!("({},)", values.len()))?;
        values.iter().try_for_each(|v| output.write_all(&v.to_le_bytes()))
    })
}

/// Magic, version, and a Python dictionary padded with blanks so that the numbers begin at a multiple of 64 bytes
/// (NumPy Enhancement Proposal 1).
pub(super) fn write_npy_header(output: &mut dyn Write, kind: &str, shape: &str) -> io::Result<()> {
    const BEFORE: usize = 10;
    let dictionary = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    let whole = (BEFORE + dictionary.len() + 1).next_multiple_of(64);
    let padded = whole - BEFORE - 1;
    output.write_all(b"\x93NUMPY\x01\x00")?;
    // At most 64 bytes of text and 40 digits, so it fits.
    output.write_all(&((padded + 1) as u16).to_le_bytes())?;
    writeln!(output, "{dictionary:padded$}")
}

/// Writes a table of one row per triangle: column `triangle`, its number from 0, then each column given by name.
///
/// Numbers have the fewest digits that read back as the same; the separator is a comma.
///
/// # Errors
/// [`Error::ShapeMismatch`] if the columns differ in length; else as [`super::write_atomic`].
pub fn write_visibility_csv(path: &Path, columns: &[(&str, &[f64])], force: bool) -> Result<()> {
    let rows = columns.first().map_or(0, |(_, values)| values.len());
    if let Some((_, values)) = columns.iter().find(|(_, values)| values.len() != rows) {
        return Err(Error::ShapeMismatch { what: "a column of the table", got: values.len(), expected: rows });
    }
    write_encoded(path, force, |output| {
        write!(output, "triangle")?;
        columns.iter().try_for_each(|(name, _)| write!(output, ",{name}"))?;
        writeln!(output)?;
        for row in 0..rows {
            write!(output, "{row}")?;
            columns.iter().try_for_each(|(_, values)| write!(output, ",{}", Shortest(values[row])))?;
            writeln!(output)?;
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn npy_header_is_a_multiple_of_64_and_numbers_follow() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("v.npy");
        write_npy_f64(&path, &[0.5, 1.0], false).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!(bytes.len(), 128 + 16);
        assert_eq!(&bytes[..10], b"\x93NUMPY\x01\x00\x76\x00");
        assert!(bytes[10..].starts_with(b"{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }"));
        assert_eq!(bytes[127], b'\n');
        assert_eq!(bytes[128..136], 0.5_f64.to_le_bytes());
        write_npy_f32(&path, &[0.25; 3], true).unwrap();
        assert_eq!(std::fs::read(&path).unwrap().len(), 128 + 12);
    }

    #[test]
    fn csv_has_a_header_and_a_row_a_triangle() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("v.csv");
        write_visibility_csv(&path, &[("visibility", &[0.1, 0.0]), ("area", &[1.5, 2e-9])], false).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "triangle,visibility,area\n0,0.1,1.5\n1,0,2e-9\n");
        let odd = write_visibility_csv(&path, &[("a", &[0.1]), ("b", &[])], true);
        assert!(matches!(odd, Err(Error::ShapeMismatch { .. })));
    }
}
