//! Triangles whose colours a texture has.
//!
//! The place in the texture is linear over a triangle in space. On the screen it is interpolated by a plane or a quadratic where that is off by at most a
//! quarter of a texel, and otherwise from the point that is seen at each pixel. A pixel takes the nearest texel.
//!
//! Ambient and diffuse light is multiplied by the texel, and highlights are added. So methods that interpolate levels interpolate both apart.
//!
//! `flat`, `gouraud`, `six-point`, and `auto` where it interpolates between corners draw by loops of the pixel format that are here. Under directional
//! lights `phong` has loops for colours that change from pixel to pixel. All else goes through the general loop.

use crate::{
    arch::product::by_fraction,
    features::{PERSPECTIVE, TEXTURES, TRANSPARENCY},
    format::{BIAS, CHANNEL, FULL, INTENSITY, Intensity, LEVEL, RAMP, TEXTURE, WALK},
    interpolate::{
        Patch, Walker,
        by_column::ByColumn,
        field::{Field, Nodes},
        perspective::{PerspectivePatch, Seen, Slant},
        plane::Plane,
        quadric::Quadric,
    },
    lighting::{
        albedo::{Albedo, Parts, SHARE},
        material_tables::MaterialTables,
        sampler::{FINER, IfTextured, Sampler, Textured, WALKED},
    },
    math::vector::{map, zip},
    method::{
        IN_SPACE, IntensityShader, LEVEL_EXTRA, LEVEL_RANGE, LinearWay, Shading, TriangleSetup, bias, channels,
        node::mixed,
        perspective,
        products::{LinearNodes, QuadraticNodes, fitted, linear, quadratic},
    },
    pixel::{
        Pixel,
        by_rows::{ByRows, ByTurns},
        half_step,
        ramps::Ramps,
        steps,
    },
    raster::{
        band::Band,
        canvas::{Canvas, Shaded},
        pixel_shader::{PixelShader, Ramp, has_kernels},
    },
    stream::record::Colour,
};
use microphong_kernels as kernels;

/// The place in a texture over a triangle.
#[derive(Clone, Copy, Debug)]
pub enum PlacePatch {
    /// A quadratic on the screen.
    OnScreen(Quadric<2>),
    /// From the point that is seen.
    InSpace(PerspectivePatch<LinearNodes<2>>),
}

/// Walks a [`PlacePatch`].
#[derive(Clone, Copy, Debug)]
pub enum PlaceWalker {
    /// On the screen.
    OnScreen(<Quadric<2> as Patch>::Walker),
    /// In space.
    InSpace(<PerspectivePatch<LinearNodes<2>> as Patch>::Walker),
}

/// Bits of the range of a place at corners.
const PLACE: u32 = TEXTURE + 4;
/// Fraction bits that a place which a plane interpolates has more than at corners.
const MORE: u32 = 16;

/// The largest error of a place on the screen: a quarter of a texel, in the unit of [`Sampler::range`].
const MOST: u32 = 2;

