use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use crate::camera::{CameraSphere, Frame, Occluders, Window};
use crate::error::Result;
use crate::mesh::{TriMesh, TriangleId};
use crate::progress::Progress;
use crate::raster::Side;

/// Points that rays start from, in barycentric coordinates: inside the triangle, each standing for a quarter of it.
const POINTS: [[f64; 3]; 4] = [
    [2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0],
    [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0],
    [1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0],
    [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0],
];

/// Nearer than this, in unit-sphere units, is contact: rounding of coordinates up to 1 says no more.
const CONTACT: f64 = 1e-12;

/// Cosines up to this are edge-on.
const EDGE_ON: f64 = 1e-9;

/// What a camera makes of one side of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sight {
    /// It sees at least one of the points.
    Seen,
    /// Nothing is in the way, but the triangle's whole image is smaller than a pixel, and pictures may miss it.
    TooSmall,
    /// The triangle that is nearest in the way of most points, of all that are.
    Blocked(TriangleId),
    /// It stands behind the triangle's plane, or looks at its edge.
    Behind,
}

/// One camera's answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraSight {
    /// Number of the camera.
    pub camera: u32,
    /// What it sees.
    pub sight: Sight,
    /// Share of the points that it sees.
    pub share: f64,
    /// Cosine between the way to the camera and the side's normal; negative behind.
    pub cosine: f64,
    /// Pixels that the whole triangle's image would cover; 0 behind.
    pub pixels: f64,
}

/// Why a triangle is as visible as it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    /// V of the side, from the share of points that each camera sees. Source: Zhang & Turk 2002, eq. (4.3).
    pub visibility: f64,
    /// One answer per camera, in their order.
    pub cameras: Vec<CameraSight>,
    /// The triangles in the way, each with the number of cameras that it blocks: the most first, then by number.
    pub blockers: Vec<(TriangleId, usize)>,
}

/// Who looks at a triangle, and what stands around it.
#[derive(Clone, Copy)]
pub struct Explaining<'a> {
    /// The triangle's mesh.
    pub mesh: &'a TriMesh,
    /// Meshes in the same coordinates that hide; their triangles have the numbers behind those of the mesh.
    pub occluders: &'a [TriMesh],
    /// The cameras.
    pub cameras: &'a CameraSphere,
    /// What pixels are counted by.
    pub window: Window,
    /// Who listens.
    pub progress: &'a dyn Progress,
}

/// Casts rays from four points of one side of a triangle to every camera, against every other triangle, in `f64` and with no
/// shortcut that could be wrong.
///
/// Triangles block from both sides; of coincident triangles the one with the smaller number is in front.
/// `None` for a degenerate triangle: no area, or too small or thin against the whole mesh to be seen at all.
///
/// # Errors
/// [`crate::Error::Limit`] for an occluder that reaches too far, [`crate::Error::Cancelled`].
pub fn explain(scene: Explaining<'_>, triangle: TriangleId, side: Side) -> Result<Option<Explanation>> {
    let Explaining { mesh, cameras, window, .. } = scene;
    let frame = Frame::of(mesh);
    let Some((area, front)) = frame.area_and_normal(mesh, triangle) else { return Ok(None) };
    let normal = if side == Side::Front { front } else { -front };
    let facing: Vec<(u32, DVec3)> =
        (0..).zip(cameras.directions().iter().copied()).filter(|(_, d)| d.dot(normal) > EDGE_ON).collect();
    let obstacles = Obstacles::to(triangle, frame, scene)?;
    let nearest = obstacles.nearest(&facing, scene.progress)?;
    let mut answers: Vec<CameraSight> =
        (0..).zip(cameras.directions()).map(|(v, d)| behind(v, d.dot(normal))).collect();
    for (&(camera, toward), blockers) in facing.iter().zip(&nearest) {
        let cosine = toward.dot(normal);
        let pixels = area * cosine / window.pixel_size().powi(2);
        answers[camera as usize] = CameraSight { pixels, ..answer(camera, cosine, blockers, pixels) };
    }
    let seen = |answer: &CameraSight| answer.share * answer.cosine.max(0.0) * cameras.weight(answer.camera) as f64;
    let visibility = answers.iter().map(seen).sum::<f64>() / cameras.cosine_sum(normal);
    Ok(Some(Explanation { visibility, blockers: count_blockers(&answers), cameras: answers }))
}

