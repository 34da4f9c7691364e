//! Mesh files, in and out: PLY, OBJ, STL, OFF, each also compressed (`.zst`, `.gz`) or through a pipe (`-`).
//!
//! One file a format, its parser apart from files; what every format shares is here.

use std::path::Path;

use crate::error::Result;
use crate::mesh::{SetAside, TriMesh};

/// A mesh file format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Polygon file format, ASCII and binary of both byte orders; written binary little-endian.
    Ply,
    /// Wavefront OBJ.
    Obj,
    /// STL, ASCII and binary; written binary.
    Stl,
    /// Object file format.
    Off,
}

impl Format {
    /// The ending of its files.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Ply => "ply",
            Self::Obj => "obj",
            Self::Stl => "stl",
            Self::Off => "off",
        }
    }
}

/// Something a file held that Outsight cannot carry over yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Dropped {
    /// Vertex or corner normals.
    Normals,
    /// Texture coordinates.
    TextureCoordinates,
    /// Colours.
    Colours,
    /// Materials and material files.
    Materials,
    /// Names of parts, groups, solids.
    Parts,
    /// Points or lines that belong to no triangle.
    PointsAndLines,
    /// Further vertex or triangle properties.
    OtherProperties,
}

/// How a mesh is read. `Default`: format by extension, weld only where the format has no indices.
#[derive(Debug, Clone, Default)]
pub struct ReadOptions {
    /// The format, where the extension does not say it (a pipe, a wrong extension).
    pub format: Option<Format>,
    /// Merge vertices at exactly equal positions, whatever the format.
    pub weld: bool,
    /// Refuse input that needs more memory than this, in bytes.
    pub memory_limit: Option<u64>,
}

/// A mesh as read, with what was left behind.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// The mesh.
    pub mesh: TriMesh,
    /// Its format.
    pub format: Format,
    /// What the file held beyond triangles.
    pub dropped: Vec<Dropped>,
    /// Triangles that were set aside, as numbers among the file's triangles.
    pub set_aside: SetAside,
    /// Vertices merged because their positions are equal; `None` where nothing was welded.
    pub welded: Option<usize>,
}

/// What is written beside the triangles of a mesh.
#[derive(Debug, Clone, Copy, Default)]
pub struct TriangleAttributes<'a> {
    /// Visibility per triangle (PLY property `visibility`).
    pub visibility: Option<&'a [f64]>,
    /// Colour per triangle (PLY properties `red`, `green`, `blue`).
    pub colours: Option<&'a [[u8; 3]]>,
}

/// Reads a mesh; `-` is standard input.
///
/// # Errors
/// [`crate::Error::Read`], [`crate::Error::Parse`], [`crate::Error::Mesh`], [`crate::Error::Limit`].
pub fn read(_path: &Path, _options: &ReadOptions) -> Result<Loaded> {
    Err(crate::Error::Unavailable { message: "to come".to_owned() })
}

/// How a mesh is written.
#[derive(Debug, Clone, Copy, Default)]
pub struct WriteOptions {
    /// Replace a file that is there.
    pub force: bool,
    /// The format, where the extension does not say it.
    pub format: Option<Format>,
}

/// Writes a mesh; `-` is standard output.
///
/// # Errors
/// [`crate::Error::Write`].
pub fn write(
    _path: &Path,
    _mesh: &TriMesh,
    _attributes: &TriangleAttributes<'_>,
    _options: &WriteOptions,
) -> Result<()> {
    Err(crate::Error::Unavailable { message: "to come".to_owned() })
}

/// Writes a file beside `path` and renames it.
///
/// # Errors
/// [`crate::Error::Write`].
pub fn write_atomic(
    path: &Path,
    _force: bool,
    write: impl FnOnce(&mut dyn std::io::Write) -> std::io::Result<()>,
) -> Result<()> {
    let fail = |e: std::io::Error| crate::Error::Write { path: path.to_owned(), message: e.to_string() };
    let mut file = std::fs::File::create(path).map_err(fail)?;
    write(&mut file).map_err(fail)
}