impl TriangleSetup<'_> {
    /// Whether the triangle has a texture.
    #[inline]
    pub(crate) fn has_texture(&self) -> bool {
        TEXTURES && self.texture.first().is_some_and(Option::is_some)
    }

    /// The texture of the triangle and the place in it, if it has one. There is no room for them in a program without the feature.
    #[doc(hidden)]
    #[inline]
    #[must_use]
    pub fn texture_patch(&self) -> IfTextured<Option<Placed<'_, PlacePatch>>> {
        self.texture.each_ref().map(|texture| {
            let texture = texture.as_ref()?;
            Some(Placed { place: self.place_patch(texture), sampler: texture.sampler })
        })
    }

    /// The place in a texture over the triangle.
    #[inline(never)]
    fn place_patch(&self, texture: &Textured<'_>) -> PlacePatch {
        if let Some(quadric) = by_quadratic(self, texture, self.way_of_places(texture)) {
            return PlacePatch::OnScreen(quadric);
        }
        PlacePatch::InSpace(PerspectivePatch::new(self.gradients, self.depths(), linear(corner_nodes(texture))))
    }

    /// How the place in a texture is interpolated.
    fn way_of_places(&self, Textured { sampler, places, in_perspective }: &Textured<'_>) -> LinearWay {
        if !in_perspective {
            return LinearWay::Plane;
        }
        perspective::linear_way(self.depths(), sampler.range(places), MOST)
    }

    /// The texels over the triangle; `None` if it has no texture, or a quadratic is too far off for the place.
    #[inline(never)]
    pub(crate) fn texels(&self) -> Option<Placed<'_, ByColumn<Quadric<2>>>> {
        let texture = self.texture.first()?.as_ref()?;
        Some(Placed { place: ByColumn(by_quadratic(self, texture, self.way_of_places(texture))?), sampler: texture.sampler })
    }

    /// The texels at the points that are seen at each pixel.
    fn place_in_space<'f>(&self, texture: &Textured<'f>) -> Option<Placed<'f, Seen<Slant<2>>>> {
        Some(Placed { place: self.in_space(linear(corner_nodes(texture)).slant())?, sampler: texture.sampler })
    }

    /// The place in a texture as a plane on the screen.
    #[inline(never)]
    fn place_by_plane(&self, Textured { places, .. }: &Textured<'_>) -> Plane<2> {
        let [[u0, v0], [u1, v1], [u2, v2]] = *places;
        let plane = Nodes::<3, 2, PLACE>::new([[u0, u1, u2], [v0, v1, v2]], MORE).fit(self.gradients);
        plane.shifted(32 - TEXTURE - MORE)
    }

    /// Draws the triangle, whose light is `field`, by `shader` with the texture. Returns the number of pixels drawn; `None` if it has no texture.
    pub(crate) fn draw_textured<F: Field, S>(&self, field: &F, shader: S, canvas: &mut dyn Canvas) -> Option<u32>
    where
        for<'s> OnTexture<'s, S>: IntensityShader<(F::Value, Colour)>,
    {
        let place = self.texture_patch().first().copied()??;
        let shader = OnTexture { sampler: place.sampler, shader };
        if PERSPECTIVE && let Some(inv_depth) = self.inv_depth() {
            let patch = PerspectivePatch::new(self.gradients, inv_depth, *field);
            return Some(self.draw_spans(&mut Shaded::new((patch, place), shader), canvas));
        }
        Some(self.draw_spans(&mut Shaded::new((field.fit(self.gradients), place), shader), canvas))
    }

    /// Draws the triangle by its texture, with the light of `parts` at its nodes. Returns the number of pixels drawn; 0 if it has no texture.
    pub(crate) fn draw_parts<const N: usize>(&self, parts: [Parts; N], canvas: &mut dyn Canvas) -> u32
    where
        Nodes<N, 3, BRIGHT>: Field<Value = [u32; 3]>,
    {
        let brightest = |levels| map(levels, |level: i32| level.min(FULL << SIXTEENTH));
        let nodes = |levels: [[i32; 3]; N]| {
            Nodes::<N, 3, BRIGHT>::new(channels(levels.map(brightest)), LEVEL_EXTRA - SIXTEENTH).biased([bias(0); 3])
        };
        let field = (nodes(parts.map(|parts| parts.diffuse)), nodes(parts.map(|parts| parts.specular)));
        self.draw_textured(&field, Apart, canvas).unwrap_or(0)
    }
}

/// The place at the corners.
fn corner_nodes(Textured { places, .. }: &Textured<'_>) -> [[i32; 3]; 2] {
    let [[u0, v0], [u1, v1], [u2, v2]] = map(*places, |place| place.map(|c| c << FINER));
    [[u0, u1, u2], [v0, v1, v2]]
}

/// The place at the corners and at these shares of the edges.
fn place_nodes(texture: &Textured<'_>, [ab, bc, ca]: [u16; 3]) -> QuadraticNodes<2> {
    quadratic(corner_nodes(texture).map(|[a, b, c]| [a, b, c, mixed(a, b, ab), mixed(b, c, bc), mixed(c, a, ca)]))
}

/// A sixteenth of a level is walked, because dark texels show more than 255 of ambient and diffuse light, and a quadratic goes beyond its nodes. It is the
/// power of two that this is the logarithm of.
const SIXTEENTH: u32 = 4;
/// Bits of the range of levels at nodes, of which sixteenths are walked.
const BRIGHT: u32 = LEVEL_RANGE + SIXTEENTH;
/// Likewise for loops of a pixel format, which draw no brighter light: a quarter.
const QUARTER: u32 = 2;

/// A quarter of a level, as far as that is no more than full intensity.
fn quarter_of(level: i32) -> i32 {
    ((level + (1 << (QUARTER - 1))) >> QUARTER).min(FULL)
}

