//! The six-point quadratic through N·L and through a root of N·H; squared and raised to the exponent at the pixel.
//!
//! Near a highlight's centre N·H is nearly quadratic in the angle, and its root more nearly so over the whole
//! triangle: fitting sqrt(N·H) instead of N·H leaves 1.5 to 6 times less error for the same cost. Below 1/4, where
//! the root would grow steep, a line of the same slope goes on.
//!
//! Cost: 4 additions a pixel and light and the highlight's table, which also squares; 12 cosines to set up. Triangles
//! without a highlight under one constant light cost as much as by [`super::six_point`]. Continuous.
//! Error against Phong: 2.4 LSB at worst on a sphere of 168 triangles, 0.2 on one of 690 (exponent 50, ks 1/2).
//! Domain: any lights; coarse triangles near a light need splitting.

use super::{
    Area, Facet, Method, RANGE, Shading,
    form::{BITS, EXTRA, Form, quadratic, signed},
    gloss,
    node::map_six,
};
use crate::{
    band::Band,
    format::{LEVEL, WALK},
    math::{power::PixelPower, rsqrt::sqrt, steps::Defects},
    palette::{Levels, Reflection},
    pixel::Pixel,
    poly::{Constant, field::Nodes},
    tone::{Ramp, Tone},
};

/// One, Q2.30.
const ONE: i32 = 1 << 30;
/// Below this cosine the root is continued by a line.
const LOWEST: i32 = ONE / 4;

#[inline(never)]
pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    if shading.is_plain()
        && let Some(pixels) = Plain::draw(facet, shading, band)
    {
        return pixels;
    }
    let nodes = facet.six_nodes();
    let fit = |source: &_| shading.six_products(&nodes, source, |[light, half]| [light, root(half)]);
    shading.draw_lit(facet, fit, Constant, Squared, band)
}

/// Under one light, on one channel.
pub(crate) struct Plain;

impl Method for Plain {
    #[inline(always)]
    fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> Option<u32> {
        let (palette, mark) = (shading.palette, facet.mark(band));
        let levels = shading.one_light().filter(Levels::is_within);
        // What was handed on has been decided, and needs no nodes.
        let cosines = if mark.is_none() { facet.six_cosines(0) } else { [0; 6] };
        let mark = mark.unwrap_or_else(|| match (facet.is_dark(palette), Lit::of(cosines)) {
            (true, Lit::Everywhere | Lit::Nowhere) => Ramp::<C>::MARK,
            (true, Lit::Partly) if levels.is_some() => Clamped::<C>::MARK,
            (_, Lit::Everywhere) if levels.is_some() => Defective::<C>::MARK,
            _ => gloss::MARK,
        });
        if mark == Ramp::<C>::MARK {
            return Some(shading.draw_plain::<6, RANGE>(facet, || palette.six_matte(cosines), band));
        }
        let roots = || map_six(facet.six_cosines(1), root);
        let defects = Defects::new(&palette.power);
        let light =
            |levels: Levels<'_, C>| Nodes::<6, 1, RANGE>::new([map_six(cosines, |cosine| levels.node(cosine, LEVEL))], WALK - LEVEL);
        if mark == Clamped::<C>::MARK {
            let levels = levels?;
            return Some(facet.draw(|| light(levels), Clamped { levels, floor: palette.power.least() }, band));
        }
        if mark == Defective::<C>::MARK {
            let levels = levels?;
            let field = || {
                let light = light(levels);
                let half = Nodes::<6, 1, BITS>::new([map_six(roots(), |root| defects.node(root))], EXTRA).raised([defects.half()]);
                (light, half)
            };
            return Some(facet.draw(field, Defective { levels, defects }, band));
        }
        let gloss = shading.gloss(Squared)?;
        Some(facet.draw(|| ((quadratic([cosines]), quadratic([roots()])), Constant), gloss, band))
    }
}

/// Level and what the root of N·H lacks of 1.
#[derive(Clone, Copy)]
struct Defective<'a, C> {
    levels: Levels<'a, C>,
    defects: Defects<'a>,
}

impl<C: Pixel> Tone<([u32; 1], [u32; 1])> for Defective<'_, C> {
    type Pixel = C;

    const CHEAP: bool = true;

    const MARK: u8 = 2;

    #[inline(always)]
    fn tone(&self, ([light], [defect]): ([u32; 1], [u32; 1]), _: usize) -> C {
        self.levels.colour::<WALK>(light, self.defects.at(signed(defect)))
    }
}

