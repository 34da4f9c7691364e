use glam::DVec3;

use crate::backend::{ItemBuffers, Occlusion, Ray};
use crate::camera::{UnitMesh, View, Window};
use crate::error::Result;
use crate::mesh::TriangleId;
use crate::raster::{Hit, ItemBufferPair, Side};

/// The judge: one ray per pixel against every triangle, in `f64`, with no shortcut.
///
/// It shares nothing with the rasteriser but the layout of the result. On an edge it lets both triangles have the pixel.
#[derive(Debug)]
pub struct Brute {
    triangles: Vec<([DVec3; 3], TriangleId)>,
    extent: f64,
}

impl Brute {
    /// The judge for a mesh.
    #[must_use]
    pub fn new(mesh: &UnitMesh) -> Self {
        let position = |v: u32| DVec3::from_array(mesh.positions[v as usize].map(f64::from));
        let triangles = mesh.triangles.iter().map(|&(corners, id)| (corners.map(position), id)).collect();
        Self { triangles, extent: mesh.extent }
    }
}

impl ItemBuffers for Brute {
    type Scratch = ();

    fn draw(&self, view: &View, (): &mut (), buffers: &mut ItemBufferPair) -> Result<()> {
        buffers.clear();
        let width = view.window.width;
        for pixel in 0..width * width {
            let origin = view.pixel_centre(pixel % width, pixel / width);
            for &(corners, triangle) in &self.triangles {
                if let Some((depth, side)) = crossing(origin, view.toward, corners) {
                    let depth = (depth / (1.001 * self.extent) * f64::from(1 << 30)).round() as i32;
                    buffers.offer(pixel as usize, depth, Hit { triangle, side });
                }
            }
        }
        Ok(())
    }

    fn bytes_per_worker(&self, window: Window) -> u64 {
        ItemBufferPair::bytes(window)
    }
}

impl Occlusion for Brute {
    fn blocked(&self, rays: &[Ray], blocked: &mut [bool]) -> Result<()> {
        for (ray, blocked) in rays.iter().zip(blocked) {
            let [origin, along] = [ray.origin, ray.direction].map(|v| DVec3::from_array(v.map(f64::from)));
            let ahead = |corners| crossing(origin, along, corners).is_some_and(|(distance, _)| distance >= 0.0);
            *blocked = self.triangles.iter().any(|&(corners, id)| Some(id) != ray.own && ahead(corners));
        }
        Ok(())
    }
}

/// Where the line through `origin` along `toward` crosses a triangle, and which side one sees from `toward`.
fn crossing(origin: DVec3, toward: DVec3, corners: [DVec3; 3]) -> Option<(f64, Side)> {
    let [a, b, c] = corners.map(|p| p - origin);
    // Volumes spanned by the line and each edge: all of one sign where the line passes inside.
    let [u, v, w] = [(b, c), (c, a), (a, b)].map(|(p, q)| toward.dot(p.cross(q)));
    let sum = u + v + w;
    let inside = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
    if !inside || sum == 0.0 {
        return None;
    }
    let depth = (a * u + b * v + c * w).dot(toward) / sum;
    Some((depth, if sum > 0.0 { Side::Front } else { Side::Back }))
}
