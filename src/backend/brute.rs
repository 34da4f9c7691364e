use glam::DVec3;
use robust::{Coord3D, orient3d};

use crate::backend::coincident::first_coincident;
use crate::backend::{ItemBuffers, Occlusion, Ray};
use crate::camera::{UnitMesh, View, Window};
use crate::error::{Error, Result};
use crate::mesh::TriangleId;
use crate::raster::{Hit, ItemBufferPair, Side, depth_step};

/// The judge: every ray against every triangle, in `f64`, with no shortcut.
///
/// It shares nothing with the rasteriser but the layout of the result. On an edge it lets both triangles have the pixel.
/// Rays it judges by the exact signs of volumes, so that none slips between two triangles that share an edge or a vertex.
#[derive(Debug)]
pub struct Brute {
    triangles: Vec<([DVec3; 3], TriangleId)>,
    /// For each the first that coincides with it.
    first: Vec<u32>,
    extent: f64,
}

impl Brute {
    /// The judge for a mesh.
    #[must_use]
    pub fn new(mesh: &UnitMesh) -> Self {
        let position = |v: u32| DVec3::from_array(mesh.positions[v as usize].map(f64::from));
        let triangles = mesh.triangles.iter().map(|&(corners, id)| (corners.map(position), id)).collect();
        Self { triangles, first: first_coincident(mesh), extent: mesh.extent }
    }
}

impl ItemBuffers for Brute {
    type Scratch = ();

    fn draw(&self, view: &View, (): &mut (), buffers: &mut ItemBufferPair) -> Result<()> {
        buffers.clear();
        let width = view.window.width;
        let step = depth_step(view.window, self.extent);
        for pixel in 0..width * width {
            let origin = view.pixel_centre(pixel % width, pixel / width);
            for &(corners, triangle) in &self.triangles {
                if let Some((depth, side)) = crossing(origin, view.toward, corners) {
                    buffers.offer(pixel as usize, (depth / step).round() as i32, Hit { triangle, side });
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
        if rays.len() != blocked.len() {
            return Err(Error::ShapeMismatch { what: "blocked", got: blocked.len(), expected: rays.len() });
        }
        for (ray, answer) in rays.iter().zip(blocked) {
            let [origin, direction] = [ray.origin, ray.direction].map(|v| DVec3::from_array(v.map(f64::from)));
            let own = ray.own.and_then(|own| self.triangles.iter().position(|&(_, id)| id == own));
            let first = own.map(|own| self.first[own]);
            let mut others = self.triangles.iter().zip(&self.first).filter(|&(_, f)| Some(*f) != first);
            let is_second = own.is_some_and(|own| Some(own as u32) != first);
            *answer = is_second || others.any(|(&(corners, _), _)| crosses(origin, origin + direction, corners));
        }
        Ok(())
    }
}

/// Whether the ray from `origin` through `other` crosses a triangle, its border included; never one in its own plane.
///
/// The signs are exact, and opposite for the two triangles at an edge: a closed mesh lets no ray out.
///
/// Source: Shewchuk 1997, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates.
fn crosses(origin: DVec3, other: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let volume = |p, q, r| orient3d(coord(p), coord(q), coord(r), coord(origin));
    let [first, second] = [volume(other, b, c), volume(other, c, a)];
    if first * second < 0.0 {
        // It passes between their sides: most triangles are done here.
        return false;
    }
    let edges = [first, second, volume(other, a, b)];
    let (left, right) = (edges.iter().all(|&e| e >= 0.0), edges.iter().all(|&e| e <= 0.0));
    if left == right {
        // It passes by, or lies in the plane.
        return false;
    }
    // How far the plane lies ahead, times how steeply the ray crosses it.
    let ahead = volume(a, b, c);
    if left { ahead >= 0.0 } else { ahead <= 0.0 }
}

fn coord(p: DVec3) -> Coord3D<f64> {
    Coord3D { x: p.x, y: p.y, z: p.z }
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
