//! What a material makes of the scene's lights, worked out once.

use crate::{
    dither::quantise,
    format::{BIAS, COSINE, LEVEL, MAX_LIGHTS, PIXEL_COSINE, RAMP, UNIT, WALK},
    math::{
        power::{Base, POWER, PixelPower, Power, square},
        product::upper,
        vector::zip,
    },
    pixel::Pixel,
    shader::Highlight,
    stream::record::{Header, Light, Material},
};

/// Largest level of a node, Q9.7.
pub const FULL: i32 = 255 << LEVEL;

/// Light levels that one light adds at cosine 1, per channel, in Q9.7.
#[derive(Clone, Copy, Debug)]
struct Gains {
    diffuse: [u16; 3],
    specular: [u16; 3],
}

/// A material under the scene's lights: gains per light, the power table, and the table of colours.
#[derive(Clone, Copy, Debug)]
pub struct Palette<C> {
    /// Colour of each level, if one level says it all.
    pub ramp: [C; RAMP],
    /// Channels at full level for dither, Q0.8 scaled to the output's depth.
    pub base: [u16; 3],
    /// x^exponent.
    pub power: Power,
    /// One walked level is not enough: the material has colours that are no multiples of `base`.
    pub three_channels: bool,
    /// Level without lights, Q9.7.
    ambient: [i32; 3],
    gains: [Gains; MAX_LIGHTS],
    dark_below: i32,
    /// `power` holds levels: what its highlight adds to the only light, on top of the level without lights.
    holds_levels: bool,
}

/// A colour as products of gains, Q4.28.
type Colour = [u32; 3];

fn product(a: [u16; 3], b: [u16; 3]) -> Colour {
    zip(a, b, |a, b| u32::from(a) * u32::from(b))
}

/// Rec. 601 luma in all three channels.
fn grey([r, g, b]: Colour) -> Colour {
    [(r >> 8) * 77 + (g >> 8) * 150 + (b >> 8) * 29; 3]
}

fn largest(colour: Colour) -> u32 {
    colour.into_iter().fold(0, u32::max)
}

/// Whether `colour` is a multiple of `base`, to 1/1024 of its largest channel.
fn along(colour: Colour, base: Colour) -> bool {
    let (a, b) = (u64::from(largest(colour)), u64::from(largest(base)));
    zip(colour, base, |c, d| (u64::from(c) * b).abs_diff(u64::from(d) * a) <= (a * b) >> 10) == [true; 3]
}

impl<C: Pixel> Palette<C> {
    /// Nothing yet, for static memory.
    #[must_use]
    pub fn empty() -> Self {
        Self::filled(C::pack([0; 3]))
    }

    /// Every colour `colour`: for static memory, where `pack` cannot be called. Black makes it all zeros, which takes no flash.
    #[must_use]
    pub const fn filled(colour: C) -> Self {
        Self {
            ramp: [colour; RAMP],
            base: [0; 3],
            power: Power::EMPTY,
            three_channels: false,
            ambient: [0; 3],
            gains: [Gains { diffuse: [0; 3], specular: [0; 3] }; MAX_LIGHTS],
            dark_below: 0,
            holds_levels: false,
        }
    }

