//! Colours at the corners of triangles, by which ambient and diffuse light are multiplied.
//!
//! The level of a node is its colour times what the material reflects of ambient and diffuse light, plus its highlights. So methods that interpolate
//! levels need nothing else. Methods that compute light at each pixel interpolate the colour linearly beside it.
//!
//! Error: levels are rounded to the nearest, and white changes none. At a vertex under more than 512 of 255 they are rounded to as many bits as the
//! largest of them has more than 16.

use crate::{
    arch::product::unsigned_product,
    features::COLOURED,
    format::{FULL, LEVEL},
    math::vector::{map, zip},
    stream::record::Colour,
};
use core::num::NonZeroU32;

/// A value for a mesh with colours at its corners: there is room for none in a program without the feature.
pub(crate) type IfColoured<T> = [T; COLOURED];

/// The colour of a surface at a point: shares of red, green and blue light, unsigned Q0.16 with 65,535 for all of it. Whole words are copied without a
/// call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Albedo {
    /// Red in the lower half, green in the upper one.
    red_green: u32,
    blue: u32,
}

/// The levels of ambient and diffuse light, Q9.7 or more bits, and those of highlights, which no colour changes.
#[derive(Clone, Copy, Debug)]
pub struct Parts {
    /// Ambient and diffuse light.
    pub(crate) diffuse: [i32; 3],
    /// Highlights.
    pub(crate) specular: [i32; 3],
}

/// Bits of a share.
pub(crate) const SHARE: u32 = 16;
/// Place of the number of fraction bits that highlights of a vertex lack.
const SPECULAR: u32 = 8;
/// Largest level of a part.
const MOST: i32 = (1 << (LEVEL + 9)) - 1;

impl Albedo {
    /// All light is reflected.
    pub(crate) const WHITE: Self = Self { red_green: u32::MAX, blue: 0xFFFF };

    /// A colour of a palette. In greys all shares are that of its luma, by the weights of Rec. 601.
    #[inline]
    pub(crate) fn new(Colour { channels: [r, g, b], .. }: Colour, is_gray: bool) -> Self {
        let (r, g, b) = (u32::from(r), u32::from(g), u32::from(b));
        if is_gray {
            let luma = ((r * 77 + g * 150 + b * 29) * 257) >> 8;
            return Self { red_green: luma | luma << 16, blue: luma };
        }
        // From 255 to 65,535, two at once.
        Self { red_green: (r | g << 16) * 257, blue: b * 257 }
    }

    /// The colour of three shares.
    #[inline]
    fn of([r, g, b]: [u16; 3]) -> Self {
        Self { red_green: u32::from(r) | u32::from(g) << 16, blue: b.into() }
    }

    /// The three shares.
    #[inline]
    fn channels(self) -> [u16; 3] {
        [self.red_green as u16, (self.red_green >> 16) as u16, self.blue as u16]
    }

    /// Three colours of a palette, see [`Self::new`].
    #[inline(never)]
    pub(crate) fn all([a, b, c]: [Colour; 3], is_gray: bool) -> [Self; 3] {
        [Self::new(a, is_gray), Self::new(b, is_gray), Self::new(c, is_gray)]
    }

    /// The colour of these shares, which lie in [0, 65,535].
    #[inline]
    pub(crate) fn of_shares(shares: [i32; 3]) -> Self {
        Self::of(map(shares, |share| share as u16))
    }

    /// The shares of the three channels.
    #[inline]
    pub(crate) fn shares(self) -> [i32; 3] {
        map(self.channels(), i32::from)
    }

    /// The colour on the way from `self` to `other`, at a share of it in Q0.16.
    #[inline]
    pub(crate) fn towards(self, other: Self, share: u16) -> Self {
        let (from, to) = (65_536 - u32::from(share), u32::from(share));
        Self::of(zip(self.channels(), other.channels(), |a, b| ((u32::from(a) * from + u32::from(b) * to) >> 16) as u16))
    }

    /// The mean of three colours with these weights, whose sum is at most 65,536.
    #[inline]
    pub(crate) fn mean(corners: &[Self; 3], [u, v, w]: [u32; 3]) -> Self {
        let [a, b, c] = map(*corners, Self::channels);
        let sum = NonZeroU32::new(u + v + w).unwrap_or(NonZeroU32::MIN);
        let (weighted, pair) = (|share: u16, weight: u32| u32::from(share) * weight, |a: u16, b: u16| (a, b));
        Self::of(zip(zip(a, b, pair), c, |(a, b), c| ((weighted(a, u) + weighted(b, v) + weighted(c, w)) / sum) as u16))
    }

    /// The least and the largest share of a channel at three corners.
    #[inline]
    fn extremes(corners: &[Self; 3]) -> [(u16, u16); 3] {
        let [a, b, c] = map(*corners, Self::channels);
        zip(zip(a, b, |a, b| (a.min(b), a.max(b))), c, |(least, most), c| (least.min(c), most.max(c)))
    }

    /// The largest difference of a channel between three corners.
    #[inline]
    pub(crate) fn range(corners: &[Self; 3]) -> u32 {
        let [r, g, b] = map(Self::extremes(corners), |(least, most)| u32::from(most - least));
        r.max(g).max(b)
    }

    /// The colour of three corners; `None` if they differ.
    #[inline]
    pub(crate) fn one(&[a, b, c]: &[Self; 3]) -> Option<Self> {
        (a == b && b == c).then_some(a)
    }

