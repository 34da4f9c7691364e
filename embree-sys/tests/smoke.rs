//! The library that is loaded has the major version of the header that was bound, and it makes a device.
#![allow(unsafe_code, reason = "calls the raw bindings")]

use std::ptr;

use embree_sys::{Embree, LIBRARIES, RTC_DEVICE_PROPERTY_VERSION_MAJOR, RTC_VERSION_MAJOR};

#[test]
fn a_device_is_made_and_has_the_major_version_of_the_header() {
    // SAFETY: Embree may be loaded at any time; its initialisers have no preconditions.
    let loaded = LIBRARIES.split(';').find_map(|name| unsafe { Embree::new(name) }.ok());
    let embree = loaded.expect("the library that the build script found");
    // SAFETY: a null configuration asks for the defaults.
    let device = unsafe { embree.rtcNewDevice(ptr::null()) };
    assert!(!device.is_null());
    // SAFETY: the device was just made and is not null.
    let version = unsafe { embree.rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION_MAJOR) };
    assert_eq!(version, RTC_VERSION_MAJOR as isize);
    // SAFETY: the device was made here and is not used afterwards.
    unsafe { embree.rtcReleaseDevice(device) };
    // Its worker threads may still run.
    std::mem::forget(embree);
}
