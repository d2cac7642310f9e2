//! Ordered dither: a threshold that changes from pixel to pixel in place of rounding.

/// 8x8 ordered dither (Bayer 1973): the bits of the column and of its difference from the row, interleaved, the lowest of them counting
/// most.
const BAYER: [[u8; 8]; 8] = {
    let mut thresholds = [[0; 8]; 8];
    let mut place = 0;
    while place < 64 {
        let (x, y) = (place % 8, place / 8);
        let mut rank = 0;
        let mut bit = 0;
        while bit < 3 {
            rank = rank << 2 | ((x ^ y) >> bit & 1) << 1 | y >> bit & 1;
            bit += 1;
        }
        thresholds[y][x] = 2 * rank as u8 + 1;
        place += 1;
    }
    thresholds
};

/// The threshold at a pixel, 1/128 of an output step.
#[inline]
#[must_use]
pub const fn threshold(x: usize, y: usize) -> u32 {
    BAYER[y & 7][x & 7] as u32
}

/// The threshold that rounds.
pub const HALF: u32 = 64;
/// The thresholds on the squares of a checkerboard, a quarter of a step below [`HALF`] and above it.
pub const SQUARES: [u32; 2] = [HALF / 2, HALF / 2 + HALF];

/// Channels of `depth` bits from channels in unsigned Q8.8 that are scaled to that depth, with a [`threshold`] in place of rounding.
#[inline]
#[must_use]
pub fn quantise(channels: [u32; 3], depth: [u32; 3], threshold: u32) -> [u8; 3] {
    let mut out = [0; 3];
    for (out, (channel, depth)) in out.iter_mut().zip(channels.into_iter().zip(depth)) {
        // One output step is 2^(16 - depth) of the Q8.8 channel.
        *out = (((channel << 7) + (threshold << (16 - depth))) >> (23 - depth)).min((1 << depth) - 1) as u8;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each threshold once in every square of eight by eight, and every fourth of them in every square of two by two.
    #[test]
    fn thresholds_are_spread() {
        let mut all: [u32; 64] = core::array::from_fn(|k| threshold(k % 8 + 3, k / 8 + 5));
        all.sort_unstable();
        assert_eq!(all, core::array::from_fn(|k| 2 * k as u32 + 1));
        for k in 0..16 {
            let (x, y) = (2 * (k % 4), 2 * (k / 4));
            let mut quarters = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)].map(|(x, y)| threshold(x, y) / 32);
            quarters.sort_unstable();
            assert_eq!(quarters, [0, 1, 2, 3]);
        }
    }

    /// A level is shown by as many lit pixels as it has of full intensity.
    #[test]
    fn means_are_kept() {
        for depth in [1, 2, 4, 5, 6] {
            for level in (0..=255u32).step_by(5) {
                let full = ((1 << depth) - 1) << (16 - depth);
                let channel = (level * full + 127) / 255;
                let sum: u32 = (0..64).map(|k| u32::from(quantise([channel; 3], [depth; 3], threshold(k % 8, k / 8))[0])).sum();
                let wanted = f64::from(level) / 255.0 * f64::from(64 * ((1 << depth) - 1));
                assert!((f64::from(sum) - wanted).abs() <= 0.6, "{depth} bits, {level}: {sum}, not {wanted}");
            }
        }
    }
}
