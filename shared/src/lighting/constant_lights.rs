//! The colours of a material under constant lights, for pixel loops. Diffuse light is walked, and highlights are looked up.

use crate::{
    arch::product::{unsigned_product, upper},
    format::{BIAS, CHANNEL, COSINE, INTENSITY, LEVEL, RAMP},
    lighting::albedo::SHARE,
    math::{
        highlight_lut::ENTRY,
        vector::{map, zip},
    },
    pixel::{
        Pixel,
        by_rows::{ByRows, ByTurns},
        half_step,
        ramps::Ramps,
        steps,
    },
    stream::record::Colour,
};
use microphong_kernels::{self as kernels, Shares};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, transmute_ref};

/// A light with a highlight: a walked diffuse level, negative where there is no light, and an entry of the table of highlights.
#[derive(Clone, Copy, Debug)]
pub struct WithHighlight(pub i32, pub u32);

/// A light without a highlight: a walked diffuse level, negative where there is no light.
#[derive(Clone, Copy, Debug)]
pub struct DiffuseOnly(pub i32);

/// The diffuse light of several lights in each channel: levels, Q10 with [`SUMMED`] fraction bits.
#[derive(Clone, Copy, Debug)]
pub struct Summed(pub [i32; 3]);

/// Light on a surface whose colour changes from pixel to pixel, and that colour: shares of red, green and blue, Q1.[`COLOUR`].
#[derive(Clone, Copy, Debug)]
pub struct Coloured<L>(pub L, pub [u32; 3]);

/// Fraction bits of a walked colour.
pub const COLOUR: u32 = 29;

/// The colour of a surface at a pixel.
pub(crate) trait SurfaceColour {
    /// Its shares of red, green and blue, Q1.[`COLOUR`].
    fn shares(self) -> [u32; 3];
}

/// Walked shares.
impl SurfaceColour for [u32; 3] {
    #[inline]
    fn shares(self) -> [u32; 3] {
        self
    }
}

/// The colour of a texel.
impl SurfaceColour for Colour {
    #[inline]
    fn shares(self) -> [u32; 3] {
        let Self { channels: [r, g, b], .. } = self;
        // From 255 to 65,535 of 65,536.
        let share = |channel: u8| u32::from(channel) * (257 << (COLOUR - SHARE));
        [share(r), share(g), share(b)]
    }
}

/// Multiplies a level by a walked share. Both levels have one format, in which they are not negative.
#[inline]
fn painted(level: i32, share: u32) -> i32 {
    // 16 bits of each make a word. At the rim of a triangle a share may be a little less than 0.
    (level >> 15).wrapping_mul((share as i32) >> (COLOUR - 15))
}

/// Fraction bits of [`Summed`].
pub const SUMMED: u32 = CHANNEL - 3;

impl From<DiffuseOnly> for WithHighlight {
    #[inline]
    fn from(DiffuseOnly(diffuse): DiffuseOnly) -> Self {
        Self(diffuse, 0)
    }
}

/// The colours of a material under constant lights.
pub trait LitColours: ByRows {
    /// The pixel that is stored.
    type Pixel: Pixel;

    /// Whether a level gives a colour, so that light without a highlight can be fitted and walked as one level.
    const TABLED: bool = false;

    /// See [`PixelShader::TRANSPARENT`](crate::raster::pixel_shader::PixelShader::TRANSPARENT).
    const TRANSPARENT: bool = true;

    /// The diffuse level at cosine 1, Q9.7: the unit in which diffuse light is walked. Unless colours are tabled, it is half of the walked range, so
    /// that cosines and their overshoots fit.
    fn diffuse(&self) -> u16 {
        1 << (FULL_BITS + LEVEL)
    }

    /// Whether no diffuse level is above 255.
    #[inline]
    fn is_within(&self) -> bool {
        self.diffuse() <= 255 << LEVEL
    }
}

/// Makes the colour of a pixel of light: [`WithHighlight`] or [`DiffuseOnly`], or a pair of them for two lights.
pub trait Shades<L>: LitColours {
    /// The colour of light whose diffuse levels have `bits` fraction bits.
    fn colour(&self, bits: u32, light: L) -> Self::Pixel;

    /// The number of planes that the patch lends to a kernel in assembler; 0 if there is no kernel.
    const NUMERATORS: usize = 0;

    /// The kernel.
    #[inline]
    fn lit<'a>(&'a self, _: kernels::Lookup<'a>) -> Option<kernels::Lit<'a>> {
        None
    }
}

/// Fraction bits of the diffuse levels of kernels.
pub(crate) const KERNEL_BITS: u32 = 19;

