//! The source tree keeps its layers: a module uses only what stands above it.
//!
//! Also: `unsafe` stays behind its fence, and only the program prints or exits. Sources are read as text, with comments,
//! literals and test modules taken out, so that every feature's code is covered whatever is compiled.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

/// Each module with what it may use. A module that is not listed fails the test: decide its place first.
const LAYERS: &[(&str, &[&str])] = &[
    // 0
    ("error", &[]),
    ("progress", &["error"]),
    ("geom", &[]),
    // 1
    ("mesh", LAYER_0),
    // 2
    ("io", LAYERS_0_1),
    ("camera", LAYERS_0_1),
    ("simplify", LAYERS_0_1),
    // 3
    ("raster", &["error", "progress", "geom", "mesh", "camera"]),
    // 4
    ("backend", &["error", "progress", "geom", "mesh", "camera", "raster"]),
    // 5
    ("visibility", LAYERS_0_4),
    ("eval", LAYERS_0_4),
    ("silhouette", LAYERS_0_4),
    // 6
    ("multires", LAYERS_0_5),
    ("refit", LAYERS_0_5),
    ("report", LAYERS_0_5),
    ("shard", LAYERS_0_5),
    ("pipeline", PIPELINE),
];

const LAYER_0: &[&str] = &["error", "progress", "geom"];
const LAYERS_0_1: &[&str] = &["error", "progress", "geom", "mesh"];
/// Visibility and its like neither read files nor collapse edges.
const LAYERS_0_4: &[&str] = &["error", "progress", "geom", "mesh", "camera", "raster", "backend"];
/// The straight path is written out below its siblings: it puts what the others make into reports and pictures.
const PIPELINE: &[&str] = &[
    "error",
    "progress",
    "geom",
    "mesh",
    "io",
    "camera",
    "simplify",
    "raster",
    "backend",
    "visibility",
    "eval",
    "silhouette",
    "report",
];
const LAYERS_0_5: &[&str] = &[
    "error",
    "progress",
    "geom",
    "mesh",
    "io",
    "camera",
    "simplify",
    "raster",
    "backend",
    "visibility",
    "eval",
    "silhouette",
];

/// Paths that a module may name although the table forbids their module: `error` gathers the areas' own errors.
const EXCEPTIONS: &[(&str, &str)] = &[("error", "mesh::MeshError")];

/// Names at the crate's root that are re-exports from `error`.
const ROOT_NAMES: &[&str] = &["Error", "Result"];

/// The program: everything is above it.
const PROGRAM: &[&str] = &["cli", "main"];

/// Crates that only the program may use.
const PROGRAM_CRATES: &[&str] = &["clap", "clap_complete", "clap_mangen", "indicatif", "signal_hook"];

/// What only the program may do.
const PROGRAM_ONLY: &[&str] =
    &["print!", "println!", "eprint!", "eprintln!", "dbg!", "process::exit", "process::abort"];

#[test]
fn every_module_uses_only_what_stands_above_it() {
    let violations: Vec<String> =
        library_sources().iter().flat_map(|s| layer_violations(&s.module, &s.code, s.is_root_of_module)).collect();
    assert!(violations.is_empty(), "{}", violations.join("\n"));
}

#[test]
fn only_the_program_prints_exits_or_parses_flags() {
    let violations: Vec<String> =
        library_sources().iter().flat_map(|s| program_violations(&s.path.display().to_string(), &s.code)).collect();
    assert!(violations.is_empty(), "{}", violations.join("\n"));
}

#[test]
fn unsafe_stays_behind_its_fence() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let fence = root.join("src/backend/embree");
    let places = ["src", "tests", "benches", "examples"];
    let mut files: Vec<PathBuf> = places.iter().flat_map(|p| rust_files(&root.join(p))).collect();
    files.push(root.join("build.rs"));
    let outside = files.iter().filter(|f| !f.starts_with(&fence));
    let found: Vec<_> = outside.filter(|f| has_word(&code_of(&fs::read_to_string(f).unwrap()), "unsafe")).collect();
    assert!(found.is_empty(), "{found:?}");
}

