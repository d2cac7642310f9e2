//! Choices of the method `auto`: numbers of triangles and pixels that are drawn in each way, and a picture of them.
//!
//! The frame is drawn by a method that asks as `auto` does, remembers the answer, and lets `auto` draw. Each pixel remembers the way in which it was
//! drawn. The frame has one band, so that no triangle is counted twice.

use crate::{
    image::{rgb_bytes, to_rgb},
    render::{self, InFormat, Picture, Settings, Style},
    shader::Shader,
};
use embedded_graphics_core::{geometry::Size, pixelcolor::Rgb888};
use microphong::{
    Stats, Stream,
    format::{Intensity, LEVEL, RAMP},
    method::{
        Canvas, ErrorBounds, Facts, LitMaterial, Method, Shading, TriangleSetup,
        auto::{Auto, Choice, choose, raises},
    },
    pixel::{FromDrawn, Pixel, PixelFormat},
    stream::record::Triangle,
};
use serde::{Serialize, Serializer};
use std::{
    cell::{Cell, RefCell},
    fmt, ptr,
    sync::LazyLock,
};

/// A way of shading that `auto` chooses among.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Way {
    /// One colour for the whole triangle.
    OneColour,
    /// Levels at the corners, linear in between.
    Linear,
    /// Levels at six nodes, quadratic in between.
    Quadratic,
    /// Cosines at six nodes, quadratic in between, highlights looked up at the pixel.
    Cosines,
    /// Phong shading.
    Phong,
}

impl Way {
    /// All ways, the cheapest first.
    pub const ALL: [Self; 5] = [Self::OneColour, Self::Linear, Self::Quadratic, Self::Cosines, Self::Phong];

    /// The name in texts and pictures.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::OneColour => "one colour",
            Self::Linear => "linear",
            Self::Quadratic => "quadratic",
            Self::Cosines => "cosines",
            Self::Phong => "Phong",
        }
    }

    /// The colour in pictures, which the colour-blind tell from the others (Okabe & Ito 2002).
    #[must_use]
    pub const fn colour(self) -> [u8; 3] {
        match self {
            Self::OneColour => [86, 180, 233],
            Self::Linear => [0, 158, 115],
            Self::Quadratic => [240, 228, 66],
            Self::Cosines => [204, 121, 167],
            Self::Phong => [213, 94, 0],
        }
    }
}

impl From<Choice> for Way {
    fn from(choice: Choice) -> Self {
        match choice {
            Choice::Solid(_) => Self::OneColour,
            Choice::Linear(_) => Self::Linear,
            Choice::Quadratic => Self::Quadratic,
            Choice::Cosines => Self::Cosines,
            Choice::Phong => Self::Phong,
        }
    }
}

/// Numbers of triangles and pixels that are drawn in one way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Count {
    /// Number of shaded triangles: all drawn ones but slivers between the centres of pixels. If a triangle is cut, each of its parts counts.
    pub triangles: u32,
    /// Pixels of these triangles, hidden ones included.
    pub pixels: u32,
}

/// Counts of each way, in the order of [`Way::ALL`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choices([Count; Way::ALL.len()]);

impl Choices {
    const NONE: Self = Self([Count { triangles: 0, pixels: 0 }; Way::ALL.len()]);

    /// The count of one way.
    #[must_use]
    pub const fn count(&self, way: Way) -> Count {
        self.0[way as usize]
    }

    /// The percentage of all triangles, and of all pixels, that is drawn in one way.
    #[must_use]
    pub fn percent(&self, way: Way) -> [f64; 2] {
        [|count: Count| count.triangles, |count: Count| count.pixels].map(|of| {
            let all: u64 = Way::ALL.iter().map(|&way| u64::from(of(self.count(way)))).sum();
            100.0 * f64::from(of(self.count(way))) / all.max(1) as f64
        })
    }

    /// Adds a triangle of `pixels` pixels.
    fn with_triangle(mut self, way: Way, pixels: u32) -> Self {
        let count = &mut self.0[way as usize];
        *count = Count { triangles: count.triangles + 1, pixels: count.pixels.saturating_add(pixels) };
        self
    }
}

