//! Laws over random triangle soups.

use glam::DVec3;
use outsight::mesh::TriMesh;
use outsight::progress::Silent;
use outsight::simplify::{Boundary, Level, PlaneWeight, SimplifyOptions, Stop, Target, Topology, simplify};
use proptest::prelude::*;

use super::shapes::{edge_counts, euler_characteristic};

/// Few vertices on a coarse grid: many shared edges, repeated triangles and triangles without area.
fn soups() -> impl Strategy<Value = TriMesh> {
    let vertices = proptest::collection::vec((-3i8..=3, -3i8..=3, -3i8..=3), 4..24);
    let picks = proptest::collection::vec((any::<u16>(), any::<u16>(), any::<u16>()), 1..80);
    (vertices, picks).prop_filter_map("at least one triangle", |(vertices, picks)| {
        let count = vertices.len() as u16;
        let positions = vertices.iter().map(|&(x, y, z)| DVec3::new(x.into(), y.into(), z.into())).collect();
        let triangles = picks.iter().map(|&(a, b, c)| [a, b, c].map(|v| u32::from(v % count)));
        let triangles = triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        TriMesh::new(positions, triangles).ok()
    })
}

fn options() -> impl Strategy<Value = SimplifyOptions> {
    let flags = (any::<bool>(), any::<bool>(), 0..3usize, any::<bool>(), any::<bool>());
    (flags, 1..20usize).prop_map(|((area, preserve, boundary, shape, loose), target)| SimplifyOptions {
        targets: vec![Target::Triangles(2 * target), Target::Triangles(target)],
        plane_weight: if area { PlaneWeight::Area } else { PlaneWeight::Uniform },
        topology: if preserve { Topology::Preserve } else { Topology::Free },
        boundary: [Boundary::Weight(0.0), Boundary::Weight(1.0), Boundary::Locked][boundary],
        min_compactness: if shape { 1e-4 } else { 0.0 },
        max_valence: shape.then_some(8),
        min_normal_cosine: if loose { -1.0 } else { 0.2 },
        ..SimplifyOptions::default()
    })
}

/// Every triangle that lasts is the image of its input triangle under the vertex map, and the maps cover the level.
fn check_maps(mesh: &TriMesh, level: &Level) {
    assert_eq!(level.vertex_map.len(), mesh.vertex_count());
    assert_eq!(level.triangle_map.len(), mesh.triangle_count());
    let mut next = 0;
    for (t, now) in level.triangle_map.iter().enumerate() {
        let Some(now) = *now else { continue };
        assert_eq!(now, next, "triangles keep their order");
        next += 1;
        let image = mesh.triangles()[t].map(|v| level.vertex_map[v as usize].unwrap());
        assert_eq!(level.mesh.triangles()[now as usize], image);
    }
    assert_eq!(next as usize, level.mesh.triangle_count());
    let mut is_used = vec![false; level.mesh.vertex_count()];
    level.mesh.triangles().iter().flatten().for_each(|&v| is_used[v as usize] = true);
    assert!(is_used.iter().all(|used| *used), "no vertex is left unused");
}

fn check_topology(mesh: &TriMesh, level: &Level, options: &SimplifyOptions) {
    let count =
        |mesh: &TriMesh, wanted: fn(usize) -> bool| edge_counts(mesh).values().filter(|&&n| wanted(n)).count() as i64;
    let change = |wanted: fn(usize) -> bool| count(&level.mesh, wanted) - count(mesh, wanted);
    assert_eq!(level.topology.boundary_edges, change(|n| n == 1));
    assert_eq!(level.topology.non_manifold_edges, change(|n| n > 2));
    if options.topology == Topology::Preserve {
        assert_eq!(level.topology.euler_characteristic, 0);
        assert_eq!(level.topology.components, 0);
        assert!(level.topology.non_manifold_edges <= 0);
    }
}

fn without_unused_vertices(mesh: &TriMesh) -> TriMesh {
    mesh.without_triangles(&vec![false; mesh.triangle_count()]).unwrap().unwrap().mesh
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_soup_gives_a_valid_level(mesh in soups(), options in options(), seed in any::<u64>()) {
        let importance: Vec<f64> =
            (0..mesh.triangle_count() as u64).map(|t| (seed.wrapping_mul(2 * t + 1) >> 60) as f64 / 16.0).collect();
        for importance in [None, Some(&importance[..])] {
            let levels = simplify(&mesh, importance, &options, &Silent).unwrap();
            prop_assert_eq!(levels.len(), 2);
            prop_assert!(levels[0].error <= levels[1].error);
            for level in &levels {
                let kept = level.mesh.triangle_count();
                prop_assert!(kept <= level.target.unwrap() || level.stop == Stop::QueueEmpty);
                prop_assert!(level.error.is_finite() && level.error >= 0.0);
                check_maps(&mesh, level);
                check_topology(&mesh, level, &options);
            }
            let change = euler_characteristic(&levels[1].mesh) - euler_characteristic(&without_unused_vertices(&mesh));
            prop_assert_eq!(levels[1].topology.euler_characteristic, change);
        }
    }

    #[test]
    fn importance_of_one_and_scaling_by_two_change_nothing(mesh in soups(), options in options()) {
        let plain = simplify(&mesh, None, &options, &Silent).unwrap().pop().unwrap();
        let ones = vec![1.0; mesh.triangle_count()];
        let weighted = simplify(&mesh, Some(&ones), &options, &Silent).unwrap().pop().unwrap();
        prop_assert_eq!(&weighted.mesh, &plain.mesh);
        let doubled = mesh.positions().iter().map(|p| 1024.0 * p).collect();
        let doubled = TriMesh::new(doubled, mesh.triangles().to_vec()).unwrap();
        let scaled = simplify(&doubled, None, &options, &Silent).unwrap().pop().unwrap();
        prop_assert_eq!(scaled.mesh.triangles(), plain.mesh.triangles());
        prop_assert_eq!(scaled.error, 1024.0 * plain.error);
    }

    #[test]
    fn locked_vertices_stay(mesh in soups()) {
        let options = SimplifyOptions {
            boundary: Boundary::Locked,
            ..SimplifyOptions::default().with_targets(vec![Target::Triangles(1)])
        };
        let level = simplify(&mesh, None, &options, &Silent).unwrap().pop().unwrap();
        for ((a, b), count) in edge_counts(&mesh) {
            if count == 1 {
                for v in [a, b] {
                    let now = level.vertex_map[v as usize].unwrap();
                    prop_assert_eq!(level.mesh.positions()[now as usize], mesh.positions()[v as usize]);
                }
            }
        }
    }
}
