use std::sync::atomic::{AtomicU64, Ordering};

use crate::error::{Error, Result};
use crate::mesh::TriangleId;

/// Which camera sees which triangle: the bit matrix F(t, v) of Zhang & Turk 2002, Fig. 1.
///
/// One row per triangle, one column per camera. A camera sees of a triangle the side that faces it; the bit does not tell
/// which one that is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VisibilityDiagram {
    cameras: usize,
    /// Row after row, each padded to whole words; camera v is bit v % 64 of word v / 64.
    words: Vec<u64>,
}

impl VisibilityDiagram {
    /// Bytes that the diagram of so many triangles and cameras takes.
    #[must_use]
    pub fn bytes(triangles: usize, cameras: usize) -> u64 {
        triangles as u64 * cameras.div_ceil(64) as u64 * 8
    }

    /// Number of rows.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.words.len() / self.words_per_row()
    }

    /// Number of columns.
    #[must_use]
    pub fn cameras(&self) -> usize {
        self.cameras
    }

    /// Whether a camera sees a triangle.
    #[must_use]
    pub fn sees(&self, triangle: TriangleId, camera: usize) -> bool {
        self.row(triangle)[camera / 64] >> (camera % 64) & 1 == 1
    }

    /// A triangle's row: camera v is bit v % 64 of word v / 64.
    #[must_use]
    pub fn row(&self, triangle: TriangleId) -> &[u64] {
        let width = self.words_per_row();
        &self.words[triangle.0 as usize * width..][..width]
    }

    /// All rows, one behind the other.
    #[must_use]
    pub fn into_words(self) -> Vec<u64> {
        self.words
    }

    fn words_per_row(&self) -> usize {
        self.cameras.div_ceil(64)
    }
}

/// Writes a [`VisibilityDiagram`] from many threads at once.
#[derive(Debug)]
pub struct DiagramRecorder {
    cameras: usize,
    words: Vec<AtomicU64>,
}

impl DiagramRecorder {
    /// An empty diagram, where no camera sees anything yet.
    ///
    /// # Errors
    /// [`Error::Limit`] if it does not fit `memory_limit` bytes.
    pub fn new(triangles: usize, cameras: usize, memory_limit: Option<u64>) -> Result<Self> {
        let bytes = VisibilityDiagram::bytes(triangles, cameras);
        let refused = || Error::Limit {
            message: format!(
                "the visibility diagram of {triangles} triangles and {cameras} cameras takes {} MiB; raise \
                 --memory-limit or take fewer cameras",
                bytes.div_ceil(1 << 20)
            ),
        };
        if memory_limit.is_some_and(|limit| bytes > limit) {
            return Err(refused());
        }
        let mut words = Vec::new();
        let count = triangles * cameras.div_ceil(64);
        words.try_reserve_exact(count).map_err(|_| refused())?;
        words.resize_with(count, AtomicU64::default);
        Ok(Self { cameras, words })
    }

    /// Notes that a camera sees a triangle.
    pub fn record(&self, triangle: TriangleId, camera: usize) {
        let word = triangle.0 as usize * self.cameras.div_ceil(64) + camera / 64;
        self.words[word].fetch_or(1 << (camera % 64), Ordering::Relaxed);
    }

    /// The finished diagram.
    #[must_use]
    pub fn finish(self) -> VisibilityDiagram {
        VisibilityDiagram { cameras: self.cameras, words: self.words.into_iter().map(AtomicU64::into_inner).collect() }
    }
}
