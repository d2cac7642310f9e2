//! From fields that are walked per light to what each light sends, and on to a pixel.

use super::{Area, Facet, Shading};
#[cfg(feature = "all-shaders")]
use crate::poly::{Patch, PerLight, Walker};
use crate::{
    band::Band,
    dither::threshold,
    format::{COSINE, MAX_LIGHTS},
    math::power::PixelPower,
    palette::{Palette, Reflection},
    pixel::Pixel,
    poly::field::{EachLight, Field, Nodes},
    scene::{Source, cosine},
    shade::node::Node,
    tone::Tone,
};

/// Fraction bits of a field at a node; walked with [`COSINE`].
pub(super) const NODE: u32 = 24;
/// Fraction bits that a walked field has more.
pub(super) const EXTRA: u32 = COSINE - NODE;
/// Nodes of fields are in [-2, 2].
pub(super) const BITS: u32 = NODE + 2;

/// What a method makes of its fields at a pixel: `V` is walked for each light, `K` once for all of them.
pub(super) trait Form<K, V>: Copy {
    /// What is worked out once for all lights.
    type Common;

    /// Works it out.
    fn common(&self, common: K) -> Self::Common;

    /// What light number `light` sends.
    fn reflect(&self, light: usize, common: &Self::Common, fields: V, power: PixelPower<'_>) -> Reflection;
}

/// Any lights on any material.
#[derive(Clone, Copy)]
pub(super) struct Lit<'a, C, F> {
    palette: &'a Palette<C>,
    form: F,
    dither: bool,
    row: usize,
}

impl<C: Pixel, K, V: Copy, F: Form<K, V>> Tone<(heapless::Vec<V, MAX_LIGHTS>, K)> for Lit<'_, C, F> {
    type Pixel = C;

    fn tone(&self, (lights, common): (heapless::Vec<V, MAX_LIGHTS>, K), x: usize) -> C {
        let (power, common) = (self.palette.power.pixel(), self.form.common(common));
        let reflections = lights.iter().enumerate().map(|(light, &fields)| self.form.reflect(light, &common, fields, power));
        let levels = self.palette.pixel_levels(reflections);
        if self.dither { self.palette.dithered(levels, threshold(x, self.row)) } else { self.palette.colour(levels) }
    }

    fn start(&mut self, row: i32) {
        self.row = row as usize;
    }

    #[inline(always)]
    fn step_row(&mut self) {
        self.row += 1;
    }
}

impl<C: Pixel> Shading<'_, C> {
    /// The tone for any lights.
    fn lit<F>(&self, form: F) -> Lit<'_, C, F> {
        Lit { palette: self.palette, form, dither: self.dither, row: 0 }
    }

    /// Draws `common` and the field `of` each light, by `form`.
    pub(super) fn draw_lit<K, V, F>(&self, facet: &Facet<'_>, of: impl Fn(&Source) -> V, common: K, form: F, band: &mut Band<'_, C>) -> u32
    where
        K: Field,
        V: Field<Value: Copy>,
        F: Form<K::Value, V::Value>,
    {
        facet.draw(|| (EachLight { sources: &self.lighting.sources, of }, common), self.lit(form), band)
    }

    /// [`Self::draw_lit`] for what knows nothing but its rows on the screen.
    #[cfg(feature = "all-shaders")]
    pub(super) fn draw_rows<K, P, F>(
        &self,
        facet: &Facet<'_>,
        (zero, fit): (P, impl Fn(&Source) -> P),
        common: K,
        form: F,
        band: &mut Band<'_, C>,
    ) -> u32
    where
        K: Patch,
        P: Patch<Walker: Walker<Value: Copy> + Copy>,
        F: Form<<K::Walker as Walker>::Value, <P::Walker as Walker>::Value>,
    {
        let lights = PerLight::new(&self.lighting.sources, zero, fit);
        facet.outline.draw(facet.basis, (lights, common), self.lit(form), band)
    }

    /// The quadratics through N·L and N·H of a light at six nodes; `map` is applied to both.
    pub(super) fn six_products(&self, nodes: &[Node; 6], source: &Source, map: impl Fn([i32; 2]) -> [i32; 2]) -> Quadratic<2> {
        let values = nodes.map(|node| map(self.lighting.directions(source, node.position).map(|direction| cosine(node.normal, direction))));
        quadratic([values.map(|[light, _]| light), values.map(|[_, half]| half)])
    }
}

/// A field through three nodes.
#[cfg(feature = "all-shaders")]
pub(super) type Linear<const CH: usize> = Nodes<3, CH, BITS>;
/// A field through six nodes.
pub(super) type Quadratic<const CH: usize> = Nodes<6, CH, BITS>;

/// The quadratics through six nodes in Q2.30.
#[inline]
pub(super) fn quadratic<const CH: usize>(nodes: [[i32; 6]; CH]) -> Quadratic<CH> {
    Nodes::new(rounded(nodes), EXTRA)
}

/// The planes through three nodes in Q2.30.
#[cfg(feature = "all-shaders")]
#[inline]
pub(super) fn linear<const CH: usize>(nodes: [[i32; 3]; CH]) -> Linear<CH> {
    Nodes::new(rounded(nodes), EXTRA)
}

/// From Q2.30 to [`NODE`] fraction bits.
#[inline(always)]
fn rounded<const N: usize, const CH: usize>(nodes: [[i32; N]; CH]) -> [[i32; N]; CH] {
    nodes.map(|nodes| nodes.map(|node| (node + (1 << (EXTRA - 1))) >> EXTRA))
}

/// A walked field in Q2.30, signed.
#[inline(always)]
pub(super) fn signed(field: u32) -> i32 {
    field as i32
}
