//! A committed scene of triangles, and the two questions that it answers.
#![allow(unsafe_code, reason = "calls Embree")]

use embree_sys as sys;

use crate::backend::embree::device::Device;
use crate::backend::embree::version::{self, Context, INVALID_ID, Lanes, Packet};
use crate::error::{Error, Result};
use crate::mesh::MeshError;

/// A ray to infinity as Embree takes it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub origin: [f32; 3],
    pub direction: [f32; 3],
    /// In [`CommittedScene::blocked`] the primitive that does not block it; in [`CommittedScene::crossings`] any number.
    pub number: u32,
}

impl Line {
    /// The number of no primitive.
    pub const NO_NUMBER: u32 = INVALID_ID;
}

/// A place where a line crosses a primitive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Crossing {
    /// The line's number.
    pub line: u32,
    /// Index of the triangle as given to [`CommittedScene::new`].
    pub primitive: u32,
}

/// Rays that one call asks about: a dozen kilobytes, which stay in the first cache.
const STREAM: usize = 256;

/// Embree loads a vertex with 16 bytes, so that behind the last one there must be room to read.
const PADDING: [[f32; 3]; 2] = [[0.0; 3]; 2];

/// Triangles, built and ready to be asked; released when dropped.
#[derive(Debug)]
pub(super) struct CommittedScene {
    handle: sys::RTCScene,
    device: Device,
    // Embree reads both for as long as the scene lives, so they are neither changed nor freed before.
    positions: Box<[[f32; 3]]>,
    triangles: Box<[[u32; 3]]>,
}

// SAFETY: "rtcIntersect/rtcOccluded functions are thread-safe" for a committed scene (README, "Embree API"), which is all
// that `&self` offers; the test `one_scene_answers_many_threads_alike` is the evidence.
unsafe impl Send for CommittedScene {}
// SAFETY: as above.
unsafe impl Sync for CommittedScene {}

