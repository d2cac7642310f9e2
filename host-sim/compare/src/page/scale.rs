//! The colours of errors, and their legends.

use maud::{Markup, html};

/// Colours by number; the first is not used.
pub(super) type Palette = [[u8; 3]; 256];

/// Errors up to here are about evenly spread, larger ones by their logarithm, LSB.
const EVEN: f64 = 0.25;
/// The error, in 1/255, from which on all errors have one colour.
const MOST: f64 = 128.0;
/// Colours from far too dark to far too bright. They can be distinguished with any colour vision.
const COLOURS: [[f64; 3]; 7] = [
    [5.0, 48.0, 97.0],
    [33.0, 113.0, 181.0],
    [146.0, 197.0, 222.0],
    [247.0, 247.0, 247.0],
    [244.0, 165.0, 130.0],
    [203.0, 55.0, 52.0],
    [103.0, 0.0, 31.0],
];

/// The place of an error on the scale from -1 to 1.
fn place(error: f64) -> f64 {
    let size = (1.0 + error.abs().min(MOST) / EVEN).ln() / (1.0 + MOST / EVEN).ln();
    size.copysign(error)
}

/// The number of an error's colour.
pub(super) fn index(error: f64) -> u8 {
    (128.0 + 127.0 * place(error)).round() as u8
}

/// The colours that [`index`] numbers.
pub(super) fn palette() -> Palette {
    std::array::from_fn(|index| {
        let place = (index.max(1) as f64 - 1.0) / 254.0 * (COLOURS.len() - 1) as f64;
        let lower = (place as usize).min(COLOURS.len() - 2);
        let share = place - lower as f64;
        std::array::from_fn(|k| (COLOURS[lower][k] + (COLOURS[lower + 1][k] - COLOURS[lower][k]) * share).round() as u8)
    })
}

/// A difference of 8-bit channels as Vlasic (2002, section 6.2) shows it.
pub(super) fn amplify(difference: u8) -> u8 {
    (255.0 * (f64::from(difference) / 255.0).powf(0.1)).round() as u8
}

const WIDTH: f64 = 360.0;

/// Legend of the colours of signed errors; `id` is for its gradient.
pub(super) fn signed(id: &str) -> Markup {
    const BAR: f64 = 336.0;
    let left = (WIDTH - BAR) / 2.0;
    let stops = COLOURS.len() - 1;
    html! {
        svg.legend viewBox="0 0 360 34" role="img" aria-label={ "Colours from blue, " (MOST) " LSB too dark, over white to red, as much too bright" } {
            linearGradient id=(id) {
                @for (index, stop) in COLOURS.iter().enumerate() {
                    stop offset=(format!("{:.4}", index as f64 / stops as f64)) stop-color=(colour(stop.map(|c| c as u8))) {}
                }
            }
            rect.swatch x=(left) y="0.5" width=(BAR) height="14" fill={ "url(#" (id) ")" } {}
            @for error in [-128.0, -16.0, -4.0, -1.0, 0.0, 1.0, 4.0, 16.0, 128.0] {
                @let x = format!("{:.1}", left + BAR * (1.0 + place(error)) / 2.0);
                line.axis x1=(x) x2=(x) y1="14" y2="19" {}
                text x=(x) y="31" text-anchor="middle" { (super::chart::signed(error, 0)) }
            }
        }
    }
}

/// Legend of amplified differences.
pub(super) fn amplified() -> Markup {
    const STEPS: [u8; 8] = [0, 1, 2, 4, 8, 32, 128, 255];
    let width = WIDTH / STEPS.len() as f64;
    html! {
        svg.legend viewBox="0 0 360 34" role="img" aria-label="Greys from black, no difference, to white, a difference of 255" {
            @for (index, step) in (0..).zip(STEPS) {
                @let grey = amplify(step);
                @let x = width * f64::from(index);
                rect.swatch x=(x + 4.0) y="0.5" width=(width - 8.0) height="14" fill=(colour([grey; 3])) {}
                text x=(x + width / 2.0) y="30" text-anchor="middle" { (step) }
            }
        }
    }
}

fn colour([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_error_is_neutral() {
        assert_eq!(palette()[usize::from(index(0.0))], [247; 3]);
        assert_eq!((index(-1e9), index(1e9)), (1, 255));
        assert!(index(-0.1) < 128 && index(0.1) > 128);
    }

    #[test]
    fn amplified_by_hand() {
        // (1/255)^(1/10) = 0.5746.
        assert_eq!([0, 1, 255].map(amplify), [0, 147, 255]);
    }
}
