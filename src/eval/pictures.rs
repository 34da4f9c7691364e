//! What opposite cameras show of a mesh, under every light at once.

use glam::{DVec2, DVec3};

use super::gallery::{Gallery, SAMPLES};
use super::light::{Greys, Light, LitMesh, LitTriangle, LitView};
use crate::camera::{Frame, View, Window};
use crate::error::Result;
use crate::mesh::TriMesh;
use crate::raster::{ItemBufferPair, Screen, depth_step};

/// Pixels along an image's side.
pub(super) const IMAGE_WIDTH: u32 = 512;

/// Pixels of an image.
pub(super) const PIXELS: usize = (IMAGE_WIDTH * IMAGE_WIDTH) as usize;

const SAMPLED_WIDTH: usize = (SAMPLES * IMAGE_WIDTH) as usize;

/// Stands for the depth of a sample that shows nothing.
pub(super) const EMPTY: f32 = f32::NEG_INFINITY;

/// What the near and the far camera of an axis show; both share the lattice of pixels.
#[derive(Debug)]
pub(super) struct Pictures {
    /// For each of [`Light::ALL`] the near and the far picture, grey 0 to 255, row after row.
    pub(super) greys: [[Vec<f32>; 2]; 3],
    /// Depth of every sample toward the near camera, in unit-sphere units, near and far surface; [`EMPTY`] where there
    /// is none.
    pub(super) depths: [Vec<f32>; 2],
}

/// A mesh, ready to be drawn and lit in the frame of the reference.
#[derive(Debug)]
pub(super) struct Sitter<'a> {
    gallery: Gallery,
    lit: LitMesh<'a>,
    /// Half the diagonal of the reference's box, in its unit-sphere units: no view cuts anything off.
    half_width: f64,
}

/// What a worker keeps from view to view.
pub(super) struct Easel {
    screen: Screen,
    buffers: ItemBufferPair,
}

impl<'a> Sitter<'a> {
    /// `mesh` in the frame of `reference`.
    pub(super) fn new(mesh: &'a TriMesh, reference: &TriMesh) -> Self {
        let frame = Frame::of(reference);
        let copy = frame.unit_copy(mesh);
        let gallery = Gallery::of_copy(mesh, &frame, copy.clone());
        let lit = LitMesh::new(mesh, &copy, gallery.normals.clone());
        Self { gallery, lit, half_width: 0.5 * reference.bounds().diagonal() / frame.radius }
    }

    pub(super) fn easel(&self) -> Easel {
        Easel { screen: Screen::default(), buffers: ItemBufferPair::new(self.window()) }
    }

    fn window(&self) -> Window {
        Window { width: SAMPLES * IMAGE_WIDTH, half_width: self.half_width }
    }

    /// The pictures from both ends of an axis.
    pub(super) fn pose(&self, axis: DVec3, easel: &mut Easel) -> Result<Pictures> {
        let view = View::toward(axis, self.window());
        self.gallery.draw(&view, &mut easel.screen, &mut easel.buffers)?;
        let mut brush = Brush {
            buffers: &easel.buffers,
            lit: self.lit.in_view(&view),
            depth_step: depth_step(view.window, self.gallery.extent),
            met: [None; 2],
        };
        let mut pictures = Pictures::blank();
        for row in 0..IMAGE_WIDTH as usize {
            let mut line = [[[0.0; 3]; 2]; IMAGE_WIDTH as usize];
            for below in 0..SAMPLES as usize {
                brush.add_samples(SAMPLES as usize * row + below, &mut line, &mut pictures.depths);
            }
            pictures.put_line(row, &line);
        }
        Ok(pictures)
    }
}

/// Sums of the greys of each pixel of a row, near and far.
type Line = [[Greys; 2]; IMAGE_WIDTH as usize];

/// Lights the samples of a view.
struct Brush<'a> {
    buffers: &'a ItemBufferPair,
    lit: LitView<'a>,
    /// In unit-sphere units.
    depth_step: f64,
    /// The triangle met last, near and far: the next sample mostly shows the same.
    met: [Option<(u32, LitTriangle)>; 2],
}

impl Brush<'_> {
    /// Adds a row of samples to the pixels that it belongs to, and notes its depths.
    fn add_samples(&mut self, row: usize, line: &mut Line, depths: &mut [Vec<f32>; 2]) {
        for (column, sample) in (0..SAMPLED_WIDTH).zip(row * SAMPLED_WIDTH..) {
            let Some(hits) = self.buffers.at(sample) else { continue };
            let place = DVec2::new(column as f64, row as f64);
            let sums = &mut line[column / SAMPLES as usize];
            for (side, (depth, hit)) in hits.into_iter().enumerate() {
                let number = hit.triangle.0;
                let triangle = match self.met[side] {
                    Some((last, triangle)) if last == number => triangle,
                    _ => self.met[side].insert((number, self.lit.triangle(number))).1,
                };
                let greys = self.lit.greys(&triangle, place);
                (0..3).for_each(|light| sums[side][light] += greys[light]);
                depths[side][sample] = (f64::from(depth) * self.depth_step) as f32;
            }
        }
    }
}

impl Pictures {
    fn blank() -> Self {
        let grey = || vec![0.0; PIXELS];
        let depth = || vec![EMPTY; SAMPLED_WIDTH * SAMPLED_WIDTH];
        Self { greys: Light::ALL.map(|_| [grey(), grey()]), depths: [depth(), depth()] }
    }

    fn put_line(&mut self, row: usize, line: &Line) {
        const PER_PIXEL: f64 = (SAMPLES * SAMPLES) as f64;
        for (pixel, sums) in (row * IMAGE_WIDTH as usize..).zip(line) {
            for (light, greys) in self.greys.iter_mut().enumerate() {
                (0..2).for_each(|side| greys[side][pixel] = (sums[side][light] / PER_PIXEL) as f32);
            }
        }
    }
}
