//! Turns flags into the library's options: the preset gives the defaults, an explicit flag overrides it.

use outsight::backend::BackendKind;
use outsight::error::{Error, Result};
use outsight::pipeline::{self, Metric, VISIBILITY_POWER};
use outsight::simplify::{PlaneWeight, SimplifyOptions, Topology};
use outsight::visibility::{Estimator, Hidden, MeasureOptions, RayOptions, Setting, Sides};

use super::collapsing::{CollapseFlags, MetricName, RefitName};
use super::flags::{BackendName, GlobalFlags, LookingFlags, Preset, RayFlags};

/// How visibility is measured under these flags.
///
/// # Errors
/// [`Error::Unavailable`] for a backend or an estimator that this version does not have, [`Error::Option`] for flags that
/// do not go together; as [`super::cameras::CameraFlags::cameras`].
pub fn measure_options(flags: &LookingFlags, global: &GlobalFlags) -> Result<MeasureOptions> {
    looking_and(flags, global, &[])
}

/// The same for a run that does `hidden` with hidden triangles: to be sure of them it draws pictures, whatever measured.
///
/// # Errors
/// As [`measure_options`].
pub fn simplify_measure_options(flags: &LookingFlags, global: &GlobalFlags, hidden: Hidden) -> Result<MeasureOptions> {
    looking_and(flags, global, if hidden == Hidden::Delete { &["--resolution"] } else { &[] })
}

/// `used_besides` are flags that the run needs besides its estimator.
fn looking_and(flags: &LookingFlags, global: &GlobalFlags, used_besides: &[&str]) -> Result<MeasureOptions> {
    let options = looking_options(flags, global)?;
    options.check()?;
    check_owners(flags, &[options.estimator], used_besides)?;
    Ok(options)
}

/// How visibility is measured under these flags by each of several settings; backend and estimator are each setting's own.
///
/// # Errors
/// [`Error::Option`] for a flag of an estimator that no setting has; as [`super::cameras::CameraFlags::cameras`].
pub fn verify_options(flags: &LookingFlags, global: &GlobalFlags, settings: &[Setting]) -> Result<MeasureOptions> {
    let estimators: Vec<Estimator> = settings.iter().map(|setting| setting.estimator).collect();
    check_owners(flags, &estimators, &[])?;
    looking_options(flags, global)
}

fn looking_options(flags: &LookingFlags, global: &GlobalFlags) -> Result<MeasureOptions> {
    let preset = pipeline::Preset::from(flags.preset).measure();
    let estimator = flags.estimator.map_or(preset.estimator, Estimator::from);
    // The paper looks at fronts. Depth rescue would make backs along the outline of a solid seen, which nobody can see.
    let sides = if estimator == Estimator::ItemBuffer { Sides::One } else { preset.sides };
    Ok(MeasureOptions {
        cameras: flags.cameras.cameras(preset.cameras)?,
        camera_weights: flags.camera_weights.map_or(preset.camera_weights, Into::into),
        resolution: flags.resolution.or(preset.resolution),
        backend: backend(flags.backend, estimator),
        estimator,
        sides: flags.sides.map_or(sides, Into::into),
        rays: ray_options(&flags.rays, preset.rays, global.seed),
        rescue: flags.rescue.map_or(preset.rescue, Into::into),
        memory_limit: global.memory_limit,
    })
}

/// The machine that looks: where none is named, who asks for rays asks for the one that casts them.
fn backend(named: Option<BackendName>, estimator: Estimator) -> BackendKind {
    match named {
        None | Some(BackendName::Auto) if !estimator.draws() => BackendKind::Embree,
        None => BackendKind::Raster,
        Some(named) => named.into(),
    }
}

