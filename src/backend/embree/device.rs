//! The library's handle, and what it says when something goes wrong.
#![allow(unsafe_code, reason = "calls Embree")]

use std::ffi::CString;
use std::fmt;
use std::sync::OnceLock;

use embree_sys as sys;

use crate::error::{Error, Result};

/// The library, loaded when first asked for.
///
/// # Errors
/// [`Error::Unavailable`], with every file that was tried.
pub(super) fn library() -> Result<&'static sys::Embree> {
    // Loaded once and never unloaded: its worker threads may outlive every device.
    static LOADED: OnceLock<sys::Embree> = OnceLock::new();
    if let Some(loaded) = LOADED.get() {
        return Ok(loaded);
    }
    let mut tried = Vec::new();
    for file in sys::LIBRARIES.split(';') {
        // SAFETY: Embree may be loaded at any time; its initialisers have no preconditions.
        match unsafe { sys::Embree::new(file) } {
            Ok(loaded) => return Ok(LOADED.get_or_init(|| loaded)),
            Err(error) => tried.push(error.to_string()),
        }
    }
    let message = format!(
        "backend embree is not available: its library does not load; install it (Debian, Ubuntu: apt-get install \
         libembree-dev) or use --backend raster; tried: {}",
        tried.join("; ")
    );
    Err(Error::Unavailable { message })
}

/// An Embree device, released when dropped.
pub(super) struct Device {
    api: &'static sys::Embree,
    handle: sys::RTCDevice,
}

impl fmt::Debug for Device {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Device").field("handle", &self.handle).finish_non_exhaustive()
    }
}

// SAFETY: "The Embree API calls are thread-safe" (README, "Embree API"); the pointer is used for nothing else. The test
// `one_scene_answers_many_threads_alike` shares one.
unsafe impl Send for Device {}
// SAFETY: as above.
unsafe impl Sync for Device {}

impl Device {
    /// A device that builds with as many threads as the current rayon pool has.
    ///
    /// # Errors
    /// [`Error::Unavailable`] if the library is not there or does not run on this processor, [`Error::Backend`] for anything else it says.
    pub fn new() -> Result<Self> {
        let api = library()?;
        let configuration = format!("threads={}", rayon::current_num_threads());
        let configuration = CString::new(configuration).expect("digits and letters hold no zero byte");
        // SAFETY: the string is zero-terminated and outlives the call.
        let handle = unsafe { api.rtcNewDevice(configuration.as_ptr()) };
        let device = Self { api, handle };
        device.check("making a device")?;
        Ok(device)
    }

    /// The functions of the library.
    pub fn api(&self) -> &'static sys::Embree {
        self.api
    }

    /// The handle, valid while `self` lives.
    pub fn handle(&self) -> sys::RTCDevice {
        self.handle
    }

    /// Version of the library that was loaded, as in 3.13.5.
    pub fn version(&self) -> String {
        let number = [
            sys::RTC_DEVICE_PROPERTY_VERSION_MAJOR,
            sys::RTC_DEVICE_PROPERTY_VERSION_MINOR,
            sys::RTC_DEVICE_PROPERTY_VERSION_PATCH,
        ];
        // SAFETY: the handle came from `rtcNewDevice`, was checked, and is released only in `drop`.
        number.map(|property| unsafe { self.api.rtcGetDeviceProperty(self.handle, property) }.to_string()).join(".")
    }

    /// The first error that the device met since it was last asked, put into words with what was done.
    pub fn check(&self, doing: &str) -> Result<()> {
        // SAFETY: the handle is live, or null where there is no device; then the error is that of making one.
        let code = unsafe { self.api.rtcGetDeviceError(self.handle) };
        let message = match code {
            sys::RTC_ERROR_NONE if !self.handle.is_null() => return Ok(()),
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
        if !self.handle.is_null() {
            // SAFETY: the handle came from `rtcNewDevice`; scenes hold the device itself, so that none outlives it.
            unsafe { self.api.rtcReleaseDevice(self.handle) };
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
        let geometry = unsafe { device.api().rtcNewGeometry(device.handle(), u32::MAX) };
        assert!(geometry.is_null());
        let error = device.check("making a shape that is none").unwrap_err();
        // Version 3 calls this an unknown error, version 4 an invalid argument.
        assert!(matches!(error, Error::Backend { .. }), "{error}");
        assert!(error.to_string().contains("making a shape that is none"), "{error}");
        device.check("after the error was read").unwrap();
    }
}