/// A walked sixteenth as an intensity, which may be beyond black and white.
fn whole(sixteenth: u32) -> i32 {
    ((sixteenth >> (WALK - INTENSITY - SIXTEENTH)) as i32) - (BIAS << (INTENSITY + SIXTEENTH))
}

/// Colours the light of another shader by a texture.
#[derive(Clone, Copy, Debug)]
pub struct OnTexture<'f, S> {
    /// The texture.
    pub sampler: &'f Sampler<'f>,
    /// The shader of the light.
    pub shader: S,
}

/// Interpolated sixteenths of levels: of ambient and diffuse light, and of highlights.
pub(crate) struct Apart;

impl Albedo {
    /// What a surface of this colour reflects of an intensity.
    fn reflected(self, light: Intensity) -> Intensity {
        zip(light, self.shares(), |light, share| ((i64::from(light) * i64::from(share) + (1 << (SHARE - 1))) >> SHARE) as i32)
    }
}

/// All light is coloured: methods that do not tell highlights apart show them in the colour of the surface.
impl<V, S: IntensityShader<V>> IntensityShader<(V, Colour)> for OnTexture<'_, S> {
    fn shade(&self, (value, texel): (V, Colour)) -> Intensity {
        // No more than full intensity, as without a texture.
        self.sampler.albedo(texel).reflected(map(self.shader.shade(value), |light| light.min(FULL << (INTENSITY - LEVEL))))
    }
}

impl IntensityShader<(([u32; 3], [u32; 3]), Colour)> for OnTexture<'_, Apart> {
    fn shade(&self, ((light, highlights), texel): (([u32; 3], [u32; 3]), Colour)) -> Intensity {
        let reflected = self.sampler.albedo(texel).reflected(map(light, whole));
        zip(reflected, map(highlights, whole), |reflected, highlight| (reflected + highlight).clamp(0, i32::from(u16::MAX)))
    }
}

/// Draws a triangle with a texture by a loop of its pixel format: `parts` of light at its nodes, which are interpolated, and a place by a plane or a
/// quadratic or at the point that is seen at each pixel. Three nodes are the corners. Six nodes are those of a quadratic on the screen. `None` if the
/// general loop has to draw it: under very bright light, and where a triangle reaches too far for words.
#[inline(never)]
pub(crate) fn fill<C: Pixel, const N: usize>(
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    parts: &[Parts; N],
    tables: MaterialTables<'_, C>,
    band: &mut Band<'_, C>,
) -> Option<u32>
where
    LightAtNodes<N, 1>: DrawTextured<1>,
    LightAtNodes<N, 3>: DrawTextured<3>,
{
    let texture = setup.texture.first()?.as_ref()?;
    let nodes = |levels: fn(&Parts) -> [i32; 3]| parts.each_ref().map(levels);
    let (diffuse, specular) = (nodes(|parts| parts.diffuse), nodes(|parts| parts.specular));
    // Light without a hue is one level at a pixel.
    let one = || {
        let green = |[_, green, _]: [i32; 3]| green;
        LightAtNodes::new([diffuse.map(green)], [specular.map(green)])
    };
    if C::GRAY {
        return if GrayTexels::<C>::EXISTS { one().draw(setup, texture, GrayTexels(Ramp(tables.ramps)), band) } else { None };
    }
    let quarter = shading.reflectance.quarter;
    if shading.reflectance.is_neutral() && NeutralTexels::<C>::EXISTS {
        let pixels = NeutralTexels::<C>::neutral(quarter);
        let rows = pixels.rows(texture.sampler, N);
        return one().draw(setup, texture, Texels { rows: rows.as_ref(), ..pixels }, band);
    }
    let pixels = Texels::<C>::new(quarter);
    let rows = pixels.rows(texture.sampler, N);
    LightAtNodes::new(channels(diffuse), channels(specular)).draw(setup, texture, Texels { rows: rows.as_ref(), ..pixels }, band)
}

/// The light of a triangle at `N` nodes, in `CH` channels: what texels reflect of it, and what is added to that.
#[derive(Clone, Copy)]
pub(crate) struct LightAtNodes<const N: usize, const CH: usize> {
    /// Quarters of ambient and diffuse light, [`scaled`].
    diffuse: [[i32; N]; CH],
    specular: [[i32; N]; CH],
}

impl<const N: usize, const CH: usize> LightAtNodes<N, CH> {
    fn new(diffuse: [[i32; N]; CH], specular: [[i32; N]; CH]) -> Self {
        Self { diffuse: diffuse.map(|levels| levels.map(|level| scaled(quarter_of(level)))), specular }
    }

