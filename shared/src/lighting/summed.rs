//! The diffuse light of any number of constant lights as one sum for each channel.
//!
//! A light with N·L >= 0 at all corners of a triangle reaches all of it, where N·L is linear. So the diffuse light of all such lights is a linear sum in
//! each channel, which a pixel divides by |N| once, however many lights there are. A light with N·L <= 0 at all corners adds nothing. What is left are
//! lights that end on the triangle, and lights with a highlight that can be seen there: each of them is added by itself.
//!
//! A vertex holds the sums of what all lights add there, and for each light the side on which it lies. The sky's light (1 + N·L)/2 never ends: half of
//! it is ambient.

use crate::{
    format::{COSINE, NORMAL_LENGTH},
    lighting::{
        constant_lights::FACTOR,
        lights::{Source, vertex_cosine},
        reflectance::{Reflectance, node_cosine},
    },
};

/// For each light, as a bit of its number: whether vertices lie on its bright side, on its dark side, and where a highlight may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Sides(u32);

/// Bits of one kind of [`Sides`].
const KIND: u32 = 8;

impl Sides {
    const BRIGHT: Self = Self(1);
    const DARK: Self = Self(1 << KIND);
    const HIGHLIGHT: Self = Self(1 << (2 * KIND));

    /// The sides of all corners of a triangle, whose interpolated normals are at least `min_normal_length` (Q1.[`NORMAL_LENGTH`]) long: bright and dark
    /// where all corners are, and a highlight where one may have it, or where normals may be so short that any place between them may.
    #[inline]
    pub(crate) fn of_triangle([a, b, c]: [i32; 3], min_normal_length: u16) -> Self {
        let (all, any) = (a & b & c, a | b | c);
        let highlights = Self::HIGHLIGHT.0 * 0xff;
        let may_have = if min_normal_length >= LEAST_LENGTH << (NORMAL_LENGTH - 4) { any as u32 } else { highlights };
        Self(all as u32 & (highlights - 1) | may_have & highlights)
    }

    /// The sides of a vertex.
    #[inline]
    pub(crate) fn of_vertex(sides: i32) -> Self {
        Self(sides as u32)
    }

    /// Whether light number `light` reaches all of the triangle.
    #[inline]
    pub(crate) fn is_bright(self, light: usize) -> bool {
        self.has(Self::BRIGHT, light)
    }

    /// Whether light number `light` reaches nothing of the triangle.
    #[inline]
    pub(crate) fn is_dark(self, light: usize) -> bool {
        self.has(Self::DARK, light)
    }

    /// Whether light number `light` may have a highlight on the triangle.
    #[inline]
    pub(crate) fn may_have_highlight(self, light: usize) -> bool {
        self.has(Self::HIGHLIGHT, light)
    }

    /// Whether each of `lights` reaches all of the triangle or nothing of it.
    #[inline]
    pub(crate) fn are_whole(self, lights: usize) -> bool {
        let all = (1u32 << (lights as u32 & 31)) - 1;
        (self.0 | self.0 >> KIND) & all == all
    }

    #[inline]
    fn has(self, side: Self, light: usize) -> bool {
        self.0 & (side.0 << light) != 0
    }
}

/// Normals that are interpolated to at least this length, as a part of 16, have a highlight only where a corner may have it.
const LEAST_LENGTH: u16 = 15;

/// The sums of diffuse light at a vertex in each channel, Q10.22 less the bits of [`Reflectance::excess`], and its [`Sides`].
pub(crate) fn at_vertex(reflectance: &Reflectance, sources: &[Source], normal: [i32; 3]) -> [i32; 4] {
    let faintest = reflectance.faintest();
    // Corners are compared before the division by the length of the normal.
    let faintest = faintest - (faintest.max(0) >> 4);
    let (mut sums, mut sides) = ([0; 3], 0);
    for (light, source) in sources.iter().enumerate() {
        let Some(&[towards, half]) = source.directional() else { continue };
        let cosine = vertex_cosine(normal, towards);
        sums = reflectance.factors(light).add_at(sums, part(source, cosine));
        let mut side = if cosine >= 0 || source.is_sky() { Sides::BRIGHT.0 } else { 0 };
        if !source.is_sky() {
            side |= if cosine <= 0 { Sides::DARK.0 } else { 0 };
            side |= if vertex_cosine(normal, half) >= faintest { Sides::HIGHLIGHT.0 } else { 0 };
        }
        sides |= side << (light as u32 & 31);
    }
    let [r, g, b] = sums;
    [r, g, b, sides as i32]
}

/// The part of a light's diffuse light that is added to the sums of a vertex with this N·L, Q1.15.
#[inline]
pub(crate) fn part(source: &Source, cosine: i32) -> i32 {
    // Of the sky, what is left without its half that is ambient.
    if source.is_sky() { cosine >> (COSINE - FACTOR + 1) } else { node_cosine(cosine) }
}
