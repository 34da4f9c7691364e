//! The driver: cheapest edge first, until a target is met.

use super::frame::Frame;
use super::guards::Guards;
use super::metric::{Candidate, Metric};
use super::queue::{Edge, EdgeQueue, Key};
use super::ring::Ring;
use super::surface::{Corner, Surface};
use super::{Boundary, SimplifyOptions, Stop};
use crate::error::Result;
use crate::mesh::adjacency::{Edges, NONE};
use crate::progress::Progress;

/// Attempts between two looks at whether to stop.
const ATTEMPTS_PER_CHECK: u64 = 1000;

/// A surface that shrinks by edge collapses in the order that a metric gives.
#[derive(Debug)]
pub struct EdgeCollapser<M> {
    surface: Surface,
    metric: M,
    guards: Guards,
    queue: EdgeQueue,
    ring: Ring,
    vertices: Vertices,
    /// Scratch: edges about to return to the queue.
    waiting: Vec<u32>,
    /// Largest mean square distance allowed, in unit-sphere units squared.
    max_mean_square: f64,
    withheld_by_error: bool,
    tally: Tally,
}

/// What a run has come to so far.
#[derive(Debug, Clone, Copy, Default)]
pub struct Tally {
    /// Largest mean square distance of a collapse, in unit-sphere units squared.
    pub mean_square: f64,
    /// Pairs of triangles back to back that were cancelled.
    pub cancelled_pairs: usize,
}

/// What the collapser knows of each vertex beside its place on the surface.
#[derive(Debug)]
pub struct Vertices {
    /// The vertex it became part of; itself while it lasts.
    pub parent: Vec<u32>,
    /// Whether it left its place in the input.
    pub moved: Vec<bool>,
    /// Whether it must neither move nor vanish.
    locked: Vec<bool>,
    /// Whether an edge at it was refused and waits for its surroundings to change.
    has_refused: Vec<bool>,
}

impl Vertices {
    fn new(edges: &Edges, count: usize, boundary: Boundary) -> Self {
        let mut locked = vec![false; count];
        if boundary == Boundary::Locked {
            let boundary = edges.ends.iter().zip(&edges.triangle_counts).filter(|&(_, &n)| n == 1);
            boundary.flat_map(|(ends, _)| ends).for_each(|&v| locked[v as usize] = true);
        }
        Self { parent: (0..count as u32).collect(), moved: vec![false; count], locked, has_refused: vec![false; count] }
    }

    /// The end that must stay where it is, or `None` if both must.
    fn pinned(&self, [u, v]: [u32; 2]) -> Option<Option<u32>> {
        match [u, v].map(|v| self.locked[v as usize]) {
            [false, false] => Some(None),
            [true, false] => Some(Some(u)),
            [false, true] => Some(Some(v)),
            [true, true] => None,
        }
    }
}

impl<M: Metric> EdgeCollapser<M> {
    /// A collapser of `surface`, with all edges in the queue.
    pub fn new(surface: Surface, metric: M, edges: &Edges, frame: &Frame, options: &SimplifyOptions) -> Self {
        let count = surface.positions.len();
        let vertices = Vertices::new(edges, count, options.boundary);
        let queue = EdgeQueue::new(&edges.ends, metric.has_second_cost(), |ends| {
            let key = assess(&surface, &metric, &vertices, ends).map(|c| key_of(&surface, ends, &c));
            (record(&surface, ends), key)
        });
        let max = options.max_error.map_or(f64::INFINITY, |e| e / frame.radius);
        Self {
            surface,
            metric,
            guards: Guards::new(options),
            queue,
            ring: Ring::new(count),
            vertices,
            waiting: Vec::new(),
            max_mean_square: max * max,
            withheld_by_error: false,
            tally: Tally::default(),
        }
    }

