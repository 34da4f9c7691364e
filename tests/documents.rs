//! The documents' links lead somewhere.

#![allow(clippy::unwrap_used)]

use std::path::Path;

/// Targets of Markdown links `](target)` that are files of this repository.
fn local_links(text: &str) -> Vec<&str> {
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    targets.filter(|target| !target.contains("://") && !target.starts_with('#')).collect()
}

#[test]
fn every_link_to_a_file_finds_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let documents = [
        "README.md",
        "ARCHITECTURE.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "docs/json.md",
        "data/README.md",
        "docs/reproduction.md",
        "docs/results/rivals.md",
    ];
    let mut checked = 0;
    for document in documents {
        let text = std::fs::read_to_string(root.join(document)).unwrap();
        let folder = Path::new(document).parent().unwrap();
        for link in local_links(&text) {
            assert!(root.join(folder).join(link).exists(), "{document} links to {link}, which is not there");
            checked += 1;
        }
    }
    assert!(checked >= 4, "only {checked} links found: the search is broken");
}
