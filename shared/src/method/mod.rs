//! Shading methods, and what a method of your own needs. The methods of this crate are constants of [`crate::Shader`].
//!
//! A [`Method`] has properties ([`Facts`]) and draws the pixels of a triangle. It computes light at some points of the triangle, for example its
//! corners, and interpolates these values as a field over the triangle ([`levels_at`]). An [`IntensityShader`] converts the value at each pixel to
//! light ([`Intensity`]). A [`Canvas`] tests depth and stores colours, so a method knows nothing of pixel formats.

#[doc(hidden)]
pub mod auto;
#[doc(hidden)]
pub mod cosines;
mod facts;
#[doc(hidden)]
pub mod levels;
#[doc(hidden)]
pub mod lighting_model;
#[doc(hidden)]
pub mod node;
mod perspective;
#[doc(hidden)]
pub mod products;
#[doc(hidden)]
pub mod texture;
#[doc(hidden)]
pub mod tiles;
mod weakening;

use crate::{
    arch::product::by_fraction,
    features::{ALWAYS_CONSTANT, COLOURED, COLOURS, PERSPECTIVE, SKIPS, TEXTURES},
    format::{BIAS, CHANNEL, INTENSITY, LEVEL, NORMAL_LENGTH, SUBPIXEL, WALK},
    geometry::viewport::first_centre,
    interpolate::{
        Checkerboard, each_channel,
        perspective::{PerspectivePatch, Seen},
    },
    lighting::{
        albedo::{Albedo, IfColoured},
        material_tables::MaterialTables,
        sampler::Textured,
    },
    pixel::{Pixel, half_step, ramps::Ramps},
    raster::{
        active::ActiveTriangle,
        band::Band,
        counts::Counts,
        pixel_shader::{PixelShader, Ramp, Rgb},
        triangle::turn,
    },
    setup::gradients::MAX_FINE_THINNESS,
    stream::record::Triangle,
};
#[doc(inline)]
pub use crate::{
    format::Intensity,
    geometry::projection::ScreenVertex,
    raster::canvas::{Canvas, IntensityShader},
};
use core::fmt;
pub use facts::{Facts, VertexLight};
pub(crate) use perspective::{IN_SPACE, LinearWay, Middles};
use zerocopy::FromZeros as _;
// For the crate of the literature.
#[doc(hidden)]
pub use {
    crate::{
        interpolate::{
            Constant, Patch, Walker,
            field::{Field, Nodes},
            perspective::{Point, SHARE, Surface},
            plane::Plane,
        },
        lighting::{
            lights::{Lighting, Source, Viewer, cosine, point},
            reflectance::{LitMaterial, Reflectance, Reflection},
            sampler::{IfTextured, Sampler},
        },
        math::highlight_lut::{CosineLookup, Highlight},
        raster::{
            canvas::{Shaded, SpanShader},
            triangle::ScreenTriangle,
        },
        setup::{
            gradients::{GUARD, Gradients, MAX_THINNESS, NEAR, Slopes},
            steepness::Steepness,
        },
        stream::record::Vertex,
    },
    auto::error_bound::ErrorBounds,
    facts::HighlightField,
    lighting_model::{LightingModel, Lit},
    node::Node,
    products::{LinearNodes, QuadraticNodes, linear, quadratic, signed},
    texture::{OnTexture, PlacePatch, Placed},
};

/// A shading method: it computes the light of the pixels of a triangle. Implement it for a method of your own, and wrap it
/// with [`Shader::new`](crate::Shader::new). The renderer takes care of clipping, depth test and pixel formats.
pub trait Method: Sync {
    /// Returns the properties of the method, for example its name and the light that it needs at vertices.
    fn facts(&self) -> &'static Facts;

    /// Computes bounds for a method with an error budget, for a material of exponent `_exponent` under `_lights` lights. Other methods do nothing
    /// here.
    #[doc(hidden)]
    fn error_bounds(&self, _reflectance: LitMaterial<'_>, _exponent: u16, _lights: usize) -> ErrorBounds {
        ErrorBounds::new_zeroed()
    }

    /// Returns whether the method looks up highlights in tables while it draws. If it does not, because it uses the light of vertices alone, it
    /// also draws with a [`Layout::without_highlight_tables`](crate::Layout::without_highlight_tables).
    fn needs_highlight_tables(&self) -> bool {
        true
    }

