//! The shading methods, one file each: what it fits, and what it makes of it at a pixel.

mod flat;
mod gouraud;
mod phong;
mod six_point;

use crate::{
    band::Band,
    format::{BIAS, LEVEL, WALK},
    palette::Palette,
    pixel::Pixel,
    poly::{Patch, Walker, basis::Basis},
    raster::triangle::Outline,
    scene::Lighting,
    shader::Shader,
    stream::record::{Triangle, Vertex},
    tone::{Dithered, Ramp, Rgb},
    vertex::ScreenVertex,
};
use core::marker::PhantomData;

/// Fraction bits that a walked level has more than a node's.
const EXTRA: u32 = WALK - LEVEL;

/// A triangle ready to be shaded; all triples start with its top corner.
pub(crate) struct Facet<'f> {
    pub(crate) outline: Outline,
    pub(crate) basis: Basis,
    pub(crate) corners: [&'f ScreenVertex; 3],
    pub(crate) vertices: [&'f Vertex; 3],
    /// Per edge, see [`Triangle`].
    pub(crate) rsum: [u16; 3],
    /// Per edge, see [`Triangle`].
    pub(crate) square: [u16; 3],
    pub(crate) triangle: &'f Triangle,
}

/// What all triangles of one material have in common in one frame.
pub(crate) struct Shading<'f, C> {
    pub(crate) shader: Shader,
    pub(crate) dither: bool,
    pub(crate) palette: &'f Palette<C>,
    pub(crate) lighting: &'f Lighting,
    /// L and H if they are constant, see [`Lighting::constant`].
    pub(crate) constant: Option<[[i32; 3]; 2]>,
}

/// The bias of walked levels plus a rounding half, the same in all channels.
fn lift<const CH: usize>(half: i32) -> [i32; CH] {
    [(BIAS << WALK).wrapping_add(half); CH]
}

impl<C: Pixel> Shading<'_, C> {
    /// Shades `facet` into `band`; returns its pixels there.
    pub(crate) fn draw(&self, facet: &Facet<'_>, band: &mut Band<'_, C>) -> u32 {
        match self.shader {
            Shader::Flat => flat::draw(facet, self, band),
            Shader::Gouraud => gouraud::draw(facet, self, band),
            Shader::SixPoint => six_point::draw(facet, self, band),
            Shader::Phong => phong::draw(facet, self, band),
        }
    }

    /// Levels at a corner.
    fn corner_levels(&self, corner: &ScreenVertex) -> [i32; 3] {
        match self.constant {
            Some(_) => self.palette.levels(core::iter::once([corner.light[0], corner.light[1]])),
            None => corner.light,
        }
    }

    /// Draws a patch of one level.
    fn draw_one<P>(&self, facet: &Facet<'_>, patch: P, raised: fn(P, [i32; 1]) -> P, band: &mut Band<'_, C>) -> u32
    where
        P: Patch<Walker: Walker<Value = [u32; 1]>>,
    {
        if self.dither {
            facet.outline.draw(&facet.basis, raised(patch, lift(0)), Dithered::new(self.palette.base), band)
        } else {
            facet.outline.draw(&facet.basis, raised(patch, lift(1 << (WALK - 1))), Ramp(&self.palette.ramp), band)
        }
    }

    /// Draws a patch of three levels.
    fn draw_three<P>(&self, facet: &Facet<'_>, patch: P, raised: fn(P, [i32; 3]) -> P, band: &mut Band<'_, C>) -> u32
    where
        P: Patch<Walker: Walker<Value = [u32; 3]>>,
    {
        if self.dither {
            facet.outline.draw(&facet.basis, raised(patch, lift(0)), Dithered::new(self.palette.base), band)
        } else {
            // Half a step of each channel.
            let half = C::DEPTH.map(|depth| (BIAS << WALK).wrapping_add(1 << (WALK + 7 - depth)));
            facet.outline.draw(&facet.basis, raised(patch, half), Rgb(PhantomData), band)
        }
    }
}
