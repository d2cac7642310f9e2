//! Correction of colours for the curve of a display.
//!
//! Lighting adds light, so levels are linear: half of the full level is half of the light. Most displays are not linear: their light is about the
//! power 2.2 of the value. A [`Gamma`] holds the inverse of this curve. Tables of colours are filled with corrected values, so pixels that are drawn
//! by a table cost nothing more.

use core::fmt;

/// The curve of a display, for [`Renderer::set_gamma`](crate::Renderer::set_gamma). Make your own with [`Self::new`] for a display that
/// [`SRGB`] does not suit.
#[derive(Clone, PartialEq, Eq)]
pub struct Gamma {
    /// The value to send for each level.
    levels: [u16; LEVELS],
    /// The value to send for each channel of light, for displays of each of [`DEPTHS`].
    light: [[u8; LIGHT]; DEPTHS.len()],
}

/// Levels of a curve.
const LEVELS: usize = 256;
/// Bits of a channel of light.
pub(super) const LIGHT_BITS: u32 = 9;
/// Values of a channel of light. A table for each depth is indexed by the channel itself, which saves a product and a division at each pixel.
const LIGHT: usize = 1 << LIGHT_BITS;
/// Bits of channels of the displays that light is made for.
const DEPTHS: [u32; 5] = [2, 3, 5, 6, 8];

/// The curve of sRGB displays (IEC 61966-2-1), about a power of 1/2.2. Values between entries are interpolated linearly, and are within
/// 0.47/255 of the exact curve.
#[rustfmt::skip]
pub static SRGB: Gamma = Gamma::new([
    0, 3254, 5545, 7227, 8604, 9792, 10849, 11806, 12687, 13506, 14273, 14997, 15683, 16337, 16962, 17561, 18138, 18694, 19231, 19751,
    20255, 20745, 21221, 21685, 22137, 22578, 23009, 23431, 23844, 24248, 24644, 25032, 25413, 25788, 26155, 26517, 26872, 27222, 27566,
    27905, 28239, 28568, 28893, 29213, 29529, 29840, 30148, 30452, 30752, 31048, 31341, 31630, 31916, 32199, 32479, 32756, 33030, 33301,
    33569, 33835, 34098, 34358, 34616, 34872, 35125, 35376, 35624, 35871, 36115, 36358, 36598, 36836, 37072, 37307, 37539, 37770, 37999,
    38226, 38451, 38675, 38897, 39118, 39337, 39554, 39770, 39984, 40197, 40408, 40618, 40827, 41034, 41240, 41445, 41648, 41850, 42051,
    42251, 42449, 42646, 42842, 43037, 43231, 43423, 43615, 43805, 43995, 44183, 44370, 44556, 44742, 44926, 45109, 45292, 45473, 45653,
    45833, 46012, 46189, 46366, 46542, 46717, 46891, 47065, 47237, 47409, 47580, 47750, 47920, 48088, 48256, 48423, 48590, 48755, 48920,
    49084, 49248, 49410, 49572, 49734, 49894, 50054, 50214, 50372, 50530, 50688, 50845, 51001, 51156, 51311, 51465, 51619, 51772, 51924,
    52076, 52228, 52378, 52529, 52678, 52827, 52976, 53124, 53271, 53418, 53564, 53710, 53856, 54000, 54145, 54288, 54432, 54575, 54717,
    54859, 55000, 55141, 55281, 55421, 55561, 55700, 55838, 55976, 56114, 56251, 56388, 56524, 56660, 56796, 56931, 57066, 57200, 57334,
    57467, 57600, 57733, 57865, 57997, 58128, 58259, 58390, 58520, 58650, 58779, 58908, 59037, 59165, 59293, 59421, 59548, 59675, 59802,
    59928, 60054, 60179, 60304, 60429, 60554, 60678, 60802, 60925, 61048, 61171, 61294, 61416, 61538, 61659, 61780, 61901, 62022, 62142,
    62262, 62382, 62501, 62620, 62739, 62857, 62976, 63093, 63211, 63328, 63445, 63562, 63679, 63795, 63911, 64026, 64142, 64257, 64371,
    64486, 64600, 64714, 64828, 64941, 65054, 65167, 65280,
]);

impl Gamma {
    /// Creates a curve: for each linear light level from 0 to 255, the value to send to the display, in units of 1/256 of a level: 0 to
    /// 65,280. Values between them are interpolated linearly.
    #[must_use]
    pub const fn new(levels: [u16; 256]) -> Self {
        let mut light = [[0; LIGHT]; DEPTHS.len()];
        let mut place = 0;
        while place < DEPTHS.len() * LIGHT {
            let (table, channel) = (place / LIGHT, place % LIGHT);
            light[table][channel] = Self::curved(&levels, channel as u32, DEPTHS[table]);
            place += 1;
        }
        Self { levels, light }
    }