    /// Draws the pixels of the triangle `setup` to `canvas`, for example with [`Area::draw`], and returns the number of pixels drawn, as `draw` does.
    /// `shading` has the material and the lights. The renderer calls this function for each triangle, and again for each band (a group of rows that
    /// is drawn at once) that the triangle lies in.
    fn shade(&self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, canvas: &mut dyn Canvas) -> u32;
}

impl fmt::Debug for dyn Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.facts().name)
    }
}

/// How the triangles of a mesh are drawn. It is decided once for all of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Style {
    /// Whether colours have three channels instead of one.
    pub(crate) three_channels: bool,
    /// Number of constant lights as [`Reflectance::lights`], if their levels fit the formats of [`crate::lighting::constant_lights`]; otherwise 0.
    pub(crate) lights: u8,
    /// Whether a light or the viewer is near, and the corners have no colours in greys.
    pub(crate) is_near: bool,
    /// Whether a light or the viewer is near, and methods with loops for that have loops for these lights.
    pub(crate) near_loops: bool,
    /// Whether loops can make the colours. Otherwise a canvas makes them, by the curve of a display on three channels that are not light.
    pub(crate) is_plain: bool,
    /// Whether light is interpolated in perspective.
    pub(crate) perspective: bool,
    /// Whether the corners of triangles have colours.
    pub(crate) is_coloured: bool,
    /// Whether triangles have a texture.
    pub(crate) has_texture: bool,
}

/// Loops of a method for some styles, compiled for each pixel format. All other styles are drawn by the general loop, through a [`Canvas`].
pub(crate) trait Loops {
    /// Whether the loops in three channels are compiled apart from loops in one. Otherwise the method asks for the channels itself.
    const APART: bool = false;

    /// Whether the method has only the general loop.
    const GENERAL: bool = false;

    /// Whether the loops leave some triangles of the styles that they take to the general loop, also without perspective and textures.
    const DECLINES: bool = true;

    /// Whether there are loops for `style`.
    fn take(style: Style) -> bool;

    /// Shades `setup` into `band` and returns the number of its pixels there; `None` if the general loop has to draw the triangle. `THREE` says
    /// whether the material has three channels, if loops are compiled [`Self::APART`].
    fn draw<C: Pixel, const THREE: bool>(
        setup: &TriangleSetup<'_>,
        shading: &Shading<'_>,
        tables: MaterialTables<'_, C>,
        band: &mut Band<'_, C>,
    ) -> Option<u32>;
}

/// Whether a program that draws by the loops `L` in the pixel format `C` needs the general loop: for some triangles, or for some styles.
pub(crate) const fn needs_general<L: Loops, C: Pixel>() -> bool {
    // Of colours, only the curve of a display on three channels that are not light needs a canvas.
    L::DECLINES || PERSPECTIVE || TEXTURES || COLOURS && !C::GRAY && !C::IS_LIGHT
}

/// The type of [`Loops::draw`] in one pixel format.
pub(crate) type DrawTriangle<C> = fn(&TriangleSetup<'_>, &Shading<'_>, MaterialTables<'_, C>, &mut Band<'_, C>) -> Option<u32>;

/// A method without loops of its own: the general loop draws all triangles.
pub(crate) struct General;

impl Loops for General {
    const GENERAL: bool = true;

    fn take(_: Style) -> bool {
        true
    }

    fn draw<C: Pixel, const THREE: bool>(
        _: &TriangleSetup<'_>,
        _: &Shading<'_>,
        _: MaterialTables<'_, C>,
        _: &mut Band<'_, C>,
    ) -> Option<u32> {
        None
    }
}

/// Fraction bits that a walked level has beyond those of a node.
const LEVEL_EXTRA: u32 = WALK - LEVEL;
/// Bits of the range of levels at nodes: they are in [0, 255] in Q9.7.
#[doc(hidden)]
pub const LEVEL_RANGE: u32 = LEVEL + 8;

/// N·L and N·H of a constant light at the corners, Q2.30.
pub(crate) type CornerCosines = [[i32; 3]; 2];

