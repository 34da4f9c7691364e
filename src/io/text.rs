//! Lines, words and numbers of the text formats.

use super::fault::Fault;

/// Lines of a file with their numbers from 1; the line end, `\n` or `\r\n`, is cut off.
#[derive(Debug, Clone)]
pub(super) struct Lines<'a> {
    rest: &'a [u8],
    number: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: without_mark(bytes), number: 0 }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (usize, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let (line, rest) = split_line(self.rest, b'\n');
        self.rest = rest;
        self.number += 1;
        Some((self.number, line.strip_suffix(b"\r").unwrap_or(line)))
    }
}

/// The bytes before the first `end`, and those behind it.
pub(super) fn split_line(bytes: &[u8], end: u8) -> (&[u8], &[u8]) {
    match bytes.iter().position(|&b| b == end) {
        Some(at) => (&bytes[..at], &bytes[at + 1..]),
        None => (bytes, &[]),
    }
}

/// Words of a line, separated by blanks.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// The bytes from the first that is not blank, a byte-order mark put aside.
pub(super) fn skip_blank(bytes: &[u8]) -> &[u8] {
    without_mark(bytes).trim_ascii_start()
}

fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// Words of a file across its lines, with the line of the last one.
#[derive(Debug)]
pub(super) struct Words<'a> {
    rest: &'a [u8],
    line: usize,
}

impl<'a> Words<'a> {
    /// Words of `bytes`, whose first line has the number `line`.
    pub(super) fn new(bytes: &'a [u8], line: usize) -> Self {
        Self { rest: bytes, line }
    }

    /// Line of the last word, from 1; at the end of the file, its last line.
    pub(super) fn line(&self) -> usize {
        self.line
    }

    /// The bytes not yet read.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.rest
    }

    /// The next word, if it stands in the current line.
    pub(super) fn next_in_line(&mut self) -> Option<&'a [u8]> {
        let blank = self.rest.iter().take_while(|&&b| b != b'\n' && b.is_ascii_whitespace()).count();
        self.rest = &self.rest[blank..];
        if self.rest.first() == Some(&b'\n') { None } else { self.next() }
    }

    /// The rest of the current line, its end taken off.
    pub(super) fn rest_of_line(&mut self) -> &'a [u8] {
        let end = self.rest.iter().position(|&b| b == b'\n').unwrap_or(self.rest.len());
        let (line, rest) = self.rest.split_at(end);
        self.rest = rest;
        line.trim_ascii()
    }
}

impl<'a> Iterator for Words<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let start = self.rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(self.rest.len());
        let (blank, rest) = self.rest.split_at(start);
        self.line += blank.iter().filter(|&&b| b == b'\n').count();
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        let (word, rest) = rest.split_at(end);
        self.rest = rest;
        if word.is_empty() { None } else { Some(word) }
    }
}

/// A coordinate: a finite number.
pub(super) fn coordinate(word: &[u8], line: usize) -> Result<f64, Fault> {
    let number = std::str::from_utf8(word).ok().and_then(|w| w.parse::<f64>().ok());
    match number {
        Some(number) if number.is_finite() => Ok(number),
        Some(_) => Err(Fault::at(line, format!("the coordinate {} is not finite", show(word)))),
        None => Err(Fault::at(line, format!("expected a coordinate, found {}", show(word)))),
    }
}

/// Three coordinates from the front of `words`.
pub(super) fn position<'a>(words: &mut impl Iterator<Item = &'a [u8]>, line: usize) -> Result<glam::DVec3, Fault> {
    let mut next = || {
        let word = words.next().ok_or_else(|| Fault::at(line, "a vertex needs three coordinates"))?;
        coordinate(word, line)
    };
    Ok(glam::DVec3::new(next()?, next()?, next()?))
}

/// A whole number.
pub(super) fn integer(word: &[u8]) -> Option<i64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// A word as a message quotes it: short and printable.
pub(super) fn show(word: &[u8]) -> String {
    const LONGEST: usize = 40;
    let cut = &word[..word.len().min(LONGEST)];
    let dots = if word.len() > LONGEST { "…" } else { "" };
    format!("`{}{dots}`", cut.escape_ascii())
}
