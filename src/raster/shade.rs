use crate::raster::ItemBufferPair;

/// A grey picture, 0 black to 255 white, top row first.
#[derive(Debug, Clone, PartialEq)]
pub struct GreyImage {
    /// Pixels along a side.
    pub width: usize,
    /// `width` × `width` values.
    pub pixels: Vec<f32>,
}

/// What a camera sees, each `samples` × `samples` block of its buffer averaged into one pixel of grey.
///
/// `brightness` gives the grey of a hit, 0 to 255; where there is none it is 0. The buffer's width must be a multiple of
/// `samples`. `hits` comes row after row, bottom row first, as [`ItemBufferPair::near`] gives it.
#[must_use]
pub fn shade<H>(
    buffers: &ItemBufferPair,
    hits: impl Iterator<Item = Option<H>>,
    samples: usize,
    brightness: impl Fn(H) -> f64,
) -> GreyImage {
    let sampled_width = buffers.window().width as usize;
    let width = sampled_width / samples;
    let mut sums = vec![0.0_f64; width * width];
    for (i, hit) in hits.enumerate() {
        let (column, row) = (i % sampled_width / samples, i / sampled_width / samples);
        if let Some(hit) = hit {
            sums[(width - 1 - row) * width + column] += brightness(hit);
        }
    }
    let per_pixel = (samples * samples) as f64;
    GreyImage { width, pixels: sums.into_iter().map(|sum| (sum / per_pixel) as f32).collect() }
}