/// The largest difference between the levels of three corners, in any channel.
pub(crate) fn largest_range(corners: [[i32; 3]; 3]) -> u32 {
    let [[r0, g0, b0], [r1, g1, b1], [r2, g2, b2]] = corners;
    let range = |a: i32, b: i32, c: i32| (a.max(b).max(c) - a.min(b).min(c)) as u32;
    range(r0, r1, r2).max(range(g0, g1, g2)).max(range(b0, b1, b2))
}

/// The largest of three values.
#[inline]
pub(crate) fn largest(&[a, b, c]: &[i32; 3]) -> i32 {
    a.max(b).max(c)
}

/// A triangle that is ready to be shaded. The order of its corners 0, 1, 2 is the top one first, then clockwise on the screen. "Nodes" are
/// points where light is computed: the corners, and for some methods the midpoints of the edges 0-1, 1-2 and 2-0.
pub struct TriangleSetup<'f> {
    /// Corners, edges and depth on the screen.
    #[doc(hidden)]
    pub screen: &'f ScreenTriangle<'f>,
    /// The gradients by which polynomials are fitted to the triangle.
    #[doc(hidden)]
    pub gradients: &'f Gradients,
    /// The corners on the screen with their light: the top one first, then clockwise.
    pub corners: [&'f ScreenVertex; 3],
    /// The colours of the corners, if they have any.
    pub(crate) albedos: IfColoured<Option<&'f [Albedo; 3]>>,
    /// The middles of the edges where a quadratic on the screen has the nodes of colours.
    pub(crate) nodes_of_colours: IfColoured<Middles>,
    /// The texture of the triangle, if it has one.
    pub(crate) texture: IfTextured<Option<Textured<'f>>>,
    /// The triangle's record in the stream.
    #[doc(hidden)]
    pub triangle: &'f Triangle,
    /// The vertices of the mesh, to which the indices of the triangle's record point.
    #[doc(hidden)]
    pub vertices: &'f [Vertex],
    /// How often the stream's corners are rotated, so that the top one is first: 0, 1 or 2.
    #[doc(hidden)]
    pub turned: usize,
    /// Whether pixels need a depth test, because another triangle may overlap this one. [`Area::draw`] takes care of it.
    pub needs_depth_test: bool,
    /// Whether perspective-correct interpolation of light is on for this triangle.
    pub perspective: bool,
    /// Index of the active triangle whose patch the band above has saved. It is loaded, and nothing is fitted.
    pub(crate) place: Option<usize>,
}

