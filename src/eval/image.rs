use glam::DVec3;
use rayon::prelude::*;

use crate::camera::{Frame, View, Window};
use crate::error::Result;
use crate::geom::{dodecahedron_axes, triangle_normal};
use crate::mesh::TriMesh;
use crate::progress::Progress;
use crate::raster::{GreyImage, Hit, ItemBufferPair, Scene, Screen, shade};

/// How far a mesh's pictures are from the reference's, over 20 views under a head light.
///
/// Source: Zhang & Turk 2002, eq. (5.11).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImageError {
    /// Square root of the sum of squared grey differences over all pixels of all views, grey 0 to 255.
    pub image_rms: f64,
    /// Root of the mean of the same squares: grey levels per pixel.
    pub image_rmse: f64,
    /// Pixels per view that one mesh covers and the other does not; a pixel partly covered counts by its samples.
    pub silhouette_xor: f64,
}

/// Pixels along an image's side.
const IMAGE_WIDTH: u32 = 512;

/// Samples along a pixel's side, averaged.
const SAMPLES: u32 = 2;

/// Views: the vertices of a dodecahedron, none of which is an octahedral camera.
const VIEWS: f64 = 20.0;

/// Compares the pictures of each test mesh with those of the reference, one result per test.
///
/// Orthographic views from the 20 vertices of a dodecahedron; 512 × 512 pixels of 2 × 2 samples; all meshes in one
/// square around the centre of the reference's box, half its diagonal to each side; flat shading by a head light,
/// grey 255 |n·d|, both sides lit, background 0.
///
/// # Errors
/// [`crate::Error::Limit`] if a test mesh is so much larger than the reference that it cannot be drawn beside it,
/// [`crate::Error::Cancelled`].
pub fn image_errors(reference: &TriMesh, tests: &[&TriMesh], progress: &dyn Progress) -> Result<Vec<ImageError>> {
    let original = Gallery::new(reference, reference);
    let others: Vec<Gallery> = tests.iter().map(|test| Gallery::new(test, reference)).collect();
    let axes = dodecahedron_axes();
    let per_axis: Vec<Vec<Difference>> = axes
        .par_iter()
        .map(|&axis| {
            progress.check()?;
            let pictures = original.both_ways(axis)?;
            let differences = others.iter().map(|other| Ok(Difference::between(&pictures, &other.both_ways(axis)?)));
            differences.collect()
        })
        .collect::<Result<_>>()?;
    progress.report("image error", axes.len() as u64, axes.len() as u64);
    // Sums run in the order of the axes, whatever thread drew them.
    let total = |test: usize| per_axis.iter().map(|d| d[test]).fold(Difference::default(), Difference::plus);
    Ok((0..tests.len()).map(|test| total(test).over_all_views()).collect())
}

/// One mesh, ready to be pictured in the frame of another.
#[derive(Debug)]
pub struct Gallery {
    scene: Scene,
    normals: Vec<DVec3>,
    /// Half the diagonal of the reference's box, in its unit-sphere units: no view cuts anything off.
    half_width: f64,
}

/// What a pair of opposite cameras shows: shaded pictures, and which samples are covered (the same for both).
struct Pictures {
    grey: [GreyImage; 2],
    covered: Vec<bool>,
}

impl Gallery {
    /// Pictures of `mesh`, framed by the box of `reference`.
    #[must_use]
    pub fn new(mesh: &TriMesh, reference: &TriMesh) -> Self {
        let frame = Frame::of(reference);
        let normal = |t: &[u32; 3]| triangle_normal(t.map(|v| frame.to_unit(mesh.positions()[v as usize])));
        Self {
            scene: Scene::new(frame.unit_copy(mesh)),
            normals: mesh.triangles().iter().map(|t| normal(t).unwrap_or_default()).collect(),
            half_width: 0.5 * reference.bounds().diagonal() / frame.radius,
        }
    }

    /// One picture under a light beside the camera, grey 0 to 255; `background` is the grey where nothing is hit.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] as [`image_errors`].
    pub fn picture(&self, shot: &Shot, background: f64) -> Result<GreyImage> {
        let buffers = self.draw(&shot.view())?;
        let greys = buffers.near().map(|hit| Some(hit.map_or(background, |hit| self.head_light(hit, shot.toward))));
        Ok(shade(&buffers, greys, SAMPLES as usize, |grey| grey))
    }

    /// The same in colour: `colour` gives three channels, 0 to 255, for a hit and |n·d|; the background is white.
    ///
    /// Returns `width` × `width` RGB triples, top row first.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] as [`image_errors`].
    pub fn coloured(&self, shot: &Shot, colour: impl Fn(Hit, f64) -> [f64; 3]) -> Result<Vec<u8>> {
        let buffers = self.draw(&shot.view())?;
        let channel = |c: usize| {
            let hits = buffers.near().map(|hit| Some(hit.map_or(255.0, |h| colour(h, self.cosine(h, shot.toward))[c])));
            shade(&buffers, hits, SAMPLES as usize, |value| value).pixels
        };
        let [red, green, blue] = [0, 1, 2].map(channel);
        let triples = red.iter().zip(&green).zip(&blue);
        Ok(triples.flat_map(|((r, g), b)| [r, g, b].map(|&value| (value + 0.5) as u8)).collect())
    }

    /// Grey of a triangle under a light beside the camera: 255 |n·d|.
    fn head_light(&self, hit: Hit, toward: DVec3) -> f64 {
        255.0 * self.cosine(hit, toward)
    }