/// Level of diffuse light, negative where there is none.
#[derive(Clone, Copy)]
struct Clamped<'a, C> {
    levels: Levels<'a, C>,
    /// The highlight's entry.
    floor: u32,
}

impl<C: Pixel> Tone<[u32; 1]> for Clamped<'_, C> {
    type Pixel = C;

    const CHEAP: bool = true;

    const MARK: u8 = 1;

    #[inline(always)]
    fn tone(&self, [light]: [u32; 1], _: usize) -> C {
        self.levels.colour::<WALK>(signed(light).max(0) as u32, self.floor)
    }
}

/// Where the quadratic through N·L is positive.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Lit {
    Everywhere,
    Nowhere,
    Partly,
    /// Partly, and nodes differ by more than 1, levels by more than [`RANGE`], or it may leave [-1, 1], where levels would wrap.
    Steeply,
}

impl Lit {
    /// By its nodes: it leaves the middle of their range by at most 5/3 of half the range (its Lebesgue constant). Unless it changes its
    /// sign the level may be fitted instead of the cosine, which is not clamped.
    #[inline(always)]
    fn of([a, b, c, ab, bc, ca]: [i32; 6]) -> Self {
        let (least, most) = (a.min(b).min(c).min(ab).min(bc).min(ca), a.max(b).max(c).max(ab).max(bc).max(ca));
        if least > 0 && least >= most >> 2 {
            Self::Everywhere
        } else if most < 0 && most <= least >> 2 {
            Self::Nowhere
        } else if most.saturating_sub(least) <= ONE && (most - (least >> 2)).max((most >> 2).saturating_sub(least)) <= 3 * (ONE / 4) {
            Self::Partly
        } else {
            Self::Steeply
        }
    }
}

/// sqrt(w) for w >= 1/4, w + 1/4 below: of one slope where they meet. Q2.30.
fn root(w: i32) -> i32 {
    if w < LOWEST {
        return w + LOWEST;
    }
    sqrt(w.min(ONE - 1))
}

/// The inverse of [`root`] at the pixel.
#[derive(Clone, Copy)]
struct Squared;

impl Form<(), [u32; 2]> for Squared {
    type Common = ();

    #[inline(always)]
    fn common(&self, (): ()) {}

    #[inline(always)]
    fn reflect(&self, _: usize, (): &(), [light, half]: [u32; 2], power: PixelPower<'_>) -> Reflection {
        // The table squares.
        Reflection { diffuse: signed(light) >> 3, highlight: power.at(signed(half) >> 3) }
    }
}

impl Form<(), ([u32; 1], [u32; 1])> for Squared {
    type Common = ();

    #[inline(always)]
    fn common(&self, (): ()) {}

    #[inline(always)]
    fn reflect(&self, light: usize, (): &(), ([l], [h]): ([u32; 1], [u32; 1]), power: PixelPower<'_>) -> Reflection {
        self.reflect(light, &(), [l, h], power)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2_000))]
        #[test]
        fn quadratics_are_where_their_nodes_say(
            centre in -1.0f64..1.0,
            spread in prop_oneof![0.0f64..0.5, 0.0f64..1.0],
            parts in prop::array::uniform6(prop_oneof![Just(-1.0f64), Just(1.0), -1.0f64..1.0]),
        ) {
            let nodes = parts.map(|part| ((centre + part * spread).clamp(-1.0, 1.0) * f64::from(ONE)) as i32);
            let lit = Lit::of(nodes);
            for (s, t) in (0..=20).flat_map(|s| (0..=20 - s).map(move |t| (f64::from(s) / 20.0, f64::from(t) / 20.0))) {
                let b = [1.0 - s - t, s, t];
                let n = nodes.map(|node| f64::from(node) / f64::from(ONE));
                let value = (0..3).map(|k| b[k] * (2.0 * b[k] - 1.0) * n[k]).sum::<f64>()
                    + 4.0 * (b[0] * b[1] * n[3] + b[1] * b[2] * n[4] + b[2] * b[0] * n[5]);
                let holds = match lit {
                    Lit::Everywhere => value > 0.0,
                    Lit::Nowhere => value < 0.0,
                    Lit::Partly => value.abs() <= 1.0,
                    Lit::Steeply => true,
                };
                prop_assert!(holds, "{nodes:?} at {s} {t}: {value}");
            }
        }
    }
}