impl TriangleSetup<'_> {
    /// Copies the set-up without edges and gradients, for functions that light the triangle. Since these are not passed on, the compiler keeps them
    /// in registers.
    #[inline]
    pub(crate) fn for_lighting(&self) -> TriangleSetup<'_> {
        TriangleSetup { screen: &ScreenTriangle::NONE, gradients: &Gradients::NONE, ..*self }
    }

    /// Returns the three vertices of the triangle in the mesh file, the top one first, then clockwise on the screen.
    #[doc(hidden)]
    #[inline(always)]
    pub fn vertices(&self) -> [&Vertex; 3] {
        let [a, c, b] = self.triangle.corners;
        // A checked stream has all vertices.
        let vertex = |corner: u16| self.vertices.get(usize::from(corner)).unwrap_or(&Vertex::ZERO);
        turn([vertex(a), vertex(b), vertex(c)], self.turned)
    }

    /// The colours of the corners; `None` if they have none.
    #[inline(always)]
    pub(crate) fn albedos(&self) -> Option<&[Albedo; 3]> {
        self.albedos.first().copied().flatten()
    }

    /// Returns the light levels of the corners: red, green, blue, each Q9.7 from 0 to 255, with the colours of the corners if they have any. Use it in
    /// a method whose [`Facts::vertex_light`] is [`VertexLight::Levels`].
    #[inline(always)]
    #[must_use]
    pub fn levels(&self) -> [[i32; 3]; 3] {
        match self.albedos() {
            Some(albedos) => painted(albedos, self.corners),
            None => self.corners.map(|corner| {
                let [r, g, b, _] = corner.light;
                [r, g, b]
            }),
        }
    }

    /// The inverse depths of the corners, Q0.28.
    #[inline(always)]
    fn depths(&self) -> [i32; 3] {
        let [a, b, c] = self.corners;
        [a.depth, b.depth, c.depth]
    }

    /// Returns the inverse depths of the corners (Q0.28), for perspective-correct interpolation. Returns `None` if that is off, or if all
    /// corners are equally far, so that linear interpolation on the screen gives the same result.
    #[doc(hidden)]
    #[inline(always)]
    pub fn inv_depth(&self) -> Option<[i32; 3]> {
        let [a, b, c] = self.depths();
        // If all corners are equally far, interpolation on the screen is the same.
        (self.perspective && !(a == b && b == c)).then_some([a, b, c])
    }

    /// A bound of the error of values that differ by `range` between corners, and that a plane on the screen interpolates; 0 if perspective is off.
    pub(crate) fn plane_error(&self, range: u32) -> u32 {
        self.inv_depth().map_or(0, |inv_depth| perspective::plane_error(inv_depth, range))
    }

    /// The quantity `surface` at the point in space that is seen at each pixel, for loops of a pixel format; `None` if the triangle reaches too far.
    fn in_space<S>(&self, surface: S) -> Option<Seen<S>> {
        let [a, b, c] = self.screen.corners();
        let extent = |k: usize| a[k].max(b[k]).max(c[k]).wrapping_sub(a[k].min(b[k]).min(c[k])) as u32 >> SUBPIXEL;
        Seen::new(self.gradients, self.depths(), extent(0) + extent(1), surface)
    }

    /// How values are interpolated on the screen that are linear over the triangle and differ by `range`, Q9.7, between corners: in the fastest way
    /// that is off by at most a quarter of a level, and 1/64 for the rounding of nodes.
    #[inline(always)]
    pub(crate) fn linear_way(&self, range: impl FnOnce() -> u32) -> LinearWay {
        match self.inv_depth() {
            Some(inv_depth) if PERSPECTIVE => perspective::linear_way(inv_depth, range(), 1 << (LEVEL - 2)),
            _ => LinearWay::Plane,
        }
    }

    /// Whether the interpolated normal may be shorter than 1/2, where the table of roots and every fit of 1/|N| end.
    #[doc(hidden)]
    #[inline]
    pub fn is_curved(&self) -> bool {
        self.triangle.min_normal_length < 1 << (NORMAL_LENGTH - 1)
    }

    /// The nodes on the edges of the triangle, on the screen if [`Self::has_screen_nodes`].
    #[inline(always)]
    pub(crate) fn middles(&self) -> Middles {
        if PERSPECTIVE && self.has_screen_nodes() { self.inv_depth().map(perspective::middles) } else { None }
    }

    /// Whether a quadratic on the screen can have its nodes there: perspective is off, or no interpolated normal is so short that the rounding of a
    /// place on an edge would turn it.
    #[inline(always)]
    pub(crate) fn has_screen_nodes(&self) -> bool {
        !PERSPECTIVE || self.inv_depth().is_none() || !self.is_curved()
    }

    /// [`Self::middles`] on the screen, Q2.30.
    pub(crate) fn fine_middles(&self) -> [u32; 3] {
        perspective::fine_middles(self.depths())
    }

    /// Whether such a quadratic also serves a root of N·H, which bends more than light: besides, the farthest corner is at most 9/8 as far as the
    /// nearest, or perspective is off.
    #[inline(always)]
    pub(crate) fn is_evenly_far(&self) -> bool {
        let even = |[a, b, c]: [i32; 3]| (a.max(b).max(c) as u32).wrapping_mul(8) <= (a.min(b).min(c) as u32).wrapping_mul(9);
        self.has_screen_nodes() && (!PERSPECTIVE || self.inv_depth().is_none_or(even))
    }

    /// Copies the set-up without perspective, for methods whose polynomials on the screen have nodes in perspective.
    pub(crate) fn on_screen(&self) -> TriangleSetup<'_> {
        TriangleSetup { perspective: false, nodes_of_colours: [self.middles(); COLOURED], ..*self }
    }

    /// Sorts three numbers that belong to the edges of the triangle in the mesh file into the order of the edges here: 0-1, 1-2, 2-0.
    #[doc(hidden)]
    #[inline]
    pub fn edges(&self, [ab, bc, ca]: [u16; 3]) -> [u16; 3] {
        turn([ca, bc, ab], self.turned)
    }

    /// Draws the triangle, without depth test where that is possible and worth a loop; returns the number of pixels in `band`. `patch` is
    /// called unless the band above has saved a patch.
    #[inline(always)]
    pub(crate) fn fill<P: Patch, T: PixelShader<<P::Walker as Walker>::Value>>(
        &self,
        patch: impl FnOnce() -> P,
        shader: T,
        band: &mut Band<'_, T::Pixel>,
    ) -> u32 {
        let patch = match self.place {
            Some(place) => match band.active.active_triangle(place).and_then(ActiveTriangle::patch) {
                Some(patch) => patch,
                // Active triangles have patches that can be saved.
                None => return 0,
            },
            None => patch(),
        };
        if T::CHEAP && !self.needs_depth_test {
            self.count(band.top, &mut band.counts.without_depth, 1);
            self.screen.draw_alone(self.gradients, patch, shader, band)
        } else {
            self.screen.draw(self.gradients, patch, shader, band)
        }
    }

    /// The [`PixelShader::ID`] that the band above has saved; `None` if the triangle is not active.
    pub(crate) fn resumed<C>(&self, band: &Band<'_, C>) -> Option<u8> {
        Some(band.active.active_triangle(self.place?)?.edges.shader)
    }

    /// What the band above has saved of the choice of `auto`; `None` if the triangle is not active.
    pub(crate) fn saved_choice<C>(&self, band: &Band<'_, C>) -> Option<u16> {
        Some(band.active.active_triangle(self.place?)?.choice)
    }

    /// Draws the triangle by `shader`, which begins on the row of the anchor. Returns the number of pixels in `canvas`.
    pub(crate) fn draw_spans(&self, shader: &mut dyn SpanShader, canvas: &mut dyn Canvas) -> u32 {
        self.screen.draw_spans(self.gradients, shader, canvas)
    }

    /// The first light's [`VertexLight::Cosines`] at the corners.
    #[inline(always)]
    pub(crate) fn corner_lights(&self) -> CornerCosines {
        let [a, b, c] = self.corners;
        [[a.light[0], b.light[0], c.light[0]], [a.light[1], b.light[1], c.light[1]]]
    }

    /// The [`VertexLight::Cosines`] of two lights at the corners. Domain: [`Reflectance::has_two_lights`], constant lights.
    #[inline(always)]
    pub(crate) fn corners_of_two_lights(&self) -> [CornerCosines; 2] {
        let [a, b, c] = self.corners;
        [self.corner_lights(), [[a.light[2], b.light[2], c.light[2]], [a.light[3], b.light[3], c.light[3]]]]
    }

    /// Returns `true` if no point of the triangle has a visible highlight. It can be used for one directional light and an infinitely
    /// distant viewer, if the vertices hold cosines ([`VertexLight::Cosines`]).
    #[doc(hidden)]
    #[inline(always)]
    pub fn has_no_highlight(&self, reflectance: &Reflectance) -> bool {
        let [a, b, c] = self.corners;
        a.light[1].max(b.light[1]).max(c.light[1]) < self.highlight_threshold(reflectance)
    }

    /// Whether the highlight of a constant light, whose N·H at the corners is `half`, is left out because it can be seen nowhere.
    #[inline]
    pub(crate) fn leaves_out_highlight(&self, reflectance: &Reflectance, half: &[i32; 3]) -> bool {
        largest(half) < self.before_division(reflectance.faintest())
    }

    /// Whether a light whose N·L at the corners is `towards` is left out because it reaches the triangle nowhere.
    #[inline]
    pub(crate) fn leaves_out_light(&self, reflectance: &Reflectance, towards: &[i32; 3]) -> bool {
        largest(towards) <= reflectance.darkest()
    }

    /// Adds `number` to a count of the band whose first row is `top`, if the triangle begins there.
    #[inline(always)]
    pub(crate) fn count(&self, top: i32, count: &mut u32, number: u32) {
        // Where the thinnest triangles begin, they may contain no pixel centre, and are not drawn.
        if !SKIPS || self.gradients.is_thinner_than(MAX_FINE_THINNESS) {
            return;
        }
        let [first, ..] = self.corners;
        if self.place.is_none() && first_centre(first.y).max(0) >= top {
            *count = count.wrapping_add(number);
        }
    }

    /// [`Self::count`] in the band of `canvas`.
    #[inline(always)]
    pub(crate) fn count_on(&self, canvas: &mut dyn Canvas, count: impl FnOnce(&mut Counts) -> &mut u32, number: u32) {
        // The compiler does not see that calls of a canvas can be left out.
        if SKIPS {
            let [_, top, _] = canvas.bounds();
            self.count(top, count(canvas.counts()), number);
        }
    }

    /// Returns the value of N·H (Q2.30) below which no highlight is visible on this triangle, where N is the normal interpolated linearly
    /// between the corners without normalising, and H the half vector between light and viewer.
    #[doc(hidden)]
    #[inline]
    pub fn highlight_threshold(&self, reflectance: &Reflectance) -> i32 {
        self.before_division(reflectance.highlight_threshold)
    }

    /// What a cosine, Q2.30, is at least before it is divided by |N|, where N·H is linear and |N| at least [`Triangle::min_normal_length`].
    #[inline]
    fn before_division(&self, cosine: i32) -> i32 {
        if cosine == Reflectance::NO_HIGHLIGHT {
            return cosine;
        }
        by_fraction(cosine, self.triangle.min_normal_length) << (16 - NORMAL_LENGTH)
    }
}