    fn brightest(levels: &[[i32; N]; CH]) -> i32 {
        levels.as_flattened().iter().fold(0, |most, &level| most.max(level))
    }

    /// Draws a triangle by the texels of `place` and by polynomials that `fit` makes of light, without highlights if none reaches it.
    #[inline]
    fn fill<C: Pixel, T, L>(
        &self,
        setup: &TriangleSetup<'_>,
        place: impl FnOnce() -> T,
        fit: impl Fn([[i32; N]; CH]) -> L,
        pixels: impl LitTexels<C, CH>,
        band: &mut Band<'_, C>,
    ) -> u32
    where
        T: Patch<Walker: Walker<Value = Colour>>,
        L: Patch<Walker: Walker<Value = [u32; CH]>>,
    {
        if Self::brightest(&self.specular) == 0 {
            setup.fill(|| (place(), fit(self.diffuse)), pixels, band)
        } else {
            setup.fill(|| (place(), (fit(self.diffuse), fit(self.specular))), pixels, band)
        }
    }

    /// Whether the sum at a pixel is less than `most` of 255 for sure. A quadratic exceeds the interval of its nodes, which begins at 0 here, by at most a
    /// third at each end: the absolute values of the weights of six nodes sum to at most 5/3.
    fn is_less_than(&self, most: i32) -> bool {
        let sum = (Self::brightest(&self.diffuse) << QUARTER) + Self::brightest(&self.specular);
        let brightest = if N == 3 { sum } else { sum + sum / 3 };
        brightest < most << LEVEL
    }
}

impl<const CH: usize> LightAtNodes<3, CH> {
    /// The largest difference between corners, in levels.
    fn range(&self) -> u32 {
        let spread =
            |levels: &[[i32; 3]; CH]| levels.iter().fold(0, |most, &[a, b, c]| most.max((a.max(b).max(c) - a.min(b).min(c)) as u32));
        (spread(&self.diffuse) << QUARTER).max(spread(&self.specular))
    }

    /// Draws a triangle that reaches so far that place and light are those of the point that is seen at each pixel.
    #[inline(never)]
    fn draw_in_space<C: Pixel, P: LitTexels<C, CH>>(
        &self,
        setup: &TriangleSetup<'_>,
        texture: &Textured<'_>,
        pixels: P,
        band: &mut Band<'_, C>,
    ) -> Option<u32> {
        let level = |levels| Nodes::<3, CH, LEVEL_RANGE>::new(levels, CHANNEL - LEVEL).slant();
        let seen = setup.in_space((linear(corner_nodes(texture)).slant(), (level(self.diffuse), level(self.specular))))?;
        Some(setup.fill(|| Placed::<_, false> { place: seen, sampler: texture.sampler }, pixels, band))
    }

    /// The light at the corners and at these shares of the edges.
    fn six(&self, [ab, bc, ca]: [u16; 3]) -> LightAtNodes<6, CH> {
        let six = |[a, b, c]: [i32; 3]| [a, b, c, mixed(a, b, ab), mixed(b, c, bc), mixed(c, a, ca)];
        LightAtNodes { diffuse: self.diffuse.map(six), specular: self.specular.map(six) }
    }
}

/// Makes pixels of texels and light in `CH` channels, without highlights and with them.
pub(crate) trait LitTexels<C, const CH: usize>:
    PixelShader<(Colour, [u32; CH]), Pixel = C> + PixelShader<(Colour, ([u32; CH], [u32; CH])), Pixel = C>
{
    /// The sum of light at a pixel, of 255, has to be less than this.
    const MOST: i32 = 511;
}

impl<C: Pixel> LitTexels<C, 3> for Texels<'_, C> {}

impl<C: Pixel> LitTexels<C, 1> for NeutralTexels<'_, C> {}

impl<C: Pixel> LitTexels<C, 1> for GrayTexels<'_, C> {
    /// Where the table of colours ends.
    const MOST: i32 = RAMP as i32 - BIAS - 1;
}

/// Light by which a triangle with a texture is drawn.
pub(crate) trait DrawTextured<const CH: usize> {
    /// Draws the triangle. `None` if the general loop has to draw it.
    fn draw<C: Pixel, P: LitTexels<C, CH>>(
        &self,
        setup: &TriangleSetup<'_>,
        texture: &Textured<'_>,
        pixels: P,
        band: &mut Band<'_, C>,
    ) -> Option<u32>;
}

