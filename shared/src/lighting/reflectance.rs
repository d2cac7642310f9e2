//! Reflectances of a material under the lights of a scene, in levels, computed once.

use crate::{
    arch::{
        product::{product, unsigned_product},
        quotient::long,
    },
    features::{COLOURS, LIGHT_SHAPES, LIGHTS, NEAR_LIGHTS, SKIPS, SUMS_LIGHTS, VERTEX_COLOURS},
    format::{BIAS, CHANNEL, COSINE, FULL, Intensity, LEVEL, PIXEL_COSINE, UNIT},
    lighting::{
        albedo::Parts,
        constant_lights::{FACTOR, LARGEST, Sum, Sums},
        lights::{Incident, ROOM, Source, UnitNormal, part_of_sky},
        shape::STRENGTH,
    },
    math::{
        highlight_lut::{ENTRY, Highlight, HighlightCurve, HighlightLut, square},
        vector::{map, zip},
    },
    pixel::{Channels, gamma::Gamma, half_step, steps},
    scene::{Colour, LightTerms, largest},
    stream::record::{Light, Material, POINT},
};
use core::ops::Deref;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// `Reflectance::lights` where the diffuse light of all lights is summed.
pub const SUMMED: u8 = 3;

/// Light levels that one light adds at cosine 1, for each channel, in Q9.7.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub struct Gains {
    pub(super) diffuse: [u16; 3],
    specular: [u16; 3],
}

impl Gains {
    /// Gains where there is no light.
    const NONE: Self = Self { diffuse: [0; 3], specular: [0; 3] };
}

/// Factors by which one light adds to the levels of a pixel, for each channel.
#[derive(Clone, Copy, Debug)]
pub struct Factors {
    /// The diffuse level at cosine 1, Q9.7 less the bits of [`Reflectance::excess`].
    pub(crate) diffuse: [i32; 3],
    /// The level of a whole highlight, Q9.6 less these bits.
    pub(crate) specular: [i32; 3],
}

impl Factors {
    /// Adds a reflection to the levels of a pixel, in Q10.22 less the bits of [`Reflectance::excess`].
    #[inline]
    pub fn add(&self, levels: &mut [i32; 3], Reflection { diffuse, highlight }: Reflection) {
        *levels = zip(*levels, self.at(Self::cosine(diffuse), highlight), i32::wrapping_add);
    }

    /// Adds diffuse light only.
    #[inline]
    pub fn add_diffuse(&self, levels: &mut [i32; 3], diffuse: i32) {
        *levels = self.add_at(*levels, Self::cosine(diffuse));
    }

    /// A cosine, Q5.27, with the fraction bits of a factor. Approximations above 1 count as 1. Armv7-M shifts and clamps in one instruction.
    #[inline]
    fn cosine(diffuse: i32) -> i32 {
        (diffuse >> (PIXEL_COSINE - FACTOR)).clamp(0, (1 << FACTOR) - 1)
    }

    /// What the light adds at a cosine, Q1.15, and a highlight, unsigned Q0.16.
    #[inline]
    fn at(&self, cosine: i32, highlight: u32) -> [i32; 3] {
        let level = |diffuse: i32, specular: i32| diffuse.wrapping_mul(cosine).wrapping_add(specular.wrapping_mul(highlight as i32));
        let ([dr, dg, db], [sr, sg, sb]) = (self.diffuse, self.specular);
        [level(dr, sr), level(dg, sg), level(db, sb)]
    }

    /// Adds a highlight, unsigned Q0.16, to levels.
    #[inline]
    pub(crate) fn add_highlight(&self, levels: &mut [i32; 3], highlight: u32) {
        *levels = zip(*levels, self.specular, |level, factor| level.wrapping_add(factor.wrapping_mul(highlight as i32)));
    }

    /// Adds the diffuse light at a cosine, Q1.15, to levels.
    #[inline]
    pub(crate) fn add_at(&self, [r, g, b]: [i32; 3], cosine: i32) -> [i32; 3] {
        let ([dr, dg, db], level) = (self.diffuse, |level: i32, gain: i32| level.wrapping_add(gain.wrapping_mul(cosine)));
        [level(r, dr), level(g, dg), level(b, db)]
    }
}

