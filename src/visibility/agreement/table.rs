use glam::DVec3;
use rayon::prelude::*;

use crate::camera::CameraSphere;
use crate::mesh::TriangleId;
use crate::visibility::agreement::causes::{Cause, Causes, Outline};
use crate::visibility::agreement::pixels::Differing;
use crate::visibility::agreement::{Compared, Comparing, Measurement, SeenAgreement};
use crate::visibility::{Shapes, VisibilityDiagram};

/// A table of two yes-or-no answers to the same questions: does A see it, does B?
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Confusion {
    /// Both do.
    pub n11: f64,
    /// Only A does.
    pub n10: f64,
    /// Only B does.
    pub n01: f64,
    /// Neither does.
    pub n00: f64,
}

impl Confusion {
    /// All questions.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.n11 + self.n10 + self.n01 + self.n00
    }

    /// Share of the questions with equal answers; 1 if there are none.
    #[must_use]
    pub fn agreement(&self) -> f64 {
        if self.total() == 0.0 { 1.0 } else { (self.n11 + self.n00) / self.total() }
    }

    /// Agreement beyond what chance would give, from 1 (perfect) over 0 (chance) to below; 1 also where chance alone must
    /// agree, because both always give the same answer.
    ///
    /// Source: Cohen 1960, κ = (p_o − p_e) / (1 − p_e).
    #[must_use]
    pub fn kappa(&self) -> f64 {
        let chance_alone = self.n10 == 0.0 && self.n01 == 0.0 && (self.n11 == 0.0 || self.n00 == 0.0);
        if chance_alone {
            return 1.0;
        }
        let yes = (self.n11 + self.n10) * (self.n11 + self.n01);
        let no = (self.n01 + self.n00) * (self.n10 + self.n00);
        let expected = (yes + no) / (self.total() * self.total());
        (self.agreement() - expected) / (1.0 - expected)
    }

    /// Share of what anyone sees that only one sees: most pairs are unseen by both, and plain agreement hides errors there.
    #[must_use]
    pub fn differing(&self) -> f64 {
        let seen = self.n11 + self.n10 + self.n01;
        if seen == 0.0 { 0.0 } else { (self.n10 + self.n01) / seen }
    }

    fn add(&mut self, [a, b]: [bool; 2], amount: f64) {
        *match (a, b) {
            (true, true) => &mut self.n11,
            (true, false) => &mut self.n10,
            (false, true) => &mut self.n01,
            (false, false) => &mut self.n00,
        } += amount;
    }

    fn plus(self, other: Self) -> Self {
        Self {
            n11: self.n11 + other.n11,
            n10: self.n10 + other.n10,
            n01: self.n01 + other.n01,
            n00: self.n00 + other.n00,
        }
    }
}

/// A camera is in front of a side where its cosine passes this, and edge-on below.
const EDGE_ON: f64 = 1e-9;

/// Triangles that one task goes through; fixed, so that sums do not depend on the number of threads.
const CHUNK: usize = 4096;

/// Everything that comparing pairs of a triangle and a camera needs.
pub(super) struct Pairs<'a> {
    pub a: &'a Measurement<'a>,
    pub b: &'a Measurement<'a>,
    pub comparing: Comparing<'a>,
    pub shapes: &'a Shapes,
    pub compared: &'a [Compared],
    pub differing: &'a Differing,
}

/// A camera before a triangle.
#[derive(Clone, Copy)]
struct Looker {
    camera: usize,
    toward: DVec3,
    cosine: f64,
}

/// What one task found.
#[derive(Default)]
struct Tally {
    counts: Confusion,
    weighted: Confusion,
    causes: Causes,
    contact_pairs: u64,
    per_camera: Vec<u64>,
}

impl Pairs<'_> {
    /// Goes through all pairs; also returns how many were left out as contacts.
    pub fn tally(&self, a: &VisibilityDiagram, b: &VisibilityDiagram) -> (SeenAgreement, u64) {
        let weights = weights_of(self.comparing.cameras);
        let tasks = (0..self.compared.len().div_ceil(CHUNK)).into_par_iter();
        let tallies: Vec<Tally> = tasks
            .map(|task| {
                let mut tally = Tally { per_camera: vec![0; weights.len()], ..Tally::default() };
                for t in task * CHUNK..self.compared.len().min((task + 1) * CHUNK) {
                    self.tally_triangle(t, [a, b], &weights, &mut tally);
                }
                tally
            })
            .collect();
        let empty = Tally { per_camera: vec![0; weights.len()], ..Tally::default() };
        let all = tallies.into_iter().fold(empty, Tally::plus);
        // The first of the largest: `max_by_key` would take the last.
        let most = all.per_camera.iter().copied().max().filter(|&most| most > 0);
        let worst_camera = most.and_then(|most| all.per_camera.iter().position(|&n| n == most));
        let Tally { counts, weighted, causes, contact_pairs, .. } = all;
        (SeenAgreement { counts, weighted, causes, worst_camera }, contact_pairs)
    }

    fn tally_triangle(&self, t: usize, diagrams: [&VisibilityDiagram; 2], weights: &[f64], tally: &mut Tally) {
        let normal = self.shapes.normal(t);
        let id = TriangleId(t as u32);
        let [a, b] = diagrams.map(|d| d.row(id));
        for (camera, &toward) in self.comparing.cameras.directions().iter().enumerate() {
            let cosine = toward.dot(normal);
            let Compared { front, back } = self.compared[t];
            if !(front && cosine > EDGE_ON || back && cosine < -EDGE_ON) {
                continue;
            }
            let sees = [a, b].map(|row| row[camera / 64] >> (camera % 64) & 1 == 1);
            if sees[0] != sees[1] {
                tally.per_camera[camera] += 1;
                let cause = self.cause(id, Looker { camera, toward, cosine }, sees);
                tally.causes.count(cause);
                if cause == Cause::CoplanarContact {
                    tally.contact_pairs += 1;
                    continue;
                }
            }
            tally.counts.add(sees, 1.0);
            tally.weighted.add(sees, self.shapes.areas[t] * cosine.abs() * weights[camera]);
        }
    }

    fn cause(&self, triangle: TriangleId, looker: Looker, sees: [bool; 2]) -> Cause {
        if self.differing.is_contact(triangle, looker.camera) {
            return Cause::CoplanarContact;
        }
        let subject = self.a.subject;
        let corners = subject.mesh().corners(triangle).map(|p| subject.frame().to_unit(p));
        let several = self.differing.shows_several(triangle, looker.camera, sees);
        Outline::of(corners, looker.toward, self.differing.pixel_size).cause(looker.cosine, several)
    }
}

impl Tally {
    fn plus(mut self, other: Self) -> Self {
        self.per_camera.iter_mut().zip(other.per_camera).for_each(|(sum, n)| *sum += n);
        Self {
            counts: self.counts.plus(other.counts),
            weighted: self.weighted.plus(other.weighted),
            causes: self.causes.plus(other.causes),
            contact_pairs: self.contact_pairs + other.contact_pairs,
            per_camera: self.per_camera,
        }
    }
}

/// How much each camera counts.
fn weights_of(cameras: &CameraSphere) -> Vec<f64> {
    (0..cameras.count() as u32).map(|camera| cameras.weight(camera) as f64).collect()
}
