use crate::error::Error;
use crate::mesh::MeshError;

/// What a reader found wrong, before it is known which file it read.
#[derive(Debug)]
pub(super) enum Fault {
    /// The bytes are not what the format says.
    Parse { line: Option<usize>, message: String },
    /// The numbers are well formed and make no mesh.
    Mesh(MeshError),
}

impl Fault {
    /// A fault of the file as a whole, or one whose message gives the byte.
    pub(super) fn new(message: impl Into<String>) -> Self {
        Self::Parse { line: None, message: message.into() }
    }

    /// A fault in a line, counted from 1.
    pub(super) fn at(line: usize, message: impl Into<String>) -> Self {
        Self::Parse { line: Some(line), message: message.into() }
    }

    /// The error for the file of that name.
    pub(super) fn named(self, name: &str) -> Error {
        match self {
            Self::Parse { line: None, message } => Error::Parse { place: name.to_owned(), message },
            Self::Parse { line: Some(line), message } => {
                Error::Parse { place: format!("{name}, line {line}"), message }
            }
            Self::Mesh(source) => Error::Mesh { place: name.to_owned(), source },
        }
    }
}

impl From<MeshError> for Fault {
    fn from(error: MeshError) -> Self {
        Self::Mesh(error)
    }
}