/// A material under the lights of a scene: the gains of each light, and the power function of highlights.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub struct Reflectance {
    /// The power function of highlights.
    pub highlights: HighlightCurve,
    /// The levels of ambient light, Q9.7.
    pub(crate) ambient: [i32; 3],
    /// Smallest N·H, Q2.30, whose highlight counts, see [`HighlightCurve::highlight_threshold`]; [`Self::NO_HIGHLIGHT`] if there is none.
    pub(crate) highlight_threshold: i32,
    /// Dither offset in three channels, a quarter of a step, with [`CHANNEL`] fraction bits, as if channels had eight bits. Even rows are lower by it
    /// and odd ones higher; 0 without dither.
    pub(crate) quarter: i32,
    /// Bits of each channel of the pixel format.
    depth: [u32; 3],
    pub(super) gains: [Gains; ROOM],
    /// Bits by which the sum of all lights may leave Q10.22, at most 5.
    excess: u16,
    /// Number of the table of highlights, counted from 1; 0 if there is none. See [`super::highlight_tables`].
    pub(super) table: u16,
    /// Sums for [`OneLightRgb`](super::constant_lights::OneLightRgb): of the first light, of the second light, and of the first light again, so that
    /// two neighbours are both lights in either order. One array is for even rows, one for odd rows.
    pub(super) sums: [[Sums; 3]; 2],
    /// The sums to which [`Factors::add`] adds all lights: ambient light, minus what a table entry without a highlight would add for each light.
    pub(crate) ambient_sums: [i32; 3],
    /// The level without diffuse light and the diffuse level at cosine 1, Q9.7, in the channel that is the index of the table of colours.
    pub(super) ramp: [i32; 2],
    /// Channels at full level for dither, Q0.8 scaled to the output's depth.
    pub(super) base: [u16; 3],
    /// Not 0 if [`Self::three_channels`], and [`NEUTRAL`] if [`Self::is_neutral`].
    three_channels: u8,
    /// Not 0 if [`Self::has_ramp`].
    has_ramp: u8,
    /// Number of lights, if it is one or two, the method has loops for them, and their levels fit their formats; [`SUMMED`] for other lights; otherwise
    /// 0.
    pub(crate) lights: u8,
    /// Not 0 if [`Self::has_two_lights`].
    has_two_lights: u8,
    /// Not 0 if highlights, or lights, are computed where they cannot be seen. The feature `skips` can turn this on.
    computes_all: [u8; 2],
}

/// See [`Reflectance::is_neutral`].
const NEUTRAL: u8 = 2;