    fn cosine(&self, hit: Hit, toward: DVec3) -> f64 {
        self.normals[hit.triangle.0 as usize].dot(toward).abs()
    }

    fn both_ways(&self, axis: DVec3) -> Result<Pictures> {
        let view = View::toward(axis, Window { width: SAMPLES * IMAGE_WIDTH, half_width: self.half_width });
        let buffers = self.draw(&view)?;
        let brightness = |hit: Hit| self.head_light(hit, axis);
        let near = shade(&buffers, buffers.near(), SAMPLES as usize, brightness);
        let far = shade(&buffers, buffers.far(), SAMPLES as usize, brightness);
        Ok(Pictures { grey: [near, far], covered: buffers.near().map(|hit| hit.is_some()).collect() })
    }

    fn draw(&self, view: &View) -> Result<ItemBufferPair> {
        let mut buffers = ItemBufferPair::new(view.window);
        self.scene.draw(view, &mut Screen::default(), &mut buffers)?;
        Ok(buffers)
    }
}

/// A picture to take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shot {
    /// Unit vector from the object toward the camera.
    pub toward: DVec3,
    /// Upward in the picture.
    pub up: DVec3,
    /// Pixels along the side.
    pub width: u32,
    /// How far the picture reaches to each side of the centre, in unit-sphere units of the reference.
    pub half_width: f64,
}

impl Shot {
    /// The shot from `toward` that just holds `mesh`, with a narrow margin.
    #[must_use]
    pub fn fitting(mesh: &TriMesh, toward: DVec3, up: DVec3, width: u32) -> Self {
        const MARGIN: f64 = 1.05;
        let frame = Frame::of(mesh);
        let view = Self { toward, up, width: 1, half_width: 1.0 }.view();
        let corners = mesh.triangles().iter().flatten().map(|&v| frame.to_unit(mesh.positions()[v as usize]));
        let reach = corners.map(|p| p.dot(view.right).abs().max(p.dot(view.up).abs())).fold(0.0, f64::max);
        Self { toward, up, width, half_width: MARGIN * reach }
    }

    fn view(&self) -> View {
        let window = Window { width: SAMPLES * self.width, half_width: self.half_width };
        View::upright(self.toward, self.up, window)
    }
}

#[derive(Debug, Clone, Copy, Default)]
struct Difference {
    squares: f64,
    samples_xor: u64,
}

impl Difference {
    fn between(a: &Pictures, b: &Pictures) -> Self {
        let squares = |a: &GreyImage, b: &GreyImage| -> f64 {
            a.pixels.iter().zip(&b.pixels).map(|(x, y)| f64::from(x - y) * f64::from(x - y)).sum()
        };
        let xor = a.covered.iter().zip(&b.covered).filter(|(x, y)| x != y).count() as u64;
        Self { squares: squares(&a.grey[0], &b.grey[0]) + squares(&a.grey[1], &b.grey[1]), samples_xor: 2 * xor }
    }

    fn plus(self, other: Self) -> Self {
        Self { squares: self.squares + other.squares, samples_xor: self.samples_xor + other.samples_xor }
    }

    fn over_all_views(self) -> ImageError {
        let pixels = VIEWS * f64::from(IMAGE_WIDTH * IMAGE_WIDTH);
        ImageError {
            image_rms: self.squares.sqrt(),
            image_rmse: (self.squares / pixels).sqrt(),
            silhouette_xor: self.samples_xor as f64 / f64::from(SAMPLES * SAMPLES) / VIEWS,
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::progress::Silent;

    /// A square plate of side 2 across the z axis, two triangles.
    fn plate(shift: DVec3) -> TriMesh {
        let corners = [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]];
        let positions = corners.map(|[x, y]| DVec3::new(x, y, 0.0) + shift).to_vec();
        TriMesh::new(positions, vec![[0, 1, 2], [0, 2, 3]]).unwrap()
    }

    #[test]
    fn a_mesh_does_not_differ_from_itself() {
        let error = image_errors(&plate(DVec3::ZERO), &[&plate(DVec3::ZERO)], &Silent).unwrap();
        assert_eq!(error, [ImageError { image_rms: 0.0, image_rmse: 0.0, silhouette_xor: 0.0 }]);
    }

    /// A plate moved out of every picture leaves its own image as the error: area 4 cos over the frame's area 8, grey
    /// 255 cos, hence a mean square of 255² · mean(cos³) / 2.
    #[test]
    fn a_missing_plate_has_the_error_of_its_own_picture() {
        let gone = image_errors(&plate(DVec3::ZERO), &[&plate(DVec3::X * 100.0)], &Silent).unwrap()[0];
        let cosines: Vec<f64> = dodecahedron_axes().iter().map(|d| d.z.abs()).collect();
        let mean_of = |power: i32| cosines.iter().map(|c| c.powi(power)).sum::<f64>() / 10.0;
        let pixels = f64::from(IMAGE_WIDTH * IMAGE_WIDTH);
        approx::assert_relative_eq!(gone.image_rmse, 255.0 * (mean_of(3) / 2.0).sqrt(), max_relative = 2e-3);
        approx::assert_relative_eq!(gone.silhouette_xor, pixels * mean_of(1) / 2.0, max_relative = 2e-3);
        approx::assert_relative_eq!(gone.image_rms, gone.image_rmse * (20.0 * pixels).sqrt(), max_relative = 1e-12);
    }
}
