//! How far two measurements of one mesh agree, camera by camera and triangle by triangle.
//!
//! The five statistics are always the same: the table of who sees what, agreement and kappa over it, the difference of V
//! over the surface, the difference of V(M), and the triangles that differ most. All are taken on unclamped, unpooled
//! values. Source of kappa: Cohen 1960, *A coefficient of agreement for nominal scales*.
//!
//! *Sides.* Each measurement knows a front and a back. With [`Sides::One`] fronts are compared. With [`Sides::Better`] each
//! triangle is compared on the side that the two together find more visible: on a closed mesh that is the front again, and
//! nothing is diluted by backs that nobody can see. With [`Sides::Sum`] both sides count. The table takes the cameras in
//! front of a compared side, with |d·n| > 1e-9. V(M) is one-sided always.
//!
//! *Contacts.* Where two triangles lie at one depth, which of them a pixel shows is a matter of rounding. Such pixels say
//! nothing about either measurement and are left out of table and differences; see [`Contacts`].

mod causes;
mod limits;
mod measurement;
mod pixels;
mod table;
mod values;

pub use causes::{Cause, Causes};
pub use limits::Limits;
pub use measurement::Measurement;
pub use table::Confusion;
pub use values::{ValueDifference, WorstTriangle};

use serde::Serialize;

use crate::camera::CameraSphere;
use crate::error::{Error, Result};
use crate::progress::Progress;
use crate::visibility::{MeasureOptions, Shapes, Sides, VisibilityDiagram};
use pixels::Differing;
use table::Pairs;

/// What is common to two measurements.
#[derive(Clone, Copy)]
pub struct Comparing<'a> {
    /// The cameras of both.
    pub cameras: &'a CameraSphere,
    /// The options of both; backend and estimator are each measurement's own.
    pub options: &'a MeasureOptions,
    /// Who listens.
    pub progress: &'a dyn Progress,
}

/// How far two measurements agree.
#[derive(Debug, Clone, PartialEq)]
pub struct Agreement {
    /// Who sees what; `None` if one of the two has no cameras.
    pub seen: Option<SeenAgreement>,
    /// How V differs.
    pub values: ValueDifference,
    /// What was left out as a tie.
    pub contacts: Contacts,
}

/// How far two measurements agree on which camera sees which triangle.
#[derive(Debug, Clone, PartialEq)]
pub struct SeenAgreement {
    /// Pairs of a triangle and a camera in front of it, each counted once.
    pub counts: Confusion,
    /// The same pairs, each counted by A_t (d·n) a_v: the share of the images, not of the list.
    pub weighted: Confusion,
    /// Why pairs differ.
    pub causes: Causes,
    /// The camera with the most pairs that differ, the first of several; `None` if no pair does.
    pub worst_camera: Option<usize>,
}

/// Pixels in which two triangles at one depth (to 2e-6 of the radius) tie, and each measurement took another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Contacts {
    /// Such pixels, over all cameras.
    pub pixels: u64,
    /// Pairs of the table that differ and have such a pixel; left out of the table.
    pub pairs: u64,
}

impl Agreement {
    /// Compares `a` with `b`: differences are a − b.
    ///
    /// Draws both again where they differ and at least one of them draws, to see why.
    ///
    /// # Errors
    /// [`Error::ShapeMismatch`] for measurements of different meshes or cameras; as [`crate::visibility::measure`].
    pub fn of(a: &Measurement<'_>, b: &Measurement<'_>, comparing: Comparing<'_>) -> Result<Self> {
        check_shapes(a, b, comparing.cameras)?;
        let shapes = Shapes::of(a.subject.mesh(), a.subject.frame());
        let differing = Differing::find(a, b, comparing)?;
        let compared = compared_sides(a, b, comparing.options.sides);
        let pairs = Pairs { a, b, comparing, shapes: &shapes, compared: &compared, differing: &differing };
        let seen = a.diagram.as_ref().zip(b.diagram.as_ref()).map(|(of_a, of_b)| pairs.tally(of_a, of_b));
        let (seen, contact_pairs) = seen.map_or((None, 0), |(seen, contacts)| (Some(seen), contacts));
        Ok(Self {
            seen,
            values: pairs.value_difference(),
            contacts: Contacts { pixels: differing.tied_pixels, pairs: contact_pairs },
        })
    }
}

/// Which sides of a triangle are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Compared {
    front: bool,
    back: bool,
}

fn compared_sides(a: &Measurement<'_>, b: &Measurement<'_>, rule: Sides) -> Vec<Compared> {
    let side = |t: usize| match rule {
        Sides::One => Compared { front: true, back: false },
        Sides::Sum => Compared { front: true, back: true },
        Sides::Better => {
            let front = a.visibility.front()[t] + b.visibility.front()[t];
            let back = a.visibility.back()[t] + b.visibility.back()[t];
            Compared { front: front >= back, back: front < back }
        }
    };
    (0..a.visibility.front().len()).map(side).collect()
}

fn check_shapes(a: &Measurement<'_>, b: &Measurement<'_>, cameras: &CameraSphere) -> Result<()> {
    let expect = |what, got, expected| {
        if got == expected { Ok(()) } else { Err(Error::ShapeMismatch { what, got, expected }) }
    };
    let triangles = a.subject.mesh().triangle_count();
    for measurement in [a, b] {
        expect("visibility", measurement.visibility.front().len(), triangles)?;
        let diagrams = measurement.diagram.iter();
        diagrams.clone().try_for_each(|d: &VisibilityDiagram| expect("diagram", d.triangles(), triangles))?;
        diagrams.clone().try_for_each(|d| expect("cameras of the diagram", d.cameras(), cameras.count()))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
