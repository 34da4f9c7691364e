use std::path::{Path, PathBuf};

use glam::DVec3;

use crate::camera::CameraSphere;
use crate::error::{Error, Result};
use crate::io::{self, Diagram, Loaded};
use crate::mesh::TriangleId;
use crate::pipeline::Observer;
use crate::report::diagram::diagram_picture;
use crate::visibility::{
    DiagramRecorder, Estimator, MeasureOptions, Subject, Visibility, VisibilityDiagram, visible_fractions,
};

/// A visibility diagram to write beside a measurement.
#[derive(Debug, Clone)]
pub struct DiagramRequest {
    /// `.vdg`, `.npy` or a picture, `.png`.
    pub output: PathBuf,
    /// The visible share of each triangle's image too, not only whether it is seen; not in a picture.
    pub fractions: bool,
}

impl DiagramRequest {
    /// Checks what can be checked before the mesh is read.
    pub(super) fn check(&self, options: &MeasureOptions) -> Result<()> {
        let refused = |name, message: &str| Err(Error::Option { name, message: message.to_owned() });
        if options.estimator == Estimator::Hemisphere {
            return refused(
                "--diagram",
                "hemisphere looks in random directions, not from cameras; take another --estimator",
            );
        }
        if self.fractions && options.estimator != Estimator::Coverage {
            return refused("--diagram-fractions", "fractions are counted in pixels; use --estimator coverage");
        }
        if self.fractions && extension(&self.output) == "png" {
            return refused("--diagram-fractions", "a picture shows only who sees what; write .vdg or .npy");
        }
        Ok(())
    }
}

/// Who saw what in a measurement.
pub(super) struct Record {
    cameras: CameraSphere,
    diagram: VisibilityDiagram,
    fractions: Option<Vec<u8>>,
}

impl Record {
    /// Looks, and writes down which camera sees which triangle.
    pub fn look(
        subject: &Subject<'_>,
        options: &MeasureOptions,
        fractions: bool,
        observer: &dyn Observer,
    ) -> Result<(Visibility, Self)> {
        let cameras = options.camera_sphere()?;
        let recorder = DiagramRecorder::new(subject.mesh().triangle_count(), cameras.count(), options.memory_limit)?;
        let visibility = subject.measure_from(&cameras, options, Some(&recorder), observer)?;
        let fractions = fractions.then(|| visible_fractions(subject, &cameras, options, observer)).transpose()?;
        Ok((visibility, Self { cameras, diagram: recorder.finish(), fractions }))
    }

    /// Writes the diagram in the order of the file's triangles; nobody sees those that were set aside.
    pub fn write(self, loaded: &Loaded, subject: &Subject<'_>, path: &Path, force: bool) -> Result<()> {
        let order = loaded.file_order();
        let count = self.cameras.count();
        let diagram = Diagram {
            cameras: self.table(),
            triangles: order.len(),
            words: rows_in_order(self.diagram.into_words(), count.div_ceil(64), &order),
            fractions: self.fractions.map(|bytes| rows_in_order(bytes, count, &order)),
        };
        match extension(path).as_str() {
            "png" => {
                let normal =
                    |id: TriangleId| subject.frame().area_and_normal(&loaded.mesh, id).map(|(_, normal)| normal);
                let normals: Vec<DVec3> = order.iter().map(|id| id.and_then(normal).unwrap_or(DVec3::ZERO)).collect();
                let picture = diagram_picture(&diagram, &normals);
                io::write_atomic(path, force, |writer| picture.write_png(writer))
            }
            "npy" => io::write_diagram_npy(path, &diagram, force),
            _ => io::write_vdg(path, &diagram, force),
        }
    }

    /// Direction and solid angle of each camera.
    fn table(&self) -> Vec<[f32; 4]> {
        let unit = 4.0 * std::f64::consts::PI / self.cameras.total_weight() as f64;
        let entry =
            |(camera, d): (u32, &DVec3)| d.extend(unit * self.cameras.weight(camera) as f64).as_vec4().to_array();
        (0..).zip(self.cameras.directions()).map(entry).collect()
    }
}

/// Rows of the mesh's triangles as rows of the file's; `width` is the length of a row.
fn rows_in_order<T: Copy + Default>(rows: Vec<T>, width: usize, order: &[Option<TriangleId>]) -> Vec<T> {
    if order.iter().all(Option::is_some) {
        return rows;
    }
    let empty = vec![T::default(); width];
    let row = |id: &Option<TriangleId>| id.map_or(&empty[..], |id| &rows[id.0 as usize * width..][..width]);
    order.iter().map(row).collect::<Vec<_>>().concat()
}

fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}
