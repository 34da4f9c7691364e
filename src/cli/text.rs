//! Numbers and tables as people read them.

use outsight::report::table::{Table, thousands};

/// Bytes in a MiB.
const MIB: f64 = 1024.0 * 1024.0;

/// A count with its thousands set apart: `871,414`.
pub fn count(number: usize) -> String {
    thousands(number as u64)
}

/// Bytes in the unit that leaves the fewest digits.
pub fn memory(bytes: u64) -> String {
    match bytes as f64 / MIB {
        mib if mib >= 1024.0 => format!("{:.1} GiB", mib / 1024.0),
        mib if mib >= 1.0 => format!("{mib:.0} MiB"),
        mib if bytes >= 1024 => format!("{:.0} KiB", mib * 1024.0),
        _ => format!("{bytes} bytes"),
    }
}

/// Seconds with as many digits as anyone wants to know.
pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 0.1 => format!("{s:.3} s"),
        s if s < 10.0 => format!("{s:.2} s"),
        s if s < 120.0 => format!("{s:.0} s"),
        s => format!("{:.0} min", s / 60.0),
    }
}

/// A length with four digits that matter: `47.97`, `0.001234`, `1.234e-9`.
pub fn significant(length: f64) -> String {
    if length == 0.0 {
        return "0".to_owned();
    }
    if !(1e-4..1e6).contains(&length.abs()) {
        return format!("{length:.3e}");
    }
    let digits_before = length.abs().log10().floor() as i32;
    let digits_behind = usize::try_from(3 - digits_before).unwrap_or(0);
    format!("{length:.digits_behind$}")
}

/// Lines of a name and what belongs to it, the second column aligned.
pub fn pairs(rows: &[(&str, String)]) -> String {
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    rows.iter().map(|(name, value)| format!("{name:width$}  {value}\n")).collect()
}

/// A table of these heads and rows: the first column to the left, all others to the right.
pub fn table(heads: &[&str], rows: &[Vec<String>]) -> String {
    let empty = Table::new(heads.iter().copied());
    rows.iter().fold(empty, |table, row| table.row(row.iter().map(String::as_str))).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_never_none() {
        let shown = [1, 1023, 1024, 1 << 20, 3 << 29].map(memory);
        assert_eq!(shown, ["1 bytes", "1023 bytes", "1 KiB", "1 MiB", "1.5 GiB"]);
    }

    #[test]
    fn lengths_keep_four_digits() {
        let shown = [0.0, 47.971, 0.001_234_5, 123_456.7, 1.234e-9, 2.5e9].map(significant);
        assert_eq!(shown, ["0", "47.97", "0.001234", "123457", "1.234e-9", "2.500e9"]);
    }
}
