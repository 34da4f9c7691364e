//! Batches of rays: blocked or not.

use crate::backend::embree::scene::Line;
use crate::backend::embree::{EmbreeScene, Primitive};
use crate::backend::{Occlusion, Ray};
use crate::error::{Error, Result};
use crate::mesh::TriangleId;

impl Occlusion for EmbreeScene {
    fn blocked(&self, rays: &[Ray], blocked: &mut [bool]) -> Result<()> {
        if rays.len() != blocked.len() {
            return Err(Error::ShapeMismatch { what: "blocked", got: blocked.len(), expected: rays.len() });
        }
        if let Some(wrong) = rays.iter().position(|ray| !is_finite(ray)) {
            return Err(Error::Option {
                name: "rays",
                message: format!("ray {wrong} has a coordinate that is not finite: {:?}", rays[wrong]),
            });
        }
        self.scene.blocked(rays.iter().map(|ray| self.line(ray)), blocked)?;
        for (ray, blocked) in rays.iter().zip(blocked) {
            *blocked |= matches!(self.primitive(ray), Primitive::Behind);
        }
        Ok(())
    }
}

impl EmbreeScene {
    fn line(&self, ray: &Ray) -> Line {
        let number = match self.primitive(ray) {
            Primitive::Number(number) => number,
            Primitive::None | Primitive::Behind => Line::NO_NUMBER,
        };
        Line { origin: ray.origin, direction: ray.direction, number }
    }

    /// The triangle that a ray starts on.
    fn primitive(&self, ray: &Ray) -> Primitive {
        let primitive = |id: TriangleId| self.primitive_of.get(id.0 as usize).copied();
        ray.own.and_then(primitive).unwrap_or(Primitive::None)
    }
}

fn is_finite(ray: &Ray) -> bool {
    ray.origin.iter().chain(&ray.direction).all(|x| x.is_finite())
}