impl Reflectance {
    /// Computes the reflectance of `material` under `lights`, for a method with these highlights and for a pixel format with these `channels`.
    /// If the method allows it, and there is one channel and one light, the table of highlights `holds_levels` instead of fractions. A material
    /// `is_coloured` if a mesh has it whose corners have colours. The last flag tells whether the viewer is near.
    pub fn fill(
        &mut self,
        channels: Channels,
        ambient: [u16; 3],
        material: &Material,
        lights: &[Light],
        (highlight, holds_levels): (Highlight, bool),
        [is_coloured, is_viewer_near]: [bool; 2],
    ) {
        let is_coloured = VERTEX_COLOURS && is_coloured;
        let Channels { depth, is_gray, is_coarse, .. } = channels;
        let LightTerms { colours: terms, base, are_one_channel } = LightTerms::new(&channels, ambient, material, lights);
        let is_plain = !LIGHT_SHAPES || !lights.iter().any(Light::has_shape);
        // There are loops for one light: a directional one, or a near one without a cone on a surface of one colour for a far viewer.
        let is_one = match lights {
            [light] if NEAR_LIGHTS && light.kind == POINT => light.axis == [0; 3] && !is_coloured && !is_viewer_near,
            [_] => is_plain,
            _ => false,
        };
        // Loops for other lights have three channels except in greys, and in one channel loops for one light have no room for the brightest levels.
        let are_several = SUMS_LIGHTS && !is_one && !lights.is_empty();
        let is_bright = || terms.iter().map(|&term| u32::from(level(largest(term), 8))).sum::<u32>() + (1 << LEVEL) >= LARGEST;
        let one_channel = !COLOURS || are_one_channel && (is_gray || !(is_coloured || holds_levels && (are_several || is_bright())));
        self.depth = depth;
        self.quarter = 0;
        let is_neutral = terms.iter().all(|&[r, g, b]| r == g && g == b);
        self.three_channels = u8::from(!one_channel) << u8::from(is_neutral);
        let levels = |colour: Colour| -> [u16; 3] { if one_channel { [level(largest(colour), 8); 3] } else { zip(colour, depth, level) } };
        self.ambient = levels(terms.last().copied().unwrap_or_default()).map(i32::from);
        for (gains, terms) in self.gains.iter_mut().zip(terms.chunks_exact(2)) {
            if let &[diffuse, specular] = terms {
                *gains = Gains { diffuse: levels(diffuse), specular: levels(specular) };
            }
        }
        let total = self.total(channels.is_checkered, lights.len());
        self.table = 0;
        // Where light is summed, normals that are a little too long are not limited to 1: streams allow 1 + 2^-9.
        let most = if are_several { total + (total >> 8) } else { total };
        let excess = (most >> (9 + LEVEL)).checked_ilog2().map_or(0, |bits| bits + 1);
        self.excess = excess as u16;
        let fits = if one_channel { total < LARGEST } else { excess == 0 };
        let (ambient, diffuse) = (self.ambient, self.gains[0].diffuse);
        let within = zip(ambient, diffuse, |ambient, diffuse| ambient + i32::from(diffuse) <= FULL) == [true; 3];
        self.has_ramp = u8::from(!is_coloured && (one_channel || is_coarse && lights.len() == 1 && within));
        let most = (1..3).fold(0, |most, k| if diffuse[k] > diffuse[most] { k } else { most });
        self.ramp = [ambient[most], diffuse[most].into()];
        let are_directional = !NEAR_LIGHTS || lights.iter().all(|light| light.kind != POINT);
        let are_two = lights.len() == 2 && !one_channel && is_plain && are_directional && !is_coloured;
        // There are no loops for colours of corners in greys.
        let has_loops = holds_levels && !(is_coloured && is_gray);
        self.lights = match has_loops && fits {
            true if is_one || are_two => lights.len() as u8,
            _ if has_loops && are_several && (is_gray || !one_channel) => SUMMED,
            _ => 0,
        };
        self.has_two_lights = u8::from(are_two && fits);
        let holds_levels = self.lights == 1 && one_channel;
        // Where lights are summed, half of the sky's light is ambient. Elsewhere cosines are rounded down: half of their last place more. Of all
        // lights, so that it does not matter which of them is first, nor whether one is left out.
        let summed = self.lights == SUMMED;
        let mut more = [0; 3];
        for (gains, _) in self.gains.iter().zip(lights).filter(|(_, light)| !summed || light.is_sky()) {
            more = zip(more, gains.diffuse, |more, gain| more + i32::from(gain));
        }
        let less = self.summed_excess();
        let bits = if summed { FACTOR - less } else { 0 };
        let ambient = zip(self.ambient, more, |level, more| (level << (FACTOR - less)).wrapping_add((more << bits) >> 1));
        let [even, odd] = &mut self.sums;
        for (sums, gains) in even.iter_mut().zip(&self.gains) {
            for (k, sum) in sums.iter_mut().enumerate() {
                *sum = Sum::new(ambient[k].wrapping_add(half_step(depth[k]) >> less), gains.diffuse[k], gains.specular[k]);
            }
        }
        // Greys have no three channels.
        if !is_gray {
            let [first, _, again] = even;
            *again = *first;
            *odd = *even;
        }
        let is_matt = self.gains.iter().take(lights.len()).all(|gains| gains.specular == [0; 3]);
        let [one, ..] = &mut self.gains;
        let (mut full, mut floor) = (1 << ENTRY, 0);
        if holds_levels {
            (full, floor) = (one.specular[0].into(), Self::biased(self.ambient[0]) as u16);
            // The remaining specular gain is 65535/65536.
            if !is_matt {
                one.specular = [u16::MAX; 3];
            }
        }
        self.highlights = HighlightCurve::new(material.exponent, highlight, full, floor);
        // Intensities are rounded down, and so are cosines: half of their last place more.
        let mut sums = self.ambient.map(|level| (level << (FACTOR - excess)) + (1 << (CHANNEL - 9 - excess)));
        for light in 0..lights.len() {
            let factors = self.factors(light);
            let none = factors.at(0, self.highlights.floor());
            sums = zip(sums, zip(factors.diffuse, none, |diffuse, none| (diffuse >> 1) - none), i32::wrapping_add);
        }
        self.ambient_sums = sums;
        self.highlight_threshold = match highlight {
            // Loops for greys have no code of their own without a highlight: they look up the level of ambient light.
            _ if is_matt && !(is_gray && holds_levels) => Self::NO_HIGHLIGHT,
            Highlight::Root => square(self.highlights.highlight_threshold()),
            _ => self.highlights.highlight_threshold(),
        };
        let whole = largest(base).max(1);
        self.base = zip(base, depth, |channel, depth| share(channel, whole, depth));
    }

    /// Whether three levels are walked instead of one, because the colours of the material are not multiples of one colour.
    #[inline]
    pub fn three_channels(&self) -> bool {
        COLOURS && self.three_channels != 0
    }

    /// Whether there are three channels although neither the material nor the light has a hue: it is a mesh with colours of its own.
    #[inline]
    pub(crate) fn is_neutral(&self) -> bool {
        self.three_channels == NEUTRAL
    }

    /// Whether all light without a highlight under one light is a level of the table of colours. It is in one channel, and in three unless a level
    /// exceeds 255 or the pixel format is finer than the table.
    #[inline]
    pub fn has_ramp(&self) -> bool {
        !COLOURS || self.has_ramp != 0
    }

