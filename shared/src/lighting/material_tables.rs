//! The colours of a material in a pixel format, computed once.

use crate::{
    features::{COLOURS, LIGHTS},
    format::{BIAS, CHANNEL, COSINE, FULL, INTENSITY, LEVEL, WALK},
    lighting::{
        albedo::Albedo,
        constant_lights::{FACTOR, NeutralRgb, OneLightRamp, OneLightRgb, SummedColours, Sums, Tint, TintLevel, TwoLightsRgb},
        reflectance::{LitMaterial, Reflectance},
    },
    math::vector::zip,
    pixel::{Pixel, by_rows::ByTurns, gamma::Gamma, half_step, ramps::Ramps, steps},
};
use microphong_kernels::Shares;

/// The colours of a material in a pixel format.
#[derive(Clone, Copy, Debug)]
pub struct MaterialTables<'a, C: Pixel> {
    /// Colour of each level of a material of one channel. In three channels under one light, if [`Reflectance::has_ramp`], colours without a
    /// highlight, by the level of the channel that has most diffuse light.
    pub ramps: &'a C::Ramps,
    /// Reflectances of the material, in levels.
    pub reflectance: &'a LitMaterial<'a>,
}

/// Adds half a step of a channel of `bits` bits to a level, Q9.7; the result is Q10.22.
#[inline]
fn rounded(level: i32, bits: u32) -> i32 {
    (level << (CHANNEL - LEVEL)).wrapping_add(half_step(bits))
}

/// The colour of three levels, Q9.7, by a [`crate::pixel::dither::threshold`].
#[inline]
fn mixed<C: Pixel>(levels: [i32; 3], threshold: u32) -> C {
    // Thresholds are 1/64 of half a step.
    C::mixed(zip(levels, C::LEVELS, |level, bits| (level << (CHANNEL - LEVEL)) + threshold as i32 * (half_step(bits) >> 6)))
}

/// Fills the tables of colours of a material, with the curve of a display. In three channels they stay linear, because code that draws them with a
/// curve does not use them.
pub fn fill_ramps<C: Pixel>(ramps: &mut C::Ramps, reflectance: &Reflectance, dither: bool, gamma: Option<&Gamma>) {
    if reflectance.three_channels() {
        // Nobody looks at it then, and products might overflow.
        if !reflectance.has_ramp() {
            return;
        }
        let ([least, most], [gains, ..]) = (reflectance.ramp, &reflectance.gains);
        ramps.fill(dither, |i, threshold| {
            let more = ((i as i32 - BIAS) << LEVEL) - least;
            // By the share of each channel in the one that has most. Guards beyond 255 stay within the word in which colours are rounded.
            let share =
                |level: i32, diffuse: u16| (level + (more * i32::from(diffuse)).checked_div(most).unwrap_or(0)).min(FULL + FULL / 2);
            mixed::<C>(zip(reflectance.ambient, gains.diffuse, share), threshold).stored()
        });
        return;
    }
    ramps.fill(dither, |i, threshold| {
        let level = (i as i32 - BIAS).clamp(0, 255) as u32;
        let channels = zip(reflectance.base, C::LEVELS, |base, depth| {
            let scaled = level * u32::from(base);
            gamma.filter(|_| !C::IS_LIGHT).map_or(scaled, |gamma| gamma.encoded(scaled, depth))
        });
        C::tabled(channels, threshold)
    });
}

