//! The stages of a frame.

use serde::Serialize;

/// Instructions of one frame by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Stages {
    /// Vertices: transformation and light.
    pub vertex: u64,
    /// Triangles that face away or lie off screen told apart, the others binned.
    pub cull: u64,
    /// Per drawn triangle and band: nodes, fits, edges.
    pub setup: u64,
    /// Per row of a triangle: stepping, slices, the start of the walkers.
    pub span: u64,
    /// The inner loop.
    pub pixel: u64,
    /// Background and depth of the band cleared. Not part of [`Self::drawing`].
    pub clear: u64,
    /// Pixels on their way to the display. Not part of [`Self::drawing`].
    pub transfer: u64,
}

impl Stages {
    /// All that draws: without clearing and transfer.
    #[must_use]
    pub fn drawing(&self) -> u64 {
        self.vertex + self.cull + self.setup + self.span + self.pixel
    }
}
