//! Figures of errors.

use anyhow::{Context, Result};
use image::RgbImage;

/// The distribution of errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The largest, without its sign.
    pub max: f64,
    /// 99 in 100 are not larger, without their signs.
    pub p99: f64,
    /// Root of the mean square.
    pub rmse: f64,
}

impl Spread {
    /// The spread of these errors; `None` if there are none.
    #[must_use]
    pub fn of(errors: &[f64]) -> Option<Self> {
        let mut sizes: Vec<f64> = errors.iter().map(|error| error.abs()).collect();
        // What is no number counts as larger than all numbers, so that it shows.
        sizes.sort_by(f64::total_cmp);
        let max = *sizes.last()?;
        let square: f64 = sizes.iter().map(|size| size * size).sum();
        Some(Self { max, p99: quantile(&sizes, 0.99), rmse: (square / sizes.len() as f64).sqrt() })
    }
}

/// The value that `share` of the sorted numbers do not exceed, linear between two of them.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * sorted.len().saturating_sub(1) as f64;
    let at = |index: f64| sorted.get(index as usize).copied().unwrap_or(f64::NAN);
    let (low, high) = (at(place.floor()), at(place.ceil()));
    low + (high - low) * place.fract()
}

/// 1 minus the mean difference of all channels, where full intensity is 1 (Vlasic 2002, section 6.1). Equal pictures have 1, black and white have 0.
///
/// Pass pixels that show something: a background is always right.
#[must_use]
pub fn colour_correctness(pairs: &[[[u8; 3]; 2]]) -> f64 {
    let sum: f64 = differences(pairs).map(|d| f64::from(d.unsigned_abs())).sum();
    1.0 - sum / (3.0 * 255.0 * pairs.len().max(1) as f64)
}

/// Peak signal-to-noise ratio in dB, over all channels; infinite if all pixels are equal.
#[must_use]
pub fn psnr(pairs: &[[[u8; 3]; 2]]) -> f64 {
    let square: f64 = differences(pairs).map(|d| f64::from(d) * f64::from(d)).sum();
    10.0 * (255.0 * 255.0 * 3.0 * pairs.len() as f64 / square).log10()
}

fn differences(pairs: &[[[u8; 3]; 2]]) -> impl Iterator<Item = i16> + '_ {
    pairs.iter().flat_map(|[a, b]| (0..3).map(|k| i16::from(a[k]) - i16::from(b[k])))
}

/// Similarity of two pictures in structure (SSIM of luma) and colour: 1 for equal pictures, 0 for unlike ones.
///
/// # Errors
/// When a picture has not `width` times `height` pixels.
pub fn similarity(width: u32, height: u32, pictures: [&[[u8; 3]]; 2]) -> Result<f64> {
    let image = |pixels: &[[u8; 3]]| RgbImage::from_raw(width, height, pixels.as_flattened().to_vec()).context("a picture of another size");
    let [a, b] = pictures;
    Ok(image_compare::rgb_hybrid_compare(&image(a)?, &image(b)?)?.score)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_of_known_errors() {
        assert_eq!(Spread::of(&[]), None);
        assert_eq!(Spread::of(&[-3.0]), Some(Spread { max: 3.0, p99: 3.0, rmse: 3.0 }));
        let spread = Spread::of(&[3.0, -4.0]).expect("two errors");
        assert_eq!((spread.max, spread.rmse), (4.0, 12.5f64.sqrt()));
        assert!((spread.p99 - 3.99).abs() < 1e-12);
        // 0 to 100: the 99th of a hundred steps.
        let many: Vec<f64> = (0..=100).rev().map(f64::from).collect();
        assert_eq!(Spread::of(&many).map(|s| s.p99), Some(99.0));
    }

    #[test]
    fn what_is_no_number_shows() {
        assert!(Spread::of(&[1.0, f64::NAN, 2.0]).is_some_and(|s| s.max.is_nan()));
    }

    #[test]
    fn colours_by_hand() {
        let (black, white) = ([0; 3], [255; 3]);
        assert_eq!(colour_correctness(&[[white, white]]), 1.0);
        assert_eq!(colour_correctness(&[[black, white]]), 0.0);
        // 10 + 20 + 30 of 2 * 765.
        let pairs = [[[10, 0, 200], [0, 20, 230]], [black, black]];
        assert!((colour_correctness(&pairs) - (1.0 - 60.0 / 1530.0)).abs() < 1e-15);
        // Mean square 1400 / 6.
        assert!((psnr(&pairs) - 10.0 * (65_025.0f64 * 6.0 / 1400.0).log10()).abs() < 1e-12);
        assert_eq!(psnr(&[[white, white]]), f64::INFINITY);
        assert_eq!(psnr(&[[black, white]]), 0.0);
    }

    #[test]
    fn similar_pictures() {
        let ramp: Vec<[u8; 3]> = (0..256).map(|i| [i as u8; 3]).collect();
        let reversed: Vec<_> = ramp.iter().rev().copied().collect();
        let same = similarity(16, 16, [&ramp, &ramp]).expect("same sizes");
        let other = similarity(16, 16, [&ramp, &reversed]).expect("same sizes");
        assert!((same - 1.0).abs() < 1e-6 && other < 0.5, "{same} {other}");
        assert!(similarity(16, 17, [&ramp, &ramp]).is_err());
    }
}
