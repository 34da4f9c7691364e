//! Polygons of any format become triangles here, n corners always n - 2 of them.
//!
//! A polygon is judged in the plane of its Newell normal (Newell 1972), by leaving out the coordinate along which that
//! normal is longest; this keeps the others exact, so that corners on a line stay on it. Quads take the diagonal
//! that lies inside, of two such the shorter. Larger ones go to `earcut`. That library leaves out corners on a
//! straight edge, which would tear the mesh there, so a polygon that has such corners is clipped here, ear by ear.
//! What neither can do (a polygon that crosses itself, or has no area) becomes a fan.

use earcut::Earcut;
use glam::{DVec2, DVec3};

use crate::mesh::MeshError;

/// Most corners that a polygon may have: cutting takes time beyond proportion to them.
const MOST_CORNERS: usize = 20_000;

/// Most corners that [`clip_ears`] takes on; its time grows with their square and, at worst, cube. Of a larger polygon,
/// corners on straight edges may be left out.
const MOST_CLIPPED: usize = 1000;

/// A polygon of four corners or more among triangles.
#[derive(Debug)]
struct Larger {
    /// Triangles of the file before it.
    triangles_before: usize,
    /// End of its corners in [`Polygons::corners`]; they begin where those of the one before end.
    end: usize,
}

/// The polygons of a file, in its order, as vertex indices. Triangles, nearly always all there is, stand for
/// themselves.
#[derive(Debug, Default)]
pub(super) struct Polygons {
    triangles: Vec<[u32; 3]>,
    larger: Vec<Larger>,
    corners: Vec<u32>,
}

impl Polygons {
    /// Makes room for `more` triangles.
    pub(super) fn reserve(&mut self, more: usize) {
        self.triangles.reserve_exact(more);
    }

    /// Adds a triangle.
    pub(super) fn push_triangle(&mut self, corners: [u32; 3]) {
        self.triangles.push(corners);
    }

    /// Adds a polygon; one of fewer than three corners is no polygon, which `false` says.
    ///
    /// # Errors
    /// A message, if the polygon has more corners than Outsight cuts.
    pub(super) fn push(&mut self, corners: &[u32]) -> Result<bool, String> {
        match *corners {
            [] | [_] | [_, _] => return Ok(false),
            [a, b, c] => self.triangles.push([a, b, c]),
            _ if corners.len() > MOST_CORNERS => {
                let n = corners.len();
                return Err(format!("a polygon of {n} corners; at most {MOST_CORNERS} are read, cut it beforehand"));
            }
            _ => {
                self.corners.extend_from_slice(corners);
                self.larger.push(Larger { triangles_before: self.triangles.len(), end: self.corners.len() });
            }
        }
        Ok(true)
    }

    /// Memory it takes, in bytes.
    pub(super) fn bytes(&self) -> u64 {
        (size_of_val(self.triangles.as_slice())
            + size_of_val(self.larger.as_slice())
            + size_of_val(self.corners.as_slice())) as u64
    }

    /// All as triangles, in the order of the file.
    pub(super) fn into_triangles(self, positions: &[DVec3]) -> Result<Vec<[u32; 3]>, MeshError> {
        if self.larger.is_empty() {
            return Ok(self.triangles);
        }
        let mut cutter = Cutter::default();
        let mut all = Vec::with_capacity(self.triangles.len() + self.corners.len());
        let (mut triangle, mut corner) = (0, 0);
        for polygon in &self.larger {
            all.extend_from_slice(&self.triangles[triangle..polygon.triangles_before]);
            cutter.cut(&self.corners[corner..polygon.end], positions, &mut all)?;
            (triangle, corner) = (polygon.triangles_before, polygon.end);
        }
        all.extend_from_slice(&self.triangles[triangle..]);
        Ok(all)
    }
}

/// Cuts polygons into triangles; keeps its buffers from one to the next.
#[derive(Default)]
struct Cutter {
    points: Vec<DVec3>,
    flat: Vec<DVec2>,
    local: Vec<[usize; 3]>,
    earcut: Earcut<f64>,
    indices: Vec<u32>,
}

impl Cutter {
    /// Adds the triangles of the polygon to `all`, counter-clockwise as the polygon.
    fn cut(&mut self, corners: &[u32], positions: &[DVec3], all: &mut Vec<[u32; 3]>) -> Result<(), MeshError> {
        self.points.clear();
        for &vertex in corners {
            let &position = positions.get(vertex as usize).ok_or(MeshError::IndexOutOfRange {
                triangle: all.len(),
                vertex,
                vertex_count: positions.len(),
            })?;
            self.points.push(position);
        }
        self.local.clear();
        if !flatten(&self.points, &mut self.flat) {
            fan(corners.len(), &mut self.local);
        } else if let &[a, b, c, d] = self.flat.as_slice() {
            self.local.extend(split_quad([a, b, c, d], &self.points));
        } else {
            self.cut_large();
        }
        all.extend(self.local.iter().map(|t| t.map(|i| corners[i])));
        Ok(())
    }

