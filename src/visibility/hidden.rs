//! Which triangles can go without anyone seeing it.

use glam::DVec3;

use crate::backend::{BackendKind, Workload};
use crate::camera::{CameraSphere, CameraWeights, Window, random_rotation};
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

/// Who draws the looks, whoever measured: the question is only who has a pixel, and of the backends that find the same, this
/// one takes a tenth of the time.
const BACKEND: BackendKind = BackendKind::Raster;

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
    let raster = Subject::among(subject.mesh(), subject.occluders(), BACKEND)?;
    for look in 0..MAX_LOOKS {
        if !hidden.iter().any(|&h| h) {
            return Ok(hidden);
        }
        let cameras = cameras_of(look, options.cameras.hemisphere)?;
        let load = Workload { window, memory_limit: options.memory_limit, phase: "visibility", progress };
        let counts = CoverageCounts::of(raster.machine(), hidden.len(), &cameras, load, None)?;
        if take_back(&counts, &mut hidden) <= TOLERATED_SHARE {
            return Ok(hidden);
        }
    }
    hidden.fill(false);
    Ok(hidden)
}

impl Hidden {
    /// Who looks again; `None` where nobody does.
    #[must_use]
    pub fn backend(self) -> Option<BackendKind> {
        (self == Self::Delete).then_some(BACKEND)
    }

    /// Marks the triangles to remove before simplifying, one entry per triangle of the measured mesh; only
    /// [`Hidden::Delete`] marks any.
    ///
    /// Every triangle that the measurement did not see is marked at first. Then come further looks, each from other
    /// directions and at twice the resolution, that take back what they see, until a look finds at most one covered
    /// pixel in 20,000 showing a marked triangle. If no look in 16 does, nothing is marked. (Guarding the marks by rings
    /// of unseen neighbours instead keeps half of what could go, and is no safer on thin slits, where neighbours are
    /// seen from the same few directions.)
    ///
    /// The raster draws the looks, whatever backend measured; see [`Hidden::backend`].
    ///
    /// The looks come from all around, whatever pattern or list of cameras measured: what few cameras missed is no reason to
    /// open a hole toward the others. Only a hemisphere restricts them too, so that what is never seen from below may go.
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

/// Cameras turned at random, differently for each look; only those of the hemisphere, if there is one.
fn cameras_of(look: u64, hemisphere: Option<DVec3>) -> Result<CameraSphere> {
    let count = if look == 0 { FIRST_CAMERAS } else { FURTHER_CAMERAS };
    let turned = CameraSphere::octahedral(count, CameraWeights::Equal)?.rotated(random_rotation(look));
    match hemisphere {
        Some(toward) => turned.within(toward),
        None => Ok(turned),
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
