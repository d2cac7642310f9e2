//! Ordered dither: a threshold that changes from pixel to pixel in place of rounding.

/// 4x4 ordered dither (Bayer 1973): thresholds in 1/32 of an output step, one row after the other.
const BAYER: [[u8; 4]; 4] = [[1, 17, 5, 21], [25, 9, 29, 13], [7, 23, 3, 19], [31, 15, 27, 11]];

/// The threshold at a pixel, 1/32 of an output step.
#[inline(always)]
#[must_use]
pub fn threshold(x: usize, y: usize) -> u32 {
    BAYER[y & 3][x & 3].into()
}

/// Channels of `depth` bits from channels in unsigned Q8.8 that are scaled to that depth, with a [`threshold`] in place of rounding.
#[inline(always)]
#[must_use]
pub fn quantise(channels: [u32; 3], depth: [u32; 3], threshold: u32) -> [u8; 3] {
    let mut out = [0; 3];
    for (out, (channel, depth)) in out.iter_mut().zip(channels.into_iter().zip(depth)) {
        // One output step is 2^(16 - depth) of the Q8.8 channel.
        *out = (((channel << 5) + (threshold << (16 - depth))) >> (21 - depth)).min((1 << depth) - 1) as u8;
    }
    out
}
