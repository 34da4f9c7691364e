//! Ray casting with Embree 3 or 4: item buffers ([`ItemBuffers`](crate::backend::ItemBuffers)) and blocked rays
//! ([`Occlusion`](crate::backend::Occlusion)).
//!
//! `device`, `scene` and `version` are the fence around the C library: handles are owned, what goes in is checked, and only
//! a committed scene can be asked. `version` is the one file in which Embree 3 and 4 differ. `grid` and `occlusion` are
//! safe code in front of the fence.

mod device;
mod grid;
mod occlusion;
mod scene;
mod version;

pub use grid::GridScratch;

use crate::backend::coincident::first_coincident;
use crate::backend::embree::device::Device;
use crate::backend::embree::scene::CommittedScene;
use crate::camera::UnitMesh;
use crate::error::Result;
use crate::mesh::TriangleId;

/// Says whether the library is there.
///
/// # Errors
/// [`Error::Unavailable`](crate::Error::Unavailable), with every file that was tried and what to install.
pub(super) fn check() -> Result<()> {
    device::library().map(drop)
}

/// A mesh laid out for ray casting.
#[derive(Debug)]
pub struct EmbreeScene {
    scene: CommittedScene,
    /// By primitive: the triangle's number, and whether ordering its corners reversed the winding.
    primitives: Vec<(TriangleId, bool)>,
    /// By triangle number.
    primitive_of: Vec<Primitive>,
    extent: f64,
}

/// A triangle's place in the scene.
#[derive(Debug, Clone, Copy)]
enum Primitive {
    /// It is not there: degenerate, or no triangle of the mesh.
    None,
    /// It coincides with one of a smaller number, which hides it and stands for it.
    Behind,
    /// By this number.
    Number(u32),
}

impl EmbreeScene {
    /// Builds the scene of a mesh.
    ///
    /// # Errors
    /// [`Error::Mesh`](crate::Error::Mesh) for an index out of range or a coordinate that is not finite;
    /// [`Error::Unavailable`](crate::Error::Unavailable), [`Error::Limit`](crate::Error::Limit) or
    /// [`Error::Backend`](crate::Error::Backend) as Embree says.
    pub fn new(mesh: &UnitMesh) -> Result<Self> {
        let slots = mesh.triangles.iter().map(|&(_, id)| id.0 as usize + 1).max().unwrap_or(0);
        let mut primitive_of = vec![Primitive::None; slots];
        let (mut triangles, mut primitives) = (Vec::new(), Vec::new());
        let first_coincident = first_coincident(mesh);
        for ((index, &(corners, id)), first) in (0..).zip(&mesh.triangles).zip(first_coincident) {
            if first != index {
                // No ray may see it; in the scene it would only hide the first from its own rays.
                primitive_of[id.0 as usize] = Primitive::Behind;
                continue;
            }
            let (ordered, reversed) = ordered_by_position(corners, &mesh.positions);
            primitive_of[id.0 as usize] = Primitive::Number(triangles.len() as u32);
            triangles.push(ordered);
            primitives.push((id, reversed));
        }
        let scene = CommittedScene::new(mesh.positions.clone(), triangles)?;
        Ok(Self { scene, primitives, primitive_of, extent: mesh.extent })
    }

    /// Version of the library, as in 3.13.5.
    ///
    /// # Errors
    /// As [`EmbreeScene::new`].
    pub fn library_version() -> Result<String> {
        Ok(Device::new()?.version())
    }
}

/// The corners ordered by position, and whether that reversed the winding.
///
/// Coincident triangles become bitwise equal, whatever order, winding or vertex numbers they are stored with: every ray
/// hits either all of them or none, at one depth.
fn ordered_by_position([a, b, c]: [u32; 3], positions: &[[f32; 3]]) -> ([u32; 3], bool) {
    let mut ordered = [a, b, c];
    ordered.sort_by(|&p, &q| {
        let place = |v: u32| positions.get(v as usize);
        place(p).partial_cmp(&place(q)).unwrap_or(std::cmp::Ordering::Equal)
    });
    (ordered, ![[a, b, c], [b, c, a], [c, a, b]].contains(&ordered))
}
