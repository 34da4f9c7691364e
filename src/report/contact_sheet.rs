//! Pictures side by side: columns are meshes and their differences, rows are views.

use super::colour::mix;
use super::legend;
use super::picture::{Area, FAINT, Font, LINE, Picture, TextStyle, WHITE};
use super::table::thousands;
use crate::error::{Error, Result};

/// Room around the sheet.
const MARGIN: u32 = 32;
/// Room between two images.
const GUTTER: u32 = 12;
/// Room between two lines of text of one block.
const LEADING: u32 = 3;
/// Room between blocks: title, headings, images, legend.
const BLOCK_GAP: u32 = 20;
/// Width of the difference legend, at most.
const LEGEND_WIDTH: u32 = 320;

/// Difference in grey levels that is drawn in full red, unless a sheet asks for another.
pub const FULL_RED: f32 = 64.0;

/// Colour of a difference of [`ContactSheet::full_red`] and more.
pub const RED: [u8; 3] = [222, 0, 0];

const TITLE: TextStyle = TextStyle { font: Font::Large, scale: 1, colour: super::picture::INK };
const HEADING: TextStyle = TextStyle { font: Font::Bold, scale: 1, colour: super::picture::INK };
const QUIET: TextStyle = TextStyle { font: Font::Small, scale: 1, colour: FAINT };

/// What is drawn where nothing was hit, that is where a grey level is exactly 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Background {
    /// White, as the paper around the image. Differences are always those of the levels as they are.
    #[default]
    White,
    /// Black, as the image error sees it.
    Black,
}

/// The images of a column, one per row: grey levels from 0 to 255, rows from the top, pixels from the left.
#[derive(Debug, Clone)]
pub enum Images<'a> {
    /// Shown as they are.
    Shaded(Vec<&'a [f32]>),
    /// Reference and test, shown as their difference: white where they are equal, red where they are not.
    Difference(Vec<[&'a [f32]; 2]>),
}

/// A column of a contact sheet.
#[derive(Debug, Clone)]
pub struct Column<'a> {
    /// One line above the column: which mesh.
    pub heading: String,
    /// Numbers below the heading; broken into lines as needed, and at each `\n`.
    pub caption: String,
    /// What is shown.
    pub images: Images<'a>,
}

/// Images of equal size in columns and rows, with titles and captions.
#[derive(Debug, Clone)]
pub struct ContactSheet<'a> {
    /// One line at the top, empty for none.
    pub title: String,
    /// Text below the title, empty for none; broken into lines as needed.
    pub subtitle: String,
    /// Width and height of every image, in pixels.
    pub image_size: [u32; 2],
    /// From the left.
    pub columns: Vec<Column<'a>>,
    /// From the top, left of each row; none, or one per row.
    pub row_captions: Vec<String>,
    /// What is drawn where nothing was hit.
    pub background: Background,
    /// Difference in grey levels that is drawn in full red, above 0; smaller ones are paler in proportion.
    pub full_red: f32,
}

impl Default for ContactSheet<'_> {
    fn default() -> Self {
        Self {
            title: String::new(),
            subtitle: String::new(),
            image_size: [0, 0],
            columns: Vec::new(),
            row_captions: Vec::new(),
            background: Background::White,
            full_red: FULL_RED,
        }
    }
}

impl Images<'_> {
    fn row_count(&self) -> usize {
        match self {
            Self::Shaded(rows) => rows.len(),
            Self::Difference(rows) => rows.len(),
        }
    }
}

/// The caption under a mesh's heading: its triangles and, for a test, its image error in grey levels.
#[must_use]
pub fn mesh_caption(triangles: usize, image_rmse: Option<f64>) -> String {
    let count = format!("{} triangles", thousands(triangles as u64));
    image_rmse.map_or(count.clone(), |error| format!("{count} · image\u{a0}RMSE\u{a0}{error:.1}"))
}

