//! Whole files or none: outputs are written beside their target and renamed.

use std::fs::{self, File, Metadata};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// Whether [`write_atomic`] would go ahead, to be asked before long work: the target is no directory, its folder is
/// there, and it does not exist unless `force`.
///
/// # Errors
/// [`Error::Write`].
pub fn check_target(path: &Path, force: bool) -> Result<()> {
    Target::of(path, force).map(drop)
}

/// Writes a file so that it is there whole or not at all: into a temporary file beside it, flushed to the disk, then
/// renamed.
///
/// An existing file is replaced only with `force` and keeps its permissions; a new one has those of the process's
/// mask. A link is followed. `-` is standard output; it and a target that is no regular file (`/dev/null`, a named pipe)
/// are written directly.
///
/// # Errors
/// [`Error::Write`]; [`Error::ClosedPipe`] if whoever read standard output went away.
pub fn write_atomic(path: &Path, force: bool, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    match Target::of(path, force)? {
        Target::Stdout => write_through(io::stdout().lock(), write).map_err(|e| match e.kind() {
            ErrorKind::BrokenPipe => Error::ClosedPipe,
            _ => failed(path, &e),
        }),
        Target::Device => {
            let file = File::options().write(true).open(path).map_err(|e| failed(path, &e))?;
            write_through(file, write).map_err(|e| failed(path, &e))
        }
        Target::File { path: real, existing } => write_renamed(path, &real, existing.as_ref(), force, write),
    }
}

