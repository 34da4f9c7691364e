//! OFF (Geomview): `OFF` with any of the prefixes ST, C and N, ASCII, one vertex or polygon a line.

use super::Dropped;
use super::fault::Fault;
use super::soup::Soup;
use super::text::{self, Lines, show};

/// Reads an OFF file.
pub(super) fn parse(file: &[u8]) -> Result<Soup, Fault> {
    let mut reader = Reader { lines: Lines::new(file), last_line: 0, file_bytes: file.len(), kind: Kind::default() };
    let (vertices, polygons) = reader.read_header()?;
    let mut soup = Soup::default();
    soup.positions.reserve_exact(vertices.min(file.len() / LEAST_LINE));
    soup.polygons.reserve(polygons.min(file.len() / LEAST_LINE));
    reader.read_vertices(vertices, &mut soup)?;
    reader.read_polygons(polygons, vertices, &mut soup)?;
    match reader.next_line() {
        None => Ok(soup),
        Some((line, _)) => {
            Err(Fault::at(line, "the file goes on behind all that its header promises; its counts are wrong"))
        }
    }
}

/// Bytes of the shortest useful line, a vertex such as `0 0 0`.
const LEAST_LINE: usize = 6;

/// What a vertex carries behind its coordinates, by the prefixes of the header.
#[derive(Debug, Clone, Copy, Default)]
struct Kind {
    texture: bool,
    colour: bool,
    normal: bool,
}

impl Kind {
    fn of(header: &[u8]) -> Option<Self> {
        let rest = header.strip_suffix(b"OFF")?;
        let (texture, rest) = rest.strip_prefix(b"ST").map_or((false, rest), |r| (true, r));
        let (colour, rest) = rest.strip_prefix(b"C").map_or((false, rest), |r| (true, r));
        let (normal, rest) = rest.strip_prefix(b"N").map_or((false, rest), |r| (true, r));
        rest.is_empty().then_some(Self { texture, colour, normal })
    }

    fn dropped(self, soup: &mut Soup) {
        let all = [
            (self.normal, Dropped::Normals),
            (self.texture, Dropped::TextureCoordinates),
            (self.colour, Dropped::Colours),
        ];
        soup.dropped.extend(all.iter().filter(|(is_there, _)| *is_there).map(|&(_, what)| what));
    }

    fn is_plain(self) -> bool {
        !(self.texture || self.colour || self.normal)
    }
}

struct Reader<'a> {
    lines: Lines<'a>,
    last_line: usize,
    file_bytes: usize,
    kind: Kind,
}

impl<'a> Reader<'a> {
    /// The next line that holds anything, its comment cut off.
    fn next_line(&mut self) -> Option<(usize, &'a [u8])> {
        let found = self.lines.by_ref().find_map(|(number, line)| {
            let (line, _) = text::split_line(line, b'#');
            let line = line.trim_ascii();
            if line.is_empty() { None } else { Some((number, line)) }
        });
        self.last_line = found.map_or(self.last_line, |(number, _)| number);
        found
    }

    /// Counts of vertices and polygons; they stand in the line of the word `OFF` or in the next.
    fn read_header(&mut self) -> Result<(usize, usize), Fault> {
        let empty = || Fault::new("no data; is the file empty?");
        let (mut number, mut line) = self.next_line().ok_or_else(empty)?;
        let first = text::words(line).next().unwrap_or_default();
        if first.ends_with(b"OFF") {
            let unknown = || format!("{} is a kind of OFF that Outsight does not read; convert it to PLY", show(first));
            self.kind = Kind::of(first).ok_or_else(|| Fault::at(number, unknown()))?;
            line = line[first.len()..].trim_ascii_start();
            if line.is_empty() {
                let no_counts = || Fault::new("the file ends before its counts; is it truncated?");
                (number, line) = self.next_line().ok_or_else(no_counts)?;
            }
        }
        if line.starts_with(b"BINARY") {
            return Err(Fault::at(
                number,
                "this is a binary OFF file, which Outsight does not read; convert it to PLY",
            ));
        }
        let mut counts = text::words(line).map(|word| {
            let count = text::integer(word).and_then(|n| usize::try_from(n).ok());
            count.ok_or_else(|| Fault::at(number, format!("expected a count, found {}", show(word))))
        });
        let mut next = || counts.next().unwrap_or_else(|| Err(Fault::at(number, "an OFF file begins with its counts")));
        Ok((next()?, next()?))
    }

    fn read_vertices(&mut self, count: usize, soup: &mut Soup) -> Result<(), Fault> {
        self.kind.dropped(soup);
        for row in 0..count {
            let (number, line) = self.next_line().ok_or_else(|| self.truncated(count, "vertices", row))?;
            let mut words = text::words(line);
            soup.positions.push(text::position(&mut words, number)?);
            // Some programs write colours without saying so in the header.
            if self.kind.is_plain() && words.next().is_some() {
                soup.dropped.insert(Dropped::Colours);
            }
        }
        Ok(())
    }

    /// Each `n v1 … vn`, perhaps with a colour behind.
    fn read_polygons(&mut self, count: usize, vertices: usize, soup: &mut Soup) -> Result<(), Fault> {
        let mut corners = Vec::new();
        for row in 0..count {
            let (number, line) = self.next_line().ok_or_else(|| self.truncated(count, "triangles", row))?;
            let mut words = text::words(line);
            let n = text::integer(words.next().unwrap_or_default()).and_then(|n| usize::try_from(n).ok());
            let n = n.ok_or_else(|| Fault::at(number, "a triangle begins with its number of corners"))?;
            corners.clear();
            for word in words.by_ref().take(n) {
                corners.push(corner(word, row, vertices).map_err(|message| Fault::at(number, message))?);
            }
            if corners.len() < n {
                return Err(Fault::at(number, format!("triangle {row} has {} corners of {n}", corners.len())));
            }
            if !soup.polygons.push(&corners).map_err(|message| Fault::at(number, message))? {
                soup.dropped.insert(Dropped::PointsAndLines);
            }
            if words.next().is_some() {
                soup.dropped.insert(Dropped::Colours);
            }
        }
        Ok(())
    }

    fn truncated(&self, promised: usize, noun: &str, rows: usize) -> Fault {
        Fault::new(format!(
            "the header promises {promised} {noun}, the file ends after {rows} (line {}, byte {}); is it truncated?",
            self.last_line, self.file_bytes
        ))
    }
}

fn corner(word: &[u8], row: usize, vertices: usize) -> Result<u32, String> {
    let index = text::integer(word).ok_or_else(|| format!("expected the number of a vertex, found {}", show(word)))?;
    u32::try_from(index).ok().filter(|&i| (i as usize) < vertices).ok_or_else(|| {
        format!("triangle {row} uses vertex {index}, but the file has {vertices} vertices (counted from 0)")
    })
}
