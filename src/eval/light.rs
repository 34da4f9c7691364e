//! How bright a sample is under each of the three lights that image errors are taken under.

use glam::{DVec2, DVec3};

use crate::camera::{UnitMesh, View};
use crate::geom::area_vector_doubled;
use crate::mesh::{TriMesh, Welder};

/// A light and a way of shading. Both sides of a surface are lit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Light {
    /// Beside the camera, flat triangles: 255 |n·d|. The one that image errors mean where they name none.
    Head,
    /// Fixed in the model's axes, flat triangles: 255 (0.25 + 0.75 |n·l|), l = (1, 2, 3)/√14.
    Fixed,
    /// Beside the camera, normals interpolated between the vertices: 255 |n·d|.
    Smooth,
}

impl Light {
    /// All of them, in the order in which pictures and errors are kept.
    pub const ALL: [Self; 3] = [Self::Head, Self::Fixed, Self::Smooth];
}

/// Grey of each of [`Light::ALL`], 0 to 255.
pub(super) type Greys = [f64; 3];

/// Direction of the fixed light, to be divided by √14.
const FIXED: DVec3 = DVec3::new(1.0, 2.0, 3.0);

/// What of the fixed light falls on surface that turns away from it.
const AMBIENT: f64 = 0.25;

/// A mesh with all that its brightness depends on.
#[derive(Debug)]
pub(super) struct LitMesh<'a> {
    triangles: &'a [[u32; 3]],
    positions: Vec<[f32; 3]>,
    /// Of the flat triangles; zero where one has no area.
    normals: Vec<DVec3>,
    /// Grey under the fixed light, by triangle.
    fixed: Vec<f64>,
    vertex_normals: Vec<DVec3>,
}

impl<'a> LitMesh<'a> {
    /// Lights `mesh`, whose copy in the unit sphere and unit normals are given.
    pub(super) fn new(mesh: &'a TriMesh, copy: &UnitMesh, normals: Vec<DVec3>) -> Self {
        let toward = FIXED.normalize();
        let fixed = |n: &DVec3| 255.0 * (AMBIENT + (1.0 - AMBIENT) * n.dot(toward).abs());
        Self {
            triangles: mesh.triangles(),
            positions: copy.positions.clone(),
            fixed: normals.iter().map(fixed).collect(),
            vertex_normals: vertex_normals(mesh, &normals),
            normals,
        }
    }

    /// Brightness in one view.
    pub(super) fn in_view(&self, view: &View) -> LitView<'_> {
        let (pixel, half) = (view.window.pixel_size(), view.window.half_width);
        let across =
            |direction: DVec3, p: &[f32; 3]| (DVec3::from(p.map(f64::from)).dot(direction) + half) / pixel - 0.5;
        let screen = self.positions.iter().map(|p| DVec2::new(across(view.right, p), across(view.up, p))).collect();
        LitView { mesh: self, toward: view.toward, screen }
    }
}

/// Unit normal of each vertex: the normals of the triangles around it, each by its angle there.
///
/// Vertices at one position are one vertex, so that a mesh is as smooth as its surface whatever format it came in.
/// Zero where the normals cancel.
///
/// Source: Thürmer & Wüthrich, Computing vertex normals from polygonal facets, 1998 (angles as weights, so that the
/// normal does not depend on how the surface is cut into triangles).
fn vertex_normals(mesh: &TriMesh, normals: &[DVec3]) -> Vec<DVec3> {
    let mut welder = Welder::default();
    let place: Vec<u32> = mesh.positions().iter().map(|&p| welder.vertex_at(p)).collect();
    let mut sums = vec![DVec3::ZERO; welder.into_positions().len()];
    for (t, &normal) in mesh.triangles().iter().zip(normals) {
        let corners = t.map(|v| mesh.positions()[v as usize]);
        for k in 0..3 {
            sums[place[t[k] as usize] as usize] += angle(corners, k) * normal;
        }
    }
    place.iter().map(|&p| sums[p as usize].normalize_or_zero()).collect()
}

/// Angle of a triangle at a corner.
fn angle(corners: [DVec3; 3], k: usize) -> f64 {
    let [a, b, c] = [0, 1, 2].map(|i| corners[(k + i) % 3]);
    let (u, v) = ((b - a).normalize_or_zero(), (c - a).normalize_or_zero());
    libm::atan2(area_vector_doubled([DVec3::ZERO, u, v]).length(), u.dot(v))
}

/// A lit mesh as one pair of opposite cameras sees it.
#[derive(Debug)]
pub(super) struct LitView<'a> {
    mesh: &'a LitMesh<'a>,
    toward: DVec3,
    /// Column and row of each vertex.
    screen: Vec<DVec2>,
}

/// A triangle in a view: its greys where flat, and the way to its interpolated normal.
#[derive(Debug, Clone, Copy)]
pub(super) struct LitTriangle {
    head: f64,
    fixed: f64,
    corners: [DVec2; 3],
    normals: [DVec3; 3],
    /// 1 ÷ doubled area on the screen; 0 where it is seen from its edge.
    per_area: f64,
}

impl LitView<'_> {
    /// The triangle of that number.
    pub(super) fn triangle(&self, number: u32) -> LitTriangle {
        let (mesh, t) = (self.mesh, number as usize);
        let vertices = mesh.triangles[t];
        let flat = mesh.normals[t];
        let corners = vertices.map(|v| self.screen[v as usize]);
        let area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]);
        LitTriangle {
            head: 255.0 * flat.dot(self.toward).abs(),
            fixed: mesh.fixed[t],
            corners,
            normals: vertices.map(|v| {
                let smooth = mesh.vertex_normals[v as usize];
                if smooth == DVec3::ZERO { flat } else { smooth }
            }),
            per_area: if area == 0.0 { 0.0 } else { 1.0 / area },
        }
    }

    /// Greys of a sample of the triangle.
    pub(super) fn greys(&self, triangle: &LitTriangle, sample: DVec2) -> Greys {
        let [a, b, c] = triangle.corners;
        // Slivers are known no better than to rounding: their weights stay within the triangle.
        let of_b = ((sample - a).perp_dot(c - a) * triangle.per_area).clamp(0.0, 1.0);
        let of_c = ((b - a).perp_dot(sample - a) * triangle.per_area).clamp(0.0, 1.0 - of_b);
        let [na, nb, nc] = triangle.normals;
        let normal = na * (1.0 - of_b - of_c) + nb * of_b + nc * of_c;
        let length = normal.length();
        let smooth = if length > 0.0 { 255.0 * normal.dot(self.toward).abs() / length } else { triangle.head };
        [triangle.head, triangle.fixed, smooth]
    }
}
