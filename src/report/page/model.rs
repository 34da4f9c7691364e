use std::io::Write;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::io::Glb;

/// A GLB file as it stands in a page: gzip, then base64.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PackedModel {
    text: String,
}

impl PackedModel {
    /// Packs a model. Packing takes two thirds to three quarters off, base64 adds a third of the rest.
    ///
    /// # Errors
    /// [`Error::Limit`] for a model that GLB cannot hold.
    pub fn of(glb: &Glb) -> Result<Self> {
        let mut packer = GzEncoder::new(Vec::new(), Compression::best());
        let packed = glb.write(&mut packer).and_then(|()| packer.flush()).and_then(|()| packer.finish());
        let packed = packed.map_err(|e| Error::Limit { message: format!("a model for the page: {e}") })?;
        Ok(Self { text: BASE64_STANDARD.encode(packed) })
    }

    /// Bytes that it takes in a page.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.text.len()
    }

    /// As it stands in a page.
    pub(super) fn as_text(&self) -> &str {
        &self.text
    }
}
