use crate::backend::{BackendKind, Machine};
use crate::camera::{CameraSphere, Frame};
use crate::error::{Error, MeshError, Result};
use crate::mesh::TriMesh;
use crate::progress::Progress;
use crate::visibility::estimate::{Looking, estimate};
use crate::visibility::{DiagramRecorder, MeasureOptions, Visibility};

/// A mesh in its frame, laid out for the machine that looks at it.
#[derive(Debug)]
pub struct Subject<'a> {
    mesh: &'a TriMesh,
    occluders: &'a [TriMesh],
    frame: Frame,
    machine: Machine,
}

impl<'a> Subject<'a> {
    /// Lays out `mesh` in its own [`Frame`].
    ///
    /// # Errors
    /// [`Error::Unavailable`] for a backend that is not there.
    pub fn new(mesh: &'a TriMesh, backend: BackendKind) -> Result<Self> {
        Self::among(mesh, &[], backend)
    }

    /// Lays out `mesh` in its own [`Frame`] among occluders in the same coordinates: a floor, an enclosure.
    ///
    /// They hide and are not measured. Surface that lies on an occluder is hidden by it.
    ///
    /// # Errors
    /// As [`Subject::new`]; [`Error::Limit`] if there are more triangles than can be numbered.
    pub fn among(mesh: &'a TriMesh, occluders: &'a [TriMesh], backend: BackendKind) -> Result<Self> {
        let frame = Frame::of(mesh);
        let unit = frame.among(frame.unit_copy(mesh), mesh.triangle_count(), occluders)?;
        Ok(Self { mesh, occluders, frame, machine: Machine::new(backend, unit)? })
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &'a TriMesh {
        self.mesh
    }

    /// What stands around it. Their triangles have the numbers behind those of the mesh, one occluder after the other.
    #[must_use]
    pub fn occluders(&self) -> &'a [TriMesh] {
        self.occluders
    }

    /// Its frame.
    #[must_use]
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Who looks.
    #[must_use]
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// Looks from the cameras that `options` name.
    ///
    /// # Errors
    /// As [`super::measure`].
    pub fn measure(&self, options: &MeasureOptions, progress: &dyn Progress) -> Result<Visibility> {
        options.check()?;
        self.measure_from(&options.camera_sphere()?, options, None, progress)
    }

    /// Looks from `cameras`, whatever `options` say about cameras, and writes down in `diagram` who sees what.
    ///
    /// # Errors
    /// As [`super::measure`].
    pub fn measure_from(
        &self,
        cameras: &CameraSphere,
        options: &MeasureOptions,
        diagram: Option<&DiagramRecorder>,
        progress: &dyn Progress,
    ) -> Result<Visibility> {
        options.check()?;
        estimate(self, &Looking { cameras, options, diagram, progress })
    }

    pub(super) fn nothing_to_see(&self) -> Error {
        let source = MeshError::NothingToSee { triangles: self.mesh.triangle_count() };
        Error::Mesh { place: "looking".to_owned(), source }
    }
}
