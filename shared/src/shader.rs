//! A shading method together with the loops that draw it in one pixel format.

use crate::{
    geometry::bin::{Key, Walk},
    mesh::MeshPass,
    method::{
        DrawTriangle, Facts, General, Loops, Method, Style, auto::Auto, flat::Flat, gouraud::Gouraud, phong::Phong,
        renq_newton::RenqNewton, six_point::SixPoint, sqrt6::Sqrt6,
    },
    pixel::Pixel,
    raster::band::Band,
};
use core::fmt;

/// A shading method in the pixel format `C`. A program contains the code of the methods that it names, and of no others.
#[derive(Clone, Copy)]
pub struct Shader<C: Pixel> {
    method: &'static dyn Method,
    /// Whether `loops` can draw this style; if not, the general way does.
    take: fn(Style) -> bool,
    pub(crate) loops: TriangleLoops<C>,
    /// Loops for three channels.
    three_channels: TriangleLoops<C>,
}

/// The type of [`MeshPass::run`] with the loops of one method.
type Run<C> = fn(&MeshPass<'_, C>, Key, &mut Walk<'_>, &mut Band<'_, C>) -> (u32, Option<Key>);

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
    /// One colour per triangle.
    pub const FLAT: Self = Self::with_loops(&Flat);
    /// Lit at the corners, linear in between.
    pub const GOURAUD: Self = Self::with_loops(&Gouraud);
    /// Lit at corners and edge midpoints, quadratic in between.
    pub const SIX_POINT: Self = Self::with_loops(&SixPoint);
    /// Normals interpolated and normalised at every pixel, highlight by the half vector.
    pub const PHONG: Self = Self::with_loops(&Phong);
    /// The root of N·H quadratic, squared and raised at the pixel.
    pub const SQRT6: Self = Self::with_loops(&Sqrt6);
    /// Linear numerators times a quadratic reciprocal length, made exact by Newton's iteration.
    pub const RENQ_NEWTON: Self = Self::with_loops(&RenqNewton);

    /// For each triangle the cheapest method that stays within the error budget.
    pub const AUTO: Self = Self::with_loops(&Auto::<true>);
    /// [`Shader::AUTO`] without quadratics: half of its flash, and as exact.
    pub const AUTO_LINEAR: Self = Self::with_loops(&Auto::<false>);

    /// Every method of this crate.
    pub const ALL: [Self; 8] =
        [Self::FLAT, Self::GOURAUD, Self::SIX_POINT, Self::PHONG, Self::SQRT6, Self::RENQ_NEWTON, Self::AUTO, Self::AUTO_LINEAR];

    /// A method of your own, or of the crate `microphong-literature`.
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
    /// What is known of the method.
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
        f.write_str(self.facts().name)
    }
}
