//! Common displays that a picture can be shown on.

use microphong_render::render::Format;
use serde::Serialize;

/// A display.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Panel {
    /// The name on the page.
    name: &'static str,
    /// Width and height in pixels.
    size: (u32, u32),
    /// The pixel format that its driver takes, by its name on the command line.
    format: &'static str,
    /// How its pixels look.
    look: Look,
}

/// How the pixels of a display look.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "lowercase")]
enum Look {
    /// Coloured pixels without gaps.
    Lcd,
    /// Pixels that shine in a bluish white, with dark gaps between them.
    Oled,
    /// A round display.
    Round,
    /// Dark pixels on a greenish reflector.
    Reflective,
}

const fn panel(name: &'static str, size: (u32, u32), format: Format, look: Look) -> Panel {
    Panel { name, size, format: format.name(), look }
}

/// All of them, the largest first.
pub(crate) const PANELS: [Panel; 9] = [
    panel("ILI9341 colour LCD", (320, 240), Format::Rgb565, Look::Lcd),
    panel("ILI9488 colour LCD", (480, 320), Format::Rgb666, Look::Lcd),
    panel("ST7789 colour LCD", (240, 240), Format::Rgb565, Look::Lcd),
    panel("GC9A01 round colour LCD", (240, 240), Format::Rgb565, Look::Round),
    panel("ST7735 colour LCD", (160, 128), Format::Rgb565, Look::Lcd),
    panel("SSD1351 colour OLED", (128, 128), Format::Rgb565, Look::Lcd),
    panel("SSD1327 OLED of 16 greys", (128, 128), Format::Gray4, Look::Oled),
    panel("SSD1306 one-bit OLED", (128, 64), Format::Binary, Look::Oled),
    panel("PCD8544 one-bit LCD", (84, 48), Format::Binary, Look::Reflective),
];
