//! Checks outputs before the long work starts, and names the files of several levels.

use std::path::{Path, PathBuf};

use outsight::error::{Error, Result};
use outsight::io::{self, Format};

/// Endings that stand behind another: the file is compressed.
const COMPRESSED: [&str; 2] = ["zst", "gz"];

/// What a command may write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A mesh in any format.
    Mesh,
    /// The visibility of each triangle: PLY, GLB, NumPy or CSV.
    Visibility,
    /// Which camera sees which triangle: diagram file, NumPy or a picture.
    Diagram,
    /// A PNG picture.
    Picture,
    /// An HTML page.
    Page,
}

impl Kind {
    fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Mesh => &["ply", "obj", "stl", "off", "glb"],
            Self::Visibility => &["ply", "glb", "npy", "csv"],
            Self::Diagram => &["vdg", "npy", "png"],
            Self::Picture => &["png"],
            Self::Page => &["html"],
        }
    }

    /// The flag that names such an output.
    fn flag(self) -> &'static str {
        match self {
            Self::Diagram => "--diagram",
            Self::Page => "--report",
            Self::Mesh | Self::Visibility | Self::Picture => "--output",
        }
    }
}

/// An output that a command is going to write.
#[derive(Debug, Clone, Copy)]
pub struct Planned<'a> {
    /// Where it goes; `-` is standard output.
    pub path: &'a Path,
    /// What it may be.
    pub kind: Kind,
    /// Its format, where a flag says it.
    pub format: Option<Format>,
}

