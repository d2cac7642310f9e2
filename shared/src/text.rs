//! Labels of scripted scenes, drawn over each band by fonts of embedded-graphics.

use crate::{
    band_target::BandTarget,
    format::Share,
    pixel::{Pixel, colour::colour},
    stream::record::{LABEL_TEXT, LEFT, Label, MIDDLE},
};
use core::convert::Infallible;
use embedded_graphics::{
    mono_font::{
        MonoFont, MonoTextStyle,
        iso_8859_1::{FONT_4X6, FONT_5X8, FONT_6X10, FONT_7X13, FONT_9X15, FONT_10X20},
    },
    pixelcolor::BinaryColor,
    prelude::*,
    primitives::Rectangle,
    text::{Alignment, Baseline, Text, TextStyleBuilder},
};

/// From the smallest to the largest.
static FONTS: [&MonoFont<'_>; 6] = [&FONT_4X6, &FONT_5X8, &FONT_6X10, &FONT_7X13, &FONT_9X15, &FONT_10X20];

/// Draws the labels of a picture of `size` pixels into the band `area`.
// A call, so that its instructions can be told from a frame's.
#[inline(never)]
pub(crate) fn draw<C: Pixel>(labels: &[Label], size: Size, pixels: &mut [C], area: Rectangle) {
    let side = size.width.min(size.height) as i32;
    // Half a pixel is added; centres are counted in halves of pixels.
    let scaled = |share: Share, halves: u32| {
        (i32::from(share.to_bits()) * side + ((halves as i32 + 1) << (Share::FRAC_NBITS - 1))) >> Share::FRAC_NBITS
    };
    for label in labels {
        let height = scaled(label.height(), 0).unsigned_abs();
        let font = FONTS.iter().rev().find(|font| font.character_size.height <= height).unwrap_or(&&FONT_4X6);
        let [x, y] = label.position();
        let position = Point::new(scaled(x, size.width), scaled(y, size.height));
        let reach = font.character_size.height as i32;
        let (top, bottom) = (area.top_left.y, area.top_left.y + area.size.height as i32);
        if position.y + reach < top || position.y - reach > bottom {
            continue;
        }
        let alignment = match label.alignment {
            LEFT => Alignment::Left,
            MIDDLE => Alignment::Center,
            _ => Alignment::Right,
        };
        let style = TextStyleBuilder::new().alignment(alignment).baseline(Baseline::Middle).build();
        // In UTF-8 each character takes two bytes at most.
        let mut text = heapless::String::<{ 2 * LABEL_TEXT }>::new();
        label.characters().for_each(|character| text.push(character).unwrap_or_default());
        let mut ink = Ink { band: BandTarget::new(&mut *pixels, area), colour: colour(label.colour) };
        let Ok(_) = Text::with_text_style(&text, position, MonoTextStyle::new(font, BinaryColor::On), style).draw(&mut ink);
    }
}

/// Paints in one colour, whatever the pixel format.
struct Ink<'b, C> {
    band: BandTarget<'b, C>,
    colour: C,
}

impl<C> Dimensions for Ink<'_, C> {
    fn bounding_box(&self) -> Rectangle {
        self.band.bounding_box()
    }
}

impl<C: Copy> DrawTarget for Ink<'_, C> {
    type Color = BinaryColor;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = embedded_graphics::Pixel<BinaryColor>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for embedded_graphics::Pixel(point, _) in pixels {
            self.band.row(point, 1).fill(self.colour);
        }
        Ok(())
    }
}
