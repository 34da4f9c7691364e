use glam::{DMat3, DQuat, DVec4};

/// A uniformly random rotation: a direction in four dimensions, drawn without sine or cosine, the same everywhere.
#[must_use]
pub fn random_rotation(seed: u64) -> DMat3 {
    DMat3::from_quat(random_turn(seed))
}

fn random_turn(seed: u64) -> DQuat {
    let mut state = seed;
    let mut coordinate = || {
        // SplitMix64; Steele, Lea & Flood 2014.
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / f64::from(1_u32 << 31) / f64::from(1_u32 << 21) - 1.0
    };
    loop {
        let point = DVec4::new(coordinate(), coordinate(), coordinate(), coordinate());
        if (0.01..=1.0).contains(&point.length_squared()) {
            return DQuat::from_vec4(point.normalize());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeds_turn_differently() {
        let turns: Vec<DQuat> = (0..16).map(random_turn).collect();
        for (i, a) in turns.iter().enumerate() {
            assert!((a.length() - 1.0).abs() < 1e-12);
            assert!(turns[..i].iter().all(|b| a.dot(*b).abs() < 0.999), "seed {i} repeats another");
        }
    }
}
