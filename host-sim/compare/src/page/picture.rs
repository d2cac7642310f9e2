//! Pictures inside the page: PNG files as data URIs.

use super::scale;
use crate::Window;
use anyhow::Result;
use base64::{Engine, engine::general_purpose::STANDARD};
use png::{BitDepth, ColorType, Compression, Encoder};

fn encoded(window: &Window, colours: Option<&scale::Palette>, bytes: &[u8]) -> Result<String> {
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, window.width(), window.height());
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    encoder.set_color(ColorType::Rgb);
    if let Some(colours) = colours {
        encoder.set_color(ColorType::Indexed);
        encoder.set_palette(colours.as_flattened());
        // The first entry is for pixels that show nothing.
        encoder.set_trns(&[0][..]);
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(bytes)?;
    writer.finish()?;
    Ok(format!("data:image/png;base64,{}", STANDARD.encode(file)))
}

/// The picture in its own colours.
pub(super) fn rgb(window: &Window, pixels: &[[u8; 3]]) -> Result<String> {
    encoded(window, None, pixels.as_flattened())
}

/// Differences that the eye would miss.
pub(super) fn amplified(window: &Window, a: &[[u8; 3]], b: &[[u8; 3]]) -> Result<String> {
    let channels = a.as_flattened().iter().zip(b.as_flattened());
    let bytes: Vec<u8> = channels.map(|(a, b)| scale::amplify(a.abs_diff(*b))).collect();
    encoded(window, None, &bytes)
}

/// Errors by colour; nothing where there is none to tell.
pub(super) fn signed(window: &Window, errors: &[Option<f64>]) -> Result<String> {
    let indices: Vec<u8> = errors.iter().map(|error| error.map_or(0, scale::index)).collect();
    encoded(window, Some(&scale::palette()), &indices)
}
