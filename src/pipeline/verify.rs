use std::path::PathBuf;

use serde::Serialize;

use crate::error::{Error, Result};
use crate::io::{self, ReadOptions};
use crate::pipeline::disagreement::{PairPictures, write_pictures};
use crate::pipeline::surroundings::Surroundings;
use crate::pipeline::{Clock, Observer};
use crate::visibility::agreement::{Agreement, Causes, Comparing, Contacts, Limits, Measurement, WorstTriangle};
use crate::visibility::{MeasureOptions, Setting, Subject};

/// What [`verify_file`] does.
#[derive(Debug, Clone)]
pub struct VerifyRequest {
    /// The mesh.
    pub input: PathBuf,
    /// How it is read.
    pub read: ReadOptions,
    /// What is compared: the first with each of the others.
    pub settings: Vec<Setting>,
    /// How all of them look; backend and estimator are each setting's own.
    pub measure: MeasureOptions,
    /// Meshes in the same coordinates that hide and are not compared.
    pub occluders: Vec<PathBuf>,
    /// Directory for pictures of where they differ; made if it is not there.
    pub pictures: Option<PathBuf>,
    /// Upward in the pictures, any length but 0.
    pub up: [f64; 3],
    /// Replace pictures that are there.
    pub force: bool,
}

/// Result of [`verify_file`].
#[derive(Debug, Clone, Serialize)]
pub struct VerifyReport {
    /// One entry per setting after the first.
    pub pairs: Vec<PairReport>,
    /// Triangles looked at.
    pub triangles: usize,
    /// Cameras.
    pub cameras: usize,
    /// Seconds of wall time for everything.
    pub seconds: f64,
}

/// How two settings agree; differences are a − b. What needs cameras is `None` for estimators without.
#[derive(Debug, Clone, Serialize)]
pub struct PairReport {
    /// The first setting.
    pub a: String,
    /// The other.
    pub b: String,
    /// Share of the table with equal answers.
    pub agreement: Option<f64>,
    /// The same, each pair of triangle and camera counted by its image.
    pub agreement_weighted: Option<f64>,
    /// Cohen's kappa of the table.
    pub kappa: Option<f64>,
    /// Pairs of triangle and camera that both see.
    pub n11: Option<u64>,
    /// Pairs that only a sees.
    pub n10: Option<u64>,
    /// Pairs that only b sees.
    pub n01: Option<u64>,
    /// Pairs that neither sees.
    pub n00: Option<u64>,
    /// Area-weighted mean of |V_a − V_b|.
    pub mean_abs_dv: f64,
    /// Area-weighted mean of V_a − V_b.
    pub bias: f64,
    /// 99 % of the area differ by no more than this.
    pub p99: f64,
    /// |V_a(M) − V_b(M)|.
    pub dvm: f64,
    /// Whether all limits are kept; `None` if there are none.
    pub pass: Option<bool>,
    /// Share of what anyone sees that only one sees.
    pub differing: Option<f64>,
    /// V(M) of each.
    pub visibility: [f64; 2],
    /// The limits.
    pub limits: Limits,
    /// Why pairs differ.
    pub causes: Option<Causes>,
    /// What was left out as a tie.
    pub contacts: Contacts,
    /// The triangles that add most to `mean_abs_dv`.
    pub worst: Vec<WorstTriangle>,
    /// Pictures that were written.
    pub pictures: Vec<PathBuf>,
}

impl VerifyRequest {
    /// Files for the pictures of the first setting and another, if any were asked for.
    #[must_use]
    pub fn pictures_of(&self, number: usize) -> Option<PairPictures> {
        let name = |number: usize| self.settings.get(number).map(|s| s.to_string().replace('@', "-"));
        let [a, b] = [name(0)?, name(number)?];
        self.pictures.as_deref().map(|directory| PairPictures::new(directory, &a, &b))
    }

