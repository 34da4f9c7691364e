use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use rayon::prelude::*;

use crate::backend::{Workload, draw_all};
use crate::camera::{Axis, CameraSphere, View, Window};
use crate::error::Result;
use crate::mesh::TriangleId;
use crate::raster::{Hit, ItemBufferPair, Side};
use crate::visibility::estimate::{Estimate, Looking};
use crate::visibility::leaks::{Pair, RescuedSample, leaks};
use crate::visibility::pieces::{Facing, Pieces};
use crate::visibility::rescue::{Candidate, Soundings, tolerance};
use crate::visibility::{Details, Rescue, Shapes, Sides, Subject};

/// A camera sees a piece of a triangle or it does not: [`crate::visibility::Estimator::ItemBuffer`].
///
/// Source: Zhang & Turk 2002, section 4 and eq. (4.3). Large triangles are cut into pieces; a piece is seen by the cameras
/// that show it in a pixel, and by those that depth rescue adds; V of a triangle is the mean over its pieces by area.
///
/// # Errors
/// As [`draw_all`]; [`crate::Error::Limit`] where the pieces do not fit the memory limit.
pub(super) fn estimate(subject: &Subject<'_>, shapes: &Shapes, looking: &Looking<'_>) -> Result<Estimate> {
    let options = looking.options;
    let window = Window::around_sphere(options.resolution_for(subject.mesh().triangle_count()));
    let pieces = Pieces::of(subject, shapes, window, options)?;
    let load = Workload { window, memory_limit: options.memory_limit, phase: "visibility", progress: looking.progress };
    let tally = Tally::of(pieces.count(), options.rays.seed);
    let views: Vec<View> = looking.cameras.axes().iter().map(|axis| View::along(axis, window)).collect();
    draw_all(&pieces, &views, load, |number, buffers| {
        let sight = Sight::of(&pieces, &views[number], buffers, options.sides);
        tally.add(&sight, &looking.cameras.axes()[number], looking);
        Ok(())
    })?;
    // Among occluders, to be hidden altogether is a result.
    if !tally.is_anything_shown.into_inner() && subject.occluders().is_empty() {
        return Err(subject.nothing_to_see());
    }
    let (front, back) = visibilities(&pieces, &tally.seen, looking.cameras);
    let (count, rescue) = (pieces.count(), tally.rescue.read());
    let rays = tally.rescued.into_rays(&pieces, subject, looking.cameras);
    // What asks the rays may need the room.
    drop((pieces, tally.seen));
    let rescue = Rescue { leaks: leaks(&rays, subject)?, ..rescue };
    let details = Details { rescue: Some(rescue), pieces: Some(count), ..Details::default() };
    Ok(Estimate { front, back, pooled_below: 0.0, resolution: window.width, details })
}

/// Who sees which piece, over all cameras.
struct Tally {
    /// Per piece for its front and its back: Σ weight · cosine, in steps, over the cameras that see it.
    seen: Vec<[AtomicU64; 2]>,
    rescue: RescueTally,
    rescued: RescuedSample,
    is_anything_shown: AtomicBool,
}

impl Tally {
    fn of(pieces: usize, seed: u64) -> Self {
        let seen = (0..pieces).map(|_| [AtomicU64::new(0), AtomicU64::new(0)]).collect();
        let (rescue, rescued) = (RescueTally::default(), RescuedSample::new(seed));
        Self { seen, rescue, rescued, is_anything_shown: AtomicBool::new(false) }
    }

    /// Adds what the two cameras of an axis see.
    fn add(&self, sight: &Sight<'_>, axis: &Axis, looking: &Looking<'_>) {
        let mut rescue = Rescue::default();
        for piece in (0..sight.pieces.count() as u32).map(TriangleId) {
            let parent = sight.pieces.cut.parent(piece);
            let Some(facing) = sight.pieces.facing(parent, axis.direction) else { continue };
            for (camera, number) in [axis.near, axis.far].into_iter().enumerate() {
                let Some(number) = number else { continue };
                let rescued_before = rescue.rescued;
                if sight.sees(piece, camera, facing, &mut rescue) {
                    let seen = &self.seen[piece.0 as usize][facing.side(camera) as usize];
                    seen.fetch_add(looking.cameras.weight(number) * facing.steps, Ordering::Relaxed);
                    looking.diagram.into_iter().for_each(|diagram| diagram.record(parent, number as usize));
                    if rescue.rescued > rescued_before {
                        self.rescued.offer(Pair { piece: piece.0, camera: number });
                    }
                }
            }
        }
        self.rescue.add(rescue);
        self.is_anything_shown.fetch_or(sight.shown.iter().any(|&by| by != 0), Ordering::Relaxed);
    }
}

