use std::path::Path;

use glam::DVec3;

use super::fault::Fault;
use super::format::FileName;
use super::source;
use super::text::{self, Lines};
use crate::error::{Error, Result, short_number};

/// Cameras that may be listed: as many as can look.
const MOST: usize = 65_536;

/// So many cameras take a few MiB.
const MOST_BYTES: u64 = 64 << 20;

/// Reads a list of cameras: directions from the object toward each, with a weight, 1 where the file gives none.
///
/// One camera a line: `x y z` or `x y z weight`, separated by blanks, commas or semicolons; what follows a `#` is a
/// comment. A first line of names, as tables have, is passed over. `-` is standard input.
///
/// # Errors
/// [`crate::Error::Read`]; [`crate::Error::Parse`], with the line, for a camera without direction, a number that is none or
/// not finite, a weight not above 0; and for a file of fewer than two cameras or more than 65,536.
pub fn read_cameras(path: &Path) -> Result<Vec<(DVec3, f64)>> {
    let name = FileName::of(path);
    let bytes = source::read_all(path, &name, Some(MOST_BYTES)).map_err(|error| match error {
        Error::Limit { .. } => Fault::new(format!("a list of cameras has at most {MOST} in 64 MiB")).named(&name.shown),
        other => other,
    })?;
    parse(&bytes).map_err(|fault| fault.named(&name.shown))
}

fn parse(bytes: &[u8]) -> std::result::Result<Vec<(DVec3, f64)>, Fault> {
    let mut cameras = Vec::new();
    let mut is_first = true;
    for (number, line) in Lines::new(bytes) {
        let content = line.split(|&b| b == b'#').next().unwrap_or_default();
        let is_blank = |b: &u8| b.is_ascii_whitespace() || *b == b',' || *b == b';';
        let words: Vec<&[u8]> = content.split(is_blank).filter(|word| !word.is_empty()).collect();
        if words.is_empty() {
            continue;
        }
        if !(is_first && is_heading(&words)) {
            cameras.push(camera(&words, number)?);
            if cameras.len() > MOST {
                return Err(Fault::at(number, format!("this is camera {}; at most {MOST} can look", cameras.len())));
            }
        }
        is_first = false;
    }
    match cameras.len() {
        0 => Err(Fault::new("no cameras; write one a line, as x y z, from the mesh toward the camera")),
        1 => Err(Fault::new("a single camera sees one side; give two or more")),
        _ => Ok(cameras),
    }
}

/// Whether a line names columns: words that begin with letters, and are no numbers such as `nan`.
fn is_heading(words: &[&[u8]]) -> bool {
    let is_name = |word: &&[u8]| {
        let text = std::str::from_utf8(word).unwrap_or_default().trim_matches('"');
        text.starts_with(|c: char| c.is_ascii_alphabetic()) && text.parse::<f64>().is_err()
    };
    (3..=4).contains(&words.len()) && words.iter().all(is_name)
}

fn camera(words: &[&[u8]], line: usize) -> std::result::Result<(DVec3, f64), Fault> {
    if !(3..=4).contains(&words.len()) {
        let message = format!("a camera is x y z, or x y z weight; found {} words", words.len());
        return Err(Fault::at(line, message));
    }
    let numbers =
        words.iter().map(|word| text::coordinate(word, line)).collect::<std::result::Result<Vec<f64>, _>>()?;
    let direction = DVec3::new(numbers[0], numbers[1], numbers[2]);
    // Scaled first, so that very short and very long ones keep their direction.
    let Some(unit) = (direction / direction.abs().max_element()).try_normalize() else {
        return Err(Fault::at(line, "0 0 0 is no direction; a camera stands away from the mesh"));
    };
    let weight = numbers.get(3).copied().unwrap_or(1.0);
    if weight > 0.0 {
        Ok((unit, weight))
    } else {
        Err(Fault::at(line, format!("the weight {} is not above 0", short_number(weight))))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn message(text: &str) -> String {
        parse(text.as_bytes()).unwrap_err().named("c.txt").to_string()
    }

    #[test]
    fn blanks_commas_comments_and_a_heading_are_understood() {
        let expected = [(DVec3::X, 1.0), (DVec3::NEG_Y, 2.5)];
        for text in [
            "1 0 0\n0 -2 0 2.5\n",
            "# a ring\n\n1,0,0 # front\r\n0,-1e-300,0,2.5",
            "x,y,z,weight\n1e300,0,0,1\n0,-1,0,2.5\n",
            "\"x\";\"y\";\"z\"\n7; 0; 0\n0; -1; 0; 2.5",
        ] {
            assert_eq!(parse(text.as_bytes()).unwrap(), expected, "{text}");
        }
    }

    #[test]
    fn each_fault_is_told_with_its_line() {
        assert_eq!(
            message("1 0 0\n0 0 0\n"),
            "c.txt, line 2: 0 0 0 is no direction; a camera stands away from the mesh"
        );
        assert_eq!(message("1 0 0\n\n0 nan 1\n"), "c.txt, line 3: the coordinate `nan` is not finite");
        assert_eq!(message("nan nan nan\n1 0 0\n"), "c.txt, line 1: the coordinate `nan` is not finite");
        assert_eq!(message("1 0 0\nx y z\n"), "c.txt, line 2: expected a coordinate, found `x`");
        assert!(message("1 0\n").starts_with("c.txt, line 1: a camera is x y z"));
        assert!(message("1 0 0 1 1\n").starts_with("c.txt, line 1: a camera is x y z"));
        assert_eq!(message("1 0 0 0\n"), "c.txt, line 1: the weight 0 is not above 0");
        assert!(message("1 0 0 # alone\n").contains("a single camera"));
        assert!(message("").contains("no cameras"));
        assert!(message("# nothing\n").contains("no cameras"));
    }
}
