#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;

use proptest::prelude::*;

use super::*;
use crate::geom::triangle_area;
use crate::mesh::shapes;

/// Lengths and areas are sums of rounded products.
const ROUNDING: f64 = 1e-12;

fn cut(mesh: &TriMesh, longest: f64) -> Subdivision {
    Subdivision::of(mesh, longest, 1_000_000).unwrap()
}

fn triangle(corners: [[f64; 2]; 3]) -> TriMesh {
    TriMesh::new(corners.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec(), vec![[0, 1, 2]]).unwrap()
}

fn halvings(cut: &Subdivision) -> Vec<u8> {
    cut.origins.iter().map(|o| o.halvings).collect()
}

/// How many triangles run along each edge, in each direction.
fn uses(mesh: &TriMesh) -> BTreeMap<[u32; 2], usize> {
    let mut uses = BTreeMap::new();
    mesh.triangles().iter().flat_map(|&t| edges(t)).for_each(|edge| *uses.entry(edge).or_default() += 1);
    uses
}

/// Each edge lies in two triangles, which run along it in opposite directions.
fn is_closed(mesh: &TriMesh) -> bool {
    let uses = uses(mesh);
    uses.iter().all(|(&[a, b], &n)| n == 1 && uses.get(&[b, a]) == Some(&1))
}

fn longest_edge(mesh: &TriMesh) -> f64 {
    let length = |[a, b]: [u32; 2]| (mesh.positions()[a as usize] - mesh.positions()[b as usize]).length();
    mesh.triangles().iter().flat_map(|&t| edges(t)).map(length).fold(0.0, f64::max)
}

