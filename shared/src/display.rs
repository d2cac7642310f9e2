//! Pictures on embedded-graphics displays, drawn in bands, with texts, lines and images under and over them.

use crate::{
    Renderer, Stats,
    band_target::BandTarget,
    error::RenderError,
    pixel::{FromDrawn, Pixel},
};
use core::{cell::RefCell, fmt, marker::PhantomData};
use embedded_graphics_core::{
    Drawable,
    draw_target::DrawTarget,
    geometry::{Dimensions, Point, Size},
    pixelcolor::PixelColor,
    primitives::Rectangle,
};

/// One frame as a [`Drawable`] of embedded-graphics. Its method `draw` renders the frame onto a display and returns the frame's [`Stats`].
///
/// A picture can lie anywhere on the display ([`Self::at`]). Text, lines and images can be drawn behind it ([`Self::under`]) and in front
/// of it ([`Self::over`]) without flicker. `C` is the pixel that the renderer draws, `F` the pixel format of the
/// display, and `U` and `O` are the types of the functions that draw behind and in front.
///
/// ```
/// use embedded_graphics::{
///     image::{Image, ImageRaw}, mono_font::{MonoTextStyle, ascii::FONT_6X10}, pixelcolor::Rgb565, prelude::*, text::Text,
/// };
/// use microphong::{Picture, RenderError, Renderer};
///
/// /// Draws the object in front of an image, with a text in front of the object. The image stays in flash: embedded-graphics reads it there.
/// fn show<D: DrawTarget<Color = Rgb565>>(
///     renderer: &mut Renderer<'_, Rgb565>,
///     band: &mut [Rgb565],
///     image: &ImageRaw<'_, Rgb565>,
///     display: &mut D,
/// ) -> Result<(), RenderError> {
///     let corner = Point::new(40, 20);
///     let image = Image::new(image, corner);
///     let text = Text::new("12.3 V", corner + Point::new(4, 12), MonoTextStyle::new(&FONT_6X10, Rgb565::YELLOW));
///     let picture = Picture::of_scene(renderer, band)?.at(corner, display)?;
///     // Drawing into a band cannot fail.
///     let picture = picture.under(|band| image.draw(band).unwrap_or_default()).over(|band| {
///         let Ok(_) = text.draw(band);
///     });
///     let _ = picture.draw(display);
///     Ok(())
/// }
/// ```
pub struct Picture<'r, 'a, C: Pixel, F = C, U = Draw<C, F>, O = Draw<C, F>> {
    parts: RefCell<(&'r mut Renderer<'a, C>, &'r mut [C])>,
    /// Number of the frame of the stream's animation; `None` for the scene as the program has set it.
    number: Option<u32>,
    /// The pixel of the display at the upper left corner of the picture.
    corner: Point,
    under: Option<U>,
    over: Option<O>,
    format: PhantomData<F>,
}

/// A function that draws on a band.
type Draw<C, F> = fn(&mut BandTarget<'_, C, F>);

impl<C: Pixel + fmt::Debug, F, U, O> fmt::Debug for Picture<'_, '_, C, F, U, O> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { parts, number, corner, .. } = self;
        f.debug_struct("Picture").field("parts", parts).field("number", number).field("corner", corner).finish_non_exhaustive()
    }
}

impl<'r, 'a, C: Pixel> Picture<'r, 'a, C> {
    /// Creates a picture of frame `number` of the animation in the stream (mesh file). A number beyond the last frame starts over.
    ///
    /// `band` is the buffer into which `renderer` draws some rows at a time. Give it [`Layout::band`](crate::Layout::band) pixels; with
    /// fewer, the picture is sent in more and smaller pieces.
    ///
    /// # Errors
    /// Returns [`RenderError::Band`] if `band` is shorter than one row of the picture.
    pub fn new(renderer: &'r mut Renderer<'a, C>, band: &'r mut [C], number: u32) -> Result<Self, RenderError> {
        renderer.check_band(band)?;
        let (parts, corner) = (RefCell::new((renderer, band)), Point::zero());
        Ok(Self { parts, number: Some(number), corner, under: None, over: None, format: PhantomData })
    }

    /// Creates a picture of the scene in its current state, for programs that move objects themselves through [`Renderer::scene`]. `band`
    /// is the buffer into which `renderer` draws some rows at a time: [`Layout::band`](crate::Layout::band) pixels.
    ///
    /// # Errors
    /// Returns [`RenderError::Band`] if `band` is shorter than one row of the picture.
    pub fn of_scene(renderer: &'r mut Renderer<'a, C>, band: &'r mut [C]) -> Result<Self, RenderError> {
        Ok(Self { number: None, ..Self::new(renderer, band, 0)? })
    }

