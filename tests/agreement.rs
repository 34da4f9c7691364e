//! The raster and the judge keep the limits that backends must keep.

#![allow(clippy::unwrap_used)]

use glam::DMat3;
use outsight::backend::BackendKind;
use outsight::camera::{CameraSphere, CameraWeights, Cameras};
use outsight::mesh::{TriMesh, shapes};
use outsight::progress::Silent;
use outsight::visibility::agreement::{Agreement, Comparing, Limits, Measurement};
use outsight::visibility::{Estimator, MeasureOptions, Setting, Subject};

/// Compares coverage by the raster with coverage by the judge, from cameras turned away from the walls.
fn raster_against_judge(mesh: &TriMesh) -> (Agreement, Limits) {
    let options =
        MeasureOptions { cameras: Cameras::octahedral(66), resolution: Some(96), ..MeasureOptions::default() };
    let turned = DMat3::from_rotation_z(0.3) * DMat3::from_rotation_x(0.7);
    let cameras = CameraSphere::octahedral(66, CameraWeights::Area).unwrap().rotated(turned);
    let comparing = Comparing { cameras: &cameras, options: &options, progress: &Silent };
    let subjects = [BackendKind::Raster, BackendKind::Brute].map(|backend| Subject::new(mesh, backend).unwrap());
    let [raster, judge] = [0, 1].map(|i| {
        let backend = [BackendKind::Raster, BackendKind::Brute][i];
        Measurement::take(&subjects[i], Setting { estimator: Estimator::Coverage, backend }, comparing).unwrap()
    });
    let limits = Limits::between(&raster, &judge, comparing);
    (Agreement::of(&raster, &judge, comparing).unwrap(), limits)
}

#[test]
fn raster_and_judge_agree_within_the_limits_of_equal_samples() {
    for mesh in [shapes::bumpy_sphere(3, 0.3), shapes::cluttered_open_box(2, 10, 3).mesh] {
        let (found, limits) = raster_against_judge(&mesh);
        assert!(limits.kappa.is_some() && limits.mean_abs_dv.is_some());
        assert_eq!(limits.are_kept_by(&found), Some(true), "{found:?}");
        assert_eq!(found.seen.unwrap().causes.unexplained, 0);
    }
}
