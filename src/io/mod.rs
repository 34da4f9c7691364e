//! Mesh files, in and out: PLY, OBJ, STL, OFF, and GLB out, each also compressed (`.zst`, `.gz`) or through a pipe (`-`).
//!
//! One file a format. Every reader is a function of bytes, [`parse`], apart from the file that they came from; it
//! ends in triangles and polygons, which become a mesh in one place. All readers are our own: they name the line or byte of what
//! is wrong and they allocate by what the file holds, never by what it promises. The crates that were tried give no
//! line numbers (`tobj`), make triangles of lines (`tobj`), or lose solids (`stl_io`); polygons go to `earcut`.
//!
//! Reading never guesses against the file's name: where the content is plainly another format, that is an error
//! which says so.

mod atomic;
mod cameras;
mod encode;
mod fault;
mod format;
mod glb;
mod obj;
mod off;
mod ply;
mod polygon;
mod soup;
mod source;
mod stl;
mod table;
mod text;
mod vdg;

use std::path::Path;

pub use atomic::{check_target, write_atomic, write_atomic_in_directory};
pub use cameras::read_cameras;
pub use encode::{Attributes, WriteOptions, write};
pub use format::Format;
pub use glb::Glb;
pub use table::{write_npy_f32, write_npy_f64, write_visibility_csv};
pub use vdg::{Diagram, read_vdg, write_diagram_npy, write_vdg};

use crate::error::{Error, Result};
use crate::mesh::{SetAside, TriMesh, TriangleId};
use fault::Fault;
use format::FileName;
use soup::Soup;

/// Something a file held that Outsight cannot carry over yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Dropped {
    /// Vertex or corner normals. The facet normals of STL do not count: they follow from the triangles.
    Normals,
    /// Texture coordinates.
    TextureCoordinates,
    /// Colours.
    Colours,
    /// Materials and material files.
    Materials,
    /// The division into parts (objects, groups, solids), where there is more than one.
    Parts,
    /// Points or lines that belong to no triangle.
    PointsAndLines,
    /// Further vertex or triangle properties.
    OtherProperties,
}

impl Dropped {
    /// Name in warnings and in JSON: `texture coordinates`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Normals => "normals",
            Self::TextureCoordinates => "texture coordinates",
            Self::Colours => "colours",
            Self::Materials => "materials",
            Self::Parts => "parts",
            Self::PointsAndLines => "points and lines",
            Self::OtherProperties => "other properties",
        }
    }
}

/// How a mesh is read. `Default`: format by extension, weld only where the format has no indices.
#[derive(Debug, Clone, Default)]
pub struct ReadOptions {
    /// The format, where the extension does not say it (a pipe, a wrong extension).
    pub format: Option<Format>,
    /// Merge vertices at exactly equal positions, whatever the format.
    pub weld: bool,
    /// Refuse input that needs more memory than this, in bytes: the unpacked file plus the mesh made of it. `None`
    /// sets no limit, except that a compressed file may not unpack to more than 64 MiB plus 200 times its size.
    pub memory_limit: Option<u64>,
}

/// A mesh as read, with what was left behind.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// The mesh.
    pub mesh: TriMesh,
    /// Its format.
    pub format: Format,
    /// What the file held beyond triangles, each once, in the order of [`Dropped`].
    pub dropped: Vec<Dropped>,
    /// Triangles that were set aside, as numbers among the file's triangles; a polygon of n corners counts as its
    /// n - 2 triangles.
    pub set_aside: SetAside,
    /// Vertices merged because their positions are equal; `None` where nothing was welded.
    pub welded: Option<usize>,
}

impl Loaded {
    /// For each triangle of the *file* its number in the mesh; `None` for those that were set aside.
    #[must_use]
    pub fn file_order(&self) -> Vec<Option<TriangleId>> {
        let mut aside = [&self.set_aside.repeated_vertex[..], &self.set_aside.zero_area[..]].concat();
        aside.sort_unstable();
        let total = self.mesh.triangle_count() + aside.len();
        let (mut kept, mut aside) = (0.., aside.into_iter().peekable());
        (0..total as u32)
            .map(|t| if aside.next_if_eq(&t).is_some() { None } else { kept.next().map(TriangleId) })
            .collect()
    }

    /// For each triangle of the mesh its number in the file.
    #[must_use]
    pub fn numbers_in_file(&self) -> Vec<usize> {
        (0..).zip(self.file_order()).filter(|(_, id)| id.is_some()).map(|(number, _)| number).collect()
    }

    /// Values of the mesh's triangles, one per triangle of the *file*: those that were set aside get `missing`.
    #[must_use]
    pub fn in_file_order(&self, values: &[f64], missing: f64) -> Vec<f64> {
        let value = |id: Option<TriangleId>| id.and_then(|id| values.get(id.0 as usize)).copied();
        self.file_order().into_iter().map(|id| value(id).unwrap_or(missing)).collect()
    }
}

/// Reads a mesh; `-` is standard input.
///
/// # Errors
/// [`Error::Read`], [`Error::Parse`], [`Error::Mesh`], [`Error::Limit`]; [`Error::Unavailable`] for a `.zst` file
/// where the feature `zstd` is off.
pub fn read(path: &Path, options: &ReadOptions) -> Result<Loaded> {
    let name = FileName::of(path);
    if options.format.is_none() && name.format.is_none() && !name.is_pipe {
        return Err(unknown_extension(&name));
    }
    let bytes = source::read_all(path, &name, options.memory_limit)?;
    parse_named(&bytes, &name, options)
}

/// Reads a mesh from the bytes of a file that is not compressed. `name` gives the format by its extension, as a path
/// would, and stands in messages.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Loaded> {
    parse_named(bytes, &FileName::of(Path::new(name)), options)
}

fn parse_named(bytes: &[u8], name: &FileName, options: &ReadOptions) -> Result<Loaded> {
    let format = format::decide(bytes, name, options.format)?;
    let soup = match format {
        Format::Ply => ply::parse(bytes),
        Format::Obj => obj::parse(bytes),
        Format::Stl => stl::parse(bytes),
        Format::Off => off::parse(bytes),
        Format::Glb => {
            Err(Fault::new("Outsight writes GLB and does not read it; export the model as .ply, .obj, .stl or .off"))
        }
    }
    .map_err(|fault| fault.named(&name.shown))?;
    check_memory(bytes.len(), &soup, name, options.memory_limit)?;
    soup.into_loaded(format, options.weld).map_err(|fault| fault.named(&name.shown))
}

fn check_memory(file_bytes: usize, soup: &Soup, name: &FileName, limit: Option<u64>) -> Result<()> {
    let needed = file_bytes as u64 + soup.bytes();
    match limit {
        Some(limit) if needed > limit => Err(Error::Limit {
            message: format!(
                "{}: reading needs {needed} bytes, more than the memory limit of {limit}; raise --memory-limit",
                name.shown
            ),
        }),
        _ => Ok(()),
    }
}

fn unknown_extension(name: &FileName) -> Error {
    Fault::new(
        "the extension names no mesh format; Outsight reads .ply, .obj, .stl and .off, each also with .gz or .zst",
    )
    .named(&name.shown)
}