    /// What to send for a `channel` of light that is scaled to a display of `depth` bits, in 1/256 of full light, also scaled to the display. It is
    /// rounded up, because thresholds of dither are smaller by half a level.
    const fn curved(levels: &[u16; LEVELS], channel: u32, depth: u32) -> u8 {
        let full = ((1 << depth) - 1) << (LIGHT_BITS - depth);
        // Black light is half a level, 1/510: see `pixel/light.rs`.
        let (above_black, range) = ((510 * channel).saturating_sub(full), 509 * full);
        let above_black = if above_black < range { above_black } else { range };
        // All products are below 2^32.
        let (level, part) = (above_black * 255 / range, above_black * 255 % range);
        let (level, part) = (level as usize, part * 256 / range);
        let next = if level + 1 < LEVELS { level + 1 } else { level };
        let value = (levels[level] as u32 * (256 - part) + levels[next] as u32 * part) >> 8;
        let value = if value < FULL_INTENSITY { value } else { FULL_INTENSITY };
        let full = ((1 << depth) - 1) << (8 - depth);
        (value * full).div_ceil(FULL_INTENSITY) as u8
    }

    /// The table of channels of light for a display of `depth` bits: what to send, see [`Self::curved`].
    #[inline]
    pub(super) const fn light(&self, depth: u32) -> &[u8; LIGHT] {
        let [two, three, five, six, eight] = &self.light;
        match depth {
            2 => two,
            3 => three,
            5 => five,
            6 => six,
            _ => eight,
        }
    }

    /// What to send for `level`, which is a channel in unsigned Q8.8 that is scaled to `depth` bits, and so is the result: both at most
    /// `2^16 - 2^(16 - depth)`, full intensity.
    #[inline(never)]
    pub(crate) fn encoded(&self, level: u32, depth: u32) -> u32 {
        let full = ((1 << depth) - 1) << (16 - depth);
        // Both products are below 2^32.
        let level = (level.min(full) * FULL_INTENSITY + full / 2).checked_div(full).unwrap_or(0);
        let (index, part) = (level >> 8, level & 0xFF);
        let at = |index: u32| u32::from(self.levels[index as usize % LEVELS]);
        let (below, above) = (at(index), at((index + 1).min(LEVELS as u32 - 1)));
        let value = (below * (256 - part) + above * part + 128) >> 8;
        (value.min(FULL_INTENSITY) * full + FULL_INTENSITY / 2) / FULL_INTENSITY
    }
}

/// Full intensity, unsigned Q8.8.
const FULL_INTENSITY: u32 = 255 << 8;

impl fmt::Debug for Gamma {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Gamma")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The curve of sRGB at a level in [0, 255].
    fn srgb(level: f64) -> f64 {
        let level = level / 255.0;
        255.0 * if level <= 0.003_130_8 { 12.92 * level } else { 1.055 * level.powf(1.0 / 2.4) - 0.055 }
    }

    #[test]
    fn the_table_of_srgb_is_exact_to_rounding() {
        for (level, &value) in SRGB.levels.iter().enumerate() {
            assert_eq!(value, (srgb(level as f64) * 256.0).round() as u16, "{level}");
        }
    }

    /// In all depths, by the curve in floating point.
    #[test]
    fn values_between_levels_are_close() {
        for depth in [1, 2, 3, 4, 5, 6, 8] {
            let full = ((1 << depth) - 1) << (16 - depth);
            let mut before = 0;
            for level in 0..=full {
                let scale = f64::from(full) / 255.0;
                let value = SRGB.encoded(level, depth);
                let off = f64::from(value) / scale - srgb(f64::from(level) / scale);
                assert!(off.abs() <= 0.47, "{depth} bits, {level}: {off}");
                assert!(before <= value && value <= full, "{depth} bits, {level}: {before}, {value}");
                before = value;
            }
            assert_eq!((SRGB.encoded(0, depth), SRGB.encoded(full, depth), SRGB.encoded(full + 1, depth)), (0, full, full), "{depth} bits");
        }
    }

    /// Tables of light follow the curve, rounded up, from black, which is half a level, to full light.
    #[test]
    fn light_follows_the_curve() {
        for depth in DEPTHS {
            let (full, sent_full) = (((1 << depth) - 1) << (LIGHT_BITS - depth), ((1 << depth) - 1) << (8 - depth));
            let table = SRGB.light(depth);
            for (channel, &sent) in table.iter().enumerate() {
                let level = (255.0 * (channel as f64 / f64::from(full) * 510.0 - 1.0) / 509.0).clamp(0.0, 255.0);
                let off = f64::from(sent) - srgb(level) / 255.0 * f64::from(sent_full);
                assert!((-0.47..1.0).contains(&off), "{depth} bits, {channel}: {sent}, off by {off}");
            }
            assert!(table.is_sorted() && table[0] == 0 && i32::from(table[full as usize]) == sent_full, "{depth} bits");
        }
    }
}
