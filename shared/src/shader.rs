//! A shading method together with the loops that draw it in one pixel format.

use crate::{
    geometry::bin::{Key, Walk},
    mesh::Drawing,
    method::{
        DrawTriangle, Facts, General, Loops, Method, Style, auto::Auto, flat::Flat, gouraud::Gouraud, phong::Phong,
        renq_newton::RenqNewton, six_point::SixPoint, sqrt6::Sqrt6,
    },
    pixel::Pixel,
    raster::band::Band,
};
use core::fmt;

/// A shading method in the pixel format `C`. A program contains only the code of methods that it names.
#[derive(Clone, Copy)]
pub struct Shader<C: Pixel> {
    method: &'static dyn Method,
    /// Whether `loops` can draw this style. If not, the general loop draws it.
    take: fn(Style) -> bool,
    pub(crate) loops: TriangleLoops<C>,
    /// Loops for three channels.
    three_channels: TriangleLoops<C>,
}

/// The type of [`Drawing::run`] with the loops of one method.
type Run<C> = fn(&Drawing<'_, C>, Key, &mut Walk<'_>, &mut Band<'_, C>) -> (u32, Option<Key>);

/// What draws triangles by the loops of one method.
pub(crate) struct TriangleLoops<C: Pixel> {
    /// Draws the triangles of a mesh that lie in a band.
    pub(crate) run: Run<C>,
    /// Draws one triangle.
    pub(crate) draw: DrawTriangle<C>,
}

impl<C: Pixel> Clone for TriangleLoops<C> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<C: Pixel> Copy for TriangleLoops<C> {}

impl<C: Pixel> TriangleLoops<C> {
    const fn of<L: Loops>() -> Self {
        Self { run: |drawing, entry, walk, band| drawing.run::<L>(entry, walk, band), draw: L::draw }
    }
}

impl<C: Pixel> Shader<C> {
    /// Flat shading: one colour for each triangle.
    pub const FLAT: Self = Self::with_loops(&Flat);
    /// Gouraud shading: light at the corners of a triangle, interpolated linearly.
    pub const GOURAUD: Self = Self::with_loops(&Gouraud);
    /// Six-point shading: light at the corners and the midpoints of edges, interpolated quadratically.
    pub const SIX_POINT: Self = Self::with_loops(&SixPoint);
    /// Phong shading: the normal is interpolated and normalised at every pixel. Highlights use the half vector.
    pub const PHONG: Self = Self::with_loops(&Phong);
    /// Six-point shading with a root: the square root of N·H is interpolated quadratically, then squared and raised to the exponent at every pixel.
    pub const SQRT6: Self = Self::with_loops(&Sqrt6);
    /// Normals interpolated linearly, multiplied by a reciprocal length that is interpolated quadratically and corrected by a step of Newton's method
    /// at every pixel.
    pub const RENQ_NEWTON: Self = Self::with_loops(&RenqNewton);

    /// The cheapest way for each triangle that keeps to the error budget: one colour, linear, quadratic, or Phong shading.
    pub const AUTO: Self = Self::with_loops(&Auto::<true>);
    /// [`Shader::AUTO`] without quadratic interpolation. It takes about half of the flash, and keeps to the error budget as well.
    pub const AUTO_LINEAR: Self = Self::with_loops(&Auto::<false>);

    /// Every method of this crate.
    pub const ALL: [Self; 8] =
        [Self::FLAT, Self::GOURAUD, Self::SIX_POINT, Self::PHONG, Self::SQRT6, Self::RENQ_NEWTON, Self::AUTO, Self::AUTO_LINEAR];

    /// A method of the program's own, or of the crate `microphong-literature`.
    #[must_use]
    pub const fn new(method: &'static dyn Method) -> Self {
        Self { method, take: General::take, loops: TriangleLoops::of::<General>(), three_channels: TriangleLoops::of::<General>() }
    }

    const fn with_loops<M: Method + Loops>(method: &'static M) -> Self {
        // A grey format has one channel.
        let three_channels = if C::GRAY { TriangleLoops::of::<M>() } else { TriangleLoops::of::<M::ThreeChannels>() };
        Self { method, take: M::take, loops: TriangleLoops::of::<M>(), three_channels }
    }

    /// The loops that draw a style.
    pub(crate) fn loops(&self, style: Style) -> TriangleLoops<C> {
        match ((self.take)(style), style.three_channels) {
            (true, false) => self.loops,
            (true, true) => self.three_channels,
            (false, _) => TriangleLoops::of::<General>(),
        }
    }
}

impl<C: Pixel> Shader<C> {
    /// Properties of the method.
    #[must_use]
    pub fn facts(&self) -> &'static Facts {
        self.method.facts()
    }

    /// The method.
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
