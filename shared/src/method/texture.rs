//! Triangles whose colours a texture has.
//!
//! The place in the texture is linear over a triangle in space. On the screen it is interpolated by a plane or a quadratic where that is off by at most a
//! quarter of a texel, and otherwise from the point that is seen at each pixel. A pixel takes the nearest texel.
//!
//! Ambient and diffuse light is multiplied by the texel, and highlights are added. So methods that interpolate levels interpolate both apart.
//!
//! Cost: about 60 instructions a pixel more than the general loop takes without.

use crate::{
    features::{PERSPECTIVE, TEXTURES},
    format::{BIAS, FULL, INTENSITY, Intensity, LEVEL, WALK},
    interpolate::{
        Patch, Walker,
        field::{Field, Nodes},
        perspective::PerspectivePatch,
        quadric::Quadric,
    },
    lighting::{
        albedo::{Albedo, Parts, SHARE},
        sampler::{FINER, Sampler, Textured},
    },
    math::vector::{map, zip},
    method::{
        EXTRA, IntensityShader, LinearWay, Middles, RANGE, TriangleSetup, bias, channels,
        node::mixed,
        perspective,
        products::{LinearNodes, fitted, linear, quadratic},
    },
    raster::canvas::{Canvas, Shaded},
};

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

/// The largest error of a place on the screen: a quarter of a texel, in the unit of [`Sampler::range`].
const MOST: u32 = 2;

impl TriangleSetup<'_> {
    /// Whether the triangle has a texture.
    #[inline(always)]
    pub(crate) fn has_texture(&self) -> bool {
        TEXTURES && self.texture.first().is_some_and(Option::is_some)
    }

    /// The texture of the triangle and the place in it, if it has one.
    #[doc(hidden)]
    #[inline]
    #[must_use]
    pub fn texture_patch(&self) -> Option<(&Sampler<'_>, PlacePatch)> {
        let texture = self.texture.first()?.as_ref()?;
        Some((texture.sampler, self.place_patch(texture)))
    }

    /// The place in a texture over the triangle.
    #[inline(never)]
    fn place_patch(&self, Textured { sampler, places, in_perspective }: &Textured<'_>) -> PlacePatch {
        let [[u0, v0], [u1, v1], [u2, v2]] = map(*places, |place| place.map(|c| c << FINER));
        let inv_depth = self.corners.map(|corner| corner.depth);
        let way = if *in_perspective { perspective::linear_way(inv_depth, sampler.range(places), MOST) } else { LinearWay::Plane };
        let shares = match way {
            LinearWay::Plane => Middles::IN_SPACE.shares(),
            LinearWay::Quadratic(shares) => shares,
            LinearWay::InSpace => {
                let surface = linear([[u0, u1, u2], [v0, v1, v2]]).surface();
                return PlacePatch::InSpace(PerspectivePatch::new(self.gradients, inv_depth, surface));
            }
        };
        let [ab, bc, ca] = shares;
        let six = |a, b, c| [a, b, c, mixed(a, b, ab), mixed(b, c, bc), mixed(c, a, ca)];
        PlacePatch::OnScreen(fitted(&quadratic([six(u0, u1, u2), six(v0, v1, v2)]), self.gradients))
    }

    /// Draws the triangle, whose light is `field`, by `shader` with the texture. Returns the number of pixels drawn; `None` if it has no texture.
    pub(crate) fn draw_textured<F: Field, S>(&self, field: &F, shader: S, canvas: &mut dyn Canvas) -> Option<u32>
    where
        for<'s> OnTexture<'s, S>: IntensityShader<(F::Value, [u32; 2])>,
    {
        let (sampler, place) = self.texture_patch()?;
        let shader = OnTexture { sampler, shader };
        if PERSPECTIVE && let Some(inv_depth) = self.inv_depth() {
            let patch = PerspectivePatch::new(self.gradients, inv_depth, field.surface());
            return Some(self.draw_spans(&mut Shaded::new((patch, place), shader), canvas));
        }
        Some(self.draw_spans(&mut Shaded::new((field.fit(self.gradients), place), shader), canvas))
    }

    /// Draws the triangle by its texture, with the light of `parts` at its nodes. Returns the number of pixels drawn; 0 if it has no texture.
    pub(crate) fn draw_parts<const N: usize>(&self, parts: [Parts; N], canvas: &mut dyn Canvas) -> u32
    where
        Nodes<N, 3, RANGE>: Field<Value = [u32; 3]>,
    {
        let nodes = |levels: [[i32; 3]; N]| Nodes::<N, 3, RANGE>::new(channels(levels), EXTRA).biased([bias(0); 3]);
        let field = (nodes(parts.map(|parts| quarters(parts.diffuse))), nodes(parts.map(|parts| quarters(parts.specular))));
        self.draw_textured(&field, Apart, canvas).unwrap_or(0)
    }
}

/// A quarter of a level is walked, because dark texels show more than 255 of ambient and diffuse light, and a quadratic goes beyond its nodes.
const QUARTER: u32 = 2;

/// A quarter of these levels, as far as they are no more than four times full intensity.
fn quarters(levels: [i32; 3]) -> [i32; 3] {
    map(levels, |level| ((level + (1 << (QUARTER - 1))) >> QUARTER).min(FULL))
}

/// A walked quarter as an intensity, which may be beyond black and white.
fn whole(quarter: u32) -> i32 {
    ((quarter >> (WALK - INTENSITY - QUARTER)) as i32) - (BIAS << (INTENSITY + QUARTER))
}

/// Colours the light of another shader by a texture.
#[derive(Clone, Copy, Debug)]
pub struct OnTexture<'f, S> {
    /// The texture.
    pub sampler: &'f Sampler<'f>,
    /// The shader of the light.
    pub shader: S,
}

/// Interpolated quarters of levels: of ambient and diffuse light, and of highlights.
pub(crate) struct Apart;

impl Albedo {
    /// What a surface of this colour reflects of an intensity that is less than 2^18.
    fn reflected(self, light: Intensity) -> Intensity {
        zip(light, self.shares(), |light, share| ((i64::from(light) * i64::from(share) + (1 << (SHARE - 1))) >> SHARE) as i32)
    }
}

/// All light is coloured: methods that do not tell highlights apart show them in the colour of the surface.
impl<V, S: IntensityShader<V>> IntensityShader<(V, [u32; 2])> for OnTexture<'_, S> {
    fn shade(&self, (value, place): (V, [u32; 2])) -> Intensity {
        // No more than full intensity, as without a texture.
        self.sampler.at(place).reflected(map(self.shader.shade(value), |light| light.min(FULL << (INTENSITY - LEVEL))))
    }
}

impl IntensityShader<(([u32; 3], [u32; 3]), [u32; 2])> for OnTexture<'_, Apart> {
    fn shade(&self, ((light, highlights), place): (([u32; 3], [u32; 3]), [u32; 2])) -> Intensity {
        let reflected = self.sampler.at(place).reflected(map(light, whole));
        zip(reflected, map(highlights, whole), |reflected, highlight| (reflected + highlight).clamp(0, i32::from(u16::MAX)))
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

    #[inline(always)]
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

const _: () = assert!(LEVEL >= QUARTER + 4, "a quarter of a level is rounded by at most 1/32 of one");
