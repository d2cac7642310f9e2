//! The core renderer with as much memory as a scene wants.

use crate::{image, neighbours, shader::Shader};
use anyhow::{Context, Result};
use embedded_graphics_core::{
    geometry::Size,
    pixelcolor::{Bgr565, BinaryColor, Gray2, Gray4, Gray8, Rgb565, Rgb666, Rgb888},
};
use microphong::{
    Frame, Layout, Outlines, Renderer, Skips, Stats, Stream,
    format::ErrorBudget,
    pixel::{Channels, FromDrawn, Light, LightGray, PictureCrc, Pixel, PixelFormat, Rgb332, gamma},
};
use zerocopy::IntoBytes;

/// Options of drawing a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// Shading method.
    pub shader: Shader,
    /// Interpolation in perspective.
    pub perspective_correct: bool,
    /// Antialiasing.
    pub antialias: bool,
    /// Lines along outlines, in place of those of the scene.
    pub outlines: Option<Outlines>,
    /// Ordered dither.
    pub dither: bool,
    /// Colours for a display with the curve of sRGB, in place of linear ones.
    pub srgb: bool,
    /// Work that is left out because nobody can see the result.
    pub skips: Skips,
}

/// The method, and nothing else.
impl From<Shader> for Style {
    fn from(shader: Shader) -> Self {
        Self { shader, perspective_correct: false, antialias: false, outlines: None, dither: false, srgb: false, skips: Skips::ALL }
    }
}

impl Style {
    /// Whether the style asks for edges, to be smoothed or to be drawn as lines.
    #[must_use]
    pub const fn has_edges(&self) -> bool {
        self.antialias || self.outlines.is_some()
    }
}

/// Room for all of a stream.
#[must_use]
pub fn layout(stream: &Stream<'_>, size: Size, band_rows: u32) -> Layout {
    let layout = Layout::new(size.width as usize, band_rows as usize).with_room_for(stream);
    layout.active_triangles(if band_rows < size.height { layout.triangles } else { 0 })
}

/// Draws frame `number` and returns its pixels row by row from the top.
///
/// Bands have `band_rows` rows, at most the picture's; the picture does not depend on it.
///
/// # Errors
/// When `size` is out of range, or the scene cannot be drawn in this style.
pub fn frame<C: Pixel>(stream: Stream<'_>, size: Size, style: impl Into<Style>, band_rows: u32, number: u32) -> Result<(Vec<C>, Stats)> {
    let style = style.into();
    frame_by(stream, size, style, style.shader.on(), band_rows, number)
}

/// Draws like [`frame`], by `shader` whatever the style says, pixels `C`, and returns pixels of the display.
///
/// # Errors
/// Returns the errors of [`frame`].
pub fn frame_by<C: Pixel, F: FromDrawn<C>>(
    stream: Stream<'_>,
    size: Size,
    style: Style,
    shader: microphong::Shader<C>,
    band_rows: u32,
    number: u32,
) -> Result<(Vec<F>, Stats)> {
    if style.has_edges() && !neighbours::has_neighbours(&stream) {
        let words = neighbours::with_neighbours(&stream)?;
        return frame_by(Stream::parse(words.as_bytes())?, size, style, shader, band_rows, number);
    }
    let rows = band_rows.clamp(1, size.height.max(1));
    let layout = layout(&stream, size, rows).edges(stream.triangles.len() * 3);
    let layout = layout.antialias(layout.antialias || style.has_edges());
    let mut memory = vec![0; layout.words::<C>()];
    let mut renderer = Renderer::with_shader(stream, size, &layout, &mut memory, shader)?;
    renderer.set_perspective_correct(style.perspective_correct)?;
    renderer.set_dither(style.dither);
    renderer.set_gamma(style.srgb.then_some(&gamma::SRGB));
    renderer.set_skips(style.skips);
    renderer.set_antialias(style.antialias)?;
    if style.outlines.is_some() {
        renderer.scene().set_outlines(style.outlines)?;
    }
    let mut pixels = Vec::with_capacity(size.width as usize * size.height as usize);
    let mut band = vec![C::pack([0; 3]); layout.band()];
    let mut frame = renderer.frame(number);
    while let Some(area) = frame.next_band(&mut band)? {
        let count = area.size.width as usize * area.size.height as usize;
        let band = band.get(..count).context("the renderer filled more rows than a band has")?;
        pixels.extend(frame.output().pixels::<C, F>(band, area));
    }
    let stats = frame.stats();
    Ok((pixels, stats))
}

