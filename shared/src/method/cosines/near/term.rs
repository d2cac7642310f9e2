//! Near lights, and highlights that a near viewer sees, as terms that are added to the sum of other lights at each pixel.
//!
//! The highlight of a term is that of [`super::products`]. If the light and the viewer are both near, F is the vector to the viewer, so that N·F, F·P
//! and |F|² are quadratics.
//!
//! Cost: for a near light two quadratics, a root and seven products; for its highlight two quadratics, a root and four products more, and if the viewer
//! is near a quadratic, a root and two products; for range and cone three products each. Error: that of [`super`] for each light; range and cone err by
//! less than 2^-13 of full light.

use super::{
    HALF, STEEPEST,
    products::{Products, along, half, is_before, is_visible, least, ways},
    squared,
};
use crate::{
    arch::product::upper,
    format::{COSINE, MAX_LIGHTS, PIXEL_COSINE},
    interpolate::{Patch, Walker, plane::Plane, quadric::Quadric},
    lighting::{
        constant_lights::FACTOR,
        lights::{Source, Viewer},
        reflectance::Factors,
        shape::CoarseShape,
    },
    math::{highlight_lut::CosineLookup, rsqrt::HalfRsqrt, vector::map},
    method::{
        Shading, TriangleSetup,
        node::{coefficients, farthest, field_product},
        products::{fitted, linear, quadratic, signed},
    },
};
use core::cell::Cell;

/// What is added at each pixel: diffuse light and a highlight, times factors for each channel.
pub(in crate::method::cosines) struct NearTerm {
    /// |P|² and N·P.
    quadratics: Cell<(Quadric<1>, Quadric<1>)>,
    /// N·F, F·P and |F|²: the first two are unused without a highlight, the last one if F is a direction.
    other: Cell<(Quadric<1>, Quadric<1>, Quadric<1>)>,
    /// The product of the axis of the cone and the way from the light; unused without a cone.
    along: Cell<Plane<1>>,
    /// The range and the cone of the light.
    shape: Option<CoarseShape>,
    /// The factors; diffuse ones are 0 where the light is in the sum.
    factors: Factors,
    has_highlight: bool,
    /// Whether F is the vector to the viewer, where P is that to the light.
    are_both_near: bool,
}

/// Room for a term of each light.
pub(in crate::method::cosines) type NearTerms = heapless::Vec<NearTerm, MAX_LIGHTS>;

