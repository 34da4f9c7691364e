use std::path::Path;

use super::fault::Fault;
use super::stl;
use super::text::{self, Lines};
use crate::error::{Error, Result};

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
    /// Binary glTF 2.0; written only.
    Glb,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 5] = [Self::Ply, Self::Obj, Self::Stl, Self::Off, Self::Glb];

    /// Its file extension in lower case, without the dot.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Ply => "ply",
            Self::Obj => "obj",
            Self::Stl => "stl",
            Self::Off => "off",
            Self::Glb => "glb",
        }
    }

    /// The format of that extension, upper or lower case, without the dot.
    #[must_use]
    pub fn from_extension(extension: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.extension().eq_ignore_ascii_case(extension))
    }

    /// The format that a path names, `.gz` or `.zst` behind it put aside; `None` for `-` and for other extensions.
    #[must_use]
    pub fn of_path(path: &Path) -> Option<Self> {
        FileName::of(path).format
    }
}

/// How a file is compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Compression {
    Gzip,
    Zstd,
}

impl Compression {
    /// Extension and name.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Gzip => "gz",
            Self::Zstd => "zst",
        }
    }

    /// By the first bytes of a file (RFC 1952 §2.3.1; RFC 8878 §3.1.1, §3.1.2).
    pub(super) fn of_magic(bytes: &[u8]) -> Option<Self> {
        match bytes {
            [0x1f, 0x8b, ..] => Some(Self::Gzip),
            [0x28, 0xb5, 0x2f, 0xfd, ..] | [0x50..=0x5f, 0x2a, 0x4d, 0x18, ..] => Some(Self::Zstd),
            _ => None,
        }
    }

    fn from_extension(extension: &str) -> Option<Self> {
        [Self::Gzip, Self::Zstd].into_iter().find(|c| c.name().eq_ignore_ascii_case(extension))
    }
}

/// What a path says about its content.
#[derive(Debug)]
pub(super) struct FileName {
    /// The name in messages.
    pub(super) shown: String,
    pub(super) is_pipe: bool,
    pub(super) format: Option<Format>,
    pub(super) compression: Option<Compression>,
}

impl FileName {
    pub(super) fn of(path: &Path) -> Self {
        if path.as_os_str() == "-" {
            return Self { shown: "-".to_owned(), is_pipe: true, format: None, compression: None };
        }
        let file = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let (mut stem, mut extension) = file.rsplit_once('.').unwrap_or((&file, ""));
        let compression = Compression::from_extension(extension);
        if compression.is_some() {
            (stem, extension) = stem.rsplit_once('.').unwrap_or((stem, ""));
        }
        // A hidden file such as `.ply` has a name and no extension.
        let format = if stem.is_empty() { None } else { Format::from_extension(extension) };
        Self { shown: path.display().to_string(), is_pipe: false, format, compression }
    }
}

/// The format to read `bytes` as: the one asked for, else the extension's, else the one that they look like.
///
/// # Errors
/// [`Error::Parse`] where they plainly are another format, or look like none.
pub(super) fn decide(bytes: &[u8], name: &FileName, asked: Option<Format>) -> Result<Format> {
    let looks = looks_like(bytes);
    match (asked.or(name.format), looks) {
        (Some(said), Some(looks)) if said != looks => Err(mismatch(name, asked, said, looks)),
        (Some(said), _) => Ok(said),
        (None, Some(looks)) => Ok(looks),
        (None, None) if bytes.is_empty() => Err(Fault::new("no data; is the file empty?").named(&name.shown)),
        (None, None) => {
            Err(Fault::new("this looks like none of PLY, OBJ, STL and OFF; name the format with --input-format")
                .named(&name.shown))
        }
    }
}

fn mismatch(name: &FileName, asked: Option<Format>, said: Format, looks: Format) -> Error {
    let (said, extension) = (said.extension().to_uppercase(), looks.extension());
    let who = if asked.is_some() { "the format asked for is" } else { "the extension says" };
    let what_next = if asked.is_some() { "ask for" } else { "rename it to" };
    let dot = if asked.is_some() { "" } else { "." };
    Fault::new(format!(
        "{who} {said}, but the content looks like {}; {what_next} {dot}{extension}",
        extension.to_uppercase()
    ))
    .named(&name.shown)
}

/// The format that the first bytes, or for binary STL the size, give away.
pub(super) fn looks_like(bytes: &[u8]) -> Option<Format> {
    let start = text::skip_blank(bytes);
    if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
        Some(Format::Ply)
    } else if bytes.starts_with(b"glTF") {
        Some(Format::Glb)
    } else if stl::is_binary(bytes) || starts_with_word(start, b"solid") {
        Some(Format::Stl)
    } else {
        first_statement(bytes).and_then(|word| match word {
            b"v" | b"vn" | b"vt" | b"f" | b"o" | b"g" | b"mtllib" | b"usemtl" => Some(Format::Obj),
            _ if word.ends_with(b"OFF") && word.len() <= 7 => Some(Format::Off),
            _ => None,
        })
    }
}

fn starts_with_word(bytes: &[u8], word: &[u8]) -> bool {
    let (start, rest) = bytes.split_at(word.len().min(bytes.len()));
    start.eq_ignore_ascii_case(word) && rest.first().is_none_or(u8::is_ascii_whitespace)
}

/// First word of the first line that is neither blank nor a `#` comment.
fn first_statement(bytes: &[u8]) -> Option<&[u8]> {
    Lines::new(bytes).find_map(|(_, line)| text::words(line).next().filter(|word| !word.starts_with(b"#")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extension_is_found_in_any_case_and_before_compression() {
        let of = |p: &str| {
            let name = FileName::of(Path::new(p));
            (name.format, name.compression)
        };
        assert_eq!(of("a/b.PLY"), (Some(Format::Ply), None));
        assert_eq!(of("a.stl.GZ"), (Some(Format::Stl), Some(Compression::Gzip)));
        assert_eq!(of("x.y.off.zst"), (Some(Format::Off), Some(Compression::Zstd)));
        assert_eq!(of(".obj"), (None, None));
        assert_eq!(of("mesh"), (None, None));
        assert_eq!(of("mesh.gz"), (None, Some(Compression::Gzip)));
        assert_eq!(of(".."), (None, None));
    }

    #[test]
    fn content_gives_its_format_away() {
        assert_eq!(looks_like(b"ply\r\nformat"), Some(Format::Ply));
        assert_eq!(looks_like(b"  SOLID\n"), Some(Format::Stl));
        assert_eq!(looks_like(b"# hello\n\nmtllib a.mtl\n"), Some(Format::Obj));
        assert_eq!(looks_like(b"# hello\nSTCNOFF\n"), Some(Format::Off));
        assert_eq!(looks_like(b"8 6 12\n"), None);
        assert_eq!(looks_like(b""), None);
        let mut binary = b"solid with a misleading header".to_vec();
        binary.resize(84 + 50, 0);
        binary[80] = 1;
        assert_eq!(looks_like(&binary), Some(Format::Stl));
    }
}
