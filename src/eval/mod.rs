//! What simplification did: to the picture, to the silhouette, to the geometry.
//!
//! Sources: Zhang & Turk 2002, section 5.3 and eq. (5.11) (image error from 20 views); Cignoni, Rocchini & Scopigno
//! 1998, "Metro" (sampled geometric error).

pub mod geometric;
mod image;
mod nearest;
mod sample;

pub use image::{Gallery, ImageError, Shot, image_errors};
