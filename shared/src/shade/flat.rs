//! Flat shading: one colour per triangle, lit at its centroid with the plane's normal.
//!
//! Cost: nothing per pixel; one evaluation of the lights per triangle. Not continuous across edges.

#[cfg(feature = "fast-loops")]
use super::Method;
use super::{Facet, RANGE, Shading, node::Node};
use crate::{
    band::Band,
    format::UNIT,
    math::vector::{add, wide},
    pixel::Pixel,
    poly::Constant,
    tone::Solid,
};

#[inline(never)]
pub(super) fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> u32 {
    let normal = wide(facet.triangle.normal);
    let palette = shading.palette;
    let colour = match &shading.directions {
        Some([towards, half]) if !palette.three_channels && !shading.dither => {
            palette.tint(palette.level([towards.cosine(normal), half.cosine(normal)]))
        }
        directions => {
            let levels = match directions {
                Some([towards, half]) => palette.one_light([towards.cosine(normal), half.cosine(normal)]),
                None => shading.levels(&centroid(facet, normal)),
            };
            if shading.dither {
                // A field without slope: dither changes from pixel to pixel all the same.
                return shading.draw_levels::<3, RANGE>(facet, || [levels; 3], band);
            }
            palette.colour(levels)
        }
    };
    facet.fill(Constant, Solid(colour), band)
}

/// Under one light, on one channel.
#[cfg(feature = "fast-loops")]
pub(crate) struct Plain;

#[cfg(feature = "fast-loops")]
impl Method for Plain {
    #[inline(always)]
    fn draw<C: Pixel>(facet: &Facet<'_>, shading: &Shading<'_, C>, band: &mut Band<'_, C>) -> Option<u32> {
        let normal = wide(facet.triangle.normal);
        let [towards, half] = shading.directions.as_ref()?;
        let level = shading.palette.level([towards.cosine(normal), half.cosine(normal)]);
        Some(facet.fill(Constant, Solid(shading.palette.tint(level)), band))
    }
}

/// The triangle's centroid, and the `normal` of its plane (Q2.14).
fn centroid(facet: &Facet<'_>, normal: [i32; 3]) -> Node {
    let [a, b, c] = facet.vertices();
    let sum = add(wide(a.position), add(wide(b.position), wide(c.position)));
    Node { position: sum.map(|c| c / 3), normal: normal.map(|c| c << (30 - UNIT)) }
}