impl<const CH: usize> DrawTextured<CH> for LightAtNodes<3, CH> {
    #[inline(never)]
    fn draw<C: Pixel, P: LitTexels<C, CH>>(
        &self,
        setup: &TriangleSetup<'_>,
        texture: &Textured<'_>,
        pixels: P,
        band: &mut Band<'_, C>,
    ) -> Option<u32> {
        if !self.is_less_than(P::MOST) {
            return None;
        }
        match setup.linear_way(|| self.range()) {
            LinearWay::Plane => {}
            LinearWay::Quadratic(shares) => return self.six(shares).draw(setup, texture, pixels, band),
            LinearWay::InSpace => return self.draw_in_space(setup, texture, pixels, band),
        }
        let fit = |levels| Nodes::<3, CH, LEVEL_RANGE>::new(levels, CHANNEL - LEVEL).fit(setup.gradients);
        let way = setup.way_of_places(texture);
        if matches!(way, LinearWay::Plane) {
            let (plane, sampler) = (setup.place_by_plane(texture), texture.sampler);
            // Kernels walk quadratics.
            let has_kernel = const { <P as PixelShader<(Colour, [u32; CH])>>::KERNEL.is_some() };
            if has_kernel {
                return Some(self.fill(setup, || Texture { place: ByColumn(plane.into()), sampler }, fit, pixels, band));
            }
            return Some(self.fill(setup, || Placed::<_, true> { place: plane, sampler }, fit, pixels, band));
        }
        if let Some(place) = aligned(setup, texture, way) {
            return Some(self.fill(setup, || place, fit, pixels, band));
        }
        if PERSPECTIVE && setup.inv_depth().is_some() {
            return self.draw_in_space(setup, texture, pixels, band);
        }
        let place = setup.place_in_space(texture)?;
        Some(setup.fill(|| (place, (fit(self.diffuse), fit(self.specular))), pixels, band))
    }
}

impl<const CH: usize> DrawTextured<CH> for LightAtNodes<6, CH> {
    #[inline(never)]
    fn draw<C: Pixel, P: LitTexels<C, CH>>(
        &self,
        setup: &TriangleSetup<'_>,
        texture: &Textured<'_>,
        pixels: P,
        band: &mut Band<'_, C>,
    ) -> Option<u32> {
        if !self.is_less_than(P::MOST) {
            return None;
        }
        let fit = |levels| ByColumn(Nodes::<6, CH, LEVEL_RANGE>::new(levels, CHANNEL - LEVEL).fit(setup.gradients));
        if let Some(quadratic) = by_quadratic(setup, texture, setup.way_of_places(texture)) {
            let place = || Placed::<_, false> { place: ByColumn(quadratic), sampler: texture.sampler };
            return Some(self.fill(setup, place, fit, pixels, band));
        }
        let place = setup.place_in_space(texture)?;
        Some(setup.fill(|| (place, (fit(self.diffuse), fit(self.specular))), pixels, band))
    }
}

/// The place on the screen as a quadratic, also where it is a plane; `None` where only the point in space will do.
fn by_quadratic(setup: &TriangleSetup<'_>, texture: &Textured<'_>, way: LinearWay) -> Option<Quadric<2>> {
    let shares = match way {
        LinearWay::Plane => IN_SPACE,
        LinearWay::Quadratic(shares) => shares,
        LinearWay::InSpace => return None,
    };
    Some(fitted(&place_nodes(texture, shares), setup.gradients))
}

/// Texels whose place is a quadratic on the screen, see [`by_quadratic`].
type Texture<'f> = Placed<'f, ByColumn<Quadric<2>>, true>;

/// The texels where a quadratic will do for the place.
fn aligned<'f>(setup: &TriangleSetup<'_>, texture: &Textured<'f>, way: LinearWay) -> Option<Texture<'f>> {
    Some(Placed { place: ByColumn(by_quadratic(setup, texture, way)?.shifted(32 - WALKED)), sampler: texture.sampler })
}

/// A level that is multiplied by a channel of 0 to 255 and divided by 256.
fn scaled(level: i32) -> i32 {
    level + ((level + 128) >> 8)
}

/// Makes pixels of interpolated light and of texels.
#[derive(Clone, Copy)]
struct Texels<'f, C, const N: usize = 3> {
    /// What is added to a level before it is rounded down.
    rounding: ByTurns<[i32; N], C>,
    /// The texture for kernels, on even rows and on odd ones.
    rows: Option<&'f [kernels::Texels<'f>; 2]>,
}

