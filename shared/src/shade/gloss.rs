//! One constant light on a material of one channel, by whatever a method walks: no loop over lights, no channels, no dither.

use super::{Area, Facet, Shading, form::Form};
use crate::{band::Band, palette::Glossy, pixel::Pixel, poly::field::Field, scene::Source, tone::Tone};

/// The tone's, see [`Tone::MARK`].
pub(super) const MARK: u8 = 3;

/// A form under one light on a material of one channel.
#[derive(Clone, Copy)]
pub(super) struct Gloss<'a, C, F> {
    glossy: Glossy<'a, C>,
    form: F,
}

impl<C: Pixel, K, V, F: Form<K, V>> Tone<(V, K)> for Gloss<'_, C, F> {
    type Pixel = C;

    const CHEAP: bool = true;

    const MARK: u8 = MARK;

    #[inline(always)]
    fn tone(&self, (fields, common): (V, K), _: usize) -> C {
        self.glossy.colour(self.form.reflect(0, &self.form.common(common), fields, self.glossy.power))
    }
}

impl<C: Pixel> Shading<'_, C> {
    /// The tone for one constant light on a material of one channel without dither, if that is all there is.
    pub(super) fn gloss<F>(&self, form: F) -> Option<Gloss<'_, C, F>> {
        let one = self.constant.is_some() && !self.dither && !self.palette.three_channels;
        let glossy = if one { self.palette.glossy() } else { None };
        glossy.map(|glossy| Gloss { glossy, form })
    }

    /// [`Shading::draw_lit`], in the fast way where there is one.
    pub(super) fn draw_reflected<K, V, F>(
        &self,
        facet: &Facet<'_>,
        of: impl Fn(&Source) -> V,
        common: K,
        form: F,
        band: &mut Band<'_, C>,
    ) -> u32
    where
        K: Field,
        V: Field<Value: Copy>,
        F: Form<K::Value, V::Value>,
    {
        match (self.gloss(form), self.lighting.sources.first()) {
            (Some(gloss), Some(source)) => facet.draw(|| (of(source), common), gloss, band),
            _ => self.draw_lit(facet, of, common, form, band),
        }
    }
}