/// Refuses a flag that belongs to estimators of which none looks.
fn check_owners(flags: &LookingFlags, estimators: &[Estimator], used_besides: &[&str]) -> Result<()> {
    let is_used = |name: &str, owners: &[Estimator]| {
        used_besides.contains(&name) || owners.iter().any(|owner| estimators.contains(owner))
    };
    let Some((name, owners)) = flags.owned().find(|(name, owners)| !is_used(name, owners)) else { return Ok(()) };
    let names = |all: &[Estimator]| all.iter().map(|one| one.name()).collect::<Vec<_>>().join(", ");
    let message = format!(
        "belongs to the estimator{} {}, and what looks is {}; ask for {} or leave the flag out",
        if owners.len() > 1 { "s" } else { "" },
        names(owners),
        names(estimators),
        if owners.len() > 1 { "one of these" } else { "that estimator" },
    );
    Err(Error::Option { name, message })
}

fn ray_options(flags: &RayFlags, preset: RayOptions, seed: u64) -> RayOptions {
    RayOptions {
        points: flags.points.unwrap_or(preset.points),
        partly_seen: flags.partly_seen.map_or(preset.partly_seen, Into::into),
        samples: flags.samples.unwrap_or(preset.samples),
        target_error: flags.target_error,
        target_error_p99: flags.target_error_p99,
        seed,
    }
}

/// What orders the collapses under these flags.
///
/// # Errors
/// [`Error::Unavailable`] for a metric that this version does not have.
pub fn metric(flags: &CollapseFlags) -> Result<Metric> {
    let name = match flags.metric {
        MetricName::Visibility => return Ok(Metric::Visibility),
        MetricName::Quadric => return Ok(Metric::Quadric),
        MetricName::Orientation => "orientation",
        MetricName::Silhouette => "silhouette",
    };
    let message = format!("metric {name} is not in this version of Outsight; use --metric visibility or quadric");
    Err(Error::Unavailable { message })
}

/// What happens to hidden triangles.
///
/// # Errors
/// [`Error::Option`] for anything but `keep` under a metric that does not look: nothing would be known to be hidden.
pub fn hidden(flags: &CollapseFlags, preset: Preset, metric: Metric) -> Result<Hidden> {
    let asked = flags.hidden.map(Hidden::from);
    let preserves = flags.topology.map(Topology::from) == Some(Topology::Preserve);
    match (metric, asked, preset) {
        (Metric::Quadric, None | Some(Hidden::Keep), _) => Ok(Hidden::Keep),
        (Metric::Quadric, Some(_), _) => Err(Error::Option {
            name: "--hidden",
            message: "--metric quadric does not look, so nothing is known to be hidden; use --metric visibility, with \
                      --visibility-power 0 for quadric error on what can be seen"
                .to_owned(),
        }),
        (Metric::Visibility, Some(asked), _) => Ok(asked),
        // Deleting would open what is closed.
        (Metric::Visibility, None, Preset::Best) if !preserves => Ok(Hidden::Delete),
        (Metric::Visibility, None, _) => Ok(Hidden::Collapse),
    }
}

/// p in V^p under these flags.
pub fn visibility_power(flags: &CollapseFlags) -> f64 {
    flags.visibility_power.unwrap_or(VISIBILITY_POWER)
}

/// The collapser's options under these flags, without targets and error bound.
///
/// # Errors
/// [`Error::Unavailable`] for `--refit guarded`.
pub fn simplify_options(flags: &CollapseFlags, preset: Preset) -> Result<SimplifyOptions> {
    if flags.refit == RefitName::Guarded {
        let message = "--refit guarded is not in this version of Outsight; leave it out or use --refit none".to_owned();
        return Err(Error::Unavailable { message });
    }
    let base = pipeline::Preset::from(preset).simplify();
    Ok(SimplifyOptions {
        plane_weight: flags.weights_by.map_or(base.plane_weight, PlaneWeight::from),
        topology: flags.topology.map_or(base.topology, Topology::from),
        boundary: flags.boundary.unwrap_or(base.boundary),
        ..base
    })
}
