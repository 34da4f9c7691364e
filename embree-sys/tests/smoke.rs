//! The library that was bound is the library that is loaded, and it makes a device.
#![allow(unsafe_code, reason = "calls the raw bindings")]

use std::ptr;

#[test]
fn a_device_is_made_and_has_the_major_version_of_the_header() {
    // SAFETY: a null configuration asks for the defaults.
    let device = unsafe { embree_sys::rtcNewDevice(ptr::null()) };
    assert!(!device.is_null());
    // SAFETY: the device was just made and is not null.
    let version = unsafe { embree_sys::rtcGetDeviceProperty(device, embree_sys::RTC_DEVICE_PROPERTY_VERSION_MAJOR) };
    assert_eq!(version, embree_sys::RTC_VERSION_MAJOR as isize);
    // SAFETY: the device was made here and is not used afterwards.
    unsafe { embree_sys::rtcReleaseDevice(device) };
}
