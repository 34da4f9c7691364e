//! The patterns in which cameras stand.

use std::f64::consts::PI;

use glam::DVec3;

use crate::camera::{CameraSphere, CameraWeights};
use crate::error::{Error, Result};
use crate::geom::OctahedralSphere;

/// Integer weight of a camera that owns the mean solid angle.
const MEAN_WEIGHT: f64 = 4096.0;

/// Finest subdivision offered (4098 cameras).
const MAX_LEVEL: u32 = 5;

/// With fewer there are surfaces that hardly any camera faces; more than these help nobody.
const FIBONACCI_COUNTS: std::ops::RangeInclusive<usize> = 6..=65_536;

/// Degrees between two circles of latitude, and between two cameras on one.
const LATLONG_STEP: f64 = 15.0;

/// Cameras that may be listed; their weights then fit sums over the largest images.
const MOST_LISTED: usize = 65_536;

impl CameraSphere {
    /// Cameras of [`Self::latlong`].
    pub const LATLONG: usize = 266;

    /// The octahedral pattern of `count` cameras: 6, 18, 66, 258, 1026 or 4098.
    ///
    /// The six axes come first, then the cameras by level of subdivision, so that the cameras of a coarser pattern are
    /// the first ones of a finer. Source: Zhang & Turk 2002, section 4.
    ///
    /// # Errors
    /// [`Error::Option`] for another count.
    pub fn octahedral(count: usize, weights: CameraWeights) -> Result<Self> {
        let level = (0..=MAX_LEVEL).find(|&k| 4_usize.pow(k + 1) + 2 == count).ok_or_else(|| {
            refused(format!("{count} is not a number of octahedral cameras; take 6, 18, 66, 258, 1026 or 4098"))
        })?;
        let sphere = OctahedralSphere::new(level);
        let angles = sphere.vertex_solid_angles();
        Ok(weighted(sphere.vertices, &angles, weights))
    }

    /// `count` cameras on a spiral from pole to pole, each of which owns nearly the same solid angle.
    ///
    /// Half of them are the upper half of the spiral, each followed by the camera opposite to it. Their weights are
    /// equal. Source: R. Swinbank & R. J. Purser, "Fibonacci grids: A novel approach to global modelling", Quarterly
    /// Journal of the Royal Meteorological Society 132, 2006; the mirrored half is ours.
    ///
    /// # Errors
    /// [`Error::Option`] for an odd count, or one outside 6 to 65,536.
    pub fn fibonacci(count: usize) -> Result<Self> {
        if count % 2 == 1 || !FIBONACCI_COUNTS.contains(&count) {
            let message = format!("{count} is not a number of fibonacci cameras; take an even one from 6 to 65536");
            return Err(refused(message));
        }
        let on_spiral = |i: usize| {
            let z = 1.0 - (2 * i + 1) as f64 / count as f64;
            let angle = PI * (1.0 + 5.0_f64.sqrt()) * (i as f64 + 0.5);
            at(z, angle)
        };
        let cameras = (0..count / 2).map(on_spiral).flat_map(|d| [(d, 1), (-d, 1)]);
        Ok(Self::of(cameras.collect()))
    }