fn behind(camera: u32, cosine: f64) -> CameraSight {
    CameraSight { camera, sight: Sight::Behind, share: 0.0, cosine, pixels: 0.0 }
}

fn answer(camera: u32, cosine: f64, blockers: &[Nearest; POINTS.len()], pixels: f64) -> CameraSight {
    let mut in_the_way: Vec<TriangleId> = blockers.iter().flatten().map(|&(_, id)| id).collect();
    in_the_way.sort_unstable();
    let share = 1.0 - in_the_way.len() as f64 / POINTS.len() as f64;
    let times = |id: &TriangleId| in_the_way.iter().filter(|other| *other == id).count();
    let sight = match in_the_way.iter().rev().max_by_key(|id| times(id)) {
        Some(&most) if share == 0.0 => Sight::Blocked(most),
        _ if pixels < 1.0 => Sight::TooSmall,
        _ => Sight::Seen,
    };
    CameraSight { camera, sight, share, cosine, pixels }
}

/// Distance and number of the nearest triangle in a ray's way.
type Nearest = Option<(f64, TriangleId)>;

/// What blocks the rays from each point, camera by camera.
type Blockers = Vec<[Nearest; POINTS.len()]>;

/// What may be in the way of rays from one triangle.
struct Obstacles<'a> {
    mesh: &'a TriMesh,
    frame: Frame,
    own: TriangleId,
    /// Of the occluders.
    sheets: Vec<(TriangleId, [DVec3; 3])>,
}

/// Obstacles between two looks at whether to stop.
const BLOCK: usize = 1024;

impl<'a> Obstacles<'a> {
    fn to(own: TriangleId, frame: Frame, scene: Explaining<'a>) -> Result<Self> {
        let behind = scene.mesh.triangle_count() as u32;
        let occluders = Occluders::around(frame, scene.occluders)?;
        let sheets = occluders.sheets().map(|(number, corners)| (TriangleId(behind + number), corners)).collect();
        Ok(Self { mesh: scene.mesh, frame, own, sheets })
    }

    fn count(&self) -> usize {
        self.mesh.triangle_count() + self.sheets.len()
    }

    fn at(&self, index: usize) -> Option<(TriangleId, [DVec3; 3])> {
        if let Some(sheet) = index.checked_sub(self.mesh.triangle_count()) {
            return self.sheets.get(sheet).copied();
        }
        let id = TriangleId(index as u32);
        // Degenerate triangles hide nothing, whoever looks.
        let is_solid = id != self.own && self.frame.area_and_normal(self.mesh, id).is_some();
        is_solid.then(|| (id, self.mesh.corners(id).map(|p| self.frame.to_unit(p))))
    }

    fn nearest(&self, facing: &[(u32, DVec3)], progress: &dyn Progress) -> Result<Blockers> {
        let [a, b, c] = self.mesh.corners(self.own).map(|p| self.frame.to_unit(p));
        let points = POINTS.map(|[u, v, w]| u * a + v * b + w * c);
        let nobody = || vec![[None; POINTS.len()]; facing.len()];
        let (done, blocks) = (AtomicU64::new(0), self.count().div_ceil(BLOCK));
        let add = |mut nearest: Blockers, block: usize| {
            if !progress.is_cancelled() {
                let block = BLOCK * block..self.count().min(BLOCK * (block + 1));
                block.filter_map(|i| self.at(i)).for_each(|obstacle| self.add(obstacle, points, facing, &mut nearest));
                progress.report("obstacles", done.fetch_add(1, Ordering::Relaxed) + 1, blocks as u64);
            }
            nearest
        };
        let found = (0..blocks).into_par_iter().fold(nobody, add).reduce(nobody, join);
        progress.check()?;
        Ok(found)
    }

