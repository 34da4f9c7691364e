use glam::DVec3;

/// The ten axes through opposite vertices of a dodecahedron, as unit vectors; with their negatives, all 20 vertices.
#[must_use]
pub fn dodecahedron_axes() -> [DVec3; 10] {
    let phi = 0.5 * (1.0 + 5.0_f64.sqrt());
    let (long, short) = (phi, 1.0 / phi);
    [
        [1.0, 1.0, 1.0],
        [-1.0, 1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, 1.0, -1.0],
        [0.0, short, long],
        [0.0, -short, long],
        [short, long, 0.0],
        [-short, long, 0.0],
        [long, 0.0, short],
        [-long, 0.0, short],
    ]
    .map(|v| DVec3::from_array(v).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_are_those_of_a_regular_dodecahedron() {
        let all: Vec<DVec3> = dodecahedron_axes().into_iter().flat_map(|d| [d, -d]).collect();
        // Three nearest neighbours each, at the central angle acos(√5/3).
        let edge = 5.0_f64.sqrt() / 3.0;
        for a in &all {
            assert_eq!(all.iter().filter(|b| (a.dot(**b) - edge).abs() < 1e-12).count(), 3);
        }
    }
}
