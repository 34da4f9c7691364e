use std::f64::consts::PI;

use glam::DVec2;

/// Segments of the dome.
const DOME: usize = 120;

/// ```text
///            .-'''-.          y = 8
/// Q--P  I--H'       |         6
/// |  |  |           |
/// | NO  J--K        |         5
/// | |      |        G----F    3
/// | M------L             |    2
/// A-----------B   D------E    0
/// x = 0        \C/       10
/// ```
pub(super) fn corners() -> Vec<DVec2> {
    let dome = (0..=DOME).map(|i| {
        let angle = PI * i as f64 / DOME as f64;
        [6.0 + 2.0 * libm::cos(angle), 6.0 + 2.0 * libm::sin(angle)]
    });
    let notch_and_step = [[0.0, 0.0], [6.0, 0.0], [7.0, 1.2], [8.0, 0.0], [10.0, 0.0], [10.0, 3.0], [8.0, 3.0]];
    let mouth = [[3.2, 6.0], [3.2, 5.0]];
    let bay = [[5.0, 5.0], [5.0, 2.0], [1.0, 2.0], [1.0, 5.0], [2.0, 5.0]];
    let left = [[2.0, 6.0], [0.0, 6.0]];
    let all = notch_and_step.into_iter().chain(dome).chain(mouth).chain(bay).chain(left);
    all.map(DVec2::from_array).collect()
}
