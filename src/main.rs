//! The `outsight` program.

fn main() {}
