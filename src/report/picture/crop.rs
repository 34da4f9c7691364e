//! Pictures without their empty margins.

use super::{Area, Picture, WHITE};

impl Area {
    /// The smallest box that holds both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        let (left, top) = (self.left.min(other.left), self.top.min(other.top));
        let right = (self.left + self.width).max(other.left + other.width);
        let bottom = (self.top + self.height).max(other.top + other.height);
        Self { left, top, width: right - left, height: bottom - top }
    }
}

impl Picture {
    /// The smallest box that holds all pixels that are not white; `None` of a white picture.
    #[must_use]
    pub fn drawn_area(&self) -> Option<Area> {
        let is_drawn = |x: u32, y: u32| self.pixel(x, y).is_some_and(|colour| colour != WHITE);
        let row = |y: &u32| (0..self.width).any(|x| is_drawn(x, *y));
        let (top, bottom) = (0..self.height).find(row).zip((0..self.height).rfind(row))?;
        let column = |x: &u32| (top..=bottom).any(|y| is_drawn(*x, y));
        let (left, right) = (0..self.width).find(column).zip((0..self.width).rfind(column))?;
        Some(Area { left, top, width: right - left + 1, height: bottom - top + 1 })
    }

    /// What lies within a box; what of it lies outside the picture is white.
    #[must_use]
    pub fn cropped(&self, area: Area) -> Self {
        let mut part = Self::filled(area.width, area.height, WHITE);
        for y in 0..area.height {
            for x in 0..area.width {
                let colour = self.pixel(area.left.saturating_add(x), area.top.saturating_add(y));
                part.set(x, y, colour.unwrap_or(WHITE));
            }
        }
        part
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: [u8; 3] = [255, 0, 0];

    #[test]
    fn margins_are_what_is_white_all_around() {
        let mut picture = Picture::filled(10, 8, WHITE);
        assert_eq!(picture.drawn_area(), None);
        let drawn = Area { left: 2, top: 3, width: 5, height: 4 };
        // Corners that face each other, with white between them.
        picture.set(2, 6, RED);
        picture.set(6, 3, RED);
        assert_eq!(picture.drawn_area(), Some(drawn));
        let cropped = picture.cropped(drawn);
        assert_eq!((cropped.width(), cropped.height()), (5, 4));
        assert_eq!(cropped.drawn_area(), Some(Area { left: 0, top: 0, ..drawn }));
        let beyond = picture.cropped(Area { left: 6, top: 3, width: 100, height: 1 });
        assert_eq!((beyond.pixel(0, 0), beyond.pixel(99, 0)), (Some(RED), Some(WHITE)));
    }

    #[test]
    fn a_union_just_holds_both() {
        let [a, b] = [[1, 5, 2, 2], [4, 0, 3, 6]].map(|[left, top, width, height]| Area { left, top, width, height });
        assert_eq!(a.union(b), Area { left: 1, top: 0, width: 6, height: 7 });
        assert_eq!(a.union(a), a);
    }
}
