//! What range and cone leave of a light at each pixel of a triangle.
//!
//! The squared distance of the light is exactly quadratic over a triangle, and the product of the way to it and the axis of its cone is linear. Both
//! are walked as one field of two channels. So what is left is exact at each pixel, except by `sqrt6` in perspective, which takes positions linearly on
//! the screen.
//!
//! Cost: 4 additions and 3 products a pixel; in a cone a root and 4 products more. Error: the squared distance errs by 2^-24 of that of the farthest
//! corner, which counts where a triangle is much larger than the range: 2^-14 of d²/R² where it is 32 times as large. In a
//! cone the cosine errs by 2^-25 q², where q is the distance of the farthest corner over that of the pixel. Where light is so steep a function of them
//! that their walking would show, their coefficients have more bits.

use crate::{
    format::{COSINE, PIXEL_COSINE},
    interpolate::{
        Patch, Walker,
        field::Field,
        perspective::{Point, Surface},
        wide_quadric::WideQuadric,
    },
    lighting::{
        lights::{Source, point},
        reflectance::Reflection,
        shape::{Nearness, Shape},
    },
    math::{
        rsqrt::Root,
        vector::{dot, map, over_longest, sub},
    },
    method::{
        node::{FRACTION, coefficients, field_product},
        products::{QuadraticNodes, quadratic, signed},
    },
    setup::{gradients::Gradients, steepness::Steepness},
    stream::record::Vertex,
};

/// The squared distance of a light, where the farthest corner has the distance 1, and the product of the way from the light and the axis of its cone;
/// and how steeply light depends on them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    nodes: QuadraticNodes<2>,
    steepness: Steepness,
}

impl Field for Way {
    type Patch = WideQuadric<2>;

    fn fit(&self, gradients: &Gradients) -> WideQuadric<2> {
        WideQuadric::fit(&gradients.steep(gradients.steepness().max(self.steepness)), &self.nodes)
    }
}

impl Surface for Way {
    type Value = [u32; 2];

    #[inline(always)]
    fn at(&self, point: &Point) -> [u32; 2] {
        self.nodes.at(point)
    }
}

/// How a light changes over a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Change<'f, P> {
    /// The light is equally strong everywhere.
    None,
    /// No light arrives.
    Dark,
    /// The light comes from the sky.
    Sky,
    /// The light is weaker by range and cone.
    Weaker(P, &'f Shape, Nearness),
}

impl<'f> Change<'f, Way> {
    /// How the light of `source` changes over a triangle between these vertices.
    #[inline(never)]
    pub(crate) fn of(source: &'f Source, vertices: [&Vertex; 3]) -> Self {
        let (Some((shape, axis)), Some(position)) = (source.shape(), source.point()) else {
            return if source.is_sky() { Self::Sky } else { Self::None };
        };
        let half = |vertex: &Vertex| map(sub(position, point(vertex.position)), |c| c >> 1);
        let ways = map(vertices, half);
        let square = ways.iter().fold(0, |longest, &way| longest.max(dot(way, way) as u64));
        let nearness = shape.nearness(square);
        let ways = over_longest::<FRACTION>(ways);
        let squares = field_product(&ways, &ways);
        let least = coefficients(squares).into_iter().fold(i32::MAX, i32::min);
        let least = least.max(0) as u32;
        if shape.weaker(nearness.part(least), || 1 << COSINE) == 0 {
            return Self::Dark;
        }
        let [a, b, c] = map(ways, |way| -((dot(axis, way) >> FRACTION) as i32));
        let middle = |a: i32, b: i32| (a >> 1) + (b >> 1);
        let along = [a, b, c, middle(a, b), middle(b, c), middle(c, a)];
        let steepness = Steepness::of_slope(shape.slope(nearness, least));
        Self::Weaker(Way { nodes: quadratic([squares, along]), steepness }, shape, nearness)
    }
}

impl<'f, P> Change<'f, P> {
    /// A change with another form of what is walked.
    pub(crate) fn map<Q>(self, f: impl FnOnce(P) -> Q) -> Change<'f, Q> {
        match self {
            Self::None => Change::None,
            Self::Dark => Change::Dark,
            Self::Sky => Change::Sky,
            Self::Weaker(way, shape, nearness) => Change::Weaker(f(way), shape, nearness),
        }
    }

    /// The walked part, to be changed.
    pub(crate) fn way(&mut self) -> Option<&mut P> {
        if let Self::Weaker(way, ..) = self { Some(way) } else { None }
    }
}

impl<'f, P: Patch> Change<'f, P> {
    /// A walker that `enter` makes of the polynomials.
    pub(crate) fn enter(&self, enter: impl FnOnce(&P) -> P::Walker) -> Change<'f, P::Walker> {
        match self {
            Self::None => Change::None,
            Self::Dark => Change::Dark,
            Self::Sky => Change::Sky,
            Self::Weaker(way, shape, nearness) => Change::Weaker(enter(way), shape, *nearness),
        }
    }
}

impl<W: Walker<Value = [u32; 2]>> Change<'_, W> {
    /// Moves to the next pixel.
    #[inline(always)]
    pub(crate) fn step(&mut self) {
        if let Self::Weaker(way, ..) = self {
            way.step();
        }
    }

    /// What the surface reflects at the pixel. `reflection` is what it would reflect of the light at full strength. The table of highlights holds
    /// `floor` where there is no highlight.
    #[inline(always)]
    pub(crate) fn applied(&self, reflection: Reflection, floor: u32) -> Reflection {
        match self {
            Self::None | Self::Dark => reflection,
            Self::Sky => reflection.of_sky(),
            Self::Weaker(way, shape, nearness) => {
                // Approximations above 1 count as 1 before the light is weaker, not afterwards.
                let diffuse = reflection.diffuse.min(1 << PIXEL_COSINE);
                Reflection { diffuse, ..reflection }.weakened(strength(way.value(), shape, *nearness), floor)
            }
        }
    }
}

/// What is left of the light at a pixel.
fn strength([square, along]: [u32; 2], shape: &Shape, nearness: Nearness) -> u32 {
    let square = signed(square).max(0) as u32;
    shape.weaker(nearness.part(square), || Root::of(square).divide(signed(along)))
}