// Kernels contain these numbers as constants.
const _: () = assert!(KERNEL_BITS + FULL_BITS - FACTOR == 11 && CHANNEL == 22 && LEVEL == 7 && COLOUR == 29 && RAMP == 512);

/// A light whose type tells whether it has a highlight.
pub trait MayHaveHighlight: Into<WithHighlight> {
    /// 1 if it has a highlight.
    const HIGHLIGHTS: usize;
}

impl MayHaveHighlight for WithHighlight {
    const HIGHLIGHTS: usize = 1;
}

impl MayHaveHighlight for DiffuseOnly {
    const HIGHLIGHTS: usize = 0;
}

/// The diffuse level of a node of this cosine (Q2.30), of a material with the level `full` (Q9.7) at cosine 1, in Q10 with `bits` fraction
/// bits, at most 20, rounded down.
#[inline]
pub fn node(full: u16, cosine: i32, bits: u32) -> i32 {
    upper(cosine, i32::from(full) << 15) >> (COSINE + LEVEL - 17 - bits)
}

/// A table of colours, indexed by the diffuse level plus an entry of the table of highlights. These entries are levels of highlight and ambient
/// light. In one channel the level is all of the light, in three channels it is one light without a highlight.
#[derive(Clone, Copy, Debug)]
pub struct OneLightRamp<'a, C: Pixel> {
    pub(super) ramps: ByTurns<&'a [C::Stored; RAMP], C>,
    pub(super) diffuse: u16,
    /// The level without diffuse light and highlight, as an entry of the table of highlights.
    pub(super) floor: u32,
}

impl<C: Pixel> ByRows for OneLightRamp<'_, C> {
    fn step_row(&mut self) {
        self.ramps.step_row();
    }
}

impl<C: Pixel> LitColours for OneLightRamp<'_, C> {
    type Pixel = C;

    const TABLED: bool = true;

    fn diffuse(&self) -> u16 {
        self.diffuse
    }
}

impl<C: Pixel> Shades<WithHighlight> for OneLightRamp<'_, C> {
    fn colour(&self, bits: u32, WithHighlight(diffuse, highlight): WithHighlight) -> C {
        C::ramped(self.ramps.now(), (diffuse.max(0) as u32).wrapping_add(highlight << (bits - LEVEL)), bits)
    }

    const NUMERATORS: usize = 2;

    #[inline]
    fn lit<'k>(&'k self, lookup: kernels::Lookup<'k>) -> Option<kernels::Lit<'k>> {
        let [even, odd] = self.ramps.both();
        C::lit(kernels::Colours::Table([C::entries(even)?, C::entries(odd)?]), 1, lookup)
    }
}

impl<C: Pixel> Shades<DiffuseOnly> for OneLightRamp<'_, C> {
    fn colour(&self, bits: u32, DiffuseOnly(diffuse): DiffuseOnly) -> C {
        self.colour(bits, WithHighlight(diffuse, self.floor))
    }

    const NUMERATORS: usize = 1;

    #[inline]
    fn lit<'k>(&'k self, lookup: kernels::Lookup<'k>) -> Option<kernels::Lit<'k>> {
        let [even, odd] = self.ramps.both();
        let lookup = kernels::Lookup { top: (self.floor << (KERNEL_BITS - LEVEL)) as i32, ..lookup };
        C::lit(kernels::Colours::Table([C::entries(even)?, C::entries(odd)?]), 0, lookup)
    }
}

impl<C: Pixel> OneLightRamp<'_, C> {
    /// The colour where there is neither diffuse light nor a highlight, on even rows and on odd ones.
    pub fn unlit(&self) -> [C::Stored; 2] {
        self.ramps.both().map(|ramp| C::entry(ramp, self.floor, LEVEL))
    }
}

/// Three channels, each the sum of two products: of the cosine and of the highlight with the material's reflectances.
#[derive(Clone, Copy, Debug)]
pub struct OneLightRgb<'a, C>(pub(super) ByTurns<&'a Sums, C>);

/// Three channels under two lights: the sums of [`OneLightRgb`] for the first, and the addends of the second. The second cosine is rounded down, by
/// at most 1/128 of a level.
#[derive(Clone, Copy, Debug)]
pub struct TwoLightsRgb<'a, C>(pub(super) ByTurns<&'a [Sums; 2], C>);

/// The factors of [`OneLightRgb`] for each channel. In Q10.22 the sum of all three is below 2^31.
pub type Sums = [Sum; 3];

/// The factors of one channel.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub struct Sum {
    /// The level of ambient light plus a constant for rounding, Q10.22.
    pub(super) ambient: i32,
    /// The level of diffuse light at cosine 1, Q9.7.
    diffuse: i32,
    /// The level of a whole highlight, Q9.6.
    specular: i32,
}

