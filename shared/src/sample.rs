//! What is seen through one pixel: parts of surfaces, one behind the other (after Carpenter's A-buffer, 1984).
//!
//! Fragments whose ranges of depth touch are parts of one surface, a *layer*: their coverages add up. A layer lies over
//! those behind it, which show through by what it leaves uncovered.
//!
//! The order of triangles matters in two cases only: where more than [`LAYERS`] surfaces share a pixel, of which the
//! farthest are then made one; and, by rounding, in the last bit. Surfaces that meet within a pixel are one layer: where
//! its coverages exceed the pixel, it is their mean.

use crate::format::{COVERAGE, LAYERS};

/// A wholly covered pixel.
const WHOLE: u32 = 1 << COVERAGE;

/// Part of a surface in a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layer {
    /// Range of nearness.
    pub near: u16,
    /// Its far end.
    pub far: u16,
    /// [`COVERAGE`] fraction bits; 0: there is none. More than one where surfaces meet.
    pub coverage: u32,
    /// Channels times coverage.
    pub light: [u32; 3],
}

impl Layer {
    /// No surface.
    const NONE: Self = Self { near: 0, far: 0, coverage: 0, light: [0; 3] };

    /// A surface of one colour.
    #[inline]
    #[must_use]
    pub fn new([near, far]: [u16; 2], coverage: u32, colour: [u8; 3]) -> Self {
        Self { near, far, coverage, light: colour.map(|channel| u32::from(channel) * coverage) }
    }

    fn touches(&self, other: &Self) -> bool {
        self.near >= other.far && other.near >= self.far
    }

    /// Adds another part of the same surface.
    fn join(&mut self, other: &Self) {
        self.near = self.near.max(other.near);
        self.far = self.far.min(other.far);
        self.coverage = self.coverage.saturating_add(other.coverage);
        for (light, other) in self.light.iter_mut().zip(other.light) {
            *light = light.saturating_add(other);
        }
    }

    /// No more than the pixel: where surfaces meet, their mean.
    fn limited(mut self) -> Self {
        if self.coverage > WHOLE {
            let coverage = u64::from(self.coverage);
            self.light = self.light.map(|light| ((u64::from(light) << COVERAGE).checked_div(coverage).unwrap_or(0)) as u32);
            self.coverage = WHOLE;
        }
        self
    }

    /// With what is seen of the layer behind it.
    fn over(self, behind: Self) -> Self {
        let (mut front, behind) = (self.limited(), behind.limited());
        let left = WHOLE - front.coverage;
        let seen = |part: u32| ((u64::from(part) * u64::from(left)) >> COVERAGE) as u32;
        front.coverage += seen(behind.coverage);
        for (light, behind) in front.light.iter_mut().zip(behind.light) {
            *light += seen(behind);
        }
        front.far = behind.far;
        front
    }
}

/// The surfaces in a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// The nearest first, then those behind, then none.
    layers: [Layer; LAYERS],
}

impl Sample {
    /// Nothing but background.
    pub const EMPTY: Self = Self { layers: [Layer::NONE; LAYERS] };

    /// Adds a part of a surface.
    #[inline(never)]
    pub fn add(&mut self, mut part: Layer) {
        // It may connect layers that did not touch: each that joins is looked at once, and the range has grown for the next.
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

    /// The colour of all layers over the background's.
    #[must_use]
    pub fn resolve(&self, background: [u8; 3]) -> [u8; 3] {
        let ground = Layer::new([0; 2], WHOLE, background);
        let sum = self.layers.iter().rev().filter(|layer| layer.coverage > 0).fold(ground, |behind, layer| layer.over(behind));
        sum.light.map(|light| ((light + WHOLE / 2) >> COVERAGE) as u8)
    }
}
