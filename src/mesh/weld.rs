use glam::DVec3;

/// Merges vertices at exactly equal positions (-0.0 equals 0.0) and renumbers the triangles.
///
/// Returns the positions, each once and in the order of its first occurrence, the triangles, and how many vertices
/// were merged away. A triangle may thereby repeat a vertex; [`super::TriMesh::from_triangles`] sets it aside.
///
/// # Panics
/// If a triangle names a vertex that is not there, or there are more than `u32::MAX` positions.
#[must_use]
pub fn weld(positions: Vec<DVec3>, mut triangles: Vec<[u32; 3]>) -> (Vec<DVec3>, Vec<[u32; 3]>, usize) {
    let given = positions.len();
    let mut welder = Welder::default();
    let new_id: Vec<u32> = positions.into_iter().map(|p| welder.vertex_at(p)).collect();
    for triangle in &mut triangles {
        *triangle = triangle.map(|v| new_id[v as usize]);
    }
    let positions = welder.into_positions();
    let merged = given - positions.len();
    (positions, triangles, merged)
}

/// Numbers positions by their first occurrence.
///
/// A hash table with open addressing whose slots are vertex numbers. Numbers follow the order of the input alone, so
/// the hash function shows in no result.
#[derive(Debug, Default)]
pub struct Welder {
    positions: Vec<DVec3>,
    /// Vertex numbers, [`EMPTY`] where free; a power of two long and at most half full.
    slots: Vec<u32>,
}

const EMPTY: u32 = u32::MAX;

impl Welder {
    /// Number of the vertex at `position`, a new one unless an earlier position is equal.
    ///
    /// # Panics
    /// If there are more than `u32::MAX` different positions.
    pub fn vertex_at(&mut self, position: DVec3) -> u32 {
        if self.slots.len() < 2 * (self.positions.len() + 1) {
            self.grow();
        }
        let slot = self.slot_of(position);
        if self.slots[slot] == EMPTY {
            assert!(self.positions.len() < EMPTY as usize, "vertices are numbered in 32 bits");
            self.slots[slot] = self.positions.len() as u32;
            self.positions.push(position);
        }
        self.slots[slot]
    }

    /// The different positions, by vertex number.
    #[must_use]
    pub fn into_positions(self) -> Vec<DVec3> {
        self.positions
    }

    /// The slot that holds the position, or the free one where it belongs.
    fn slot_of(&self, position: DVec3) -> usize {
        let mask = self.slots.len() - 1;
        let wanted = key(position);
        let mut slot = hash(wanted) as usize & mask;
        while self.slots[slot] != EMPTY && key(self.positions[self.slots[slot] as usize]) != wanted {
            slot = (slot + 1) & mask;
        }
        slot
    }

    fn grow(&mut self) {
        let size = (2 * self.slots.len()).max(64);
        self.slots.clear();
        self.slots.resize(size, EMPTY);
        for vertex in 0..self.positions.len() {
            let slot = self.slot_of(self.positions[vertex]);
            self.slots[slot] = vertex as u32;
        }
    }
}

/// Bits that are equal exactly where positions are: adding 0.0 turns -0.0 into 0.0 and changes no other number.
fn key(position: DVec3) -> [u64; 3] {
    (position + 0.0).to_array().map(f64::to_bits)
}

/// Folded multiplication per coordinate, as in wyhash: the low bits of the result depend on all bits of the key.
fn hash(key: [u64; 3]) -> u64 {
    /// Odd constants with about as many ones as zeros (fractional digits of π).
    const MIX: [u64; 2] = [0x243f_6a88_85a3_08d3, 0x1319_8a2e_0370_7345];
    key.iter().fold(MIX[0], |h, &k| {
        let product = u128::from(h ^ k) * u128::from(MIX[1]);
        (product as u64) ^ ((product >> 64) as u64).rotate_left(29)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_positions_become_one_vertex_in_order_of_appearance() {
        let a = DVec3::new(1.0, 0.0, 0.0);
        let b = DVec3::new(0.0, 1.0, 0.0);
        let c = DVec3::new(0.0, 0.0, 1.0);
        let (positions, triangles, merged) = weld(vec![b, a, c, a, b], vec![[0, 1, 2], [2, 3, 4], [0, 4, 2]]);
        assert_eq!(positions, [b, a, c]);
        assert_eq!(triangles, [[0, 1, 2], [2, 1, 0], [0, 0, 2]]);
        assert_eq!(merged, 2);
    }

    #[test]
    fn negative_zero_is_zero_and_the_next_number_is_another() {
        let next = f64::from_bits(1.0_f64.to_bits() + 1);
        let positions = vec![DVec3::new(-0.0, 1.0, 0.0), DVec3::new(0.0, 1.0, -0.0), DVec3::new(0.0, next, 0.0)];
        let (positions, _, merged) = weld(positions, Vec::new());
        assert_eq!((positions.len(), merged), (2, 1));
    }

    #[test]
    fn grid_keeps_its_vertices_apart() {
        let grid: Vec<DVec3> = (0..20_000).map(|i| DVec3::new(f64::from(i % 100), f64::from(i / 100), 7.0)).collect();
        let twice = [grid.clone(), grid.clone()].concat();
        let (positions, _, merged) = weld(twice, Vec::new());
        assert_eq!(positions, grid);
        assert_eq!(merged, 20_000);
    }
}