/// Fraction bits of a cosine that is multiplied by a diffuse level.
pub(crate) const FACTOR: u32 = CHANNEL - LEVEL;
/// [`LitColours::diffuse`] is 2 to this power, if colours are not tabled.
const FULL_BITS: u32 = 7;

impl Sum {
    /// The factors for a level of ambient light with a constant for rounding, Q10.22, and levels of diffuse and specular light, Q9.7.
    pub(super) fn new(ambient: i32, diffuse: u16, specular: u16) -> Self {
        Self { ambient, diffuse: diffuse.into(), specular: (i32::from(specular) + 1) >> 1 }
    }

    /// What the light adds at a pixel, from a cosine, Q1.15, and a highlight, unsigned Q0.16; Q10.22.
    #[inline]
    pub(super) fn light(&self, cosine: i32, highlight: i32) -> i32 {
        self.diffuse.wrapping_mul(cosine).wrapping_add(self.specular.wrapping_mul(highlight))
    }

    /// The sum on a surface that reflects a `share` of ambient and diffuse light, Q0.16. `ambient` is the level of ambient light alone.
    #[inline]
    pub(super) fn painted(self, ambient: i32, share: i32) -> Self {
        let reflected = |level: i32| (unsigned_product(level as u32, share as u32) >> SHARE) as i32;
        let lit = reflected(ambient);
        Self {
            ambient: self.ambient.wrapping_sub(ambient).wrapping_add(lit),
            diffuse: ((self.diffuse as u32 * share as u32 + (1 << (SHARE - 1))) >> SHARE) as i32,
            ..self
        }
    }

    /// The sum as a channel of [`ColouredRgb`]. `ambient` is the level of ambient light alone.
    pub(super) fn shares(&self, ambient: i32) -> [i32; 4] {
        [self.ambient.wrapping_sub(ambient), ambient, self.diffuse, self.specular]
    }

    /// Adds `by` to all levels, Q10.22. A sum that overflows is not used.
    pub(super) fn raised(self, by: i32) -> Self {
        Self { ambient: self.ambient.wrapping_add(by), ..self }
    }

    /// The level, Q10.22, from a cosine, Q1.15, and a highlight, unsigned Q0.16.
    #[inline]
    fn level(&self, cosine: i32, highlight: i32) -> i32 {
        self.ambient.wrapping_add(self.light(cosine, highlight))
    }

    /// [`Self::level`] with the highlight added first. Only measurement tells which order leaves loops more registers.
    #[inline]
    fn level_from_highlight(&self, cosine: i32, highlight: i32) -> i32 {
        self.ambient.wrapping_add(self.specular.wrapping_mul(highlight)).wrapping_add(self.diffuse.wrapping_mul(cosine))
    }
}

const _: () = assert!(ENTRY + LEVEL - 1 == CHANNEL);

/// A walked diffuse level as a cosine from 0 to 1, Q1.15.
#[inline]
pub(crate) fn cosine(bits: u32, diffuse: i32) -> i32 {
    // Armv7-M shifts and clamps by one instruction.
    (diffuse >> ((bits + FULL_BITS - FACTOR) & 31)).clamp(0, (1 << FACTOR) - 1)
}

impl<'a, C: Pixel> OneLightRgb<'a, C> {
    /// The colours of these sums for even rows and for odd ones.
    pub(crate) fn of([even, odd]: &'a [Sums; 2]) -> Self {
        Self(ByTurns::new([even, odd]))
    }

    /// The sums as kernels read them.
    #[inline]
    fn in_kernels(&self) -> [&'a kernels::Sums; 2] {
        self.0.both().map(|sums| transmute_ref!(sums))
    }

    /// The colour of one cosine, Q1.15, and a highlight, unsigned Q0.16, on even rows and on odd ones.
    #[inline]
    pub fn by_turns(&self, cosine: i32, highlight: u32) -> [C::Stored; 2] {
        let [[r, g, b], [odd_r, odd_g, odd_b]] = self.0.both();
        let (cosine, highlight) = (cosine.clamp(0, (1 << FACTOR) - 1), highlight as i32);
        let (red, green, blue) = (r.light(cosine, highlight), g.light(cosine, highlight), b.light(cosine, highlight));
        let lit = |sum: &Sum, light: i32| sum.ambient.wrapping_add(light);
        let colour = |[r, g, b]: [&Sum; 3]| C::mixed([lit(r, red), lit(g, green), lit(b, blue)]).stored();
        let even = colour([r, g, b]);
        [even, if C::Ramps::CHECKERED { colour([odd_r, odd_g, odd_b]) } else { even }]
    }
}

