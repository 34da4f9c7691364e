//! From model units to the unit sphere and back.

use glam::DVec3;

use crate::geom::Aabb;
use crate::mesh::TriMesh;

/// The map x -> (x - centre) / radius that takes a mesh into the unit sphere.
///
/// Scaling a mesh by a power of two scales centre and radius exactly, so that unit coordinates stay the same bits.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    /// Centre of the box around the used vertices, in model units.
    pub centre: DVec3,
    /// Largest distance of a used vertex from the centre, in model units; 1 if all are in one place.
    pub radius: f64,
}

impl Frame {
    /// The frame of `mesh`, from the vertices that its triangles use.
    pub fn of(mesh: &TriMesh) -> Self {
        let used = || mesh.triangles().iter().flatten().map(|&v| mesh.positions()[v as usize]);
        let start = mesh.positions()[mesh.triangles()[0][0] as usize];
        let bounds = used().fold(Aabb { min: start, max: start }, |b, p| Aabb { min: b.min.min(p), max: b.max.max(p) });
        let centre = bounds.centre();
        // Lengths are taken after a division by the largest coordinate, since squares of tiny ones would underflow.
        let largest = used().map(|p| (p - centre).abs().max_element()).fold(0.0, f64::max);
        if largest == 0.0 {
            return Self { centre, radius: 1.0 };
        }
        let relative = used().map(|p| ((p - centre) / largest).length_squared()).fold(0.0, f64::max);
        Self { centre, radius: largest * relative.sqrt() }
    }

    /// Model units to unit-sphere coordinates.
    pub fn to_unit(self, p: DVec3) -> DVec3 {
        (p - self.centre) / self.radius
    }

    /// Unit-sphere coordinates to model units.
    pub fn to_model(self, x: DVec3) -> DVec3 {
        self.centre + self.radius * x
    }
}
