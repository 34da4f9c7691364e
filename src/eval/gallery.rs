use glam::DVec3;

use crate::camera::{Frame, UnitMesh, View, Window};
use crate::error::Result;
use crate::geom::triangle_normal;
use crate::mesh::TriMesh;
use crate::raster::{GreyImage, Hit, ItemBufferPair, Scene, Screen, shade};

/// Samples along a pixel's side, averaged.
pub(super) const SAMPLES: u32 = 2;

/// One mesh, ready to be pictured in the frame of another.
#[derive(Debug)]
pub struct Gallery {
    scene: Scene,
    /// By triangle; zero where it has no area.
    pub(super) normals: Vec<DVec3>,
    /// How far the mesh reaches from the centre, in unit-sphere units.
    pub(super) extent: f64,
}

impl Gallery {
    /// Pictures of `mesh`, framed by `reference`.
    #[must_use]
    pub fn new(mesh: &TriMesh, reference: &TriMesh) -> Self {
        let frame = Frame::of(reference);
        Self::of_copy(mesh, &frame, frame.unit_copy(mesh))
    }

    /// The same, where the copy of `mesh` in `frame` is there already.
    pub(super) fn of_copy(mesh: &TriMesh, frame: &Frame, copy: UnitMesh) -> Self {
        let normal = |t: &[u32; 3]| triangle_normal(t.map(|v| frame.to_unit(mesh.positions()[v as usize])));
        let extent = copy.extent;
        Self {
            scene: Scene::new(copy),
            normals: mesh.triangles().iter().map(|t| normal(t).unwrap_or_default()).collect(),
            extent,
        }
    }

    /// One picture under a light beside the camera, grey 0 to 255; `background` is the grey where nothing is hit.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] as [`super::image_errors`].
    pub fn picture(&self, shot: &Shot, background: f64) -> Result<GreyImage> {
        let buffers = self.buffers(&shot.view())?;
        let greys = buffers.near().map(|hit| Some(hit.map_or(background, |hit| 255.0 * self.cosine(hit, shot.toward))));
        Ok(shade(&buffers, greys, SAMPLES as usize, |grey| grey))
    }

    /// The same in colour: `colour` gives three channels, 0 to 255, for a hit and |n·d|; the background is white.
    ///
    /// Returns `width` × `width` RGB triples, top row first.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] as [`super::image_errors`].
    pub fn coloured(&self, shot: &Shot, colour: impl Fn(Hit, f64) -> [f64; 3]) -> Result<Vec<u8>> {
        let buffers = self.buffers(&shot.view())?;
        let channel = |c: usize| {
            let hits = buffers.near().map(|hit| Some(hit.map_or(255.0, |h| colour(h, self.cosine(h, shot.toward))[c])));
            shade(&buffers, hits, SAMPLES as usize, |value| value).pixels
        };
        let [red, green, blue] = [0, 1, 2].map(channel);
        let triples = red.iter().zip(&green).zip(&blue);
        Ok(triples.flat_map(|((r, g), b)| [r, g, b].map(|&value| (value + 0.5) as u8)).collect())
    }

    fn cosine(&self, hit: Hit, toward: DVec3) -> f64 {
        self.normals[hit.triangle.0 as usize].dot(toward).abs()
    }

    fn buffers(&self, view: &View) -> Result<ItemBufferPair> {
        let mut buffers = ItemBufferPair::new(view.window);
        self.draw(view, &mut Screen::default(), &mut buffers)?;
        Ok(buffers)
    }

    /// Draws both item buffers of a view, over what they held.
    pub(super) fn draw(&self, view: &View, screen: &mut Screen, buffers: &mut ItemBufferPair) -> Result<()> {
        self.scene.draw(view, screen, buffers)
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