impl<C: Pixel> ByRows for OneLightRgb<'_, C> {
    fn step_row(&mut self) {
        self.0.step_row();
    }
}

impl<C: Pixel> LitColours for OneLightRgb<'_, C> {
    type Pixel = C;
}

impl<C: Pixel, L: MayHaveHighlight> Shades<L> for OneLightRgb<'_, C> {
    #[inline]
    fn colour(&self, bits: u32, light: L) -> C {
        let WithHighlight(diffuse, highlight) = light.into();
        let ([r, g, b], cosine, highlight) = (self.0.now(), cosine(bits, diffuse), highlight as i32);
        C::mixed([r.level_from_highlight(cosine, highlight), g.level(cosine, highlight), b.level(cosine, highlight)])
    }

    const NUMERATORS: usize = 1 + L::HIGHLIGHTS;

    #[inline]
    fn lit<'k>(&'k self, lookup: kernels::Lookup<'k>) -> Option<kernels::Lit<'k>> {
        C::lit(kernels::Colours::Light(self.in_kernels()), L::HIGHLIGHTS, lookup)
    }
}

/// Three channels under one light on a surface whose colour changes from pixel to pixel. In the shares of a channel, a number for rounding and dither and
/// the level of ambient light precede the factors of [`Sum`].
#[derive(Clone, Copy, Debug)]
pub struct ColouredRgb<'a, C>(ByTurns<&'a Shares, C>);

impl<'a, C: Pixel> ColouredRgb<'a, C> {
    /// The colours of these shares for even rows and for odd ones.
    pub(crate) fn of([even, odd]: &'a [Shares; 2]) -> Self {
        Self(ByTurns::new([even, odd]))
    }
}

impl<C: Pixel> ByRows for ColouredRgb<'_, C> {
    #[inline]
    fn step_row(&mut self) {
        self.0.step_row();
    }
}

impl<C: Pixel> LitColours for ColouredRgb<'_, C> {
    type Pixel = C;
}

impl<C: Pixel, L: MayHaveHighlight> Shades<Coloured<L>> for ColouredRgb<'_, C> {
    #[inline]
    fn colour(&self, bits: u32, Coloured(light, [red, green, blue]): Coloured<L>) -> C {
        let WithHighlight(diffuse, highlight) = light.into();
        let ([r, g, b], cosine, highlight) = (self.0.now(), cosine(bits, diffuse), highlight as i32);
        let level = |&[rounding, ambient, diffuse, specular]: &[i32; 4], share: u32| {
            let reflected = painted(ambient.wrapping_add(diffuse.wrapping_mul(cosine)), share);
            reflected.wrapping_add(rounding).wrapping_add(specular.wrapping_mul(highlight))
        };
        C::mixed([level(r, red), level(g, green), level(b, blue)])
    }

    const NUMERATORS: usize = 4 + L::HIGHLIGHTS;

    #[inline]
    fn lit<'k>(&'k self, lookup: kernels::Lookup<'k>) -> Option<kernels::Lit<'k>> {
        C::lit(kernels::Colours::PaintedLight(self.0.both()), L::HIGHLIGHTS, lookup)
    }
}

/// [`ColouredRgb`] where red and blue have the same levels, as they do where neither material nor light has a hue. A loop keeps nearly all of these
/// numbers in registers.
#[derive(Clone, Copy, Debug)]
pub struct NeutralRgb<C> {
    /// Levels of red and blue. Ambient light is without what rounding and dither add.
    outer: Sum,
    /// Levels of green, of which a display of 16 bits shows more steps.
    middle: Sum,
    /// What rounding and dither add to a channel of eight bits, Q10.22.
    rounding: ByTurns<i32, C>,
}

impl<C: Pixel> NeutralRgb<C> {
    /// The levels of these sums for even rows, which are dithered by `quarter`; `None` if red and blue differ.
    #[inline]
    pub(super) fn new([r, g, b]: &Sums, quarter: i32) -> Option<Self> {
        let [even, odd] = [half_step(8).wrapping_sub(quarter), half_step(8).wrapping_add(quarter)];
        let [more_r, more_g, more_b] = steps(C::LEVELS, even);
        let is_same = more_r == more_b && r.ambient == b.ambient && r.diffuse == b.diffuse && r.specular == b.specular;
        let pure = |sum: &Sum, more: i32| sum.raised(more.wrapping_neg());
        is_same.then_some(Self { outer: pure(r, more_r), middle: pure(g, more_g), rounding: ByTurns::new([even, odd]) })
    }

