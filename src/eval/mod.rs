//! What a simplification did: to the picture and to the geometry.

mod nearest;
mod sample;

pub mod geometric;
