//! Frames of microphong drawn by other renderers, each in the way that its documentation shows, for `microphong bench --peers`.
//!
//! Only [`counted_frame`] is counted: all that a renderer does for a frame, without clearing. Meshes, matrices and the light's direction stay the
//! same from frame to frame and are converted before.
#![no_std]

extern crate alloc;

mod embedded_3dgfx;
mod retrofire;
pub mod scene;

use alloc::boxed::Box;
use core::hint::black_box;
use retrofire::Shading;
use scene::Scene;

/// Columns of the picture.
pub const WIDTH: usize = 320;
/// Rows of the picture.
pub const HEIGHT: usize = 240;

/// Pixels from the top left on, row by row, as RGB565.
pub type Picture = [u16; WIDTH * HEIGHT];

/// Draws a frame on black: once, as depth is not cleared again.
pub type Drawing<'s> = Box<dyn FnMut(&mut Picture) + 's>;

/// A renderer and its way to shade.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Peer {
    /// Light at the vertices, by a vertex shader.
    RetrofireGouraud,
    /// Light at each pixel, by a fragment shader.
    RetrofirePhong,
    /// One colour for each triangle, `RenderMode::SolidLightDir`.
    Embedded3dgfxFlat,
    /// One colour for each triangle with a highlight, `RenderMode::BlinnPhong`.
    Embedded3dgfxFlatBlinnPhong,
    /// Light at the vertices, `RenderMode::GouraudLightDir`.
    Embedded3dgfxGouraud,
}

impl Peer {
    /// All drawings by other renderers.
    pub const ALL: [Self; 5] = [
        Self::RetrofireGouraud,
        Self::RetrofirePhong,
        Self::Embedded3dgfxFlat,
        Self::Embedded3dgfxFlatBlinnPhong,
        Self::Embedded3dgfxGouraud,
    ];

    /// The name that the host knows.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::RetrofireGouraud => "retrofire gouraud",
            Self::RetrofirePhong => "retrofire phong",
            Self::Embedded3dgfxFlat => "embedded-3dgfx flat",
            Self::Embedded3dgfxFlatBlinnPhong => "embedded-3dgfx flat-blinn-phong",
            Self::Embedded3dgfxGouraud => "embedded-3dgfx gouraud",
        }
    }

    /// Converts `scene`, and returns what draws a frame of it; `None` if it has no shader for such lights and materials.
    #[must_use]
    pub fn prepare(self, scene: &Scene) -> Option<Drawing<'_>> {
        match self {
            Self::RetrofireGouraud => retrofire::drawing(scene, Shading::Gouraud),
            Self::RetrofirePhong => retrofire::drawing(scene, Shading::Phong),
            Self::Embedded3dgfxFlat => Some(embedded_3dgfx::flat(scene)),
            Self::Embedded3dgfxFlatBlinnPhong => Some(embedded_3dgfx::flat_blinn_phong(scene)),
            Self::Embedded3dgfxGouraud => Some(embedded_3dgfx::gouraud(scene)),
        }
    }
}

/// Pixels that are not background.
#[must_use]
pub fn covered(picture: &Picture) -> usize {
    picture.iter().filter(|&&pixel| pixel != 0).count()
}

/// Callgrind knows it by its name, and starts from zero where it begins.
#[inline(never)]
pub fn counted_frame(draw: &mut dyn FnMut(&mut Picture), picture: &mut Picture) {
    draw(picture);
    black_box(picture);
}

/// Draws a frame. Callgrind writes its counts when this function returns.
#[inline(never)]
pub fn dumped_frame(draw: &mut dyn FnMut(&mut Picture), picture: &mut Picture) {
    counted_frame(draw, picture);
    black_box(picture);
}
