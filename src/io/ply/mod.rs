//! PLY (Turk 1994): ASCII and binary of both byte orders, elements in any order.
//!
//! Taken are the coordinates of `vertex`, the polygons of `face` and the strips of `tristrips`; all else is stepped
//! over and named as dropped. One row reader serves all encodings: monomorphised, it reads the plain binary layout (float
//! coordinates, `uchar` and `int` for triangles) as fast as a special case of its own did, so there is none.

mod body;
mod header;
mod rows;

use super::fault::Fault;
use super::soup::Soup;
use header::{Encoding, Header};
use rows::{AsciiRows, BinaryRows};

/// Reads a PLY file.
pub(super) fn parse(file: &[u8]) -> Result<Soup, Fault> {
    let header = Header::parse(file)?;
    match header.encoding {
        Encoding::Ascii => body::read(&header, AsciiRows::new(file, &header)),
        Encoding::Little => body::read(&header, BinaryRows::<false>::new(file, &header)),
        Encoding::Big => body::read(&header, BinaryRows::<true>::new(file, &header)),
    }
}
