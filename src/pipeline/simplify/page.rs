//! What the page shows of a run of `simplify`.

use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::eval::{ImageError, image_errors};
use crate::mesh::TriMesh;
use crate::pipeline::measure::hiding_too;
use crate::pipeline::page::{Column, Exhibit, Show, section, shown_names};
use crate::pipeline::surroundings::Surroundings;
use crate::pipeline::{Metric, Observer, Simplified, SimplifyRequest};
use crate::report::page::{Content, Figure, Figures, Image, Section};
use crate::report::plot::{MethodCurves, TwoAxisPlot};
use crate::report::table::thousands;
use crate::visibility::Visibility;

/// A mesh before it was simplified.
pub(in crate::pipeline) struct Before<'a> {
    pub mesh: &'a TriMesh,
    /// `None` where nobody looked.
    pub visibility: Option<Visibility>,
    pub occluders: &'a Surroundings,
}

/// What a page shows of a run: every level is looked at by itself.
pub(in crate::pipeline) fn show<'a>(
    before: Before<'a>,
    simplified: &'a Simplified,
    request: &'a SimplifyRequest,
    observer: &dyn Observer,
) -> Result<Show<'a>> {
    let look = |name, mesh| Exhibit::look(name, before.occluders.around(mesh)?, &request.measure, observer);
    let paths: Vec<&Path> =
        std::iter::once(&request.input).chain(request.levels.iter().map(|l| &l.output)).map(PathBuf::as_path).collect();
    let mut names = shown_names(&paths);
    let name = names.remove(0);
    let names = request.page.iter().fold(names, |names, page| page.named(names));
    let original = match before.visibility {
        Some(visibility) => Exhibit { name, mesh: before.mesh, visibility },
        None => look(name, before.mesh)?,
    };
    let results = simplified.levels.iter().zip(names).map(|(level, name)| look(name, &level.mesh));
    let meshes: Vec<&TriMesh> = simplified.levels.iter().map(|level| &level.mesh).collect();
    let errors = image_errors(before.mesh, &meshes, observer)?;
    let mut notes = vec![format!("Collapses were ordered by the metric {}.", request.metric.name())];
    if simplified.hidden_deleted > 0 {
        let deleted = thousands(simplified.hidden_deleted as u64);
        notes.push(format!("{deleted} hidden triangles were deleted before the first collapse."));
    }
    notes.extend(hiding_too(&request.occluders));
    Ok(Show {
        deed: "simplified",
        original,
        results: results.collect::<Result<_>>()?,
        verdict: String::new(),
        columns: columns(&errors),
        sections: error_over_triangles(&meshes, &errors, request.metric)?.into_iter().collect(),
        errors,
        measure: &request.measure,
        notes,
    })
}

/// The errors of the levels in the page's table.
fn columns(errors: &[ImageError]) -> Vec<Column> {
    let cells = |show: fn(&ImageError) -> String| errors.iter().map(show).collect();
    vec![
        Column { head: "Image error", cells: cells(|error| format!("{:.2}", error.image_rmse)) },
        Column { head: "Outline error", cells: cells(|error| format!("{:.1}", error.silhouette_xor)) },
    ]
}

/// A plot of the errors; `None` where a single level leaves no curve to draw.
fn error_over_triangles(meshes: &[&TriMesh], errors: &[ImageError], metric: Metric) -> Result<Option<Section>> {
    if meshes.len() < 2 {
        return Ok(None);
    }
    let curve = |error: fn(&ImageError) -> f64| {
        meshes.iter().zip(errors).map(|(mesh, e)| (mesh.triangle_count(), error(e))).collect()
    };
    let (left, right) = (curve(|e| e.image_rmse), curve(|e| e.silhouette_xor));
    let plot = TwoAxisPlot {
        title: String::new(),
        left: "image error, grey levels".to_owned(),
        right: "outline error, pixels a picture".to_owned(),
        methods: vec![MethodCurves { name: format!("metric {}", metric.name()), left, right }],
    };
    let svg = plot.to_svg().map_err(|e| Error::Limit { message: format!("the plot of errors: {e}") })?;
    let caption = "Image error (left axis) and outline error (right axis) of each level.".to_owned();
    let figures = Figures { columns: 1, figures: vec![Figure { image: Image::Svg(svg), caption }], legend: None };
    Ok(Some(section("Error over triangles", "", Content::Figures(figures))))
}