/// What the two cameras of an axis see.
struct Sight<'a> {
    pieces: &'a Pieces<'a>,
    window: Window,
    /// Per piece the cameras with a pixel of it: bit 0 for the near one, bit 1 for the far one.
    shown: Vec<u8>,
    soundings: Soundings,
    rescues_backs: bool,
}

impl<'a> Sight<'a> {
    fn of(pieces: &'a Pieces<'_>, view: &View, buffers: &ItemBufferPair, sides: Sides) -> Self {
        let mut shown = vec![0; pieces.count()];
        let mut mark = |hit: Hit, bit: u8| {
            // Occluders have the numbers behind those of the pieces.
            if let Some(cameras) = shown.get_mut(hit.triangle.0 as usize) {
                *cameras |= bit;
            }
        };
        buffers.near().flatten().for_each(|hit| mark(hit, 1));
        buffers.far().flatten().for_each(|hit| mark(hit, 2));
        let soundings = pieces.rescuer.sound(view, buffers, pieces.extent, &pieces.positions);
        Self { pieces, window: view.window, shown, soundings, rescues_backs: sides != Sides::One }
    }

    /// Whether a camera, 0 for the near and 1 for the far one, sees the side of a piece that faces it.
    ///
    /// A rule for sides that never looks at backs has none of them rescued: where it is closed, a mesh has no visible
    /// backs, and rescue would find some on its outline.
    fn sees(&self, piece: TriangleId, camera: usize, facing: Facing, rescue: &mut Rescue) -> bool {
        let has_pixel = self.shown[piece.0 as usize] >> camera & 1 == 1;
        if facing.side(camera) == Side::Back && !self.rescues_backs {
            return has_pixel;
        }
        if has_pixel {
            rescue.with_pixel += 1;
            return true;
        }
        let candidate = Candidate { piece, camera, tolerance: tolerance(self.window.pixel_size(), facing.cosine()) };
        let rescued = self.pieces.rescuer.rescues(&candidate, &self.soundings, &self.pieces.cut, self.pieces.shapes);
        rescue.without_pixel += 1;
        rescue.rescued += u64::from(rescued);
        rescued
    }
}

/// [`Rescue`], counted from many threads.
#[derive(Default)]
struct RescueTally {
    with_pixel: AtomicU64,
    without_pixel: AtomicU64,
    rescued: AtomicU64,
}

impl RescueTally {
    fn add(&self, rescue: Rescue) {
        self.with_pixel.fetch_add(rescue.with_pixel, Ordering::Relaxed);
        self.without_pixel.fetch_add(rescue.without_pixel, Ordering::Relaxed);
        self.rescued.fetch_add(rescue.rescued, Ordering::Relaxed);
    }

    fn read(&self) -> Rescue {
        let [with_pixel, without_pixel, rescued] =
            [&self.with_pixel, &self.without_pixel, &self.rescued].map(|count| count.load(Ordering::Relaxed));
        Rescue { with_pixel, without_pixel, rescued, leaks: None }
    }
}

/// V of the front and of the back of each triangle; Zhang & Turk 2002, eq. (4.3), both sums over the cameras that face the
/// side, those that a hemisphere leaves out included. A side that no camera faces gets 0.
fn visibilities(pieces: &Pieces<'_>, seen: &[[AtomicU64; 2]], cameras: &CameraSphere) -> (Vec<f64>, Vec<f64>) {
    let facing = |t: u32| {
        let mut sums = [0; 2];
        for &(direction, weight) in cameras.pattern() {
            if let Some(facing) = pieces.facing(TriangleId(t), direction) {
                sums[facing.side(0) as usize] += weight * facing.steps;
            }
        }
        sums
    };
    let all: Vec<[u64; 2]> = (0..pieces.shapes.areas.len() as u32).into_par_iter().map(facing).collect();
    let (mut front, mut back) = (vec![0.0; all.len()], vec![0.0; all.len()]);
    for (piece, seen) in (0..).map(TriangleId).zip(seen) {
        let t = pieces.cut.parent(piece).0 as usize;
        for (side, visibility) in [&mut front[t], &mut back[t]].into_iter().enumerate() {
            let seen = seen[side].load(Ordering::Relaxed);
            if seen > 0 {
                *visibility += pieces.cut.share(piece) * (seen as f64 / all[t][side] as f64);
            }
        }
    }
    (front, back)
}