    fn cut_large(&mut self) {
        let wanted = self.flat.len() - 2;
        self.earcut.earcut(self.flat.iter().map(|p| p.to_array()), &[], &mut self.indices);
        let all_corners_used = self.indices.len() == 3 * wanted;
        self.local.extend(self.indices.chunks_exact(3).map(|t| [t[0] as usize, t[1] as usize, t[2] as usize]));
        for t in &mut self.local {
            if !turns_left(t.map(|i| self.flat[i])) {
                t.swap(1, 2);
            }
        }
        let all_turn_left = self.local.iter().all(|t| turns_left(t.map(|i| self.flat[i])));
        let is_done = all_turn_left && (all_corners_used || self.flat.len() > MOST_CLIPPED);
        if !is_done && !clip_ears(&self.flat, &mut self.local) {
            fan(self.flat.len(), &mut self.local);
        }
    }
}

/// The polygon in its own plane, counter-clockwise, in coordinates of at most 1; `false` where it has no area.
fn flatten(points: &[DVec3], flat: &mut Vec<DVec2>) -> bool {
    let origin = points[0];
    let extent = points.iter().fold(0.0, |e: f64, &p| e.max((p - origin).abs().max_element()));
    let local = |p: DVec3| (p - origin) / extent;
    let next = points.iter().cycle().skip(1);
    let normal: DVec3 = points.iter().zip(next).map(|(&p, &q)| local(p).cross(local(q))).sum();
    let longest = normal.abs().max_element();
    // False for NaN too, which a coordinate that is no number leads to.
    let has_area = longest > 0.0 && longest.is_finite();
    flat.clear();
    if has_area {
        let axis = (0..3).find(|&i| normal[i].abs() == longest).unwrap_or(2);
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (u, v) = if normal[axis] > 0.0 { (u, v) } else { (v, u) };
        flat.extend(points.iter().map(|&p| DVec2::new(local(p)[u], local(p)[v])));
    }
    has_area
}