/// A map from ways to counts.
impl Serialize for Choices {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(Way::ALL.map(|way| (way, self.count(way))))
    }
}

/// The shares of all ways.
impl fmt::Display for Choices {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shares = |of: usize| Way::ALL.map(|way| format!("{} {:.1} %", way.name(), self.percent(way)[of])).join(", ");
        write!(f, "triangles: {}; pixels: {}", shares(0), shares(1))
    }
}

/// The choice of `auto` for a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chosen {
    /// The way.
    pub way: Way,
    /// Levels by which each channel is raised, in 1/255.
    pub raises: [f64; 3],
}

/// The choices of `auto` in a frame.
#[derive(Clone, Debug)]
pub struct Told {
    /// The error budget, in 1/255.
    pub budget: f64,
    /// Counts of each way.
    pub choices: Choices,
    /// The choice for each triangle of the stream; `None` if the triangle is not drawn, or is cut first.
    pub ways: Vec<Option<Chosen>>,
}

thread_local! {
    /// Counts of the triangles that this thread has drawn in the frame.
    static CHOICES: Cell<Choices> = const { Cell::new(Choices::NONE) };
    /// The address of the triangles' records, and what was chosen for each triangle.
    static WAYS: RefCell<(usize, Vec<Option<Chosen>>)> = const { RefCell::new((0, Vec::new())) };
    /// The way of the triangle that this thread is shading.
    static WAY: Cell<Option<Way>> = const { Cell::new(None) };
}

/// The method `auto`, or `auto-linear`, which records its choices.
struct Telling<const QUADRATICS: bool>;

impl<const QUADRATICS: bool> Method for Telling<QUADRATICS> {
    fn facts(&self) -> &'static Facts {
        // Under a number of its own: the loops of `auto` would tell nothing.
        static FACTS: LazyLock<Facts> = LazyLock::new(|| Facts { id: Facts::FIRST_FREE, ..*Auto::<true>.facts() });
        &FACTS
    }

    fn error_bounds(&self, reflectance: LitMaterial<'_>, exponent: u16, lights: usize) -> ErrorBounds {
        Auto::<QUADRATICS>.error_bounds(reflectance, exponent, lights)
    }

    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32 {
        let choice = choose::<QUADRATICS>(setup, shading);
        let way = Way::from(choice);
        let raises = raises(choice, setup, shading).map(|raise| f64::from(raise) / f64::from(1 << LEVEL));
        WAY.set(Some(way));
        let pixels = Auto::<QUADRATICS>.shade(setup, shading, canvas);
        WAY.set(None);
        let is_first = WAYS.with_borrow_mut(|(first, ways)| {
            // A triangle that is cut has a record of its own, elsewhere.
            let distance = ptr::from_ref(setup.triangle).addr().wrapping_sub(*first);
            ways.get_mut(distance / size_of::<Triangle>()).is_none_or(|of| of.replace(Chosen { way, raises }).is_none())
        });
        // A large triangle is shaded once for each of its tiles, and each time all of its pixels are counted.
        if is_first {
            CHOICES.set(CHOICES.get().with_triangle(way, pixels));
        }
        pixels
    }
}

/// A pixel of any format that knows in which way it was drawn; `None` is background.
#[derive(Clone, Copy)]
struct Traced<C> {
    pixel: C,
    way: Option<Way>,
}

impl<C: Pixel> Traced<C> {
    /// A pixel of the triangle that is being shaded.
    fn new(pixel: C) -> Self {
        Self { pixel, way: WAY.get() }
    }

    /// The colour of the way, between three quarters of it and all, as the pixel is bright: that hints the shape.
    fn painted(self) -> Rgb888 {
        let shown = to_rgb(self.pixel).map(u32::from);
        let Some(way) = self.way else { return Rgb888::pack(shown) };
        let [r, g, b] = shown;
        let brightness = (2 * r + 5 * g + b) / 8;
        Rgb888::pack(way.colour().map(|channel| u32::from(channel) * (3 * 255 + brightness) / (4 * 255)))
    }
}

impl<C: Pixel> PixelFormat for Traced<C> {
    const GRAY: bool = C::GRAY;
    const DEPTH: [u32; 3] = C::DEPTH;
    const BYTES: usize = C::BYTES;

