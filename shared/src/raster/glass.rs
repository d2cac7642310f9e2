//! Transparent surfaces: a pixel keeps a part of the colour that it had before.
//!
//! The loops of pixels know nothing of it. They draw a transparent row in runs of 32 pixels into a buffer, with a copy of the depth. Where the depth has
//! changed, the pixels of the buffer are mixed with those of the band. The depth of the band stays, so that a surface behind a transparent one can be drawn
//! later. All transparent triangles are drawn after the others.

use crate::{
    features::TRANSPARENT,
    pixel::{Pixel, gamma::Gamma},
    raster::active::ActiveTriangles,
    setup::{
        edge::COLUMN,
        edge_walker::{EdgeWalker, LeftRight},
    },
};
use core::ops::Range;

/// Number of pixels that are drawn at once.
pub(crate) const RUN: usize = 32;

/// A value for transparent surfaces: there is room for none in a program without the feature.
pub type IfTransparent<T> = [T; TRANSPARENT];

/// How a surface lets through what is behind it.
#[derive(Clone, Copy, Debug)]
pub struct Glass {
    /// The part of the light from behind that it lets through, in units of 1/128.
    share: u32,
    /// The curve of the display.
    gamma: Option<&'static Gamma>,
}

impl Glass {
    /// A surface that lets through so many sixteenths of the light from behind.
    pub(crate) fn new(sixteenths: u8, gamma: Option<&'static Gamma>) -> Self {
        Self { share: u32::from(sixteenths) * 8, gamma }
    }

    /// The colour of the surface in front of a colour.
    #[inline(always)]
    pub(crate) fn over<C: Pixel>(self, surface: C, behind: C) -> C {
        surface.mixed_with(behind, self.share, self.gamma)
    }
}

/// The surface that is drawn, and room for a run of its pixels and for their depth.
#[derive(Debug)]
pub struct Sheet<C> {
    /// `None` if nothing is seen through it.
    pub(crate) glass: Option<Glass>,
    pub(crate) pixels: [C; RUN],
    pub(crate) depth: [u16; RUN],
}

impl<C: Pixel> Default for Sheet<C> {
    fn default() -> Self {
        Self { glass: None, pixels: [C::pack([0; 3]); RUN], depth: [0; RUN] }
    }
}

/// A surface that is drawn run by run.
pub(crate) trait RunFiller<C> {
    /// Room for the pixels of a run and for their depth.
    fn run(&mut self) -> (&mut [C], &mut [u16]);

    /// Draws a run of the coming row to its room, and steps to the next row if the run `is_last`.
    fn fill_run(&mut self, run: LeftRight, is_last: bool);

    /// Moves the polynomial `down` by so many rows, and everything that differs between even and odd rows to `row` of the picture.
    fn start_at(&mut self, row: i32, down: i32);

    /// Saves the triangle with this key and these sides for the next band, on whose first row `pair` stands.
    fn save(&self, triangle: (u32, &EdgeWalker), pair: LeftRight, active: &mut ActiveTriangles<'_>);
}

/// A band behind a transparent surface.
pub(crate) struct Behind<'b, 'a, C> {
    /// How the surface lets through what is behind it.
    pub(crate) glass: Glass,
    /// The pixels of the band.
    pub(crate) pixels: &'b mut [C],
    /// Their depth; `None` if it is not tested.
    pub(crate) depth: Option<&'b [u16]>,
    /// Index of the first pixel of the coming row.
    pub(crate) start: usize,
    /// Pixels in a row.
    pub(crate) width: usize,
    /// Triangles that go on in the next band.
    pub(crate) active: &'b mut ActiveTriangles<'a>,
}

impl<C: Pixel> Behind<'_, '_, C> {
    /// Draws the surface between the two sides of the coming row, and moves to the next one.
    pub(crate) fn cover(&mut self, surface: &mut dyn RunFiller<C>, sides: LeftRight) {
        let [left, mut end] = [sides.left, sides.right].map(|side| (side.x >> COLUMN) as usize);
        loop {
            let first = end.saturating_sub(RUN).max(left);
            let is_last = first == left;
            let at = self.start.wrapping_add(first)..self.start.wrapping_add(end);
            let depth = self.depth.map(|depth| depth.get(at.clone()).unwrap_or_default());
            if let Some(depth) = depth {
                let (_, copy) = surface.run();
                copy.iter_mut().zip(depth).for_each(|(to, &from)| *to = from);
            }
            let mut run = sides;
            (run.left.x, run.right.x) = ((first as u32) << COLUMN, (end as u32) << COLUMN);
            surface.fill_run(run, is_last);
            self.show(at, depth, surface.run());
            if is_last {
                break;
            }
            end = first;
        }
        self.start = self.start.wrapping_add(self.width);
    }

    /// Mixes a run that has been drawn with the pixels behind it, which have this `depth`.
    fn show(&mut self, at: Range<usize>, depth: Option<&[u16]>, (drawn, new): (&mut [C], &mut [u16])) {
        let surface = drawn.iter().zip(self.pixels.get_mut(at).unwrap_or_default());
        let Some(old) = depth else {
            // Loops without a test draw every pixel: none of them has holes.
            surface.for_each(|(&surface, pixel)| *pixel = self.glass.over(surface, *pixel));
            return;
        };
        for ((&surface, pixel), (new, old)) in surface.zip(new.iter().zip(old)) {
            // A pixel that passes the test changes its depth.
            if new != old {
                *pixel = self.glass.over(surface, *pixel);
            }
        }
    }
}