    /// Sets the pixel format `F` of the display, if the renderer draws other pixels: [`Light`](crate::pixel::Light) or
    /// [`LightGray`](crate::pixel::LightGray). Call it before [`Self::under`] and [`Self::over`], which then draw in colours of the display.
    #[must_use]
    pub fn shown_as<F: FromDrawn<C>>(self) -> Picture<'r, 'a, C, F> {
        let Self { parts, number, corner, .. } = self;
        Picture { parts, number, corner, under: None, over: None, format: PhantomData }
    }
}

impl<'r, 'a, C: Pixel, F, U, O> Picture<'r, 'a, C, F, U, O> {
    /// Moves the picture on the display: `corner` is the position of its upper left pixel, in pixels of `display`. Without this call the
    /// picture lies at `(0, 0)`. The rest of the display stays untouched.
    ///
    /// # Errors
    /// Returns [`RenderError::Corner`] if a part of the picture would lie outside of `display`.
    pub fn at(mut self, corner: Point, display: &impl Dimensions) -> Result<Self, RenderError> {
        let (Size { width, height }, outer) = (self.parts.get_mut().0.size(), display.bounding_box());
        let lies = |at: i32, side: u32, start: i32, room: u32| {
            let first = i64::from(at) - i64::from(start);
            first >= 0 && first + i64::from(side) <= i64::from(room)
        };
        let on_display =
            lies(corner.x, width, outer.top_left.x, outer.size.width) && lies(corner.y, height, outer.top_left.y, outer.size.height);
        if !on_display {
            return Err(RenderError::Corner);
        }
        Ok(Self { corner, ..self })
    }

    /// Sets a function that draws behind the objects and in front of the scene's background, for example an image. The picture is drawn in
    /// bands (groups of rows), and `under` is called once for each band. Each call draws the same things, in coordinates of the display;
    /// pixels outside of the band are discarded.
    #[must_use]
    pub fn under<N: Fn(&mut BandTarget<'_, C, F>)>(self, under: N) -> Picture<'r, 'a, C, F, N, O> {
        let Self { parts, number, corner, over, format, .. } = self;
        Picture { parts, number, corner, under: Some(under), over, format }
    }

    /// Sets a function that draws in front of the objects, for example a label. The picture is drawn in bands (groups of rows), and `over`
    /// is called once for each band. Each call draws the same things, in coordinates of the display; pixels outside of the band are
    /// discarded.
    #[must_use]
    pub fn over<N: Fn(&mut BandTarget<'_, C, F>)>(self, over: N) -> Picture<'r, 'a, C, F, U, N> {
        let Self { parts, number, corner, under, format, .. } = self;
        Picture { parts, number, corner, under, over: Some(over), format }
    }
}

impl<C, F, U, O> Drawable for Picture<'_, '_, C, F, U, O>
where
    C: Pixel,
    F: FromDrawn<C> + PixelColor,
    U: Fn(&mut BandTarget<'_, C, F>),
    O: Fn(&mut BandTarget<'_, C, F>),
{
    type Color = F;
    type Output = Stats;

    /// Renders the frame and sends it to `target`, with one call of `fill_contiguous` for each band (group of rows drawn at once). Returns
    /// the frame's [`Stats`], or the first error of the display.
    fn draw<D: DrawTarget<Color = F>>(&self, target: &mut D) -> Result<Stats, D::Error> {
        // The picture is borrowed already only if a display draws it from within its own `fill_contiguous`.
        let Ok(mut parts) = self.parts.try_borrow_mut() else { return Ok(Stats::default()) };
        let (renderer, band) = &mut *parts;
        let mut frame = match self.number {
            Some(number) => renderer.frame(number),
            None => renderer.draw(),
        };
        let on_display = |area: Rectangle| Rectangle::new(area.top_left + self.corner, area.size);
        // The band holds a row: that was checked.
        while let Ok(Some(drawn)) = frame.next_band_over(band, |pixels, area| {
            if let Some(under) = &self.under {
                under(&mut BandTarget::new(pixels, on_display(area)));
            }
        }) {
            let area = on_display(drawn);
            if let Some(over) = &self.over {
                over(&mut BandTarget::new(band, area));
            }
            target.fill_contiguous(&area, frame.output().pixels(band, drawn))?;
        }
        Ok(frame.stats())
    }
}
