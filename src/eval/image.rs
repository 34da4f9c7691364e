use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::light::Light;
use super::pictures::{EMPTY, Easel, PIXELS, Pictures, Sitter};
use super::similarity::similarity;
use crate::camera::Frame;
use crate::error::Result;
use crate::geom::dodecahedron_axes;
use crate::mesh::TriMesh;
use crate::progress::Progress;

/// How far a mesh's pictures are from the reference's, over 20 views.
///
/// Source: Zhang & Turk 2002, eq. (5.11).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImageError {
    /// Square root of the sum of squared grey differences over all pixels of all views, grey 0 to 255, under the light
    /// that the paper's tables are read as: [`Light::Head`].
    pub image_rms: f64,
    /// Root of the mean of the same squares: grey levels per pixel.
    pub image_rmse: f64,
    /// The two under [`Light::Fixed`].
    pub fixed_light: GreyError,
    /// The two under [`Light::Smooth`].
    pub smooth: GreyError,
    /// Pixels per view that one mesh covers and the other does not; a pixel partly covered counts by its samples.
    pub silhouette_xor: f64,
    /// Root mean square difference in depth over the samples that both cover, in model units; `None` where there are
    /// none.
    pub depth_rms: Option<f64>,
    /// Mean structural similarity over the views under [`Light::Head`], each within the rectangle around what either
    /// mesh shows; 1 is alike.
    pub ssim: f64,
}

/// Error of pictures under one light, as in [`ImageError`].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct GreyError {
    /// As [`ImageError::image_rms`].
    pub image_rms: f64,
    /// As [`ImageError::image_rmse`].
    pub image_rmse: f64,
}

/// Views: the vertices of a dodecahedron, none of which is an octahedral camera.
const VIEWS: f64 = 20.0;

const SAMPLES_PER_PIXEL: f64 = (super::gallery::SAMPLES * super::gallery::SAMPLES) as f64;

/// Compares the pictures of each test mesh with those of the reference, one result per test.
///
/// # Errors
/// As [`ReferencePictures::compare`].
pub fn image_errors(reference: &TriMesh, tests: &[&TriMesh], progress: &dyn Progress) -> Result<Vec<ImageError>> {
    let pictures = ReferencePictures::new(reference, progress)?;
    tests.iter().map(|test| pictures.compare(test, progress)).collect()
}

/// The pictures of a mesh that others are compared with, drawn once: 150 MB.
///
/// Orthographic views from the 20 vertices of a dodecahedron; 512 × 512 pixels of 2 × 2 samples; all meshes in one
/// square around the centre of the reference's box, half its diagonal to each side; both sides lit, background 0. Each
/// view is drawn once and shaded under all of [`Light::ALL`].
#[derive(Debug)]
pub struct ReferencePictures<'a> {
    mesh: &'a TriMesh,
    per_axis: Vec<Pictures>,
}

impl<'a> ReferencePictures<'a> {
    /// Draws the reference.
    ///
    /// # Errors
    /// [`crate::Error::Cancelled`].
    pub fn new(mesh: &'a TriMesh, progress: &dyn Progress) -> Result<Self> {
        let per_axis = on_all_axes(&Sitter::new(mesh, mesh), progress, |_, pictures| pictures)?;
        Ok(Self { mesh, per_axis })
    }

    /// Compares the pictures of `test` with those of the reference.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] if `test` is so much larger than the reference that it cannot be drawn beside it,
    /// [`crate::Error::Cancelled`].
    pub fn compare(&self, test: &TriMesh, progress: &dyn Progress) -> Result<ImageError> {
        let sitter = Sitter::new(test, self.mesh);
        let between = |axis: usize, pictures: Pictures| Difference::between(&self.per_axis[axis], &pictures);
        // Sums run in the order of the axes, whatever thread drew them.
        let differences = on_all_axes(&sitter, progress, between)?;
        let total = differences.into_iter().fold(Difference::default(), Difference::plus);
        Ok(total.over_all_views(Frame::of(self.mesh).radius))
    }
}

/// Draws the mesh along every axis, in the order of the axes.
fn on_all_axes<T: Send>(
    sitter: &Sitter,
    progress: &dyn Progress,
    finish: impl Fn(usize, Pictures) -> T + Sync,
) -> Result<Vec<T>> {
    let axes = dodecahedron_axes();
    let draw = |easel: &mut Easel, axis: usize| {
        progress.check()?;
        Ok(finish(axis, sitter.pose(axes[axis], easel)?))
    };
    let results = (0..axes.len()).into_par_iter().map_init(|| sitter.easel(), draw).collect::<Result<_>>()?;
    progress.report("image error", axes.len() as u64, axes.len() as u64);
    Ok(results)
}

/// Sums over pixels of views, from which an [`ImageError`] follows.
#[derive(Debug, Clone, Copy, Default)]
struct Difference {
    /// Squared grey differences, by light.
    squares: [f64; 3],
    samples_xor: u64,
    samples_both: u64,
    /// In unit-sphere units squared, over the samples of `samples_both`.
    depth_squares: f64,
    similarity: f64,
}

impl Difference {
    fn between(a: &Pictures, b: &Pictures) -> Self {
        let pairs = |light: usize| a.greys[light].iter().zip(&b.greys[light]);
        let mut sums = Self {
            squares: [0, 1, 2].map(|light| pairs(light).map(squares).sum()),
            similarity: pairs(Light::Head as usize).map(|(a, b)| similarity(a, b)).sum(),
            ..Self::default()
        };
        for (a, b) in a.depths.iter().zip(&b.depths) {
            sums.add_depths(a, b);
        }
        sums
    }

    fn add_depths(&mut self, a: &[f32], b: &[f32]) {
        for (&a, &b) in a.iter().zip(b) {
            let covered = [a, b].map(|depth| depth != EMPTY);
            self.samples_xor += u64::from(covered[0] != covered[1]);
            if covered == [true; 2] {
                self.samples_both += 1;
                self.depth_squares += f64::from(a - b) * f64::from(a - b);
            }
        }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            squares: [0, 1, 2].map(|light| self.squares[light] + other.squares[light]),
            samples_xor: self.samples_xor + other.samples_xor,
            samples_both: self.samples_both + other.samples_both,
            depth_squares: self.depth_squares + other.depth_squares,
            similarity: self.similarity + other.similarity,
        }
    }

    fn over_all_views(self, radius: f64) -> ImageError {
        let [head, fixed_light, smooth] = self.squares.map(|squares| GreyError {
            image_rms: squares.sqrt(),
            image_rmse: (squares / (VIEWS * PIXELS as f64)).sqrt(),
        });
        let both = self.samples_both as f64;
        ImageError {
            image_rms: head.image_rms,
            image_rmse: head.image_rmse,
            fixed_light,
            smooth,
            silhouette_xor: self.samples_xor as f64 / SAMPLES_PER_PIXEL / VIEWS,
            depth_rms: (self.samples_both > 0).then(|| radius * (self.depth_squares / both).sqrt()),
            ssim: self.similarity / VIEWS,
        }
    }
}

/// Sum of squared grey differences of two pictures.
fn squares((a, b): (&Vec<f32>, &Vec<f32>)) -> f64 {
    a.iter().zip(b).map(|(x, y)| f64::from(x - y) * f64::from(x - y)).sum()
}

#[cfg(test)]
mod tests;
