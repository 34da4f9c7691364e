//! Wavefront OBJ: vertices, polygons and, to name what is dropped, everything else.
//!
//! Of the many statements only `v` and `f` make triangles. `tobj` was tried: its errors have no line numbers, it makes
//! triangles of lines and points, and cuts concave polygons wrongly; what is left of it is less than this file.

use std::borrow::Cow;
use std::collections::BTreeSet;

use super::Dropped;
use super::fault::Fault;
use super::soup::Soup;
use super::text::{self, Lines, show};

/// Reads an OBJ file.
pub(super) fn parse(file: &[u8]) -> Result<Soup, Fault> {
    let mut reader = Reader::default();
    let mut lines = Lines::new(file);
    while let Some((number, line)) = lines.next() {
        let statement = join_continued(line, &mut lines);
        reader.read(&statement, number)?;
    }
    reader.finish()
}

/// A statement that a `\` at its end carries over to the next lines, as one line.
fn join_continued<'a>(line: &'a [u8], lines: &mut Lines<'a>) -> Cow<'a, [u8]> {
    let Some(start) = line.strip_suffix(b"\\") else { return Cow::Borrowed(line) };
    let mut whole = start.to_vec();
    for (_, more) in lines {
        whole.push(b' ');
        match more.strip_suffix(b"\\") {
            Some(part) => whole.extend_from_slice(part),
            None => {
                whole.extend_from_slice(more);
                break;
            }
        }
    }
    Cow::Owned(whole)
}

#[derive(Debug, Default)]
struct Reader {
    soup: Soup,
    corners: Vec<u32>,
    /// Largest vertex number used, from 1, and the line that used it first: vertices may follow their triangles.
    highest: (usize, usize),
    /// Names of objects and groups under which polygons were found, as far as it takes to see that there are several.
    part: Vec<u8>,
    parts_used: BTreeSet<Vec<u8>>,
}

impl Reader {
    fn read(&mut self, statement: &[u8], line: usize) -> Result<(), Fault> {
        let mut words = text::words(statement);
        let Some(keyword) = words.next() else { return Ok(()) };
        match keyword {
            b"v" => self.read_vertex(&mut words, line)?,
            b"f" | b"fo" => self.read_polygon(&mut words, line)?,
            b"o" | b"g" => self.part = statement.trim_ascii().to_vec(),
            b"vn" => self.drop(Dropped::Normals),
            b"vt" => self.drop(Dropped::TextureCoordinates),
            b"usemtl" | b"mtllib" | b"usemap" | b"maplib" => self.drop(Dropped::Materials),
            b"l" | b"p" => self.drop(Dropped::PointsAndLines),
            b"s" if matches!(words.next(), None | Some(b"off" | b"0")) => {}
            _ if keyword.starts_with(b"#") => {}
            _ if statement.contains(&0) => {
                return Err(Fault::at(line, "this is no text; name the format, or convert the file to PLY"));
            }
            _ => self.drop(Dropped::OtherProperties),
        }
        Ok(())
    }

    fn drop(&mut self, what: Dropped) {
        self.soup.dropped.insert(what);
    }

    /// `v x y z`, then nothing, a weight, a colour, or both.
    fn read_vertex<'a>(&mut self, words: &mut impl Iterator<Item = &'a [u8]>, line: usize) -> Result<(), Fault> {
        self.soup.positions.push(text::position(words, line)?);
        match words.take_while(|w| !w.starts_with(b"#")).count() {
            0 => {}
            1 => self.drop(Dropped::OtherProperties),
            _ => self.drop(Dropped::Colours),
        }
        Ok(())
    }

    /// `f 1 2 3`, `f 1/1 2/2 3/3`, `f 1//1 …`, `f 1/1/1 …`, each number from 1, or from the last backwards below 0.
    fn read_polygon<'a>(&mut self, words: &mut impl Iterator<Item = &'a [u8]>, line: usize) -> Result<(), Fault> {
        self.corners.clear();
        for word in words.take_while(|w| !w.starts_with(b"#")) {
            let mut fields = word.split(|&b| b == b'/');
            let vertex = self.vertex_number(fields.next().unwrap_or_default(), line)?;
            self.corners.push((vertex - 1) as u32);
            if vertex > self.highest.0 {
                self.highest = (vertex, line);
            }
            for what in [Dropped::TextureCoordinates, Dropped::Normals] {
                if fields.next().is_some_and(|f| !f.is_empty()) {
                    self.soup.dropped.insert(what);
                }
            }
        }
        let is_polygon = self.soup.polygons.push(&self.corners).map_err(|message| Fault::at(line, message))?;
        if !is_polygon {
            self.drop(Dropped::PointsAndLines);
        } else if self.parts_used.len() < 2 && !self.parts_used.contains(&self.part) {
            self.parts_used.insert(self.part.clone());
        }
        Ok(())
    }

    /// The vertex that a polygon names, from 1; not yet checked against the end of the file.
    fn vertex_number(&self, word: &[u8], line: usize) -> Result<usize, Fault> {
        let so_far = self.soup.positions.len();
        let number = text::integer(word)
            .ok_or_else(|| Fault::at(line, format!("expected the number of a vertex, found {}", show(word))))?;
        let vertex = match usize::try_from(number) {
            Ok(0) => return Err(Fault::at(line, "vertex 0 is used, but OBJ counts from 1")),
            Ok(vertex) if vertex < u32::MAX as usize => Some(vertex),
            Ok(_) => None,
            Err(_) => {
                usize::try_from(number.unsigned_abs()).ok().filter(|&back| back <= so_far).map(|b| so_far + 1 - b)
            }
        };
        vertex.ok_or_else(|| {
            let message = format!("triangle uses vertex {number}, but the file has {so_far} vertices up to this line");
            Fault::at(line, message)
        })
    }

    fn finish(mut self) -> Result<Soup, Fault> {
        let vertices = self.soup.positions.len();
        let (highest, line) = self.highest;
        if highest > vertices {
            let message = format!("triangle uses vertex {highest}, but the file has {vertices} vertices");
            return Err(Fault::at(line, message));
        }
        if self.parts_used.len() > 1 {
            self.drop(Dropped::Parts);
        }
        Ok(self.soup)
    }
}
