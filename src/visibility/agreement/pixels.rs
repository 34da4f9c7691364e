use std::sync::atomic::{AtomicI64, AtomicU64, Ordering};

use glam::{DVec2, DVec3};

use crate::backend::{ItemBuffers, MachineScratch, Workload, draw_all};
use crate::camera::{CameraSphere, View, Window};
use crate::error::Result;
use crate::mesh::TriangleId;
use crate::raster::{Hit, ItemBufferPair, Side};
use crate::visibility::agreement::{Comparing, Measurement};
use crate::visibility::{DiagramRecorder, Estimator, Shapes, Subject, VisibilityDiagram};

/// What the pixels say where two measurements differ.
pub(super) struct Differing {
    /// Of the pictures; where nobody draws, of those that would be drawn.
    pub pixel_size: f64,
    /// Pixels in which two triangles at one depth tie.
    pub tied_pixels: u64,
    /// Which of the two drew pictures.
    drawn: [bool; 2],
    /// Pairs of which one measurement shows two pixels or more and the other none, ties apart.
    several: Option<VisibilityDiagram>,
    /// Pairs of which one measurement shows ties, for the most part, and the other nothing.
    contact: Option<VisibilityDiagram>,
    /// Two per triangle, front and back: weighted tied pixels of A less those of B. Empty where V is no count of pixels.
    tied: Vec<i64>,
}

/// Two surfaces closer in depth than this, in unit-sphere units, lie at one depth: a dozen steps of `f32` near 1, about
/// what rays in `f32` can tell apart.
const SAME_DEPTH: f64 = 2e-6;

/// A pixel centre closer to an edge than this, in pixels, may lie beside the triangle instead of on it: rounding moves
/// rays and vertices by less. Neighbours that share the edge are no contact.
const ON_EDGE: f64 = 1e-3;

impl Differing {
    /// Draws again what differs.
    pub fn find(a: &Measurement<'_>, b: &Measurement<'_>, comparing: Comparing<'_>) -> Result<Self> {
        let triangles = a.subject.mesh().triangle_count();
        let width = a.drawn().or(b.drawn()).unwrap_or_else(|| comparing.options.resolution_for(triangles));
        let window = Window::around_sphere(width);
        let drawn = [a, b].map(|m| m.drawn() == Some(width));
        let nothing = Self {
            pixel_size: window.pixel_size(),
            tied_pixels: 0,
            drawn,
            several: None,
            contact: None,
            tied: Vec::new(),
        };
        let Some(diagrams) = a.diagram.as_ref().zip(b.diagram.as_ref()) else { return Ok(nothing) };
        let equal = diagrams.0 == diagrams.1
            && a.visibility.front() == b.visibility.front()
            && a.visibility.back() == b.visibility.back();
        if equal || drawn == [false, false] {
            return Ok(nothing);
        }
        let search = Search::new(a, b, [diagrams.0, diagrams.1], comparing)?;
        search.draw(drawn, window)?;
        Ok(Self {
            tied_pixels: search.tied_pixels.into_inner(),
            several: Some(search.several.finish()),
            contact: Some(search.contact.finish()),
            tied: search.tied.into_iter().map(AtomicI64::into_inner).collect(),
            ..nothing
        })
    }

    pub fn is_contact(&self, triangle: TriangleId, camera: usize) -> bool {
        self.contact.as_ref().is_some_and(|c| c.sees(triangle, camera))
    }

    /// Whether the one measurement that sees the triangle shows two pixels of it or more; `None` if it does not draw.
    pub fn shows_several(&self, triangle: TriangleId, camera: usize, sees: [bool; 2]) -> Option<bool> {
        let draws = sees.iter().zip(self.drawn).any(|(&sees, drawn)| sees && drawn);
        self.several.as_ref().filter(|_| draws).map(|s| s.sees(triangle, camera))
    }

    /// V_A − V_B of front and back that comes from tied pixels alone.
    pub fn tied(&self, t: usize, shapes: &Shapes, cameras: &CameraSphere) -> [f64; 2] {
        match self.tied.get(2 * t..2 * t + 2) {
            Some(&[front, back]) if front != 0 || back != 0 => {
                let all = shapes.areas[t] * cameras.cosine_sum(shapes.normal(t));
                [front, back].map(|pixels| pixels as f64 * self.pixel_size * self.pixel_size / all)
            }
            _ => [0.0; 2],
        }
    }
}

/// The search for what differs; written to from many threads.
struct Search<'a> {
    subjects: [&'a Subject<'a>; 2],
    diagrams: [&'a VisibilityDiagram; 2],
    comparing: Comparing<'a>,
    several: DiagramRecorder,
    contact: DiagramRecorder,
    tied_pixels: AtomicU64,
    tied: Vec<AtomicI64>,
}

/// What one camera sees, pixel by pixel, with a measurement that does not draw seeing nothing.
struct Sight {
    camera: u32,
    weight: u64,
    hits: [Vec<Option<Hit>>; 2],
}

