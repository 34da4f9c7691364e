use glam::DVec3;

use crate::camera::Axis;
use crate::error::Error;

/// The square that orthographic images cover, in unit-sphere units; all cameras of a run share one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Pixels along a side.
    pub width: u32,
    /// Half the length of a side.
    pub half_width: f64,
}

impl Window {
    /// The window around the whole unit sphere, with one pixel to spare on each side.
    #[must_use]
    pub fn around_sphere(width: u32) -> Self {
        Self { width, half_width: 1.0 + 2.0 / f64::from(width) }
    }

    /// Length of a pixel's edge, in unit-sphere units.
    #[must_use]
    pub fn pixel_size(&self) -> f64 {
        2.0 * self.half_width / f64::from(self.width)
    }

    /// The error for a scene that reaches `extent` from the centre, too far for this window's pixels to be told apart.
    #[must_use]
    pub fn too_small_for(&self, extent: f64) -> Error {
        let times = extent / self.half_width;
        let times = if times < 1e6 { format!("{times:.0}") } else { format!("{times:.1e}") };
        let message = format!(
            "a scene that reaches {times} times as far as its picture cannot be drawn with {} pixels along the side; are the \
             units the same? if so, take fewer pixels or a smaller scene",
            self.width
        );
        Error::Limit { message }
    }

    /// Pixels in an image.
    #[must_use]
    pub fn pixel_count(&self) -> usize {
        (self.width as usize).pow(2)
    }
}

/// One axis looking through a window: a right-handed basis (right, up, toward the near camera).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Direction in which the column index grows.
    pub right: DVec3,
    /// Direction in which the row index grows.
    pub up: DVec3,
    /// Unit vector from the object toward the near camera; depth grows along it.
    pub toward: DVec3,
    /// The window.
    pub window: Window,
}

impl View {
    /// The view along `axis`.
    #[must_use]
    pub fn along(axis: &Axis, window: Window) -> Self {
        Self::toward(axis.direction, window)
    }

    /// The view from the unit direction `toward`, upright with respect to the coordinate axis that it leans to least.
    #[must_use]
    pub fn toward(toward: DVec3, window: Window) -> Self {
        let [x, y, z] = toward.abs().to_array();
        let axis = if x <= y && x <= z {
            DVec3::X
        } else if y <= z {
            DVec3::Y
        } else {
            DVec3::Z
        };
        Self::with_right(axis.cross(toward), toward, window)
    }

    /// The view from the unit direction `toward` with `up` upward in the image; any other up where the two are parallel.
    #[must_use]
    pub fn upright(toward: DVec3, up: DVec3, window: Window) -> Self {
        let right = up.cross(toward);
        if right.length_squared() < 1e-12 {
            Self::toward(toward, window)
        } else {
            Self::with_right(right, toward, window)
        }
    }

    fn with_right(right: DVec3, toward: DVec3, window: Window) -> Self {
        let right = right.normalize();
        Self { right, up: toward.cross(right), toward, window }
    }

    /// Point of the pixel (column, row) in the plane through the centre, in unit-sphere units.
    #[must_use]
    pub fn pixel_centre(&self, column: u32, row: u32) -> DVec3 {
        let (s, h) = (self.window.pixel_size(), self.window.half_width);
        let along = |i: u32| (f64::from(i) + 0.5) * s - h;
        along(column) * self.right + along(row) * self.up
    }
}
