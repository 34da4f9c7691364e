//! Values of flags: sizes, ratios, directions. Each message says what was probably meant.

use std::time::Duration;

use outsight::error::short_number;

/// One level of detail as `--lods` names it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LevelSize {
    /// A share of the triangles, in (0, 1].
    Ratio(f64),
    /// A number of triangles.
    Triangles(usize),
}

/// A size in bytes: `2G`, `500M`, `1.5GiB`, `1000000`. A unit is a power of 1024.
pub fn bytes(text: &str) -> Result<u64, String> {
    let form = "write a size as 2G or 500M";
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let number: f64 = digits.parse().map_err(|_| form.to_owned())?;
    let unit: f64 = match text[digits.len()..].to_ascii_lowercase().as_str() {
        "" | "b" => 1.0,
        "k" | "kb" | "kib" => 1024.0,
        "m" | "mb" | "mib" => 1024.0 * 1024.0,
        "g" | "gb" | "gib" => 1024.0 * 1024.0 * 1024.0,
        "t" | "tb" | "tib" => 1024.0 * 1024.0 * 1024.0 * 1024.0,
        other => return Err(format!("'{other}' is no unit of size; {form}")),
    };
    let bytes = number * unit;
    // The cast saturates, and a limit beyond 2^64 bytes is no limit.
    if bytes >= 1.0 { Ok(bytes as u64) } else { Err(format!("must be at least one byte; {form}")) }
}

/// A time limit in seconds, above 0.
pub fn seconds(text: &str) -> Result<Duration, String> {
    let form = "write seconds as 90 or 0.5";
    let number: f64 = text.parse().map_err(|_| form.to_owned())?;
    if number > 0.0 { Duration::try_from_secs_f64(number).map_err(|_| form.to_owned()) } else { Err(form.to_owned()) }
}

/// A number of threads: beyond some, they cost more than they do.
pub fn threads(text: &str) -> Result<usize, String> {
    const MOST: usize = 1024;
    match text.parse() {
        Ok(count) if (1..=MOST).contains(&count) => Ok(count),
        _ => Err(format!("threads are a number from 1 to {MOST}")),
    }
}

/// A number of triangles, at least 1.
pub fn triangles(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(0) => Err("a mesh needs at least 1 triangle".to_owned()),
        Ok(number) => Ok(number),
        Err(_) if is_share(text) => {
            Err(format!("is no whole number; for a share of the triangles write --ratio {text}"))
        }
        Err(_) => Err("write a whole number, at least 1".to_owned()),
    }
}

/// A ratio, in (0, 1].
pub fn ratio(text: &str) -> Result<f64, String> {
    let meaning = "a ratio is triangles kept ÷ given, above 0 and at most 1";
    if let Some(percent) = text.strip_suffix('%').and_then(|p| p.parse::<f64>().ok()) {
        let [percent, share] = [percent, percent / 100.0].map(short_number);
        return Err(format!("{meaning}; for {percent} % write --ratio {share}"));
    }
    let number: f64 = text.parse().map_err(|_| meaning.to_owned())?;
    if number > 0.0 && number <= 1.0 {
        Ok(number)
    } else if number > 1.0 && number <= 100.0 {
        Err(format!("{meaning}; for {number} % write --ratio {}", number / 100.0))
    } else if (100.0..1e15).contains(&number) {
        Err(format!("{meaning}; for {} triangles write --triangles {}", number.trunc(), number.trunc()))
    } else {
        Err(meaning.to_owned())
    }
}

/// A share of the triangles, in (0, 1).
pub fn share(text: &str) -> Result<f64, String> {
    let meaning = "a level is a share of the triangles, above 0 and below 1";
    match text.strip_suffix('%').unwrap_or(text).parse::<f64>() {
        Ok(number) if is_share(text) => Ok(number),
        Ok(percent) if (1.0..100.0).contains(&percent) => {
            Err(format!("{meaning}; for {percent} % write {}", short_number(percent / 100.0)))
        }
        _ => Err(meaning.to_owned()),
    }
}

fn is_share(text: &str) -> bool {
    text.parse::<f64>().is_ok_and(|n| n > 0.0 && n < 1.0)
}

/// One level of `--lods`: a ratio up to 1, or a whole number of triangles from 2.
pub fn level_size(text: &str) -> Result<LevelSize, String> {
    match text.parse::<usize>() {
        Ok(number) if number >= 2 => Ok(LevelSize::Triangles(number)),
        _ => {
            let message = "write each level as a ratio up to 1 or as a number of triangles from 2";
            ratio(text).map(LevelSize::Ratio).map_err(|_| message.to_owned())
        }
    }
}

/// A length in model units, finite and above 0.
pub fn length(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|n: &f64| n.is_finite() && *n > 0.0);
    number.ok_or_else(|| "write a length in model units, above 0".to_owned())
}

/// A finite number, at least 0.
pub fn non_negative(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|n: &f64| n.is_finite() && *n >= 0.0);
    number.ok_or_else(|| "write a number, at least 0".to_owned())
}

/// A standard error of a visibility, above 0 and below 1.
pub fn standard_error(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|n: &f64| *n > 0.0 && *n < 1.0);
    number.ok_or_else(|| "write a standard error above 0 and below 1, as 0.001".to_owned())
}

