//! The study of convergence against rays, on a small mesh.

#![allow(clippy::unwrap_used)]

use outsight::backend::BackendKind;
use outsight::camera::{CameraWeights, Cameras};
use outsight::io::{self, Attributes, ReadOptions, WriteOptions};
use outsight::mesh::shapes;
use outsight::pipeline::{ConvergenceReport, ConvergenceRequest, IndependentReference, study_convergence};
use outsight::progress::Silent;
use outsight::visibility::{Estimator, MeasureOptions, RayOptions, Sides, Subject, mean_difference};

const SAMPLES: u32 = 512;
const RESOLUTION: u32 = 96;

/// Walls of a well see half of a sphere of cameras at most: what is wrong with the cameras' weights shows.
fn study(directory: &tempfile::TempDir) -> ConvergenceReport {
    let path = directory.path().join("well.ply");
    let well = shapes::cylindrical_well(1.0, [12, 2]).mesh;
    io::write(&path, &well, &Attributes::default(), &WriteOptions::default()).unwrap();
    let request = ConvergenceRequest {
        occluders: Vec::new(),
        inputs: vec![path],
        read: ReadOptions::default(),
        against: IndependentReference::Hemisphere(SAMPLES),
        resolution: Some(RESOLUTION),
        memory_limit: None,
    };
    study_convergence(&request, &Silent).unwrap()
}

#[test]
fn distance_from_rays_is_the_distance_of_two_measurements() {
    let home = tempfile::tempdir().unwrap();
    let report = study(&home);
    assert_eq!((report.reference.as_str(), report.reference_samples), ("hemisphere@embree", Some(SAMPLES)));

    let mesh = io::read(&home.path().join("well.ply"), &ReadOptions::default()).unwrap().mesh;
    let one_side = MeasureOptions { sides: Sides::One, ..MeasureOptions::default() };
    let rays = RayOptions { samples: SAMPLES, ..RayOptions::default() };
    let by_rays = MeasureOptions { estimator: Estimator::Hemisphere, backend: BackendKind::Embree, rays, ..one_side };
    let reference = Subject::new(&mesh, by_rays.backend).unwrap().measure(&by_rays, &Silent).unwrap();
    let subject = Subject::new(&mesh, BackendKind::Raster).unwrap();
    for error in report.meshes[0].errors.iter().filter(|error| error.weights == CameraWeights::Area) {
        let cameras = Cameras::octahedral(error.cameras);
        let resolution = Some(RESOLUTION);
        let alone = MeasureOptions { cameras, resolution, sides: Sides::One, ..MeasureOptions::default() };
        let alone = subject.measure(&alone, &Silent).unwrap();
        assert_eq!(error.against_reference, mean_difference(&subject, alone.front(), reference.front()));
    }
}

#[test]
fn rays_show_the_floor_of_equal_weights() {
    /// On half open half-spheres 4098 cameras are off by 0.012 with equal weights and by 0.002 with area weights; the
    /// rest is room for pixels and rays.
    const FLOOR: f64 = 2.0;
    let home = tempfile::tempdir().unwrap();
    let report = study(&home);
    let [equal, area] = report.meshes[0].errors.last_chunk::<2>().unwrap();
    assert_eq!((equal.cameras, equal.weights, area.weights), (4098, CameraWeights::Equal, CameraWeights::Area));
    let errors = (equal.against_reference, area.against_reference);
    assert!(errors.0 > FLOOR * errors.1, "{errors:?}");
    assert!(report.meshes[0].reference_error.is_some_and(|error| error > 0.0 && error < errors.0), "{errors:?}");
}
