use std::borrow::Cow;

use crate::camera::Frame;
use crate::error::Result;
use crate::io::Glb;
use crate::mesh::TriMesh;
use crate::pipeline::page::{Exhibit, MAP};
use crate::progress::Progress;
use crate::report::page::{Model, PackedModel};
use crate::report::table::thousands;
use crate::simplify::{SimplifyOptions, Target, simplify};

/// Most triangles of a model on a page: phones turn as many without a stutter.
const MOST_TRIANGLES: usize = 150_000;

/// Steps along the radius of the frame that positions are rounded to: half of a hundredth of a pixel in a view of a
/// thousand, and a third of the bytes.
const STEPS: f64 = 65536.0;

/// Safety in the guess of how many triangles fit: fewer triangles share fewer vertices.
const CAUTION: f64 = 0.9;

/// All models of a viewer in the frame of the first, the original, within `bytes` of the page together.
pub(in crate::pipeline) fn models(
    exhibits: &[&Exhibit<'_>],
    bytes: usize,
    progress: &dyn Progress,
) -> Result<Vec<Model>> {
    let Some(original) = exhibits.first() else { return Ok(Vec::new()) };
    let frame = Frame::of(original.mesh);
    // Results first: they are what is judged, and what they leave is the original's.
    let mut left = bytes;
    let mut shown = Vec::new();
    for (before, exhibit) in exhibits.iter().enumerate().rev() {
        let next = model(exhibit, &frame, left / (before + 1), progress)?;
        left = left.saturating_sub(next.model.bytes());
        shown.push(next);
    }
    shown.reverse();
    Ok(shown)
}

/// The model of an exhibit, or the largest level of detail that fits into `share` bytes of the page.
fn model(exhibit: &Exhibit<'_>, frame: &Frame, share: usize, progress: &dyn Progress) -> Result<Model> {
    let given = exhibit.mesh.triangle_count();
    let mut mesh = Cow::Borrowed(exhibit.mesh);
    let mut colours: Vec<[u8; 3]> = exhibit.visibility.per_triangle().iter().map(|&v| MAP.colour(v)).collect();
    let mut target = MOST_TRIANGLES;
    loop {
        if mesh.triangle_count() > target {
            let (smaller, kept) = level_of_detail(&mesh, &colours, target, progress)?;
            (mesh, colours) = (Cow::Owned(smaller), kept);
        }
        let shown = mesh.triangle_count();
        let model = packed(&mesh, &colours, frame)?;
        // What no collapse makes smaller is left to the limit of the whole page.
        if model.bytes() <= share || shown > target || target == 1 {
            return Ok(Model { name: exhibit.name.clone(), caption: caption(given, shown), model });
        }
        target = (CAUTION * shown as f64 * share as f64 / model.bytes() as f64).max(1.0) as usize;
    }
}

fn caption(given: usize, shown: usize) -> String {
    let all = thousands(given as u64);
    if shown == given {
        return format!("{all} triangles");
    }
    format!("{all} triangles, shown as a level of detail with {}", thousands(shown as u64))
}

/// A smaller mesh by shape alone. Each triangle has the colour of the one that it was.
fn level_of_detail(
    mesh: &TriMesh,
    colours: &[[u8; 3]],
    target: usize,
    progress: &dyn Progress,
) -> Result<(TriMesh, Vec<[u8; 3]>)> {
    let options = SimplifyOptions::default().with_targets(vec![Target::Triangles(target)]);
    let level = simplify(mesh, None, &options, progress)?.swap_remove(0);
    let mut kept = vec![[0; 3]; level.mesh.triangle_count()];
    for (&colour, number) in colours.iter().zip(&level.triangle_map) {
        if let Some(number) = number {
            kept[*number as usize] = colour;
        }
    }
    Ok((level.mesh, kept))
}

fn packed(mesh: &TriMesh, colours: &[[u8; 3]], frame: &Frame) -> Result<PackedModel> {
    let place = |&p: &glam::DVec3| (frame.to_unit(p) * STEPS).round() / STEPS;
    let positions = mesh.positions().iter().map(place).collect();
    let unit = TriMesh::new(positions, mesh.triangles().to_vec())
        .map_err(|source| crate::error::Error::Mesh { place: "a model for the page".to_owned(), source })?;
    PackedModel::of(&Glb::of(&unit, Some(colours))?)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::mesh::shapes;
    use crate::pipeline::observation::Surrounded;
    use crate::progress::Silent;
    use crate::visibility::MeasureOptions;

    #[test]
    fn results_are_whole_and_the_original_has_what_they_leave() {
        let [fine, coarse] = [4, 2].map(|cuts| shapes::nested_spheres(0.5, cuts).mesh);
        let options = MeasureOptions { resolution: Some(64), ..MeasureOptions::default() };
        let look =
            |mesh| Exhibit::look("s.ply".to_owned(), Surrounded { mesh, occluders: &[] }, &options, &Silent).unwrap();
        let exhibits = [look(&fine), look(&coarse)];
        let sizes: Vec<usize> =
            exhibits.iter().map(|e| models(&[e], usize::MAX, &Silent).unwrap()[0].model.bytes()).collect();
        // Half of it each would be too little for the original.
        let enough = sizes[0] + sizes[1];
        let shown = models(&[&exhibits[0], &exhibits[1]], enough, &Silent).unwrap();
        assert!(sizes[0] > enough / 2);
        assert!(shown.iter().all(|model| !model.caption.contains("level of detail")), "{}", shown[0].caption);
        let shown = models(&[&exhibits[0], &exhibits[1]], enough - 1, &Silent).unwrap();
        assert!(shown[0].caption.contains("level of detail") && !shown[1].caption.contains("level of detail"));
    }

    #[test]
    fn a_model_too_large_for_its_share_becomes_a_level_of_detail() {
        let mesh = shapes::nested_spheres(0.5, 4).mesh;
        let options = MeasureOptions { resolution: Some(64), ..MeasureOptions::default() };
        let alone = Surrounded { mesh: &mesh, occluders: &[] };
        let exhibit = Exhibit::look("s.ply".to_owned(), alone, &options, &Silent).unwrap();
        let frame = Frame::of(&mesh);
        let shown = |share| model(&exhibit, &frame, share, &Silent).unwrap();
        let whole = shown(usize::MAX);
        assert_eq!(whole.caption, "10,240 triangles");
        let share = whole.model.bytes() / 3;
        let small = shown(share);
        assert!(small.model.bytes() <= share && small.model.bytes() > share / 2, "{}", small.model.bytes());
        assert!(small.caption.starts_with("10,240 triangles, shown as a level of detail with "), "{}", small.caption);
        assert!(shown(1).caption.contains("level of detail"), "ends even where nothing fits");
    }
}
