//! The driver: cheapest edge first, until a target is met.

use super::Stop;
use super::guards::Guards;
use super::metric::{Candidate, Metric};
use super::queue::{EdgeQueue, Rated};
use super::ring::Ring;
use super::surface::{Corner, Surface};
use crate::error::Result;
use crate::mesh::adjacency::NONE;
use crate::progress::Progress;

/// Attempts between two looks at whether to stop.
const ATTEMPTS_PER_CHECK: u64 = 1000;

/// A surface that shrinks by edge collapses in the order that a metric gives.
#[derive(Debug)]
pub struct EdgeCollapser<M> {
    state: State,
    metric: M,
    limits: Limits,
    queue: EdgeQueue,
    ring: Ring,
    /// Scratch: edges about to return to the queue.
    rated: Vec<Rated>,
    withheld_by_error: bool,
}

/// Which collapses are allowed.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// What must hold around the edge.
    pub guards: Guards,
    /// Largest mean square distance, in unit-sphere units squared.
    pub max_mean_square: f64,
}

/// What a run has come to so far: all that a level of detail is made of.
#[derive(Debug)]
pub struct State {
    /// Triangles and positions.
    pub surface: Surface,
    /// What became of each vertex.
    pub vertices: Vertices,
    /// Sums over the collapses done.
    pub tally: Tally,
}

