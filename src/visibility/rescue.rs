use std::f64::consts::FRAC_1_SQRT_2;

use crate::camera::{View, Window};
use crate::mesh::adjacency::find_root;
use crate::mesh::{Subdivision, TriMesh, TriangleId, VertexTriangles};
use crate::raster::{Hit, ItemBufferPair, depth_step};
use crate::visibility::{DepthRescue, Shapes};

/// Decides whether a piece without a pixel is seen all the same.
///
/// Source: Zhang & Turk 2002, section 4: small and sliver triangles that no pixel shows are compared with the depth buffer.
/// They give no tolerances; those here are ours.
pub(super) struct Rescuer {
    rule: DepthRescue,
    surface: Option<Surface>,
}

/// A piece that faces a camera, 0 for the near and 1 for the far one of an axis, and has no pixel in its picture.
pub(super) struct Candidate {
    pub piece: TriangleId,
    pub camera: usize,
    /// Farthest that a corner may lie behind what the picture shows around it; see [`tolerance`].
    pub tolerance: f64,
}

impl Rescuer {
    pub fn new(rule: DepthRescue, cut: &Subdivision) -> Self {
        Self { rule, surface: (rule == DepthRescue::Strict).then(|| Surface::of(cut.mesh())) }
    }

    /// Compares every vertex with the pictures that an axis gives of it.
    pub fn sound(&self, view: &View, buffers: &ItemBufferPair, extent: f64, positions: &[[f32; 3]]) -> Soundings {
        let line = Line { view, buffers, depth_step: depth_step(view.window, extent) };
        let sound = |&p| line.sound(p, self.rule == DepthRescue::Strict);
        match self.rule {
            DepthRescue::None => Soundings(Vec::new()),
            DepthRescue::Plain | DepthRescue::Strict => Soundings(positions.iter().map(sound).collect()),
        }
    }

    /// Whether the candidate counts as seen.
    pub fn rescues(&self, candidate: &Candidate, soundings: &Soundings, cut: &Subdivision, shapes: &Shapes) -> bool {
        let passes = |&v: &u32| {
            let sounding = soundings.0[v as usize][candidate.camera];
            let is_ours = |surface: &Surface| {
                sounding.shown == NOTHING || surface.holds(candidate.piece, TriangleId(sounding.shown), cut, shapes)
            };
            f64::from(sounding.behind) <= candidate.tolerance && self.surface.as_ref().is_none_or(is_ours)
        };
        self.rule != DepthRescue::None && cut.mesh().triangles()[candidate.piece.0 as usize].iter().any(passes)
    }
}

/// How far the depth of a surface seen under this cosine changes from a corner to a pixel around it: half a pixel, and the
/// slope over half the diagonal of a pixel. The slope ends at 75°, the paper's worst case: nearer to edge-on the
/// tolerance would reach through walls.
pub(super) fn tolerance(pixel_size: f64, cosine: f64) -> f64 {
    const TAN_75_DEGREES: f64 = 3.732_050_807_568_877;
    let tangent = (1.0 - cosine * cosine).max(0.0).sqrt() / cosine;
    pixel_size * (0.5 + FRAC_1_SQRT_2 * tangent.min(TAN_75_DEGREES))
}

/// For each vertex and camera of an axis, what its picture shows around the vertex.
pub(super) struct Soundings(Vec<[Sounding; 2]>);

impl Soundings {
    pub fn bytes(vertices: usize) -> u64 {
        (vertices * size_of::<[Sounding; 2]>()) as u64
    }
}

#[derive(Clone, Copy)]
struct Sounding {
    /// How far the vertex lies behind what is shown, in unit-sphere units; −∞ where nothing is.
    behind: f32,
    /// The piece that is shown, or [`NOTHING`].
    shown: u32,
}

const NOTHING: u32 = u32::MAX;

const EMPTY: Sounding = Sounding { behind: f32::NEG_INFINITY, shown: NOTHING };