    /// The level and the colour of a surface with these shares, Q0.16, `raise` (Q9.7) higher; `None` if green is not lit as red and blue are.
    #[inline]
    pub(super) fn tint(&self, [red, green, blue]: [i32; 3], raise: i32) -> Option<(TintLevel, Tint<C>)> {
        let Self { outer, middle, rounding } = self;
        // The largest levels of channels are as 1 - 2^-bits. Levels are rounded to the nearest, so that products with such a number of 8 bits differ
        // by at most 256; ambient light is rounded twice, because half of the last place of cosines is added to it.
        let [full, full_green] = [0, 1].map(|k| (1 << 8) - (1 << (8 - C::LEVELS[k])));
        let is_alike = |outer: i32, middle: i32, slack: i32| (outer * full_green).wrapping_sub(middle * full).abs() <= slack;
        let level = TintLevel { ambient: outer.ambient >> FACTOR, diffuse: outer.diffuse };
        if !(is_alike(level.ambient, middle.ambient >> FACTOR, 1 << 9) && is_alike(outer.diffuse, middle.diffuse, 1 << 8)) {
            return None;
        }
        let added = rounding.map(|rounding| {
            let [r, g, _] = steps(C::LEVELS, rounding);
            (r.wrapping_add(raise << FACTOR), g.wrapping_add(raise << FACTOR))
        });
        let green = if full == full_green { green } else { green * full_green / full };
        Some((level, Tint { shares: [(red + 1) >> 1, (green + 1) >> 1, (blue + 1) >> 1], added }))
    }
}

/// A surface of one colour under light without a hue: each channel is a share of one level.
#[derive(Clone, Copy, Debug)]
pub struct Tint<C> {
    /// The shares of red, green and blue, Q1.15.
    shares: [i32; 3],
    /// What is added to red and blue, and to green, for rounding and dither, Q10.22.
    added: ByTurns<(i32, i32), C>,
}

/// One level of [`Tint`]: that of red and blue of a white surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TintLevel {
    ambient: i32,
    diffuse: i32,
}

impl TintLevel {
    /// The level at N·L, Q2.30; the result is Q9.7.
    #[inline(always)]
    pub(crate) fn at(self, cosine: i32) -> i32 {
        self.ambient + ((self.diffuse * (cosine.clamp(0, 1 << COSINE) >> (COSINE - FACTOR)) + (1 << (FACTOR - 1))) >> FACTOR)
    }
}

impl<C: Pixel> Tint<C> {
    /// The colour at a level, Q10.22.
    #[inline]
    pub(crate) fn lit(&self, level: u32) -> C {
        let ([red, green, blue], level, (more, green_more)) = (self.shares, (level >> FACTOR) as i32, self.added.now());
        let channel = |share: i32, more: i32| more.wrapping_add(level.wrapping_mul(share));
        C::mixed([channel(red, more), channel(green, green_more), channel(blue, more)])
    }
}

impl<C: Pixel> ByRows for Tint<C> {
    #[inline]
    fn step_row(&mut self) {
        self.added.step_row();
    }
}

impl<C: Pixel> ByRows for NeutralRgb<C> {
    #[inline]
    fn step_row(&mut self) {
        self.rounding.step_row();
    }
}

impl<C: Pixel> LitColours for NeutralRgb<C> {
    type Pixel = C;
}

impl<C: Pixel, L: Into<WithHighlight>> Shades<Coloured<L>> for NeutralRgb<C> {
    #[inline]
    fn colour(&self, bits: u32, Coloured(light, [red, green, blue]): Coloured<L>) -> C {
        let WithHighlight(diffuse, highlight) = light.into();
        let (Self { outer, middle, .. }, cosine, highlight) = (self, cosine(bits, diffuse), highlight as i32);
        let [r, g, b] = steps(C::LEVELS, self.rounding.now());
        // Added up channel by channel, without arrays: the compiler would keep these in memory.
        let level = outer.ambient.wrapping_add(outer.diffuse.wrapping_mul(cosine));
        let green_level = middle.ambient.wrapping_add(middle.diffuse.wrapping_mul(cosine));
        let more = outer.specular.wrapping_mul(highlight);
        let green_more = middle.specular.wrapping_mul(highlight);
        C::mixed([
            painted(level, red).wrapping_add(more).wrapping_add(r),
            painted(green_level, green).wrapping_add(green_more).wrapping_add(g),
            painted(level, blue).wrapping_add(more).wrapping_add(b),
        ])
    }
}

