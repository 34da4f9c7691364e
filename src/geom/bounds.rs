use glam::DVec3;

/// Axis-aligned box, in the units of the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates.
    pub min: DVec3,
    /// Largest coordinates.
    pub max: DVec3,
}

impl Aabb {
    /// The smallest box around `points`; `None` for no points.
    #[must_use]
    pub fn around(points: impl IntoIterator<Item = DVec3>) -> Option<Self> {
        let boxes = points.into_iter().map(|p| Self { min: p, max: p });
        boxes.reduce(|a, b| Self { min: a.min.min(b.min), max: a.max.max(b.max) })
    }

    /// Centre of the box.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Length of the box's diagonal, in model units.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        (self.max - self.min).length()
    }
}