    /// Whether the table of highlights holds levels: the ambient level plus the highlight of the only light.
    #[inline]
    pub fn holds_levels(&self) -> bool {
        self.lights == 1 && !self.three_channels()
    }

    /// The table of highlights among `tables`, if there is one for this material.
    #[inline]
    pub(crate) fn table<'t>(&self, tables: &'t [HighlightLut]) -> Option<&'t HighlightLut> {
        tables.get(usize::from(self.table).wrapping_sub(1))
    }

    /// Whether there are two lights on three channels, and their sums fit a word.
    #[inline]
    pub fn has_two_lights(&self) -> bool {
        LIGHTS && COLOURS && self.has_two_lights != 0
    }

    /// Whether light is summed, see [`crate::lighting::summed`].
    #[inline]
    pub(crate) fn sums_lights(&self) -> bool {
        SUMS_LIGHTS && self.lights == SUMMED
    }

    /// [`Self::highlight_threshold`] of a material without highlights, greater than every N·H.
    pub(crate) const NO_HIGHLIGHT: i32 = i32::MAX;

    /// Whether the material has no highlight under the lights of the scene, so that it needs no table. Greys whose table holds
    /// levels always need one.
    #[inline]
    pub fn is_matt(&self) -> bool {
        self.highlight_threshold == Self::NO_HIGHLIGHT
    }

    /// Whether the light of all lights fits a word as [`Sum`]s add it up.
    #[inline]
    pub fn sums_fit(&self) -> bool {
        self.excess == 0
    }

    /// Dithers three channels by rows: even ones are a quarter of a step lower, odd ones higher.
    pub(crate) fn dither(&mut self) {
        self.quarter = 1 << (CHANNEL - 2);
        let less = self.summed_excess();
        for (rows, quarter) in self.sums.iter_mut().zip([-self.quarter, self.quarter]) {
            for sums in rows {
                *sums = zip(*sums, steps(self.depth, quarter), |sum, step| sum.raised(step >> less));
            }
        }
    }

    /// The levels of ambient light in the sums of the first light, without what is added there for rounding and dither.
    pub(crate) fn pure_ambient(&self) -> [i32; 3] {
        let ([[first, ..], _], less) = (&self.sums, self.summed_excess());
        let raised = zip(steps(self.depth, -self.quarter), self.depth, |step, depth| (half_step(depth) >> less) + (step >> less));
        zip(map(*first, |sum| sum.ambient), raised, i32::wrapping_sub)
    }

    /// A level, Q9.7, of sums as vertices hold them. Domain: [`Self::sums_lights`].
    #[inline]
    pub(crate) fn summed_level(&self, sum: i32) -> i32 {
        sum >> (FACTOR - self.excess())
    }

    /// Turns two savings on or off: leaving out highlights where none can be seen, and lights that do not reach a triangle.
    #[cfg(feature = "skips")]
    pub(crate) fn leave_out(&mut self, highlights: bool, lights: bool) {
        self.computes_all = [highlights, lights].map(|left_out| u8::from(!left_out));
    }

    /// N·H, Q2.30, below which a highlight is left out: [`Self::highlight_threshold`] unless that is switched off.
    #[inline]
    pub(crate) fn faintest(&self) -> i32 {
        if SKIPS && self.computes_all[0] != 0 && !self.is_matt() { i32::MIN } else { self.highlight_threshold }
    }

    /// N·L, Q2.30, up to which a light is left out: 0 unless that is switched off.
    #[inline]
    pub(crate) fn darkest(&self) -> i32 {
        if SKIPS && self.computes_all[1] != 0 { i32::MIN } else { 0 }
    }

    /// The level of the table of colours without highlight at N·L (Q2.30) under one light, Q9.7. Domain: [`Self::has_ramp`].
    #[inline]
    pub fn ramp_level(&self, cosine: i32) -> i32 {
        diffuse_level(self.ramp, cosine)
    }

    /// Rise of each channel if the level of the table of colours rises by `raise`, Q9.7. Domain: [`Self::has_ramp`].
    pub fn ramp_rise(&self, raise: i32) -> [i32; 3] {
        let share = |gain: u16| (raise * i32::from(gain)).checked_div(self.ramp[1]).unwrap_or(0);
        self.gains[0].diffuse.map(share)
    }

    /// Levels of three channels under one light, Q9.7 in [0, 255], from N·L (Q2.30) and a highlight (unsigned Q0.16).
    #[inline]
    pub fn reflection(&self, cosine: i32, highlight: u32) -> [i32; 3] {
        [self.channel(0, cosine, highlight), self.channel(1, cosine, highlight), self.channel(2, cosine, highlight)]
    }

    /// The level of a channel under one light, Q9.7 in [0, 255], from N·L (Q2.30) and a highlight (unsigned Q0.16).
    #[inline]
    fn channel(&self, channel: usize, cosine: i32, highlight: u32) -> i32 {
        let ([gains, ..], n) = (&self.gains, channel % 3);
        let diffuse = diffuse_level([self.ambient[n], gains.diffuse[n].into()], cosine);
        (diffuse + reflected((0, gains.specular[n]), 0, highlight)).min(FULL)
    }

    /// The parts of [`Self::reflection`].
    #[inline]
    pub(crate) fn reflected_parts(&self, cosine: i32, highlight: u32) -> Parts {
        let [gains, ..] = &self.gains;
        let mut parts = self.unlit_parts();
        parts.add(gains, cosine, highlight);
        parts
    }

    /// The parts of ambient light alone.
    #[inline]
    fn unlit_parts(&self) -> Parts {
        Parts { diffuse: self.ambient, specular: [0; 3] }
    }

    /// The levels of the table of colours without highlight at six nodes with these cosines, under one light, not clamped, Q9.7. Domain:
    /// [`Self::has_ramp`].
    #[inline]
    pub fn six_diffuse(&self, [a, b, c, ab, bc, ca]: [i32; 6]) -> [i32; 6] {
        let level = |cosine| diffuse_level(self.ramp, cosine);
        [level(a), level(b), level(c), level(ab), level(bc), level(ca)]
    }

    /// Levels as in [`Self::six_diffuse`], clamped to 255.
    #[inline]
    pub fn six_diffuse_clamped(&self, cosines: [i32; 6]) -> [i32; 6] {
        let [ambient, diffuse] = self.ramp;
        if ambient + diffuse <= FULL {
            return self.six_diffuse(cosines);
        }
        let [a, b, c, ab, bc, ca] = cosines;
        let level = |cosine| diffuse_level(self.ramp, cosine).min(FULL);
        [level(a), level(b), level(c), level(ab), level(bc), level(ca)]
    }

    /// The levels of a channel under one light, Q9.7 in [0, 255], at six nodes of these cosines and highlights (unsigned Q0.16).
    #[inline]
    pub fn six(&self, channel: usize, [a, b, c, ab, bc, ca]: [i32; 6], [i, j, k, ij, jk, ki]: [u32; 6]) -> [i32; 6] {
        let level = |cosine, highlight| self.channel(channel, cosine, highlight);
        [level(a, i), level(b, j), level(c, k), level(ab, ij), level(bc, jk), level(ca, ki)]
    }

    /// Levels under two lights, Q9.7 in [0, 255], from a cosine, Q1.15, and a highlight, unsigned Q0.16, of each.
    #[inline]
    fn two_sums(&self, [[cosine, highlight], [other, other_highlight]]: [[i32; 2]; 2]) -> [i32; 3] {
        let [[first, second, _], _] = &self.sums;
        let level = |ambient: i32, first: &Sum, second: &Sum| {
            let sum = first.light(cosine, highlight).wrapping_add(second.light(other, other_highlight));
            ((ambient << FACTOR) + (1 << (FACTOR - 1))).wrapping_add(sum) >> FACTOR
        };
        let ([r, g, b], [r1, g1, b1], [r2, g2, b2]) = (self.ambient, first, second);
        [level(r, r1, r2).min(FULL), level(g, g1, g2).min(FULL), level(b, b1, b2).min(FULL)]
    }

    /// [`Self::excess`] where light is summed. The sums of one light or two fit a word; there it is 0.
    fn summed_excess(&self) -> u32 {
        if self.lights == SUMMED { self.excess() } else { 0 }
    }

    /// Bits by which the sum of all lights may leave Q10.22, at most 5.
    #[inline]
    pub(super) fn excess(&self) -> u32 {
        u32::from(self.excess)
    }

    /// Factors of light number `light`.
    #[inline]
    pub fn factors(&self, light: usize) -> Factors {
        let Gains { diffuse, specular } = self.gains.get(light).copied().unwrap_or(Gains::NONE);
        let excess = self.excess;
        let ([dr, dg, db], [sr, sg, sb]) = (diffuse, specular);
        let (diffuse, specular) = (|gain: u16| i32::from(gain) >> excess, |gain: u16| (i32::from(gain) + 1) >> (1 + excess));
        Factors { diffuse: [diffuse(dr), diffuse(dg), diffuse(db)], specular: [specular(sr), specular(sg), specular(sb)] }
    }

    /// Converts sums of all lights to intensities.
    #[inline]
    pub fn intensities(&self) -> impl Fn([i32; 3]) -> Intensity + use<> {
        let shift = (CHANNEL - 8 - u32::from(self.excess)) & 31;
        // Armv7-M clamps by one instruction.
        let intensity = move |sum: i32| (sum >> shift).clamp(0, (1 << 16) - 1);
        move |[r, g, b]| [intensity(r), intensity(g), intensity(b)]
    }

    #[inline]
    fn add(&self, levels: &mut [i32; 3], gains: &Gains, diffuse: i32, highlight: u32) {
        let light = |level: i32, gains| level.saturating_add(reflected(gains, diffuse, highlight));
        if !self.three_channels() {
            *levels = [light(levels[0], (gains.diffuse[0], gains.specular[0])); 3];
        } else {
            let ([r, g, b], [dr, dg, db], [sr, sg, sb]) = (*levels, gains.diffuse, gains.specular);
            *levels = [light(r, (dr, sr)), light(g, (dg, sg)), light(b, (db, sb))];
        }
    }

    /// A level, Q9.7, as an index of the table of colours, with bias and half a step for rounding.
    pub(super) fn biased(level: i32) -> u32 {
        (level + (BIAS << LEVEL) + (1 << (LEVEL - 1))) as u32
    }

    /// The largest level under `lights` lights, Q9.7 or more bits, and the constant for rounding: half a step of a channel, or with a checkerboard
    /// three quarters.
    fn total(&self, is_checkered: bool, lights: usize) -> u32 {
        let quarters = if is_checkered { 3 } else { 2 };
        let mut total = zip(self.ambient, self.depth, |level, depth| level as u32 + (quarters << (LEVEL + 6 - depth)));
        for gains in self.gains.iter().take(lights) {
            let light = zip(gains.diffuse, gains.specular, |diffuse, specular| u32::from(diffuse) + u32::from(specular));
            total = zip(total, light, |total, light| total + light);
        }
        largest(total)
    }

    /// An intensity in unsigned Q8.8 that is scaled to the depths of the pixel format, by the curve of a display.
    #[inline]
    pub fn scaled(&self, intensity: Intensity, gamma: Option<&Gamma>) -> [u32; 3] {
        let intensity = intensity.map(|level| level.min(255 << 8));
        let [level, ..] = intensity;
        let scaled = if self.three_channels() {
            intensity.map(|level| level as u32)
        } else {
            self.base.map(|base| (level as u32 * u32::from(base)) >> 8)
        };
        gamma.map_or(scaled, |gamma| zip(scaled, self.depth, |level, depth| gamma.encoded(level, depth)))
    }
}