/// The levels of corners of these colours, whose vertices hold [`Parts`](crate::lighting::albedo::Parts).
#[inline(never)]
fn painted([x, y, z]: &[Albedo; 3], [a, b, c]: [&ScreenVertex; 3]) -> [[i32; 3]; 3] {
    [x.lit_vertex(a.light), y.lit_vertex(b.light), z.lit_vertex(c.light)]
}

/// An area of the screen that can be shaded: a triangle ([`TriangleSetup`]) or a part of one.
pub trait Area {
    /// Draws the area to `canvas`. It interpolates `field`, a quantity whose values at the corners are known, such as [`levels_at`], and computes the
    /// light of each pixel with `shader`. Returns the number of pixels drawn.
    fn draw<F: Field, S: IntensityShader<F::Value>>(&self, field: &F, shader: S, canvas: &mut dyn Canvas) -> u32;
}

/// The whole triangle, in perspective or not.
impl Area for TriangleSetup<'_> {
    fn draw<F: Field, S: IntensityShader<F::Value>>(&self, field: &F, shader: S, canvas: &mut dyn Canvas) -> u32 {
        if TEXTURES && self.has_texture() {
            return self.draw_textured(field, shader, canvas).unwrap_or(0);
        }
        if PERSPECTIVE && let Some(inv_depth) = self.inv_depth() {
            let patch = PerspectivePatch::new(self.gradients, inv_depth, *field);
            return self.draw_spans(&mut Shaded::new(patch, shader), canvas);
        }
        self.draw_spans(&mut Shaded::new(field.fit(self.gradients), shader), canvas)
    }
}