impl<'a, C: Pixel> MaterialTables<'a, C> {
    /// The table of colours with the gain of the only light, if the table of highlights holds levels.
    #[inline(always)]
    pub fn one_light_ramp(&self) -> Option<OneLightRamp<'a, C>> {
        let (ramps, [_, diffuse]) = (ByTurns::new(self.ramps.squares()), self.reflectance.ramp);
        let floor = self.reflectance.highlights.floor();
        self.reflectance.holds_levels().then_some(OneLightRamp { ramps, diffuse: diffuse as u16, floor })
    }

    /// The table of colours of a triangle in three channels under the only light, where that has no highlight; `None` unless
    /// [`Reflectance::has_ramp`].
    #[inline]
    pub fn diffuse_ramp(&self) -> Option<OneLightRamp<'a, C>> {
        let (ramps, [ambient, diffuse]) = (ByTurns::new(self.ramps.squares()), self.reflectance.ramp);
        self.reflectance.has_ramp().then(|| OneLightRamp { ramps, diffuse: diffuse as u16, floor: Reflectance::biased(ambient) })
    }

    /// The sums of three channels under the only light, if the material has three. Domain: [`Reflectance::lights`] is 1.
    pub fn one_light_rgb(&self) -> Option<OneLightRgb<'a, C>> {
        self.three_channels().then_some(self.sums())
    }

    /// The colours of a surface whose colour changes from pixel to pixel, for [`ColouredRgb`](super::constant_lights::ColouredRgb) on even rows and on
    /// odd ones. Domain: [`Reflectance::lights`] is 1, three channels.
    #[inline(never)]
    pub(crate) fn coloured(&self) -> [Shares; 2] {
        let ([[even, ..], [odd, ..]], ambient) = (&self.reflectance.reflectance().sums, self.reflectance.pure_ambient());
        [even, odd].map(|sums| zip(*sums, ambient, |sum, ambient| sum.shares(ambient)))
    }

    /// The colours of [`Self::coloured`] where red and blue have the same levels.
    #[inline]
    pub(crate) fn neutral_rgb(&self) -> Option<NeutralRgb<C>> {
        let [[even, ..], _] = &self.reflectance.reflectance().sums;
        NeutralRgb::new(even, self.reflectance.quarter)
    }

    /// The level and the colour of a surface of one colour, `raise` (Q9.7) higher, if the light has no hue and fits a word.
    #[inline(never)]
    pub(crate) fn tint_of(&self, albedo: Albedo, raise: i32) -> Option<(TintLevel, Tint<C>)> {
        if self.reflectance.sums_fit() { self.neutral_rgb()?.tint(albedo.shares(), raise) } else { None }
    }

    /// The sums of [`Self::one_light_rgb`] on a surface of this colour, for even rows and for odd ones.
    #[inline(never)]
    pub(crate) fn painted_sums(&self, albedo: Albedo) -> [Sums; 2] {
        let ([[even, ..], [odd, ..]], ambient) = (&self.reflectance.reflectance().sums, self.reflectance.pure_ambient());
        [even, odd].map(|sums| {
            zip(*sums, zip(ambient, albedo.shares(), |ambient, share| (ambient, share)), |sum, (ambient, share)| {
                sum.painted(ambient, share)
            })
        })
    }

    /// Whether the material has three channels. Formats of greys never have, so the compiler leaves this code out for them.
    fn three_channels(&self) -> bool {
        !C::GRAY && self.reflectance.three_channels()
    }

    /// The sums of three channels under the first light.
    #[inline]
    fn sums(&self) -> OneLightRgb<'a, C> {
        let [[even, ..], [odd, ..]] = &self.reflectance.reflectance().sums;
        OneLightRgb(ByTurns::new([even, odd]))
    }

    /// The sums of three channels under two lights in the order of the stream, and in the other, if [`Reflectance::lights`] is 2.
    #[inline]
    pub fn two_lights_rgb(&self) -> Option<[TwoLightsRgb<'a, C>; 2]> {
        let [even, odd] = &self.reflectance.reflectance().sums;
        let forth = ByTurns::new([even.first_chunk()?, odd.first_chunk()?]);
        let back = ByTurns::new([even.last_chunk()?, odd.last_chunk()?]);
        (LIGHTS && COLOURS && !C::GRAY && self.reflectance.lights == 2).then_some([TwoLightsRgb(forth), TwoLightsRgb(back)])
    }

    /// The colours where light is summed. Domain: [`Reflectance::sums_lights`].
    #[inline]
    pub(crate) fn summed_colours(&self) -> SummedColours<'a, C> {
        let (OneLightRgb(ambient), [greys, _]) = (self.sums(), self.ramps.squares());
        SummedColours { ambient, greys, bits: CHANNEL - INTENSITY - self.reflectance.excess() }
    }

    /// The colour under one light from `[N·L, N·H]` (Q2.30), on even rows and on odd ones.
    #[inline]
    pub fn one_light(&self, cosines: [i32; 2]) -> [C::Stored; 2] {
        if self.three_channels() { self.one_light_mixed(cosines) } else { self.tint(self.reflectance.level(cosines)) }
    }

    /// [`Self::one_light`] in three channels.
    #[inline(never)]
    fn one_light_mixed(self, [cosine, half]: [i32; 2]) -> [C::Stored; 2] {
        match self.reflectance.highlight(half) {
            0 if self.reflectance.has_ramp() => self.tint(self.reflectance.ramp_level(cosine)),
            highlight if self.reflectance.sums_fit() => self.sums().by_turns(cosine >> (COSINE - FACTOR), highlight),
            highlight => self.mixed_by_turns(self.reflectance.reflection(cosine, highlight)),
        }
    }

    /// The colour of three levels, Q9.7, on even rows and on odd ones.
    #[inline(always)]
    pub fn colour(&self, levels: [i32; 3]) -> [C::Stored; 2] {
        if !self.three_channels() {
            return self.tint(levels[0]);
        }
        self.mixed_by_turns(levels)
    }

    /// [`Self::colour`] in three channels.
    #[inline(always)]
    fn mixed_by_turns(&self, levels: [i32; 3]) -> [C::Stored; 2] {
        let [r, g, b] = zip(levels, C::LEVELS, rounded);
        let [r_more, g_more, b_more] = steps(C::DEPTH, self.reflectance.quarter);
        let even = C::mixed([r - r_more, g - g_more, b - b_more]).stored();
        if C::Ramps::CHECKERED { [even, C::mixed([r + r_more, g + g_more, b + b_more]).stored()] } else { [even; 2] }
    }

    /// The colour of a level, Q9.7, of a material of one channel, as its tables hold it for even rows and for odd ones.
    #[inline]
    pub fn tint(&self, level: i32) -> [C::Stored; 2] {
        let ([even, odd], level) = (self.ramps.squares(), Reflectance::biased(level) << (WALK - LEVEL));
        [C::entry(even, level, WALK), C::entry(odd, level, WALK)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        format::{COSINE, RAMP, UNIT},
        math::highlight_lut::Highlight,
        pixel::{Channels, PixelFormat},
        stream::record::{Light, Material},
    };
    use embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
    use proptest::prelude::*;
    use zerocopy::FromZeros;

    /// The reflectance of a material under one light in the pixel format `C`.
    fn reflectance<C: Pixel>(material: &Material, colour: [u16; 3]) -> Reflectance {
        let mut reflectance = Reflectance::new_zeroed();
        reflectance.fill(
            Channels::of::<C>(),
            [1 << UNIT; 3],
            material,
            &[Light { colour, ..Light::new_zeroed() }],
            (Highlight::Half, false),
            [false; 2],
        );
        reflectance
    }

    /// Light that does not fit a word is as bright as possible, with dither or without. It does not wrap to black.
    #[test]
    fn the_brightest_light_does_not_wrap() {
        for gain in (1u16 << 11..1 << 15).step_by(499) {
            let material = Material { ambient: [gain; 3], diffuse: [gain, gain / 2, 0], specular: [gain; 3], exponent: 30 };
            let mut reflectance = reflectance::<Rgb565>(&material, [1 << UNIT; 3]);
            for _ in 0..2 {
                let tables = MaterialTables::<Rgb565> { ramps: &[[0; RAMP]; 2], reflectance: &LitMaterial::new(&reflectance, None) };
                let exact = reflectance.reflection(1 << COSINE, 1 << 16);
                let colours = tables.one_light([1 << COSINE, 1 << COSINE]).map(|stored| Rgb565::from_stored(stored).channels());
                for (colour, turn) in colours.into_iter().zip([-1, 1]) {
                    let quarter = reflectance.quarter * turn;
                    let expected = zip(exact, Rgb565::DEPTH, |level, depth| {
                        let level = ((level + (1 << (LEVEL + 7 - depth))) << (CHANNEL - LEVEL)) + (quarter << (8 - depth));
                        (level >> (CHANNEL + 8 - depth)).min((1 << depth) - 1)
                    });
                    let differences = zip(colour, expected, |colour, expected| (i32::from(colour) - expected).abs());
                    assert!(differences.into_iter().all(|difference| difference <= 1), "{gain}: {colour:?} {expected:?}");
                }
                reflectance.dither();
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(500))]
        /// Without a highlight, the table of colours has the colour of three channels, or its neighbour.
        #[test]
        fn colours_without_a_highlight_lie_on_a_line(
            ambient in prop::array::uniform3(0u16..1 << 13),
            diffuse in prop::array::uniform3(0u16..1 << 13),
            light in prop::array::uniform3(0u16..1 << UNIT),
        ) {
            let material = Material { ambient, diffuse, specular: [1 << 13; 3], exponent: 30 };
            prop_assert!(!reflectance::<Rgb888>(&material, light).has_ramp() || !reflectance::<Rgb888>(&material, light).three_channels());
            let reflectance = reflectance::<Rgb565>(&material, light);
            prop_assume!(reflectance.three_channels());
            prop_assert!(reflectance.has_ramp());
            let mut ramps = [[0; RAMP]; 2];
            fill_ramps::<Rgb565>(&mut ramps, &reflectance, false, None);
            let tables = MaterialTables::<Rgb565> { ramps: &ramps, reflectance: &LitMaterial::new(&reflectance, None) };
            for cosine in (-4..=64).map(|c| c << (COSINE - 6)) {
                let [exact, _] = tables.colour(reflectance.reflection(cosine, 0)).map(|stored| Rgb565::from_stored(stored).channels());
                let [tabled, _] = tables.tint(reflectance.ramp_level(cosine)).map(|stored| Rgb565::from_stored(stored).channels());
                let differences = zip(exact, tabled, u8::abs_diff);
                prop_assert!(differences.into_iter().all(|difference| difference <= 1), "{cosine}: {exact:?} {tabled:?}");
            }
        }
    }
}
