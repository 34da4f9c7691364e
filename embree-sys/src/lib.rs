#![doc = include_str!("../README.md")]
#![allow(unsafe_code, reason = "generated declarations of a C library")]
#![allow(
    clippy::missing_safety_doc,
    clippy::too_many_arguments,
    reason = "what each function asks for stands in Embree's manual"
)]
#![allow(missing_docs, non_camel_case_types, non_snake_case, non_upper_case_globals, reason = "the names are Embree's")]

/// Files that may be the library, to be tried in this order, with `;` between them.
pub const LIBRARIES: &str = env!("EMBREE_LIBRARIES");

include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