/// The material and the lights of a triangle, which the renderer passes to [`Method::shade`].
#[derive(Clone, Copy)]
pub struct Shading<'f> {
    /// The material under the lights of the scene. It converts cosines to light levels: N·L for diffuse light, and N·H for highlights.
    #[doc(hidden)]
    pub reflectance: LitMaterial<'f>,
    /// The lights of the scene and the viewer, in object space.
    #[doc(hidden)]
    pub lighting: &'f Lighting,
    /// The exponent of the material's highlight, 1 to 1024.
    pub exponent: u16,
    /// The unit vectors L (to the light) and H (half vector between light and viewer) in object space, Q2.30, if there is just one light,
    /// which is directional, and the viewer is infinitely distant. Otherwise `None`.
    #[doc(hidden)]
    pub constant: Option<[[i32; 3]; 2]>,
    /// Bounds of the error that cheap interpolation makes on this material, for methods that keep to an error budget.
    #[doc(hidden)]
    pub error_bounds: &'f ErrorBounds,
    /// The error budget: the largest difference of a pixel from Phong shading, in Q9.7 units of 1/255 of full intensity. Only methods that
    /// keep to a budget use it.
    #[doc(hidden)]
    pub budget: u32,
}

/// The nodes of each channel.
#[inline(always)]
fn channels<const N: usize>(levels: [[i32; 3]; N]) -> [[i32; N]; 3] {
    if N != 3 {
        return channels_of_many(levels);
    }
    // Written out: `map` of arrays goes through memory at opt-level "s".
    let mut channels = [[0; N]; 3];
    each_channel::<N>(|node| [channels[0][node], channels[1][node], channels[2][node]] = levels[node]);
    channels
}

