//! [embedded-3dgfx](https://crates.io/crates/embedded-3dgfx): Lambert's light without highlights, corners on whole pixels.

use crate::{HEIGHT, Picture, WIDTH, scene::Scene};
use alloc::{boxed::Box, vec};
use core::convert::Infallible;
use embedded_3dgfx::{
    Z_MAX_VALUE,
    engine::K3dengine,
    pipeline::{
        command_buffer::CommandBuffer,
        renderer::FrameCtx,
        vertex::mesh::{Geometry, K3dMesh, RenderMode},
    },
};
use embedded_graphics_core::{
    Pixel,
    draw_target::DrawTarget,
    geometry::{OriginDimensions, Size},
    pixelcolor::{IntoStorage, Rgb565, RgbColor},
};
use nalgebra::{Point3, Vector3};

/// One colour a triangle.
pub(crate) fn flat(scene: &Scene) -> impl FnMut(&mut Picture) {
    drawing(scene, RenderMode::SolidLightDir(light(scene)))
}

/// Light is worked out at the vertices.
pub(crate) fn gouraud(scene: &Scene) -> impl FnMut(&mut Picture) {
    drawing(scene, RenderMode::GouraudLightDir(light(scene)))
}

/// It turns z round.
fn light(scene: &Scene) -> Vector3<f32> {
    let [x, y, z] = scene.towards;
    Vector3::new(x, y, -z)
}

/// Room for the triangles of a frame.
type Commands = CommandBuffer<1024>;

fn drawing(scene: &Scene, mode: RenderMode) -> impl FnMut(&mut Picture) {
    let mut engine = K3dengine::new(WIDTH as u16, HEIGHT as u16);
    // Whoever clears is not counted.
    engine.set_depth_clear_enabled(false);
    engine.camera.set_position(eye(scene).into());
    engine.camera.set_target(Point3::origin());
    engine.camera.set_fovy(2.0 * libm::atanf(1.0 / scene.focal));

    let geometry = Geometry::new(&scene.positions, &scene.faces).with_normals(&scene.face_normals).with_vertex_normals(&scene.normals);
    let mut mesh = K3dMesh::new(geometry);
    mesh.set_color(grey(scene.surface.ambient + scene.surface.diffuse));
    mesh.set_render_mode(mode);

    let mut commands = Box::new(Commands::new());
    let mut depth = vec![Z_MAX_VALUE; WIDTH * HEIGHT];
    move |picture| {
        let mut frame = FrameCtx { zbuffer: &mut depth, width: WIDTH, height: HEIGHT };
        let drawn =
            engine.record([&mesh], &mut commands, None).and_then(|()| engine.execute(&mut Target(picture), &mut frame, &commands, None));
        drawn.expect("the buffers are large enough");
    }
}

/// Where the camera is in object space.
fn eye(scene: &Scene) -> [f32; 3] {
    let column = |i: usize| -scene.rotation.iter().zip(scene.translation).map(|(row, t)| row[i] * t).sum::<f32>();
    [0, 1, 2].map(column)
}

/// The colour of this share of full light.
fn grey(share: f32) -> Rgb565 {
    let level = |max: u8| (share * f32::from(max)) as u8;
    Rgb565::new(level(Rgb565::MAX_R), level(Rgb565::MAX_G), level(Rgb565::MAX_B))
}

/// Pixels in memory.
struct Target<'p>(&'p mut Picture);

impl OriginDimensions for Target<'_> {
    fn size(&self) -> Size {
        Size::new(WIDTH as u32, HEIGHT as u32)
    }
}

impl DrawTarget for Target<'_> {
    type Color = Rgb565;
    type Error = Infallible;

    #[inline]
    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(point, colour) in pixels {
            if let Some(pixel) = self.0.get_mut(point.y as usize * WIDTH + point.x as usize) {
                *pixel = colour.into_storage();
            }
        }
        Ok(())
    }
}