    /// Takes the place of what is farther.
    fn add(
        &self,
        (id, corners): (TriangleId, [DVec3; 3]),
        points: [DVec3; POINTS.len()],
        facing: &[(u32, DVec3)],
        nearest: &mut [[Nearest; POINTS.len()]],
    ) {
        let least = if id < self.own { -CONTACT } else { CONTACT };
        for (k, &point) in points.iter().enumerate() {
            let volumes = Volumes::of(corners.map(|p| p - point));
            for (slot, &(_, toward)) in nearest.iter_mut().zip(facing) {
                let hit = volumes.crossing(toward).filter(|&distance| distance > least).map(|distance| (distance, id));
                slot[k] = nearer(slot[k], hit);
            }
        }
    }
}

fn join(mut a: Blockers, b: Blockers) -> Blockers {
    for (a, b) in a.iter_mut().flatten().zip(b.into_iter().flatten()) {
        *a = nearer(*a, b);
    }
    a
}

/// The nearer of two; at equal distance the smaller number, so that threads do not matter.
fn nearer(a: Nearest, b: Nearest) -> Nearest {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b < a { b } else { a }),
        _ => a.or(b),
    }
}

/// A triangle as seen from a point: what can be said before a direction is known.
struct Volumes {
    /// Corners, relative to the point.
    corners: [DVec3; 3],
    /// Cross products of the corners at each edge, opposite to the corners.
    edges: [DVec3; 3],
}

impl Volumes {
    fn of(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        Self { corners, edges: [b.cross(c), c.cross(a), a.cross(b)] }
    }

    /// How far along the direction its line passes through the triangle, if it does.
    #[inline]
    fn crossing(&self, toward: DVec3) -> Option<f64> {
        // Volumes spanned by the line and each edge: all of one sign where the line passes inside.
        let [u, v, w] = self.edges.map(|edge| toward.dot(edge));
        let inside = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
        let sum = u + v + w;
        if !inside || sum == 0.0 {
            return None;
        }
        let [a, b, c] = self.corners;
        Some((a * u + b * v + c * w).dot(toward) / sum)
    }
}

