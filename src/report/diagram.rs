//! The picture of a visibility diagram: which camera sees which triangle.

use glam::{DVec3, Vec4};
use rayon::prelude::*;

use super::picture::{Picture, WHITE};
use crate::io::Diagram;

/// Longest side of the picture; beyond it a pixel is the mean of several pairs.
const MAX_SIDE: usize = 4096;

/// Draws a diagram: triangles from left to right, cameras from top to bottom, white where a camera does not see a triangle,
/// else green, the brighter the more squarely it looks at it.
///
/// `normals` has the unit normal of each triangle, zero where it is degenerate. Up to 4096 triangles and cameras each pair is
/// a pixel; beyond, a pixel is the mean colour of the pairs that fall on it.
///
/// Source: Zhang & Turk 2002, figure 1, for meshes in place of outlines.
#[must_use]
pub fn diagram_picture(diagram: &Diagram, normals: &[DVec3]) -> Picture {
    let (width, height) = (diagram.triangles.min(MAX_SIDE), diagram.cameras.len().min(MAX_SIDE));
    let columns: Vec<Vec<[u8; 3]>> = (0..width)
        .into_par_iter()
        .map(|x| {
            let triangles = block(x, width, diagram.triangles);
            (0..height)
                .map(|y| mean(diagram, normals, triangles.clone(), block(y, height, diagram.cameras.len())))
                .collect()
        })
        .collect();
    let mut picture = Picture::filled(width as u32, height as u32, WHITE);
    for (x, column) in (0..).zip(&columns) {
        (0..).zip(column).for_each(|(y, &colour)| picture.set(x, y, colour));
    }
    picture
}

/// The pairs along one direction that fall on pixel `i` of `pixels`.
fn block(i: usize, pixels: usize, pairs: usize) -> std::ops::Range<usize> {
    i * pairs / pixels..(i + 1) * pairs / pixels
}

fn mean(
    diagram: &Diagram,
    normals: &[DVec3],
    triangles: std::ops::Range<usize>,
    cameras: std::ops::Range<usize>,
) -> [u8; 3] {
    let count = (triangles.len() * cameras.len()) as u64;
    let mut sums = [0_u64; 3];
    for t in triangles {
        for v in cameras.clone() {
            let colour = colour(diagram, normals[t], t, v);
            sums.iter_mut().zip(colour).for_each(|(sum, channel)| *sum += u64::from(channel));
        }
    }
    sums.map(|sum| ((2 * sum + count) / (2 * count)) as u8)
}

fn colour(diagram: &Diagram, normal: DVec3, triangle: usize, camera: usize) -> [u8; 3] {
    if !diagram.sees(triangle, camera) {
        return WHITE;
    }
    // Whichever side faces the camera is the one that it sees.
    let toward = Vec4::from_array(diagram.cameras[camera]).truncate().as_dvec3();
    green(toward.dot(normal).abs())
}

/// Green, the brighter the more squarely a camera looks: the cosine of its direction and the normal.
pub(super) fn green(cosine: f64) -> [u8; 3] {
    [0, (255.0 * cosine).round() as u8, 0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cameras at +z and +x; triangle 0 faces +z, triangle 1 lies between the two.
    fn diagram(triangles: usize) -> (Diagram, Vec<DVec3>) {
        let cameras = vec![[0.0, 0.0, 1.0, 6.0], [1.0, 0.0, 0.0, 6.0]];
        let words = (0..triangles).map(|t| if t % 2 == 0 { 0b01 } else { 0b11 }).collect();
        let between = DVec3::new(0.6, 0.0, 0.8);
        let normals = (0..triangles).map(|t| if t % 2 == 0 { DVec3::Z } else { between }).collect();
        (Diagram { cameras, triangles, words, fractions: None }, normals)
    }

    #[test]
    fn a_pair_is_white_unseen_and_green_by_its_cosine() {
        let (diagram, normals) = diagram(2);
        let picture = diagram_picture(&diagram, &normals);
        assert_eq!((picture.width(), picture.height()), (2, 2));
        let pixels = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(x, y)| picture.pixel(x, y));
        assert_eq!(pixels, [[0, 255, 0], [255, 255, 255], [0, 204, 0], [0, 153, 0]].map(Some));
    }

    #[test]
    fn pixels_of_several_pairs_are_their_mean() {
        let (diagram, normals) = diagram(3 * MAX_SIDE);
        let picture = diagram_picture(&diagram, &normals);
        assert_eq!((picture.width(), picture.height()), (MAX_SIDE as u32, 2));
        // Triangles 0, 1, 2, of which camera 1 sees the middle one, for a third of the colour.
        assert_eq!(picture.pixel(0, 0), Some([0, 238, 0]));
        assert_eq!(picture.pixel(0, 1), Some([170, 221, 170]));
    }
}