/// Colours under any number of lights: ambient light, to which the light at a pixel is added. In greys all channels are the same, and their level is an
/// index of the table of colours.
#[derive(Clone, Copy, Debug)]
pub struct SummedColours<'a, C: Pixel> {
    /// The levels of ambient light, as the sums of the first light contain them.
    pub(super) ambient: ByTurns<&'a Sums, C>,
    /// The table of greys.
    pub(super) greys: &'a [C::Stored; RAMP],
    /// Fraction bits that levels have more than an intensity.
    pub(super) bits: u32,
}

impl<C: Pixel> ByRows for SummedColours<'_, C> {
    #[inline]
    fn step_row(&mut self) {
        self.ambient.step_row();
    }
}

impl<C: Pixel> LitColours for SummedColours<'_, C> {
    type Pixel = C;
}

impl<'a, C: Pixel> SummedColours<'a, C> {
    /// The colours where ambient light is that of these sums, for even rows and for odd ones.
    #[inline]
    pub(crate) fn in_ambient<'s>(&self, [even, odd]: &'s [Sums; 2]) -> SummedColours<'s, C>
    where
        'a: 's,
    {
        SummedColours { ambient: ByTurns::new([even, odd]), ..*self }
    }

    /// Whether levels have no fewer fraction bits than [`SummedRgb`] has.
    #[inline]
    pub(crate) fn is_fine(&self) -> bool {
        self.bits == CHANNEL - INTENSITY
    }

    /// The colours with the factors of two highlights for [`SummedRgb`]: of a surface of one colour, or where `pure` is the level of ambient light alone.
    #[inline]
    pub(crate) fn shares(&self, pure: Option<&[i32; 3]>, [first, second]: [[i32; 3]; 2]) -> [Shares; 2] {
        self.ambient.both().map(|sums| {
            let levels = map(*sums, |sum| sum.ambient);
            let ambient = match pure {
                Some(&pure) => zip(levels, pure, |level, pure| [level.wrapping_sub(pure), pure]),
                None => map(levels, |level| [0, level]),
            };
            zip(ambient, zip(first, second, |a, b| [a, b]), |[rounding, ambient], [a, b]| [rounding, ambient, a, b])
        })
    }

    /// The levels of this diffuse light and of ambient light.
    #[inline]
    pub(crate) fn levels(&self, Summed([red, green, blue]): Summed) -> [i32; 3] {
        let [r, g, b] = self.ambient.now();
        let level = |ambient: &Sum, sum: i32| ambient.ambient.wrapping_add(sum << (CHANNEL - SUMMED));
        [level(r, red), level(g, green), level(b, blue)]
    }

    /// Levels of ambient and diffuse light on a surface of a walked colour, where `pure` is what they have of ambient light alone.
    #[inline]
    pub(crate) fn painted(&self, levels: [i32; 3], [pure_r, pure_g, pure_b]: [i32; 3], [red, green, blue]: [u32; 3]) -> [i32; 3] {
        let ([r, g, b], [level_r, level_g, level_b]) = (self.ambient.now(), levels);
        let level = |sum: &Sum, level: i32, pure: i32, share: u32| {
            let rounding = sum.ambient.wrapping_sub(pure);
            painted(level.wrapping_sub(rounding), share).wrapping_add(rounding)
        };
        [level(r, level_r, pure_r, red), level(g, level_g, pure_g, green), level(b, level_b, pure_b, blue)]
    }

    /// The colour of levels.
    #[inline]
    pub(crate) fn mixed(&self, [r, g, b]: [i32; 3]) -> C {
        // Armv7-M clamps by one instruction.
        let intensity = |level: i32, more: i32| (level >> (self.bits & 31)).wrapping_add(more).clamp(0, (1 << (8 + INTENSITY)) - 1);
        if C::GRAY {
            // Levels of the table have eight bits, and what is added for rounding is half a step of the display.
            let more = const { (half_step(8) - half_step(C::LEVELS[0])) >> (CHANNEL - INTENSITY) };
            return C::ramped(self.greys, (intensity(r, more) + (BIAS << INTENSITY)) as u32, INTENSITY);
        }
        let level = |level: i32| intensity(level, 0) << (CHANNEL - INTENSITY);
        C::mixed([level(r), level(g), level(b)])
    }
}

/// The diffuse light of several lights, and entries of the table of two highlights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SummedWithHighlights(pub(crate) Summed, pub(crate) [u32; 2]);

/// Three channels of [`SummedWithHighlights`], for kernels. In the shares of a channel, a number for rounding and dither and the level of ambient light
/// precede the factors of highlights. The first number is not used on a surface of one colour, and the second includes it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SummedRgb<'a, C> {
    shares: ByTurns<&'a Shares, C>,
    /// Number of highlights. Kernels leave out the others, whose factors are 0.
    highlights: usize,
}

