//! The calls in which Embree 3 and 4 differ: what goes with a query, the order of arguments, streams only in 3.
#![allow(unsafe_code, reason = "calls Embree")]

use std::os::raw::c_int;

use embree_sys as sys;

/// `RTC_INVALID_GEOMETRY_ID`, a cast in a macro that bindgen leaves out.
pub(super) const INVALID_ID: u32 = u32::MAX;

#[cfg(not(embree4))]
type QueryContext = sys::RTCIntersectContext;
#[cfg(embree4)]
type QueryContext = sys::RTCRayQueryContext;

/// What travels through Embree from a query to the filters: the library's part first, then ours.
#[repr(C)]
pub(super) struct Context<T> {
    query: QueryContext,
    pub extension: T,
}

impl<T> Context<T> {
    /// As `rtcInitIntersectContext` and `rtcInitRayQueryContext` do, inline functions that bindgen leaves out.
    pub fn new(extension: T) -> Self {
        #[cfg(not(embree4))]
        let query = QueryContext { instID: [INVALID_ID], ..QueryContext::default() };
        #[cfg(embree4)]
        let query = QueryContext { instID: [INVALID_ID], instPrimID: [INVALID_ID] };
        Self { query, extension }
    }

    /// The extension of the context that a filter is called with.
    ///
    /// # Safety
    /// `query` belongs to a live `Context<T>` that nobody else refers to during the call.
    pub unsafe fn extension_of<'a>(query: *mut QueryContext) -> &'a mut T {
        // SAFETY: `query` is the first field of a `repr(C)` struct, by the caller's promise.
        unsafe { &mut (*query.cast::<Self>()).extension }
    }
}

/// A packet of eight rays with room for their hits, all lanes off.
pub(super) struct Packet {
    pub valid: Lanes,
    pub rays: sys::RTCRayHit8,
}

/// Which lanes of a packet hold a ray: −1 for yes.
#[repr(align(32))]
pub(super) struct Lanes(pub [c_int; 8]);

/// Finds hits along each ray of the packet.
///
/// # Safety
/// `scene` is committed and live.
pub(super) unsafe fn intersect8<T>(
    api: &sys::Embree,
    scene: sys::RTCScene,
    packet: &mut Packet,
    context: &mut Context<T>,
) {
    let valid = packet.valid.0.as_ptr();
    #[cfg(not(embree4))]
    // SAFETY: the scene by the caller's promise; mask, packet and context are live and aligned by their types.
    unsafe {
        api.rtcIntersect8(valid, scene, &raw mut context.query, &raw mut packet.rays);
    }
    #[cfg(embree4)]
    {
        let mut arguments = sys::RTCIntersectArguments {
            flags: sys::RTC_RAY_QUERY_FLAG_COHERENT,
            feature_mask: sys::RTC_FEATURE_FLAG_ALL,
            context: &raw mut context.query,
            ..Default::default()
        };
        // SAFETY: as above; the arguments live as long as the call.
        unsafe { api.rtcIntersect8(valid, scene, &raw mut packet.rays, &raw mut arguments) };
    }
}

/// Sets `tfar` of every ray that something blocks to −∞.
///
/// One stream: on Embree 3 that was 1.4 times as fast as packets of eight (`benches/record`), with the coherent flag off.
///
/// # Safety
/// `scene` is committed and live.
#[cfg(not(embree4))]
pub(super) unsafe fn occluded(api: &sys::Embree, scene: sys::RTCScene, rays: &mut [sys::RTCRay]) {
    let mut context = Context::new(());
    let count = u32::try_from(rays.len()).expect("a batch is short");
    // SAFETY: the scene by the caller's promise; `rays` holds `count` rays one after the other, aligned by their type.
    unsafe { api.rtcOccluded1M(scene, &raw mut context.query, rays.as_mut_ptr(), count, size_of::<sys::RTCRay>()) };
}

/// Sets `tfar` of every ray that something blocks to −∞.
///
/// Packets of eight: Embree 4 has no streams.
///
/// # Safety
/// `scene` is committed and live.
#[cfg(embree4)]
pub(super) unsafe fn occluded(api: &sys::Embree, scene: sys::RTCScene, rays: &mut [sys::RTCRay]) {
    let mut context = Context::new(());
    let mut arguments = sys::RTCOccludedArguments {
        feature_mask: sys::RTC_FEATURE_FLAG_ALL,
        context: &raw mut context.query,
        ..Default::default()
    };
    for eight in rays.chunks_mut(8) {
        let (valid, mut packet) = packed(eight);
        // SAFETY: the scene by the caller's promise; mask, packet and arguments are live and aligned by their types.
        unsafe { api.rtcOccluded8(valid.0.as_ptr(), scene, &raw mut packet, &raw mut arguments) };
        for (ray, tfar) in eight.iter_mut().zip(packet.tfar) {
            ray.tfar = tfar;
        }
    }
}

/// Up to eight rays as a packet.
#[cfg(embree4)]
fn packed(rays: &[sys::RTCRay]) -> (Lanes, sys::RTCRay8) {
    let (mut valid, mut packet) = (Lanes([0; 8]), sys::RTCRay8::default());
    for (lane, ray) in rays.iter().enumerate() {
        valid.0[lane] = -1;
        (packet.org_x[lane], packet.org_y[lane], packet.org_z[lane]) = (ray.org_x, ray.org_y, ray.org_z);
        (packet.dir_x[lane], packet.dir_y[lane], packet.dir_z[lane]) = (ray.dir_x, ray.dir_y, ray.dir_z);
        (packet.tnear[lane], packet.tfar[lane]) = (ray.tnear, ray.tfar);
        (packet.mask[lane], packet.id[lane]) = (ray.mask, ray.id);
    }
    (valid, packet)
}
