//! No ray leaves a closed mesh unseen: ten of them, random rays from inside, and rays aimed at vertices and edges.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;

use glam::{DQuat, DVec3};
use outsight::backend::{Brute, EmbreeScene, Occlusion, Ray};
use outsight::camera::{Frame, UnitMesh};
use outsight::mesh::{TriMesh, shapes};
use rayon::prelude::*;

/// Places inside each mesh from which rays start.
const ORIGINS: usize = 500;

/// Share of the rays aimed at vertices and edge midpoints that may slip past Embree: on Embree 3.13 up to 0.0028 did, on
/// the flat ellipsoid. None may slip past the exact test that they are retried with.
const AIMED_MAY_MISS: f64 = 0.01;

/// Closed meshes of many kinds, turned so that nothing is aligned with the axes.
fn closed_meshes() -> Vec<(&'static str, TriMesh)> {
    let gearbox = shapes::gearbox(0.5);
    let part = |name: &str| {
        let (_, triangles) = gearbox.parts.iter().find(|(part, _)| part.ends_with(name)).unwrap();
        let picked = gearbox.mesh.triangles()[triangles.clone()].to_vec();
        TriMesh::new(gearbox.mesh.positions().to_vec(), picked).unwrap()
    };
    vec![
        ("tetrahedron", shapes::tetrahedron()),
        ("cuboid", shapes::cuboid(DVec3::new(1.0, 2.0, 3.0), 24)),
        ("icosphere", shapes::icosphere(5)),
        ("sphere with poles", shapes::uv_sphere(128, 96)),
        ("flat ellipsoid", shapes::ellipsoid(DVec3::new(1.0, 0.7, 0.05), 128, 96)),
        ("torus", shapes::torus(1.0, 0.3, 160, 80)),
        ("bumpy sphere", shapes::bumpy_sphere(5, 0.2)),
        ("box with thick walls", shapes::open_box_solid(0.1, 16).mesh),
        ("gearbox case", part("case")),
        ("bearing ring", part("outer ring")),
    ]
}

/// A small generator of random numbers, the same everywhere.
///
/// Source: Steele, Lea, Flood 2014, Fast splittable pseudorandom number generators (SplitMix64).
struct Random(u64);

impl Random {
    /// A number in 0..1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let d = DVec3::from_array(std::array::from_fn(|_| 2.0 * self.next() - 1.0));
            if (1e-3..=1.0).contains(&d.length_squared()) {
                return d.normalize();
            }
        }
    }
}