    /// Works out `material` under `lights`, for a method with these highlights. Where one level says it all, and it may, the highlight's
    /// table `holds_levels` instead of shares.
    pub fn fill(&mut self, header: &Header, material: &Material, lights: &[Light], highlight: Highlight, holds_levels: bool) {
        let tint = |colour: Colour| if C::GRAY { grey(colour) } else { colour };
        let ambient = tint(product(header.ambient, material.ambient));
        let diffuse = |light: &Light| tint(product(light.colour, material.diffuse));
        let specular = |light: &Light| tint(product(light.colour, material.specular));
        // The brightest of all terms sets the base colour; the others may be multiples of it.
        let terms = || lights.iter().flat_map(|light| [diffuse(light), specular(light)]).chain([ambient]);
        let base = terms().max_by_key(|&term| largest(term)).unwrap_or([0; 3]);
        let one_channel = terms().all(|term| along(term, base));
        self.three_channels = !one_channel;
        let levels =
            |colour: Colour| -> [u16; 3] { if one_channel { [level(largest(colour), 8); 3] } else { zip(colour, C::DEPTH, level) } };
        self.ambient = levels(ambient).map(i32::from);
        for (gains, light) in self.gains.iter_mut().zip(lights) {
            *gains = Gains { diffuse: levels(diffuse(light)), specular: levels(specular(light)) };
        }
        self.holds_levels = holds_levels && one_channel && lights.len() == 1 && self.fits();
        let [one, ..] = &mut self.gains;
        let (mut full, mut floor) = (1 << POWER, 0);
        if self.holds_levels {
            (full, floor) = (one.specular[0].into(), Self::raised(self.ambient[0]) as u16);
            // What is left to multiply with is all but one.
            one.specular = [u16::MAX; 3];
        }
        self.power.fill(material.exponent, highlight.base(), full, floor);
        self.dark_below = match highlight.base() {
            Base::Square => square(self.power.dark_below()),
            _ => self.power.dark_below(),
        };
        // Share of each channel in the base colour, scaled to what the output can show.
        let whole = u64::from(largest(base).max(1));
        self.base = zip(base, C::DEPTH, |channel, depth| {
            let full = ((1u64 << depth) - 1) << (8 - depth);
            ((u64::from(channel) * full * 256 + whole * 255 / 2) / (whole * 255)) as u16
        });
        for (i, colour) in self.ramp.iter_mut().enumerate() {
            let level = (i as i32 - BIAS).clamp(0, 255) as u32;
            let mut channels = [0; 3];
            for (channel, (base, depth)) in channels.iter_mut().zip(self.base.into_iter().zip(C::DEPTH)) {
                let step = 1 << (16 - depth);
                *channel = ((level * u32::from(base) + step / 2) / step).min((1 << depth) - 1) as u8;
            }
            *colour = C::pack(channels);
        }
    }

    /// Smallest N·H, Q2.30, whose highlight counts, see [`Power::dark_below`].
    #[must_use]
    pub fn dark_below(&self) -> i32 {
        self.dark_below
    }

    /// The level of a material of one channel under one light, Q9.7 in [0, 255], from `[N·L, N·H]` (Q2.30).
    #[inline(never)]
    #[must_use]
    pub fn level(&self, [diffuse, half]: [i32; 2]) -> i32 {
        let [gains, ..] = &self.gains;
        let light = reflected((gains.diffuse[0], gains.specular[0]), diffuse, self.power.at(half));
        (self.ambient[0] + light).min(FULL)
    }

    /// [`Self::level`] at six nodes where there is no highlight.
    #[inline]
    #[must_use]
    pub fn six_matte(&self, [a, b, c, ab, bc, ca]: [i32; 6]) -> [i32; 6] {
        let [gains, ..] = &self.gains;
        let matte = |cosine| self.matte(cosine);
        if self.ambient[0] + i32::from(gains.diffuse[0]) <= FULL {
            return [matte(a), matte(b), matte(c), matte(ab), matte(bc), matte(ca)];
        }
        let matte = |cosine| self.matte(cosine).min(FULL);
        [matte(a), matte(b), matte(c), matte(ab), matte(bc), matte(ca)]
    }

    /// [`Self::level`] at six nodes.
    #[inline(always)]
    #[must_use]
    pub fn six(&self, [a, b, c, ab, bc, ca]: [i32; 6], [i, j, k, ij, jk, ki]: [i32; 6]) -> [i32; 6] {
        let [gains, ..] = &self.gains;
        let level = |diffuse, half| (self.matte(diffuse) + reflected((0, gains.specular[0]), 0, self.power.at(half))).min(FULL);
        [level(a, i), level(b, j), level(c, k), level(ab, ij), level(bc, jk), level(ca, ki)]
    }

    /// Level without highlight and not clamped; rounded as by [`reflected`].
    #[inline(always)]
    fn matte(&self, cosine: i32) -> i32 {
        let [gains, ..] = &self.gains;
        let base = ((self.ambient[0] as u32) << 15) + (1 << 14);
        ((base + u32::from(gains.diffuse[0]) * (cosine.max(0) as u32 >> (COSINE - 15))) >> 15) as i32
    }

    /// Levels under one light, Q9.7 in [0, 255], from `[N·L, N·H]` (Q2.30).
    #[inline]
    #[must_use]
    pub fn one_light(&self, cosines: [i32; 2]) -> [i32; 3] {
        if self.three_channels { self.levels(core::iter::once(cosines)) } else { [self.level(cosines); 3] }
    }

