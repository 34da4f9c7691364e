use glam::DVec3;

use crate::camera::Occluders;
use crate::error::{Error, Result};
use crate::geom;
use crate::mesh::{MAX_TRIANGLES, TriMesh, TriangleId};

/// The sphere that cameras look at: centre of a mesh's box and distance of its farthest vertex.
///
/// Several meshes can be seen in one frame (an original and its simplified forms).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Centre of the box, in model units.
    pub centre: DVec3,
    /// Largest distance of a vertex from the centre, in model units.
    pub radius: f64,
}

/// Triangles below this area, in unit-sphere units, are not seen and hide nothing.
const DEGENERATE_AREA: f64 = 1e-14;

/// A mesh in the unit sphere, narrowed to `f32`: what rasters and rays work on.
#[derive(Debug, Clone)]
pub struct UnitMesh {
    /// Vertex positions; those of the framed mesh itself lie in the unit ball.
    pub positions: Vec<[f32; 3]>,
    /// Triangles that can be seen, with their numbers in the mesh; degenerate ones are left out. Occluders have the
    /// numbers behind the mesh's own, several triangles of one number each: see [`Frame::among`].
    pub triangles: Vec<([u32; 3], TriangleId)>,
    /// Largest distance of a vertex in use from the centre; 1 up to rounding for the framed mesh itself.
    pub extent: f64,
}

impl Frame {
    /// The frame of a mesh; vertices that no triangle uses do not count.
    #[must_use]
    pub fn of(mesh: &TriMesh) -> Self {
        let centre = mesh.bounds().centre();
        // Squares of very small or large lengths would leave the range of numbers, so they are scaled first.
        let scale = corners_of_all(mesh).map(|p| (p - centre).abs().max_element()).fold(0.0, f64::max);
        if scale == 0.0 {
            // A mesh whose triangles all shrank to one point still needs a finite frame.
            return Self { centre, radius: 1.0 };
        }
        let farthest = corners_of_all(mesh).map(|p| ((p - centre) / scale).length_squared()).fold(0.0, f64::max);
        Self { centre, radius: scale * farthest.sqrt() }
    }

    /// `p` in unit-sphere coordinates.
    #[must_use]
    pub fn to_unit(&self, p: DVec3) -> DVec3 {
        (p - self.centre) / self.radius
    }

    /// The mesh as seen in this frame.
    #[must_use]
    pub fn unit_copy(&self, mesh: &TriMesh) -> UnitMesh {
        self.unit_copy_of(mesh, |id| self.area_and_normal(mesh, id).is_some())
    }

    /// The mesh as seen in this frame, where the caller knows which triangles can be seen.
    #[must_use]
    pub fn unit_copy_of(&self, mesh: &TriMesh, can_be_seen: impl Fn(TriangleId) -> bool) -> UnitMesh {
        let unit = |p: DVec3| self.to_unit(p);
        let triangles = (0..).map(TriangleId).zip(mesh.triangles());
        let visible = triangles.filter(|&(id, _)| can_be_seen(id));
        UnitMesh {
            positions: mesh.positions().iter().map(|&p| unit(p).as_vec3().to_array()).collect(),
            triangles: visible.map(|(id, &t)| (t, id)).collect(),
            extent: self.reach(mesh),
        }
    }

    /// A mesh as seen in this frame with the sheets of occluders that stand around it in the same coordinates.
    ///
    /// `unit` shows a mesh of `triangles` triangles. Triangle t of the first occluder gets the number `triangles` + t; the
    /// next occluder follows.
    ///
    /// # Errors
    /// [`Error::Limit`] if there are more triangles than can be numbered, or an occluder reaches too far: see
    /// [`Occluders::check`].
    pub fn among(&self, mut unit: UnitMesh, triangles: usize, occluders: &[TriMesh]) -> Result<UnitMesh> {
        let occluders = Occluders::around(*self, occluders)?;
        let around = occluders.triangle_count();
        if around == 0 {
            return Ok(unit);
        }
        let positions = unit.positions.len() + 9 * around;
        if triangles + around > MAX_TRIANGLES || positions > u32::MAX as usize {
            let message = format!("occluders of {around} triangles are more than can be numbered; take simpler ones");
            return Err(Error::Limit { message });
        }
        unit.extent = unit.extent.max(occluders.extent());
        for (number, corners) in occluders.sheets() {
            let next = unit.positions.len() as u32;
            unit.positions.extend(corners.map(|p| p.as_vec3().to_array()));
            unit.triangles.push(([next, next + 1, next + 2], TriangleId(triangles as u32 + number)));
        }
        Ok(unit)
    }

    /// How far a mesh reaches from the centre of this frame, in unit-sphere units.
    #[must_use]
    pub fn reach(&self, mesh: &TriMesh) -> f64 {
        corners_of_all(mesh).map(|p| self.to_unit(p).length()).fold(0.0, f64::max)
    }

    /// Area (unit-sphere units) and unit normal of a triangle; `None` for a degenerate one.
    #[must_use]
    pub fn area_and_normal(&self, mesh: &TriMesh, triangle: TriangleId) -> Option<(f64, DVec3)> {
        let doubled = geom::area_vector_doubled(mesh.corners(triangle).map(|p| self.to_unit(p)));
        let area = 0.5 * doubled.length();
        (area >= DEGENERATE_AREA).then(|| (area, doubled / (2.0 * area)))
    }
}

fn corners_of_all(mesh: &TriMesh) -> impl Iterator<Item = DVec3> + '_ {
    mesh.triangles().iter().flatten().map(|&v| mesh.positions()[v as usize])
}
