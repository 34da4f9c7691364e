//! Which triangles can go without anyone seeing it.

use glam::{DMat3, DQuat, DVec4};

use crate::backend::Workload;
use crate::camera::{CameraSphere, CameraWeights, Window};
use crate::error::Result;
use crate::progress::Progress;
use crate::raster::Side;
use crate::visibility::{CoverageCounts, Hidden, MeasureOptions, Subject, Visibility};

/// Share of the covered pixels that may show a marked triangle in the last look. That look then takes back what it saw,
/// so the share that is left is smaller; 1e-4 is promised.
const TOLERATED_SHARE: f64 = 5e-5;

/// Cameras of the first look, which is all that a mesh with few hidden triangles needs, and of the others.
const FIRST_CAMERAS: usize = 66;
const FURTHER_CAMERAS: usize = 258;

/// An assembly seen through many narrow slits took 8.
const MAX_LOOKS: u64 = 16;

/// Looks again, from other directions and at twice the resolution, until a look is satisfied; see [`Hidden::marks`].
fn hidden_triangles(
    subject: &Subject<'_>,
    visibility: &Visibility,
    options: &MeasureOptions,
    progress: &dyn Progress,
) -> Result<Vec<bool>> {
    let mut hidden: Vec<bool> = visibility.seen().iter().map(|&seen| !seen).collect();
    let drawn = match visibility.resolution() {
        0 => options.resolution_for(hidden.len()),
        drawn => drawn,
    };
    let window = Window::around_sphere((2 * drawn).min(16384));
    for look in 0..MAX_LOOKS {
        if !hidden.iter().any(|&h| h) {
            return Ok(hidden);
        }
        let cameras = cameras_of(look)?;
        let load = Workload { window, memory_limit: options.memory_limit, phase: "visibility", progress };
        let counts = CoverageCounts::of(subject.machine(), hidden.len(), &cameras, load, None)?;
        if take_back(&counts, &mut hidden) <= TOLERATED_SHARE {
            return Ok(hidden);
        }
    }
    hidden.fill(false);
    Ok(hidden)
}

impl Hidden {
    /// Marks the triangles to remove before simplifying, one entry per triangle of the measured mesh; only
    /// [`Hidden::Delete`] marks any.
    ///
    /// Every triangle that the measurement did not see is marked at first. Then come further looks, each from other
    /// directions and at twice the resolution, that take back what they see, until a look finds at most one covered
    /// pixel in 20,000 showing a marked triangle. If no look in 16 does, nothing is marked. (Guarding the marks by rings
    /// of unseen neighbours instead keeps half of what could go, and is no safer on thin slits, where neighbours are
    /// seen from the same few directions.)
    ///
    /// # Errors
    /// As [`super::measure`].
    pub fn marks(
        self,
        subject: &Subject<'_>,
        visibility: &Visibility,
        options: &MeasureOptions,
        progress: &dyn Progress,
    ) -> Result<Vec<bool>> {
        match self {
            Self::Delete => hidden_triangles(subject, visibility, options, progress),
            Self::Keep | Self::Collapse => Ok(vec![false; subject.mesh().triangle_count()]),
        }
    }
}

/// Cameras turned at random, differently for each look.
fn cameras_of(look: u64) -> Result<CameraSphere> {
    let count = if look == 0 { FIRST_CAMERAS } else { FURTHER_CAMERAS };
    Ok(CameraSphere::octahedral(count, CameraWeights::Equal)?.rotated(DMat3::from_quat(rotation_of(look))))
}

/// A uniformly random rotation: a direction in four dimensions, drawn without sine or cosine, the same everywhere.
fn rotation_of(look: u64) -> DQuat {
    let mut state = look;
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

/// Unmarks what was seen; returns the share of the covered pixels that showed it.
fn take_back(counts: &CoverageCounts, hidden: &mut [bool]) -> f64 {
    let mut showing = 0;
    for (t, mark) in hidden.iter_mut().enumerate().filter(|(_, mark)| **mark) {
        let pixels = counts.seen(t, Side::Front) + counts.seen(t, Side::Back);
        showing += pixels;
        *mark = pixels == 0;
    }
    showing as f64 / counts.covered().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_are_turned_differently() {
        let rotations: Vec<DQuat> = (0..MAX_LOOKS).map(rotation_of).collect();
        for (i, a) in rotations.iter().enumerate() {
            assert!((a.length() - 1.0).abs() < 1e-12);
            assert!(rotations[..i].iter().all(|b| a.dot(*b).abs() < 0.999), "look {i} repeats another");
        }
    }
}
