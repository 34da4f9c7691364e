use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use crate::backend::BackendKind;
use crate::error::{Error, Result};
use crate::io;
use crate::mesh::TriMesh;
use crate::pipeline::Observer;
use crate::visibility::{Hidden, KeptFault, KeptMeasurement, MeasureOptions, MeasurementKey, Subject, Visibility};

/// Ending of a file that keeps one measurement; a cache of any other name is a directory of them.
const ENDING: &str = "seen";

/// The file that keeps the measurement of that key in a cache.
fn file_in(cache: &Path, key: &MeasurementKey) -> PathBuf {
    if cache_is_file(cache) { cache.to_owned() } else { cache.join(format!("{}.{ENDING}", key.name())) }
}

/// Whether a cache is one file, by its name, and not a directory: it ends in `.seen`.
#[must_use]
pub fn cache_is_file(cache: &Path) -> bool {
    cache.extension().is_some_and(|e| e == ENDING)
}

/// A mesh and the occluders around it.
#[derive(Clone, Copy)]
pub(super) struct Surrounded<'a> {
    pub mesh: &'a TriMesh,
    pub occluders: &'a [TriMesh],
}

impl<'a> Surrounded<'a> {
    /// Lays it out.
    pub fn for_backend(self, backend: BackendKind) -> Result<Subject<'a>> {
        Subject::among(self.mesh, self.occluders, backend)
    }
}

/// A look at a mesh that may have been taken by an earlier run.
pub(super) struct Observation<'a> {
    scene: Surrounded<'a>,
    options: &'a MeasureOptions,
    /// Laid out when someone has to look.
    subject: Option<Subject<'a>>,
    kept: Option<Kept>,
}

/// Where the look is kept, and what was found there.
struct Kept {
    file: PathBuf,
    key: MeasurementKey,
    visibility: Option<Visibility>,
    hidden: Option<Vec<bool>>,
    /// Whether all, some or nothing of what was asked for came from the file.
    reused: &'static str,
}

impl<'a> Observation<'a> {
    /// Finds what `cache` keeps of the look, and gets ready to look where it keeps nothing.
    pub fn of(
        scene: Surrounded<'a>,
        options: &'a MeasureOptions,
        cache: Option<&Path>,
        observer: &dyn Observer,
    ) -> Result<Self> {
        let key = || MeasurementKey::of(scene.mesh, scene.occluders, options);
        let kept = cache.map(|cache| Kept::find(cache, key(), observer)).transpose()?;
        let mut observation = Self { scene, options, subject: None, kept };
        if observation.kept.as_ref().is_none_or(|kept| kept.visibility.is_none()) {
            observation.subject()?;
        }
        Ok(observation)
    }

    /// The mesh, laid out for the backend.
    pub fn subject(&mut self) -> Result<&Subject<'a>> {
        let subject = match self.subject.take() {
            Some(subject) => subject,
            None => self.scene.for_backend(self.options.backend)?,
        };
        Ok(self.subject.insert(subject))
    }

    pub fn visibility(&mut self, observer: &dyn Observer) -> Result<Visibility> {
        let options = self.options;
        let seen = match self.kept.as_mut().and_then(|kept| kept.visibility.take()) {
            Some(found) => found,
            None => self.subject()?.measure(options, observer)?,
        };
        observer.measured(options, &seen)?;
        Ok(seen)
    }

    /// The marks of [`Hidden::marks`].
    pub fn hidden(&mut self, rule: Hidden, seen: &Visibility, observer: &dyn Observer) -> Result<Vec<bool>> {
        if rule != Hidden::Delete {
            return Ok(vec![false; self.scene.mesh.triangle_count()]);
        }
        if let Some(found) = self.kept.as_mut().and_then(|kept| kept.hidden.take()) {
            return Ok(found);
        }
        if let Some(kept) = self.kept.as_mut().filter(|kept| kept.reused == "hit") {
            kept.reused = "partial";
        }
        let options = self.options;
        rule.marks(self.subject()?, seen, options, observer)
    }

    /// Keeps what was seen for later runs, and the marks of [`Hidden::Delete`]; not if all of it was kept already.
    pub fn keep(&self, visibility: &Visibility, hidden: Option<&[bool]>) -> Result<()> {
        let Some(kept) = self.kept.as_ref().filter(|kept| kept.reused != "hit") else { return Ok(()) };
        let measurement = KeptMeasurement { visibility: visibility.clone(), hidden: hidden.map(<[bool]>::to_vec) };
        let bytes = measurement.to_bytes(&kept.key);
        io::write_atomic_in_directory(&kept.file, true, |output| output.write_all(&bytes))
    }

    /// `hit`, `partial` or `miss`; `None` without a cache.
    pub fn reused(&self) -> Option<&'static str> {
        self.kept.as_ref().map(|kept| kept.reused)
    }
}

impl Kept {
    fn find(cache: &Path, key: MeasurementKey, observer: &dyn Observer) -> Result<Self> {
        let file = file_in(cache, &key);
        // A directory that is not there is made when there is something to keep.
        if cache_is_file(cache) || cache.is_dir() {
            io::check_target(&file, true)?;
        }
        let found = match read(&file, &key)? {
            Ok(found) => found,
            Err(fault) if cache_is_file(cache) => return Err(unusable(&file, fault)),
            // In a directory the name says what a file should hold, so that it can be replaced.
            Err(fault) => {
                observer.kept_look_unusable(&file, fault)?;
                None
            }
        };
        let (visibility, hidden) = found.map_or((None, None), |found| (Some(found.visibility), found.hidden));
        let reused = if visibility.is_some() { "hit" } else { "miss" };
        Ok(Self { file, key, visibility, hidden, reused })
    }
}

fn unusable(path: &Path, fault: KeptFault) -> Error {
    let next = if fault == KeptFault::Damaged { "delete it" } else { "give --cache another name, or delete it" };
    Error::Parse { place: path.display().to_string(), message: format!("{fault}; {next}") }
}

/// What a file keeps; `None` where there is no file.
fn read(path: &Path, key: &MeasurementKey) -> Result<std::result::Result<Option<KeptMeasurement>, KeptFault>> {
    let failed = |source| Error::Read { path: path.to_owned(), source };
    let mut file = match File::open(path) {
        Ok(file) => file,
        Err(e) if e.kind() == ErrorKind::NotFound => return Ok(Ok(None)),
        Err(e) => return Err(failed(e)),
    };
    let mut bytes = Vec::new();
    // Whatever else the file is, it need not be read to its end.
    file.by_ref().take(KeptMeasurement::HEAD as u64).read_to_end(&mut bytes).map_err(failed)?;
    if let Err(fault) = KeptMeasurement::check_head(&bytes, key) {
        return Ok(Err(fault));
    }
    file.read_to_end(&mut bytes).map_err(failed)?;
    Ok(KeptMeasurement::from_bytes(&bytes, key).map(Some))
}
