use glam::DVec3;

use crate::backend::{ItemBuffers, Machine, MachineScratch};
use crate::camera::{Frame, View, Window};
use crate::error::Result;
use crate::mesh::{Subdivision, TriMesh, TriangleId};
use crate::raster::{ItemBufferPair, Side};
use crate::visibility::rescue::{Rescuer, Soundings};
use crate::visibility::{MeasureOptions, Shapes, Subject};

/// Longest edge of a piece, in pixels: √(2 ρ m / κ).
///
/// A triangle of longest edge l and aspect ratio ρ = 2 (isosceles with a right angle) has the area l² / (2 ρ); turned away
/// as far as the worst case of Zhang & Turk, cosine κ = 0.25, its image is to have m = 4 pixels.
const LONGEST_EDGE: f64 = 8.0;

/// A piece as it is cut, narrowed, laid out for the machine and counted, with its share of the vertices.
const BYTES_PER_PIECE: u64 = 128;

/// About how many pieces [`crate::visibility::Estimator::ItemBuffer`] cuts a mesh into under these options.
#[must_use]
pub fn estimated_pieces(mesh: &TriMesh, options: &MeasureOptions) -> f64 {
    let window = Window::around_sphere(options.resolution_for(mesh.triangle_count()));
    Subdivision::estimate(mesh, longest_edge(window, &Frame::of(mesh)))
}

/// Longest edge of a piece, in model units.
fn longest_edge(window: Window, frame: &Frame) -> f64 {
    LONGEST_EDGE * window.pixel_size() * frame.radius
}

/// A mesh cut into pieces that are not much larger than pixels, laid out for the machine that looks at them.
pub(super) struct Pieces<'a> {
    pub cut: Subdivision,
    pub shapes: &'a Shapes,
    pub rescuer: Rescuer,
    /// Vertices of the pieces as the machine draws them.
    pub positions: Vec<[f32; 3]>,
    /// Largest distance from the centre, occluders included.
    pub extent: f64,
    machine: Machine,
}

/// How a triangle stands to an axis.
#[derive(Clone, Copy)]
pub(super) struct Facing {
    /// Cosine between its normal and the axis, without its sign, in steps of [`Facing::STEP`].
    ///
    /// Integers, so that sums do not depend on their order, and what everyone sees has a visibility of exactly 1.
    pub steps: u64,
    near_sees_front: bool,
}

impl Facing {
    const STEP: f64 = 1.0 / 4_294_967_296.0;

    pub fn cosine(self) -> f64 {
        self.steps as f64 * Self::STEP
    }

    /// The side that a camera of the axis faces: 0 is the near one, 1 the far one.
    pub fn side(self, camera: usize) -> Side {
        if self.near_sees_front == (camera == 0) { Side::Front } else { Side::Back }
    }
}

impl<'a> Pieces<'a> {
    /// Cuts the mesh for a window.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] where the pieces do not fit the memory limit, and what the machine says.
    pub fn of(subject: &Subject<'_>, shapes: &'a Shapes, window: Window, options: &MeasureOptions) -> Result<Self> {
        let frame = subject.frame();
        let most = options.memory_limit.map_or(usize::MAX, |bytes| (bytes / BYTES_PER_PIECE) as usize);
        let cut = Subdivision::of(subject.mesh(), longest_edge(window, frame), most)?;
        // However small a piece is, it can be seen if the whole can.
        let unit = frame.unit_copy_of(cut.mesh(), |piece| shapes.areas[cut.parent(piece).0 as usize] > 0.0);
        let positions = unit.positions.clone();
        let unit = frame.among(unit, cut.mesh().triangle_count(), subject.occluders())?;
        let extent = unit.extent;
        let machine = Machine::new(subject.machine().kind(), unit)?;
        Ok(Self { rescuer: Rescuer::new(options.rescue, &cut), cut, shapes, positions, extent, machine })
    }

    pub fn count(&self) -> usize {
        self.cut.mesh().triangle_count()
    }

    /// How a triangle stands to an axis along `direction`; `None` for one that cannot be seen, or only edge-on.
    pub fn facing(&self, triangle: TriangleId, direction: DVec3) -> Option<Facing> {
        const EDGE_ON: f64 = 1e-9;
        let t = triangle.0 as usize;
        let cosine = self.shapes.normal(t).dot(direction);
        let steps = (cosine.abs() / Facing::STEP + 0.5) as u64;
        let counts = self.shapes.areas[t] > 0.0 && cosine.abs() > EDGE_ON;
        counts.then_some(Facing { steps, near_sees_front: cosine > 0.0 })
    }
}

impl ItemBuffers for Pieces<'_> {
    type Scratch = MachineScratch;

    fn draw(&self, view: &View, scratch: &mut MachineScratch, buffers: &mut ItemBufferPair) -> Result<()> {
        self.machine.draw(view, scratch, buffers)
    }

    fn bytes_per_worker(&self, window: Window) -> u64 {
        self.machine.bytes_per_worker(window) + Soundings::bytes(self.positions.len()) + self.count() as u64
    }
}
