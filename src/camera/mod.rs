//! Where the cameras stand.
mod sphere;
pub use sphere::CameraWeights;
