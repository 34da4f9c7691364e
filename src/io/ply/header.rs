use super::super::fault::Fault;
use super::super::text::{self, show};

/// How the numbers behind the header are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Little,
    Big,
}

/// Type of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    /// Bytes it takes in binary.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }

    /// By its old name or its newer one with the number of bits.
    fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }
}

/// One number of an element, or one list.
#[derive(Debug, Clone)]
pub(super) struct Property {
    pub(super) name: String,
    /// Type of the number, or of the list's items.
    pub(super) kind: Scalar,
    /// Type of the list's length; `None` for a single number.
    pub(super) count: Option<Scalar>,
}

/// A table of the file: so many rows of these properties.
#[derive(Debug, Clone)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) rows: usize,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// Bytes of a row in binary, each list taken as empty: no row is smaller.
    pub(super) fn least_row_bytes(&self) -> usize {
        self.properties.iter().map(|p| p.count.unwrap_or(p.kind).size()).sum()
    }

    pub(super) fn has_lists(&self) -> bool {
        self.properties.iter().any(|p| p.count.is_some())
    }

    /// What its rows are called in messages.
    pub(super) fn noun(&self) -> &str {
        match self.name.as_str() {
            "vertex" => "vertices",
            "face" => "triangles",
            "tristrips" => "triangle strips",
            other => other,
        }
    }
}

/// All that stands before the numbers.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// A comment names a texture file, as several programs write it.
    pub(super) names_texture: bool,
    /// Bytes and lines of the header.
    pub(super) bytes: usize,
    pub(super) lines: usize,
}

impl Header {
    pub(super) fn parse(file: &[u8]) -> Result<Self, Fault> {
        // Files of old systems end their lines with `\r` alone.
        let end = if file.starts_with(b"ply\r") && file.get(4) != Some(&b'\n') { b'\r' } else { b'\n' };
        let mut draft = Draft::default();
        let mut rest = file;
        let mut line_number = 0;
        while !rest.is_empty() {
            let (line, behind) = text::split_line(rest, end);
            let is_whole = line.len() < rest.len();
            rest = behind;
            line_number += 1;
            if line_number == 1 {
                check_first_line(line)?;
            } else if line.trim_ascii_end() == b"end_header" && is_whole {
                return draft.finish(file.len() - rest.len(), line_number);
            } else {
                draft.read_line(line).map_err(|message| Fault::at(line_number, message))?;
            }
        }
        Err(Fault::new(match line_number {
            0 => "no data; is the file empty?".to_owned(),
            _ => format!("the header has no `end_header`, the file ends at byte {}; is it truncated?", file.len()),
        }))
    }
}

fn check_first_line(line: &[u8]) -> Result<(), Fault> {
    if line.trim_ascii_end() == b"ply" {
        Ok(())
    } else {
        Err(Fault::at(1, format!("a PLY file begins with `ply`, found {}", show(line))))
    }
}

/// Most elements of a header; meshes have two or three.
const MOST_ELEMENTS: usize = 256;

/// A header as far as it has been read.
#[derive(Debug, Default)]
struct Draft {
    encoding: Option<Encoding>,
    elements: Vec<Element>,
    names_texture: bool,
}

impl Draft {
    fn read_line(&mut self, line: &[u8]) -> Result<(), String> {
        let mut words = text::words(line);
        match words.next() {
            None | Some(b"obj_info") => Ok(()),
            Some(b"comment") => {
                self.names_texture |= words.next().is_some_and(|w| w.eq_ignore_ascii_case(b"texturefile"));
                Ok(())
            }
            Some(b"format") => self.read_format(words.next()),
            Some(b"element") => self.read_element(words.next(), words.next()),
            Some(b"property") => self.read_property(&mut words),
            Some(other) => Err(format!("{} does not belong into a PLY header", show(other))),
        }
    }

    fn read_format(&mut self, name: Option<&[u8]>) -> Result<(), String> {
        self.encoding = Some(match name {
            Some(b"ascii") => Encoding::Ascii,
            Some(b"binary_little_endian") => Encoding::Little,
            Some(b"binary_big_endian") => Encoding::Big,
            other => return Err(format!("{} is no PLY format", show(other.unwrap_or_default()))),
        });
        Ok(())
    }

    fn read_element(&mut self, name: Option<&[u8]>, count: Option<&[u8]>) -> Result<(), String> {
        let (Some(name), Some(count)) = (name, count) else {
            return Err("an element needs a name and a count".to_owned());
        };
        let rows = text::integer(count).and_then(|n| usize::try_from(n).ok());
        let rows = rows.ok_or_else(|| format!("{} is no count", show(count)))?;
        let name = String::from_utf8_lossy(name).into_owned();
        if self.elements.len() == MOST_ELEMENTS {
            return Err(format!("more than {MOST_ELEMENTS} elements; this is no mesh"));
        }
        if self.elements.iter().any(|e| e.name == name) {
            return Err(format!("the element {name} is declared twice"));
        }
        self.elements.push(Element { name, rows, properties: Vec::new() });
        Ok(())
    }

    fn read_property<'a>(&mut self, words: &mut impl Iterator<Item = &'a [u8]>) -> Result<(), String> {
        let element = self.elements.last_mut().ok_or("a property stands before the first element")?;
        let mut kind = || {
            let name = words.next().unwrap_or_default();
            if name == b"list" {
                return Ok(None);
            }
            Scalar::from_name(name).map(Some).ok_or_else(|| format!("{} is no PLY type", show(name)))
        };
        let missing = || "a list needs the types of its length and of its items".to_owned();
        let (count, kind) = match kind()? {
            Some(kind) => (None, kind),
            None => (Some(kind()?.ok_or_else(missing)?), kind()?.ok_or_else(missing)?),
        };
        if count.is_some_and(|c| !c.is_integer()) {
            return Err("the length of a list must have an integer type".to_owned());
        }
        let name = words.next().ok_or("a property needs a name")?;
        element.properties.push(Property { name: String::from_utf8_lossy(name).into_owned(), kind, count });
        Ok(())
    }

    fn finish(self, bytes: usize, lines: usize) -> Result<Header, Fault> {
        let encoding = self.encoding.ok_or_else(|| Fault::at(lines, "the header has no line `format …`"))?;
        Ok(Header { encoding, elements: self.elements, names_texture: self.names_texture, bytes, lines })
    }
}