#[test]
fn planted_violations_are_found() {
    let found = |module: &str, text: &str| layer_violations(module, &without_tests(&code_of(text)), false).len();
    assert_eq!(found("mesh", "use crate::io::read;"), 1, "below");
    assert_eq!(found("camera", "use crate::simplify::Target;"), 1, "beside");
    assert_eq!(found("simplify", "fn f() { crate::visibility::measure(); }"), 1, "a path without use");
    assert_eq!(found("simplify", "use crate::{error::Result, pipeline, mesh::{self, TriMesh}};"), 1, "in a group");
    assert_eq!(found("geom", "use outsight::mesh::TriMesh;"), 1, "by the crate's name");
    assert_eq!(found("brand_new", "use crate::mesh;"), 1, "a module without a place");
    assert_eq!(found("error", "use crate::mesh::{MeshError, TriMesh};"), 1, "beside an exception");
    assert_eq!(layer_violations("mesh", "use super::io;", true).len(), 1, "through super at the module's root");

    assert_eq!(found("mesh", "use crate::mesh::weld; use crate::Result; use crate::geom::Aabb;"), 0);
    assert_eq!(found("error", "pub use crate::mesh::MeshError;"), 0);
    assert_eq!(found("mesh", "// see crate::io\nconst A: &str = \"crate::io\"; /* crate::cli */"), 0);
    assert_eq!(found("mesh", "#[cfg(test)]\nmod tests { use crate::io; fn f() { {} } }\nuse crate::geom;"), 0);
    assert_eq!(found("mesh", "#[cfg(test)]\nmod tests { }\nuse crate::io;"), 1, "after a test module");
}

#[test]
fn planted_prints_and_unsafe_are_found() {
    let found = |text: &str| program_violations("x.rs", &without_tests(&code_of(text))).len();
    assert_eq!(found("fn f() { println!(\"x\"); }"), 1);
    assert_eq!(found("fn f() { std::process::exit(1) }"), 1);
    assert_eq!(found("use indicatif::ProgressBar;"), 1);
    assert_eq!(found("fn f() { writeln!(out, \"println!\"); } // println!"), 0);
    assert!(has_word(&code_of("let c = '\"'; unsafe { f() }"), "unsafe"), "after a quote in quotes");
    assert!(!has_word(&code_of("#![deny(unsafe_code)] // unsafe"), "unsafe"));
}

/// A source file of the library, without comments, literals and tests.
struct Source {
    path: PathBuf,
    module: String,
    code: String,
    /// `src/NAME.rs` or `src/NAME/mod.rs`, where `super` is the crate.
    is_root_of_module: bool,
}

fn library_sources() -> Vec<Source> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let sources: Vec<Source> = rust_files(&src).into_iter().filter_map(|path| library_source(&src, path)).collect();
    assert!(sources.len() >= 10, "the sources are where this test looks for them");
    sources
}

fn library_source(src: &Path, path: PathBuf) -> Option<Source> {
    let inside = path.strip_prefix(src).unwrap().with_extension("");
    let parts: Vec<String> = inside.iter().map(|p| p.to_string_lossy().into_owned()).collect();
    let is_test = parts.iter().any(|p| p.ends_with("tests"));
    if is_test || parts == ["lib"] || PROGRAM.contains(&parts[0].as_str()) {
        return None;
    }
    let is_root_of_module = parts.len() == 1 || (parts.len() == 2 && parts[1] == "mod");
    let code = without_tests(&code_of(&fs::read_to_string(&path).unwrap()));
    Some(Source { module: parts[0].clone(), path, code, is_root_of_module })
}

fn rust_files(directory: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(directory) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.map(|e| e.unwrap().path()).collect();
    paths.sort();
    let is_rust = |p: &PathBuf| p.extension().is_some_and(|e| e == "rs");
    paths.into_iter().flat_map(|p| if p.is_dir() { rust_files(&p) } else { vec![p] }).filter(is_rust).collect()
}

/// What `module` names and may not.
fn layer_violations(module: &str, code: &str, is_root_of_module: bool) -> Vec<String> {
    let Some((_, allowed)) = LAYERS.iter().find(|(name, _)| *name == module) else {
        return vec![format!("{module}: has no layer yet; give it one in tests/layers.rs")];
    };
    let mut roots = vec!["crate::", "outsight::"];
    if is_root_of_module {
        roots.push("super::");
    }
    let named = roots.iter().flat_map(|root| paths_behind(code, root));
    let is_fine = |path: &String| {
        let first = path.split("::").next().unwrap_or_default();
        first == module
            || allowed.contains(&first)
            || ROOT_NAMES.contains(&first)
            || EXCEPTIONS.contains(&(module, path.as_str()))
    };
    let wrong = named.filter(|path| !is_fine(path));
    wrong.map(|path| format!("{module} uses {path}, which does not stand above it")).collect()
}

/// Prints, exits and the program's crates in library code.
fn program_violations(file: &str, code: &str) -> Vec<String> {
    let words = PROGRAM_ONLY.iter().filter(|word| has_word(code, word));
    let crates = PROGRAM_CRATES.iter().filter(|name| has_word(code, &format!("{name}::")));
    words.chain(crates).map(|what| format!("{file}: {what} belongs into src/cli")).collect()
}

