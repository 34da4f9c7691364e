//! The model that `outsight demo` shows, inside the program so that an installed binary needs no other file.

/// Its name.
pub const NAME: &str = "gearbox.ply.zst";

/// The compressed PLY file, as in `data/`.
pub const BYTES: &[u8] = include_bytes!("../../data/gearbox.ply.zst");