    /// The colour whose channels lie half-way between the extremes at three corners.
    #[inline]
    pub(crate) fn half_way(corners: &[Self; 3]) -> Self {
        Self::of(map(Self::extremes(corners), |(least, most)| least + ((most - least) >> 1)))
    }

    /// The levels of a vertex that holds [`Parts`], at a corner of this colour.
    #[inline]
    pub(crate) fn lit_vertex(self, [r, g, b, spare]: [i32; 4]) -> [i32; 3] {
        // In words, and so without an array of each part. What is wanted of the fourth number stands in its lower bits.
        let lit = |parts: i32, share: u16| {
            let (diffuse, specular) = (parts as u32 & MOST as u32, parts as u32 >> SHARE << (spare as u32 >> SPECULAR & 31));
            let bits = SHARE.wrapping_sub(spare as u32) & 31;
            (((diffuse * u32::from(share) + (1 << (SHARE - 1))) >> bits) + specular).min(FULL as u32) as i32
        };
        let [red, green, blue] = self.channels();
        [lit(r, red), lit(g, green), lit(b, blue)]
    }

    /// The levels of a surface of this colour, Q9.7 in [0, 255].
    #[inline]
    pub(crate) fn lit(self, Parts { diffuse, specular }: Parts) -> [i32; 3] {
        let reflected =
            zip(diffuse, self.channels(), |level, share| (unsigned_product(level as u32, share.into()) + (1 << (SHARE - 1))) >> SHARE);
        zip(reflected, specular, |reflected, specular| (reflected as i32 + specular).min(FULL))
    }
}

impl Parts {
    /// The parts that [`Self::packed`] has packed. Those of more than 512 have lost fraction bits.
    pub(crate) fn unpacked([r, g, b, spare]: [i32; 4]) -> Self {
        let (packed, more) = ([r, g, b], spare >> SPECULAR);
        Self {
            diffuse: map(packed, |parts| (parts & MOST) << (spare & 31)),
            specular: map(packed, |parts| ((parts as u32 >> SHARE) << (more & 31)) as i32),
        }
    }

    /// The parts as a vertex holds them. Where light exceeds 512, which a dark colour or a corner without light can make visible, its levels have fewer
    /// fraction bits: the fourth number says how many, for ambient and diffuse light in its lower bits and for highlights from [`SPECULAR`] on.
    #[inline]
    pub(crate) fn packed(self) -> [i32; 4] {
        let spare = |[r, g, b]: [i32; 3]| ((r | g | b) as u32 >> SHARE).checked_ilog2().map_or(0, |bits| bits as i32 + 1);
        let (spare, more) = (spare(self.diffuse), spare(self.specular));
        let pack = |diffuse: i32, specular: i32| diffuse >> (spare & 31) | specular >> (more & 31) << SHARE;
        let [x, y, z] = zip(self.diffuse, self.specular, pack);
        [x, y, z, spare | more << SPECULAR]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const WHITE: Colour = Colour::new([255; 3]);

    proptest! {
        #[test]
        fn levels_are_the_nearest(levels in prop::array::uniform3(0..=FULL), specular in prop::array::uniform3(0..=FULL), channels in prop::array::uniform3(0u8..)) {
            let parts = Parts { diffuse: levels, specular };
            let white = Albedo::new(WHITE, false).lit(parts);
            prop_assert_eq!(white, zip(levels, specular, |a, b| (a + b).min(FULL)));
            let lit = Albedo::new(Colour::new(channels), false).lit(parts);
            prop_assert_eq!(lit, Albedo::new(Colour::new(channels), false).lit_vertex(parts.packed()));
            for k in 0..3 {
                let exact = f64::from(levels[k]) * f64::from(channels[k]) / 255.0 + f64::from(specular[k]);
                prop_assert!((f64::from(lit[k]) - exact.min(f64::from(FULL))).abs() <= 1.0);
            }
        }

        /// Vertices keep 16 bits of the largest level.
        #[test]
        fn bright_light_keeps_its_largest_bits(diffuse in prop::array::uniform3(0..=8 * FULL), specular in prop::array::uniform3(0..=16 * FULL)) {
            let parts = Parts { diffuse, specular };
            let unpacked = Parts::unpacked(parts.packed());
            for (levels, kept) in [(diffuse, unpacked.diffuse), (specular, unpacked.specular)] {
                let lost = levels.iter().fold(0, |most, &level| most.max(level)) >> SHARE;
                prop_assert!(zip(levels, kept, |level, kept| (0..=2 * lost).contains(&(level - kept))) == [true; 3], "{levels:?} {kept:?}");
            }
            let lit = Albedo::new(WHITE, false).lit_vertex(parts.packed());
            let exact = Albedo::new(WHITE, false).lit(parts);
            prop_assert!(zip(lit, exact, |lit, exact| (exact - lit).abs() <= 32) == [true; 3], "{lit:?} {exact:?}");
        }
    }

    #[test]
    fn greys_have_the_luma_of_a_colour() {
        let gray = |channels| Albedo::new(Colour::new(channels), true).shares();
        assert_eq!(gray([255; 3]), [65_535; 3]);
        assert_eq!(gray([255, 0, 0]), [(77 * 255 * 257) >> 8; 3]);
    }
}
