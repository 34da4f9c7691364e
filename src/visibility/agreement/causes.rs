use glam::DVec3;
use serde::Serialize;

/// Why one of two measurements sees a triangle and the other does not; the first that applies, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cause {
    /// Another triangle lies at the same depth, and each measurement took another of the two.
    CoplanarContact,
    /// The camera looks along the triangle, |d·n| < 0.05.
    Grazing,
    /// Its image is longer than four pixels and narrower than one.
    Sliver,
    /// Its image, or what is seen of it, is at most about one pixel.
    SubPixel,
    /// None of these: worth a closer look if the two sample alike, what points or pixels missed if they do not.
    Unexplained,
}

/// How many pairs differ for which cause.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Causes {
    /// See [`Cause::CoplanarContact`].
    pub coplanar_contact: u64,
    /// See [`Cause::Grazing`].
    pub grazing: u64,
    /// See [`Cause::Sliver`].
    pub sliver: u64,
    /// See [`Cause::SubPixel`].
    pub sub_pixel: u64,
    /// See [`Cause::Unexplained`].
    pub unexplained: u64,
}

impl Causes {
    pub(super) fn count(&mut self, cause: Cause) {
        *match cause {
            Cause::CoplanarContact => &mut self.coplanar_contact,
            Cause::Grazing => &mut self.grazing,
            Cause::Sliver => &mut self.sliver,
            Cause::SubPixel => &mut self.sub_pixel,
            Cause::Unexplained => &mut self.unexplained,
        } += 1;
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            coplanar_contact: self.coplanar_contact + other.coplanar_contact,
            grazing: self.grazing + other.grazing,
            sliver: self.sliver + other.sliver,
            sub_pixel: self.sub_pixel + other.sub_pixel,
            unexplained: self.unexplained + other.unexplained,
        }
    }
}

/// About 87°: a pixel spans 20 pixels' worth of surface, and so does any error of rounding.
const GRAZING_COSINE: f64 = 0.05;

/// Pixels that the image of a sliver is at least long.
const SLIVER_LENGTH: f64 = 4.0;

/// The image of a triangle, in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Outline {
    /// Longest edge.
    length: f64,
    /// Altitude on it.
    width: f64,
    area: f64,
}

impl Outline {
    /// The image of a triangle (unit-sphere coordinates) for the camera at `toward`.
    pub fn of(corners: [DVec3; 3], toward: DVec3, pixel_size: f64) -> Self {
        let [a, b, c] = corners.map(|p| (p - toward * p.dot(toward)) / pixel_size);
        let length = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let area = 0.5 * (b - a).cross(c - a).length();
        Self { length, width: if length > 0.0 { 2.0 * area / length } else { 0.0 }, area }
    }

    /// The cause, contacts apart; `several` says whether a picture shows the triangle in two pixels or more, `None` if
    /// there is no picture.
    pub fn cause(&self, cosine: f64, several: Option<bool>) -> Cause {
        if cosine.abs() < GRAZING_COSINE {
            Cause::Grazing
        } else if self.width < 1.0 && self.length > SLIVER_LENGTH {
            Cause::Sliver
        } else if self.area < 1.0 || several == Some(false) {
            Cause::SubPixel
        } else {
            Cause::Unexplained
        }
    }
}