/// Whether any frame of a stream shows a pixel of a triangle, in pictures of this size.
///
/// # Errors
/// When `size` is out of range.
pub fn shows_a_pixel(stream: &Stream<'_>, size: Size) -> Result<bool> {
    for number in 0..u32::from(stream.header.frames) {
        // Any method covers the same pixels. This one is named, so that a program has no loops of others in greys.
        let flat = microphong::Shader::FLAT;
        let (_, stats) = frame_by::<Gray8, Gray8>(*stream, size, Shader::FLAT.into(), flat, size.height, number)?;
        if stats.pixels > 0 {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Frames that are drawn to count active triangles: a turn of most scenes.
const COUNTED: u32 = 120;

/// The fewest active triangles with which no frame of a stream sets up a triangle anew, whatever the method. Of more than 120 frames, some are drawn.
///
/// # Errors
/// When `size` is out of range.
pub fn fewest_active_triangles(stream: &Stream<'_>, size: Size, band_rows: u32) -> Result<usize> {
    if band_rows >= size.height {
        return Ok(0);
    }
    let mut layout = Layout::new(size.width as usize, band_rows as usize).with_room_for(stream).active_triangles(0);
    let mut band = vec![Gray8::pack([0; 3]); layout.band()];
    let frames = u32::from(stream.header.frames);
    let mut numbers = (0..frames).step_by(frames.div_ceil(COUNTED).max(1) as usize).peekable();
    while numbers.peek().is_some() {
        let mut memory = vec![0; layout.words::<Gray8>()];
        let mut renderer = Renderer::with_shader(*stream, size, &layout, &mut memory, microphong::Shader::FLAT)?;
        while let Some(&number) = numbers.peek() {
            let missing = missing_active_triangles(renderer.frame(number), &mut band)?;
            if missing > 0 {
                layout.active_triangles += missing;
                break;
            }
            numbers.next();
        }
    }
    Ok(layout.active_triangles)
}

/// How many active triangles a frame needs at least beyond those that it has: the most triangles that one of its bands could not keep. Each active
/// triangle more keeps one of them at most.
fn missing_active_triangles(mut frame: Frame<'_, Gray8>, band: &mut [Gray8]) -> Result<usize> {
    // A frame of more triangles than its lists can hold goes through all triangles in each band, and keeps none.
    if frame.stats().passes == 0 {
        return Ok(0);
    }
    let (mut missing, mut before) = (0, 0);
    while frame.next_band(band)?.is_some() {
        let set_up_anew = frame.stats().set_up_anew;
        missing = missing.max(set_up_anew - before);
        before = set_up_anew;
    }
    Ok(missing as usize)
}

/// The layout for a program that draws a stream in bands of `band_rows` rows: with room for all of it, and for its active triangles. There is room for
/// half as many again of these, because the program may show poses that the stream does not. There are tables of highlights if `shader` needs
/// them, and room for antialiasing if the stream has neighbours.
///
/// # Errors
/// When `size` is out of range.
pub fn program_layout(stream: &Stream<'_>, shader: Shader, size: Size, band_rows: u32) -> Result<Layout> {
    let layout = Layout::new(size.width as usize, band_rows as usize).with_room_for(stream);
    let layout = if shader.needs_highlight_tables() { layout } else { layout.without_highlight_tables() };
    let fewest = fewest_active_triangles(stream, size, band_rows)?;
    let layout = layout.active_triangles((fewest + fewest.div_ceil(2)).min(layout.triangles));
    if stream.neighbours.is_empty() {
        return Ok(layout);
    }
    let edges = most_edges(stream, size)?;
    Ok(layout.antialias(true).edges(edges + edges.div_ceil(2)))
}

/// The largest number of edges in the outlines of a frame.
fn most_edges(stream: &Stream<'_>, size: Size) -> Result<usize> {
    let layout = Layout::new(size.width as usize, 16).with_room_for(stream).antialias(true).edges(3 * stream.triangles.len());
    let mut memory = vec![0; layout.words::<Gray8>()];
    let mut renderer = Renderer::<Gray8>::with_shader(*stream, size, &layout, &mut memory, microphong::Shader::FLAT)?;
    renderer.set_antialias(true)?;
    let frames = u32::from(stream.header.frames);
    let step = frames.div_ceil(COUNTED).max(1) as usize;
    Ok((0..frames).step_by(step).map(|number| renderer.frame(number).stats().edges).max().unwrap_or(0) as usize)
}

/// Checksum of a picture.
#[must_use]
pub fn crc<F: PixelFormat>(pixels: &[F]) -> u32 {
    let mut crc = PictureCrc::default();
    crc.update(pixels);
    crc.finish()
}

/// A pixel format, chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The format that most colour displays store.
    Rgb565,
    /// Eight bits per channel.
    Rgb888,
    /// 256 greys.
    Gray8,
    /// 16 greys.
    Gray4,
    /// Four greys.
    Gray2,
    /// Black and white.
    Binary,
    /// [`Self::Rgb565`] with red and blue exchanged.
    Bgr565,
    /// Six bits per channel.
    Rgb666,
    /// Three bits of red and green, two of blue.
    Rgb332,
    /// [`Self::Rgb565`] by way of light, with 8x8 dither.
    LightRgb565,
}

/// An operation for a pixel format that is chosen at run time.
pub trait InFormat {
    /// The result of the operation.
    type Output;

    /// Does it, where pixels `C` are drawn for a display with pixels `F`.
    fn in_format<C: Pixel, F: FromDrawn<C>>(self) -> Self::Output;
}

impl Format {
    /// Every format.
    pub const ALL: [Self; 10] = [
        Self::Rgb565,
        Self::Rgb888,
        Self::Gray8,
        Self::Gray4,
        Self::Gray2,
        Self::Binary,
        Self::Bgr565,
        Self::Rgb666,
        Self::Rgb332,
        Self::LightRgb565,
    ];

    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rgb565 => "rgb565",
            Self::Rgb888 => "rgb888",
            Self::Gray8 => "gray8",
            Self::Gray4 => "gray4",
            Self::Gray2 => "gray2",
            Self::Binary => "binary",
            Self::Bgr565 => "bgr565",
            Self::Rgb666 => "rgb666",
            Self::Rgb332 => "rgb332",
            Self::LightRgb565 => "light-rgb565",
        }
    }

    /// Does something in this format.
    pub fn run<T: InFormat>(self, what: T) -> T::Output {
        match self {
            Self::Rgb565 => what.in_format::<Rgb565, Rgb565>(),
            Self::Rgb888 => what.in_format::<Rgb888, Rgb888>(),
            Self::Gray8 => what.in_format::<Gray8, Gray8>(),
            Self::Gray4 => what.in_format::<LightGray<4>, Gray4>(),
            Self::Gray2 => what.in_format::<LightGray<2>, Gray2>(),
            Self::Binary => what.in_format::<LightGray<1>, BinaryColor>(),
            Self::Bgr565 => what.in_format::<Bgr565, Bgr565>(),
            Self::Rgb666 => what.in_format::<Rgb666, Rgb666>(),
            Self::Rgb332 => what.in_format::<Light<3, 3, 2>, Rgb332>(),
            Self::LightRgb565 => what.in_format::<Light<5, 6, 5>, Rgb565>(),
        }
    }

    /// Bytes of the renderer's memory, and of a band of pixels.
    #[must_use]
    pub fn bytes(self, layout: &Layout) -> [usize; 2] {
        struct Of<'a>(&'a Layout);
        impl InFormat for Of<'_> {
            type Output = [usize; 2];

            fn in_format<C: Pixel, F: FromDrawn<C>>(self) -> [usize; 2] {
                [self.0.bytes::<C>(), self.0.band() * size_of::<C>()]
            }
        }
        self.run(Of(layout))
    }

    /// Properties of the pixels that are drawn for this format.
    #[must_use]
    pub fn channels(self) -> Channels {
        struct Of;
        impl InFormat for Of {
            type Output = Channels;

            fn in_format<C: Pixel, F: FromDrawn<C>>(self) -> Channels {
                Channels::of::<C>()
            }
        }
        self.run(Of)
    }

    /// The error budget of scenes that state none.
    #[must_use]
    pub fn budget(self) -> ErrorBudget {
        struct Of;
        impl InFormat for Of {
            type Output = ErrorBudget;

            fn in_format<C: Pixel, F: FromDrawn<C>>(self) -> ErrorBudget {
                C::BUDGET
            }
        }
        self.run(Of)
    }

    /// Whether the format has 16 greys or fewer.
    #[must_use]
    pub const fn has_few_greys(self) -> bool {
        matches!(self, Self::Binary | Self::Gray2 | Self::Gray4)
    }

    /// Whether dither changes the picture: a channel has fewer than eight bits.
    #[must_use]
    pub fn is_dithered(self) -> bool {
        struct Asked;
        impl InFormat for Asked {
            type Output = bool;

            fn in_format<C: Pixel, F: FromDrawn<C>>(self) -> bool {
                F::DEPTH[2] < 8
            }
        }
        self.run(Asked)
    }
}