/// A direction `x,y,z` of any length but 0.
pub fn direction(text: &str) -> Result<[f64; 3], String> {
    let form = "write a direction as x,y,z, such as 1,1,0.5; 0,0,0 is none";
    let numbers: Vec<f64> = text.split(',').map(|n| n.trim().parse()).collect::<Result<_, _>>().map_err(|_| form)?;
    let xyz = <[f64; 3]>::try_from(numbers).map_err(|_| form)?;
    let usable = xyz.iter().all(|c| c.is_finite() && c.abs() < 1e100) && xyz.iter().any(|c| c.abs() > 1e-100);
    if usable { Ok(xyz) } else { Err(form.to_owned()) }
}

/// A direction `x,y,z` of all, or of one as `NAME=x,y,z`.
pub fn direction_of(text: &str) -> Result<(Option<String>, [f64; 3]), String> {
    match text.rsplit_once('=') {
        Some(("", _)) => Err("write NAME=x,y,z, or x,y,z for all".to_owned()),
        Some((name, xyz)) => Ok((Some(name.to_owned()), direction(xyz)?)),
        None => Ok((None, direction(text)?)),
    }
}

/// A side: `+y`, `-z`, or a direction `x,y,z`.
pub fn side(text: &str) -> Result<[f64; 3], String> {
    let sign = match text.as_bytes().first() {
        Some(b'+') => 1.0,
        Some(b'-') => -1.0,
        _ => 0.0,
    };
    match (sign, text.get(1..)) {
        (1.0 | -1.0, Some("x")) => Ok([sign, 0.0, 0.0]),
        (1.0 | -1.0, Some("y")) => Ok([0.0, sign, 0.0]),
        (1.0 | -1.0, Some("z")) => Ok([0.0, 0.0, sign]),
        _ => direction(text).map_err(|_| "write a side as +y or -z, or as a direction x,y,z".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_read_as_people_write_them() {
        assert_eq!(bytes("2G"), Ok(2 << 30));
        assert_eq!(bytes("500M"), Ok(500 << 20));
        assert_eq!(bytes("1.5kib"), Ok(1536));
        assert_eq!(bytes("77"), Ok(77));
        for wrong in ["", "G", "-1G", "0", "2X", "nan", "2 G"] {
            assert!(bytes(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn ratio_above_one_says_what_was_meant() {
        assert_eq!(ratio("0.05"), Ok(0.05));
        assert_eq!(ratio("1"), Ok(1.0));
        assert!(ratio("5").is_err_and(|m| m.ends_with("for 5 % write --ratio 0.05")));
        assert!(ratio("5%").is_err_and(|m| m.ends_with("for 5 % write --ratio 0.05")));
        assert!(ratio("5000").is_err_and(|m| m.ends_with("write --triangles 5000")));
        for wrong in ["0", "-0.1", "nan", "inf", "x"] {
            assert!(ratio(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn shares_lie_between_none_and_all() {
        assert_eq!(share("0.0078125"), Ok(0.007_812_5));
        for percent in ["1.5", "1.5%"] {
            assert!(share(percent).is_err_and(|m| m.ends_with("for 1.5 % write 0.015")), "{percent}");
        }
        assert!(share("1").is_err_and(|m| m.ends_with("for 1 % write 0.01")));
        for wrong in ["0", "-0.1", "100", "nan", "inf", "0.5x", ""] {
            assert!(share(wrong).is_err_and(|m| m.ends_with("below 1")), "{wrong}");
        }
    }

    #[test]
    fn standard_errors_lie_between_zero_and_one() {
        assert_eq!(standard_error("1e-3"), Ok(0.001));
        assert!(["0", "1", "-0.1", "nan", "inf", "x"].into_iter().all(|text| standard_error(text).is_err()));
    }

    #[test]
    fn zero_triangles_and_shares_are_no_counts() {
        assert_eq!(triangles("7"), Ok(7));
        assert!(triangles("0").is_err());
        assert!(triangles("0.5").is_err_and(|m| m.contains("--ratio 0.5")));
    }

    #[test]
    fn levels_are_ratios_or_counts() {
        assert_eq!(level_size("0.5"), Ok(LevelSize::Ratio(0.5)));
        assert_eq!(level_size("1"), Ok(LevelSize::Ratio(1.0)));
        assert_eq!(level_size("5000"), Ok(LevelSize::Triangles(5000)));
        assert!(level_size("1.5").is_err());
    }

    #[test]
    fn threads_are_bounded() {
        assert_eq!((threads("1"), threads("1024")), (Ok(1), Ok(1024)));
        assert!(["0", "1025", "100000", "-1", "two"].into_iter().all(|text| threads(text).is_err()));
    }

    #[test]
    fn directions_need_three_numbers_and_a_length() {
        assert_eq!(direction("1, 0,-2"), Ok([1.0, 0.0, -2.0]));
        for wrong in ["", "1,2", "0,0,0", "1,2,3,4", "nan,0,1", "1,,2"] {
            assert!(direction(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn directions_are_of_all_or_of_one() {
        assert_eq!(direction_of("0,1,0"), Ok((None, [0.0, 1.0, 0.0])));
        assert_eq!(direction_of("a=b=0,1,0"), Ok((Some("a=b".to_owned()), [0.0, 1.0, 0.0])));
        for wrong in ["=0,1,0", "a=", "a=0,0,0", "a"] {
            assert!(direction_of(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn sides_are_axes_with_a_sign_or_directions() {
        assert_eq!(side("+y"), Ok([0.0, 1.0, 0.0]));
        assert_eq!(side("-z"), Ok([0.0, 0.0, -1.0]));
        assert_eq!(side("-1,0,2"), Ok([-1.0, 0.0, 2.0]));
        for wrong in ["", "y", "+", "+w", "0,0,0", "+é"] {
            assert!(side(wrong).is_err(), "{wrong}");
        }
    }
}
