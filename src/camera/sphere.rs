/// How much each camera counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CameraWeights {
    /// By the solid angle it owns.
    #[default]
    Area,
    /// All alike, as Zhang & Turk count.
    Equal,
}
