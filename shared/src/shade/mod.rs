//! The shading methods, one file each: what it fits, and what it makes of it at a pixel.

#[cfg(feature = "all-shaders")]
mod angular;
#[cfg(feature = "all-shaders")]
mod blinn;
#[cfg(feature = "all-shaders")]
mod cubic;
pub(crate) mod duff;
#[cfg(feature = "all-shaders")]
mod environment;
pub(crate) mod flat;
mod form;
#[cfg(feature = "all-shaders")]
mod gloss;
#[cfg(feature = "all-shaders")]
mod goldman;
pub(crate) mod gouraud;
#[cfg(feature = "all-shaders")]
mod gouraud4;
#[cfg(feature = "all-shaders")]
mod highlight_test;
#[cfg(feature = "all-shaders")]
mod hybrid;
mod node;
#[cfg(feature = "all-shaders")]
mod parabola;
pub(crate) mod phong;
#[cfg(feature = "all-shaders")]
mod phong_rv;
#[cfg(feature = "all-shaders")]
mod pseudo_phong;
#[cfg(feature = "all-shaders")]
mod quadratic_blinn;
mod quotient;
#[cfg(feature = "all-shaders")]
mod renq;
#[cfg(feature = "all-shaders")]
mod renq_newton;
#[cfg(feature = "all-shaders")]
mod scanline;
pub(crate) mod six_point;
#[cfg(feature = "all-shaders")]
mod six_point_adaptive;
#[cfg(feature = "all-shaders")]
mod six_point_centre;
#[cfg(feature = "all-shaders")]
mod slerp;
#[cfg(feature = "all-shaders")]
mod split;
#[cfg(feature = "all-shaders")]
pub(crate) mod sqrt6;
#[cfg(feature = "all-shaders")]
mod taylor;
#[cfg(feature = "all-shaders")]
mod taylor_finite;

#[cfg(feature = "all-shaders")]
use crate::poly::hyperbolic::Hyperbolic;
use crate::{
    band::Band,
    format::{BIAS, LEVEL, RHO, WALK},
    math::product::by_fraction,
    palette::Palette,
    pixel::Pixel,
    poly::{
        Patch, Walker,
        basis::Basis,
        field::{Field, Nodes},
    },
    raster::triangle::{Outline, turn},
    scene::{Direction, Lighting, cosine},
    shade::node::Node,
    shader::Shader,
    stream::record::{Triangle, Vertex},
    tone::{Dithered, Ramp, Rgb, Tone},
    vertex::ScreenVertex,
};
use core::marker::PhantomData;
#[cfg(feature = "all-shaders")]
use parabola::Parabolas;

/// Fraction bits that a walked level has more than a node's.
const EXTRA: u32 = WALK - LEVEL;
/// Levels of nodes are in [0, 255] in Q9.7.
const RANGE: u32 = LEVEL + 8;

/// A triangle ready to be shaded; all triples start with its top corner.
pub(crate) struct Facet<'f> {
    pub(crate) outline: &'f Outline,
    pub(crate) basis: &'f Basis,
    pub(crate) corners: [&'f ScreenVertex; 3],
    pub(crate) triangle: &'f Triangle,
    /// Those that the triangle's indices are of.
    pub(crate) vertices: &'f [Vertex],
    /// Others may overlap it.
    pub(crate) contested: bool,
    /// It is to be shaded in perspective, if that makes a difference.
    #[cfg(feature = "all-shaders")]
    pub(crate) perspective: bool,
    /// Where the band above handed it on: its patch is there, and nothing is to be fitted.
    pub(crate) place: Option<usize>,
}

