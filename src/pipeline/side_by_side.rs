use glam::DVec3;

use crate::error::Result;
use crate::eval::{Gallery, Shot};
use crate::mesh::TriMesh;
use crate::pipeline::compare::views_around;
use crate::raster::GreyImage;
use crate::report::colour::mix;
use crate::report::contact_sheet::{Column, ContactSheet, FULL_RED, Images, RED, mesh_caption};
use crate::report::picture::{Area, Picture, WHITE};

/// Pixels along the side of a picture on the sheet.
const PICTURE_WIDTH: u32 = 400;

/// Meshes beside the one that they were made from, in three views, with what differs in red.
#[derive(Debug, Clone)]
pub struct SideBySide<'a> {
    /// One line at the top, empty for none.
    pub title: String,
    /// Text below the title, empty for none; broken into lines as needed.
    pub subtitle: String,
    /// What the others are compared with.
    pub reference: Portrait<'a>,
    /// The others.
    pub tests: Vec<Portrait<'a>>,
    /// Where the columns stand.
    pub order: ColumnOrder,
    /// Upward in the pictures, any length but 0.
    pub up: DVec3,
}

/// A mesh and what stands above its pictures.
#[derive(Debug, Clone)]
pub struct Portrait<'a> {
    /// One line.
    pub name: String,
    /// The mesh.
    pub mesh: &'a TriMesh,
    /// Its image error in grey levels; `None` for the reference.
    pub image_rmse: Option<f64>,
}

/// Order of the columns, from the left.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColumnOrder {
    /// Reference, then each test and its difference.
    #[default]
    ReferenceFirst,
    /// The reference between the first half of the tests and the rest, differences outside: as Zhang & Turk 2002, figure 5,
    /// has QB, original, VG.
    ReferenceBetween,
}

/// A picture and what it shows.
pub(super) struct Captioned {
    pub caption: String,
    pub picture: Picture,
}

/// The pictures of a sheet, taken.
pub(super) struct Taken<'a> {
    asked: &'a SideBySide<'a>,
    original: Pictures,
    others: Vec<Pictures>,
}

impl SideBySide<'_> {
    /// Draws the sheet.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] if a test is so much larger than the reference that it cannot be drawn beside it.
    pub fn draw(&self) -> Result<Picture> {
        self.take()?.sheet()
    }

    /// Takes all pictures.
    pub(super) fn take(&self) -> Result<Taken<'_>> {
        let up = self.up.normalize();
        let shots = views_around(up).map(|toward| Shot::fitting(self.reference.mesh, toward, up, PICTURE_WIDTH));
        let pictures = |portrait: &Portrait| Pictures::of(portrait.mesh, self.reference.mesh, &shots);
        let others = self.tests.iter().map(pictures).collect::<Result<_>>()?;
        Ok(Taken { asked: self, original: pictures(&self.reference)?, others })
    }
}

impl Taken<'_> {
    /// All views of all meshes, with words.
    pub fn sheet(&self) -> Result<Picture> {
        let SideBySide { title, subtitle, reference, tests, order, .. } = self.asked;
        let before = match order {
            ColumnOrder::ReferenceFirst => 0,
            ColumnOrder::ReferenceBetween => tests.len().div_ceil(2),
        };
        let mut columns = Vec::new();
        for (i, (portrait, pictures)) in tests.iter().zip(&self.others).enumerate() {
            let shown = portrait.column(pictures.shown());
            let images = self.original.difference(pictures);
            let difference = Column { heading: "difference".to_owned(), caption: String::new(), images };
            columns.extend(if i < before { [difference, shown] } else { [shown, difference] });
        }
        columns.insert(2 * before, reference.column(self.original.shown()));
        let (title, subtitle) = (title.clone(), subtitle.clone());
        ContactSheet { title, subtitle, image_size: [PICTURE_WIDTH; 2], columns, ..ContactSheet::default() }.draw()
    }

    /// The first view alone: the reference, then each test and its difference, without a word in the pictures, all cropped to
    /// the box that just holds what any of them shows.
    pub fn first_view(&self) -> Result<Vec<Captioned>> {
        let captioned = |caption: String, picture: Result<Picture>| Ok(Captioned { caption, picture: picture? });
        let mut row = vec![captioned(self.asked.reference.caption(), self.original.shaded(0))];
        for (portrait, pictures) in self.asked.tests.iter().zip(&self.others) {
            row.push(captioned(portrait.caption(), pictures.shaded(0)));
            row.push(captioned(format!("difference of {}", portrait.name), self.original.red(pictures, 0)));
        }
        let mut row = row.into_iter().collect::<Result<Vec<Captioned>>>()?;
        if let Some(all) = row.iter().filter_map(|shown| shown.picture.drawn_area()).reduce(Area::union) {
            row.iter_mut().for_each(|shown| shown.picture = shown.picture.cropped(all));
        }
        Ok(row)
    }
}