/// The first two names of every path that begins with `root`; groups in braces are opened.
fn paths_behind(code: &str, root: &str) -> Vec<String> {
    let starts = code.match_indices(root).filter(|(at, _)| !code[..*at].ends_with(|c: char| is_name(c) || c == ':'));
    starts.flat_map(|(at, _)| expand(&code[at + root.len()..])).map(|path| first_two(&path)).collect()
}

fn first_two(path: &str) -> String {
    path.split("::").take(2).collect::<Vec<_>>().join("::")
}

/// All paths of a use tree that begins at `text`: `a::{b, c::d}` gives `a::b` and `a::c::d`.
fn expand(text: &str) -> Vec<String> {
    if let Some(inside) = text.strip_prefix('{') {
        return split_group(inside).iter().flat_map(|part| expand(part.trim())).collect();
    }
    let name: String = text.chars().take_while(|&c| is_name(c)).collect();
    match text[name.len()..].strip_prefix("::") {
        Some(rest) => expand(rest).iter().map(|path| format!("{name}::{path}")).collect(),
        None => vec![name],
    }
}

/// The parts of a group, up to its closing brace.
fn split_group(text: &str) -> Vec<String> {
    let mut parts = vec![String::new()];
    let mut depth = 0;
    for c in text.chars() {
        match c {
            '}' if depth == 0 => break,
            ',' if depth == 0 => parts.push(String::new()),
            _ => {
                depth += i32::from(c == '{') - i32::from(c == '}');
                parts.last_mut().unwrap().push(c);
            }
        }
    }
    parts.retain(|p| !p.trim().is_empty());
    parts
}

fn is_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// True if `word` stands in `code` on its own, not as the end of a longer name.
fn has_word(code: &str, word: &str) -> bool {
    code.match_indices(word).any(|(at, _)| {
        let (before, after) = (&code[..at], &code[at + word.len()..]);
        let open_end = word.ends_with(|c: char| !is_name(c));
        !before.ends_with(is_name) && (open_end || !after.starts_with(is_name))
    })
}

/// `code` without the bodies of its `#[cfg(test)]` modules.
fn without_tests(code: &str) -> String {
    let mut rest = code;
    let mut kept = String::new();
    while let Some(at) = rest.find("#[cfg(test)]") {
        kept.push_str(&rest[..at]);
        rest = behind_item(&rest[at..]);
    }
    kept + rest
}

/// What follows the item at the start of `code`: behind its `;` or its closing brace.
fn behind_item(code: &str) -> &str {
    let mut depth = 0;
    for (at, c) in code.char_indices() {
        match c {
            ';' if depth == 0 => return &code[at + 1..],
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => continue,
        }
        if depth == 0 {
            return &code[at + 1..];
        }
    }
    ""
}

/// `text` without comments and without what stands in quotes.
fn code_of(text: &str) -> String {
    let mut code = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let skipped = length_of_comment(rest).or_else(|| length_of_literal(rest, &code));
        match skipped {
            Some(length) => {
                code.push(' ');
                rest = &rest[length..];
            }
            None => {
                code.push(c);
                rest = &rest[c.len_utf8()..];
            }
        }
    }
    code
}

fn length_of_comment(text: &str) -> Option<usize> {
    if text.starts_with("//") {
        return Some(text.find('\n').unwrap_or(text.len()));
    }
    if !text.starts_with("/*") {
        return None;
    }
    let mut depth = 0;
    let mut at = 0;
    while at < text.len() {
        let here = &text.as_bytes()[at..];
        if here.starts_with(b"/*") {
            depth += 1;
            at += 2;
        } else if here.starts_with(b"*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return Some(at);
            }
        } else {
            at += 1;
        }
    }
    Some(text.len())
}

/// Length of the string or character literal at the start of `text`; `before` tells a raw string from a name's end.
fn length_of_literal(text: &str, before: &str) -> Option<usize> {
    if let Some(raw) = text.strip_prefix('r').filter(|_| !before.ends_with(|c: char| is_name(c) && c != 'b')) {
        let hashes = raw.len() - raw.trim_start_matches('#').len();
        if raw[hashes..].starts_with('"') {
            let end = format!("\"{}", "#".repeat(hashes));
            let body = 1 + hashes + 1;
            return Some(text[body..].find(&end).map_or(text.len(), |at| body + at + end.len()));
        }
    }
    if text.starts_with('"') {
        return Some(quoted_length(text, '"'));
    }
    // A quote that does not close after one character is a lifetime.
    let mut characters = text.strip_prefix('\'')?.chars();
    let is_character = match characters.next() {
        Some('\\') => true,
        Some(_) => characters.next() == Some('\''),
        None => false,
    };
    is_character.then(|| quoted_length(text, '\''))
}

fn quoted_length(text: &str, quote: char) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            c if c == quote => return at + 1,
            _ => {}
        }
    }
    text.len()
}