/// [`channels`] of more nodes, by one loop.
fn channels_of_many<const N: usize>(levels: [[i32; 3]; N]) -> [[i32; N]; 3] {
    let mut channels = [[0; N]; 3];
    let [reds, greens, blues] = &mut channels;
    for (((red, green), blue), [r, g, b]) in reds.iter_mut().zip(greens).zip(blues).zip(levels) {
        (*red, *green, *blue) = (r, g, b);
    }
    channels
}

/// Creates a field (a quantity to be interpolated over a triangle) of light levels in three channels, for [`Area::draw`]. `levels` are red, green and
/// blue, each from 0 to 255 in Q9.7 (the integers 0 to 32,640), at `N` points: the 3 corners, or 6 with the midpoints of the edges 0-1, 1-2 and 2-0.
/// Use [`Walked`] to convert the interpolated values to an [`Intensity`].
#[must_use]
pub fn levels_at<const N: usize>(levels: [[i32; 3]; N]) -> Nodes<N, 3, LEVEL_RANGE> {
    Nodes::new(channels(levels), LEVEL_EXTRA).biased([bias(0); 3])
}

/// Levels at `N` nodes, Q9.7, as indices of the tables of colours of the pixel format `C`.
#[inline(always)]
fn indices<const N: usize, C: Pixel>(levels: [i32; N]) -> Nodes<N, 1, LEVEL_RANGE> {
    let bits = C::Ramps::BITS;
    let bias = (BIAS << bits).wrapping_add(1 << (bits - 1));
    Nodes::new([levels], bits - LEVEL).biased([bias])
}

/// The polynomial through [`indices`].
#[inline(always)]
fn fit_levels<const N: usize, C: Pixel>(gradients: &Gradients, levels: [i32; N]) -> <Nodes<N, 1, LEVEL_RANGE> as Field>::Patch
where
    Nodes<N, 1, LEVEL_RANGE>: Field<Patch: Checkerboard>,
{
    let patch = indices::<N, C>(levels).fit(gradients);
    if C::Ramps::CHECKERED { patch.checkered(gradients.row()) } else { patch }
}

/// Levels of three channels at `N` nodes, `raise` more, as [`Rgb`] takes them in the pixel format `C`.
#[inline(always)]
fn three_levels<const N: usize, C: Pixel>(channels: [[i32; N]; 3], raise: i32) -> Nodes<N, 3, LEVEL_RANGE> {
    let [r, g, b] = const {
        let [r, g, b] = C::LEVELS;
        [half_step(r), half_step(g), half_step(b)]
    };
    let raise = raise << (CHANNEL - LEVEL);
    Nodes::new(channels, CHANNEL - LEVEL).biased([r + raise, g + raise, b + raise])
}

/// The bias of walked levels plus `more`.
const fn bias(more: i32) -> i32 {
    (BIAS << WALK).wrapping_add(more)
}

