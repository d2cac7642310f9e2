//! Drawing of the triangles of one mesh into a band.

mod painting;
mod pass;
pub(crate) mod vertices;

use crate::{
    features::COLOURED,
    geometry::bin::{TriangleKey, Walk},
    lighting::material_tables::MaterialTables,
    method::{DrawTriangle, General, Loops, Shading, Style, TriangleSetup, cosines::near, needs_general, tiles},
    pixel::{Output, Pixel},
    raster::{
        band::Band,
        canvas::{BandCanvas, Colourist},
        glass::Glass,
        triangle::{ScreenTriangle, turned},
    },
    setup::gradients::Gradients,
    stream::record::{Mesh, Triangle},
};
pub(crate) use {painting::Painting, pass::MeshPass};

/// A mesh in one frame, and the colours of its material in the pixel format `C`.
pub(crate) struct Drawing<'f, C: Pixel> {
    pub(crate) pass: MeshPass<'f>,
    /// The tables of colours of the material.
    pub(crate) ramps: &'f C::Ramps,
    pub(crate) output: Output,
}

impl<C: Pixel> Drawing<'_, C> {
    fn tables(&self) -> MaterialTables<'_, C> {
        MaterialTables { ramps: self.ramps, reflectance: &self.pass.shading.reflectance }
    }

    /// How the surface of `mesh` lets through what is behind it.
    #[inline(always)]
    pub(crate) fn glass(&self, mesh: &Mesh) -> Option<Glass> {
        mesh.is_transparent().then(|| Glass::new(mesh.transparency(), self.output.gamma))
    }

    /// What makes pixels of intensities.
    fn colourist(&self) -> Colourist<'_, C> {
        Colourist::new(self.tables(), self.output.dither, self.output.gamma)
    }

    /// How the triangles of the mesh are drawn.
    // As part of its caller, it changes how the compiler arranges the set-up of triangles: +0.7 % of a frame on Armv6-M.
    #[inline(never)]
    pub(crate) fn style(&self) -> Style {
        let MeshPass { shading: Shading { reflectance, lighting, .. }, perspective, .. } = &self.pass;
        Style {
            three_channels: reflectance.three_channels(),
            lights: if lighting.is_constant() { reflectance.lights } else { 0 },
            is_near: !(lighting.is_constant() || C::GRAY && self.pass.stage.is_coloured()),
            // Boards with displays of greys have little flash: no loops there.
            near_loops: !C::GRAY && near::have_loops(lighting, reflectance),
            is_plain: self.colourist().suits_loops(),
            perspective: *perspective,
            is_coloured: self.pass.stage.is_coloured(),
            has_texture: self.pass.painting.has_texture(),
        }
    }

    /// Draws the triangle `key` and all that follow in the same mesh, by the loops `L` where they can. Returns the number of pixels in `band`, and
    /// the first triangle of another mesh.
    #[inline(never)]
    pub(crate) fn run<L: Loops, const THREE: bool>(
        &self,
        mut key: TriangleKey,
        walk: &mut Walk<'_>,
        band: &mut Band<'_, C>,
    ) -> (u32, Option<TriangleKey>) {
        let mut pixels = 0u32;
        loop {
            // The mesh has every triangle of its entries.
            if let Some(triangle) = self.pass.triangles.get(self.pass.index(key)) {
                let drawn = if L::GENERAL || !key.is_word_sized() {
                    self.draw::<L, THREE>(triangle, band)
                } else {
                    // A triangle that the loops decline is set up anew: if its set-up were passed on, that of all triangles would be kept
                    // in memory.
                    self.draw_word_sized::<L, THREE>(triangle, key.word(), band).unwrap_or_else(|| self.draw_declined::<L>(triangle, band))
                };
                pixels = pixels.wrapping_add(drawn);
            }
            match walk.next() {
                Some(other) if self.pass.index(other) < self.pass.triangles.len() => key = other,
                other => return (pixels, other),
            }
        }
    }

    /// Draws a triangle of any size, by the loops `L` if possible. Returns the number of its pixels in `band`.
    pub(crate) fn draw<L: Loops, const THREE: bool>(&self, triangle: &Triangle, band: &mut Band<'_, C>) -> u32 {
        let loops: DrawTriangle<C> = L::draw::<C, THREE>;
        if const { needs_general::<L, C>() } {
            self.draw_by::<true>(loops, triangle, band)
        } else {
            self.draw_by::<false>(loops, triangle, band)
        }
    }

    /// Draws a triangle that the loops `L` cannot draw.
    fn draw_declined<L: Loops>(&self, triangle: &Triangle, band: &mut Band<'_, C>) -> u32 {
        if const { needs_general::<L, C>() } { self.draw_by::<true>(General::draw::<C, false>, triangle, band) } else { 0 }
    }

    /// Draws a triangle of any size, by `loops` if possible, and otherwise by the general loop if the program has one.
    #[inline(never)]
    fn draw_by<const GENERAL: bool>(&self, loops: DrawTriangle<C>, triangle: &Triangle, band: &mut Band<'_, C>) -> u32 {
        let (width, rows) = (band.width as i32, band.range());
        self.pass.set_up(triangle, width, rows, &mut |setup| {
            let drawn = loops(setup, &self.pass.shading, self.tables(), band);
            drawn.unwrap_or_else(|| if GENERAL { self.shade_generally(setup, band) } else { 0 })
        })
    }

    #[inline(never)]
    fn shade_generally(&self, setup: &TriangleSetup<'_>, band: &mut Band<'_, C>) -> u32 {
        let MeshPass { method, shading, .. } = &self.pass;
        tiles::shade(setup, &mut BandCanvas { band, colourist: &self.colourist() }, |setup, canvas| method.shade(setup, shading, canvas))
    }

    /// Draws a word-sized triangle, see [`is_word_sized`](crate::geometry::viewport::Viewport::is_word_sized). `key` identifies it among active
    /// triangles. `None` if the loops cannot draw it.
    // Instructions of Armv6-M reach little of a large stack frame, so this is a call there.
    #[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
    #[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline(always))]
    fn draw_word_sized<L: Loops, const THREE: bool>(&self, triangle: &Triangle, key: u32, band: &mut Band<'_, C>) -> Option<u32> {
        let (by, corners) = turned(self.pass.corners(triangle)?);
        let paint = self.pass.paint(triangle, by);
        let place = band.active.take(key);
        let (screen, gradients, needs_depth_test);
        // Decision: continued.
        if let Some(active_triangle) = place.and_then(|place| band.active.active_triangle(place)) {
            (screen, gradients) = (ScreenTriangle::resumed(active_triangle, corners, band), Gradients::NONE);
            needs_depth_test = active_triangle.inv_depth().is_some();
        } else {
            let mut new = ScreenTriangle::word_sized(corners, key, band);
            if new.is_empty() {
                return Some(0);
            }
            gradients = Gradients::word_sized(new.corners(), self.pass.steepness);
            needs_depth_test = self.pass.needs_depth_test(&new);
            if needs_depth_test {
                new.set_up_depth(&gradients);
            }
            screen = new;
        }
        let setup = TriangleSetup {
            screen: &screen,
            gradients: &gradients,
            corners,
            albedos: paint.lent(),
            nodes_of_colours: [None; COLOURED],
            texture: self.pass.painting.texture(&paint),
            triangle,
            vertices: self.pass.vertices,
            turned: by,
            needs_depth_test,
            perspective: self.pass.perspective,
            place,
        };
        L::draw::<C, THREE>(&setup, &self.pass.shading, self.tables(), band)
    }
}
