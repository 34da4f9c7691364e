//! A mesh without some of its triangles, and maps between the numbers of two meshes.

use super::TriMesh;
use crate::error::{Error, Result};

/// What is left of a mesh, and where its vertices and triangles went.
#[derive(Debug, Clone, PartialEq)]
pub struct Remainder {
    /// The mesh; vertices that no triangle uses are gone, the order of the others is kept.
    pub mesh: TriMesh,
    /// For each vertex before its number in `mesh`, `None` where it is gone.
    pub vertex_map: Vec<Option<u32>>,
    /// For each triangle before its number in `mesh`, `None` where it is gone.
    pub triangle_map: Vec<Option<u32>>,
}

impl TriMesh {
    /// The mesh without the triangles that `remove` marks; `None` where none would be left.
    ///
    /// # Errors
    /// [`Error::ShapeMismatch`] if `remove` is not one mark per triangle.
    pub fn without_triangles(&self, remove: &[bool]) -> Result<Option<Remainder>> {
        if remove.len() != self.triangle_count() {
            let (got, expected) = (remove.len(), self.triangle_count());
            return Err(Error::ShapeMismatch { what: "the marks of triangles to remove", got, expected });
        }
        let kept = || self.triangles.iter().zip(remove).filter(|(_, removed)| !**removed).map(|(t, _)| t);
        let mut is_used = vec![false; self.vertex_count()];
        kept().flatten().for_each(|&v| is_used[v as usize] = true);
        let vertex_map = number_marked(self.vertex_count(), |v| is_used[v]);
        let positions = self.positions.iter().zip(&is_used).filter(|(_, used)| **used).map(|(&p, _)| p).collect();
        let triangles: Vec<_> = kept().filter_map(|&[a, b, c]| renumber([a, b, c], &vertex_map)).collect();
        let triangle_map = number_marked(remove.len(), |t| !remove[t]);
        let is_empty = triangles.is_empty();
        let mesh = Self { positions, triangles };
        Ok((!is_empty).then_some(Remainder { mesh, vertex_map, triangle_map }))
    }
}

/// Where a number goes by way of two maps, one after the other; `None` where either loses it.
#[must_use]
pub fn compose_maps(first: &[Option<u32>], second: &[Option<u32>]) -> Vec<Option<u32>> {
    first.iter().map(|number| number.and_then(|n| second.get(n as usize).copied().flatten())).collect()
}

/// Numbers from 0 for those of `count` items that are marked, in order; `None` for the others.
#[must_use]
pub(crate) fn number_marked(count: usize, is_marked: impl Fn(usize) -> bool) -> Vec<Option<u32>> {
    let mut next = 0;
    let number = |item: usize| {
        let number = is_marked(item).then_some(next);
        next += u32::from(number.is_some());
        number
    };
    (0..count).map(number).collect()
}

fn renumber([a, b, c]: [u32; 3], map: &[Option<u32>]) -> Option<[u32; 3]> {
    Some([map[a as usize]?, map[b as usize]?, map[c as usize]?])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use glam::DVec3;

    use super::*;

    /// Two triangles 0-1-2 and 2-1-3 on a square, and an unused vertex 4.
    fn square() -> TriMesh {
        let positions = [(0, 0), (1, 0), (0, 1), (1, 1), (5, 5)].map(|(x, y)| DVec3::new(x.into(), y.into(), 0.0));
        TriMesh::new(positions.to_vec(), vec![[0, 1, 2], [2, 1, 3]]).unwrap()
    }

    #[test]
    fn remainder_keeps_order_and_maps_point_into_it() {
        let left = square().without_triangles(&[true, false]).unwrap().unwrap();
        assert_eq!(left.mesh.triangles(), [[1, 0, 2]]);
        assert_eq!(left.vertex_map, [None, Some(0), Some(1), Some(2), None]);
        assert_eq!(left.triangle_map, [None, Some(0)]);
    }

    #[test]
    fn nothing_left_is_none_and_a_wrong_length_is_an_error() {
        assert_eq!(square().without_triangles(&[true, true]).unwrap(), None);
        assert!(matches!(square().without_triangles(&[true]), Err(Error::ShapeMismatch { got: 1, expected: 2, .. })));
    }

    #[test]
    fn composed_map_follows_both_and_loses_what_either_loses() {
        let first = [Some(1), None, Some(0), Some(7)];
        assert_eq!(compose_maps(&first, &[None, Some(5)]), [Some(5), None, None, None]);
    }
}
