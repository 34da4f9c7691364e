//! Small meshes with known answers.

use std::collections::BTreeMap;

use glam::{DVec3, IVec3};
use outsight::mesh::TriMesh;

/// Collects triangles over integer points; equal points become one vertex.
#[derive(Default)]
pub struct Grid {
    numbers: BTreeMap<[i32; 3], u32>,
    points: Vec<IVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Grid {
    pub fn vertex(&mut self, p: IVec3) -> u32 {
        *self.numbers.entry(p.to_array()).or_insert_with(|| {
            self.points.push(p);
            self.points.len() as u32 - 1
        })
    }

    /// Two triangles over a, b, c, d, which go round counter-clockwise.
    pub fn quad(&mut self, corners: [IVec3; 4]) {
        let [a, b, c, d] = corners.map(|p| self.vertex(p));
        self.triangles.extend([[a, b, c], [a, c, d]]);
    }

    /// An n x n sheet of quads from `origin` along `u` and `v`.
    pub fn sheet(&mut self, origin: IVec3, u: IVec3, v: IVec3, n: i32) {
        for i in 0..n {
            for j in 0..n {
                let at = |i: i32, j: i32| origin + u * i + v * j;
                self.quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }

    pub fn into_mesh(self, place: impl Fn(DVec3) -> DVec3) -> TriMesh {
        let positions = self.points.iter().map(|p| place(p.as_dvec3())).collect();
        TriMesh::new(positions, self.triangles).unwrap()
    }
}

/// The cube from 0 to n with n x n quads a side, facing outward.
pub fn cube(n: i32) -> TriMesh {
    box_at(n, IVec3::ZERO)
}

pub fn box_at(n: i32, low: IVec3) -> TriMesh {
    let mut grid = Grid::default();
    add_box(&mut grid, n, low);
    grid.into_mesh(|p| p)
}

pub fn add_box(grid: &mut Grid, n: i32, low: IVec3) {
    let (x, y, z) = (IVec3::X, IVec3::Y, IVec3::Z);
    for (u, v, w) in [(x, y, z), (y, z, x), (z, x, y)] {
        grid.sheet(low + w * n, u, v, n);
        grid.sheet(low, v, u, n);
    }
}

/// A sphere: the cube's points moved outward, 12 n² triangles.
pub fn ball(n: i32) -> TriMesh {
    let mut grid = Grid::default();
    add_box(&mut grid, n, IVec3::ZERO);
    grid.into_mesh(|p| (2.0 * p / f64::from(n) - DVec3::ONE).normalize())
}

/// A square sheet of n x n quads in z = 0.
pub fn sheet(n: i32) -> TriMesh {
    bumpy_sheet(n, |_, _| 0.0)
}

/// A square sheet of n x n quads with these heights.
pub fn bumpy_sheet(n: i32, height: impl Fn(f64, f64) -> f64) -> TriMesh {
    let mut grid = Grid::default();
    grid.sheet(IVec3::ZERO, IVec3::X, IVec3::Y, n);
    grid.into_mesh(|p| DVec3::new(p.x, p.y, height(p.x, p.y)))
}

/// A torus of n x n quads.
pub fn torus(n: i32) -> TriMesh {
    let mut grid = Grid::default();
    for i in 0..n {
        for j in 0..n {
            let at = |i: i32, j: i32| IVec3::new(i % n, j % n, 0);
            grid.quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    grid.into_mesh(|p| {
        let turn = std::f64::consts::TAU / f64::from(n);
        let ((sin_u, cos_u), (sin_v, cos_v)) = ((turn * p.x).sin_cos(), (turn * p.y).sin_cos());
        DVec3::new((3.0 + cos_v) * cos_u, (3.0 + cos_v) * sin_u, sin_v)
    })
}

pub fn tetrahedron() -> TriMesh {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    TriMesh::new(positions, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap()
}

/// How often each edge is used, by its smaller and larger vertex.
pub fn edge_counts(mesh: &TriMesh) -> BTreeMap<(u32, u32), usize> {
    let mut counts = BTreeMap::new();
    for &[a, b, c] in mesh.triangles() {
        for (u, v) in [(a, b), (b, c), (c, a)] {
            *counts.entry((u.min(v), u.max(v))).or_insert(0) += 1;
        }
    }
    counts
}

/// Vertices - edges + triangles, of a mesh without unused vertices.
pub fn euler_characteristic(mesh: &TriMesh) -> i64 {
    mesh.vertex_count() as i64 - edge_counts(mesh).len() as i64 + mesh.triangle_count() as i64
}

pub fn is_closed(mesh: &TriMesh) -> bool {
    edge_counts(mesh).values().all(|&n| n == 2)
}

/// Volume inside a closed mesh.
pub fn volume(mesh: &TriMesh) -> f64 {
    let corners = mesh.triangles().iter().map(|t| t.map(|v| mesh.positions()[v as usize]));
    corners.map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

pub fn area(mesh: &TriMesh) -> f64 {
    let corners = mesh.triangles().iter().map(|t| t.map(|v| mesh.positions()[v as usize]));
    corners.map(outsight::geom::triangle_area).sum()
}
