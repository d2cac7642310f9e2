//! A shading method together with the loops that draw it in one pixel format.

use crate::{
    features::COLOURS,
    geometry::bin::{TriangleKey, Walk},
    mesh::Drawing,
    method::{
        ErrorBounds, Facts, General, LitMaterial, Loops, Method, Shading, Style, TriangleSetup,
        auto::Auto,
        cosines::{phong::Phong, sqrt6::Sqrt6},
        levels::{flat::Flat, gouraud::Gouraud, six_point::SixPoint},
        needs_general,
    },
    pixel::Pixel,
    raster::{band::Band, canvas::Canvas},
    stream::record::Triangle,
};
use core::fmt;

/// A shading method, compiled for the pixel format `C`. Choose one of the constants, or wrap your own [`Method`] with [`Self::new`]. A program
/// contains only the code of the methods that it mentions.
#[derive(Clone, Copy)]
pub struct Shader<C: Pixel> {
    method: &'static dyn Method,
    /// Whether `loops` can draw this style. If not, the general loop draws it.
    take: fn(Style) -> bool,
    pub(crate) loops: TriangleLoops<C>,
    /// Loops for three channels.
    three_channels: TriangleLoops<C>,
    /// The general loop, unless the program needs none.
    general: TriangleLoops<C>,
}

/// The type of [`Drawing::run`] with the loops of one method.
type Run<C> = fn(&Drawing<'_, C>, TriangleKey, &mut Walk<'_>, &mut Band<'_, C>) -> (u32, Option<TriangleKey>);

/// What draws triangles by the loops of one method.
#[derive(Clone, Copy)]
pub(crate) struct TriangleLoops<C: Pixel> {
    /// Draws the triangles of a mesh that lie in a band.
    pub(crate) run: Run<C>,
    /// Draws one triangle.
    pub(crate) draw: fn(&Drawing<'_, C>, &Triangle, &mut Band<'_, C>) -> u32,
}

/// A method whose loops draw everything: a program that has no other pointer to it contains no general loop of it.
struct LoopsAlone<M>(M);

impl<M: Method> Method for LoopsAlone<M> {
    fn facts(&self) -> &'static Facts {
        self.0.facts()
    }

    fn error_bounds(&self, reflectance: LitMaterial<'_>, exponent: u16, lights: usize) -> ErrorBounds {
        self.0.error_bounds(reflectance, exponent, lights)
    }

    fn needs_highlight_tables(&self) -> bool {
        self.0.needs_highlight_tables()
    }

    fn shade(&self, _: &TriangleSetup<'_>, _: &Shading<'_>, _: &mut dyn Canvas) -> u32 {
        0
    }
}

impl<C: Pixel> TriangleLoops<C> {
    const fn of<L: Loops, const THREE: bool>() -> Self {
        Self {
            run: |drawing, entry, walk, band| drawing.run::<L, THREE>(entry, walk, band),
            draw: |drawing, triangle, band| drawing.draw::<L, THREE>(triangle, band),
        }
    }
}

impl<C: Pixel> Shader<C> {
    /// Flat shading: each triangle has one colour. It suits objects with facets, and is the fastest method.
    pub const FLAT: Self = Self::with_loops(&LoopsAlone(Flat));
    /// Gouraud shading: light is computed at the corners of a triangle and interpolated linearly. It suits matte surfaces, and highlights that are
    /// wider than a triangle.
    pub const GOURAUD: Self = Self::with_loops(&LoopsAlone(Gouraud));
    /// Six-point shading: light is computed at the corners and the midpoints of the edges of a triangle, and interpolated by a quadratic
    /// polynomial. It suits smooth surfaces, but flattens highlights that are narrower than a triangle.
    pub const SIX_POINT: Self = Self::with_loops(&LoopsAlone(SixPoint));
    /// Phong shading: the normal is interpolated and normalised at every pixel. Highlights use the half vector H between light and viewer
    /// (Blinn). All other methods approximate this result.
    pub const PHONG: Self = Self::with_loops(&LoopsAlone(Phong));
    /// Phong-like shading for large triangles: the square root of N·H is computed at the corners of a triangle and the midpoints of its edges, and
    /// interpolated quadratically. At each pixel it is squared and raised to the exponent of the material. The result is almost the same as with
    /// [`Shader::PHONG`], in less time.
    pub const SQRT6: Self = Self::with_loops(&LoopsAlone(Sqrt6));

    /// A method that chooses for each triangle the cheapest way whose error stays within a budget: one colour, linear interpolation, two
    /// kinds of quadratic interpolation, or Phong shading. [`Renderer::set_budget`](crate::Renderer::set_budget) sets the budget. This is
    /// the default of `microphong convert`.
    pub const AUTO: Self = Self::with_loops(&LoopsAlone(Auto::<true>));
    /// A variant of [`Shader::AUTO`] without quadratic interpolation. Its code takes about 60 % of the flash that the code of `AUTO` takes. It keeps
    /// the same error budget, but is slower on large triangles.
    pub const AUTO_LINEAR: Self = Self::with_loops(&LoopsAlone(Auto::<false>));

    /// All shading methods of this crate. A program that uses this list contains the code of every method.
    pub const ALL: [Self; 7] = [Self::FLAT, Self::GOURAUD, Self::SIX_POINT, Self::PHONG, Self::SQRT6, Self::AUTO, Self::AUTO_LINEAR];

    /// Creates a shader from your own implementation of [`Method`], or from a method of the crate `microphong-literature`.
    #[must_use]
    pub const fn new(method: &'static dyn Method) -> Self {
        let general = TriangleLoops::of::<General, false>();
        Self { method, take: General::take, loops: general, three_channels: general, general }
    }

    const fn with_loops<M: Method + Loops>(method: &'static LoopsAlone<M>) -> Self {
        // A grey format has one channel, and so has a program without the feature `colours`.
        let loops = TriangleLoops::of::<M, false>();
        let three_channels = if M::APART && !C::GRAY && COLOURS { TriangleLoops::of::<M, true>() } else { loops };
        let method: &'static dyn Method = if needs_general::<M, C>() { &method.0 } else { method };
        let general = if needs_general::<M, C>() { TriangleLoops::of::<General, false>() } else { loops };
        Self { method, take: M::take, loops, three_channels, general }
    }

    /// The loops that draw a style.
    pub(crate) fn loops(&self, style: Style) -> TriangleLoops<C> {
        // Decision: style.
        match ((self.take)(style), style.three_channels) {
            (true, false) => self.loops,
            (true, true) => self.three_channels,
            (false, _) => self.general,
        }
    }

    /// Returns the properties of the shading method, for example its name and its number.
    #[must_use]
    pub fn facts(&self) -> &'static Facts {
        self.method.facts()
    }

    /// Returns the shading method that this shader draws with. A shader is a method together with loops for one pixel format; the method is the same
    /// for all formats.
    #[must_use]
    pub fn method(&self) -> &'static dyn Method {
        self.method
    }
}

impl<C: Pixel> fmt::Debug for Shader<C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.method.fmt(f)
    }
}