impl Shading<'_> {
    /// Returns `true` if vertices hold cosines, and `false` if they hold light levels, in a method that asks for
    /// [`VertexLight::CosinesOrLevels`]. Cosines are there if the scene has just one light, which is directional, and the viewer is
    /// infinitely distant.
    #[doc(hidden)]
    #[inline]
    pub fn vertices_have_cosines(&self) -> bool {
        ALWAYS_CONSTANT || self.constant.is_some()
    }

    /// Interpolates light levels over `area` and draws them to `canvas`. `levels` are red, green and blue, Q9.7, at `N` points: the 3
    /// corners, or 6 with the midpoints of the edges 0-1, 1-2 and 2-0. `BITS` is the number of bits of their range: 15 for levels from 0 to
    /// 255. Returns the number of pixels drawn.
    #[doc(hidden)]
    pub fn draw_levels<const N: usize, const BITS: u32>(&self, area: &impl Area, levels: [[i32; 3]; N], canvas: &mut dyn Canvas) -> u32
    where
        Nodes<N, 1, BITS>: Field<Value = [u32; 1]>,
        Nodes<N, 3, BITS>: Field<Value = [u32; 3]>,
    {
        self.draw_channels::<N, BITS>(area, &channels(levels), [0; 3], canvas)
    }

    /// Draws like [`Self::draw_levels`], from the nodes of each channel, which are raised by `raises`.
    pub(crate) fn draw_channels<const N: usize, const BITS: u32>(
        &self,
        area: &impl Area,
        channels: &[[i32; N]; 3],
        raises: [i32; 3],
        canvas: &mut dyn Canvas,
    ) -> u32
    where
        Nodes<N, 1, BITS>: Field<Value = [u32; 1]>,
        Nodes<N, 3, BITS>: Field<Value = [u32; 3]>,
    {
        let biases = raises.map(|raise| bias(raise << LEVEL_EXTRA));
        if self.reflectance.three_channels() {
            area.draw(&Nodes::<N, 3, BITS>::new(*channels, LEVEL_EXTRA).biased(biases), Walked, canvas)
        } else {
            area.draw(&Nodes::<N, 1, BITS>::new([channels[0]], LEVEL_EXTRA).biased([biases[0]]), Walked, canvas)
        }
    }

    /// [`Self::draw_levels`] by loops of a method: one level, which is an index of the table of colours.
    #[inline(always)]
    fn fill_one<const N: usize, C: Pixel>(
        setup: &TriangleSetup<'_>,
        nodes: impl FnOnce() -> [i32; N],
        tables: MaterialTables<'_, C>,
        band: &mut Band<'_, C>,
    ) -> u32
    where
        Nodes<N, 1, LEVEL_RANGE>: Field<Value = [u32; 1], Patch: Checkerboard>,
    {
        setup.fill(|| fit_levels::<N, C>(setup.gradients, nodes()), Ramp(tables.ramps), band)
    }

    /// [`Self::draw_levels`] by loops of a method: three levels, `raise` more than at the nodes, whose polynomials are walked as `walked` says.
    #[inline(always)]
    fn fill_three<const N: usize, C: Pixel, P: Patch<Walker: Walker<Value = [u32; 3]>>>(
        &self,
        setup: &TriangleSetup<'_>,
        channels: impl FnOnce() -> [[i32; N]; 3],
        raise: i32,
        walked: impl FnOnce(<Nodes<N, 3, LEVEL_RANGE> as Field>::Patch) -> P,
        band: &mut Band<'_, C>,
    ) -> u32
    where
        Nodes<N, 3, LEVEL_RANGE>: Field,
    {
        let patch = || walked(three_levels::<N, C>(channels(), raise).fit(setup.gradients));
        setup.fill(patch, Rgb::new(self.reflectance.quarter), band)
    }
}

/// Draws all pixels of a triangle with these levels, and returns their number in `canvas`.
// A call, so that a method that can also draw otherwise does not keep its memory on the stack meanwhile.
#[inline(never)]
pub(crate) fn draw_uniform(setup: &TriangleSetup<'_>, levels: [i32; 3], canvas: &mut dyn Canvas) -> u32 {
    setup.draw_spans(&mut Shaded::new(Constant, Uniform(of_levels(levels))), canvas)
}

/// Shades all pixels with one intensity.
#[derive(Clone, Copy, Debug)]
#[doc(hidden)]
pub struct Uniform(pub Intensity);

impl IntensityShader<()> for Uniform {
    fn shade(&self, (): ()) -> Intensity {
        // One by one: as a whole they would be moved by a function for memory that may overlap.
        let Self([r, g, b]) = *self;
        [r, g, b]
    }
}

/// An [`IntensityShader`] for interpolated light levels, such as those of [`levels_at`]: each pixel gets the interpolated level.
#[derive(Clone, Copy, Debug)]
pub struct Walked;

/// Converts a walked level, which has a bias, to an intensity.
#[inline]
fn intensity(walked: u32) -> i32 {
    ((walked >> (WALK - INTENSITY)) as i32 - (BIAS << INTENSITY)).clamp(0, (1 << 16) - 1)
}

/// Converts levels in Q9.7 to intensities of at most 255.
#[inline]
#[doc(hidden)]
pub fn of_levels(levels: [i32; 3]) -> Intensity {
    levels.map(|level| level.max(0) << 1)
}

impl IntensityShader<[u32; 1]> for Walked {
    #[inline]
    fn shade(&self, [level]: [u32; 1]) -> Intensity {
        [intensity(level); 3]
    }
}

impl IntensityShader<[u32; 3]> for Walked {
    #[inline]
    fn shade(&self, levels: [u32; 3]) -> Intensity {
        levels.map(intensity)
    }
}