/// A material under the lights of a scene, with its table of highlights if there is memory for one.
#[derive(Clone, Copy, Debug)]
pub struct LitMaterial<'f> {
    reflectance: &'f Reflectance,
    table: Option<&'f HighlightLut>,
}

impl Deref for LitMaterial<'_> {
    type Target = Reflectance;

    #[inline]
    fn deref(&self) -> &Reflectance {
        self.reflectance
    }
}

impl<'f> LitMaterial<'f> {
    /// A material and its table, which has been filled with the curve of its highlights.
    #[inline]
    pub fn new(reflectance: &'f Reflectance, table: Option<&'f HighlightLut>) -> Self {
        Self { reflectance, table }
    }

    /// The material without its table.
    #[inline]
    pub fn reflectance(self) -> &'f Reflectance {
        self.reflectance
    }

    /// The table of highlights. Renderers refuse methods that need one if there is none.
    #[inline]
    pub fn table(self) -> Option<&'f HighlightLut> {
        self.table
    }

    /// The highlight at N·H (Q2.30), unsigned Q0.16.
    #[inline]
    pub fn highlight_at(self, half: i32) -> u32 {
        match self.table {
            Some(table) => table.at(half),
            None => self.highlights.at(half),
        }
    }

    /// The level of a material of one channel under one light, Q9.7 in [0, 255], from `[N·L, N·H]` (Q2.30).
    #[inline(never)]
    pub fn level(self, [diffuse, half]: [i32; 2]) -> i32 {
        let [gains, ..] = &self.gains;
        let light = reflected((gains.diffuse[0], gains.specular[0]), diffuse, self.highlight(half));
        (self.ambient[0] + light).min(FULL)
    }

    /// The highlight at N·H (Q2.30), unsigned Q0.16, 0 where none can be seen.
    #[inline]
    pub fn highlight(self, half: i32) -> u32 {
        if half < self.highlight_threshold { 0 } else { self.highlight_at(half) }
    }

    /// The diffuse level at cosine 1 and the level of a whole highlight of a light, Q9.7, each in the channel where it is largest.
    #[inline]
    pub fn largest_gains(self, light: usize) -> [u32; 2] {
        let Gains { diffuse, specular } = self.gains.get(light).copied().unwrap_or(Gains::NONE);
        // Written out: `map` of arrays goes through memory at opt-level "s".
        let most = |[r, g, b]: [u16; 3]| u32::from(r.max(g).max(b));
        [most(diffuse), if self.holds_levels() { self.highlight(1 << COSINE) } else { most(specular) }]
    }

    /// Levels under one light, Q9.7 in [0, 255], from `[N·L, N·H]` (Q2.30).
    #[inline]
    pub fn one_light(self, cosines: [i32; 2]) -> [i32; 3] {
        if self.three_channels() { self.levels(core::iter::once(cosines.into())) } else { [self.level(cosines); 3] }
    }

    /// Levels at a point, Q9.7 in [0, 255], from what falls on it from each light.
    #[inline]
    pub fn levels(self, incident: impl Iterator<Item = Incident>) -> [i32; 3] {
        let mut levels = self.ambient;
        for (gains, Incident { towards, half, strength }) in self.gains.iter().zip(incident) {
            let mut light = Reflection { diffuse: towards, highlight: self.highlight_at(half) };
            if LIGHT_SHAPES {
                light = light.weakened(strength, 0);
            }
            self.add(&mut levels, gains, light.diffuse, light.highlight);
        }
        levels.map(|level| level.min(FULL))
    }

    /// The parts of [`Self::levels`].
    #[inline]
    pub(crate) fn parts(self, incident: impl Iterator<Item = Incident>) -> Parts {
        let mut parts = self.unlit_parts();
        for (gains, Incident { towards, half, strength }) in self.gains.iter().zip(incident) {
            let mut light = Reflection { diffuse: towards, highlight: self.highlight_at(half) };
            if LIGHT_SHAPES {
                light = light.weakened(strength, 0);
            }
            parts.add(gains, light.diffuse, light.highlight);
        }
        parts
    }

    /// The parts of [`Self::constant_levels`].
    #[inline(never)]
    pub(crate) fn constant_parts<N: UnitNormal>(self, sources: &[Source], normal: &N) -> Parts {
        let mut parts = self.unlit_parts();
        for (gains, source) in self.gains.iter().zip(sources) {
            let Some(&[towards, half]) = source.directional() else { continue };
            let cosine = normal.cosine(towards);
            let (towards, highlight) =
                if source.is_sky() { (part_of_sky(cosine, COSINE), 0) } else { (cosine, self.highlight(normal.cosine(half))) };
            parts.add(gains, towards, highlight);
        }
        parts
    }

    /// Adds the highlight of light number `light` at N·H, Q2.30.
    #[inline]
    pub(crate) fn add_highlight(self, parts: &mut Parts, light: usize, half: i32) {
        if let Some(gains) = self.gains.get(light) {
            parts.add(gains, 0, self.highlight(half));
        }
    }

    /// Levels under constant lights, Q9.7 in [0, 255], of a unit normal.
    #[inline(never)]
    pub fn constant_levels<N: UnitNormal>(self, sources: &[Source], normal: &N) -> [i32; 3] {
        if sources.len() > 2 || self.excess != 0 {
            return self.many_constant_levels(sources, normal);
        }
        let mut lit = [[0; 2]; 2];
        for (lit, source) in lit.iter_mut().zip(sources) {
            if let Some(&[towards, half]) = source.directional() {
                let cosine = normal.cosine(towards);
                let towards = if source.is_sky() { part_of_sky(cosine, COSINE) } else { cosine };
                *lit = [node_cosine(towards), self.highlight(normal.cosine(half)) as i32];
            }
        }
        self.two_sums(lit)
    }

    /// Levels under two lights, Q9.7 in [0, 255], from N·L and N·H (Q2.30) of one, then of the other. Domain: [`Self::has_two_lights`].
    #[inline]
    pub fn two_lights(self, [towards, half, other, other_half]: [i32; 4]) -> [i32; 3] {
        let lit = |towards, half| [node_cosine(towards), self.highlight(half) as i32];
        self.two_sums([lit(towards, half), lit(other, other_half)])
    }

    /// Levels as in [`Self::constant_levels`], for sums that do not fit a word, or for more than two lights.
    #[inline(never)]
    fn many_constant_levels<N: UnitNormal>(self, sources: &[Source], normal: &N) -> [i32; 3] {
        let bits = (FACTOR - self.excess()) & 31;
        let [mut r, mut g, mut b] = [1i32 << (bits - 1); 3];
        for (light, source) in sources.iter().enumerate() {
            let Some(&[towards, half]) = source.directional() else { continue };
            let cosine = normal.cosine(towards);
            let (towards, highlight) =
                if source.is_sky() { (part_of_sky(cosine, COSINE), 0) } else { (cosine, self.highlight(normal.cosine(half))) };
            // One by one: arrays go through memory at opt-level "s".
            let [red, green, blue] = self.factors(light).at(node_cosine(towards), highlight);
            (r, g, b) = (r.wrapping_add(red), g.wrapping_add(green), b.wrapping_add(blue));
        }
        let ([red, green, blue], level) = (self.ambient, |ambient: i32, sum: i32| (ambient + (sum >> bits)).min(FULL));
        [level(red, r), level(green, g), level(blue, b)]
    }
}