impl<C: Pixel, const N: usize> Texels<'_, C, N> {
    /// What kernels add to red, green and blue.
    fn rounded(rounding: [i32; N]) -> [i32; 3] {
        [rounding[0], rounding[1], rounding[if N == 3 { 2 } else { 0 }]]
    }

    /// The texture for kernels, which draw light of so many nodes; `None` if there are none, or none for the format.
    #[inline]
    fn rows<'t>(&self, sampler: &Sampler<'t>, nodes: usize) -> Option<[kernels::Texels<'t>; 2]> {
        let [even, odd] = self.rounding.both().map(Self::rounded);
        if has_kernels::<C>() && nodes == 3 { Some([sampler.in_kernels(even)?, sampler.in_kernels(odd)?]) } else { None }
    }

    /// The fields of a kernel for light of which so many levels are walked.
    const fn fields(levels: usize) -> Option<[usize; 2]> {
        if has_kernels::<C>() { Some([levels, 2]) } else { None }
    }

    /// The kernel for so many highlights.
    #[inline]
    fn kernel(&self, highlights: usize) -> Option<kernels::Lit<'_>> {
        let [even, odd] = self.rows?;
        let rows = if even.rounding() == Self::rounded(self.rounding.now()) { [even, odd] } else { [odd, even] };
        let colours = if N == 3 { kernels::Colours::Texels(rows) } else { kernels::Colours::NeutralTexels(rows) };
        C::lit(colours, highlights, kernels::Lookup::default())
    }
}

impl<C: Pixel> Texels<'_, C> {
    /// Dithers by rows, see [`Rgb`](crate::raster::pixel_shader::Rgb).
    fn new(quarter: i32) -> Self {
        let rounding = |quarter| zip(steps(C::DEPTH, quarter), C::LEVELS, |step, depth| half_step(depth) + step);
        let [even, odd] = if C::Ramps::CHECKERED { [-quarter, quarter] } else { [0; 2] };
        Self { rounding: ByTurns::new([rounding(even), rounding(odd)]), rows: None }
    }

    /// The levels that [`scaled`] quarters of light leave on a texel.
    #[inline]
    fn reflected([r, g, b]: [u32; 3], Colour { channels: [red, green, blue], .. }: Colour) -> [i32; 3] {
        // Q8.16 times eight bits, of which a quarter is a whole level with CHANNEL fraction bits. It is between -512 and 512.
        let reflect = |quarter: u32, channel: u8| (quarter as i32 >> (CHANNEL - 16)).wrapping_mul(channel.into());
        [reflect(r, red), reflect(g, green), reflect(b, blue)]
    }

    #[inline]
    fn colour(&self, levels: [i32; 3]) -> C {
        C::mixed(zip(levels, self.rounding.now(), i32::wrapping_add))
    }
}

impl<C: Pixel, const N: usize> ByRows for Texels<'_, C, N> {
    #[inline]
    fn step_row(&mut self) {
        self.rounding.step_row();
    }
}

impl<C: Pixel> PixelShader<(Colour, [u32; 3])> for Texels<'_, C> {
    type Pixel = C;

    #[inline]
    fn shade(&self, (texel, light): (Colour, [u32; 3])) -> C {
        self.colour(Self::reflected(light, texel))
    }

    const KERNEL: Option<[usize; 2]> = Self::fields(3);

    #[inline]
    fn lit(&self) -> Option<kernels::Lit<'_>> {
        self.kernel(0)
    }
}

impl<C: Pixel> PixelShader<(Colour, ([u32; 3], [u32; 3]))> for Texels<'_, C> {
    type Pixel = C;

    #[inline]
    fn shade(&self, (texel, (light, highlights)): (Colour, ([u32; 3], [u32; 3]))) -> C {
        self.colour(zip(Self::reflected(light, texel), highlights, |level, highlight| level.wrapping_add(highlight as i32)))
    }

    const KERNEL: Option<[usize; 2]> = Self::fields(6);

    #[inline]
    fn lit(&self) -> Option<kernels::Lit<'_>> {
        self.kernel(1)
    }
}

/// [`Texels`] under light without a hue, of which one level is walked: that of green. Rounding is that of red and blue, and of green.
type NeutralTexels<'f, C> = Texels<'f, C, 2>;