impl Portrait<'_> {
    fn column<'a>(&self, images: Images<'a>) -> Column<'a> {
        let caption = mesh_caption(self.mesh.triangle_count(), self.image_rmse);
        Column { heading: self.name.clone(), caption, images }
    }

    /// All that is known of it in one line.
    fn caption(&self) -> String {
        format!("{}: {}", self.name, mesh_caption(self.mesh.triangle_count(), self.image_rmse))
    }
}

/// The pictures of one mesh: over white to be looked at, over black, as the image error sees them, to be compared.
pub(super) struct Pictures {
    pub white: Vec<GreyImage>,
    pub black: Vec<GreyImage>,
}

impl Pictures {
    pub fn of(mesh: &TriMesh, reference: &TriMesh, shots: &[Shot]) -> Result<Self> {
        let gallery = Gallery::new(mesh, reference);
        let over = |background: f64| -> Result<Vec<GreyImage>> {
            shots.iter().map(|shot| gallery.picture(shot, background)).collect()
        };
        Ok(Self { white: over(255.0)?, black: over(0.0)? })
    }

    /// A view as it is looked at.
    pub fn shaded(&self, view: usize) -> Result<Picture> {
        let image = &self.white[view];
        Picture::from_grey(image.width as u32, image.width as u32, &image.pixels)
    }

    /// What differs in a view of `other`, in red.
    pub fn red(&self, other: &Self, view: usize) -> Result<Picture> {
        let (a, b) = (&self.black[view], &other.black[view]);
        let differences: Vec<f32> = a.pixels.iter().zip(&b.pixels).map(|(a, b)| (a - b).abs()).collect();
        let red = |level: f32| mix(WHITE, RED, f64::from((level / FULL_RED).min(1.0)));
        Picture::from_values(a.width as u32, a.width as u32, &differences, red)
    }

    fn shown(&self) -> Images<'_> {
        Images::Shaded(self.white.iter().map(|image| image.pixels.as_slice()).collect())
    }

    fn difference<'a>(&'a self, other: &'a Self) -> Images<'a> {
        let pairs = self.black.iter().zip(&other.black);
        Images::Difference(pairs.map(|(a, b)| [a.pixels.as_slice(), b.pixels.as_slice()]).collect())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::mesh::shapes;

    /// The sheet of a box and of what became of it.
    fn sheet(order: ColumnOrder, tests: &[&TriMesh]) -> Picture {
        let reference = shapes::cuboid(DVec3::ONE, 1);
        let portrait = |mesh| Portrait { name: "x".to_owned(), mesh, image_rmse: Some(1.0) };
        let sheet = SideBySide {
            title: String::new(),
            subtitle: String::new(),
            reference: Portrait { name: "original".to_owned(), mesh: &reference, image_rmse: None },
            tests: tests.iter().map(|mesh| portrait(*mesh)).collect(),
            order,
            up: DVec3::Z * 3.0,
        };
        sheet.draw().unwrap()
    }

    /// Column of the first and last red pixel above the key, as shares of the sheet's width.
    fn reds(picture: &Picture) -> Option<[f64; 2]> {
        let rows = picture.height() * 9 / 10;
        let is_red = |x: u32| (0..rows).any(|y| picture.pixel(x, y) == Some(RED));
        let columns: Vec<u32> = (0..picture.width()).filter(|&x| is_red(x)).collect();
        let share = |x: &u32| f64::from(*x) / f64::from(picture.width());
        Some([share(columns.first()?), share(columns.last()?)])
    }

    #[test]
    fn the_reference_stands_first_or_between_and_differences_outside() {
        let gone = shapes::cuboid(DVec3::splat(1e-3), 1);
        let same = shapes::cuboid(DVec3::ONE, 1);
        // Five columns: original, test, difference, test, difference.
        let [first, last] = reds(&sheet(ColumnOrder::ReferenceFirst, &[&gone, &same])).unwrap();
        assert!(0.4 < first && last < 0.6, "{first} {last}");
        // Difference, test, original, test, difference.
        let [first, last] = reds(&sheet(ColumnOrder::ReferenceBetween, &[&gone, &same])).unwrap();
        assert!(last < 0.2, "{first} {last}");
        let [first, last] = reds(&sheet(ColumnOrder::ReferenceBetween, &[&same, &gone])).unwrap();
        assert!(0.8 < first, "{first} {last}");
    }

    #[test]
    fn a_mesh_does_not_differ_from_itself() {
        let same = shapes::cuboid(DVec3::ONE, 1);
        for order in [ColumnOrder::ReferenceFirst, ColumnOrder::ReferenceBetween] {
            assert_eq!(reds(&sheet(order, &[&same])), None);
            assert_eq!(reds(&sheet(order, &[])), None);
        }
    }
}
