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
    pub fn around(points: &[DVec3]) -> Option<Self> {
        let (&first, rest) = points.split_first()?;
        let start = Self { min: first, max: first };
        Some(rest.iter().fold(start, |b, &p| Self { min: b.min.min(p), max: b.max.max(p) }))
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