/// Settings of a picture.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Width and height.
    pub size: Size,
    /// The style of drawing.
    pub style: Style,
    /// Rows drawn at a time.
    pub band_rows: u32,
    /// Pixel format.
    pub format: Format,
}

impl Settings {
    /// The settings by which `microphong render` draws a picture if nothing else is asked for: dithered if the format has few colours, for a display
    /// with a linear curve, and with jagged outlines.
    #[must_use]
    pub fn usual(shader: Shader, size: Size, format: Format) -> Self {
        Self { size, style: Style { dither: format.is_dithered(), ..shader.into() }, band_rows: ROWS, format }
    }
}

/// Rows of a band, where nobody names another number.
pub const ROWS: u32 = 16;

/// A finished frame of any format.
#[derive(Clone, Debug)]
pub struct Picture {
    /// 8-bit RGB, row by row from the top.
    pub rgb: Vec<u8>,
    /// Checksum of the pixels in their own format.
    pub crc: u32,
    /// Counts of the frame.
    pub stats: Stats,
}

/// Draws frame `number`, and converts it to 8 bits a channel.
///
/// # Errors
/// Errors of [`frame`].
pub fn picture(stream: Stream<'_>, settings: &Settings, number: u32) -> Result<Picture> {
    struct View<'a>(Stream<'a>, &'a Settings, u32);
    impl InFormat for View<'_> {
        type Output = Result<Picture>;

        fn in_format<C: Pixel, F: FromDrawn<C>>(self) -> Result<Picture> {
            let Self(stream, settings, number) = self;
            picture_in::<C, F>(stream, settings, number)
        }
    }
    settings.format.run(View(stream, settings, number))
}

/// Draws like [`picture`], pixels `C` for a display with pixels `F`, whatever the format of the settings is. A program that calls nothing else has the
/// loops of these formats alone.
///
/// # Errors
/// Errors of [`frame`].
pub fn picture_in<C: Pixel, F: FromDrawn<C>>(stream: Stream<'_>, s: &Settings, number: u32) -> Result<Picture> {
    let (pixels, stats) = frame_by::<C, F>(stream, s.size, s.style, s.style.shader.on(), s.band_rows, number)?;
    Ok(Picture { rgb: image::rgb_bytes(&pixels), crc: crc(&pixels), stats })
}
