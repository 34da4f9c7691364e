use glam::DVec3;
use rayon::prelude::*;

use crate::camera::Frame;
use crate::mesh::{TriMesh, TriangleId};

/// Areas (unit-sphere units) and unit normals of all triangles; area 0 marks degenerate ones.
pub(super) struct Shapes {
    pub areas: Vec<f64>,
    normals: Vec<[f32; 3]>,
}

impl Shapes {
    pub fn of(mesh: &TriMesh, frame: &Frame) -> Self {
        let shape = |t: u32| {
            let (area, normal) = frame.area_and_normal(mesh, TriangleId(t)).unwrap_or((0.0, DVec3::ZERO));
            (area, normal.as_vec3().to_array())
        };
        let (areas, normals) = (0..mesh.triangle_count() as u32).into_par_iter().map(shape).unzip();
        Self { areas, normals }
    }

    pub fn normal(&self, t: usize) -> DVec3 {
        DVec3::from_array(self.normals[t].map(f64::from))
    }

    /// Mean of a value over the surface; sums run in index order.
    pub fn area_mean(&self, value: impl Fn(usize) -> f64) -> f64 {
        let total: f64 = self.areas.iter().sum();
        let weighted: f64 = self.areas.iter().enumerate().map(|(t, area)| area * value(t)).sum();
        if total > 0.0 { weighted / total } else { 0.0 }
    }
}