impl Facet<'_> {
    /// Its vertices, the top one first.
    #[inline(always)]
    fn vertices(&self) -> [&Vertex; 3] {
        let [a, c, b] = self.triangle.corners;
        // A stream that has been checked has them all.
        let vertex = |corner: u16| self.vertices.get(usize::from(corner)).unwrap_or(&Vertex::ZERO);
        turn([vertex(a), vertex(b), vertex(c)], self.outline.turned)
    }

    /// Nearness of its corners, if it is to be shaded in perspective.
    #[cfg(feature = "all-shaders")]
    #[inline(always)]
    fn nearness(&self) -> Option<[i32; 3]> {
        let [a, b, c] = self.corners;
        let (a, b, c) = (a.depth, b.depth, c.depth);
        // All of it equally far is all of it flat on the screen.
        (self.perspective && !(a == b && b == c)).then_some([a, b, c])
    }

    /// Constants of the stream's edges in the order of the corners here, which turn the other way.
    #[inline(always)]
    fn edges(&self, [ab, bc, ca]: [u16; 3]) -> [u16; 3] {
        turn([ca, bc, ab], self.outline.turned)
    }

    /// Draws it, without depth where that is possible and worth a loop of its own; returns the pixels in `band`.
    #[inline(always)]
    fn fill<P: Patch, T: Tone<<P::Walker as Walker>::Value>>(&self, patch: P, tone: T, band: &mut Band<'_, T::Pixel>) -> u32 {
        if T::CHEAP && !self.contested {
            self.outline.draw_alone(self.basis, patch, tone, band)
        } else {
            self.outline.draw(self.basis, patch, tone, band)
        }
    }

    /// What the band above handed on.
    #[inline(always)]
    fn kept<P: Patch, C>(&self, band: &Band<'_, C>) -> Option<P> {
        band.relay.leg(self.place?)?.patch()
    }

    /// That of the tone in which the band above handed it on.
    #[cfg(feature = "all-shaders")]
    #[inline(always)]
    fn mark<C>(&self, band: &Band<'_, C>) -> Option<u8> {
        Some(band.relay.leg(self.place?)?.rest.mark())
    }

    /// Nowhere on the triangle does the highlight of one constant light reach a visible level:
    /// N·H is linear and |N| at least rho.
    #[inline(always)]
    fn is_dark<C: Pixel>(&self, palette: &Palette<C>) -> bool {
        let [a, b, c] = self.corners;
        a.light[1].max(b.light[1]).max(c.light[1]) < self.dark_below(palette)
    }

    /// Where N·H, linear between the corners, is smaller, N·H over |N| is too small for a highlight; Q2.30.
    #[inline(always)]
    fn dark_below<C: Pixel>(&self, palette: &Palette<C>) -> i32 {
        by_fraction(palette.dark_below(), self.triangle.rho) << (16 - RHO)
    }
}

/// Some part of the screen that belongs to a triangle.
trait Area {
    /// Draws a field there, which is asked for if it is not known already; returns the pixels in `band`.
    fn draw<F: Field, T: Tone<F::Value>>(&self, field: impl FnOnce() -> F, tone: T, band: &mut Band<'_, T::Pixel>) -> u32;

    /// The same, in the first of two tones or in the second.
    fn draw_either<F: Field, T: Tone<F::Value>, U: Tone<F::Value, Pixel = T::Pixel>>(
        &self,
        field: impl FnOnce() -> F,
        first: bool,
        tones: (T, U),
        band: &mut Band<'_, T::Pixel>,
    ) -> u32;
}

/// The whole triangle, in perspective or without.
impl Area for Facet<'_> {
    #[inline(always)]
    fn draw<F: Field, T: Tone<F::Value>>(&self, field: impl FnOnce() -> F, tone: T, band: &mut Band<'_, T::Pixel>) -> u32 {
        let patch = match self.kept(band) {
            Some(patch) => patch,
            None => {
                let field = field();
                #[cfg(feature = "all-shaders")]
                if let Some(nearness) = self.nearness() {
                    return self.outline.draw(self.basis, Hyperbolic::new(self.basis, nearness, field.surface()), tone, band);
                }
                field.fit(self.basis)
            }
        };
        self.fill(patch, tone, band)
    }

    #[inline(always)]
    fn draw_either<F: Field, T: Tone<F::Value>, U: Tone<F::Value, Pixel = T::Pixel>>(
        &self,
        field: impl FnOnce() -> F,
        first: bool,
        tones: (T, U),
        band: &mut Band<'_, T::Pixel>,
    ) -> u32 {
        let patch = match self.kept(band) {
            Some(patch) => patch,
            None => {
                let field = field();
                #[cfg(feature = "all-shaders")]
                if let Some(nearness) = self.nearness() {
                    let patch = Hyperbolic::new(self.basis, nearness, field.surface());
                    return if first {
                        self.outline.draw(self.basis, patch, tones.0, band)
                    } else {
                        self.outline.draw(self.basis, patch, tones.1, band)
                    };
                }
                field.fit(self.basis)
            }
        };
        if first { self.fill(patch, tones.0, band) } else { self.fill(patch, tones.1, band) }
    }
}

