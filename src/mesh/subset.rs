use crate::mesh::TriMesh;

/// Part of a mesh, with the way back to the whole.
#[derive(Debug, Clone)]
pub struct Subset {
    /// The triangles kept, in their old order, and the vertices they use, in theirs.
    pub mesh: TriMesh,
    /// For each vertex of the whole its number in `mesh`, `None` where no kept triangle uses it.
    pub vertex_map: Vec<Option<u32>>,
    /// For each triangle of the whole its number in `mesh`, `None` where it was left out.
    pub triangle_map: Vec<Option<u32>>,
}

impl TriMesh {
    /// The triangles for which `keep` holds, given their numbers; `None` if that is none of them.
    #[must_use]
    pub fn subset(&self, keep: impl Fn(usize) -> bool) -> Option<Subset> {
        let mut vertex_map = vec![None; self.vertex_count()];
        let mut triangle_map = vec![None; self.triangle_count()];
        let mut kept = Vec::new();
        for (t, corners) in self.triangles().iter().enumerate().filter(|&(t, _)| keep(t)) {
            triangle_map[t] = Some(kept.len() as u32);
            corners.iter().for_each(|&v| vertex_map[v as usize] = Some(0));
            kept.push(*corners);
        }
        if kept.is_empty() {
            return None;
        }
        let used = vertex_map.iter_mut().flatten();
        (0..).zip(used).for_each(|(number, slot)| *slot = number);
        let renumbered = |v: u32| vertex_map[v as usize].expect("every vertex of a kept triangle was marked");
        let triangles = kept.into_iter().map(|corners| corners.map(renumbered)).collect();
        let positions =
            self.positions().iter().zip(&vertex_map).filter(|(_, n)| n.is_some()).map(|(&p, _)| p).collect();
        let mesh = Self::new(positions, triangles).expect("part of a valid mesh with a triangle in it is valid");
        Some(Subset { mesh, vertex_map, triangle_map })
    }
}
