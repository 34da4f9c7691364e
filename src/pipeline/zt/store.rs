//! Where findings lie, so that a killed run loses at most the cell in work.

use std::fs;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::cell::{Cell, Finding, LookFinding, PicturesFinding, RunFinding, ViewerFinding};
use super::{ZtModel, ZtRequest};
use crate::error::{Error, Result};
use crate::io;
use crate::pipeline::MeshConvergence;

/// Directory of the findings in the study's.
const CELLS: &str = "cells";

/// The findings of one model.
pub(super) struct Store<'a> {
    /// The study's directory.
    root: &'a Path,
    /// Where this model's findings lie.
    cells: PathBuf,
    model: &'a ZtModel,
    request: &'a ZtRequest,
    /// SHA-256 of the model's file.
    file_hash: String,
}

/// A finding as it lies in its file.
#[derive(Serialize, Deserialize)]
struct Kept<T> {
    key: String,
    /// SHA-256 of the files that the finding names, in their order: what became of them since is no part of it.
    files: Vec<String>,
    finding: T,
}

impl<'a> Store<'a> {
    /// The findings of `model` under the options of `request`.
    ///
    /// # Errors
    /// [`Error::Read`] if the model's file cannot be read, or not twice.
    pub fn of(model: &'a ZtModel, request: &'a ZtRequest) -> Result<Self> {
        let cells = request.output.join(CELLS).join(&model.name);
        let file_hash = hash_of(&model.path).map_err(|source| Error::Read { path: model.path.clone(), source })?;
        Ok(Self { root: &request.output, cells, model, request, file_hash })
    }

    /// Directory of this model: findings, and measurements for them.
    pub fn cells(&self) -> &Path {
        &self.cells
    }

    /// The same as a name in the study's directory.
    pub fn cells_name(&self) -> String {
        format!("{CELLS}/{}", self.model.name)
    }

    /// Whether an earlier run found it.
    pub fn has(&self, cell: Cell) -> Result<bool> {
        Ok(match cell {
            Cell::Look(_) => self.find::<LookFinding>(cell)?.is_some(),
            Cell::Run(..) => self.find::<RunFinding>(cell)?.is_some(),
            Cell::Pictures(_) => self.find::<PicturesFinding>(cell)?.is_some(),
            Cell::Viewer => self.find::<ViewerFinding>(cell)?.is_some(),
            Cell::Convergence => self.find::<MeshConvergence>(cell)?.is_some(),
        })
    }

    /// What an earlier run found; `None` if it found nothing, by other options, or its files are gone.
    pub fn find<T: Finding>(&self, cell: Cell) -> Result<Option<T>> {
        let path = self.file(cell);
        let text = match fs::read(&path) {
            Ok(text) => text,
            Err(e) if e.kind() == ErrorKind::NotFound => return Ok(None),
            Err(source) => return Err(Error::Read { path, source }),
        };
        // A file that this version cannot read was not written by it: the cell is computed again.
        let Ok(kept) = serde_json::from_slice::<Kept<T>>(&text) else { return Ok(None) };
        let whole = kept.key == self.key(cell) && self.hashes(&kept.finding).is_ok_and(|files| files == kept.files);
        Ok(whole.then_some(kept.finding))
    }

    /// Forgets a finding before its files are written anew: a run that is killed between them leaves none that lies.
    pub fn forget(&self, cell: Cell) -> Result<()> {
        remove(&self.file(cell))
    }

    /// Keeps a finding, when all of its files are written.
    pub fn keep<T: Finding>(&self, cell: Cell, finding: &T) -> Result<()> {
        let path = self.file(cell);
        let files = self.hashes(finding).map_err(|source| Error::Read { path: self.root.to_owned(), source })?;
        let kept = Kept { key: self.key(cell), files, finding };
        let text = serde_json::to_string_pretty(&kept)
            .map_err(|e| Error::Write { path: path.clone(), message: e.to_string() })?;
        io::write_atomic(&path, true, |out| writeln!(out, "{text}"))
    }

    fn hashes(&self, finding: &impl Finding) -> std::io::Result<Vec<String>> {
        finding.files().into_iter().map(|file| hash_of(&self.root.join(file))).collect()
    }

    fn file(&self, cell: Cell) -> PathBuf {
        self.cells.join(format!("{}.json", cell.name()))
    }

    /// SHA-256 of the version, the model's file and every option that changes a finding.
    fn key(&self, cell: Cell) -> String {
        let words = self.request.words(self.model, cell);
        let all = format!("Outsight {}, {words}, {}", env!("CARGO_PKG_VERSION"), self.file_hash);
        hexadecimal(&Sha256::digest(all))
    }
}

/// Models that earlier runs left findings of in the study's directory, and that are not in `request`; by name.
pub(super) fn others(request: &ZtRequest) -> Result<Vec<String>> {
    let cells = request.output.join(CELLS);
    let read = |source| Error::Read { path: cells.clone(), source };
    let mut names = Vec::new();
    for entry in fs::read_dir(&cells).map_err(read)? {
        names.push(entry.map_err(read)?.file_name().to_string_lossy().into_owned());
    }
    names.retain(|name| request.models.iter().all(|model| &model.name != name));
    names.sort_unstable();
    Ok(names)
}

/// Removes a file that an earlier run wrote, if it did.
pub(super) fn remove(path: &Path) -> Result<()> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != ErrorKind::NotFound => {
            Err(Error::Write { path: path.to_owned(), message: e.to_string() })
        }
        _ => Ok(()),
    }
}

/// SHA-256 of a file, which no memory limit is too small for.
fn hash_of(path: &Path) -> std::io::Result<String> {
    // Asked before it is opened: to open a pipe is to wait for who writes into it.
    if !fs::metadata(path)?.is_file() {
        let message = "is no ordinary file; a study reads its models more than once: save it as a file first";
        return Err(std::io::Error::new(ErrorKind::InvalidInput, message));
    }
    let (mut file, mut hash, mut part) = (fs::File::open(path)?, Sha256::new(), vec![0; 1 << 16]);
    loop {
        match file.read(&mut part)? {
            0 => return Ok(hexadecimal(&hash.finalize())),
            read => hash.update(&part[..read]),
        }
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
