//! The message that a board must show instead of a picture, drawn here by the firmware's own code.

use embedded_graphics::{
    pixelcolor::BinaryColor,
    prelude::{DrawTarget, OriginDimensions, Pixel, Size},
};
use microphong_sim::board::Board;
use std::{collections::HashSet, convert::Infallible};

#[path = "../../firmware/src/picture.rs"]
#[expect(unreachable_pub, reason = "it is public in the firmware")]
mod picture;

/// A display that remembers where there is ink.
struct Ink {
    size: Size,
    pixels: HashSet<usize>,
}

impl OriginDimensions for Ink {
    fn size(&self) -> Size {
        self.size
    }
}

impl DrawTarget for Ink {
    type Color = BinaryColor;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<BinaryColor>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(point, colour) in pixels {
            if (0..self.size.width as i32).contains(&point.x) && (0..self.size.height as i32).contains(&point.y) {
                let at = point.y as usize * self.size.width as usize + point.x as usize;
                if colour.is_on() {
                    self.pixels.insert(at)
                } else {
                    self.pixels.remove(&at)
                };
            }
        }
        Ok(())
    }
}

/// Whether `picture` shows `message` and nothing else, in one colour on another.
#[must_use]
pub fn is_shown(board: Board, picture: &[u32], message: &str) -> bool {
    let (width, height) = board.size();
    let mut expected = Ink { size: Size::new(width, height), pixels: HashSet::new() };
    let Ok(()) = picture::error_picture(&mut expected, BinaryColor::Off, BinaryColor::On, message);
    let Some(paper) = picture.last() else { return false };
    let ink: HashSet<usize> = picture.iter().enumerate().filter(|(_, pixel)| *pixel != paper).map(|(at, _)| at).collect();
    let colours: HashSet<u32> = picture.iter().copied().collect();
    ink == expected.pixels && colours.len() == 2
}
