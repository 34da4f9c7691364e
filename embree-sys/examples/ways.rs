//! What each way of asking "is this ray blocked?" costs: streams, packets or single rays; robust scenes or fast ones;
//! the ray's own triangle rejected by a filter or skipped by an offset.
//!
//!     outsight convert dragon.ply.zst dragon.ply
//!     cargo run --release -p embree-sys --example ways -- dragon.ply
//!
//! One ray per triangle and direction: from the centroid toward each of 258 directions in front of it, triangles along a
//! Morton curve, blocks of 256 spread over the mesh. Million rays per second are for two threads: rays over processor
//! time, doubled.
#![allow(unsafe_code, reason = "calls the raw bindings")]
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a driver that one runs by hand")]

use std::f32::consts::PI;
use std::os::raw::c_int;
use std::ptr;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use cpu_time::ProcessTime;
use embree_sys::*;

const DIRECTIONS: usize = 258;
/// Consecutive triangles whose rays are asked together.
const BLOCK: usize = 256;
/// Of this many blocks one is asked.
const SKIP: usize = 16;
const STREAM: usize = 256;

type V = [f32; 3];

/// `RTC_INVALID_GEOMETRY_ID`, a cast in a macro that bindgen leaves out.
const INVALID: u32 = u32::MAX;

#[derive(Clone, Copy, PartialEq)]
enum Own {
    Filter,
    Offset,
}

#[derive(Clone, Copy, PartialEq, Debug)]
enum Way {
    #[cfg(not(embree4))]
    Stream,
    #[cfg(not(embree4))]
    CoherentStream,
    Packet8,
    Packet16,
    Single,
}

fn embree() -> &'static Embree {
    static LOADED: OnceLock<Embree> = OnceLock::new();
    // SAFETY: Embree may be loaded at any time; its initialisers have no preconditions.
    let load = || LIBRARIES.split(';').find_map(|name| unsafe { Embree::new(name) }.ok());
    LOADED.get_or_init(|| load().expect("the library that the build script found"))
}

fn main() {
    let path = std::env::args().nth(1).expect("a binary PLY file as `outsight convert` writes it");
    let (positions, triangles) = unit_sphere(read_ply(&std::fs::read(path).unwrap()));
    let order = along_morton_curve(&positions, &triangles);
    println!("{} triangles, Embree {RTC_VERSION_MAJOR}.{RTC_VERSION_MINOR}.{RTC_VERSION_PATCH}", triangles.len());
    println!(
        "way | scene | own triangle | rays in order of | Mray/s on two threads | blocked\n--- | --- | --- | --- | ---: | ---:"
    );
    for robust in [true, false] {
        for own in [Own::Filter, Own::Offset] {
            let scene = Scene::new(&positions, &triangles, robust, own);
            for by_camera in [false, true] {
                let blocks = rays(&positions, &triangles, &order, own, by_camera);
                for way in ways() {
                    scene.report(way, &blocks, [robust, own == Own::Filter, by_camera]);
                }
            }
        }
    }
}

fn ways() -> Vec<Way> {
    #[cfg(not(embree4))]
    return vec![Way::Stream, Way::CoherentStream, Way::Packet8, Way::Packet16, Way::Single];
    #[cfg(embree4)]
    vec![Way::Packet8, Way::Packet16, Way::Single]
}

struct Scene(RTCScene);

// SAFETY: the scene is committed and only asked.
unsafe impl Sync for Scene {}