/// True for standard input or output.
pub fn is_pipe(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Refuses an output that could not be written in the end: unknown ending, an input of the run, there already, no such
/// directory, or not writable.
///
/// # Errors
/// [`Error::Option`] for a wrong name, [`Error::Write`] for what is in the way.
pub fn check(output: Planned<'_>, inputs: &[&Path], force: bool) -> Result<()> {
    if is_pipe(output.path) {
        return match (output.kind, output.format) {
            (Kind::Mesh, Some(_)) => Ok(()),
            (Kind::Mesh, None) => Err(Error::Option {
                name: "--output-format",
                message: "standard output has no name that says the format; give ply, obj, stl, off or glb".to_owned(),
            }),
            _ => Err(needs_name(output.kind)),
        };
    }
    check_ending(output)?;
    if let Some(input) = inputs.iter().find(|input| same_file(input, output.path)) {
        let message = format!("{} is also an input; choose another name", input.display());
        return Err(Error::Option { name: output.kind.flag(), message });
    }
    check_place(output.path, force)
}

/// Refuses a place where no file could be written: there already without `--force`, no directory, not writable.
///
/// # Errors
/// [`Error::Write`].
pub fn check_place(path: &Path, force: bool) -> Result<()> {
    io::check_target(path, force)?;
    let directory = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if path.exists() && !path.is_file() {
        // A device or a named pipe is written to directly.
        return Ok(());
    }
    // Only trying tells: permissions, read-only file systems and full quotas look different everywhere.
    tempfile::tempfile_in(directory).map(drop).map_err(|e| Error::Write {
        path: path.to_owned(),
        message: format!("the directory {} cannot be written to: {e}", directory.display()),
    })
}

/// Does the same for a file whose directory will be made where there is none.
///
/// # Errors
/// [`Error::Write`].
pub fn check_place_to_be(path: &Path, force: bool) -> Result<()> {
    match path.parent() {
        Some(directory) if !directory.as_os_str().is_empty() && !directory.exists() => {
            check_place_to_be(directory, true)
        }
        _ => check_place(path, force),
    }
}

fn check_ending(output: Planned<'_>) -> Result<()> {
    let (base, compressed) = without_compression(output.path);
    // A hidden file such as `.ply` has a name and no ending.
    let ending = if output.format.is_some() { String::new() } else { ending_of(&base) };
    let known = output.format.is_some() || output.kind.endings().contains(&ending.as_str());
    let may_compress = output.kind == Kind::Mesh || ["ply", "glb", "vdg"].contains(&ending.as_str());
    if known && (may_compress || !compressed) { Ok(()) } else { Err(needs_name(output.kind)) }
}

fn needs_name(kind: Kind) -> Error {
    let endings: Vec<String> = kind.endings().iter().map(|e| format!(".{e}")).collect();
    let message = format!("name a file that ends in {}", endings.join(", "));
    let more = match kind {
        Kind::Mesh => "; .zst or .gz behind it compresses",
        Kind::Visibility => "; .zst or .gz behind .ply and .glb compresses",
        Kind::Diagram => "; .zst or .gz behind .vdg compresses",
        Kind::Picture | Kind::Page => "",
    };
    Error::Option { name: kind.flag(), message: message + more }
}

fn same_file(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

/// The path without `.zst` or `.gz`, and whether it had one.
fn without_compression(path: &Path) -> (PathBuf, bool) {
    let compressed = COMPRESSED.contains(&ending_of(path).as_str());
    (if compressed { path.with_extension("") } else { path.to_owned() }, compressed)
}

/// The lower-case ending of a path, empty where it has none.
pub fn ending_of(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

/// The file of level `level` of several: `{}` in the name becomes the number, else `-lod0`, `-lod1`, … stands before
/// the ending (`part.ply.zst` gives `part-lod0.ply.zst`).
pub fn level_path(pattern: &Path, level: usize) -> PathBuf {
    let name = pattern.file_name().unwrap_or_default();
    if let Some(name) = name.to_str().filter(|name| name.contains("{}")) {
        return pattern.with_file_name(name.replace("{}", &level.to_string()));
    }
    let (base, compressed) = without_compression(Path::new(name));
    let mut name_of_level = base.file_stem().unwrap_or_default().to_os_string();
    name_of_level.push(format!("-lod{level}"));
    let compression = Path::new(name).extension().filter(|_| compressed);
    for ending in base.extension().into_iter().chain(compression) {
        name_of_level.push(".");
        name_of_level.push(ending);
    }
    pattern.with_file_name(name_of_level)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn mesh(path: &Path) -> Planned<'_> {
        Planned { path, kind: Kind::Mesh, format: None }
    }

    #[test]
    fn levels_are_numbered_before_the_ending() {
        assert_eq!(level_path(Path::new("a/part.ply"), 0), Path::new("a/part-lod0.ply"));
        assert_eq!(level_path(Path::new("part.ply.zst"), 2), Path::new("part-lod2.ply.zst"));
        assert_eq!(level_path(Path::new("v1.2.obj"), 1), Path::new("v1.2-lod1.obj"));
        assert_eq!(level_path(Path::new("lods/{}.stl"), 3), Path::new("lods/3.stl"));
    }

    #[test]
    fn unknown_ending_is_a_usage_error() {
        for name in ["x", "x.png", "x.gltf", "x.zst", ".ply"] {
            let error = check(mesh(Path::new(name)), &[], false).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{name}");
        }
        let odd = [
            ("x.png.gz", Kind::Picture),
            ("x.npy.zst", Kind::Visibility),
            ("x.ply", Kind::Diagram),
            ("x.html.gz", Kind::Page),
            ("-", Kind::Page),
            ("x.npy.gz", Kind::Diagram),
            ("-", Kind::Mesh),
        ];
        for (name, kind) in odd {
            let planned = Planned { path: Path::new(name), kind, format: None };
            assert_eq!(check(planned, &[], false).unwrap_err().exit_code(), 2, "{name}");
        }
    }

    #[test]
    fn existing_file_needs_force() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("there.ply");
        std::fs::write(&path, "x").unwrap();
        assert_eq!(check(mesh(&path), &[], false).unwrap_err().exit_code(), 4);
        assert!(check(mesh(&path), &[], true).is_ok());
        assert_eq!(check(mesh(&path), &[&path], true).unwrap_err().exit_code(), 2, "an input is never overwritten");
    }

    #[test]
    fn missing_directory_is_an_output_error() {
        let error = check(mesh(Path::new("no/such/directory/x.ply")), &[], false).unwrap_err();
        assert_eq!(error.exit_code(), 4);
    }
}
