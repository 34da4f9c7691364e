//! Plain text tables: aligned columns, no lines drawn.

use std::fmt;

/// Spaces between two columns.
const GAP: &str = "   ";

/// A table that prints as aligned columns: the first to the left, the others, taken for numbers, to the right.
///
/// # Examples
/// ```
/// use outsight::report::table::{Table, thousands};
///
/// let table = Table::new(["method", "triangles", "image RMSE"])
///     .units(["", "", "grey levels"])
///     .row(["quadric".to_owned(), thousands(5517), "17.4".to_owned()])
///     .row(["visibility".to_owned(), thousands(5517), "11.9".to_owned()]);
/// assert_eq!(table.to_string(), "\
/// method       triangles    image RMSE
///                          grey levels
/// ----------   ---------   -----------
/// quadric          5,517          17.4
/// visibility       5,517          11.9
/// ");
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Table {
    headers: Vec<String>,
    units: Option<Vec<String>>,
    rows: Vec<Vec<String>>,
    left_aligned: Vec<usize>,
}

impl Table {
    /// A table with these headings and no rows.
    #[must_use]
    pub fn new<S: Into<String>>(headers: impl IntoIterator<Item = S>) -> Self {
        Self { headers: strings(headers), left_aligned: vec![0], ..Self::default() }
    }

    /// With a second line of headings, for units.
    #[must_use]
    pub fn units<S: Into<String>>(self, units: impl IntoIterator<Item = S>) -> Self {
        Self { units: Some(strings(units)), ..self }
    }

    /// With one more row. Missing cells are empty, further ones get a column without heading.
    #[must_use]
    pub fn row<S: Into<String>>(mut self, cells: impl IntoIterator<Item = S>) -> Self {
        self.rows.push(strings(cells));
        self
    }

    /// With column `column`, counted from 0, aligned to the left: text, not numbers.
    #[must_use]
    pub fn left(mut self, column: usize) -> Self {
        self.left_aligned.push(column);
        self
    }

    /// The headings, each with its unit in brackets.
    #[must_use]
    pub fn heads(&self) -> Vec<String> {
        let unit = |column: usize| self.units.as_ref().and_then(|units| units.get(column)).filter(|u| !u.is_empty());
        let with_unit = |(column, head): (usize, &String)| match unit(column) {
            Some(unit) => format!("{head} ({unit})"),
            None => head.clone(),
        };
        self.headers.iter().enumerate().map(with_unit).collect()
    }

    /// The rows, a cell for each heading.
    #[must_use]
    pub fn rows(&self) -> &[Vec<String>] {
        &self.rows
    }

    /// The table as GitHub writes it, columns aligned as here.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        let line = |cells: &[String]| {
            let escaped: Vec<String> = cells.iter().map(|cell| markdown(cell)).collect();
            format!("| {} |\n", escaped.join(" | "))
        };
        let is_left = |column: usize| self.left_aligned.contains(&column);
        let rule = (0..self.headers.len()).map(|column| if is_left(column) { "---" } else { "---:" });
        let rule: Vec<String> = rule.map(str::to_owned).collect();
        let rows: String = self.rows.iter().map(|row| line(row)).collect();
        format!("{}{}{rows}", line(&self.heads()), line(&rule))
    }

    /// All lines of text, the headings' included.
    fn lines(&self) -> impl Iterator<Item = &Vec<String>> {
        std::iter::once(&self.headers).chain(&self.units).chain(&self.rows)
    }

    /// Width of each column, in characters.
    fn widths(&self) -> Vec<usize> {
        let columns = self.lines().map(Vec::len).max().unwrap_or(0);
        let width_of =
            |column: usize| self.lines().filter_map(|line| line.get(column)).map(|cell| cell.chars().count()).max();
        (0..columns).map(|column| width_of(column).unwrap_or(0)).collect()
    }

    fn write_line(&self, f: &mut fmt::Formatter, cells: &[String], widths: &[usize]) -> fmt::Result {
        let aligned = widths.iter().enumerate().map(|(column, &width)| {
            let cell = cells.get(column).map_or("", String::as_str);
            if self.left_aligned.contains(&column) { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        let line = aligned.collect::<Vec<_>>().join(GAP);
        writeln!(f, "{}", line.trim_end())
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let widths = self.widths();
        let rule: Vec<_> = widths.iter().map(|&width| "-".repeat(width)).collect();
        self.write_line(f, &self.headers, &widths)?;
        self.units.iter().try_for_each(|units| self.write_line(f, units, &widths))?;
        self.write_line(f, &rule, &widths)?;
        self.rows.iter().try_for_each(|row| self.write_line(f, row, &widths))
    }
}

fn strings<S: Into<String>>(cells: impl IntoIterator<Item = S>) -> Vec<String> {
    cells.into_iter().map(Into::into).collect()
}

/// Text as Markdown shows it to be: nothing in it is markup, a bar or the end of a line.
#[must_use]
pub fn markdown(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '|' | '`' | '[' | ']' | '\\' => safe.extend(['\\', letter]),
            _ if letter.is_control() => safe.push(' '),
            _ => safe.push(letter),
        }
    }
    safe
}

/// A whole number with a comma every three digits: `1,234,567`.
#[must_use]
pub fn thousands(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_set_off_by_commas() {
        let cases = [(0, "0"), (999, "999"), (1000, "1,000"), (65_536, "65,536"), (1_234_567, "1,234,567")];
        for (number, text) in cases {
            assert_eq!(thousands(number), text);
        }
        assert_eq!(thousands(u64::MAX), "18,446,744,073,709,551,615");
    }

    #[test]
    fn short_rows_are_filled_and_long_rows_make_columns() {
        let table = Table::new(["a", "b"]).row(["x"]).row(["y", "1", "22"]);
        assert_eq!(table.to_string(), "a   b\n-   -   --\nx\ny   1   22\n");
    }

    #[test]
    fn letters_count_not_bytes() {
        let table = Table::new(["ü", "n"]).row(["öö", "1"]);
        assert_eq!(table.to_string(), "ü    n\n--   -\nöö   1\n");
    }

    #[test]
    fn a_column_can_be_aligned_to_the_left() {
        let table = Table::new(["n", "file"]).left(1).row(["1", "a"]);
        assert_eq!(table.to_string(), "n   file\n-   ----\n1   a\n");
    }

    #[test]
    fn markdown_keeps_columns_apart_whatever_stands_in_them() {
        let table = Table::new(["name", "n"]).units(["", "s"]).row(["a|b", "1"]);
        assert_eq!(table.to_markdown(), "| name | n (s) |\n| --- | ---: |\n| a\\|b | 1 |\n");
    }

    #[test]
    fn markdown_shows_hostile_names_and_runs_none() {
        let table = Table::new(["name", "n"]).row(["<img src=x>\n[a](b)`c`&\\", "1"]);
        let shown = "| &lt;img src=x&gt; \\[a\\](b)\\`c\\`&amp;\\\\ | 1 |\n";
        assert_eq!(table.to_markdown(), format!("| name | n |\n| --- | ---: |\n{shown}"));
    }

    #[test]
    fn a_table_of_nothing_is_two_empty_lines() {
        assert_eq!(Table::default().to_string(), "\n\n");
    }
}
