#![allow(clippy::unwrap_used)]

use std::f64::consts::{FRAC_PI_2, PI};

use super::*;

const CAMERAS: usize = 720;

fn outline(corners: &[[f64; 2]]) -> Outline {
    Outline::new(corners.iter().copied().map(DVec2::from_array).collect()).unwrap()
}

/// A block 4 wide with a rectangular notch from above, `width` wide and `depth` deep, and the length along the boundary to
/// where the notch begins.
///
/// ```text
/// +---+ +---+
/// |   +-+   |
/// +---------+
/// ```
fn notched(width: f64, depth: f64) -> (Outline, f64) {
    let (left, right, bottom) = (2.0 - 0.5 * width, 2.0 + 0.5 * width, 10.0 - depth);
    let corners = [
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, 10.0],
        [right, 10.0],
        [right, bottom],
        [left, bottom],
        [left, 10.0],
        [0.0, 10.0],
    ];
    let outline = outline(&corners);
    let start = outline.length_to(3);
    (outline, start)
}

#[test]
fn a_convex_outline_is_seen_by_exactly_the_cameras_in_front() {
    let pentagon = outline(&[[0.0, 0.0], [3.0, -1.0], [5.0, 2.0], [2.0, 4.0], [-1.0, 2.5]]);
    let diagram = pentagon.diagram(200, CAMERAS);
    for sample in 0..200 {
        let at = pentagon.length() * (sample as f64 + 0.5) / 200.0;
        let segment = (0..5).rev().find(|&i| pentagon.length_to(i) <= at).unwrap();
        for camera in 0..CAMERAS {
            let cosine = direction(camera, CAMERAS).dot(pentagon.normal(segment)).max(0.0);
            assert_eq!(diagram.cosine(sample, camera), cosine, "sample {sample}, camera {camera}");
        }
    }
}

/// From the middle of the bottom the sky reaches atan(w / 2h) to each side.
#[test]
fn the_bottom_of_a_notch_sees_out_as_far_as_its_rim_allows() {
    for (width, depth) in [(1.0, 1.0), (0.5, 2.0), (3.0, 0.4), (0.01, 5.0)] {
        let (notched, start) = notched(width, depth);
        let cosines = notched.seen_from(start + depth + 0.5 * width, CAMERAS);
        let half_angle = libm::atan(width / (2.0 * depth));
        for (camera, &cosine) in cosines.iter().enumerate() {
            let off = (TAU * camera as f64 / CAMERAS as f64 - FRAC_PI_2).abs();
            assert_eq!(cosine > 0.0, off < half_angle, "{width} x {depth}, camera {camera}");
        }
    }
}

/// Share of the sum: 100 points per unit of length and 1440 cameras leave steps at the edges of the sky.
const SUM_TOLERANCE: f64 = 0.01;

/// What enters a notch ends on its inside: the sum of V over the inside is the width of the mouth.
#[test]
fn visibility_inside_a_notch_sums_to_its_mouth() {
    for (width, depth) in [(1.0, 1.0), (2.0, 0.5), (0.5, 3.0)] {
        let (notched, start) = notched(width, depth);
        let samples = (100.0 * notched.length()) as usize;
        let step = notched.length() / samples as f64;
        let diagram = notched.diagram(samples, 1440);
        let inside = (0..samples).filter(|&i| {
            let at = step * (i as f64 + 0.5) - start;
            (0.0..2.0 * depth + width).contains(&at)
        });
        let sum: f64 = inside.map(|i| step * diagram.visibility(i)).sum();
        assert!((sum / width - 1.0).abs() < SUM_TOLERANCE, "{width} x {depth}: {sum}");
    }
}

#[test]
fn only_directions_through_the_mouth_reach_into_the_harbour() {
    let harbour = Outline::harbour();
    let names = harbour.sharp_corners();
    assert_eq!(names.len(), 17);
    let [l, m] = [11, 12].map(|i| harbour.length_to(names[i]));
    let cosines = harbour.seen_from(0.5 * (l + m), CAMERAS);
    // From (3, 2), the middle of the bay's bottom, the upper corners of the mouth, (2, 6) and (3.2, 6), are in the way.
    let (rightmost, leftmost) = (libm::atan2(4.0, 0.2), libm::atan2(4.0, -1.0));
    for (camera, &cosine) in cosines.iter().enumerate() {
        let angle = TAU * camera as f64 / CAMERAS as f64;
        assert_eq!(cosine > 0.0, (rightmost..leftmost).contains(&angle), "camera {camera}");
    }
}

#[test]
fn scaling_by_a_power_of_two_changes_nothing() {
    let harbour = Outline::harbour();
    let small = Outline::new(harbour.corners().iter().map(|c| c * 2.0_f64.powi(-40)).collect()).unwrap();
    assert_eq!(small.diagram(150, 90), harbour.diagram(150, 90));
}

#[test]
fn round_parts_have_no_sharp_corners() {
    let circle: Vec<DVec2> = (0..40).map(|i| direction(i, 40)).collect();
    let circle = Outline::new(circle).unwrap();
    assert!(circle.sharp_corners().is_empty());
    assert!((circle.length() - 2.0 * 40.0 * (PI / 40.0).sin()).abs() < 1e-12);
    assert_eq!(outline(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 1.0]]).sharp_corners(), [0, 2, 3]);
}

#[test]
fn what_is_no_outline_is_refused() {
    let fault = |corners: &[[f64; 2]]| {
        Outline::new(corners.iter().copied().map(DVec2::from_array).collect()).unwrap_err().to_string()
    };
    assert!(fault(&[[0.0, 0.0], [1.0, 0.0]]).contains("three or more"));
    assert!(fault(&[[0.0, 0.0], [1.0, 0.0], [f64::NAN, 1.0]]).contains("finite"));
    assert!(fault(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]).contains("corner 1 and the next"));
    assert!(fault(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]).contains("corner 3 and the next"));
    assert!(fault(&[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]).contains("clockwise"));
}
