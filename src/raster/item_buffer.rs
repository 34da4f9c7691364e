use crate::camera::Window;
use crate::mesh::TriangleId;

/// A side of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The side its normal points to.
    Front,
    /// The other one.
    Back,
}

impl Side {
    /// The other side.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Front => Self::Back,
            Self::Back => Self::Front,
        }
    }
}

/// What a camera sees in a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Hit {
    /// The triangle.
    pub triangle: TriangleId,
    /// The side of it that the camera sees.
    pub side: Side,
}

/// One step of depth in an item buffer, in unit-sphere units, for a mesh that reaches `extent` from the centre.
///
/// Every backend counts depth in these steps from the centre, toward the near camera. 2³⁰ of them reach a little farther
/// than the mesh: rounding to `f32` may carry a vertex past its extent.
#[must_use]
pub fn depth_step(window: Window, extent: f64) -> f64 {
    1.0001 * extent.max(window.half_width) / f64::from(1 << 30)
}

/// The two item buffers of an axis: what the near and the far camera see in each pixel.
///
/// Both cameras share the pixel lattice: the far image is not mirrored. Rows go upward.
#[derive(Debug, Clone)]
pub struct ItemBufferPair {
    window: Window,
    /// Per pixel the keys for the near and the far camera. The greater key wins: closeness in the upper half, below it
    /// the complement of `2 · triangle + back` as seen by the *near* camera, so that equal depth goes to the smaller
    /// number. 0 is empty.
    keys: Vec<[u64; 2]>,
}

impl ItemBufferPair {
    /// Empty buffers for the window.
    #[must_use]
    pub fn new(window: Window) -> Self {
        Self { window, keys: vec![[0; 2]; window.pixel_count()] }
    }

    /// Bytes that the buffers of a window take.
    #[must_use]
    pub fn bytes(window: Window) -> u64 {
        (window.pixel_count() * size_of::<[u64; 2]>()) as u64
    }

    /// The window that the buffers cover.
    #[must_use]
    pub fn window(&self) -> Window {
        self.window
    }

    /// What the near camera sees, pixel by pixel, row after row.
    pub fn near(&self) -> impl Iterator<Item = Option<Hit>> + '_ {
        self.keys.iter().map(|k| decode(k[0]))
    }

    /// What the far camera sees, at the same pixels.
    pub fn far(&self) -> impl Iterator<Item = Option<Hit>> + '_ {
        let from_behind = |hit: Hit| Hit { side: hit.side.opposite(), ..hit };
        self.keys.iter().map(move |k| decode(k[1]).map(from_behind))
    }

    /// What the near and the far camera see at a pixel, each with its depth (see [`depth_step`]); `None` where it is empty.
    #[inline]
    #[must_use]
    pub fn at(&self, pixel: usize) -> Option<[(i32, Hit); 2]> {
        let [near, far] = self.keys[pixel];
        let (front, back) = (decode(near)?, decode(far)?);
        let depth = |closeness: u64| (closeness >> 32) as u32 ^ 0x8000_0000;
        Some([(depth(near) as i32, front), (depth(!far) as i32, Hit { side: back.side.opposite(), ..back })])
    }

    /// Pixels in which the cameras see anything; the same number for both.
    #[must_use]
    pub fn covered(&self) -> u64 {
        self.keys.iter().filter(|k| k[0] != 0).count() as u64
    }

    /// Makes every pixel empty.
    pub fn clear(&mut self) {
        self.keys.fill([0; 2]);
    }

    /// Offers a surface point to both cameras: `depth`, in steps of [`depth_step`], grows toward the near one, `side` is what
    /// that one sees.
    #[inline]
    pub fn offer(&mut self, pixel: usize, depth: i32, hit: Hit) {
        offer(&mut self.keys[pixel], depth, tag(hit));
    }

    pub(super) fn row_mut(&mut self, row: usize) -> &mut [[u64; 2]] {
        let width = self.window.width as usize;
        &mut self.keys[row * width..(row + 1) * width]
    }
}

/// The lower half of a key: greater for smaller triangle numbers, never 0.
#[inline]
pub(super) fn tag(hit: Hit) -> u32 {
    !(hit.triangle.0 << 1 | u32::from(hit.side == Side::Back))
}

/// Offers a pixel of a large triangle.
#[inline]
pub(super) fn offer(keys: &mut [u64; 2], depth: i32, tag: u32) {
    let [near, far] = keys_of(depth, tag);
    // Branches, not maxima: most large surfaces lie between two others, so that both are foreseen, nothing is written.
    if near > keys[0] {
        keys[0] = near;
    }
    if far > keys[1] {
        keys[1] = far;
    }
}

/// The same for small triangles, whose fate differs from one to the next: without branches.
#[inline]
pub(super) fn raise(keys: &mut [u64; 2], depth: i32, tag: u32) {
    let [near, far] = keys_of(depth, tag);
    *keys = [keys[0].max(near), keys[1].max(far)];
}

#[inline]
fn keys_of(depth: i32, tag: u32) -> [u64; 2] {
    let closeness = depth as u32 ^ 0x8000_0000;
    [closeness, !closeness].map(|c| u64::from(c) << 32 | u64::from(tag))
}

#[inline]
fn decode(key: u64) -> Option<Hit> {
    let code = !(key as u32);
    let side = if code & 1 == 0 { Side::Front } else { Side::Back };
    (key != 0).then_some(Hit { triangle: TriangleId(code >> 1), side })
}