impl<C: Pixel> NeutralTexels<'_, C> {
    /// Whether the format has as many bits of red as of blue, and as many of green or one more.
    const EXISTS: bool = matches!(C::LEVELS, [red, green, blue] if red == blue && (green == red || green == 6 && red == 5));

    fn neutral(quarter: i32) -> Self {
        Self { rounding: Texels::<C>::new(quarter).rounding.map(|[red, green, _]| [red, green]), rows: None }
    }

    /// A level of red and blue by that of green. They are as 248 to 252 if green has 6 bits and they have 5: this is off by 2^-12.
    #[inline]
    fn outer(level: i32) -> i32 {
        let [red, green, _] = C::LEVELS;
        if red == green { level } else { level.wrapping_sub(level >> 6) }
    }

    /// The colour where a texel reflects this much light, as [`scaled`] quarters, and where these levels of highlights are added.
    #[inline]
    fn colour(&self, quarter: u32, highlight: u32, Colour { channels: [red, green, blue], .. }: Colour) -> C {
        let [more, more_green] = self.rounding.now();
        let (quarter, highlight) = (quarter as i32 >> (CHANNEL - 16), highlight as i32);
        let level = |channel: u8, quarter: i32, more: i32| quarter.wrapping_mul(channel.into()).wrapping_add(more);
        let (outer, more) = (Self::outer(quarter), more.wrapping_add(Self::outer(highlight)));
        C::mixed([level(red, outer, more), level(green, quarter, more_green.wrapping_add(highlight)), level(blue, outer, more)])
    }
}

impl<C: Pixel> PixelShader<(Colour, [u32; 1])> for NeutralTexels<'_, C> {
    type Pixel = C;

    #[inline]
    fn shade(&self, (texel, [light]): (Colour, [u32; 1])) -> C {
        self.colour(light, 0, texel)
    }

    const KERNEL: Option<[usize; 2]> = Self::fields(1);

    #[inline]
    fn lit(&self) -> Option<kernels::Lit<'_>> {
        self.kernel(0)
    }
}

impl<C: Pixel> PixelShader<(Colour, ([u32; 1], [u32; 1]))> for NeutralTexels<'_, C> {
    type Pixel = C;

    #[inline]
    fn shade(&self, (texel, ([light], [highlight])): (Colour, ([u32; 1], [u32; 1]))) -> C {
        self.colour(light, highlight, texel)
    }

    const KERNEL: Option<[usize; 2]> = Self::fields(2);

    #[inline]
    fn lit(&self) -> Option<kernels::Lit<'_>> {
        self.kernel(1)
    }
}

/// [`Texels`] in greys.
#[derive(Clone, Copy)]
struct GrayTexels<'f, C: Pixel>(Ramp<'f, C>);

impl<C: Pixel> GrayTexels<'_, C> {
    /// Whether tables of colours serve all pixels of a row alike.
    const EXISTS: bool = !C::Ramps::CHECKERED;

    /// The grey where a texel reflects this much light, as [`scaled`] quarters, and where these levels of highlights are added.
    #[inline]
    fn gray(&self, quarter: u32, highlight: u32, Colour { channels: [red, green, blue], .. }: Colour) -> C {
        // As by `Albedo::new`.
        let luma = 77 * u32::from(red) + 150 * u32::from(green) + 29 * u32::from(blue);
        let reflected = by_fraction(quarter as i32, luma as u16) as u32;
        let bias = bias(1 << (WALK - 1)) as u32;
        self.0.shade([(reflected << (WALK - CHANNEL + QUARTER)).wrapping_add(highlight << (WALK - CHANNEL)).wrapping_add(bias)])
    }
}

impl<C: Pixel> ByRows for GrayTexels<'_, C> {}

impl<C: Pixel> PixelShader<(Colour, [u32; 1])> for GrayTexels<'_, C> {
    type Pixel = C;

    #[inline]
    fn shade(&self, (texel, [light]): (Colour, [u32; 1])) -> C {
        self.gray(light, 0, texel)
    }
}

impl<C: Pixel> PixelShader<(Colour, ([u32; 1], [u32; 1]))> for GrayTexels<'_, C> {
    type Pixel = C;

    #[inline]
    fn shade(&self, (texel, ([light], [highlight])): (Colour, ([u32; 1], [u32; 1]))) -> C {
        self.gray(light, highlight, texel)
    }
}

