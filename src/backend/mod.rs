//! Who looks: the machines that draw item buffers and answer rays.

/// The machine that looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BackendKind {
    /// The CPU rasteriser, always there.
    #[default]
    Raster,
    /// Ray casting with Embree.
    Embree,
    /// Rasterisation through wgpu.
    Gpu,
}

impl BackendKind {
    /// The name on the command line and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Raster => "raster",
            Self::Embree => "embree",
            Self::Gpu => "gpu",
        }
    }
}
