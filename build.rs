//! Records how the program was built, for `outsight doctor` and bug reports, and which Embree it is built with.

fn main() {
    for name in ["TARGET", "PROFILE"] {
        // Cargo sets both for every build script; a missing one is reported as such rather than guessed.
        let value = std::env::var(name).unwrap_or_else(|_| "unknown".to_owned());
        println!("cargo::rustc-env=OUTSIGHT_BUILD_{name}={value}");
    }
    println!("cargo::rustc-check-cfg=cfg(embree4)");
    if std::env::var("DEP_EMBREE_MAJOR").is_ok_and(|major| major == "4") {
        println!("cargo::rustc-cfg=embree4");
    }
    println!("cargo::rerun-if-changed=build.rs");
}