/// The level without highlight, not clamped, rounded as by [`reflected`]. `ambient` is the ambient level, `diffuse` the diffuse level at cosine 1.
#[inline]
fn diffuse_level([ambient, diffuse]: [i32; 2], cosine: i32) -> i32 {
    let base = ((ambient as u32) << 15) + (1 << 14);
    ((base + diffuse as u32 * (cosine.max(0) as u32 >> (COSINE - 15))) >> 15) as i32
}

impl Parts {
    /// Adds what a light with these gains adds, from N·L (Q2.30) and a highlight (unsigned Q0.16). All lights together have 20 bits.
    #[inline]
    fn add(&mut self, gains: &Gains, towards: i32, highlight: u32) {
        if towards > 0 {
            let cosine = towards as u32 >> (COSINE - 15);
            let lit = |level: i32, gain: u16| level.wrapping_add(((u32::from(gain) * cosine + (1 << 14)) >> 15) as i32);
            let ([r, g, b], [red, green, blue]) = (self.diffuse, gains.diffuse);
            self.diffuse = [lit(r, red), lit(g, green), lit(b, blue)];
        }
        if highlight > 0 {
            let lit = |level: i32, gain: u16| level.wrapping_add(((u32::from(gain) * highlight + (1 << (ENTRY - 1))) >> ENTRY) as i32);
            let ([r, g, b], [red, green, blue]) = (self.specular, gains.specular);
            self.specular = [lit(r, red), lit(g, green), lit(b, blue)];
        }
    }
}