impl<'a, C: Pixel> SummedRgb<'a, C> {
    /// The colours of these shares for even rows and for odd ones.
    pub(crate) fn of([even, odd]: &'a [Shares; 2], highlights: usize) -> Self {
        Self { shares: ByTurns::new([even, odd]), highlights }
    }
}

impl<C: Pixel> ByRows for SummedRgb<'_, C> {
    #[inline]
    fn step_row(&mut self) {
        self.shares.step_row();
    }
}

impl<C: Pixel> LitColours for SummedRgb<'_, C> {
    type Pixel = C;

    const TRANSPARENT: bool = false;
}

/// Adds a sum to the ambient light of a channel.
#[inline]
fn summed(&[_, ambient, ..]: &[i32; 4], sum: i32) -> i32 {
    ambient.wrapping_add(sum << (CHANNEL - SUMMED))
}

/// Adds highlights to the level of a channel.
#[inline]
fn highlit(level: i32, &[_, _, first, second]: &[i32; 4], [one, two]: [u32; 2]) -> i32 {
    level.wrapping_add(first.wrapping_mul(one as i32)).wrapping_add(second.wrapping_mul(two as i32))
}

impl<C: Pixel> Shades<SummedWithHighlights> for SummedRgb<'_, C> {
    #[inline]
    fn colour(&self, _: u32, SummedWithHighlights(Summed([red, green, blue]), highlights): SummedWithHighlights) -> C {
        let [r, g, b] = self.shares.now();
        let level = |shares: &[i32; 4], sum: i32| highlit(summed(shares, sum), shares, highlights);
        C::mixed([level(r, red), level(g, green), level(b, blue)])
    }

    const NUMERATORS: usize = 5;

    #[inline]
    fn lit<'k>(&'k self, lookup: kernels::Lookup<'k>) -> Option<kernels::Lit<'k>> {
        C::lit(kernels::Colours::Summed(self.shares.both()), self.highlights, lookup)
    }
}

impl<C: Pixel> Shades<Coloured<SummedWithHighlights>> for SummedRgb<'_, C> {
    #[inline]
    fn colour(&self, _: u32, Coloured(light, [red, green, blue]): Coloured<SummedWithHighlights>) -> C {
        let (SummedWithHighlights(Summed(sums), highlights), [r, g, b]) = (light, self.shares.now());
        let level = |shares: &[i32; 4], sum: i32, share: u32| {
            let [rounding, ..] = shares;
            highlit(painted(summed(shares, sum), share).wrapping_add(*rounding), shares, highlights)
        };
        C::mixed([level(r, sums[0], red), level(g, sums[1], green), level(b, sums[2], blue)])
    }

    const NUMERATORS: usize = 8;

    #[inline]
    fn lit<'k>(&'k self, lookup: kernels::Lookup<'k>) -> Option<kernels::Lit<'k>> {
        C::lit(kernels::Colours::PaintedSum(self.shares.both()), self.highlights, lookup)
    }
}

impl<C: Pixel> Shades<Summed> for SummedColours<'_, C> {
    #[inline]
    fn colour(&self, _: u32, sum: Summed) -> C {
        self.mixed(self.levels(sum))
    }
}

impl<C: Pixel> ByRows for TwoLightsRgb<'_, C> {
    fn step_row(&mut self) {
        self.0.step_row();
    }
}

impl<C: Pixel> LitColours for TwoLightsRgb<'_, C> {
    type Pixel = C;
}

impl<C: Pixel, A: MayHaveHighlight, B: MayHaveHighlight> Shades<(A, B)> for TwoLightsRgb<'_, C> {
    #[inline]
    fn colour(&self, bits: u32, (one, two): (A, B)) -> C {
        let [[r, g, b], [r2, g2, b2]] = self.0.now();
        let (WithHighlight(c, h), WithHighlight(c2, h2)) = (one.into(), two.into());
        let (c, h, c2, h2) = (cosine(bits, c), h as i32, cosine(bits, c2), h2 as i32);
        let level = |first: &Sum, second: &Sum| first.level_from_highlight(c, h).wrapping_add(second.light(c2, h2));
        // The same, the second light's products one after the other. In which channels that leaves loops more registers is known by measurement
        // alone.
        let in_turn = |first: &Sum, second: &Sum| {
            first.level_from_highlight(c, h).wrapping_add(second.specular.wrapping_mul(h2)).wrapping_add(second.diffuse.wrapping_mul(c2))
        };
        C::mixed([level(r, r2), in_turn(g, g2), level(b, b2)])
    }

    const NUMERATORS: usize = if A::HIGHLIGHTS < B::HIGHLIGHTS { 0 } else { 2 + A::HIGHLIGHTS + B::HIGHLIGHTS };

    #[inline]
    fn lit<'k>(&'k self, lookup: kernels::Lookup<'k>) -> Option<kernels::Lit<'k>> {
        let sums = self.0.both().map(|sums| transmute_ref!(sums));
        C::lit(kernels::Colours::TwoLights(sums), A::HIGHLIGHTS + B::HIGHLIGHTS, lookup)
    }
}