/// Twice the signed area of a triangle; positive counter-clockwise.
fn turn([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

fn turns_left(triangle: [DVec2; 3]) -> bool {
    turn(triangle) > 0.0
}

/// A quad along the diagonal that lies inside it; of two such, along the shorter one.
fn split_quad([a, b, c, d]: [DVec2; 4], points: &[DVec3]) -> [[usize; 3]; 2] {
    /// How much shorter, squared, the second diagonal must be: rounding alone must not turn the pattern of a grid.
    const CLEARLY_SHORTER: f64 = 1.0 - 1e-9;
    let first_inside = turns_left([a, b, c]) && turns_left([a, c, d]);
    let second_inside = turns_left([a, b, d]) && turns_left([b, c, d]);
    let first = points[0].distance_squared(points[2]);
    let second = points[1].distance_squared(points[3]);
    let take_second = second_inside && (!first_inside || second < CLEARLY_SHORTER * first);
    if take_second { [[0, 1, 3], [1, 2, 3]] } else { [[0, 1, 2], [0, 2, 3]] }
}

/// Ear clipping that uses every corner, those on straight edges included; `false` where the polygon is not simple.
///
/// An ear is a strictly convex corner whose triangle holds no other corner, not even on its rim. A simple polygon with
/// area always has one (Meisters 1975), and what is left after cutting it is again such a polygon.
fn clip_ears(flat: &[DVec2], triangles: &mut Vec<[usize; 3]>) -> bool {
    triangles.clear();
    if flat.len() > MOST_CLIPPED {
        return false;
    }
    let mut ring: Vec<usize> = (0..flat.len()).collect();
    let mut at = 0;
    let mut tried = 0;
    while ring.len() > 3 {
        let n = ring.len();
        if tried == n {
            return false;
        }
        let ear = [ring[(at + n - 1) % n], ring[at % n], ring[(at + 1) % n]];
        if is_ear(flat, &ring, ear) {
            triangles.push(ear);
            ring.remove(at % n);
            tried = 0;
        } else {
            at = (at + 1) % n;
            tried += 1;
        }
        at %= ring.len();
    }
    triangles.push([ring[0], ring[1], ring[2]]);
    turns_left([flat[ring[0]], flat[ring[1]], flat[ring[2]]])
}

fn is_ear(flat: &[DVec2], ring: &[usize], ear: [usize; 3]) -> bool {
    let [a, b, c] = ear.map(|i| flat[i]);
    let inside = |p: DVec2| turn([a, b, p]) >= 0.0 && turn([b, c, p]) >= 0.0 && turn([c, a, p]) >= 0.0;
    turns_left([a, b, c]) && !ring.iter().any(|&i| !ear.contains(&i) && inside(flat[i]))
}

fn fan(corners: usize, triangles: &mut Vec<[usize; 3]>) {
    triangles.clear();
    triangles.extend((2..corners).map(|i| [0, i - 1, i]));
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn cut(points: &[[f64; 3]]) -> Vec<[u32; 3]> {
        let positions: Vec<DVec3> = points.iter().map(|&p| DVec3::from(p)).collect();
        let corners: Vec<u32> = (0..points.len() as u32).collect();
        let mut polygons = Polygons::default();
        assert!(polygons.push(&corners).unwrap());
        polygons.into_triangles(&positions).unwrap()
    }

    /// Area of each triangle in the xy plane; all are positive if nothing is turned over.
    fn areas(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> Vec<f64> {
        let flat = |i: u32| DVec2::new(points[i as usize][0], points[i as usize][1]);
        triangles.iter().map(|t| 0.5 * turn(t.map(flat))).collect()
    }

    #[test]
    fn order_of_triangles_and_polygons_is_kept() {
        let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let mut polygons = Polygons::default();
        polygons.push_triangle([3, 2, 1]);
        assert!(polygons.push(&[0, 1, 2, 3]).unwrap());
        assert!(!polygons.push(&[0, 1]).unwrap());
        assert!(polygons.push(&[1, 2, 3]).unwrap());
        let triangles = polygons.into_triangles(&square).unwrap();
        assert_eq!(triangles, [[3, 2, 1], [0, 1, 2], [0, 2, 3], [1, 2, 3]]);
    }

    #[test]
    fn concave_quad_is_split_inside() {
        //  3
        //  |\ .
        //  |  2 .
        //  |     . .
        //  0 ------- 1     the diagonal 1-3 lies outside
        let arrow = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 4.0, 0.0]];
        assert_eq!(cut(&arrow), [[0, 1, 2], [0, 2, 3]]);
        let turned = [arrow[1], arrow[2], arrow[3], arrow[0]];
        assert_eq!(cut(&turned), [[0, 1, 3], [1, 2, 3]]);
    }

    #[test]
    fn convex_quad_takes_its_shorter_diagonal() {
        let kite = [[0.0, 0.0, 5.0], [2.0, -0.5, 5.0], [4.0, 0.0, 5.0], [2.0, 0.5, 5.0]];
        assert_eq!(cut(&kite), [[0, 1, 3], [1, 2, 3]]);
        let square = [[0.1, 0.1, 0.0], [0.4, 0.1, 0.0], [0.4, 0.4, 0.0], [0.1, 0.4, 0.0]];
        assert_eq!(cut(&square), [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn quad_with_a_corner_on_a_straight_edge_has_no_flat_triangle() {
        let quad = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        assert!(areas(&quad, &cut(&quad)).iter().all(|&a| a > 0.0));
    }

    #[test]
    fn comb_is_cut_into_its_own_area() {
        // 33 teeth of area 1 on a strip of area 2 * 33.
        let mut comb = vec![[0.0, -1.0, 0.0], [66.0, -1.0, 0.0], [66.0, 0.0, 0.0]];
        for tooth in (0..33).rev() {
            let x = 2.0 * f64::from(tooth);
            comb.extend([[x + 1.0, 1.0, 0.0], [x, 0.0, 0.0]]);
        }
        let triangles = cut(&comb);
        assert_eq!(triangles.len(), comb.len() - 2);
        let areas = areas(&comb, &triangles);
        assert!(areas.iter().all(|&a| a > 0.0));
        assert_eq!(areas.iter().sum::<f64>(), 66.0 + 33.0);
    }

    #[test]
    fn corners_on_straight_edges_are_all_used() {
        // An L whose every edge has a corner in its middle.
        let outline = [[0, 0], [2, 0], [4, 0], [4, 1], [4, 2], [3, 2], [2, 2], [2, 3], [2, 4], [1, 4], [0, 4], [0, 2]];
        let points = outline.map(|[x, y]| [f64::from(x), f64::from(y), 1.0]);
        let triangles = cut(&points);
        assert_eq!(triangles.len(), 10);
        let areas = areas(&points, &triangles);
        assert!(areas.iter().all(|&a| a > 0.0), "{areas:?}");
        assert_eq!(areas.iter().sum::<f64>(), 12.0);
    }

    #[test]
    fn clockwise_polygon_stays_clockwise() {
        let points = [[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [1.0, 1.0, 0.0], [2.0, 2.0, 0.0], [2.0, 0.0, 0.0]];
        let areas = areas(&points, &cut(&points));
        assert!(areas.iter().all(|&a| a < 0.0));
        assert_eq!(areas.iter().sum::<f64>(), -3.0);
    }

    #[test]
    fn polygon_without_area_becomes_a_fan() {
        let line = [[0.0; 3], [1.0; 3], [2.0; 3], [3.0; 3], [4.0; 3]];
        assert_eq!(cut(&line), [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
        let nowhere = [[f64::NAN; 3], [1.0; 3], [2.0; 3], [3.0; 3]];
        assert_eq!(cut(&nowhere).len(), 2);
        let point = [[1.0; 3]; 5];
        assert_eq!(cut(&point).len(), 3);
    }

    #[test]
    fn scale_does_not_change_the_cut() {
        let points = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 1.0, 0.0], [3.0, 3.0, 0.0], [0.0, 4.0, 0.0]];
        let scaled = |s: f64| points.map(|p| p.map(|x| x * s));
        for power in [-900, -20, 20, 300] {
            let scale = if power < 0 { 0.5_f64.powi(-power) } else { 2.0_f64.powi(power) };
            assert_eq!(cut(&points), cut(&scaled(scale)));
        }
    }
}
