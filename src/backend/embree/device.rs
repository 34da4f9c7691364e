//! The library's handle, and what it says when something goes wrong.
#![allow(unsafe_code, reason = "calls Embree")]

use std::ffi::CString;

use embree_sys as sys;

use crate::error::{Error, Result};

/// An Embree device, released when dropped.
#[derive(Debug)]
pub(super) struct Device(sys::RTCDevice);

// SAFETY: "The Embree API calls are thread-safe" (README, "Embree API"); the pointer is used for nothing else. The test
// `one_scene_answers_many_threads_alike` shares one.
unsafe impl Send for Device {}
// SAFETY: as above.
unsafe impl Sync for Device {}

impl Device {
    /// A device that builds with as many threads as the current rayon pool has.
    ///
    /// # Errors
    /// [`Error::Unavailable`] if the library does not run on this processor, [`Error::Backend`] for anything else it says.
    pub fn new() -> Result<Self> {
        let configuration = format!("threads={}", rayon::current_num_threads());
        let configuration = CString::new(configuration).expect("digits and letters hold no zero byte");
        // SAFETY: the string is zero-terminated and outlives the call.
        let device = Self(unsafe { sys::rtcNewDevice(configuration.as_ptr()) });
        device.check("making a device")?;
        Ok(device)
    }

    /// The handle, valid while `self` lives.
    pub fn handle(&self) -> sys::RTCDevice {
        self.0
    }

    /// Version of the library that was loaded, as in 3.13.5.
    pub fn version(&self) -> String {
        let number = [
            sys::RTC_DEVICE_PROPERTY_VERSION_MAJOR,
            sys::RTC_DEVICE_PROPERTY_VERSION_MINOR,
            sys::RTC_DEVICE_PROPERTY_VERSION_PATCH,
        ];
        // SAFETY: the handle came from `rtcNewDevice`, was checked, and is released only in `drop`.
        number.map(|property| unsafe { sys::rtcGetDeviceProperty(self.0, property) }.to_string()).join(".")
    }

    /// The first error that the device met since it was last asked, put into words with what was done.
    pub fn check(&self, doing: &str) -> Result<()> {
        // SAFETY: the handle is live, or null where there is no device; then the error is that of making one.
        let code = unsafe { sys::rtcGetDeviceError(self.0) };
        let message = match code {
            sys::RTC_ERROR_NONE if !self.0.is_null() => return Ok(()),
            sys::RTC_ERROR_OUT_OF_MEMORY => {
                let message = format!("embree ran out of memory while {doing}; use --backend raster");
                return Err(Error::Limit { message });
            }
            sys::RTC_ERROR_UNSUPPORTED_CPU => {
                let message =
                    "backend embree is not available: the library needs a processor with SSE2; use --backend \
                               raster"
                        .to_owned();
                return Err(Error::Unavailable { message });
            }
            sys::RTC_ERROR_UNKNOWN => "unknown error".to_owned(),
            sys::RTC_ERROR_INVALID_ARGUMENT => "invalid argument".to_owned(),
            sys::RTC_ERROR_INVALID_OPERATION => "invalid operation".to_owned(),
            sys::RTC_ERROR_CANCELLED => "cancelled".to_owned(),
            other => format!("error {other}"),
        };
        Err(Error::Backend { message: format!("embree says \"{message}\" while {doing}; use --backend raster") })
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        if !self.0.is_null() {
            // SAFETY: the handle came from `rtcNewDevice`; scenes hold the device itself, so that none outlives it.
            unsafe { sys::rtcReleaseDevice(self.0) };
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn an_error_of_the_device_becomes_an_error_of_ours() {
        let device = Device::new().unwrap();
        // SAFETY: the device is live; the format is no format of an index buffer, which is what is asked for here.
        let geometry = unsafe { sys::rtcNewGeometry(device.handle(), u32::MAX) };
        assert!(geometry.is_null());
        let error = device.check("making a shape that is none").unwrap_err();
        // Version 3 calls this an unknown error, version 4 an invalid argument.
        assert!(matches!(error, Error::Backend { .. }), "{error}");
        assert!(error.to_string().contains("making a shape that is none"), "{error}");
        device.check("after the error was read").unwrap();
    }
}
