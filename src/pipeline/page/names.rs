use std::ffi::OsStr;
use std::path::{Component, Path};

/// The names of files without the folders before them, which are nobody else's business; of these only as many as tell
/// files of one name apart.
#[must_use]
pub fn shown_names(paths: &[&Path]) -> Vec<String> {
    let all: Vec<Vec<&OsStr>> = paths.iter().map(|path| parts(path)).collect();
    let name = |own: &Vec<&OsStr>| {
        let is_unique = |n: &usize| all.iter().all(|other| other == own || ending(other, *n) != ending(own, *n));
        let shown = (1..own.len()).find(is_unique).unwrap_or(own.len());
        let words: Vec<_> = ending(own, shown).iter().map(|part| part.to_string_lossy()).collect();
        if words == ["-"] { "standard input or output".to_owned() } else { words.join("/") }
    };
    all.iter().map(name).collect()
}

/// The name of a file without the folders before it.
pub(in crate::pipeline) fn shown_name(path: &Path) -> String {
    shown_names(&[path]).concat()
}

/// Folders as they were given, without the root, and the file.
fn parts(path: &Path) -> Vec<&OsStr> {
    let part = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::ParentDir);
    path.components().filter(|c| part(*c)).map(Component::as_os_str).collect()
}

fn ending<'a, 'b>(parts: &'a [&'b OsStr], count: usize) -> &'a [&'b OsStr] {
    &parts[parts.len().saturating_sub(count)..]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names<const N: usize>(paths: [&str; N]) -> Vec<String> {
        shown_names(&paths.map(Path::new))
    }

    #[test]
    fn folders_appear_only_where_names_repeat() {
        assert_eq!(names(["/home/me/a.ply", "work/b.ply"]), ["a.ply", "b.ply"]);
        assert_eq!(names(["/home/me/qb/x.ply", "vg/x.ply", "/home/you/y.ply"]), ["qb/x.ply", "vg/x.ply", "y.ply"]);
        assert_eq!(
            names(["x.ply", "./vg/x.ply", "qb/1/x.ply", "vg/1/x.ply"]),
            ["x.ply", "vg/x.ply", "qb/1/x.ply", "vg/1/x.ply"]
        );
    }

    #[test]
    fn one_file_given_twice_has_one_name() {
        assert_eq!(names(["/a/x.ply", "/a/x.ply", "-"]), ["x.ply", "x.ply", "standard input or output"]);
        assert_eq!(names(["a/x.ply", "../a/x.ply"]), ["a/x.ply", "../a/x.ply"]);
    }
}