impl CommittedScene {
    /// Builds the scene: robust, so that rays do not slip through edges, at medium quality.
    ///
    /// # Errors
    /// [`Error::Mesh`] for an index out of range or a coordinate that is not finite; what the device says.
    pub fn new(mut positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Result<Self> {
        check(&positions, &triangles)?;
        positions.extend(PADDING);
        let device = Device::new()?;
        // SAFETY: the device is live.
        let handle = unsafe { device.api().rtcNewScene(device.handle()) };
        device.check("making a scene")?;
        let scene = Self { handle, device, positions: positions.into(), triangles: triangles.into() };
        scene.build()?;
        Ok(scene)
    }

    fn build(&self) -> Result<()> {
        let api = self.device.api();
        // SAFETY: the scene is live and not committed yet.
        unsafe { api.rtcSetSceneFlags(self.handle, sys::RTC_SCENE_FLAG_ROBUST) };
        // SAFETY: as above.
        unsafe { api.rtcSetSceneBuildQuality(self.handle, sys::RTC_BUILD_QUALITY_MEDIUM) };
        self.attach_triangles()?;
        // SAFETY: the scene is live and holds one committed geometry.
        unsafe { api.rtcCommitScene(self.handle) };
        self.device.check("building a scene")
    }

    fn attach_triangles(&self) -> Result<()> {
        let api = self.device.api();
        // SAFETY: the device is live.
        let geometry = unsafe { api.rtcNewGeometry(self.device.handle(), sys::RTC_GEOMETRY_TYPE_TRIANGLE) };
        self.device.check("making triangles")?;
        let vertices = &self.positions[..self.positions.len() - PADDING.len()];
        // SAFETY: positions live as long as the scene, with the padding behind them.
        unsafe { self.share(geometry, sys::RTC_BUFFER_TYPE_VERTEX, sys::RTC_FORMAT_FLOAT3, vertices) };
        // SAFETY: triangles live as long as the scene; a row of three indices needs no padding.
        unsafe { self.share(geometry, sys::RTC_BUFFER_TYPE_INDEX, sys::RTC_FORMAT_UINT3, &self.triangles) };
        // SAFETY: the geometry is live; both filters keep to what the library says of filters.
        unsafe { api.rtcSetGeometryOccludedFilterFunction(geometry, Some(reject_own)) };
        // SAFETY: as above.
        unsafe { api.rtcSetGeometryIntersectFilterFunction(geometry, Some(note_and_reject)) };
        // SAFETY: the geometry is live and complete.
        unsafe { api.rtcCommitGeometry(geometry) };
        // SAFETY: scene and geometry are live; the scene takes a reference of its own.
        unsafe { api.rtcAttachGeometry(self.handle, geometry) };
        // SAFETY: our reference is not used again.
        unsafe { api.rtcReleaseGeometry(geometry) };
        self.device.check("handing over triangles")
    }

    /// Hands a list over to a geometry, without copying it.
    ///
    /// # Safety
    /// The geometry is live, `format` describes a `T`, and `items` live as long as the scene, with the padding that buffers of
    /// their kind need.
    unsafe fn share<T>(
        &self,
        geometry: sys::RTCGeometry,
        kind: sys::RTCBufferType,
        format: sys::RTCFormat,
        items: &[T],
    ) {
        let (start, size, count) = (items.as_ptr().cast(), size_of::<T>(), items.len());
        // SAFETY: by the caller's promise; the buffer holds that many items of that size.
        unsafe { self.device.api().rtcSetSharedGeometryBuffer(geometry, kind, 0, format, start, 0, size, count) };
    }

    /// Vertex positions; behind the last one lies padding.
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// The triangles, in the order of their primitive numbers.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Says for each line whether a primitive other than the one it names crosses it at or behind its origin.
    pub fn blocked(&self, mut lines: impl ExactSizeIterator<Item = Line>, blocked: &mut [bool]) -> Result<()> {
        debug_assert_eq!(lines.len(), blocked.len());
        for answers in blocked.chunks_mut(STREAM) {
            let mut stream = [sys::RTCRay::default(); STREAM];
            let rays = &mut stream[..answers.len()];
            rays.iter_mut().zip(&mut lines).for_each(|(ray, line)| *ray = ray_along(line));
            // SAFETY: `handle` came from `rtcNewScene`, was committed in `new`, and is released only in `drop`.
            unsafe { version::occluded(self.device.api(), self.handle, rays) };
            answers.iter_mut().zip(rays).for_each(|(answer, ray)| *answer = ray.tfar < 0.0);
        }
        self.device.check("asking about rays")
    }

    /// Appends every crossing of up to eight lines to `crossings`, in no particular order.
    ///
    /// # Errors
    /// [`Error::Limit`] where there is no memory for the crossings.
    pub fn crossings(&self, lines: &[Line], crossings: &mut Vec<Crossing>) -> Result<()> {
        let mut packet = Packet { valid: Lanes([0; 8]), rays: sys::RTCRayHit8::default() };
        let rays = &mut packet.rays.ray;
        for (lane, line) in lines.iter().enumerate().take(8) {
            packet.valid.0[lane] = -1;
            [rays.org_x[lane], rays.org_y[lane], rays.org_z[lane]] = line.origin;
            [rays.dir_x[lane], rays.dir_y[lane], rays.dir_z[lane]] = line.direction;
            (rays.tfar[lane], rays.mask[lane], rays.id[lane]) = (f32::INFINITY, u32::MAX, line.number);
        }
        packet.rays.hit.geomID = [INVALID_ID; 8];
        let mut context = Context::new(Notes { crossings, out_of_memory: false });
        // SAFETY: `handle` came from `rtcNewScene`, was committed in `new`, and is released only in `drop`.
        unsafe { version::intersect8(self.device.api(), self.handle, &mut packet, &mut context) };
        if context.extension.out_of_memory {
            return Err(Error::Limit { message: "no memory for the triangles behind a few pixels".to_owned() });
        }
        Ok(())
    }
}

impl Drop for CommittedScene {
    fn drop(&mut self) {
        // SAFETY: the handle came from `rtcNewScene`; the device and both buffers are dropped after it.
        unsafe { self.device.api().rtcReleaseScene(self.handle) };
    }
}

/// What the C side trusts us to have checked.
fn check(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<()> {
    let fault = |source| Error::Mesh { place: "mesh in the unit sphere".to_owned(), source };
    if let Some(vertex) = positions.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        let [x, y, z] = positions[vertex].map(f64::from);
        return Err(fault(MeshError::BadCoordinate { vertex, x, y, z }));
    }
    let vertex_count = positions.len();
    for (triangle, corners) in triangles.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= vertex_count) {
            return Err(fault(MeshError::IndexOutOfRange { triangle, vertex, vertex_count }));
        }
    }
    Ok(())
}

