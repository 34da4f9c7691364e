use std::path::{Path, PathBuf};

use crate::camera::{Frame, Occluders};
use crate::error::Result;
use crate::io::{self, ReadOptions};
use crate::mesh::TriMesh;
use crate::pipeline::observation::Surrounded;

/// The occluders of a run, as read.
pub(super) struct Surroundings {
    files: Vec<PathBuf>,
    meshes: Vec<TriMesh>,
    /// For each triangle of each mesh its number in the file.
    in_file: Vec<Vec<usize>>,
}

impl Surroundings {
    pub fn read(files: &[PathBuf], options: &ReadOptions) -> Result<Self> {
        // The format is told for the mesh alone.
        let options = ReadOptions { format: None, ..options.clone() };
        let mut read = Self { files: files.to_vec(), meshes: Vec::new(), in_file: Vec::new() };
        for file in files {
            let loaded = io::read(file, &options)?;
            read.in_file.push(loaded.numbers_in_file());
            read.meshes.push(loaded.mesh);
        }
        Ok(read)
    }

    /// Puts them around a mesh.
    ///
    /// # Errors
    /// As [`Occluders::check`], naming the file.
    pub fn around<'a>(&'a self, mesh: &'a TriMesh) -> Result<Surrounded<'a>> {
        let frame = Frame::of(mesh);
        for (file, occluder) in self.files.iter().zip(&self.meshes) {
            Occluders::check(frame, occluder, &file.display().to_string())?;
        }
        Ok(Surrounded { mesh, occluders: &self.meshes })
    }

    pub fn triangle_count(&self) -> usize {
        self.meshes.iter().map(TriMesh::triangle_count).sum()
    }

    /// File and number in it of a triangle, which is counted through all occluders.
    pub fn find(&self, mut number: usize) -> Option<(&Path, usize)> {
        for (file, in_file) in self.files.iter().zip(&self.in_file) {
            match in_file.get(number) {
                Some(&number) => return Some((file, number)),
                None => number -= in_file.len(),
            }
        }
        None
    }
}