impl Scene {
    fn new(positions: &[V], triangles: &[[u32; 3]], robust: bool, own: Own) -> Self {
        // SAFETY: Embree copies or owns everything here; the buffers made have room for what is copied into them.
        unsafe {
            let device = embree().rtcNewDevice(ptr::null());
            let (scene, geometry) =
                (embree().rtcNewScene(device), embree().rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
            embree().rtcSetSceneFlags(scene, if robust { RTC_SCENE_FLAG_ROBUST } else { RTC_SCENE_FLAG_NONE });
            let make = |kind, format, count| embree().rtcSetNewGeometryBuffer(geometry, kind, 0, format, 12, count);
            let to = make(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, positions.len());
            ptr::copy_nonoverlapping(positions.as_ptr(), to.cast(), positions.len());
            let to = make(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, triangles.len());
            ptr::copy_nonoverlapping(triangles.as_ptr(), to.cast(), triangles.len());
            if own == Own::Filter {
                embree().rtcSetGeometryOccludedFilterFunction(geometry, Some(reject_own));
            }
            embree().rtcCommitGeometry(geometry);
            embree().rtcAttachGeometry(scene, geometry);
            embree().rtcCommitScene(scene);
            assert_eq!(embree().rtcGetDeviceError(device), RTC_ERROR_NONE);
            Self(scene)
        }
    }

    fn report(&self, way: Way, blocks: &[Vec<RTCRay>], [robust, filter, by_camera]: [bool; 3]) {
        let mut best = (0.0_f64, 0);
        for _ in 0..3 {
            let (start, next, blocked) = (ProcessTime::now(), AtomicUsize::new(0), AtomicUsize::new(0));
            std::thread::scope(|threads| {
                for _ in 0..2 {
                    threads.spawn(|| {
                        while let Some(block) = blocks.get(next.fetch_add(1, Ordering::Relaxed)) {
                            let sum: usize = block.chunks(STREAM).map(|rays| self.ask(way, rays)).sum();
                            blocked.fetch_add(sum, Ordering::Relaxed);
                        }
                    });
                }
            });
            let rays: usize = blocks.iter().map(Vec::len).sum();
            let speed = 2e-6 * rays as f64 / start.elapsed().as_secs_f64();
            best = if speed > best.0 { (speed, blocked.into_inner()) } else { best };
        }
        let [scene, own, order] = [
            ["fast", "robust"][usize::from(robust)],
            ["offset", "filter"][usize::from(filter)],
            ["triangle", "camera"][usize::from(by_camera)],
        ];
        println!("{way:?} | {scene} | {own} | {order} | {:.2} | {}", best.0, best.1);
    }

    /// Blocked rays among up to 256.
    fn ask(&self, way: Way, rays: &[RTCRay]) -> usize {
        let mut copy = [RTCRay::default(); STREAM];
        copy[..rays.len()].copy_from_slice(rays);
        match way {
            #[cfg(not(embree4))]
            Way::Stream | Way::CoherentStream => {
                let mut context = context();
                if way == Way::CoherentStream {
                    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
                }
                let count = rays.len() as u32;
                // SAFETY: the scene is committed, the context and `count` rays are live.
                unsafe { embree().rtcOccluded1M(self.0, &mut context, copy.as_mut_ptr(), count, size_of::<RTCRay>()) };
                blocked(&copy.map(|ray| ray.tfar)[..rays.len()])
            }
            Way::Single => {
                for ray in &mut copy[..rays.len()] {
                    let mut context = context();
                    // SAFETY: as above.
                    #[cfg(not(embree4))]
                    unsafe {
                        embree().rtcOccluded1(self.0, &mut context, ray)
                    };
                    // SAFETY: as above; the arguments point to the live context.
                    #[cfg(embree4)]
                    unsafe {
                        embree().rtcOccluded1(self.0, ray, &mut arguments(&mut context))
                    };
                }
                blocked(&copy.map(|ray| ray.tfar)[..rays.len()])
            }
            Way::Packet8 => rays.chunks(8).map(|rays| self.packet8(rays)).sum(),
            Way::Packet16 => rays.chunks(16).map(|rays| self.packet16(rays)).sum(),
        }
    }
}

macro_rules! packet {
    ($name:ident, $packet:ty, $call:ident, $width:literal) => {
        impl Scene {
            fn $name(&self, rays: &[RTCRay]) -> usize {
                #[repr(align(64))]
                struct Valid([c_int; $width]);
                let (mut packet, mut valid) = (<$packet>::default(), Valid([0; $width]));
                for (lane, ray) in rays.iter().enumerate() {
                    valid.0[lane] = -1;
                    (packet.org_x[lane], packet.org_y[lane], packet.org_z[lane]) = (ray.org_x, ray.org_y, ray.org_z);
                    (packet.dir_x[lane], packet.dir_y[lane], packet.dir_z[lane]) = (ray.dir_x, ray.dir_y, ray.dir_z);
                    (packet.tnear[lane], packet.tfar[lane], packet.mask[lane]) = (ray.tnear, ray.tfar, ray.mask);
                    packet.id[lane] = ray.id;
                }
                let mut context = context();
                // SAFETY: the scene is committed; the packet, its mask and the context are live and aligned.
                #[cfg(not(embree4))]
                unsafe {
                    embree().$call(valid.0.as_ptr(), self.0, &mut context, &mut packet)
                };
                // SAFETY: as above.
                #[cfg(embree4)]
                unsafe {
                    embree().$call(valid.0.as_ptr(), self.0, &mut packet, &mut arguments(&mut context))
                };
                blocked(&packet.tfar[..rays.len()])
            }
        }
    };
}

packet!(packet8, RTCRay8, rtcOccluded8, 8);
packet!(packet16, RTCRay16, rtcOccluded16, 16);

#[cfg(not(embree4))]
fn context() -> RTCIntersectContext {
    RTCIntersectContext { instID: [INVALID; 1], ..Default::default() }
}

#[cfg(embree4)]
fn context() -> RTCRayQueryContext {
    RTCRayQueryContext { instID: [INVALID; 1], instPrimID: [INVALID; 1] }
}

#[cfg(embree4)]
fn arguments(context: &mut RTCRayQueryContext) -> RTCOccludedArguments {
    RTCOccludedArguments { feature_mask: RTC_FEATURE_FLAG_ALL, context, ..Default::default() }
}

/// Rejects the hit on a ray's own triangle, whose number is the ray's.
unsafe extern "C" fn reject_own(arguments: *const RTCFilterFunctionNArguments) {
    // SAFETY: Embree calls with live arguments.
    let a = unsafe { &*arguments };
    let n = a.N as usize;
    for i in 0..n {
        // SAFETY: rays are arrays of n for each field, `id` the eleventh; hits likewise, `primID` the sixth.
        unsafe {
            if *a.ray.cast::<u32>().add(10 * n + i) == *a.hit.cast::<u32>().add(5 * n + i) {
                *a.valid.add(i) = 0;
            }
        }
    }
}

fn blocked(tfar: &[f32]) -> usize {
    tfar.iter().filter(|&&t| t < 0.0).count()
}

fn rays(positions: &[V], triangles: &[[u32; 3]], order: &[u32], own: Own, by_camera: bool) -> Vec<Vec<RTCRay>> {
    let directions: Vec<V> = (0..DIRECTIONS).map(direction).collect();
    let ray = |t: u32, d: V| {
        let [a, b, c] = triangles[t as usize].map(|v| positions[v as usize]);
        let n = cross(sub(b, a), sub(c, a));
        let o: V = std::array::from_fn(|k| (a[k] + b[k] + c[k]) / 3.0);
        (dot(n, d) > 0.0).then_some(RTCRay {
            org_x: o[0],
            org_y: o[1],
            org_z: o[2],
            dir_x: d[0],
            dir_y: d[1],
            dir_z: d[2],
            tnear: if own == Own::Offset { 1e-6 } else { 0.0 },
            tfar: f32::INFINITY,
            mask: u32::MAX,
            id: t,
            ..RTCRay::default()
        })
    };
    let block = |ts: &[u32]| {
        if by_camera {
            directions.iter().flat_map(|&d| ts.iter().filter_map(move |&t| ray(t, d))).collect()
        } else {
            ts.iter().flat_map(|&t| directions.iter().filter_map(move |&d| ray(t, d))).collect()
        }
    };
    order.chunks(BLOCK).step_by(SKIP).map(block).collect()
}

/// Point `i` of a spiral of evenly spread directions.
fn direction(i: usize) -> V {
    let z = 1.0 - (2 * i + 1) as f32 / DIRECTIONS as f32;
    let angle = PI * (1.0 + 5.0_f32.sqrt()) * (i as f32 + 0.5);
    let r = (1.0 - z * z).sqrt();
    [r * angle.cos(), r * angle.sin(), z]
}

fn read_ply(bytes: &[u8]) -> (Vec<V>, Vec<[u32; 3]>) {
    let end = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    let header = std::str::from_utf8(&bytes[..end]).unwrap();
    let count = |what: &str| -> usize {
        header.lines().find_map(|line| line.strip_prefix(what)).unwrap().trim().parse().unwrap()
    };
    let (vertices, faces) = (count("element vertex"), count("element face"));
    let word = |at: usize| <[u8; 4]>::try_from(&bytes[at..at + 4]).unwrap();
    let positions = (0..vertices).map(|v| [0, 4, 8].map(|k| f32::from_le_bytes(word(end + 12 * v + k)))).collect();
    let start = end + 12 * vertices + 1;
    let triangles = (0..faces).map(|t| [0, 4, 8].map(|k| u32::from_le_bytes(word(start + 13 * t + k)))).collect();
    (positions, triangles)
}

fn unit_sphere((mut positions, triangles): (Vec<V>, Vec<[u32; 3]>)) -> (Vec<V>, Vec<[u32; 3]>) {
    let fold = |f: fn(f32, f32) -> f32| [0, 1, 2].map(|k| positions.iter().map(|p| p[k]).reduce(f).unwrap());
    let (low, high) = (fold(f32::min), fold(f32::max));
    let centre: V = std::array::from_fn(|k| 0.5 * (low[k] + high[k]));
    let radius = positions.iter().map(|&p| dot(sub(p, centre), sub(p, centre))).fold(0.0, f32::max).sqrt();
    for p in &mut positions {
        *p = sub(*p, centre).map(|x| x / radius);
    }
    (positions, triangles)
}

fn along_morton_curve(positions: &[V], triangles: &[[u32; 3]]) -> Vec<u32> {
    let spread = |x: f32| {
        let x = ((x + 1.0) * 511.5) as u32;
        (0..10).map(|bit| (x >> bit & 1) << (3 * bit)).sum::<u32>()
    };
    let key = |t: u32| {
        let p = positions[triangles[t as usize][0] as usize];
        spread(p[0]) | spread(p[1]) << 1 | spread(p[2]) << 2
    };
    let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
    order.sort_by_cached_key(|&t| key(t));
    order
}

fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: V, b: V) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
