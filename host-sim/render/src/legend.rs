//! A legend below a picture of what the method `auto` chooses: colours, names, and shares of triangles and pixels.

use crate::choices::{Choices, Way};
use embedded_graphics::{
    mono_font::{MonoTextStyle, ascii::FONT_7X13},
    pixelcolor::Rgb888,
    prelude::*,
    primitives::{PrimitiveStyle, Rectangle},
    text::{Baseline, Text},
};
use std::convert::Infallible;

/// Distance from one line to the next, in pixels.
const LINE: u32 = 15;
/// Free space around the lines.
const SPACE: u32 = 4;

/// Height of the legend: a head, and a line for each way.
pub const HEIGHT: u32 = (1 + Way::ALL.len() as u32) * LINE + 2 * SPACE;

/// Adds the legend to a picture of 8-bit RGB that is `width` wide. It fits pictures of 240 columns; narrower ones cut it off.
pub fn add(rgb: &mut Vec<u8>, width: u32, choices: &Choices) {
    let mut strip = Strip { size: Size::new(width, HEIGHT), rgb: vec![0; (3 * width * HEIGHT) as usize] };
    let Ok(()) = draw(&mut strip, choices);
    rgb.append(&mut strip.rgb);
}

fn draw(strip: &mut Strip, choices: &Choices) -> Result<(), Infallible> {
    let place = |line: u32| Point::new(SPACE as i32, (SPACE + line * LINE) as i32);
    let style = MonoTextStyle::new(&FONT_7X13, Rgb888::WHITE);
    // Behind the patch of colour.
    let indent = Point::new(LINE as i32 + 3, 0);
    let write = |strip: &mut Strip, line: u32, [name, triangles, pixels]: [&str; 3]| {
        let text = format!("{name:10} {triangles:>10} {pixels:>7}");
        Text::with_baseline(&text, place(line) + indent, style, Baseline::Top).draw(strip).map(drop)
    };
    write(strip, 0, ["", "triangles", "pixels"])?;
    for (line, way) in (1..).zip(Way::ALL) {
        let [r, g, b] = way.colour();
        let patch = Rectangle::new(place(line), Size::new_equal(LINE - 2));
        patch.into_styled(PrimitiveStyle::with_fill(Rgb888::new(r, g, b))).draw(strip)?;
        let [triangles, pixels] = choices.percent(way).map(|percent| format!("{percent:.1} %"));
        write(strip, line, [way.name(), &triangles, &pixels])?;
    }
    Ok(())
}

/// The strip below the picture.
struct Strip {
    size: Size,
    rgb: Vec<u8>,
}

impl OriginDimensions for Strip {
    fn size(&self) -> Size {
        self.size
    }
}

impl DrawTarget for Strip {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        let area = self.bounding_box();
        for Pixel(place, colour) in pixels.into_iter().filter(|&Pixel(place, _)| area.contains(place)) {
            let at = 3 * (place.y as usize * self.size.width as usize + place.x as usize);
            if let Some(rgb) = self.rgb.get_mut(at..at + 3) {
                rgb.copy_from_slice(&[colour.r(), colour.g(), colour.b()]);
            }
        }
        Ok(())
    }
}
