//! Estimates of memory and time, made before the work.

use outsight::Result;
use outsight::pipeline::{Cell, Metric, PlannedCell, Preset, ZtRequest};
use outsight::visibility::{MeasureOptions, VisibilityDiagram, nested_resolution};

/// What a run does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Task {
    /// Only reads.
    Read,
    /// Measures visibility with images of this many pixels along the side.
    Measure {
        /// Pixels along the side; 0 where not known before reading.
        resolution: u32,
        /// Cameras; 0 where none takes pictures.
        cameras: usize,
    },
    /// Measures, and writes down which camera sees which triangle.
    Diagram {
        /// As in `Measure`.
        resolution: u32,
        /// Cameras.
        cameras: usize,
        /// Also the visible share of each triangle's image.
        fractions: bool,
    },
    /// Measures twice, keeping for each who sees what, and again what differs.
    Verify {
        /// Pixels along the side; 0 where not known before reading.
        resolution: u32,
        /// Cameras.
        cameras: usize,
    },
    /// Measures and simplifies.
    Simplify {
        /// Pixels along the side; 0 where not known before reading.
        resolution: u32,
        /// Cameras; 0 where none takes pictures.
        cameras: usize,
    },
    /// Measures from many patterns at once.
    Study {
        /// Pixels along the side; `None` where the study chooses them by the triangles.
        resolution: Option<u32>,
    },
    /// Measures the reference, draws and compares meshes.
    Compare {
        /// Pixels along the side of the images that measure; 0 where not known before reading.
        resolution: u32,
    },
}

/// The program itself, its threads and their stacks.
const FLOOR_BYTES: u64 = 24 << 20;
/// A triangle and the half vertex that it brings, as read: indices, position, and the file's bytes beside them.
const READ_BYTES: u64 = 64;
/// A triangle while it is looked at: its `f32` copy, its two counts, its visibility.
const MEASURE_BYTES: u64 = 120;
/// A triangle in a study, besides: a count and a visibility for each of twelve patterns.
const STUDY_BYTES: u64 = 192;
/// A triangle while it is simplified: quadrics, heap and rings of its share of vertices and edges.
const SIMPLIFY_BYTES: u64 = 250;
/// Who sees what by either measurement, and the pairs of several pixels and of contacts among what differs.
const VERIFY_DIAGRAMS: u64 = 4;
/// Two pictures at a time, and what they show spread out.
const VERIFY_IMAGES: u64 = 4;
/// A triangle while it is compared: the search tree and the samples.
const COMPARE_BYTES: u64 = 200;
/// The reference's pictures.
const COMPARE_PICTURES: u64 = 140 << 20;
/// The item buffers and pictures of one axis, for each thread.
const COMPARE_AXIS: u64 = 32 << 20;
/// A pixel of the two item buffers of an axis: near and far, triangle and depth each.
const PIXEL_BYTES: u64 = 16;

/// Memory that `task` needs on a mesh of that many triangles, in bytes. Rough: within a factor of two.
pub fn memory_bytes(task: Task, triangles: usize) -> u64 {
    let triangles = triangles as u64;
    let images = |resolution: u32| {
        let side = u64::from(resolution_or_chosen(resolution, triangles));
        PIXEL_BYTES * side * side * rayon::current_num_threads() as u64
    };
    let working = match task {
        Task::Read => 0,
        Task::Measure { resolution, .. } => MEASURE_BYTES * triangles + images(resolution),
        Task::Diagram { resolution, cameras, fractions } => {
            let row = cameras.div_ceil(64) * 8 + if fractions { cameras } else { 0 };
            (MEASURE_BYTES + row as u64) * triangles + images(resolution)
        }
        Task::Simplify { resolution, .. } => SIMPLIFY_BYTES.max(MEASURE_BYTES) * triangles + images(resolution),
        Task::Study { resolution } => {
            let resolution = resolution.unwrap_or_else(|| nested_resolution(triangles as usize));
            (MEASURE_BYTES + STUDY_BYTES) * triangles + images(resolution)
        }
        Task::Verify { resolution, cameras } => {
            let diagrams = VERIFY_DIAGRAMS * VisibilityDiagram::bytes(triangles as usize, cameras);
            diagrams + 2 * MEASURE_BYTES * triangles + VERIFY_IMAGES * images(resolution)
        }
        Task::Compare { resolution } => {
            let drawing = COMPARE_PICTURES + COMPARE_AXIS * rayon::current_num_threads() as u64;
            COMPARE_BYTES * triangles + drawing.max(images(resolution))
        }
    };
    FLOOR_BYTES + READ_BYTES * triangles + working
}

