use std::sync::atomic::{AtomicU8, Ordering};

use crate::backend::{Workload, draw_all};
use crate::camera::{CameraSphere, View, Window};
use crate::error::{Error, Result};
use crate::progress::Progress;
use crate::raster::Hit;
use crate::visibility::coverage::for_each_run;
use crate::visibility::{MeasureOptions, Shapes, Subject};

/// The share of each triangle's image that each camera sees, 255 for all of it: one row per triangle, one byte per camera.
///
/// The image of a triangle of area A, seen at the cosine |d·n|, covers A |d·n| / s² pixels of edge s; c of them show it, from
/// the side that faces the camera. Shares above 1, which tiny triangles reach, count as 1; none that is seen gets less
/// than 1/255. A look of its own: one camera's counts are added up before they become a share.
///
/// # Errors
/// [`Error::Limit`] if the bytes do not fit the memory limit; else as [`draw_all`].
pub fn visible_fractions(
    subject: &Subject<'_>,
    cameras: &CameraSphere,
    options: &MeasureOptions,
    progress: &dyn Progress,
) -> Result<Vec<u8>> {
    let shapes = Shapes::of(subject.mesh(), subject.frame());
    let (triangles, count) = (shapes.areas.len(), cameras.count());
    let bytes = empty_bytes(triangles, count, options.memory_limit)?;
    let window = Window::around_sphere(options.resolution_for(triangles));
    let load = Workload { window, memory_limit: options.memory_limit, phase: "visibility", progress };
    let views: Vec<View> = cameras.axes().iter().map(|axis| View::along(axis, window)).collect();
    let column = |pixels: &mut dyn Iterator<Item = Option<Hit>>, camera: u32| {
        let toward = cameras.directions()[camera as usize];
        let mut counts = vec![0_u32; triangles];
        // Occluders have the numbers behind those of the mesh.
        let mut add = |hit: Hit, pixels: u64| {
            if let Some(count) = counts.get_mut(hit.triangle.0 as usize) {
                *count += pixels as u32;
            }
        };
        for_each_run(pixels, &mut add);
        for (t, &seen) in counts.iter().enumerate().filter(|(_, seen)| **seen > 0) {
            let whole = shapes.areas[t] * toward.dot(shapes.normal(t)).abs() / window.pixel_size().powi(2);
            let byte = (255.0 * f64::from(seen) / whole).round().clamp(1.0, 255.0);
            bytes[t * count + camera as usize].store(byte as u8, Ordering::Relaxed);
        }
    };
    draw_all(subject.machine(), &views, load, |number, buffers| {
        let axis = &cameras.axes()[number];
        axis.near.into_iter().for_each(|camera| column(&mut buffers.near(), camera));
        axis.far.into_iter().for_each(|camera| column(&mut buffers.far(), camera));
        Ok(())
    })?;
    Ok(bytes.into_iter().map(AtomicU8::into_inner).collect())
}

fn empty_bytes(triangles: usize, cameras: usize, memory_limit: Option<u64>) -> Result<Vec<AtomicU8>> {
    let wanted = triangles as u64 * cameras as u64;
    let refused = || Error::Limit {
        message: format!(
            "the visible fractions of {triangles} triangles and {cameras} cameras take {} MiB; raise --memory-limit, \
             take fewer cameras, or leave out --diagram-fractions",
            wanted.div_ceil(1 << 20)
        ),
    };
    if memory_limit.is_some_and(|limit| wanted > limit) {
        return Err(refused());
    }
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(triangles * cameras).map_err(|_| refused())?;
    bytes.resize_with(triangles * cameras, AtomicU8::default);
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::backend::BackendKind;
    use crate::camera::Cameras;
    use crate::mesh::shapes;
    use crate::progress::Silent;
    use crate::visibility::{DiagramRecorder, Visibility};

    fn options() -> MeasureOptions {
        let sides = crate::visibility::Sides::One;
        MeasureOptions { cameras: Cameras::octahedral(66), resolution: Some(256), sides, ..MeasureOptions::default() }
    }

    /// A byte is rounded by at most half a step of 1/255.
    const HALF_STEP: f64 = 0.5 / 255.0;

    #[test]
    fn fractions_weighted_by_cosine_are_the_visibility() {
        // Two squares that face each other: large triangles, each hidden in part from most cameras.
        let mesh = shapes::parallel_squares(0.7, 1).mesh;
        let subject = Subject::new(&mesh, BackendKind::Raster).unwrap();
        let options = options();
        let cameras = options.camera_sphere().unwrap();
        let recorder = DiagramRecorder::new(mesh.triangle_count(), 66, None).unwrap();
        let visibility: Visibility = subject.measure_from(&cameras, &options, Some(&recorder), &Silent).unwrap();
        let (diagram, bytes) = (recorder.finish(), visible_fractions(&subject, &cameras, &options, &Silent).unwrap());
        let shapes = Shapes::of(&mesh, subject.frame());
        for t in 0..mesh.triangle_count() {
            let row = &bytes[66 * t..][..66];
            let id = crate::mesh::TriangleId(t as u32);
            assert!((0..66).all(|v| diagram.sees(id, v) == (row[v] > 0)), "a share where there is a bit");
            let in_front =
                |v: usize| (cameras.directions()[v].dot(shapes.normal(t))).max(0.0) * cameras.weight(v as u32) as f64;
            let sum: f64 = (0..66).map(|v| f64::from(row[v]) / 255.0 * in_front(v)).sum();
            let found = sum / cameras.cosine_sum(shapes.normal(t));
            // Shares a little above 1, where a pixel centre too many fell on the triangle, are cut: below 1 % at 256 pixels.
            assert!((found - visibility.front()[t]).abs() < HALF_STEP + 0.01, "{found} {}", visibility.front()[t]);
        }
        assert!(bytes.iter().any(|&b| (20..235).contains(&b)), "some are hidden in part");
    }

    #[test]
    fn too_many_bytes_are_refused_before_they_are_asked_for() {
        let mesh = shapes::tetrahedron();
        let subject = Subject::new(&mesh, BackendKind::Raster).unwrap();
        let limited = MeasureOptions { memory_limit: Some(100), ..options() };
        let cameras = limited.camera_sphere().unwrap();
        let error = visible_fractions(&subject, &cameras, &limited, &Silent).unwrap_err();
        assert!(matches!(error, Error::Limit { .. }) && error.to_string().contains("--diagram-fractions"), "{error}");
    }
}