impl ContactSheet<'_> {
    /// Draws the sheet.
    ///
    /// # Errors
    /// [`Error::ShapeMismatch`] if columns or captions differ in their number of rows or an image in its size,
    /// [`Error::Option`] for a `full_red` that is not above 0.
    pub fn draw(&self) -> Result<Picture> {
        self.check()?;
        let layout = Layout::of(self);
        let mut sheet = Picture::filled(layout.width, layout.height, WHITE);
        write_lines(&mut sheet, &layout.title, MARGIN, MARGIN);
        for (column, content) in self.columns.iter().enumerate() {
            write_lines(&mut sheet, &layout.headings[column], layout.column_left(column), layout.headings_top);
            for row in 0..layout.rows {
                let (left, top) = (layout.column_left(column), layout.row_top(row));
                let [width, height] = self.image_size;
                sheet.frame(Area { left, top, width, height }, LINE);
                sheet.blit(&self.image(&content.images, row)?, left, top);
            }
        }
        for (row, caption) in self.row_captions.iter().enumerate() {
            let middle = layout.row_top(row) + self.image_size[1].saturating_sub(QUIET.height()) / 2;
            sheet.text(caption, MARGIN, middle, QUIET);
        }
        if let Some(key) = self.difference_key(&layout) {
            // The key's bar begins at the left edge of the first difference column, where there is room for it.
            let column = self.columns.iter().position(|c| matches!(c.images, Images::Difference(_))).unwrap_or(0);
            let left = layout.column_left(column) - legend::SIDE;
            let left = left.min(layout.width.saturating_sub(MARGIN / 2 + key.width()));
            sheet.blit(&key, left, layout.key_top());
        }
        Ok(sheet)
    }

    fn check(&self) -> Result<()> {
        let rows = self.columns.first().map_or(0, |c| c.images.row_count());
        let length = self.image_size[0] as usize * self.image_size[1] as usize;
        let expect = |what, got, expected| {
            if got == expected { Ok(()) } else { Err(Error::ShapeMismatch { what, got, expected }) }
        };
        for column in &self.columns {
            expect("column of the contact sheet", column.images.row_count(), rows)?;
            match &column.images {
                Images::Shaded(images) => images.iter().try_for_each(|i| expect("image", i.len(), length))?,
                Images::Difference(pairs) => {
                    pairs.iter().flatten().try_for_each(|i| expect("image", i.len(), length))?;
                }
            }
        }
        if !self.row_captions.is_empty() {
            expect("row captions", self.row_captions.len(), rows)?;
        }
        if self.full_red > 0.0 {
            return Ok(());
        }
        Err(Error::Option { name: "full_red", message: format!("{} is not above 0", self.full_red) })
    }

    fn image(&self, images: &Images, row: usize) -> Result<Picture> {
        let [width, height] = self.image_size;
        match images {
            Images::Shaded(rows) => Picture::from_values(width, height, rows[row], |level| {
                let is_background = level == 0.0 && self.background == Background::White;
                if is_background { WHITE } else { [level.round() as u8; 3] }
            }),
            Images::Difference(rows) => {
                let [reference, test] = rows[row];
                let differences: Vec<f32> = reference.iter().zip(test).map(|(a, b)| (a - b).abs()).collect();
                Picture::from_values(width, height, &differences, |d| self.red(d))
            }
        }
    }

    /// The colour of a difference in grey levels.
    fn red(&self, difference: f32) -> [u8; 3] {
        mix(WHITE, RED, f64::from((difference / self.full_red).clamp(0.0, 1.0)))
    }

    /// What the reds mean, if there are any.
    fn difference_key(&self, layout: &Layout) -> Option<Picture> {
        if !self.columns.iter().any(|c| matches!(c.images, Images::Difference(_))) {
            return None;
        }
        let level = |share: f32| format!("{}", share * self.full_red);
        let ticks = [(0.0, "0".to_owned()), (0.5, level(0.5)), (1.0, format!("{}+", level(1.0)))];
        let colour = |share: f64| self.red(share as f32 * self.full_red);
        let width = layout.image_size[0].min(LEGEND_WIDTH);
        Some(legend::gradient(colour, &ticks, "difference, grey levels", width))
    }
}