    /// Levels at a point, Q9.7 in [0, 255], from the cosines `[N·L, N·H]` (Q2.30) of each light.
    #[inline]
    #[must_use]
    pub fn levels(&self, cosines: impl Iterator<Item = [i32; 2]>) -> [i32; 3] {
        let mut levels = self.ambient;
        for (gains, [diffuse, half]) in self.gains.iter().zip(cosines) {
            let power = self.power.at(half);
            self.add(&mut levels, gains, diffuse, power);
        }
        levels.map(|level| level.min(FULL))
    }

    /// Levels at a pixel, Q9.7 in [0, 255], from what each light sends: N·L (Q5.27) and the highlight (Q0.16).
    #[inline(always)]
    #[must_use]
    pub fn pixel_levels(&self, reflections: impl Iterator<Item = Reflection>) -> [i32; 3] {
        let mut levels = self.ambient;
        for (gains, Reflection { diffuse, highlight }) in self.gains.iter().zip(reflections) {
            // What approximations lift above 1 counts as 1.
            let diffuse = diffuse.min(1 << PIXEL_COSINE) << (COSINE - PIXEL_COSINE);
            self.add(&mut levels, gains, diffuse, highlight.saturating_sub(self.power.floor()));
        }
        levels.map(|level| level.min(FULL))
    }

    #[inline(always)]
    fn add(&self, levels: &mut [i32; 3], gains: &Gains, diffuse: i32, power: u32) {
        let light = |level: i32, gains| level.saturating_add(reflected(gains, diffuse, power));
        if !self.three_channels {
            *levels = [light(levels[0], (gains.diffuse[0], gains.specular[0])); 3];
        } else {
            *levels = zip(*levels, zip(gains.diffuse, gains.specular, |d, s| (d, s)), light);
        }
    }

    /// A level, Q9.7, with bias and rounding half of the ramp's index.
    fn raised(level: i32) -> u32 {
        (level + (BIAS << LEVEL) + (1 << (LEVEL - 1))) as u32
    }

    /// One light on one channel is at most what the ramp takes.
    fn fits(&self) -> bool {
        let [gains, ..] = &self.gains;
        let sum = self.ambient[0] as u32 + u32::from(gains.diffuse[0]) + u32::from(gains.specular[0]);
        sum < (RAMP as u32 - BIAS as u32 - 1) << LEVEL
    }

    /// What one light comes to in a material of one channel: for the pixel loop. `None` if that is more than the ramp takes.
    #[must_use]
    pub fn glossy(&self) -> Option<Glossy<'_, C>> {
        let [gains, ..] = &self.gains;
        let diffuse = u32::from(gains.diffuse[0]) << (WALK - LEVEL - DIFFUSE);
        let (ramp, power) = (&self.ramp, self.power.pixel());
        if self.holds_levels {
            Some(Glossy { ramp, power, ambient: 0, diffuse, specular: 1 << (WALK - LEVEL) })
        } else {
            let ambient = Self::raised(self.ambient[0]) << (WALK - LEVEL);
            self.fits().then(|| Glossy { ramp, power, ambient, diffuse, specular: gains.specular[0].into() })
        }
    }

    /// The same, of a highlight's table that holds levels; `None` if it does not.
    #[must_use]
    pub fn levels_of_one(&self) -> Option<Levels<'_, C>> {
        let [gains, ..] = &self.gains;
        self.holds_levels.then(|| Levels { ramp: &self.ramp, diffuse: gains.diffuse[0] })
    }

    /// The colour of three levels, Q9.7, rounded.
    #[inline(always)]
    #[must_use]
    pub fn colour(&self, levels: [i32; 3]) -> C {
        if !self.three_channels {
            return self.tint(levels[0]);
        }
        C::mixed(zip(levels, C::DEPTH, |level, depth| walked(level, LEVEL + 7 - depth)))
    }

    /// The colour of a level, Q9.7, of a material of one channel, rounded.
    #[inline(always)]
    #[must_use]
    pub fn tint(&self, level: i32) -> C {
        C::ramped::<WALK>(&self.ramp, walked(level, LEVEL - 1))
    }

    /// The colour of three levels, Q9.7, dithered by `threshold`, see [`crate::dither::threshold`].
    #[must_use]
    pub fn dithered(&self, levels: [i32; 3], threshold: u32) -> C {
        let fine = levels.map(|level| (level.max(0) as u32) << 1);
        let scaled = if !self.three_channels { self.base.map(|base| (fine[0] * u32::from(base)) >> 8) } else { fine };
        quantise(scaled, threshold)
    }
}

