use crate::error::Result;
use crate::visibility::agreement::Comparing;
use crate::visibility::{DiagramRecorder, Setting, Subject, Visibility, VisibilityDiagram};

/// One measurement of a mesh, with what it takes to ask it why.
#[derive(Debug)]
pub struct Measurement<'a> {
    /// The mesh, before the machine that looked.
    pub subject: &'a Subject<'a>,
    /// What was counted, by whom.
    pub setting: Setting,
    /// The result.
    pub visibility: Visibility,
    /// Which camera sees which triangle; `None` from estimators without cameras.
    pub diagram: Option<VisibilityDiagram>,
}

impl<'a> Measurement<'a> {
    /// Measures; `subject` is laid out for the setting's backend.
    ///
    /// # Errors
    /// As [`crate::visibility::measure`]; [`crate::Error::Limit`] also if the diagram does not fit the memory limit.
    pub fn take(subject: &'a Subject<'a>, setting: Setting, comparing: Comparing<'_>) -> Result<Self> {
        let Comparing { cameras, options, progress } = comparing;
        let triangles = subject.mesh().triangle_count();
        let recorder = || DiagramRecorder::new(triangles, cameras.count(), options.memory_limit);
        let recorder = setting.estimator.has_cameras().then(recorder).transpose()?;
        let visibility = subject.measure_from(cameras, &setting.apply(options), recorder.as_ref(), progress)?;
        Ok(Self { subject, setting, visibility, diagram: recorder.map(DiagramRecorder::finish) })
    }

    /// Pixels along the side of the pictures that it looked at; `None` if it cast rays instead.
    pub(super) fn drawn(&self) -> Option<u32> {
        self.setting.estimator.draws().then(|| self.visibility.resolution())
    }
}