impl<'a> Search<'a> {
    fn new(
        a: &'a Measurement<'_>,
        b: &'a Measurement<'_>,
        diagrams: [&'a VisibilityDiagram; 2],
        comparing: Comparing<'a>,
    ) -> Result<Self> {
        let triangles = a.subject.mesh().triangle_count();
        let recorder = || DiagramRecorder::new(triangles, diagrams[0].cameras(), comparing.options.memory_limit);
        let counts_pixels = [a, b].iter().all(|m| m.setting.estimator == Estimator::Coverage);
        let counters = if counts_pixels { 2 * triangles } else { 0 };
        Ok(Self {
            subjects: [a.subject, b.subject],
            diagrams,
            comparing,
            several: recorder()?,
            contact: recorder()?,
            tied_pixels: AtomicU64::new(0),
            tied: (0..counters).map(|_| AtomicI64::new(0)).collect(),
        })
    }

    fn draw(&self, drawn: [bool; 2], window: Window) -> Result<()> {
        let Comparing { cameras, options, progress } = self.comparing;
        // Each worker draws both pictures and spreads them out.
        let memory_limit = options.memory_limit.map(|limit| limit / 4);
        let load = Workload { window, memory_limit, phase: "differences", progress };
        let views: Vec<View> = cameras.axes().iter().map(|axis| View::along(axis, window)).collect();
        let [first, second] = if drawn[0] { [0, 1] } else { [1, 0] };
        // Occluders, which have the numbers behind the mesh's, hide and are not compared.
        let triangles = self.diagrams[0].triangles();
        let of_mesh = |hit: Option<Hit>| hit.filter(|hit| (hit.triangle.0 as usize) < triangles);
        draw_all(self.subjects[first].machine(), &views, load, |number, buffers| {
            let mut others = ItemBufferPair::new(window);
            if drawn[second] {
                let mut scratch = MachineScratch::default();
                self.subjects[second].machine().draw(&views[number], &mut scratch, &mut others)?;
            }
            let pair = if first == 0 { [buffers, &others] } else { [&others, buffers] };
            let axis = cameras.axes()[number];
            if let Some(camera) = axis.near {
                let hits = pair.map(|b| b.near().map(of_mesh).collect());
                self.look(&views[number], &Sight { camera, weight: cameras.weight(camera), hits });
            }
            if let Some(camera) = axis.far {
                let hits = pair.map(|b| b.far().map(of_mesh).collect());
                self.look(&views[number], &Sight { camera, weight: cameras.weight(camera), hits });
            }
            Ok(())
        })
    }

    fn look(&self, view: &View, sight: &Sight) {
        // Per measurement the pixels of triangles that the other does not see, and whether each is a tie.
        let mut alone = [Vec::new(), Vec::new()];
        for (pixel, (&a, &b)) in sight.hits[0].iter().zip(&sight.hits[1]).enumerate() {
            if a == b {
                continue;
            }
            let tie = self.is_tie(view, pixel as u32, a, b);
            if tie {
                self.count_tie(a, b, sight.weight);
            }
            for (which, hit) in [a, b].into_iter().enumerate() {
                let differs = |h: &Hit| !self.diagrams[1 - which].sees(h.triangle, sight.camera as usize);
                alone[which].extend(hit.filter(differs).map(|h| (h.triangle.0, tie)));
            }
        }
        alone.into_iter().for_each(|pixels| self.record(pixels, sight.camera as usize));
    }

    fn record(&self, mut pixels: Vec<(u32, bool)>, camera: usize) {
        pixels.sort_unstable();
        for of_one in pixels.chunk_by(|a, b| a.0 == b.0) {
            let triangle = TriangleId(of_one[0].0);
            // Centres on an edge are no ties, so a triangle in contact may show a few other pixels.
            let ties = of_one.iter().filter(|(_, tie)| *tie).count();
            if 2 * ties >= of_one.len() {
                self.contact.record(triangle, camera);
            } else if of_one.len() - ties > 1 {
                self.several.record(triangle, camera);
            }
        }
    }

    fn count_tie(&self, a: Option<Hit>, b: Option<Hit>, weight: u64) {
        self.tied_pixels.fetch_add(1, Ordering::Relaxed);
        for (hit, sign) in [(a, 1), (b, -1)] {
            let slot = hit.map(|h| 2 * h.triangle.0 as usize + usize::from(h.side == Side::Back));
            if let Some(counter) = slot.and_then(|slot| self.tied.get(slot)) {
                counter.fetch_add(sign * weight as i64, Ordering::Relaxed);
            }
        }
    }

    /// Whether two triangles lie at one depth under a pixel's centre, which is well inside both.
    fn is_tie(&self, view: &View, pixel: u32, a: Option<Hit>, b: Option<Hit>) -> bool {
        let Some((a, b)) = a.zip(b).filter(|(a, b)| a.triangle != b.triangle) else { return false };
        let width = view.window.width;
        let centre = view.pixel_centre(pixel % width, pixel / width);
        let depth = |hit: Hit| depth_within(self.unit_corners(hit.triangle), centre, view);
        depth(a).zip(depth(b)).is_some_and(|(a, b)| (a - b).abs() <= SAME_DEPTH)
    }

    /// Corners as the machines know them.
    fn unit_corners(&self, triangle: TriangleId) -> [DVec3; 3] {
        let subject = self.subjects[0];
        subject.mesh().corners(triangle).map(|p| subject.frame().to_unit(p).as_vec3().as_dvec3())
    }
}

/// Depth of a triangle over a point of the picture; `None` outside it and near its edges.
fn depth_within(corners: [DVec3; 3], point: DVec3, view: &View) -> Option<f64> {
    let flat = corners.map(|p| DVec2::new((p - point).dot(view.right), (p - point).dot(view.up)));
    let [a, b, c] = flat;
    let doubled_area = (b - a).perp_dot(c - a);
    let margin = ON_EDGE * view.window.pixel_size();
    // Twice the areas that the point makes with each edge, in the order of the opposite corners.
    let parts = [(b, c), (c, a), (a, b)].map(|(p, q)| (p.perp_dot(q) * doubled_area.signum(), p.distance(q)));
    let inside = parts.iter().all(|&(part, edge)| part > margin * edge);
    let depths = parts.iter().zip(corners).map(|((part, _), corner)| part * corner.dot(view.toward));
    inside.then(|| depths.sum::<f64>() / doubled_area.abs())
}
