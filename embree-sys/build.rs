//! Finds Embree 4 or 3, binds its header, and says under which names the library is to be loaded.

use std::env;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Newest first: where both are installed the newer one is bound.
const MAJORS: [u32; 2] = [4, 3];

/// An installation of Embree.
struct Found {
    major: u32,
    include: PathBuf,
    library: PathBuf,
}

#[allow(clippy::print_stderr, reason = "cargo shows what a failing build script prints")]
fn main() -> ExitCode {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=EMBREE_DIR");
    match find(&places()).and_then(|found| bind(&found)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

/// Directories of headers, each with the directories of libraries that go with it.
fn places() -> Vec<(PathBuf, Vec<PathBuf>)> {
    if let Some(root) = env::var_os("EMBREE_DIR").map(PathBuf::from) {
        return vec![(root.join("include"), vec![root.join("lib"), root.join("lib64"), root])];
    }
    let architecture = env::var("CARGO_CFG_TARGET_ARCH").unwrap_or_default();
    ["/usr", "/usr/local", "/opt/homebrew"]
        .map(|root| {
            let root = Path::new(root);
            let libraries = ["lib", "lib64"].map(|d| root.join(d));
            let multiarch = root.join("lib").join(format!("{architecture}-linux-gnu"));
            (root.join("include"), [vec![multiarch], libraries.to_vec()].concat())
        })
        .to_vec()
}

/// The newest Embree whose header and library are both there; otherwise every place tried, and what to do.
fn find(places: &[(PathBuf, Vec<PathBuf>)]) -> Result<Found, String> {
    let mut tried = Vec::new();
    for major in MAJORS {
        for (include, libraries) in places {
            let header = include.join(format!("embree{major}/rtcore.h"));
            if !header.is_file() {
                tried.push(header);
                continue;
            }
            println!("cargo::rerun-if-changed={}", header.display());
            for library in libraries {
                let files =
                    [format!("libembree{major}.so"), format!("libembree{major}.dylib"), format!("embree{major}.lib")];
                if let Some(file) = files.iter().map(|file| library.join(file)).find(|file| file.exists()) {
                    return Ok(Found { major, include: include.clone(), library: file });
                }
                tried.extend(files.map(|file| library.join(file)));
            }
        }
    }
    let tried: Vec<String> = tried.iter().map(|path| format!("  {}", path.display())).collect();
    Err(format!(
        "embree-sys: no Embree 3 or 4 here; install it (Debian, Ubuntu: apt-get install libembree-dev), or set \
         EMBREE_DIR to a directory with include/ and lib/, or build outsight without its feature `embree`; looked \
         for:\n{}",
        tried.join("\n")
    ))
}

/// Says what was found, and writes its declarations.
fn bind(found: &Found) -> Result<(), String> {
    println!("cargo::metadata=major={}", found.major);
    println!("cargo::rustc-check-cfg=cfg(embree4)");
    if found.major == 4 {
        println!("cargo::rustc-cfg=embree4");
    }
    // Where it was found, and by its name wherever the program will run.
    let major = found.major;
    let library = found.library.display();
    println!("cargo::rustc-env=EMBREE_LIBRARIES={library};libembree{major}.so.{major};libembree{major}.so");
    let header = found.include.join(format!("embree{}/rtcore.h", found.major));
    let builder = bindgen::Builder::default()
        .header(header.display().to_string())
        .clang_arg(format!("-I{}", found.include.display()))
        .allowlist_item("(rtc|RTC).*")
        .default_enum_style(bindgen::EnumVariation::Consts)
        .prepend_enum_name(false)
        .derive_default(true)
        .generate_comments(false)
        .dynamic_library_name("Embree")
        .dynamic_link_require_all(true)
        .wrap_unsafe_ops(true)
        .rust_edition(bindgen::RustEdition::Edition2024)
        .layout_tests(true);
    // bindgen panics where it cannot load libclang, with the places where it looked.
    let generated = catch_unwind(AssertUnwindSafe(|| builder.generate()));
    let needs = "bindgen needs libclang with its headers (Debian, Ubuntu: apt-get install libclang-dev)";
    let bindings = generated
        .map_err(|_| format!("embree-sys: {needs}; LIBCLANG_PATH may name its directory"))?
        .map_err(|e| format!("embree-sys: {} cannot be read: {e}; {needs}", header.display()))?;
    let output = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it")).join("bindings.rs");
    bindings.write_to_file(&output).map_err(|e| format!("embree-sys: {}: {e}", output.display()))
}