    fn pack(channels: [u32; 3]) -> Self {
        Self::new(C::pack(channels))
    }

    fn channels(self) -> [u8; 3] {
        self.pixel.channels()
    }

    fn bits(self) -> u32 {
        self.pixel.bits()
    }
}

impl<C: Pixel> Pixel for Traced<C> {
    type Stored = C::Stored;
    type Ramps = C::Ramps;

    const COARSE: bool = C::COARSE;
    const LEVELS: [u32; 3] = C::LEVELS;
    const IS_LIGHT: bool = C::IS_LIGHT;

    fn stored(self) -> C::Stored {
        self.pixel.stored()
    }

    fn from_stored(stored: C::Stored) -> Self {
        Self::new(C::from_stored(stored))
    }

    fn tabled(channels: [u32; 3], threshold: u32) -> C::Stored {
        C::tabled(channels, threshold)
    }

    fn entry(ramp: &[C::Stored; RAMP], level: u32, bits: u32) -> C::Stored {
        C::entry(ramp, level, bits)
    }

    fn quantised(intensity: Intensity, threshold: u32) -> Self {
        Self::new(C::quantised(intensity, threshold))
    }

    fn mixed(levels: [i32; 3]) -> Self {
        Self::new(C::mixed(levels))
    }
}

/// Draws frame `number` by [`Telling`] in the place of `shader`, in one band.
fn told<C: Pixel>(
    shader: Shader,
    stream: Stream<'_>,
    size: Size,
    perspective_correct: bool,
    number: u32,
) -> anyhow::Result<(Vec<C>, Stats, Told)> {
    let telling: &'static dyn Method = if shader == Shader::AUTO { &Telling::<true> } else { &Telling::<false> };
    let style = Style { perspective_correct, ..shader.into() };
    CHOICES.set(Choices::NONE);
    WAYS.set((stream.triangles.as_ptr().addr(), vec![None; stream.triangles.len()]));
    let (pixels, stats) = render::frame_by(stream, size, style, microphong::Shader::new(telling), size.height, number)?;
    let (_, ways) = WAYS.take();
    let budget = stream.header.budget().unwrap_or(C::BUDGET).to_num();
    Ok((pixels, stats, Told { budget, choices: CHOICES.get(), ways }))
}

/// The choices of a method in frame `number` of a picture in the pixel format `C`; `None` unless the method has an error budget.
///
/// # Errors
/// When `size` is out of range.
pub fn by<C: Pixel>(
    shader: Shader,
    stream: Stream<'_>,
    size: Size,
    perspective_correct: bool,
    number: u32,
) -> anyhow::Result<Option<Told>> {
    if !shader.keeps_budget() {
        return Ok(None);
    }
    let (_, _, told) = told::<C>(shader, stream, size, perspective_correct, number)?;
    Ok(Some(told))
}

/// Draws frame `number` by a method that keeps a budget, in this size, format and perspective, each triangle painted in the colour of its way, in 8 bits per
/// channel.
///
/// # Errors
/// When the size is out of range.
pub fn painted(stream: Stream<'_>, settings: &Settings, number: u32) -> anyhow::Result<(Picture, Told)> {
    struct Paint<'a>(Stream<'a>, &'a Settings, u32);
    impl InFormat for Paint<'_> {
        type Output = anyhow::Result<(Picture, Told)>;

        fn in_format<C: Pixel, F: FromDrawn<C>>(self) -> Self::Output {
            painted_as::<C>(self.0, self.1, self.2)
        }
    }
    settings.format.run(Paint(stream, settings, number))
}

/// Draws like [`painted`], pixels `C`, whatever the format of the settings is.
///
/// # Errors
/// When the size is out of range.
pub fn painted_as<C: Pixel>(stream: Stream<'_>, settings: &Settings, number: u32) -> anyhow::Result<(Picture, Told)> {
    let Settings { size, style, .. } = *settings;
    let (pixels, stats, told) = told::<Traced<C>>(style.shader, stream, size, style.perspective_correct, number)?;
    let painted: Vec<_> = pixels.into_iter().map(Traced::painted).collect();
    Ok((Picture { rgb: rgb_bytes(&painted), crc: render::crc(&painted), stats }, told))
}
