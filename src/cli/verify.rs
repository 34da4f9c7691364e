//! `outsight verify`: do backends and estimators agree?

use std::path::PathBuf;

use clap::Args;
use outsight::error::{Error, Result};
use outsight::pipeline::{PairReport, VerifyReport, VerifyRequest, verify_file};
use outsight::visibility::Setting;
use serde::Serialize;
use serde_json::Value;

use super::console::Console;
use super::estimate::Task;
use super::failure::Failure;
use super::flags::{InputFlags, LookingFlags, OccluderFlags, UpFlags};
use super::in_force;
use super::outputs;
use super::presets;
use super::system::peak_mib;
use super::text::{count, duration, table};
use super::watch::{Found, Watch};

#[derive(Debug, Args)]
pub struct Flags {
    #[command(flatten)]
    input: InputFlags,
    /// What to compare, the first with each of the others: backends, estimators, or both as in surface@embree
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "raster,embree,hemisphere")]
    backends: Vec<Setting>,
    /// Directory for pictures of where they differ
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    up: UpFlags,
    #[command(flatten)]
    looking: LookingFlags,
    #[command(flatten)]
    around: OccluderFlags,
}

/// The library's report with what only the program knows.
#[derive(Debug, Serialize)]
struct Object<'a> {
    #[serde(flatten)]
    report: &'a VerifyReport,
    peak_mb: Option<f64>,
    #[serde(flatten)]
    found: Found,
    occluders: &'a [PathBuf],
    options: Value,
}

/// Measures, compares, prints; fails if a limit is not kept.
pub fn run(flags: &Flags, console: &Console) -> std::result::Result<(), Failure> {
    let request = request(flags, console)?;
    for files in (1..request.settings.len()).filter_map(|number| request.pictures_of(number)) {
        outputs::check_place_to_be(&files.values, request.force)?;
        outputs::check_place_to_be(&files.pixels, request.force)?;
    }
    let cameras = request.measure.camera_sphere()?.count();
    let task = Task::Verify { resolution: request.measure.resolution.unwrap_or(0), cameras };
    let watch = Watch::new(console, task);
    let report = verify_file(&request, &watch)?;
    let object = Object {
        report: &report,
        peak_mb: peak_mib(),
        found: watch.found(),
        occluders: &request.occluders,
        options: in_force::verify(&request.measure),
    };
    console.result(&object, &text(&report), true)?;
    verdict(&report.pairs)
}

fn request(flags: &Flags, console: &Console) -> Result<VerifyRequest> {
    if flags.looking.backend.is_some() || flags.looking.estimator.is_some() {
        return Err(Error::Option {
            name: "--backends",
            message:
                "verify takes several backends and estimators at once; name them here, as in raster,surface@embree"
                    .to_owned(),
        });
    }
    Ok(VerifyRequest {
        input: flags.input.mesh.clone(),
        read: flags.input.reading.options(&console.global),
        settings: flags.backends.clone(),
        measure: presets::verify_options(&flags.looking, &console.global, &flags.backends)?,
        occluders: flags.around.occluders.clone(),
        pictures: flags.output.clone(),
        up: flags.up.up,
        force: console.global.force,
    })
}

/// The asked condition: every pair keeps its limits.
fn verdict(pairs: &[PairReport]) -> std::result::Result<(), Failure> {
    if pairs.iter().any(|pair| pair.pass == Some(false)) { Err(Failure::ConditionFalse) } else { Ok(()) }
}

fn text(report: &VerifyReport) -> String {
    let pairs: Vec<String> = report.pairs.iter().map(pair_text).collect();
    let (triangles, cameras) = (count(report.triangles), count(report.cameras));
    format!("{}{triangles} triangles, {cameras} cameras, {}\n", pairs.concat(), duration(report.seconds))
}

fn pair_text(pair: &PairReport) -> String {
    let limits = &pair.limits;
    let rows: Vec<Vec<String>> = [
        share("agreement", pair.agreement, Bound::None),
        share("agreement by image area", pair.agreement_weighted, Bound::least(limits.agreement_weighted)),
        share("kappa", pair.kappa, Bound::least(limits.kappa)),
        small("seen by one only", pair.differing, Bound::most(limits.differing)),
        small("mean |difference of V|", Some(pair.mean_abs_dv), Bound::most(limits.mean_abs_dv)),
        small("bias", Some(pair.bias), Bound::None),
        small("99 % of the area within", Some(pair.p99), Bound::None),
        small("|difference of V(M)|", Some(pair.dvm), Bound::most(limits.dvm)),
    ]
    .into_iter()
    .flatten()
    .collect();
    let verdict = match pair.pass {
        Some(true) => "agree",
        Some(false) => "DISAGREE",
        None => "no limits are known for this pair",
    };
    let statistics = table(&["", "found", "limit", ""], &rows);
    let pictures: String = pair.pictures.iter().map(|p| format!("picture: {}\n", p.display())).collect();
    format!("{} and {}: {verdict}\n\n{statistics}\n{}{pictures}\n", pair.a, pair.b, causes_text(pair))
}

/// What a statistic must keep.
#[derive(Clone, Copy)]
enum Bound {
    Least(f64),
    Most(f64),
    None,
}

impl Bound {
    fn least(limit: Option<f64>) -> Self {
        limit.map_or(Self::None, Self::Least)
    }

    fn most(limit: Option<f64>) -> Self {
        limit.map_or(Self::None, Self::Most)
    }

    /// The limit and whether `value` keeps it.
    fn cells(self, value: f64) -> [String; 2] {
        let (limit, kept) = match self {
            Self::Least(limit) => (format!("≥ {limit}"), value >= limit),
            Self::Most(limit) => (format!("≤ {}", (limit * 1e5).round() / 1e5), value <= limit),
            Self::None => return [String::new(), String::new()],
        };
        [limit, if kept { "ok" } else { "NO" }.to_owned()]
    }
}

fn share(name: &str, value: Option<f64>, bound: Bound) -> Option<Vec<String>> {
    value.map(|v| [vec![name.to_owned(), format!("{v:.7}")], bound.cells(v).to_vec()].concat())
}

fn small(name: &str, value: Option<f64>, bound: Bound) -> Option<Vec<String>> {
    value.map(|v| [vec![name.to_owned(), format!("{v:.2e}")], bound.cells(v).to_vec()].concat())
}

/// Who sees what, and why not both.
fn causes_text(pair: &PairReport) -> String {
    let (Some(causes), Some(n10), Some(n01), Some(n11)) = (pair.causes, pair.n10, pair.n01, pair.n11) else {
        return String::new();
    };
    let named = [
        ("coplanar contact", causes.coplanar_contact),
        ("grazing", causes.grazing),
        ("sliver", causes.sliver),
        ("sub-pixel", causes.sub_pixel),
        ("unexplained", causes.unexplained),
    ];
    let listed: Vec<String> =
        named.iter().filter(|(_, n)| *n > 0).map(|(name, n)| format!("{name} {}", count(*n as usize))).collect();
    let causes = if listed.is_empty() { "none".to_owned() } else { listed.join(", ") };
    let [n11, n10, n01] = [n11, n10, n01].map(|n| count(n as usize));
    format!("triangle seen by camera: both {n11}, only the first {n10}, only the second {n01}\ncauses: {causes}\n")
}

#[cfg(test)]
mod tests;