/// Takes soundings in the pictures of one axis.
struct Line<'a> {
    view: &'a View,
    buffers: &'a ItemBufferPair,
    depth_step: f64,
}

impl Line<'_> {
    /// What the nearest pixel says of a vertex, or the most forgiving of the four around it.
    fn sound(&self, vertex: [f32; 3], only_nearest: bool) -> [Sounding; 2] {
        let p = glam::DVec3::from_array(vertex.map(f64::from));
        let Window { half_width, .. } = self.view.window;
        let pixel = |along: f64| (along + half_width) / self.view.window.pixel_size() - 0.5;
        let (column, row, depth) = (pixel(p.dot(self.view.right)), pixel(p.dot(self.view.up)), p.dot(self.view.toward));
        if only_nearest {
            return self.at(column.round(), row.round(), depth);
        }
        let (column, row) = (column.floor(), row.floor());
        let around = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
        let all = around.map(|(right, up)| self.at(column + right, row + up, depth));
        [0, 1].map(|camera| all.map(|s| s[camera]).into_iter().fold(all[0][camera], most_forgiving))
    }

    /// Compares a depth with a pixel; outside the picture nothing is shown.
    fn at(&self, column: f64, row: f64, depth: f64) -> [Sounding; 2] {
        let width = f64::from(self.view.window.width);
        if !(0.0..width).contains(&column) || !(0.0..width).contains(&row) {
            return [EMPTY; 2];
        }
        let pixel = row as usize * self.view.window.width as usize + column as usize;
        let Some([near, far]) = self.buffers.at(pixel) else { return [EMPTY; 2] };
        let sounding = |(shown, hit): (i32, Hit), toward: f64| Sounding {
            behind: (toward * (f64::from(shown) * self.depth_step - depth)) as f32,
            shown: hit.triangle.0,
        };
        [sounding(near, 1.0), sounding(far, -1.0)]
    }
}

fn most_forgiving(a: Sounding, b: Sounding) -> Sounding {
    if b.behind < a.behind { b } else { a }
}

/// What [`DepthRescue::Strict`] asks: which pieces lie on one surface.
struct Surface {
    around: VertexTriangles,
    /// Per vertex the smallest vertex that edges connect it with.
    component: Vec<u32>,
}

impl Surface {
    fn of(mesh: &TriMesh) -> Self {
        let mut component: Vec<u32> = (0..mesh.vertex_count() as u32).collect();
        for &[a, b, c] in mesh.triangles() {
            for (a, b) in [(a, b), (b, c)] {
                let (a, b) = (find_root(&mut component, a), find_root(&mut component, b));
                component[a.max(b) as usize] = a.min(b);
            }
        }
        (0..component.len() as u32).for_each(|v| component[v as usize] = find_root(&mut component, v));
        Self { around: VertexTriangles::of(mesh), component }
    }

    /// Whether what is shown continues the surface of a piece: of the same component and facing the same way, or within two
    /// triangles of it, edge by edge.
    ///
    /// An empty pixel needs no such proof: its centre is within half a diagonal of the vertex, and between the two the
    /// surface of the piece has its outline.
    fn holds(&self, piece: TriangleId, shown: TriangleId, cut: &Subdivision, shapes: &Shapes) -> bool {
        if shown.0 as usize >= cut.mesh().triangle_count() {
            // An occluder.
            return false;
        }
        let corners = |t: u32| cut.mesh().triangles()[t as usize];
        let component = |t: TriangleId| self.component[corners(t.0)[0] as usize];
        let normal = |t: TriangleId| shapes.normal(cut.parent(t).0 as usize);
        let touch = |s: u32, t: u32| corners(s).iter().filter(|v| corners(t).contains(v)).count() >= 2;
        let is_between = |m: &u32| touch(piece.0, *m) && touch(*m, shown.0);
        (component(piece) == component(shown) && normal(piece).dot(normal(shown)) > 0.0)
            || corners(piece.0).iter().any(|&v| self.around.around(v).iter().any(is_between))
    }
}