/// A method in the loop over the triangles of one mesh.
pub(crate) trait Method {
    /// In perspective, too.
    #[cfg(feature = "all-shaders")]
    const ANY: bool = false;

    /// Shades `facet`, of a simple triangle, into `band`; returns its pixels there, or `None` if it takes the long way.
    fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> Option<u32>;
}

/// Any of them, on whatever there is: looked up at each triangle.
pub(crate) struct Any;

impl Method for Any {
    #[cfg(feature = "all-shaders")]
    const ANY: bool = true;

    #[inline(always)]
    fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> Option<u32> {
        Some(shading.draw(facet, band))
    }
}

/// What all triangles of one material have in common in one frame.
pub(crate) struct Shading<'f, C> {
    pub(crate) shader: Shader,
    pub(crate) dither: bool,
    pub(crate) palette: &'f Palette<C>,
    pub(crate) lighting: &'f Lighting,
    /// The material's.
    #[cfg(feature = "all-shaders")]
    pub(crate) exponent: u16,
    /// L and H if they are constant, see [`Lighting::constant`].
    pub(crate) constant: Option<[[i32; 3]; 2]>,
    /// The same, for products with vertex normals.
    pub(crate) directions: Option<[Direction; 2]>,
}

/// The first channel. Written out, as far as it matters: `map` is a loop through memory at opt-level "s".
#[inline(always)]
fn first<const N: usize>(levels: [[i32; 3]; N]) -> [i32; N] {
    let mut first = [0; N];
    if let ([a, b, c], [[x, ..], [y, ..], [z, ..]]) = (first.as_mut_slice(), levels.as_slice()) {
        (*a, *b, *c) = (*x, *y, *z);
        return first;
    }
    levels.map(|[level, ..]| level)
}

/// Nodes of each channel.
fn channels<const N: usize>(levels: [[i32; 3]; N]) -> [[i32; N]; 3] {
    [levels.map(|[r, ..]| r), levels.map(|[_, g, _]| g), levels.map(|[.., b]| b)]
}

/// The bias of walked levels plus a rounding half, the same in all channels.
fn lift<const CH: usize>(half: i32) -> [i32; CH] {
    [(BIAS << WALK).wrapping_add(half); CH]
}

