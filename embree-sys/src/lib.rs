#![doc = include_str!("../README.md")]
#![allow(unsafe_code, reason = "generated declarations of a C library")]
#![allow(missing_docs, non_camel_case_types, non_snake_case, non_upper_case_globals, reason = "the names are Embree's")]

include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
