use serde::Serialize;

use crate::camera::{CameraPattern, CameraWeights, Cameras, Window};
use crate::visibility::agreement::{Agreement, Comparing, Measurement};
use crate::visibility::{Estimator, Shapes, surface_mean};

/// How far two measurements may disagree; `None` where nothing is known to hold.
///
/// *The same estimator on two machines* takes the same samples, so that only edge rules and rounding may differ.
/// *`coverage` against `hemisphere`* may differ by the quadrature of the cameras (q, measured on planes half blocked and
/// on cones of sky) and by the noise of counting C pixels a triangle (0.8/√C: the mean of |x| for a normal x of standard
/// deviation 1 is √(2/π)) and of casting rays (0.8 σ, with the standard errors σ that `hemisphere` found); known for 258
/// area-weighted cameras and more. *All other pairs* measure different things:
/// `item-buffer` calls a triangle seen that is seen in part, `surface` looks from a few points only. How far that carries
/// depends on the mesh, so there is no limit.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Limits {
    /// Least weighted agreement.
    pub agreement_weighted: Option<f64>,
    /// Least kappa.
    pub kappa: Option<f64>,
    /// Largest share of what anyone sees that only one sees, (n10 + n01) / (n11 + n10 + n01).
    pub differing: Option<f64>,
    /// Largest area-weighted mean of |V_A − V_B|.
    pub mean_abs_dv: Option<f64>,
    /// Largest |V_A(M) − V_B(M)|.
    pub dvm: Option<f64>,
}

/// The same samples on two machines.
const SAME_SAMPLES: Limits = Limits {
    agreement_weighted: Some(0.9995),
    kappa: Some(0.999),
    differing: Some(5e-4),
    mean_abs_dv: Some(5e-4),
    dvm: None,
};

/// Error of the camera quadrature by the least number of cameras: of a triangle's V (q), and of V(M).
const QUADRATURE: [(usize, f64, f64); 2] = [(1026, 0.005, 0.004), (258, 0.012, 0.01)];

/// Pixels along the side from which the limit on V(M) holds.
const ENOUGH_PIXELS: u32 = 480;

/// Mean of |x| for a normal x of standard deviation 1, rounded up.
const MEAN_OF_NOISE: f64 = 0.8;

impl Limits {
    /// The limits for `a` against `b`.
    #[must_use]
    pub fn between(a: &Measurement<'_>, b: &Measurement<'_>, comparing: Comparing<'_>) -> Self {
        let by_hemisphere = |m: &Measurement<'_>| m.setting.estimator == Estimator::Hemisphere;
        let by_coverage = |m: &&Measurement<'_>| m.setting.estimator == Estimator::Coverage;
        if a.setting.estimator == b.setting.estimator {
            return if by_hemisphere(a) { SAME_SAMPLES.without_table() } else { SAME_SAMPLES };
        }
        let coverage = [a, b].into_iter().find(by_coverage);
        match coverage.zip([a, b].into_iter().find(|m| by_hemisphere(m))) {
            Some((coverage, rays)) => Self::of_quadrature(coverage, rays, comparing),
            None => Self::default(),
        }
    }

    fn of_quadrature(coverage: &Measurement<'_>, rays: &Measurement<'_>, comparing: Comparing<'_>) -> Self {
        let cameras = comparing.cameras.count();
        let known = QUADRATURE.iter().find(|(least, ..)| cameras >= *least);
        let Cameras { pattern, hemisphere, .. } = &comparing.options.cameras;
        let is_even = matches!(pattern, CameraPattern::Octahedral(_) | CameraPattern::Fibonacci(_))
            && hemisphere.is_none()
            && comparing.options.camera_weights == CameraWeights::Area;
        let Some((_, q, of_mesh)) = known.filter(|_| is_even) else { return Self::default() };
        let noise = MEAN_OF_NOISE * (1.0 / mean_count(coverage, cameras).sqrt() + mean_standard_error(rays));
        let sharp = coverage.visibility.resolution() >= ENOUGH_PIXELS;
        Self { mean_abs_dv: Some(q + noise), dvm: sharp.then_some(*of_mesh), ..Self::default() }
    }

    fn without_table(self) -> Self {
        Self { agreement_weighted: None, kappa: None, differing: None, ..self }
    }

    /// Whether `agreement` keeps them; `None` if there are none.
    #[must_use]
    pub fn are_kept_by(&self, agreement: &Agreement) -> Option<bool> {
        let seen = agreement.seen.as_ref();
        let at_least = |value: Option<f64>, limit: Option<f64>| value.zip(limit).map(|(v, l)| v >= l);
        let at_most = |value: Option<f64>, limit: Option<f64>| value.zip(limit).map(|(v, l)| v <= l);
        let checks = [
            at_least(seen.map(|s| s.weighted.agreement()), self.agreement_weighted),
            at_least(seen.map(|s| s.counts.kappa()), self.kappa),
            at_most(seen.map(|s| s.counts.differing()), self.differing),
            at_most(Some(agreement.values.mean_abs), self.mean_abs_dv),
            at_most(Some(agreement.values.of_mesh), self.dvm),
        ];
        checks.into_iter().flatten().reduce(|all, one| all && one)
    }
}

/// C, the pixels that the mean triangle fills over all cameras, N A V / (4 s²); at least 1.
fn mean_count(coverage: &Measurement<'_>, cameras: usize) -> f64 {
    let shapes = Shapes::of(coverage.subject.mesh(), coverage.subject.frame());
    let mean_area = shapes.areas.iter().sum::<f64>() / shapes.areas.len() as f64;
    let pixel = Window::around_sphere(coverage.visibility.resolution()).pixel_size();
    (cameras as f64 * mean_area * coverage.visibility.of_mesh() / (4.0 * pixel * pixel)).max(1.0)
}

/// σ of a triangle's V, mean over the surface; 0 where the estimator tells none.
fn mean_standard_error(rays: &Measurement<'_>) -> f64 {
    let error = rays.visibility.details().standard_error.as_ref();
    error.map_or(0.0, |error| surface_mean(rays.subject, |t| error.per_triangle[t]))
}