/// Adds the terms of a triangle: near lights, and highlights that a near viewer sees. `None` if loops cannot draw one of them.
#[inline(never)]
pub(in crate::method::cosines) fn add(terms: &mut NearTerms, setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> Option<()> {
    let Shading { reflectance, lighting, .. } = shading;
    for (light, source) in lighting.sources().iter().enumerate() {
        // The highlight alone is seen by a near viewer; there is none of the sky.
        if source.point().is_none() && (source.is_sky() || !matches!(lighting.viewer(), Viewer::Local(_))) {
            continue;
        }
        // In its place, because a copy takes longer than most of what is computed here. There is room for all.
        let _ = terms.push(NearTerm::new(reflectance.factors(light)));
        let adds = match (terms.last_mut(), source.point(), source.directional(), lighting.viewer()) {
            (Some(term), Some(position), ..) => term.set_light(setup, shading, source, position)?,
            (Some(term), _, Some(&[towards, _]), Viewer::Local(eye)) => term.set_constant_light(setup, shading, [eye, towards])?,
            _ => false,
        };
        if !adds {
            let _ = terms.pop();
        }
    }
    Some(())
}

impl NearTerm {
    fn new(factors: Factors) -> Self {
        Self {
            quadratics: Cell::default(),
            other: Cell::default(),
            along: Cell::default(),
            shape: None,
            factors,
            has_highlight: false,
            are_both_near: false,
        }
    }

    /// Sets the term to that of `source`, a light at `position`, Q7.25. Whether it adds anything to the triangle; `None` if loops cannot draw it.
    #[inline(never)]
    fn set_light(&mut self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, source: &Source, position: [i32; 3]) -> Option<bool> {
        let towards = match shading.lighting.viewer() {
            Viewer::Infinite(towards) => towards,
            Viewer::Local(_) => [0; 3],
        };
        let products = Products::new(setup, position, towards)?;
        if let Some((shape, axis)) = source.shape() {
            let shape = shape.coarse(shape.nearness(farthest(setup.vertices(), position)))?;
            if shape.strength(products.least_pp() << 2, || 1 << COSINE) == 0 {
                return Some(false);
            }
            self.shape = Some(shape);
            self.along.set(fitted(&linear([map(along(ways(setup.vertices(), position), axis), |product| -product)]), setup.gradients));
        }
        match shading.lighting.viewer() {
            Viewer::Infinite(towards) => self.set_highlight(setup, shading, &products, towards)?,
            Viewer::Local(eye) => self.set_highlight_for_viewer(setup, shading, &products, [position, eye])?,
        }
        let adds = self.has_highlight || products.largest_np() > shading.reflectance.darkest();
        if adds {
            self.quadratics.set(products.quadratics(setup));
        }
        Some(adds)
    }

    /// Sets the term to the highlight of a light in the direction `towards`, Q2.30, which a viewer at `eye`, Q7.25, sees; its diffuse light is in the sum.
    /// Whether it can be seen; `None` if loops cannot draw it.
    #[inline(never)]
    fn set_constant_light(&mut self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, [eye, towards]: [[i32; 3]; 2]) -> Option<bool> {
        self.factors.diffuse = [0; 3];
        let products = Products::new(setup, eye, towards)?;
        self.set_highlight(setup, shading, &products, towards)?;
        if self.has_highlight {
            self.quadratics.set(products.quadratics(setup));
        }
        Some(self.has_highlight)
    }

    /// Sets the highlight if one may be visible, where the other of light and viewer is in the direction `fixed`.
    fn set_highlight(&mut self, setup: &TriangleSetup<'_>, shading: &Shading<'_>, products: &Products, fixed: [i32; 3]) -> Option<()> {
        let corners = setup.corner_cosines(fixed);
        self.has_highlight = products.may_have_highlight(setup, corners, &shading.reflectance);
        if self.has_highlight {
            draws_highlight(setup, shading, products.have_half())?;
            let (nf, fp) = products.planes(setup, corners);
            self.other.set((nf.into(), fp.into(), Quadric::default()));
        }
        Some(())
    }

    /// Sets the highlight if one may be visible, where both the light and the viewer are near.
    #[inline(never)]
    fn set_highlight_for_viewer(
        &mut self,
        setup: &TriangleSetup<'_>,
        shading: &Shading<'_>,
        products: &Products,
        [position, eye]: [[i32; 3]; 2],
    ) -> Option<()> {
        let (view, vertices) = (Products::new(setup, eye, [0; 3])?, setup.vertices());
        let fp = field_product(&ways(vertices, position), &ways(vertices, eye));
        // Q5.27, and over the length of one vector and then of the other.
        let least = products.least_over(view.least_over(least(coefficients(fp))) << (COSINE - PIXEL_COSINE));
        let bounds = [view.largest_cosine() << (COSINE - PIXEL_COSINE), products.largest_cosine(), least];
        self.has_highlight = is_visible(setup, &shading.reflectance, bounds);
        if self.has_highlight {
            draws_highlight(setup, shading, is_before(least << (COSINE - PIXEL_COSINE)))?;
            let (vv, nv) = view.quadratics(setup);
            self.other.set((nv, fitted(&quadratic([fp]), setup.gradients), vv));
            self.are_both_near = true;
        }
        Some(())
    }

    /// Puts the light on a surface of one colour.
    pub(in crate::method::cosines) fn paint(&mut self, reflected: impl Fn([i32; 3]) -> [i32; 3]) {
        self.factors.diffuse = reflected(self.factors.diffuse);
    }

    /// Moves the polynomials down by `rows`.
    #[inline(always)]
    pub(in crate::method::cosines) fn jump(&self, rows: i32) {
        let ((mut pp, mut np), (mut nf, mut fp, mut ff), mut along) = (self.quadratics.get(), self.other.get(), self.along.get());
        pp.jump(rows);
        np.jump(rows);
        self.quadratics.set((pp, np));
        if self.has_highlight {
            nf.jump(rows);
            fp.jump(rows);
            ff.jump(rows);
            self.other.set((nf, fp, ff));
        }
        if self.shape.is_some() {
            along.jump(rows);
            self.along.set(along);
        }
    }

    /// What the term adds at a column to diffuse light and to highlights, where `normal` is half the reciprocal length of the normal.
    #[inline(always)]
    pub(in crate::method::cosines) fn add_at(
        &self,
        column: i32,
        normal: i32,
        (lengths, lookup): (&HalfRsqrt, CosineLookup<'_>),
        [diffuse, shine]: &mut [[i32; 3]; 2],
    ) {
        let (pp, np) = self.quadratics.get();
        let ([pp], [np]) = (pp.enter(column).value(), np.enter(column).value());
        let near = lengths.rsqrt(pp) as i32;
        let np = upper(signed(np), near);
        let strength = self.shape.as_ref().map(|shape| {
            let [along] = self.along.get().enter(column).value();
            shape.strength(squared(pp), || upper(signed(along), near) << (COSINE - PIXEL_COSINE))
        });
        let cosine = upper(np << (COSINE - PIXEL_COSINE), normal);
        let mut cosine = (cosine.wrapping_add(HALF_FACTOR) >> (PIXEL_COSINE - FACTOR)).clamp(0, (1 << FACTOR) - 1);
        if let Some(strength) = strength {
            cosine = cosine.wrapping_mul(strength >> (COSINE - FACTOR)) >> FACTOR;
        }
        *diffuse = self.factors.add_at(*diffuse, cosine);
        if self.has_highlight {
            let (nf, fp, ff) = self.other.get();
            let ([nf], [fp]) = (nf.enter(column).value(), fp.enter(column).value());
            let (mut nf, mut fp) = (signed(nf), signed(fp));
            if self.are_both_near {
                let [ff] = ff.enter(column).value();
                let far = lengths.rsqrt(ff) as i32;
                (nf, fp) = (upper(nf, far) << (COSINE - PIXEL_COSINE), upper(fp, far) << (COSINE - PIXEL_COSINE));
            }
            let half = half(lengths, nf, np, upper(fp, near));
            let mut highlight = lookup.at(upper(half << (COSINE - HALF), normal));
            if let Some(strength) = strength {
                highlight = (highlight * (strength as u32 >> (COSINE - 16))) >> 16;
            }
            self.factors.add_highlight(shine, highlight);
        }
    }
}

/// `Some` if loops can draw a highlight, and the half vector is in the table of reciprocal roots.
fn draws_highlight(setup: &TriangleSetup<'_>, shading: &Shading<'_>, have_half: bool) -> Option<()> {
    (shading.exponent <= STEEPEST && setup.gradients.walks_in_words() && have_half).then_some(())
}

/// Half of the last place of a cosine as it is multiplied by factors, Q5.27.
const HALF_FACTOR: i32 = 1 << (PIXEL_COSINE - FACTOR - 1);
