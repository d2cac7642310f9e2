//! Labels of scripted scenes, drawn over each band by fonts of embedded-graphics.

use crate::{
    band_target::BandTarget,
    format::Share,
    pixel::{Pixel, colour::colour},
    stream::record::{LABEL_TEXT, LEAST_LINE, LEFT, Label, MIDDLE},
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
    text::{Baseline, renderer::TextRenderer},
};

/// The fonts, from the smallest to the largest.
static FONTS: [&MonoFont<'_>; 6] = [&FONT_4X6, &FONT_5X8, &FONT_6X10, &FONT_7X13, &FONT_9X15, &FONT_10X20];

const _: () = assert!(FONT_4X6.character_size.height == LEAST_LINE);

/// Draws the labels of a picture of `size` pixels into the band `area`. In a small picture labels are left out that would need a smaller font than
/// there is, because they would cover what they name.
// A call, so that its instructions can be told from a frame's.
#[inline(never)]
pub(crate) fn draw<C: Pixel>(labels: &[Label], size: Size, pixels: &mut [C], area: Rectangle) {
    let side = size.width.min(size.height) as i32;
    // Half a pixel is added; centres are counted in halves of pixels.
    let scaled = |share: Share, halves: u32| {
        (i32::from(share.to_bits()) * side + ((halves as i32 + 1) << (Share::FRAC_NBITS - 1))) >> Share::FRAC_NBITS
    };
    let (top, bottom) = (area.top_left.y, area.top_left.y + area.size.height as i32);
    for label in labels {
        let height = scaled(label.height(), 0).unsigned_abs();
        let Some(font) = FONTS.iter().rev().find(|font| font.character_size.height <= height) else { continue };
        let [x, y] = label.position();
        let height = font.character_size.height as i32;
        let y = scaled(y, size.height) - (height - 1) / 2;
        if y + height <= top || y >= bottom {
            continue;
        }
        // In UTF-8 each character takes two bytes at most.
        let mut text = heapless::String::<{ 2 * LABEL_TEXT }>::new();
        label.characters().for_each(|character| text.push(character).unwrap_or_default());
        let last_column = (label.characters().count() as u32 * font.character_size.width) as i32 - 1;
        let left = match label.alignment {
            LEFT => 0,
            MIDDLE => last_column / 2,
            _ => last_column,
        };
        let corner = Point::new(scaled(x, size.width) - left, y);
        let mut ink = Ink { band: BandTarget::new(&mut *pixels, area), colour: colour(label.colour) };
        // Not by `Text`, whose division into lines has a panic that the compiler cannot rule out.
        let Ok(_) = MonoTextStyle::new(font, BinaryColor::On).draw_string(&text, corner, Baseline::Top, &mut ink);
    }
}

/// Paints in one colour, in any pixel format.
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
