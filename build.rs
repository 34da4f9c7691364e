//! Records how the program was built, for `outsight doctor` and bug reports.

fn main() {
    for name in ["TARGET", "PROFILE"] {
        // Cargo sets both for every build script; a missing one is reported as such rather than guessed.
        let value = std::env::var(name).unwrap_or_else(|_| "unknown".to_owned());
        println!("cargo::rustc-env=OUTSIGHT_BUILD_{name}={value}");
    }
    println!("cargo::rerun-if-changed=build.rs");
}
