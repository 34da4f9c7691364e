//! Structural similarity of two pictures.
//!
//! The crate `iqa` does it as Wang, Bovik, Sheikh & Simoncelli (Image quality assessment: from error visibility to
//! structural similarity, 2004) print it: windows of 11 × 11 pixels with a Gaussian of σ = 1.5 at every place where they
//! fit, K1 = 0.01, K2 = 0.03, on grey levels of 8 bits. `image-compare` forgets to divide its variances by the window's
//! area, so that its K2 is another; `dssim` has a licence that we cannot take.

use iqa::{Image, SsimOptions, ssim};

use super::pictures::IMAGE_WIDTH;

/// Side of the window that slides over the pictures.
const WINDOW: usize = 11;

/// A result is rounded to this: the weights of the library's window come from the system's mathematics, whose last
/// digits differ from machine to machine.
const STEP: f64 = 1e-9;

const WIDTH: usize = IMAGE_WIDTH as usize;

/// Mean SSIM of two pictures within the rectangle around what either shows; 1 where neither shows anything.
///
/// Beyond the rectangle both are black, where similarity is 1 and would only dilute the mean.
pub(super) fn similarity(a: &[f32], b: &[f32]) -> f64 {
    let [columns, rows] = covered_rectangle(a, b);
    let part = |picture: &[f32]| {
        let row = |row: usize| picture[row * WIDTH..][columns.clone()].iter().map(|&grey| (grey + 0.5) as u8);
        let pixels: Vec<u8> = rows.clone().flat_map(row).collect();
        Image::gray8(columns.len() as u32, rows.len() as u32, pixels).expect("as many pixels as rows times columns")
    };
    let score =
        ssim(&part(a), &part(b), SsimOptions::default()).expect("two pictures of one size, at least a window's");
    (score / STEP).round() * STEP
}

/// Columns and rows that hold all pixels which are not black in both pictures, at least one window's.
fn covered_rectangle(a: &[f32], b: &[f32]) -> [std::ops::Range<usize>; 2] {
    let mut least = [WIDTH; 2];
    let mut most = [0; 2];
    for (pixel, _) in a.iter().zip(b).enumerate().filter(|(_, (a, b))| **a > 0.0 || **b > 0.0) {
        for (axis, place) in [pixel % WIDTH, pixel / WIDTH].into_iter().enumerate() {
            least[axis] = least[axis].min(place);
            most[axis] = most[axis].max(place + 1);
        }
    }
    [0, 1].map(|axis| {
        let from = least[axis].min(WIDTH - WINDOW);
        from..most[axis].max(from + WINDOW)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(grey: impl Fn(usize, usize) -> f32) -> Vec<f32> {
        (0..WIDTH * WIDTH).map(|i| grey(i % WIDTH, i / WIDTH)).collect()
    }

    #[test]
    fn a_picture_is_like_itself() {
        let a = picture(|x, y| ((x * 7 + y * 13) % 256) as f32);
        assert_eq!(similarity(&a, &a), 1.0);
        let black = picture(|_, _| 0.0);
        assert_eq!(similarity(&black, &black), 1.0);
    }

    /// Without any variance, SSIM is its first factor, (2ab + C1) / (a² + b² + C1); a wide margin changes nothing.
    #[test]
    fn even_squares_have_the_similarity_of_their_means() {
        let square = |grey: f32| move |x: usize, y: usize| if x.max(y) < 11 { grey } else { 0.0 };
        let c1 = (0.01_f64 * 255.0).powi(2);
        let expected = (2.0 * 100.0 * 120.0 + c1) / (100.0 * 100.0 + 120.0 * 120.0 + c1);
        assert!((similarity(&picture(square(100.0)), &picture(square(120.0))) - expected).abs() < STEP);
    }

    /// One window, so that the whole formula can be written out: a step against its own shadow at half the contrast.
    #[test]
    fn one_window_is_the_printed_formula() {
        let step = |low: f32, high: f32| {
            picture(move |x, y| match (x.max(y) < WINDOW, x < 5) {
                (false, _) => 0.0,
                (true, true) => low,
                (true, false) => high,
            })
        };
        let weight = |x: usize| (-(x as f64 - 5.0).powi(2) / 4.5).exp();
        let share = (0..5).map(weight).sum::<f64>() / (0..WINDOW).map(weight).sum::<f64>();
        let (mean_a, mean_b) = (share * 60.0 + (1.0 - share) * 200.0, share * 100.0 + (1.0 - share) * 170.0);
        let spread = share * (1.0 - share);
        let (var_a, var_b, both) = (spread * 140.0 * 140.0, spread * 70.0 * 70.0, spread * 140.0 * 70.0);
        let (c1, c2) = ((0.01_f64 * 255.0).powi(2), (0.03_f64 * 255.0).powi(2));
        let expected = (2.0 * mean_a * mean_b + c1) * (2.0 * both + c2)
            / ((mean_a * mean_a + mean_b * mean_b + c1) * (var_a + var_b + c2));
        assert!((similarity(&step(60.0, 200.0), &step(100.0, 170.0)) - expected).abs() < 2.0 * STEP);
    }
}