/// A line of text and how it looks.
type Line = (String, TextStyle);

/// Where everything goes.
struct Layout {
    image_size: [u32; 2],
    rows: usize,
    /// Title and subtitle.
    title: Vec<Line>,
    /// Heading and caption of each column.
    headings: Vec<Vec<Line>>,
    /// Left edge of the first column.
    left: u32,
    headings_top: u32,
    /// Upper edge of the first row.
    top: u32,
    width: u32,
    height: u32,
}

impl Layout {
    fn of(sheet: &ContactSheet) -> Self {
        let columns = sheet.columns.len() as u32;
        let rows = sheet.columns.first().map_or(0, |c| c.images.row_count());
        let captions = sheet.row_captions.iter().map(|c| QUIET.width_of(c)).max().unwrap_or(0);
        let left = if captions > 0 { MARGIN + captions + GUTTER } else { MARGIN };
        let images_width = columns * (sheet.image_size[0] + GUTTER);
        let width = left + images_width.saturating_sub(GUTTER).max(legend::MIN_WIDTH) + MARGIN;

        let title = text_block(&sheet.title, &sheet.subtitle, TITLE, width - 2 * MARGIN);
        let column_width = sheet.image_size[0];
        let headings: Vec<_> =
            sheet.columns.iter().map(|c| text_block(&c.heading, &c.caption, HEADING, column_width)).collect();
        let after = |top: u32, height: u32, gap: u32| if height > 0 { top + height + gap } else { top };
        let headings_top = after(MARGIN, height_of(&title), BLOCK_GAP);
        let headings_height = headings.iter().map(|lines| height_of(lines)).max().unwrap_or(0);
        let top = after(headings_top, headings_height, GUTTER);
        let layout =
            Self { image_size: sheet.image_size, rows, title, headings, left, headings_top, top, width, height: 0 };
        let bottom = match sheet.difference_key(&layout) {
            Some(key) => layout.key_top() + key.height(),
            None => layout.row_top(rows).saturating_sub(GUTTER),
        };
        Self { height: bottom + MARGIN, ..layout }
    }

    fn column_left(&self, column: usize) -> u32 {
        self.left + column as u32 * (self.image_size[0] + GUTTER)
    }

    fn row_top(&self, row: usize) -> u32 {
        self.top + row as u32 * (self.image_size[1] + GUTTER)
    }

    fn key_top(&self) -> u32 {
        self.row_top(self.rows) + BLOCK_GAP - GUTTER
    }
}

/// A heading and quiet text below it, broken into lines of at most `width` pixels.
fn text_block(heading: &str, text: &str, style: TextStyle, width: u32) -> Vec<Line> {
    let with = |text, style| broken_into_lines(text, style, width).into_iter().map(move |line| (line, style));
    with(heading, style).chain(with(text, QUIET)).collect()
}

/// Breaks text at spaces, but not at no-break spaces, so that each line fits; a word too long for a line is cut.
fn broken_into_lines(text: &str, style: TextStyle, width: u32) -> Vec<String> {
    let letters = (width / style.width_of(" ").max(1)).max(1) as usize;
    let mut lines = Vec::new();
    for paragraph in text.lines() {
        let mut line = String::new();
        for word in paragraph.split(' ').filter(|word| !word.is_empty()) {
            if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > letters {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.extend(word.chars().take(letters));
        }
        lines.push(line);
    }
    lines
}

fn height_of(lines: &[Line]) -> u32 {
    lines.iter().map(|(_, style)| style.height() + LEADING).sum()
}

fn write_lines(sheet: &mut Picture, lines: &[Line], left: u32, top: u32) {
    let mut top = top;
    for (line, style) in lines {
        sheet.text(line, left, top, *style);
        top += style.height() + LEADING;
    }
}

#[cfg(test)]
mod tests;