/// Light that a surface reflects at a pixel, before the gains of the material.
#[derive(Clone, Copy, Debug)]
pub struct Reflection {
    /// N·L, Q5.27; negative where the light is behind the surface.
    pub diffuse: i32,
    /// The highlight, a power of a cosine, unsigned Q0.16.
    pub highlight: u32,
}

impl Reflection {
    /// The light of a source that has this part of its strength, up to 1 << [`STRENGTH`]. The diffuse light may have any format. A table of
    /// highlights holds `floor` where there is no highlight.
    #[inline]
    pub(crate) fn weakened(self, strength: u32, floor: u32) -> Self {
        let diffuse = (product(self.diffuse, strength as i32) >> STRENGTH) as i32;
        let highlight = unsigned_product(self.highlight.saturating_sub(floor), strength) >> STRENGTH;
        Self { diffuse, highlight: highlight as u32 + floor }
    }

    /// The light of the sky about L, where this is that of a directional light: there is no highlight.
    #[inline]
    pub(crate) fn of_sky(self) -> Self {
        Self { diffuse: part_of_sky(self.diffuse, PIXEL_COSINE), highlight: 0 }
    }
}

/// The level, Q9.7, of light reflected with the gains `(diffuse, specular)`, for N·L (Q2.30) and a highlight (Q0.16).
#[inline]
fn reflected((diffuse, specular): (u16, u16), cosine: i32, highlight: u32) -> i32 {
    let cosine = cosine.max(0) as u32 >> (COSINE - 15);
    let diffuse = (u32::from(diffuse) * cosine + (1 << 14)) >> 15;
    let specular = (u32::from(specular) * highlight + (1 << (ENTRY - 1))) >> ENTRY;
    (diffuse + specular) as i32
}

/// N·L of a node, Q2.30, as a factor of diffuse light, Q1.15; 0 if it is negative.
#[inline]
pub(super) fn node_cosine(cosine: i32) -> i32 {
    cosine.max(0) >> (COSINE - FACTOR)
}

/// The share of a channel in a colour whose largest is `whole`, Q0.8 scaled to what an output of `depth` bits can show.
#[inline(never)]
fn share(channel: u32, whole: u32, depth: u32) -> u16 {
    let full = ((1 << depth) - 1) << (16 - depth);
    let whole = u64::from(whole) * 255;
    long(u64::from(channel) * full + whole / 2, whole) as u16
}

/// A product of two gains (Q4.28, 1 is full) as a level in Q9.7 whose upper `depth` bits are the channel.
#[inline(never)]
fn level(product: u32, depth: u32) -> u16 {
    let full = ((1u64 << depth) - 1) << (8 - depth + LEVEL);
    ((u64::from(product) * full + (1 << (2 * UNIT - 1))) >> (2 * UNIT)).min(u64::from(u16::MAX)) as u16
}
