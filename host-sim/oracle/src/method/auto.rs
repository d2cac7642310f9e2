//! The method `auto`: one of five ways, whichever stays within an error budget.

use super::{Decide, gouraud, six_point, sqrt6};
use crate::{
    Facet, Frame, Shade,
    frame::SurfacePoint,
    light::{highlight, phong},
    texture::painted,
};
use microphong_render::choices::{Chosen, Way};

/// An excess that is close to its threshold at every margin but 0.
const CLOSE: f64 = -f64::MIN_POSITIVE;

/// Shades as `auto`. The choice follows from bounds that only the core knows. The first result is Phong shading, and each of the five ways counts as
/// a decision that may fall either way, so arithmetic is compared with all of them.
pub(super) fn shade<'f, const QUADRATICS: bool>(frame: &'f Frame, facet: &'f Facet, decide: &'f Decide<'f>) -> Shade<'f> {
    if !decide(CLOSE) {
        return phong(frame, facet);
    }
    match (decide(CLOSE), decide(CLOSE)) {
        (false, false) => gouraud::shade(frame, facet),
        (false, true) if !QUADRATICS => phong(frame, facet),
        (false, true) if decide(CLOSE) => sqrt6::by_cosines(frame, facet),
        (false, true) => six_point::shade(frame, facet),
        (true, by_light) => solid(frame, facet, by_light),
    }
}

/// Shades a facet for which the choice is known.
#[must_use]
pub fn chosen<'f>(frame: &'f Frame, facet: &'f Facet, Chosen { way, raises }: Chosen) -> Shade<'f> {
    if let Some(texture) = &facet.texture {
        return painted(facet, texture, move |facet, p| chosen(frame, facet, Chosen { way, raises })(p));
    }
    let shade = match way {
        // Under one light in three channels, or on a surface with colours, the core has no levels at the corners, but a cosine and a highlight. The light
        // of a sky it has as a level.
        Way::OneColour => {
            let one = frame.is_constant() && frame.lights.len() == 1 && frame.lights.iter().all(|light| !light.is_sky);
            solid(frame, facet, one && (facet.albedos.is_some() || frame.only_channel(facet).is_none()))
        }
        Way::Linear => gouraud::shade(frame, facet),
        Way::Quadratic => six_point::shade(frame, facet),
        Way::Cosines => sqrt6::by_cosines(frame, facet),
        Way::Phong => phong(frame, facet),
    };
    if raises == [0.0; 3] {
        return shade;
    }
    Box::new(move |p| {
        let levels = shade(p);
        [0, 1, 2].map(|k| (levels[k] + raises[k]).clamp(0.0, 255.0))
    })
}

/// One colour: `by_light` from the means of the extremes of cosine, highlight and albedo at the corners, otherwise from the means of the extremes of
/// the corners' levels.
fn solid<'f>(frame: &'f Frame, facet: &'f Facet, by_light: bool) -> Shade<'f> {
    let middle = |values: [f64; 3]| {
        let [least, most] = [f64::min, f64::max].map(|extreme| values.into_iter().reduce(extreme).unwrap_or(0.0));
        0.5 * (least + most)
    };
    let levels = if by_light {
        let exponent = frame.material(facet).exponent;
        let reflected = frame.lights.iter().map(|light| {
            let cosines = Facet::CORNERS.map(|corner| frame.cosines(light, facet.position(corner), facet.node(corner)));
            [middle(cosines.map(|[diffuse, _]| diffuse.max(0.0))), middle(cosines.map(|[_, half]| highlight(half, exponent)))]
        });
        let [a, b, c] = Facet::CORNERS.map(|corner| facet.albedo(corner));
        let albedo = [0, 1, 2].map(|k| middle([a[k], b[k], c[k]]));
        frame.levels(facet, SurfacePoint { albedo, ..facet.point(Facet::CENTRE) }, reflected)
    } else {
        let [a, b, c] = Facet::CORNERS.map(|corner| frame.node(facet, corner));
        [0, 1, 2].map(|k| middle([a[k], b[k], c[k]]))
    };
    Box::new(move |_| levels)
}
