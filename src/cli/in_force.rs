//! The options that were in force, as JSON: each under the name and value of its flag.

use outsight::camera::CameraWeights;
use outsight::pipeline::SimplifyRequest;
use outsight::simplify::{Boundary, PlaneWeight, Topology};
use outsight::visibility::MeasureOptions;
use serde_json::{Value, json};

/// Options of measuring. A resolution of `null` was chosen by the number of triangles.
pub fn measure(options: &MeasureOptions) -> Value {
    json!({
        "cameras": options.cameras,
        "camera_weights": match options.camera_weights {
            CameraWeights::Area => "area",
            CameraWeights::Equal => "equal",
        },
        "resolution": options.resolution,
        "backend": options.backend.name(),
        "estimator": options.estimator.name(),
        "sides": options.sides.name(),
    })
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

/// Options of simplifying, and of measuring under `measure`.
pub fn simplify(request: &SimplifyRequest) -> Value {
    let options = &request.simplify;
    json!({
        "metric": request.metric.name(),
        "hidden": request.hidden.name(),
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
