//! Where the cameras stand: a sphere of orthographic cameras around the mesh, and the frame they share.
//!
//! [`Cameras`] says which cameras look, [`CameraSphere`] is them. Orthographic rays of the directions +d and −d are the same
//! lines, so cameras come in pairs, [`Axis`]: one pass over the triangles gives both images. All of this happens in the unit sphere: [`Frame`] is the one place where a mesh is
//! centred, scaled and narrowed to `f32`.
//!
//! Source: Zhang & Turk 2002, section 4 (octahedral pattern). The solid-angle weights are the area(v) of their
//! eq. (4.3), which they cancel as if all were equal; they are not, by a factor of 2.8 at 258 cameras.

mod cameras;
mod frame;
mod occluders;
mod pattern;
mod rotation;
mod sphere;
mod view;

pub use cameras::{CameraList, CameraPattern, Cameras};
pub use frame::{Frame, UnitMesh};
pub use occluders::Occluders;
pub use rotation::random_rotation;
pub use sphere::{Axis, CameraSphere, CameraWeights};
pub use view::{View, Window};
