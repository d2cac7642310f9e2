//! The surfaces that are seen through one pixel, one behind the other (after Carpenter's A-buffer, 1984).
//!
//! Fragments whose ranges of depth touch are parts of one surface, a *layer*: their coverages add up. A layer lies over
//! those behind it. How much of them it hides is judged by a mask of points: surfaces that fill a pixel together, such as
//! the two sides of a fold, leave nothing of the background between them.
//!
//! Surfaces that cut each other within a pixel are one layer too. Their coverages exceed the pixel then, and the excess is
//! shared out by how far their ranges of depth overlap (Carpenter's rule).
//!
//! The order of triangles matters in three cases. If more than [`LAYERS`] surfaces share a pixel, the farthest are merged. A surface in several
//! fragments may cut another one. And the last of 16 bits may be rounded differently.

use crate::{
    coverage::area::Mask,
    format::{COVERAGE, LAYERS},
};

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// The coverage of a whole pixel.
const WHOLE: u32 = 1 << COVERAGE;

/// Part of a surface in a pixel.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Layer {
    /// The nearest inverse depth of the layer in the pixel.
    pub near: u16,
    /// The farthest inverse depth of the layer in the pixel.
    pub far: u16,
    /// The covered area, [`COVERAGE`] fraction bits, at most one pixel; 0 if there is no layer.
    pub coverage: u32,
    /// Where the covered area lies in the pixel.
    pub mask: Mask,
    /// Red, green and blue, times the coverage.
    pub light: [u32; 3],
}

impl Layer {
    /// No surface.
    const NONE: Self = Self { near: 0, far: 0, coverage: 0, mask: 0, light: [0; 3] };

    /// A surface of one colour that covers a part of the pixel.
    #[inline]
    #[must_use]
    pub fn new([near, far]: [u16; 2], coverage: u32, mask: Mask, colour: [u8; 3]) -> Self {
        let coverage = coverage.min(WHOLE);
        Self { near, far, coverage, mask, light: colour.map(|channel| u32::from(channel) * coverage) }
    }

    /// A surface of one colour that covers the whole pixel.
    #[inline]
    #[must_use]
    pub fn whole(range: [u16; 2], colour: [u8; 3]) -> Self {
        Self::new(range, WHOLE, Mask::MAX, colour)
    }

    fn touches(&self, other: &Self) -> bool {
        self.near >= other.far && other.near >= self.far
    }

    /// Adds a fragment of this surface, or of one that cuts it.
    fn join(&mut self, part: &Self) {
        // Both surfaces cover the excess; the nearer one is seen there.
        let excess = (self.coverage + part.coverage).saturating_sub(WHOLE);
        let lead = |near: u16, far: u16| u64::from(near.saturating_sub(far));
        let (lead, behind) = (lead(self.near, part.far), lead(part.near, self.far));
        let lost = (u64::from(excess) * behind).checked_div(lead + behind).map_or(excess / 2, |lost| lost as u32);
        self.hide(lost);
        let mut part = *part;
        part.hide(excess - lost);
        self.near = self.near.max(part.near);
        self.far = self.far.min(part.far);
        self.coverage += part.coverage;
        self.mask |= part.mask;
        for (light, part) in self.light.iter_mut().zip(part.light) {
            *light += part;
        }
    }

    /// Reduces the coverage by `lost`.
    fn hide(&mut self, lost: u32) {
        if lost > 0 {
            let left = u64::from(self.coverage.saturating_sub(lost));
            let kept = |light: u32| (u64::from(light) * left).checked_div(self.coverage.into()).unwrap_or(0) as u32;
            self.light = self.light.map(kept);
            self.coverage = left as u32;
        }
    }

    /// This layer together with the visible part of the layer behind it.
    fn over(mut self, behind: Self) -> Self {
        let left = u64::from(WHOLE.saturating_sub(self.coverage));
        let whole = u64::from(behind.coverage);
        let points = behind.mask.count_ones();
        let free = (behind.mask & !self.mask).count_ones();
        let seen = if self.mask != 0 && self.mask | behind.mask == Mask::MAX {
            left
        } else if points > 0 {
            (whole * u64::from(free) / u64::from(points.max(1))).min(left)
        } else {
            // The layer behind covers no point. It counts as hidden in proportion to the area that this one covers.
            (whole * left) >> COVERAGE
        };
        self.coverage += seen as u32;
        self.mask |= behind.mask;
        for (light, behind) in self.light.iter_mut().zip(behind.light) {
            *light += (u64::from(behind) * seen).checked_div(whole).unwrap_or(0) as u32;
        }
        self.far = behind.far;
        self
    }
}

/// The surfaces in a pixel.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub struct Sample {
    /// The layers from the nearest to the farthest, then empty ones.
    layers: [Layer; LAYERS],
}

impl Sample {
    /// A sample with nothing but background.
    pub const EMPTY: Self = Self { layers: [Layer::NONE; LAYERS] };

    /// Adds a fragment of a surface.
    #[inline(never)]
    pub fn add(&mut self, mut part: Layer) {
        // A fragment may connect layers that did not touch. Each layer that joins widens its range, so all others are looked at again.
        let mut joined = true;
        while joined {
            joined = false;
            for layer in &mut self.layers {
                if layer.coverage > 0 && layer.touches(&part) {
                    part.join(layer);
                    *layer = Layer::NONE;
                    joined = true;
                }
            }
        }
        let layers = core::mem::replace(&mut self.layers, Self::EMPTY.layers);
        let mut part = Some(part);
        for layer in layers.into_iter().filter(|layer| layer.coverage > 0) {
            if let Some(part) = part.take_if(|part| part.near > layer.near) {
                self.push(part);
            }
            self.push(layer);
        }
        if let Some(part) = part {
            self.push(part);
        }
    }

    /// Puts a layer behind all others, if it can be seen there.
    fn push(&mut self, behind: Layer) {
        for layer in &mut self.layers {
            if layer.coverage == 0 {
                *layer = behind;
                return;
            }
            if layer.coverage >= WHOLE {
                return;
            }
        }
        if let Some(last) = self.layers.last_mut() {
            *last = last.over(behind);
        }
    }

    /// The colour of all layers over the background.
    #[must_use]
    pub fn resolve(&self, background: [u8; 3]) -> [u8; 3] {
        let layers = self.layers.iter().copied().filter(|layer| layer.coverage > 0);
        let seen = layers.chain([Layer::whole([0; 2], background)]).reduce(Layer::over).unwrap_or(Layer::NONE);
        seen.light.map(|light| ((light + WHOLE / 2) >> COVERAGE) as u8)
    }
}
