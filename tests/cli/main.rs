//! The program as its users meet it: exit codes, messages, JSON, files. One file a topic.

#![allow(clippy::unwrap_used)]

mod ends;
mod files;
mod flags;
mod looking;
mod objects;
mod products;
mod runner;
mod saying;
mod simplifying;
mod studies;
mod verifying;