/// A place in a texture, alone or with what is interpolated beside it.
pub trait AtPlace {
    /// The texel, and what is beside the place.
    type Texel;

    /// Takes the texel from `sampler`. The bits of the place stand where the sampler needs them if it is `aligned`.
    fn texel(self, sampler: &Sampler<'_>, aligned: bool) -> Self::Texel;

    /// The colour of a texel.
    fn colour(texel: &Self::Texel) -> Colour;
}

impl AtPlace for [u32; 2] {
    type Texel = Colour;

    #[inline]
    fn texel(self, sampler: &Sampler<'_>, aligned: bool) -> Colour {
        sampler.texel(if aligned { self } else { Sampler::aligned(self) })
    }

    #[inline]
    fn colour(texel: &Colour) -> Colour {
        *texel
    }
}

impl<V> AtPlace for ([u32; 2], V) {
    type Texel = (Colour, V);

    #[inline]
    fn texel(self, sampler: &Sampler<'_>, aligned: bool) -> (Colour, V) {
        let (place, light) = self;
        (place.texel(sampler, aligned), light)
    }

    #[inline]
    fn colour((texel, _): &(Colour, V)) -> Colour {
        *texel
    }
}

/// A place that is walked, see [`AtPlace`]. Where the texture has a hole, the surface covers no pixel.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'f, P, const ALIGNED: bool = false> {
    /// The place, and what is beside it. Its bits already stand where the sampler cuts the number of a texel from them, or are moved there at each pixel.
    pub place: P,
    /// The texture.
    pub sampler: &'f Sampler<'f>,
}

impl<'f, P: Patch<Walker: Walker<Value: AtPlace>>, const ALIGNED: bool> Patch for Placed<'f, P, ALIGNED> {
    type Walker = Placed<'f, P::Walker, ALIGNED>;

    #[inline(always)]
    fn jump(&mut self, rows: i32) {
        self.place.jump(rows);
    }

    #[inline]
    fn step_row(&mut self) {
        self.place.step_row();
    }

    #[inline(always)]
    fn enter(&self, x: i32) -> Self::Walker {
        Placed { place: self.place.enter(x), sampler: self.sampler }
    }

    const FIELDS: Option<[usize; 2]> = if ALIGNED { P::FIELDS } else { None };

    #[inline]
    fn lend<'a>(&'a mut self, fields: &mut kernels::Fields<'a>) {
        self.place.lend(fields);
    }
}

impl<W: Walker<Value: AtPlace>, const ALIGNED: bool> Walker for Placed<'_, W, ALIGNED> {
    type Value = <W::Value as AtPlace>::Texel;

    #[inline]
    fn step(&mut self) {
        self.place.step();
    }

    #[inline(always)]
    fn value(&self) -> Self::Value {
        self.place.value().texel(self.sampler, ALIGNED)
    }

    const HAS_HOLES: bool = TRANSPARENCY;

    #[inline]
    fn may_have_holes(&self) -> bool {
        TRANSPARENCY && self.sampler.has_holes
    }

    #[inline]
    fn covers(texel: &Self::Value) -> bool {
        !TRANSPARENCY || W::Value::colour(texel).hole == 0
    }
}

impl Patch for PlacePatch {
    type Walker = PlaceWalker;

    fn jump(&mut self, rows: i32) {
        match self {
            Self::OnScreen(patch) => patch.jump(rows),
            Self::InSpace(patch) => patch.jump(rows),
        }
    }

    fn step_row(&mut self) {
        match self {
            Self::OnScreen(patch) => patch.step_row(),
            Self::InSpace(patch) => patch.step_row(),
        }
    }

    fn enter(&self, x: i32) -> PlaceWalker {
        match self {
            Self::OnScreen(patch) => PlaceWalker::OnScreen(patch.enter(x)),
            Self::InSpace(patch) => PlaceWalker::InSpace(patch.enter(x)),
        }
    }
}

impl Walker for PlaceWalker {
    type Value = [u32; 2];

    #[inline]
    fn step(&mut self) {
        match self {
            Self::OnScreen(walker) => walker.step(),
            Self::InSpace(walker) => walker.step(),
        }
    }

    #[inline(always)]
    fn value(&self) -> [u32; 2] {
        match self {
            Self::OnScreen(walker) => walker.value(),
            Self::InSpace(walker) => walker.value(),
        }
    }
}

const _: () = assert!(LEVEL >= SIXTEENTH + 3, "a sixteenth of a level is rounded by at most 1/16 of one");