    /// Collapses until at most `target` triangles are left, or no collapse is allowed any more.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub fn run(&mut self, target: usize, progress: &dyn Progress, total: u64) -> Result<Stop> {
        let input = self.surface.triangles.len() as u64;
        let mut attempts = 0;
        while self.surface.alive > target {
            if attempts % ATTEMPTS_PER_CHECK == 0 {
                progress.check()?;
                progress.report("simplify", input - self.surface.alive as u64, total);
            }
            attempts += 1;
            let Some(edge) = self.queue.pop() else {
                return Ok(if self.withheld_by_error { Stop::Error } else { Stop::QueueEmpty });
            };
            self.attempt(edge);
        }
        Ok(Stop::Target)
    }

    /// The surface as it is now.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// The vertices as they are now.
    pub fn vertices(&self) -> &Vertices {
        &self.vertices
    }

    /// What the run has come to so far.
    pub fn tally(&self) -> Tally {
        self.tally
    }

    /// Collapses the edge if that is allowed.
    fn attempt(&mut self, edge: u32) {
        let ends = self.queue.ends(edge);
        self.ring.gather(&self.surface, ends);
        // An edge whose last triangles were cancelled is met here once more.
        if self.ring.on_edge.is_empty() {
            return;
        }
        let Some(candidate) = assess(&self.surface, &self.metric, &self.vertices, ends) else {
            return;
        };
        if candidate.mean_square > self.max_mean_square {
            self.withheld_by_error = true;
            return;
        }
        let is_free = candidate.cost == 0.0;
        if self.guards.allow(&self.surface, &self.ring, &self.vertices.locked, candidate.position, is_free) {
            self.collapse(&candidate);
        } else {
            ends.iter().for_each(|&v| self.vertices.has_refused[v as usize] = true);
        }
    }

    fn collapse(&mut self, candidate: &Candidate) {
        let kept_side = self.side_that_stays(candidate);
        let [kept, gone] = [self.ring.ends[kept_side], self.ring.ends[1 - kept_side]];
        self.retire_edges(1 - kept_side);
        self.join_triangles(kept_side);
        self.move_vertex(kept, candidate);
        self.vertices.parent[gone as usize] = kept;
        self.metric.merge(gone, kept);
        self.tally.mean_square = self.tally.mean_square.max(candidate.mean_square);
        self.tally.cancelled_pairs += self.ring.cancelled_pairs;
        self.requeue_edges(kept, kept_side);
        self.retry_refused(kept);
    }

    /// The end whose number lives on: one that keeps its position, else the smaller.
    fn side_that_stays(&self, candidate: &Candidate) -> usize {
        let ends = self.ring.ends;
        let stays = |side: usize| self.surface.positions[ends[side] as usize] == candidate.position;
        match [stays(0), stays(1)] {
            [true, false] => 0,
            [false, true] => 1,
            [true, true] if self.vertices.locked[ends[0] as usize] => 0,
            [true, true] if self.vertices.locked[ends[1] as usize] => 1,
            _ => usize::from(ends[1] < ends[0]),
        }
    }

    /// Takes out of the queue what becomes the double of another edge.
    fn retire_edges(&mut self, gone_side: usize) {
        for neighbour in self.ring.neighbours.iter().filter(|n| n.is_common()) {
            self.queue.remove(neighbour.edges[gone_side]);
        }
    }

    /// Gives the triangles of the vanishing end to the other one, without those that vanish.
    fn join_triangles(&mut self, kept_side: usize) {
        let Self { surface, ring, .. } = self;
        let [kept, gone] = [ring.ends[kept_side], ring.ends[1 - kept_side]];
        for &triangle in ring.on_edge.iter().chain(&ring.covered) {
            surface.remove_triangle(triangle, ring.ends);
        }
        surface.clear_corners(kept);
        surface.clear_corners(gone);
        for (side, corner) in ring.lasting() {
            if side != kept_side {
                adopt_edges(surface, ring, corner, kept_side);
            }
            surface.attach(corner, kept);
        }
    }

    fn move_vertex(&mut self, kept: u32, candidate: &Candidate) {
        let position = &mut self.surface.positions[kept as usize];
        if *position != candidate.position {
            *position = candidate.position;
            self.vertices.moved[kept as usize] = true;
        }
    }

    /// Gives every edge at the new vertex its new cost.
    fn requeue_edges(&mut self, kept: u32, kept_side: usize) {
        for i in 0..self.ring.neighbours.len() {
            let neighbour = self.ring.neighbours[i];
            let kept_edge = neighbour.edges[kept_side];
            let edge = if kept_edge == NONE { neighbour.edges[1 - kept_side] } else { kept_edge };
            self.requeue(edge, [kept, neighbour.vertex]);
        }
    }

    fn requeue(&mut self, edge: u32, ends: [u32; 2]) {
        match assess(&self.surface, &self.metric, &self.vertices, ends) {
            Some(candidate) => self.queue.set(edge, key_of(&self.surface, ends, &candidate)),
            None => self.queue.set_aside(edge, record(&self.surface, ends)),
        }
    }

    /// Puts refused edges at the neighbours of `kept` back into the queue: their surroundings have changed.
    fn retry_refused(&mut self, kept: u32) {
        self.vertices.has_refused[kept as usize] = false;
        for i in 0..self.ring.neighbours.len() {
            let vertex = self.ring.neighbours[i].vertex;
            if std::mem::take(&mut self.vertices.has_refused[vertex as usize]) {
                self.retry_around(vertex);
            }
        }
    }

    fn retry_around(&mut self, vertex: u32) {
        self.waiting.clear();
        for corner in self.surface.corners(vertex) {
            let triangle = self.surface.triangle(corner.triangle);
            let [k1, k2] = corner.others();
            self.waiting.extend([triangle.edges[k1], triangle.edges[k2]].iter().filter(|&&e| !self.queue.contains(e)));
        }
        for i in 0..self.waiting.len() {
            let edge = self.waiting[i];
            self.requeue(edge, self.queue.ends(edge));
        }
    }
}

/// Where a triangle that changes ends meets an edge that the kept end has too, it takes that one for its own.
fn adopt_edges(surface: &mut Surface, ring: &Ring, corner: Corner, kept_side: usize) {
    let triangle = &mut surface.triangles[corner.triangle as usize];
    let [k1, k2] = corner.others();
    for (to, opposite) in [(k1, k2), (k2, k1)] {
        let kept_edge = ring.neighbour(triangle.vertices[to]).edges[kept_side];
        if kept_edge != NONE {
            triangle.edges[opposite] = kept_edge;
        }
    }
}

/// What would become of the edge, `None` if both ends are locked.
fn assess<M: Metric>(surface: &Surface, metric: &M, vertices: &Vertices, ends: [u32; 2]) -> Option<Candidate> {
    vertices.pinned(ends).map(|pinned| metric.candidate(surface, ends, pinned))
}

fn key_of(surface: &Surface, ends: [u32; 2], candidate: &Candidate) -> Key {
    Key { cost: candidate.cost, second_cost: candidate.second_cost, edge: record(surface, ends) }
}

fn record(surface: &Surface, ends: [u32; 2]) -> Edge {
    let [u, v] = ends.map(|v| surface.positions[v as usize]);
    Edge { ends, length_squared: u.distance_squared(v) as f32 }
}