#[test]
fn a_triangle_with_short_edges_stays_as_it_is() {
    let small = triangle([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    assert_eq!(cut(&small, 1.5).mesh(), &small);
    assert_eq!(cut(&small, 1.5).share(TriangleId(0)), 1.0);
}

/// ```text
/// 2
/// |`3
/// |  `
/// 0---1
/// ```
#[test]
fn one_long_edge_is_joined_to_the_corner_across() {
    let made = cut(&triangle([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), 1.2);
    assert_eq!(made.mesh().positions()[3], DVec3::new(0.5, 0.5, 0.0));
    assert_eq!(made.mesh().triangles(), [[1, 3, 0], [3, 2, 0]]);
    assert_eq!(halvings(&made), [1, 1]);
}

/// A narrow triangle, its sides long and its base short; vertex 0 at the top leans left or right, or neither.
#[test]
fn two_long_edges_cut_off_a_corner_and_the_shorter_diagonal() {
    // Midpoints: 3 of 0–1 on the left, 4 of 2–0 on the right.
    let leaning = |x: f64| cut(&triangle([[x, 3.0], [0.0, 0.0], [1.0, 0.0]]), 2.5);
    let left = leaning(0.0);
    assert_eq!(left.mesh().triangles(), [[0, 3, 4], [1, 2, 4], [3, 1, 4]], "1–4 is shorter than 3–2");
    let right = leaning(1.0);
    assert_eq!(right.mesh().triangles(), [[0, 3, 4], [3, 1, 2], [3, 2, 4]], "3–2 is shorter than 1–4");
    let even = leaning(0.5);
    assert_eq!(even.mesh().triangles(), [[0, 3, 4], [1, 2, 4], [3, 1, 4]], "equal: 1 is the smallest");
    assert_eq!(halvings(&even), [2, 1, 2]);
}

#[test]
fn two_long_edges_are_cut_alike_wherever_the_triangle_starts() {
    let positions = [[0.5, 3.0], [0.0, 0.0], [1.0, 0.0]].map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
    for start in [[0, 1, 2], [1, 2, 0], [2, 0, 1]] {
        let made = cut(&TriMesh::new(positions.clone(), vec![start]).unwrap(), 2.5);
        let of_base = made.mesh().triangles()[1];
        assert!(of_base.contains(&1) && of_base.contains(&2), "{start:?}");
        let across = made.mesh().positions()[of_base[2] as usize];
        assert_eq!(across, DVec3::new(0.75, 1.5, 0.0), "{start:?}: the diagonal from vertex 1");
    }
}

/// ```text
///     2
///    / \
///   5---4
///  / \ / \
/// 0---3---1
/// ```
#[test]
fn three_long_edges_make_four_pieces() {
    let made = cut(&triangle([[0.0, 0.0], [2.0, 0.0], [1.0, 1.8]]), 1.5);
    assert_eq!(made.mesh().triangles(), [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]);
    assert_eq!(halvings(&made), [2, 2, 2, 2]);
}

/// Halving all edges alike is what happens to a regular triangle; others are estimated within this factor.
const ESTIMATE: f64 = 2.0;

#[test]
fn the_number_of_pieces_is_known_about_before_they_are_made() {
    let regular = triangle([[0.0, 0.0], [4.0, 0.0], [2.0, 12.0_f64.sqrt()]]);
    assert_eq!(Subdivision::estimate(&regular, 1.1), 16.0);
    assert_eq!(Subdivision::estimate(&regular, 5.0), 1.0);
    let sliver = triangle([[0.0, 0.0], [4.0, 0.1], [4.0, -0.1]]);
    for mesh in [regular, sliver, shapes::cluttered_open_box(1, 20, 1).mesh, shapes::nested_spheres(0.5, 2).mesh] {
        let longest = 0.05 * longest_edge(&mesh);
        let (estimate, made) =
            (Subdivision::estimate(&mesh, longest), cut(&mesh, longest).mesh().triangle_count() as f64);
        assert!(estimate / made < ESTIMATE && made / estimate < ESTIMATE, "{estimate} for {made}");
    }
}

/// Two triangles share the edge 1–2, and both find the same midpoint.
#[test]
fn neighbours_share_midpoints() {
    let square = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
    let made = cut(&TriMesh::new(square, vec![[0, 1, 2], [3, 2, 1]]).unwrap(), 1.2);
    assert_eq!(made.mesh().vertex_count(), 5);
    assert_eq!(made.mesh().triangles(), [[1, 4, 0], [4, 2, 0], [2, 4, 3], [4, 1, 3]]);
}

#[test]
fn too_many_pieces_are_refused_before_they_are_made() {
    let error = Subdivision::of(&shapes::tetrahedron(), 1e-9, 1000).unwrap_err();
    assert!(matches!(&error, Error::Limit { message } if message.contains("1000 are allowed")), "{error}");
    assert_eq!(Subdivision::of(&shapes::tetrahedron(), 1e9, 4).unwrap().mesh().triangle_count(), 4);
}

/// At 2^60 neighbouring numbers are 256 apart.
#[test]
fn halving_ends_where_there_are_no_numbers_in_between() {
    let far = 2.0_f64.powi(60);
    let made = cut(&triangle([[far, far], [far + 1024.0, far], [far, far + 1024.0]]), 1e-3);
    // 25 points of the lattice, so at most some dozens of pieces with an edge to halve.
    assert!(made.mesh().triangle_count() < 1000, "{}", made.mesh().triangle_count());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, ..ProptestConfig::default() })]

    #[test]
    fn closed_meshes_stay_closed_and_keep_their_area(
        seeds in prop::collection::vec(-0.4..0.4_f64, 3 * 42),
        stretch in 0.1..8.0_f64,
        longest in 0.2..2.0_f64,
    ) {
        // A shaken ball: edges of every length, triangles of every shape.
        let ball = shapes::icosphere(1);
        let shaken = ball.positions().iter().zip(seeds.chunks_exact(3)).map(|(&p, s)| {
            (p + DVec3::from_slice(s)) * DVec3::new(stretch, 1.0, 1.0)
        });
        let mesh = TriMesh::new(shaken.collect(), ball.triangles().to_vec()).unwrap();
        let made = cut(&mesh, longest);
        prop_assert!(longest_edge(made.mesh()) <= longest * (1.0 + ROUNDING));
        prop_assert!(is_closed(made.mesh()));
        prop_assert_eq!(&made.mesh().positions()[..mesh.vertex_count()], mesh.positions());
        let mut shares = vec![0.0; mesh.triangle_count()];
        for piece in (0..made.mesh().triangle_count() as u32).map(TriangleId) {
            let parent = made.parent(piece);
            shares[parent.0 as usize] += made.share(piece);
            let whole = triangle_area(mesh.corners(parent));
            let area = triangle_area(made.mesh().corners(piece));
            prop_assert!((area - whole * made.share(piece)).abs() <= ROUNDING * stretch.max(1.0));
        }
        prop_assert!(shares.iter().all(|&share| share == 1.0), "the shares of a triangle add up to exactly 1");
        prop_assert!(made.origins.is_sorted_by_key(|o| o.parent));
    }
}