/// What one light sends from a pixel to the viewer, before the material's gains.
#[derive(Clone, Copy, Debug)]
pub struct Reflection {
    /// N·L, Q5.27; negative where the light is behind the surface.
    pub diffuse: i32,
    /// The highlight, a power of a cosine, unsigned Q0.16.
    pub highlight: u32,
}

/// One light on a material of one channel.
#[derive(Clone, Copy, Debug)]
pub struct Glossy<'a, C> {
    ramp: &'a [C; RAMP],
    /// The highlight's table.
    pub power: PixelPower<'a>,
    /// Q9.23.
    ambient: u32,
    /// Level at cosine 1, such that its product with a cosine of [`DIFFUSE`] fraction bits is Q9.23.
    diffuse: u32,
    /// Level of a full highlight, Q9.7.
    specular: u32,
}

/// Fraction bits of N·L in the pixel loop; 1 is one unit less. Error: 2^-14 of the light, 0.02 LSB.
const DIFFUSE: u32 = 15;

impl<C: Pixel> Glossy<'_, C> {
    /// The colour of what the light sends.
    #[inline(always)]
    #[must_use]
    pub fn colour(&self, Reflection { diffuse, highlight }: Reflection) -> C {
        let diffuse = (diffuse >> (PIXEL_COSINE - DIFFUSE)).clamp(0, (1 << DIFFUSE) - 1) as u32;
        let level = self.ambient.wrapping_add(diffuse.wrapping_mul(self.diffuse)).wrapping_add(highlight.wrapping_mul(self.specular));
        C::ramped::<WALK>(self.ramp, level)
    }
}

/// One light on a material of one channel, its levels walked: what its highlight adds, and all that is the same everywhere, is in
/// the highlight's table.
#[derive(Clone, Copy, Debug)]
pub struct Levels<'a, C> {
    ramp: &'a [C; RAMP],
    /// Level at cosine 1, Q9.7.
    diffuse: u16,
}

impl<C: Pixel> Levels<'_, C> {
    /// The diffuse level at a node, in Q10 with `bits` more, at most 20, rounded down; `cosine` in Q2.30.
    #[inline(always)]
    #[must_use]
    pub fn node(&self, cosine: i32, bits: u32) -> i32 {
        upper(cosine, i32::from(self.diffuse) << 15) >> (COSINE + LEVEL - 17 - bits)
    }

    /// No diffuse level is above 255.
    #[inline(always)]
    #[must_use]
    pub fn is_within(&self) -> bool {
        i32::from(self.diffuse) <= FULL
    }

    /// The colour of a walked diffuse level, not negative, Q9.`BITS`, and the highlight's entry.
    #[inline(always)]
    #[must_use]
    pub fn colour<const BITS: u32>(&self, diffuse: u32, highlight: u32) -> C {
        C::ramped::<BITS>(self.ramp, diffuse.wrapping_add(highlight << (BITS - LEVEL)))
    }
}

/// A level, Q9.7, as it is walked, with half a step: the guards at the ramp's ends are not reached.
#[inline(always)]
fn walked(level: i32, half: u32) -> u32 {
    ((level + (BIAS << LEVEL) + (1 << half)) as u32) << (WALK - LEVEL)
}

/// Level, Q9.7, that the gains `(diffuse, specular)` make of N·L (Q2.30) and a power of N·H (Q0.16).
#[inline(always)]
fn reflected((diffuse, specular): (u16, u16), cosine: i32, power: u32) -> i32 {
    let cosine = cosine.max(0) as u32 >> (COSINE - 15);
    let diffuse = (u32::from(diffuse) * cosine + (1 << 14)) >> 15;
    let specular = (u32::from(specular) * power + (1 << (POWER - 1))) >> POWER;
    (diffuse + specular) as i32
}

/// A product of two gains (Q4.28, 1 is full) as a level in Q9.7 whose upper `depth` bits are the channel.
fn level(product: u32, depth: u32) -> u16 {
    let full = ((1u64 << depth) - 1) << (8 - depth + LEVEL);
    ((u64::from(product) * full + (1 << (2 * UNIT - 1))) >> (2 * UNIT)).min(u64::from(u16::MAX)) as u16
}