impl<'a, C> TwoLightsRgb<'a, C> {
    /// The colours of the first light alone.
    #[inline]
    pub fn first(&self) -> OneLightRgb<'a, C> {
        OneLightRgb(self.0.map(|[first, _]| first))
    }
}

/// Sums of levels below this limit, Q9.7, are entries of a table of colours.
pub(super) const LARGEST: u32 = (RAMP as u32 - BIAS as u32 - 1) << LEVEL;

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_graphics_core::pixelcolor::Rgb565;
    use proptest::prelude::*;

    const CASES: u32 = 2_000;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(CASES))]
        /// The colours that kernels draw by sums are those of the loop in Rust, on even rows and on odd ones.
        #[test]
        fn kernels_of_sums_have_the_colours_of_the_loop(
            ambient in prop::array::uniform2(prop::array::uniform3(-1i32 << 29..1 << 29)),
            pure in prop::array::uniform3(0i32..1 << 29),
            sums in prop::array::uniform3(-1i32 << 26..1 << 26),
            factors in prop::array::uniform2(prop::array::uniform3(0i32..1 << 13)),
            highlights in prop::array::uniform2(0u32..1 << 16),
            colour in prop::array::uniform3(0u32..=1 << COLOUR),
        ) {
            let [even, odd] = ambient.map(|levels| levels.map(|level| Sum::new(level, 0, 0)));
            let bits = CHANNEL - INTENSITY;
            let mut loops = SummedColours::<Rgb565> { ambient: ByTurns::new([&even, &odd]), greys: &[0; RAMP], bits };
            prop_assert!(loops.is_fine());
            let (one_colour, painted) = (loops.shares(None, factors), loops.shares(Some(&pure), factors));
            let mut kernels = [&one_colour, &painted].map(|shares| SummedRgb::<Rgb565>::of(shares, 2));
            let light = SummedWithHighlights(Summed(sums), highlights);
            let highlit = |levels: [i32; 3]| {
                factors.iter().zip(highlights).fold(levels, |levels, (factors, highlight)| {
                    zip(levels, *factors, |level, factor| level.wrapping_add(factor.wrapping_mul(highlight as i32)))
                })
            };
            for _ in 0..2 {
                let levels = loops.levels(Summed(sums));
                prop_assert_eq!(kernels[0].colour(0, light), loops.mixed(highlit(levels)));
                prop_assert_eq!(kernels[1].colour(0, Coloured(light, colour)), loops.mixed(highlit(loops.painted(levels, pure, colour))));
                loops.step_row();
                kernels.iter_mut().for_each(ByRows::step_row);
            }
        }

        /// Where red and blue have the same levels, they have the same colours by both ways to draw a colour that is walked.
        #[test]
        fn neutral_colours_are_those_of_all_channels(
            levels in prop::array::uniform2((0i32..1 << 28, 0u16..1 << 15, 0u16..1 << 15)),
            quarter in 0i32..1 << 18,
            diffuse in -1i32 << 27..1 << 27,
            highlight in 0u32..1 << 16,
            colour in prop::array::uniform3(0u32..=1 << COLOUR),
        ) {
            let [outer, middle] = levels;
            let pure = [outer.0, middle.0, outer.0];
            let sums = |quarter: i32| {
                let rounding = steps(Rgb565::LEVELS, half_step(8) + quarter);
                let sum = |(ambient, diffuse, specular): (i32, u16, u16), rounding: i32| Sum::new(ambient + rounding, diffuse, specular);
                [sum(outer, rounding[0]), sum(middle, rounding[1]), sum(outer, rounding[2])]
            };
            let [even, odd] = [sums(-quarter), sums(quarter)];
            let shares = [&even, &odd].map(|sums| zip(*sums, pure, |sum, pure| sum.shares(pure)));
            let mut neutral = NeutralRgb::<Rgb565>::new(&even, quarter).expect("red and blue are alike");
            let mut all = ColouredRgb::<Rgb565>::of(&shares);
            for _ in 0..2 {
                let light = Coloured(WithHighlight(diffuse, highlight), colour);
                prop_assert_eq!(Shades::colour(&neutral, KERNEL_BITS, light), all.colour(KERNEL_BITS, light));
                neutral.step_row();
                all.step_row();
            }
        }
    }
}
