//! STL, ASCII and binary. It has no indices, so corners at exactly equal positions become one vertex.
//!
//! Which of the two a file is does not show in its first word: many binary headers begin with `solid`. A file whose
//! size is exactly what its binary count says is binary; of the rest, `solid` followed by text is ASCII. A count
//! that disagrees with the size is an error in both directions: bytes behind the last triangle may be anything.

use glam::DVec3;

use super::Dropped;
use super::fault::Fault;
use super::soup::Soup;
use super::text::{self, Words, show};
use crate::mesh::Welder;

/// Bytes before the first triangle of a binary file: a free text and the count.
const HEADER: usize = 84;
/// Bytes of a binary triangle: normal, three corners, two bytes of attributes.
const TRIANGLE: usize = 50;

/// Reads an STL file.
pub(super) fn parse(file: &[u8]) -> Result<Soup, Fault> {
    if file.is_empty() {
        Err(Fault::new("no data; is the file empty?"))
    } else if is_binary(file) {
        Ok(parse_binary(file))
    } else if is_text(file) {
        AsciiReader::new(file).read()
    } else {
        Err(wrong_size(file))
    }
}

/// Whether the size is that of a binary file with so many triangles.
pub(super) fn is_binary(file: &[u8]) -> bool {
    promised(file).is_some_and(|n| file.len() as u64 == size_of_binary(n))
}

fn promised(file: &[u8]) -> Option<u32> {
    file.get(80..).and_then(|f| f.first_chunk()).map(|&count| u32::from_le_bytes(count))
}

fn size_of_binary(triangles: u32) -> u64 {
    HEADER as u64 + TRIANGLE as u64 * u64::from(triangles)
}

/// Text that begins as ASCII STL does; a zero byte early on says that it is binary for all its `solid`.
fn is_text(file: &[u8]) -> bool {
    let start = text::skip_blank(file);
    let is_solid = start.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    is_solid && !file[..file.len().min(512)].contains(&0)
}

fn wrong_size(file: &[u8]) -> Fault {
    let Some(count) = promised(file) else {
        return Fault::new(format!(
            "neither text that begins with `solid` nor {HEADER} bytes of a binary header, the file ends at byte {}; \
             is it truncated?",
            file.len()
        ));
    };
    let (needed, have) = (size_of_binary(count), file.len() as u64);
    let whole = (file.len() - HEADER) / TRIANGLE;
    Fault::new(if have < needed {
        format!(
            "the header promises {count} triangles ({needed} bytes), the file ends after {whole} (byte {have}); \
             is it truncated?"
        )
    } else {
        format!("the header promises {count} triangles ({needed} bytes), the file has {have} bytes; its count is wrong")
    })
}

fn parse_binary(file: &[u8]) -> Soup {
    let mut soup = Soup::default();
    let mut welder = Welder::default();
    let mut has_attributes = false;
    let (triangles, _) = file[HEADER..].as_chunks::<TRIANGLE>();
    soup.polygons.reserve(triangles.len());
    for triangle in triangles {
        let number = |i: usize| f64::from(f32::from_le_bytes([0, 1, 2, 3].map(|k| triangle[12 + 4 * i + k])));
        let corner = |i: usize| DVec3::new(number(3 * i), number(3 * i + 1), number(3 * i + 2));
        soup.polygons.push_triangle([0, 1, 2].map(|i| welder.vertex_at(corner(i))));
        has_attributes |= triangle[48..] != [0, 0];
    }
    if has_attributes {
        // Two programs' conventions put a colour there; nothing else is known to use these bytes.
        soup.dropped.insert(Dropped::Colours);
    }
    finish(soup, welder, 3 * triangles.len())
}

fn finish(mut soup: Soup, welder: Welder, corners: usize) -> Soup {
    soup.positions = welder.into_positions();
    soup.welded = Some(corners - soup.positions.len());
    soup
}

/// Reads `solid name (facet normal x y z outer loop (vertex x y z)×3 endloop endfacet)… endsolid name`, in any
/// layout and case, one solid after the other.
struct AsciiReader<'a> {
    words: Words<'a>,
    file_bytes: usize,
    soup: Soup,
    welder: Welder,
    triangles: usize,
    solids: usize,
}

impl<'a> AsciiReader<'a> {
    fn new(file: &'a [u8]) -> Self {
        let words = Words::new(text::skip_blank(file), 1 + leading_lines(file));
        let (soup, welder) = (Soup::default(), Welder::default());
        Self { words, file_bytes: file.len(), soup, welder, triangles: 0, solids: 0 }
    }

    fn read(mut self) -> Result<Soup, Fault> {
        while let Some(word) = self.words.next() {
            if !word.eq_ignore_ascii_case(b"solid") {
                return Err(self.expected("`solid`", word));
            }
            self.words.rest_of_line();
            self.read_solid()?;
            self.solids += 1;
        }
        if self.solids > 1 {
            self.soup.dropped.insert(Dropped::Parts);
        }
        Ok(finish(self.soup, self.welder, 3 * self.triangles))
    }

    fn read_solid(&mut self) -> Result<(), Fault> {
        loop {
            let word = self.word()?;
            if word.eq_ignore_ascii_case(b"facet") {
                self.read_facet()?;
            } else if word.eq_ignore_ascii_case(b"endsolid") {
                self.words.rest_of_line();
                return Ok(());
            } else {
                return Err(self.expected("`facet` or `endsolid`", word));
            }
        }
    }

    fn read_facet(&mut self) -> Result<(), Fault> {
        self.keyword("normal")?;
        for _ in 0..3 {
            self.word()?; // The normal follows from the corners, and is often wrong or `nan`.
        }
        self.keyword("outer")?;
        self.keyword("loop")?;
        let mut corners = [0; 3];
        for corner in &mut corners {
            self.keyword("vertex")?;
            let position = [self.word()?, self.word()?, self.word()?];
            let position = text::position(&mut position.into_iter(), self.words.line())?;
            *corner = self.welder.vertex_at(position);
        }
        self.keyword("endloop")?;
        self.keyword("endfacet")?;
        self.soup.polygons.push_triangle(corners);
        self.triangles += 1;
        Ok(())
    }

    fn word(&mut self) -> Result<&'a [u8], Fault> {
        self.words.next().ok_or_else(|| {
            Fault::new(format!(
                "the file ends within a solid, after {} triangles (byte {}); is it truncated?",
                self.triangles, self.file_bytes
            ))
        })
    }

    fn keyword(&mut self, keyword: &str) -> Result<(), Fault> {
        let word = self.word()?;
        if word.eq_ignore_ascii_case(keyword.as_bytes()) {
            Ok(())
        } else {
            Err(self.expected(&format!("`{keyword}`"), word))
        }
    }

    fn expected(&self, what: &str, found: &[u8]) -> Fault {
        Fault::at(self.words.line(), format!("expected {what}, found {}", show(found)))
    }
}

/// Lines before the first that is not blank.
fn leading_lines(file: &[u8]) -> usize {
    let blank = file.len() - text::skip_blank(file).len();
    file[..blank].iter().filter(|&&b| b == b'\n').count()
}