fn ray_along(line: Line) -> sys::RTCRay {
    let ([org_x, org_y, org_z], [dir_x, dir_y, dir_z]) = (line.origin, line.direction);
    sys::RTCRay {
        org_x,
        org_y,
        org_z,
        dir_x,
        dir_y,
        dir_z,
        tfar: f32::INFINITY,
        mask: u32::MAX,
        id: line.number,
        ..sys::RTCRay::default()
    }
}

/// Where [`note_and_reject`] writes.
struct Notes<'a> {
    crossings: &'a mut Vec<Crossing>,
    out_of_memory: bool,
}

/// The fields that filters read of the hits they are asked about: line number, primitive number.
///
/// # Safety
/// `a` are the arguments of a filter call in progress, and `i < a.N`.
unsafe fn hit(a: &sys::RTCFilterFunctionNArguments, i: usize) -> Crossing {
    let n = a.N as usize;
    // SAFETY: `RTCRayN` is one array of n numbers after the other, and `id` the eleventh.
    let line = unsafe { *a.ray.cast::<u32>().add(10 * n + i) };
    // SAFETY: `RTCHitN` likewise, and `primID` the sixth.
    let primitive = unsafe { *a.hit.cast::<u32>().add(5 * n + i) };
    Crossing { line, primitive }
}

/// Filter of occlusion queries: a ray's own triangle does not block it. Cannot panic.
unsafe extern "C" fn reject_own(arguments: *const sys::RTCFilterFunctionNArguments) {
    // SAFETY: Embree calls with live arguments.
    let a = unsafe { &*arguments };
    for i in 0..a.N as usize {
        // SAFETY: `a` belongs to the call in progress, and `i` is below N.
        let hit = unsafe { hit(a, i) };
        if hit.line == hit.primitive {
            // SAFETY: `valid` has N entries, which a filter may set to 0.
            unsafe { *a.valid.add(i) = 0 };
        }
    }
}

/// Filter of intersection queries: notes every hit and rejects it, so that the ray goes on to the next. Cannot panic.
unsafe extern "C" fn note_and_reject(arguments: *const sys::RTCFilterFunctionNArguments) {
    // SAFETY: Embree calls with live arguments.
    let a = unsafe { &*arguments };
    // SAFETY: intersection queries are made by `crossings` alone, with such a context, which it does not touch meanwhile.
    let notes = unsafe { Context::<Notes<'_>>::extension_of(a.context) };
    for i in 0..a.N as usize {
        // SAFETY: `valid` has N entries, which a filter may set to 0.
        let valid = unsafe { &mut *a.valid.add(i) };
        if *valid != 0 {
            *valid = 0;
            // `push` alone could panic, and no panic may cross the library.
            if notes.crossings.try_reserve(1).is_ok() {
                // SAFETY: `a` belongs to the call in progress, and `i` is below N.
                notes.crossings.push(unsafe { hit(a, i) });
            } else {
                notes.out_of_memory = true;
            }
        }
    }
}