/// Does the same in a directory that is made where there is none, and that goes again if the file is not written.
///
/// # Errors
/// As [`write_atomic`].
pub fn write_atomic_in_directory(
    path: &Path,
    force: bool,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<()> {
    let folder = folder_of(path);
    let made: Vec<&Path> = folder.ancestors().take_while(|f| !f.as_os_str().is_empty() && !f.exists()).collect();
    fs::create_dir_all(folder).map_err(|e| refused(folder, &format!("cannot be made a directory: {e}")))?;
    // From the inside out; what holds something by now stays.
    write_atomic(path, force, write).inspect_err(|_| made.into_iter().for_each(|folder| drop(fs::remove_dir(folder))))
}

/// What a path stands for.
enum Target {
    Stdout,
    /// Something that is neither a file nor a directory.
    Device,
    /// A file, links followed, and what is known of it if it exists.
    File {
        path: PathBuf,
        existing: Option<Metadata>,
    },
}

impl Target {
    fn of(path: &Path, force: bool) -> Result<Self> {
        if path.as_os_str() == "-" {
            return Ok(Self::Stdout);
        }
        match fs::metadata(path) {
            Ok(about) if about.is_dir() => Err(refused(path, "is a directory; give the name of a file in it")),
            Ok(about) if !about.is_file() => Ok(Self::Device),
            Ok(_) if !force => Err(exists(path)),
            Ok(about) => {
                let real = fs::canonicalize(path).map_err(|e| failed(path, &e))?;
                Ok(Self::File { path: real, existing: Some(about) })
            }
            Err(e) if e.kind() == ErrorKind::NotFound && fs::symlink_metadata(path).is_ok() && !force => {
                Err(exists(path))
            }
            Err(e) if e.kind() == ErrorKind::NotFound => new_file(path),
            Err(e) => Err(failed(path, &e)),
        }
    }
}

fn new_file(path: &Path) -> Result<Target> {
    if path.file_name().is_none() {
        return Err(refused(path, "names no file"));
    }
    let folder = folder_of(path);
    if !folder.is_dir() {
        return Err(refused(path, &format!("there is no directory {}; create it first", folder.display())));
    }
    Ok(Target::File { path: path.to_owned(), existing: None })
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn write_through(output: impl Write, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut output = BufWriter::with_capacity(1 << 17, output);
    write(&mut output)?;
    output.flush()
}

fn write_renamed(
    path: &Path,
    real: &Path,
    existing: Option<&Metadata>,
    force: bool,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<()> {
    let failed = |e: &io::Error| failed(path, e);
    let mut draft = temporary_beside(real).map_err(|e| failed(&e))?;
    if let Some(about) = existing {
        draft.as_file().set_permissions(about.permissions()).map_err(|e| failed(&e))?;
    }
    write_through(draft.as_file_mut(), write).map_err(|e| failed(&e))?;
    draft.as_file().sync_all().map_err(|e| failed(&e))?;
    if force {
        draft.persist(real).map(drop).map_err(|e| failed(&e.error))
    } else {
        // Another program may have made the file in the meantime.
        draft.persist_noclobber(real).map(drop).map_err(|e| match e.error.kind() {
            ErrorKind::AlreadyExists => exists(path),
            _ => failed(&e.error),
        })
    }
}

fn temporary_beside(path: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".outsight-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Asked for on creation, so that the process's mask takes its share.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder_of(path))
}

fn exists(path: &Path) -> Error {
    refused(path, "exists already; use --force to replace it")
}

fn refused(path: &Path, message: &str) -> Error {
    Error::Write { path: path.to_owned(), message: message.to_owned() }
}

fn failed(path: &Path, error: &io::Error) -> Error {
    // `tempfile` adds the temporary name to the message, which would only confuse.
    let system = error.raw_os_error().map(io::Error::from_raw_os_error);
    let inner = error.get_ref().and_then(|e| e.source()).map(ToString::to_string);
    let reason = system.map(|e| e.to_string()).or(inner).unwrap_or_else(|| error.to_string());
    refused(path, &format!("cannot be written: {reason}"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn write(path: &Path, force: bool, bytes: &[u8]) -> Result<()> {
        write_atomic(path, force, |w| w.write_all(bytes))
    }

    fn names(folder: &Path) -> Vec<String> {
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn existing_file_is_replaced_only_by_force() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bin");
        write(&path, false, b"one").unwrap();
        let error = write(&path, false, b"two").unwrap_err();
        assert!(error.to_string().ends_with("a.bin: exists already; use --force to replace it"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"one");
        write(&path, true, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(names(folder.path()), ["a.bin"]);
    }

    #[test]
    fn failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bin");
        write(&path, false, b"old").unwrap();
        let error = write_atomic(&path, true, |w| {
            w.write_all(&[0; 1 << 20])?;
            Err(io::Error::other("the sky fell"))
        });
        assert!(error.unwrap_err().to_string().ends_with("cannot be written: the sky fell"));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["a.bin"]);
    }

    #[test]
    fn directory_and_missing_directory_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let error = write(folder.path(), true, b"").unwrap_err().to_string();
        assert!(error.ends_with("is a directory; give the name of a file in it"), "{error}");
        let error = write(&folder.path().join("no/a.bin"), true, b"").unwrap_err().to_string();
        assert!(error.contains("there is no directory") && error.ends_with("create it first"), "{error}");
        assert!(check_target(&folder.path().join("new.bin"), false).is_ok());
    }

    #[test]
    fn directory_comes_with_its_first_file_and_not_without() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("a/b/c.bin");
        let failing = |w: &mut dyn Write| w.write_all(b"x").and(Err(io::Error::other("the sky fell")));
        assert!(write_atomic_in_directory(&path, false, failing).is_err());
        assert!(names(home.path()).is_empty());
        write_atomic_in_directory(&path, false, |w| w.write_all(b"x")).unwrap();
        assert_eq!(names(&home.path().join("a/b")), ["c.bin"]);
        assert!(write_atomic_in_directory(&path, false, |w| w.write_all(b"y")).is_err());
        assert_eq!(fs::read(&path).unwrap(), b"x");
    }

    #[cfg(unix)]
    #[test]
    fn permissions_are_those_of_the_mask_or_of_the_file_before() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (ours, plain) = (folder.path().join("ours"), folder.path().join("plain"));
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        write(&ours, false, b"").unwrap();
        fs::write(&plain, b"").unwrap();
        assert_eq!(mode(&ours), mode(&plain));
        fs::set_permissions(&ours, fs::Permissions::from_mode(0o640)).unwrap();
        write(&ours, true, b"again").unwrap();
        assert_eq!(mode(&ours), 0o640);
    }

    #[cfg(unix)]
    #[test]
    fn link_is_followed_and_device_is_written_directly() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, b"old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write(&link, true, b"new").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        write(Path::new("/dev/null"), false, b"gone").unwrap();
    }
}