/// Where the line crosses the mesh, ascending.
fn crossings(mesh: &UnitMesh, origin: DVec3, direction: DVec3) -> Vec<f64> {
    let crossing = |corners: [u32; 3]| {
        let [a, b, c] = corners.map(|v| DVec3::from_array(mesh.positions[v as usize].map(f64::from)) - origin);
        let [u, v, w] = [(b, c), (c, a), (a, b)].map(|(p, q)| direction.dot(p.cross(q)));
        let inside = (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
        inside.then(|| (a * u + b * v + c * w).dot(direction) / (u + v + w))
    };
    let mut found: Vec<f64> = mesh.triangles.iter().filter_map(|&(corners, _)| crossing(corners)).collect();
    found.sort_by(f64::total_cmp);
    found
}

/// Points inside: halfway between where a random line enters and leaves.
fn places_inside(mesh: &UnitMesh, random: &mut Random) -> Vec<DVec3> {
    let mut places = Vec::new();
    while places.len() < ORIGINS {
        let (near, direction) = (random.direction() * random.next(), random.direction());
        let crossed = crossings(mesh, near, direction);
        if crossed.len().is_multiple_of(2) {
            // Thinner than this, rounding to `f32` could put the point outside.
            let thick = crossed.chunks_exact(2).filter(|span| span[1] - span[0] > 1e-3);
            places.extend(thick.map(|span| near + 0.5 * (span[0] + span[1]) * direction));
        }
    }
    places.truncate(ORIGINS);
    places
}

fn ray(origin: DVec3, direction: DVec3) -> Ray {
    Ray { origin: origin.as_vec3().to_array(), direction: direction.as_vec3().to_array(), own: None }
}

/// The rays that `backend` lets out.
fn escaping(backend: &impl Occlusion, rays: &[Ray]) -> Vec<Ray> {
    let mut blocked = vec![false; rays.len()];
    backend.blocked(rays, &mut blocked).unwrap();
    rays.iter().zip(blocked).filter(|&(_, blocked)| !blocked).map(|(ray, _)| *ray).collect()
}

fn unit(mesh: &TriMesh) -> UnitMesh {
    let turn = DQuat::from_rotation_z(0.3) * DQuat::from_rotation_x(0.7);
    let turned = mesh.positions().iter().map(|&p| turn * p).collect();
    let mesh = TriMesh::new(turned, mesh.triangles().to_vec()).unwrap();
    Frame::of(&mesh).unit_copy(&mesh)
}

fn no_random_ray_escapes(rays_per_mesh: usize) {
    for (seed, (name, mesh)) in (0..).zip(closed_meshes()) {
        let mesh = unit(&mesh);
        let scene = EmbreeScene::new(&mesh).unwrap();
        let places = places_inside(&mesh, &mut Random(seed));
        let escaped: usize = (0..)
            .zip(&places)
            .par_bridge()
            .map(|(number, &place)| {
                let mut random = Random(seed << 32 | number << 8);
                let rays: Vec<Ray> = (0..rays_per_mesh / ORIGINS).map(|_| ray(place, random.direction())).collect();
                escaping(&scene, &rays).len()
            })
            .sum();
        assert_eq!(escaped, 0, "{name}: of {rays_per_mesh} random rays");
    }
}

#[test]
fn no_random_ray_escapes_from_ten_closed_meshes() {
    no_random_ray_escapes(1_000_000);
}

#[test]
#[ignore = "1e8 rays take a minute of processor time"]
fn no_random_ray_escapes_from_ten_closed_meshes_in_ten_million_each() {
    no_random_ray_escapes(10_000_000);
}

/// Vertices, and the middle of every edge.
fn delicate_points(mesh: &UnitMesh) -> Vec<DVec3> {
    let place = |v: u32| DVec3::from_array(mesh.positions[v as usize].map(f64::from));
    let sides = |&([a, b, c], _): &([u32; 3], _)| [(a, b), (b, c), (c, a)].map(|(p, q)| (p.min(q), p.max(q)));
    let edges: BTreeSet<(u32, u32)> = mesh.triangles.iter().flat_map(sides).collect();
    let vertices: BTreeSet<u32> = edges.iter().flat_map(|&(a, b)| [a, b]).collect();
    let middles = edges.iter().map(|&(a, b)| 0.5 * (place(a) + place(b)));
    vertices.iter().map(|&v| place(v)).chain(middles).collect()
}

#[test]
fn no_ray_at_a_vertex_or_an_edge_escapes_the_exact_retry() {
    for (seed, (name, mesh)) in (100..).zip(closed_meshes()) {
        let mesh = unit(&mesh);
        let (scene, judge) = (EmbreeScene::new(&mesh).unwrap(), Brute::new(&mesh));
        let places = places_inside(&mesh, &mut Random(seed));
        let targets = delicate_points(&mesh);
        let rays: Vec<Ray> = (targets.iter().cycle().take(100_000.max(targets.len())).zip(places.iter().cycle()))
            .map(|(&target, &place)| ray(place, (target - place).normalize()))
            .collect();
        let missed = escaping(&scene, &rays);
        let share = missed.len() as f64 / rays.len() as f64;
        assert!(share <= AIMED_MAY_MISS, "{name}: {share} of the rays slip past Embree");
        assert_eq!(escaping(&judge, &missed), [], "{name}");
    }
}