fn count_blockers(answers: &[CameraSight]) -> Vec<(TriangleId, usize)> {
    let mut counts = BTreeMap::new();
    for answer in answers {
        if let Sight::Blocked(id) = answer.sight {
            *counts.entry(id).or_insert(0) += 1;
        }
    }
    let mut counts: Vec<(TriangleId, usize)> = counts.into_iter().collect();
    counts.sort_by_key(|&(id, cameras)| (std::cmp::Reverse(cameras), id));
    counts
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::camera::CameraWeights;
    use crate::progress::{CancelFlag, Silent};

    const WINDOW: Window = Window { width: 480, half_width: 1.0 };

    fn alone(mesh: &TriMesh, triangle: u32, side: Side, cameras: &CameraSphere) -> Explanation {
        among(&[], mesh, triangle, side, cameras)
    }

    fn among(occluders: &[TriMesh], mesh: &TriMesh, t: u32, side: Side, cameras: &CameraSphere) -> Explanation {
        let scene = Explaining { mesh, occluders, cameras, window: WINDOW, progress: &Silent };
        explain(scene, TriangleId(t), side).unwrap().unwrap()
    }

    /// A tiny triangle at the origin facing +z, and a triangular plate of half-width 3 in the plane z = 1, in three pieces
    /// around the axis: numbers 1, 2, 3.
    fn plate_above() -> TriMesh {
        let tiny = [[-1e-3, -1e-3, 0.0], [1e-3, -1e-3, 0.0], [0.0, 1e-3, 0.0]];
        let plate = [[0.0, 0.0, 1.0], [-2.0, -1.0, 1.0], [2.0, -1.0, 1.0], [0.0, 2.0, 1.0]];
        let corners = tiny.into_iter().chain(plate).map(DVec3::from).collect();
        TriMesh::new(corners, vec![[0, 1, 2], [3, 4, 5], [3, 5, 6], [3, 6, 4]]).unwrap()
    }

    /// Which piece of the plate lies above the origin in direction `d`, by the angle alone.
    fn piece_in_the_way(d: DVec3) -> Option<u32> {
        // Where the line from the origin meets the plane z = 1.
        let (x, y) = (d.x / d.z, d.y / d.z);
        let inside = y >= -1.0 && 1.5 * x + y <= 2.0 && -1.5 * x + y <= 2.0;
        // Borders run from the middle to the corners (−2, −1), (2, −1), (0, 2).
        let piece = if y <= -0.5 * x.abs() {
            1
        } else if x > 0.0 {
            2
        } else {
            3
        };
        inside.then_some(piece)
    }

    #[test]
    fn a_plate_blocks_exactly_the_cameras_that_it_covers_and_its_pieces_are_told_apart() {
        let mesh = plate_above();
        // Turned, so that no camera looks along a border between the pieces.
        let rotation = glam::DMat3::from_rotation_z(0.3) * glam::DMat3::from_rotation_x(0.2);
        let cameras = CameraSphere::octahedral(258, CameraWeights::Area).unwrap().rotated(rotation);
        let found = alone(&mesh, 0, Side::Front, &cameras);
        let (mut open, mut all) = (0.0, 0.0);
        for answer in &found.cameras {
            let d = cameras.directions()[answer.camera as usize];
            let weight = d.z.max(0.0) * cameras.weight(answer.camera) as f64;
            all += weight;
            let wanted = match piece_in_the_way(d) {
                _ if d.z <= 0.0 => Sight::Behind,
                Some(piece) => Sight::Blocked(TriangleId(piece)),
                None => Sight::TooSmall,
            };
            open += if wanted == Sight::TooSmall { weight } else { 0.0 };
            assert_eq!(answer.sight, wanted, "{d}");
        }
        assert!((found.visibility - open / all).abs() < 1e-12);
        let by_hand = |piece| found.cameras.iter().filter(|a| a.sight == Sight::Blocked(TriangleId(piece))).count();
        assert_eq!(found.blockers.len(), 3);
        assert!(found.blockers.iter().all(|&(id, cameras)| cameras == by_hand(id.0) && cameras > 5));
        assert!(found.blockers.is_sorted_by_key(|&(_, cameras)| std::cmp::Reverse(cameras)));
    }

    #[test]
    fn nothing_blocks_the_other_side() {
        let cameras = CameraSphere::octahedral(66, CameraWeights::Equal).unwrap();
        let found = alone(&plate_above(), 0, Side::Back, &cameras);
        assert!((found.visibility - 1.0).abs() < 1e-12);
        assert!(found.blockers.is_empty());
    }

    #[test]
    fn large_triangles_are_seen_in_part_and_the_nearest_of_two_plates_is_named() {
        // A floor, and two shelves over the same third of it, numbers 1 (above) and 2 (below).
        let floor = [[-3.0, -3.0, 0.0], [3.0, -3.0, 0.0], [0.0, 3.0, 0.0]];
        let shelf = |z: f64| [[-3.5, -3.5, z], [-1.0, -3.5, z], [-2.0, 0.0, z]];
        let corners = [floor, shelf(2.0), shelf(1.0)].concat().into_iter().map(DVec3::from).collect();
        let mesh = TriMesh::new(corners, vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]]).unwrap();
        let cameras = CameraSphere::octahedral(6, CameraWeights::Equal).unwrap();
        let up = cameras.directions().iter().position(|d| d.z == 1.0).unwrap();
        let floor = alone(&mesh, 0, Side::Front, &cameras);
        assert_eq!((floor.cameras[up].sight, floor.cameras[up].share), (Sight::Seen, 0.75));
        assert_eq!(floor.visibility, 0.75);
        let lower = alone(&mesh, 2, Side::Front, &cameras);
        assert_eq!(lower.blockers, [(TriangleId(1), 1)]);
        let corner = shelf(0.5);
        let (mut corners, mut triangles) = mesh.into_parts();
        corners.extend(corner.map(DVec3::from));
        triangles.push([9, 10, 11]);
        let mesh = TriMesh::new(corners, triangles).unwrap();
        let lowest = alone(&mesh, 3, Side::Front, &cameras);
        assert_eq!(lowest.blockers, [(TriangleId(2), 1)], "the nearest, not the first");
    }

    #[test]
    fn of_two_coincident_triangles_the_smaller_number_is_in_front() {
        let corners = [[0.0, 0.0, 0.0], [0.7, 0.1, 0.3], [0.2, 0.9, 0.1]].map(DVec3::from).to_vec();
        let mesh = TriMesh::new(corners, vec![[0, 1, 2], [1, 2, 0]]).unwrap();
        let cameras = CameraSphere::octahedral(66, CameraWeights::Equal).unwrap();
        let v = |t| alone(&mesh, t, Side::Front, &cameras).visibility;
        assert!((v(0) - 1.0).abs() < 1e-12);
        assert_eq!(v(1), 0.0);
    }

    /// The plate of [`plate_above`] hides the same cameras whether it belongs to the mesh or stands around it.
    #[test]
    fn an_occluder_hides_as_a_part_does_and_has_the_numbers_behind_the_mesh() {
        let whole = plate_above();
        let part = |triangles: &[[u32; 3]]| TriMesh::new(whole.positions().to_vec(), triangles.to_vec()).unwrap();
        // Two of its pieces are the mesh's, so that the frame is the same.
        let (mesh, plate) = (part(&whole.triangles()[..3]), part(&whole.triangles()[3..]));
        let rotation = glam::DMat3::from_rotation_z(0.3) * glam::DMat3::from_rotation_x(0.2);
        let cameras = CameraSphere::octahedral(258, CameraWeights::Area).unwrap().rotated(rotation);
        let found = among(&[plate], &mesh, 0, Side::Front, &cameras);
        assert!(found.blockers.iter().any(|&(id, _)| id == TriangleId(3)));
        assert_eq!(found.blockers, alone(&whole, 0, Side::Front, &cameras).blockers);
    }

    #[test]
    fn what_lies_on_an_occluder_is_hidden_by_it_from_both_sides() {
        let floor = [[-3.0, -3.0, 0.0], [3.0, -3.0, 0.0], [0.0, 3.0, 0.0]].map(DVec3::from).to_vec();
        let floor = TriMesh::new(floor, vec![[0, 1, 2]]).unwrap();
        // All cameras of six but the two along z are edge-on.
        let cameras = CameraSphere::octahedral(6, CameraWeights::Equal).unwrap();
        for side in [Side::Front, Side::Back] {
            let found = among(std::slice::from_ref(&floor), &plate_above(), 0, side, &cameras);
            assert_eq!((found.visibility, &found.blockers[..]), (0.0, &[(TriangleId(4), 1)][..]));
        }
    }

    #[test]
    fn an_explanation_can_be_stopped() {
        let cameras = CameraSphere::octahedral(6, CameraWeights::Equal).unwrap();
        let stop = CancelFlag::default();
        stop.cancel();
        let mesh = plate_above();
        let scene = Explaining { mesh: &mesh, occluders: &[], cameras: &cameras, window: WINDOW, progress: &stop };
        assert!(matches!(explain(scene, TriangleId(0), Side::Front), Err(crate::Error::Cancelled)));
    }
}
