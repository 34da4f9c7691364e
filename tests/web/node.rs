//! Runs a script of this folder with node.

use std::path::Path;
use std::process::Command;

/// What `script` prints on standard output for these arguments.
///
/// Panics where node or the packages of `tests/web/package-lock.json` are missing, or the script fails.
pub fn node(script: &str, arguments: &[&Path]) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/web");
    let next = "run `scripts/install-needs --test`";
    assert!(folder.join("node_modules/.package-lock.json").is_file(), "node's packages are not installed; {next}");
    let ended = Command::new("node").arg(folder.join(script)).args(arguments).output();
    let ended = ended.unwrap_or_else(|e| panic!("node does not start: {e}; {next}"));
    assert!(ended.status.success(), "{script}: {}", String::from_utf8_lossy(&ended.stderr));
    String::from_utf8_lossy(&ended.stdout).into_owned()
}