/// Cameras that take pictures under these options.
///
/// # Errors
/// As [`MeasureOptions::camera_sphere`].
pub fn cameras_drawing(options: &MeasureOptions) -> Result<usize> {
    if options.estimator.draws() { Ok(options.camera_sphere()?.count()) } else { Ok(0) }
}

/// Resolution that measuring chooses by itself where none is given.
fn resolution_or_chosen(resolution: u32, triangles: u64) -> u32 {
    if resolution == 0 { MeasureOptions::default().resolution_for(triangles as usize) } else { resolution }
}

/// Seconds of one thread per triangle and camera axis, measured on scans of 0.1 to 1 million triangles.
const SECONDS_PER_TRIANGLE_AXIS: f64 = 4e-8;
/// Seconds of one thread per pixel and camera axis: clearing and counting.
const SECONDS_PER_PIXEL_AXIS: f64 = 1.5e-8;
/// Triangles that one thread takes away in a second.
const COLLAPSED_TRIANGLES_PER_SECOND: f64 = 250_000.0;

/// Seconds of `task` on a mesh of that many triangles, on the threads of this run, where pictures take most of the time.
/// Rough; for a simplification to a small share of the triangles.
pub fn seconds(task: Task, triangles: usize) -> Option<f64> {
    match task {
        Task::Measure { resolution, cameras } | Task::Diagram { resolution, cameras, .. } => {
            Some(measure_seconds(triangles, cameras, resolution))
        }
        Task::Simplify { resolution, cameras } => {
            let looking = (1.0 + LOOKING_AGAIN) * measure_seconds(triangles, cameras, resolution);
            Some(looking + triangles as f64 / COLLAPSED_TRIANGLES_PER_SECOND)
        }
        Task::Read | Task::Verify { .. } | Task::Study { .. } | Task::Compare { .. } => None,
    }
}

fn measure_seconds(triangles: usize, cameras: usize, resolution: u32) -> f64 {
    let side = f64::from(resolution_or_chosen(resolution, triangles as u64));
    let axis = SECONDS_PER_TRIANGLE_AXIS * triangles as f64 + SECONDS_PER_PIXEL_AXIS * side * side;
    axis * cameras as f64 / 2.0 / rayon::current_num_threads() as f64
}

/// Seconds of one thread to compare a level with an original, more for each of the original's triangles and each sample.
const LEVEL_SECONDS: f64 = 0.8;
const LEVEL_SECONDS_PER_TRIANGLE: f64 = 2e-6;
const LEVEL_SECONDS_PER_SAMPLE: f64 = 7e-7;
/// Seconds of one thread per camera axis and piece of a triangle, depth rescue included.
const SECONDS_PER_PIECE_AXIS: f64 = 9e-8;
/// Cameras of the octahedral patterns and the spiral that convergence looks through.
const CONVERGENCE_CAMERAS: usize = 6 + 18 + 66 + 258 + 1026 + 4098 + 4096;

/// Seconds that a cell of `study zt` takes, within a factor of two; its constants were measured on two threads of a server
/// processor, and scale with the options and the threads.
pub fn study_seconds(planned: &PlannedCell, request: &ZtRequest) -> f64 {
    let triangles = planned.triangles;
    let threads = rayon::current_num_threads() as f64;
    let cameras = request.cameras.unwrap_or(258);
    let look = measure_seconds(triangles, cameras, request.resolution.unwrap_or(0));
    match planned.cell {
        Cell::Look(_) => planned
            .pieces
            .map_or(look, |pieces| look + SECONDS_PER_PIECE_AXIS * pieces * cameras as f64 / 2.0 / threads),
        Cell::Run(preset, metric) => {
            let again = preset == Preset::Best && metric == Metric::Visibility;
            let looking = if again { LOOKING_AGAIN * look } else { 0.0 };
            let level = LEVEL_SECONDS
                + LEVEL_SECONDS_PER_TRIANGLE * triangles as f64
                + LEVEL_SECONDS_PER_SAMPLE * request.samples as f64;
            looking + triangles as f64 / COLLAPSED_TRIANGLES_PER_SECOND + planned.levels as f64 * level / threads
        }
        Cell::Pictures(_) => 0.5,
        Cell::Viewer => 1.0 + triangles as f64 / COLLAPSED_TRIANGLES_PER_SECOND,
        Cell::Convergence => measure_seconds(triangles, CONVERGENCE_CAMERAS, request.resolution.unwrap_or(480)),
    }
}

/// Looking again for hidden triangles takes this many times as long as measuring: 2 on a mesh that hides little, 14 on
/// one that hides much behind slits.
const LOOKING_AGAIN: f64 = 7.0;
