//! What simplification did: to the picture, to the silhouette, to the geometry, to the triangles.
//!
//! [`Reference`] is a mesh that others are compared with: it is drawn and laid out once, then each comparison costs only
//! the other mesh's share.
//!
//! Sources: Zhang & Turk 2002, section 5.3 and eq. (5.11) (image error from 20 views); Cignoni, Rocchini & Scopigno
//! 1998, "Metro" (sampled geometric error).

mod gallery;
pub mod geometric;
mod image;
mod light;
mod nearest;
mod pictures;
mod quality;
mod sample;
mod similarity;

pub use gallery::{Gallery, Shot};
pub use image::{GreyError, ImageError, ReferencePictures, image_errors};
pub use light::Light;
pub use quality::TriangleQuality;

use crate::camera::Frame;
use crate::error::Result;
use crate::mesh::TriMesh;
use crate::progress::Progress;
use geometric::{GeometricError, GeometricOptions, ReferenceSurface};

/// How far a mesh is from the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison {
    /// Pictures.
    pub image: ImageError,
    /// Distances of the surfaces.
    pub geometric: GeometricError,
    /// Triangles that went wrong.
    pub quality: TriangleQuality,
}

/// A mesh that others are compared with, prepared once for any number of them.
#[derive(Debug)]
pub struct Reference<'a> {
    frame: Frame,
    pictures: ReferencePictures<'a>,
    surface: ReferenceSurface<'a>,
    non_manifold_edges: usize,
}

impl<'a> Reference<'a> {
    /// Draws `mesh` and lays it out; `visibility` holds V of each of its triangles, 0 to 1, where that is known.
    ///
    /// # Errors
    /// As [`ReferencePictures::new`] and [`ReferenceSurface::new`].
    pub fn new(
        mesh: &'a TriMesh,
        visibility: Option<&'a [f64]>,
        options: GeometricOptions,
        progress: &dyn Progress,
    ) -> Result<Self> {
        Ok(Self {
            frame: Frame::of(mesh),
            surface: ReferenceSurface::new(mesh, visibility, options)?,
            pictures: ReferencePictures::new(mesh, progress)?,
            non_manifold_edges: quality::non_manifold_edges(mesh),
        })
    }

    /// Compares a mesh with the reference: the same result for any number of threads.
    ///
    /// # Errors
    /// As [`ReferencePictures::compare`] and [`ReferenceSurface::compare`].
    ///
    /// # Examples
    /// ```
    /// use outsight::eval::Reference;
    /// use outsight::eval::geometric::GeometricOptions;
    /// use outsight::mesh::shapes;
    /// use outsight::progress::Silent;
    ///
    /// let (fine, coarse) = (shapes::icosphere(4), shapes::icosphere(1));
    /// let reference = Reference::new(&fine, None, GeometricOptions::default(), &Silent)?;
    /// let comparison = reference.compare(&coarse, &Silent)?;
    /// assert!(comparison.image.image_rmse > comparison.image.smooth.image_rmse);
    /// assert_eq!(comparison.quality.flipped, 0);
    /// # Ok::<(), outsight::Error>(())
    /// ```
    pub fn compare(&self, test: &TriMesh, progress: &dyn Progress) -> Result<Comparison> {
        Ok(Comparison {
            image: self.pictures.compare(test, progress)?,
            geometric: self.surface.compare(test, progress)?,
            quality: TriangleQuality::of(test, &self.surface, &self.frame, self.non_manifold_edges),
        })
    }
}