impl<C: Pixel> Shading<'_, C> {
    /// One level says it all: one constant light on a material of one channel, without dither.
    #[cfg(any(feature = "fast-loops", feature = "all-shaders"))]
    pub(crate) fn is_plain(&self) -> bool {
        self.constant.is_some() && !self.palette.three_channels && !self.dither
    }

    /// Shades `facet` into `band`; returns its pixels there.
    #[inline(always)]
    pub(crate) fn draw(&self, facet: &Facet<'_>, band: &mut Band<'_, C>) -> u32 {
        match self.shader {
            Shader::Flat => flat::draw(facet, self, band),
            Shader::Gouraud => gouraud::draw(facet, self, band),
            Shader::SixPoint => six_point::draw(facet, self, band),
            Shader::Phong => phong::draw(facet, self, band),
            #[cfg(feature = "all-shaders")]
            _ => self.draw_literature(facet, band),
            #[cfg(not(feature = "all-shaders"))]
            _ => 0,
        }
    }

    /// The methods that not every build has.
    #[cfg(feature = "all-shaders")]
    fn draw_literature(&self, facet: &Facet<'_>, band: &mut Band<'_, C>) -> u32 {
        match self.shader {
            Shader::Gouraud4 => gouraud4::draw(facet, self, band),
            Shader::PseudoPhong => pseudo_phong::draw(facet, self, band),
            Shader::SixPointAdaptive => six_point_adaptive::draw(facet, self, band),
            Shader::SixPointCentre => six_point_centre::draw(facet, self, band),
            Shader::PhongRv => phong_rv::draw(facet, self, band),
            Shader::HighlightTest => highlight_test::draw(facet, self, band),
            Shader::Taylor => taylor::draw(facet, self, band),
            Shader::TaylorFinite => taylor_finite::draw(facet, self, band),
            Shader::Cubic => cubic::draw(facet, self, band),
            Shader::Environment => environment::draw(facet, self, band),
            Shader::Blinn => blinn::draw(facet, self, band),
            Shader::QuadraticBlinn => quadratic_blinn::draw(facet, self, band),
            Shader::Duff => duff::draw(facet, self, band),
            Shader::Sqrt6 => sqrt6::draw(facet, self, band),
            Shader::Renq => renq::draw(facet, self, band),
            Shader::RenqNewton => renq_newton::draw(facet, self, band),
            Shader::Goldman => goldman::draw(facet, self, band),
            Shader::Slerp => slerp::draw(facet, self, band),
            Shader::Angular => angular::draw(facet, self, Parabolas::refitted, band),
            Shader::AngularOriginal => angular::draw(facet, self, Parabolas::printed, band),
            Shader::Hybrid => hybrid::draw(facet, self, Parabolas::refitted, band),
            Shader::HybridOriginal => hybrid::draw(facet, self, Parabolas::printed, band),
            _ => 0,
        }
    }

    /// Levels at a point, Q9.7.
    fn levels(&self, node: &Node) -> [i32; 3] {
        if let Some([towards, half]) = self.constant {
            return self.palette.one_light([cosine(node.normal, towards), cosine(node.normal, half)]);
        }
        self.palette.levels(self.lighting.cosines(node.position, node.normal))
    }

    /// Draws one level or three, whichever the material needs, from those at `N` nodes, Q9.7 in a range narrower than
    /// 2^`BITS`.
    #[inline(always)]
    fn draw_levels<const N: usize, const BITS: u32>(
        &self,
        area: &impl Area,
        levels: impl FnOnce() -> [[i32; 3]; N],
        band: &mut Band<'_, C>,
    ) -> u32
    where
        Nodes<N, 1, BITS>: Field<Value = [u32; 1]>,
        Nodes<N, 3, BITS>: Field<Value = [u32; 3]>,
    {
        if !self.palette.three_channels {
            self.draw_one::<N, BITS>(area, || first(levels()), band)
        } else {
            self.draw_three::<N, BITS>(area, levels, band)
        }
    }

    /// Draws one level by its nodes.
    #[inline(always)]
    fn draw_one<const N: usize, const BITS: u32>(&self, area: &impl Area, nodes: impl FnOnce() -> [i32; N], band: &mut Band<'_, C>) -> u32
    where
        Nodes<N, 1, BITS>: Field<Value = [u32; 1]>,
    {
        let half = if self.dither { 0 } else { 1 << (WALK - 1) };
        let field = || Nodes::<N, 1, BITS>::new([nodes()], EXTRA).raised(lift(half));
        area.draw_either(field, self.dither, (Dithered::new(self.palette.base), Ramp(&self.palette.ramp)), band)
    }

    /// Draws one level by its nodes, without dither.
    #[cfg(any(feature = "fast-loops", feature = "all-shaders"))]
    #[inline(always)]
    fn draw_plain<const N: usize, const BITS: u32>(&self, area: &impl Area, nodes: impl FnOnce() -> [i32; N], band: &mut Band<'_, C>) -> u32
    where
        Nodes<N, 1, BITS>: Field<Value = [u32; 1]>,
    {
        let field = || Nodes::<N, 1, BITS>::new([nodes()], EXTRA).raised(lift(1 << (WALK - 1)));
        area.draw(field, Ramp(&self.palette.ramp), band)
    }

    /// Draws three levels by their nodes.
    #[inline(always)]
    fn draw_three<const N: usize, const BITS: u32>(
        &self,
        area: &impl Area,
        levels: impl FnOnce() -> [[i32; 3]; N],
        band: &mut Band<'_, C>,
    ) -> u32
    where
        Nodes<N, 3, BITS>: Field<Value = [u32; 3]>,
    {
        // Half a step of each channel.
        let half = C::DEPTH.map(|depth| if self.dither { 0 } else { 1 << (WALK + 7 - depth) });
        let field = || Nodes::<N, 3, BITS>::new(channels(levels()), EXTRA).raised(half.map(|half| (BIAS << WALK).wrapping_add(half)));
        area.draw_either(field, self.dither, (Dithered::new(self.palette.base), Rgb(PhantomData)), band)
    }
}
