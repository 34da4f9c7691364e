//! The one error type of the crate, grouped by whose fault it is.
//!
//! A message says what, where and what to do next; lower case, no full stop.

use std::path::PathBuf;

pub use crate::mesh::MeshError;

/// Everything that can go wrong in Outsight.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The surroundings: a file could not be opened or read.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file, `-` for standard input.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },

    /// The surroundings: a file could not be written; nothing is left behind under its name.
    #[error("{}: {message}", path.display())]
    Write {
        /// The file, `-` for standard output.
        path: PathBuf,
        /// What went wrong and what to do next.
        message: String,
    },

    /// The surroundings: whoever read standard output went away; programs end quietly then.
    #[error("standard output was closed before the end")]
    ClosedPipe,

    /// The input: a file is not what its format says.
    #[error("{place}: {message}")]
    Parse {
        /// File name, with line or byte where known: `bunny.ply, line 1207`.
        place: String,
        /// What is wrong and what to do next.
        message: String,
    },

    /// The input: triangles and vertices that do not make a mesh.
    #[error("{place}: {source}")]
    Mesh {
        /// File name or another name of the mesh.
        place: String,
        /// What is wrong with it.
        source: MeshError,
    },

    /// The caller: an option outside its range, or two that exclude each other.
    #[error("{name}: {message}")]
    Option {
        /// The option, spelled as on the command line: `--ratio`.
        name: &'static str,
        /// What was given, what is allowed, what was probably meant.
        message: String,
    },

    /// The caller: two arguments made for different meshes or cameras.
    #[error("{what} has {got} entries, expected {expected}")]
    ShapeMismatch {
        /// The argument.
        what: &'static str,
        /// Entries it has.
        got: usize,
        /// Entries it needs.
        expected: usize,
    },

    /// Resources: the work would go past a limit that was set.
    #[error("{message}")]
    Limit {
        /// The limit, what would be needed, what to do next.
        message: String,
    },

    /// The surroundings: a backend or an estimator that this build or machine does not have.
    #[error("{message}")]
    Unavailable {
        /// What is missing and what to use or install instead.
        message: String,
    },

    /// The library behind a backend: it met an error that is not ours to foresee.
    #[error("{message}")]
    Backend {
        /// What it said, what was done, and what to use instead.
        message: String,
    },

    /// The caller asked the work to stop.
    #[error("stopped before the end; no file is left half-written")]
    Cancelled,
}

impl Error {
    /// The exit code of the command line for this error: 2 usage, 3 input, 4 output, 5 limit, 6 not available,
    /// 70 a bug, 130 interrupted; 0 where the reader of standard output had enough.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::ClosedPipe => 0,
            Self::Option { .. } => 2,
            Self::Read { .. } | Self::Parse { .. } | Self::Mesh { .. } => 3,
            Self::Write { .. } => 4,
            Self::Limit { .. } => 5,
            Self::Unavailable { .. } => 6,
            Self::ShapeMismatch { .. } | Self::Backend { .. } => 70,
            Self::Cancelled => 130,
        }
    }
}

/// A number as a message quotes it: all its digits, but none that only say how large it is (`1e200`).
#[must_use]
pub fn short_number(number: f64) -> String {
    let is_plain = number == 0.0 || (1e-6..1e15).contains(&number.abs()) || !number.is_finite();
    if is_plain { number.to_string() } else { format!("{number:e}") }
}

/// Result with the crate's [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

#[cfg(test)]
mod tests {
    use super::short_number;

    #[test]
    fn numbers_in_messages_stay_short() {
        let shown = [0.0, -0.25, 5000.0, 1e200, -1e-200, f64::INFINITY, f64::MAX].map(short_number);
        assert_eq!(shown, ["0", "-0.25", "5000", "1e200", "-1e-200", "inf", "1.7976931348623157e308"]);
    }
}
