//! The options that were in force, as JSON: each under the name and value of its flag.

use outsight::backend::BackendKind;
use outsight::camera::{CameraPattern, CameraSphere, CameraWeights};
use outsight::pipeline::{Metric, SimplifyRequest};
use outsight::simplify::{Boundary, PlaneWeight, Topology};
use outsight::visibility::{Estimator, Hidden, MeasureOptions};
use serde_json::{Value, json};

/// Options of measuring. A resolution of `null` was chosen by the number of triangles.
pub fn measure(options: &MeasureOptions) -> Value {
    json!({
        "cameras": camera_count(&options.cameras.pattern),
        "camera_weights": match options.camera_weights {
            CameraWeights::Area => "area",
            CameraWeights::Equal => "equal",
        },
        "camera_pattern": options.cameras.pattern.name(),
        "camera_file": match &options.cameras.pattern {
            CameraPattern::Listed(list) => Some(&list.name),
            _ => None,
        },
        "camera_rotation": options.cameras.rotation,
        "hemisphere": options.cameras.hemisphere.map(|toward| toward.to_array()),
        "resolution": options.resolution,
        "backend": options.backend.name(),
        "estimator": options.estimator.name(),
        "sides": options.sides.name(),
        "points": options.rays.points,
        "partly_seen": options.rays.partly_seen.name(),
        "samples": options.rays.samples,
        "target_error": options.rays.target_error,
        "target_error_p99": options.rays.target_error_p99,
        "seed": options.rays.seed,
        "rescue": (options.estimator == Estimator::ItemBuffer).then(|| options.rescue.name()),
    })
}

/// Cameras of the pattern, before a hemisphere takes some away.
fn camera_count(pattern: &CameraPattern) -> usize {
    match pattern {
        CameraPattern::Octahedral(count) | CameraPattern::Fibonacci(count) => *count,
        CameraPattern::Latlong => CameraSphere::LATLONG,
        CameraPattern::Listed(list) => list.cameras.len(),
    }
}

/// Options of measuring that all settings of `verify` share.
pub fn verify(options: &MeasureOptions) -> Value {
    let mut common = measure(options);
    if let Some(object) = common.as_object_mut() {
        object.shift_remove("backend");
        object.shift_remove("estimator");
    }
    common
}

/// Options of comparing, and of measuring under `measure`. Surface samples of `null` were chosen by the triangles.
pub fn compare(surface_samples: Option<u64>, options: &MeasureOptions) -> Value {
    json!({ "surface_samples": surface_samples, "measure": measure(options) })
}

/// Options of simplifying, and of measuring under `measure`.
pub fn simplify(request: &SimplifyRequest) -> Value {
    let options = &request.simplify;
    let looks_again = (request.metric == Metric::Visibility).then_some(request.hidden);
    json!({
        "metric": request.metric.name(),
        "hidden": request.hidden.name(),
        "hidden_backend": looks_again.and_then(Hidden::backend).map(BackendKind::name),
        "visibility_power": request.visibility_power,
        "max_error": options.max_error,
        "weights_by": match options.plane_weight {
            PlaneWeight::Area => "area",
            PlaneWeight::Uniform => "uniform",
        },
        "topology": match options.topology {
            Topology::Free => "free",
            Topology::Preserve => "preserve",
        },
        "boundary": match options.boundary {
            Boundary::Weight(weight) => json!(weight),
            Boundary::Locked => json!("locked"),
        },
        "measure": measure(&request.measure),
    })
}