/// Sums over the collapses done.
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
    fn new(locked: Vec<bool>) -> Self {
        let count = locked.len();
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
    /// A collapser of `surface`, whose edges are `edges`, with all of them in the queue.
    pub fn new(surface: Surface, metric: M, edges: Vec<[u32; 2]>, locked: Vec<bool>, limits: Limits) -> Self {
        let count = surface.positions.len();
        let vertices = Vertices::new(locked);
        let queue = EdgeQueue::new(edges, metric.has_second_cost(), |edge, ends| {
            rate(&surface, &metric, &vertices, edge, ends)
        });
        Self {
            state: State { surface, vertices, tally: Tally::default() },
            metric,
            limits,
            queue,
            ring: Ring::new(count),
            rated: Vec::new(),
            withheld_by_error: false,
        }
    }

    /// Collapses until at most `target` triangles are left, or no collapse is allowed any more.
    ///
    /// `floor`, at most `target`, is where the whole of the work ends; progress is reported toward it.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub fn run(&mut self, target: usize, floor: usize, progress: &dyn Progress) -> Result<Stop> {
        progress.check()?;
        let mut attempts = 0;
        while self.state.surface.alive > target {
            if attempts % ATTEMPTS_PER_CHECK == 0 {
                progress.check()?;
                self.report(floor, progress);
            }
            attempts += 1;
            let Some(edge) = self.queue.pop() else {
                return Ok(if self.withheld_by_error { Stop::Error } else { Stop::QueueEmpty });
            };
            self.attempt(edge);
        }
        self.report(floor, progress);
        Ok(Stop::Target)
    }

    fn report(&self, floor: usize, progress: &dyn Progress) {
        let Surface { triangles, alive, .. } = &self.state.surface;
        let total = triangles.len().saturating_sub(floor);
        progress.report("simplify", (triangles.len() - alive).min(total) as u64, total as u64);
    }

    /// What the run has come to so far.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// What the run has come to, without what was needed to go on.
    pub fn into_state(self) -> State {
        self.state
    }

    /// Collapses the edge if that is allowed.
    fn attempt(&mut self, edge: u32) {
        let ends = self.queue.ends(edge);
        self.ring.gather(&self.state.surface, ends);
        // An edge whose last triangles were cancelled is met here once more.
        if self.ring.on_edge.is_empty() {
            return;
        }
        let Some(candidate) = assess(&self.state.surface, &self.metric, &self.state.vertices, ends) else {
            return;
        };
        if candidate.mean_square > self.limits.max_mean_square {
            self.withheld_by_error = true;
            return;
        }
        let is_free = candidate.cost == 0.0;
        if self.limits.guards.allow(
            &self.state.surface,
            &self.ring,
            &self.state.vertices.locked,
            candidate.position,
            is_free,
        ) {
            self.collapse(&candidate);
        } else {
            ends.iter().for_each(|&v| self.state.vertices.has_refused[v as usize] = true);
        }
    }

    fn collapse(&mut self, candidate: &Candidate) {
        let kept_side = self.side_that_stays(candidate);
        let [kept, gone] = [self.ring.ends[kept_side], self.ring.ends[1 - kept_side]];
        self.retire_edges(1 - kept_side);
        self.join_triangles(kept_side);
        self.move_vertex(kept, candidate);
        self.state.vertices.parent[gone as usize] = kept;
        self.metric.merge(gone, kept);
        self.state.tally.mean_square = self.state.tally.mean_square.max(candidate.mean_square);
        self.state.tally.cancelled_pairs += self.ring.cancelled_pairs;
        self.requeue_edges(kept, kept_side);
        self.retry_refused(kept);
    }

    /// The end whose number lives on: one that keeps its position, else the smaller.
    fn side_that_stays(&self, candidate: &Candidate) -> usize {
        let ends = self.ring.ends;
        let stays = |side: usize| self.state.surface.positions[ends[side] as usize] == candidate.position;
        match [stays(0), stays(1)] {
            [true, false] => 0,
            [false, true] => 1,
            [true, true] if self.state.vertices.locked[ends[0] as usize] => 0,
            [true, true] if self.state.vertices.locked[ends[1] as usize] => 1,
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
        let Self { state: State { surface, .. }, ring, .. } = self;
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
        let position = &mut self.state.surface.positions[kept as usize];
        if *position != candidate.position {
            *position = candidate.position;
            self.state.vertices.moved[kept as usize] = true;
        }
    }

    /// Gives every edge at the new vertex its new cost.
    ///
    /// All are rated before the first moves in the queue: the processor can then fetch the next quadrics while it
    /// works on the last, which branches in the queue would keep it from.
    fn requeue_edges(&mut self, kept: u32, kept_side: usize) {
        let Self { state: State { surface, vertices, .. }, metric, queue, ring, rated, .. } = self;
        rated.clear();
        rated.extend(ring.neighbours.iter().map(|neighbour| {
            let kept_edge = neighbour.edges[kept_side];
            let edge = if kept_edge == NONE { neighbour.edges[1 - kept_side] } else { kept_edge };
            rate(surface, metric, vertices, edge, [kept, neighbour.vertex])
        }));
        rated.iter().for_each(|rated| queue.place(rated));
    }

    /// Puts refused edges at the neighbours of `kept` back into the queue: their surroundings have changed.
    fn retry_refused(&mut self, kept: u32) {
        self.state.vertices.has_refused[kept as usize] = false;
        for i in 0..self.ring.neighbours.len() {
            let vertex = self.ring.neighbours[i].vertex;
            if std::mem::take(&mut self.state.vertices.has_refused[vertex as usize]) {
                self.retry_around(vertex);
            }
        }
    }

    fn retry_around(&mut self, vertex: u32) {
        let Self { state: State { surface, vertices, .. }, metric, queue, rated, .. } = self;
        rated.clear();
        for corner in surface.corners(vertex) {
            let triangle = surface.triangle(corner.triangle);
            let edges = corner.others().map(|k| triangle.edges[k]);
            let waiting = edges.into_iter().filter(|&edge| !queue.contains(edge));
            rated.extend(waiting.map(|edge| rate(surface, metric, vertices, edge, queue.ends(edge))));
        }
        rated.iter().for_each(|rated| queue.place(rated));
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

/// What would become of the edge between `ends`, `None` if both are locked.
fn assess<M: Metric>(surface: &Surface, metric: &M, vertices: &Vertices, ends: [u32; 2]) -> Option<Candidate> {
    vertices.pinned(ends).map(|pinned| metric.candidate(surface, ends, pinned))
}

fn rate<M: Metric>(surface: &Surface, metric: &M, vertices: &Vertices, edge: u32, ends: [u32; 2]) -> Rated {
    let [u, v] = ends.map(|v| surface.positions[v as usize]);
    let costs = assess(surface, metric, vertices, ends).map(|c| [c.cost, c.second_cost]);
    Rated { edge, ends, length_squared: u.distance_squared(v) as f32, costs }
}