    fn check(&self) -> Result<()> {
        if self.settings.len() < 2 {
            let message = "name at least two to compare, as in raster,embree".to_owned();
            return Err(Error::Option { name: "--backends", message });
        }
        if let Some(setting) = self.settings.iter().find(|setting| !setting.goes_together()) {
            let (estimator, backend) = (setting.estimator.name(), setting.backend.name());
            let message =
                format!("{setting}: {estimator} needs rays, which {backend} does not cast; name {estimator}@embree");
            return Err(Error::Option { name: "--backends", message });
        }
        let check = |setting: &Setting| setting.apply(&self.measure).check().map_err(|error| named(*setting, error));
        self.settings.iter().try_for_each(check)
    }
}

/// Says which setting it is that is not there.
fn named(setting: Setting, error: Error) -> Error {
    match error {
        Error::Unavailable { message } => {
            Error::Unavailable { message: format!("{setting}: {message}, or leave {setting} out of --backends") }
        }
        other => other,
    }
}

/// Puts the same question to several backends and estimators, and says how far their answers agree.
///
/// # Errors
/// As its steps; [`Error::Option`] for fewer than two settings. Disagreement is a result, not an error.
pub fn verify_file(request: &VerifyRequest, observer: &dyn Observer) -> Result<VerifyReport> {
    let clock = Clock::start();
    request.check()?;
    let occluders = Surroundings::read(&request.occluders, &request.read)?;
    let loaded = io::read(&request.input, &request.read)?;
    observer.mesh_read(&request.input, &loaded)?;
    let options = &request.measure;
    let cameras = options.camera_sphere()?;
    let comparing = Comparing { cameras: &cameras, options, progress: observer };
    let subject = occluders.around(&loaded.mesh)?.for_backend(request.settings[0].backend)?;
    let first = Measurement::take(&subject, request.settings[0], comparing)?;
    observer.measured(options, &first.visibility)?;
    let mut pairs = Vec::new();
    for number in 1..request.settings.len() {
        pairs.push(verify_pair(&first, number, (comparing, observer), request)?);
    }
    Ok(VerifyReport {
        pairs,
        triangles: loaded.mesh.triangle_count(),
        cameras: cameras.count(),
        seconds: clock.total(),
    })
}

fn verify_pair(
    first: &Measurement<'_>,
    number: usize,
    (comparing, observer): (Comparing<'_>, &dyn Observer),
    request: &VerifyRequest,
) -> Result<PairReport> {
    let setting = request.settings[number];
    let subject = Subject::among(first.subject.mesh(), first.subject.occluders(), setting.backend)?;
    let second = Measurement::take(&subject, setting, comparing)?;
    observer.measured(comparing.options, &second.visibility)?;
    let agreement = Agreement::of(first, &second, comparing)?;
    let mut report = PairReport::new(first, &second, &agreement, comparing);
    if let Some(files) = request.pictures_of(number) {
        report.pictures = write_pictures(&files, [first, &second], &agreement, comparing, request)?;
    }
    Ok(report)
}

impl PairReport {
    fn new(a: &Measurement<'_>, b: &Measurement<'_>, agreement: &Agreement, comparing: Comparing<'_>) -> Self {
        let limits = Limits::between(a, b, comparing);
        let (seen, values) = (agreement.seen.as_ref(), &agreement.values);
        Self {
            a: a.setting.to_string(),
            b: b.setting.to_string(),
            agreement: seen.map(|s| s.counts.agreement()),
            agreement_weighted: seen.map(|s| s.weighted.agreement()),
            kappa: seen.map(|s| s.counts.kappa()),
            n11: seen.map(|s| s.counts.n11 as u64),
            n10: seen.map(|s| s.counts.n10 as u64),
            n01: seen.map(|s| s.counts.n01 as u64),
            n00: seen.map(|s| s.counts.n00 as u64),
            mean_abs_dv: values.mean_abs,
            bias: values.bias,
            p99: values.p99,
            dvm: values.of_mesh,
            pass: limits.are_kept_by(agreement),
            differing: seen.map(|s| s.counts.differing()),
            visibility: [a, b].map(|m| m.visibility.of_mesh()),
            limits,
            causes: seen.map(|s| s.causes),
            contacts: agreement.contacts,
            worst: values.worst.clone(),
            pictures: Vec::new(),
        }
    }
}