    /// 266 cameras on circles of latitude, every 15 degrees in latitude and longitude, the poles first, each
    /// camera followed by the one opposite to it.
    ///
    /// By [`CameraWeights::Area`] a camera counts by the zone of its circle divided by the cameras on it; alike, they crowd
    /// the poles, and V is wrong by a tenth. Source: Mata, Pastor & Rodríguez, GRAPP 2008.
    #[must_use]
    pub fn latlong(weights: CameraWeights) -> Self {
        const CIRCLES: i32 = (90.0 / LATLONG_STEP) as i32 - 1;
        const PER_CIRCLE: i32 = (360.0 / LATLONG_STEP) as i32;
        let radians = |degrees: f64| degrees * (PI / 180.0);
        let half_step = radians(0.5 * LATLONG_STEP);
        let polar = 2.0 * PI * (1.0 - libm::cos(half_step));
        let mut cameras = vec![(DVec3::Z, polar)];
        for circle in 0..=CIRCLES {
            let latitude = radians(LATLONG_STEP * f64::from(circle));
            let zone = libm::sin(latitude + half_step) - libm::sin(latitude - half_step);
            // Half of the equator: the other half is opposite.
            let along = if circle == 0 { PER_CIRCLE / 2 } else { PER_CIRCLE };
            for camera in 0..along {
                let direction = at(libm::sin(latitude), radians(LATLONG_STEP * f64::from(camera)));
                cameras.push((direction, zone * 2.0 * PI / f64::from(PER_CIRCLE)));
            }
        }
        let (directions, angles): (Vec<DVec3>, Vec<f64>) =
            cameras.into_iter().flat_map(|(d, angle)| [(d, angle), (-d, angle)]).unzip();
        weighted(directions, &angles, weights)
    }

    /// The listed cameras: directions of any length but 0 from the object toward the camera, each with a weight above 0.
    ///
    /// Under [`CameraWeights::Equal`] the weights in the list do not count.
    ///
    /// # Errors
    /// [`Error::Option`] for fewer than 2 cameras or more than 65,536, a direction of no length, a weight not above 0.
    pub fn listed(cameras: &[(DVec3, f64)], weights: CameraWeights) -> Result<Self> {
        if !(2..=MOST_LISTED).contains(&cameras.len()) {
            let message = format!("a list of cameras has 2 to {MOST_LISTED}, not {}", cameras.len());
            return Err(Error::Option { name: "--camera-file", message });
        }
        let unit = |(i, &(d, weight)): (usize, &(DVec3, f64))| match d.try_normalize() {
            Some(unit) if weight > 0.0 && weight.is_finite() => Ok((unit, weight)),
            _ => {
                let message = format!("camera {i}: {d} with weight {weight} does not look from anywhere");
                Err(Error::Option { name: "--camera-file", message })
            }
        };
        let (directions, shares): (Vec<DVec3>, Vec<f64>) =
            cameras.iter().enumerate().map(unit).collect::<Result<Vec<_>>>()?.into_iter().unzip();
        if weights == CameraWeights::Area {
            check_spread(&shares)?;
        }
        Ok(weighted(directions, &shares, weights))
    }
}

/// The heaviest listed camera may count this many times as much as the lightest: with integers of mean 4096 and a floor under
/// the sums of cosines, what only lighter ones see would come out wrong.
const MAX_SPREAD: f64 = 100.0;

fn check_spread(shares: &[f64]) -> Result<()> {
    let (least, most) = shares.iter().fold((f64::INFINITY, 0.0_f64), |(l, m), &share| (l.min(share), m.max(share)));
    if most <= MAX_SPREAD * least {
        return Ok(());
    }
    let message = format!(
        "the weights go from {least:e} to {most:e}; the largest may be {MAX_SPREAD} times the smallest, or what only light \
         cameras see is lost; leave the lightest out, or let all count alike with --camera-weights equal"
    );
    Err(Error::Option { name: "--camera-file", message })
}

/// The unit vector of height `z` at an angle around the z axis.
fn at(z: f64, angle: f64) -> DVec3 {
    let r = (1.0 - z * z).sqrt();
    DVec3::new(r * libm::cos(angle), r * libm::sin(angle), z)
}

/// Cameras that count by their share of the whole, in integers whose mean is [`MEAN_WEIGHT`], or alike.
fn weighted(directions: Vec<DVec3>, shares: &[f64], weights: CameraWeights) -> CameraSphere {
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    let weight = |share: f64| match weights {
        // A camera that is listed counts, however many and heavy the others.
        CameraWeights::Area => (libm::round(MEAN_WEIGHT * (share / mean)) as u64).max(1),
        CameraWeights::Equal => 1,
    };
    CameraSphere::of(directions.into_iter().zip(shares.iter().map(|&share| weight(share))).collect())
}

fn refused(message: String) -> Error {
    Error::Option { name: "--cameras", message }
}
