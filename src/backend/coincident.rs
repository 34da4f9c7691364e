use std::collections::HashMap;

use crate::camera::UnitMesh;

/// For each triangle of `mesh.triangles` the index there of the first that has its three corners at the same places,
/// whatever their order; its own where it is the first.
///
/// Pictures give a pixel of coincident triangles to the smallest number. Rays that start on one of them follow: the first
/// is not blocked by the others, and the others are blocked by it.
pub(super) fn first_coincident(mesh: &UnitMesh) -> Vec<u32> {
    // Adding 0.0 turns −0.0 into 0.0. A vertex that is not there is for the backend to refuse.
    let place = |v: u32| mesh.positions.get(v as usize).map(|p| p.map(|x| (x + 0.0).to_bits()));
    let mut first = HashMap::with_capacity(mesh.triangles.len());
    let index_of = |(index, &(corners, _)): (u32, &([u32; 3], _))| {
        let mut key = corners.map(place);
        key.sort_unstable();
        *first.entry(key).or_insert(index)
    };
    (0..).zip(&mesh.triangles).map(index_of).collect()
}
