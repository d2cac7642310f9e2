//! [embedded-3dgfx](https://crates.io/crates/embedded-3dgfx): one directional light, highlights on whole triangles alone, corners on whole
//! pixels.

use crate::{Drawing, HEIGHT, Picture, WIDTH, scene::Scene};
use alloc::{boxed::Box, vec};
use core::convert::Infallible;
use embedded_3dgfx::{
    Z_MAX_VALUE,
    config::MaterialProfile,
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

/// Draws each triangle in one colour.
pub(crate) fn flat(scene: &Scene) -> Drawing<'_> {
    drawing(scene, RenderMode::SolidLightDir(light(scene)))
}

/// Draws each triangle in one colour, with a white highlight that is seen from the eye.
pub(crate) fn flat_blinn_phong(scene: &Scene) -> Drawing<'_> {
    let [_, specular_intensity, _] = scene.lights.first().map_or([0.0; 3], |light| light.specular);
    drawing(scene, RenderMode::BlinnPhong { light_dir: light(scene), specular_intensity, shininess: scene.exponent.into() })
}

/// Light is worked out at the vertices.
pub(crate) fn gouraud(scene: &Scene) -> Drawing<'_> {
    drawing(scene, RenderMode::GouraudLightDir(light(scene)))
}

/// The direction of the light. embedded-3dgfx has its z the other way round.
fn light(scene: &Scene) -> Vector3<f32> {
    let [x, y, z] = scene.lights.first().map_or([0.0; 3], |light| light.towards);
    Vector3::new(x, y, -z)
}

/// Room for the triangles of a frame.
type Commands = CommandBuffer<2048>;

/// The far plane. The renderer's depth is f + 2n - 2fn/d at the distance d, between the distances n and f, rounded to whole numbers and never below
/// zero, so it is useful from 2n on.
const FAR: f32 = 60_000.0;

fn drawing(scene: &Scene, mode: RenderMode) -> Drawing<'_> {
    let [x, y, z] = scene.eye;
    let mut engine = K3dengine::new(WIDTH as u16, HEIGHT as u16);
    // Whoever clears is not counted.
    engine.set_depth_clear_enabled(false);
    // Or there are no highlights.
    engine.set_material_profile(MaterialProfile::SimpleSpecular);
    engine.camera.set_position(Point3::new(x, y, z));
    engine.camera.set_target(Point3::new(x, y, z - 1.0));
    engine.camera.set_fovy(2.0 * libm::atanf(1.0 / scene.focal));
    engine.camera.set_near_far((z - scene.radius).max(scene.near) / 2.0, FAR);

    let geometry = Geometry::new(&scene.positions, &scene.faces).with_normals(&scene.face_normals).with_vertex_normals(&scene.normals);
    let mut mesh = K3dMesh::new(geometry);
    mesh.set_color(colour(scene));
    mesh.set_render_mode(mode);

    let mut commands = Box::new(Commands::new());
    let mut depth = vec![Z_MAX_VALUE; WIDTH * HEIGHT];
    Box::new(move |picture| {
        let mut frame = FrameCtx { zbuffer: &mut depth, width: WIDTH, height: HEIGHT };
        let drawn =
            engine.record([&mesh], &mut commands, None).and_then(|()| engine.execute(&mut Target(picture), &mut frame, &commands, None));
        drawn.expect("the buffers are large enough");
    })
}

/// The colour of a face that is turned to the first light. A tenth of it is the ambient light.
fn colour(scene: &Scene) -> Rgb565 {
    let diffuse = scene.lights.first().map_or([0.0; 3], |light| light.diffuse);
    let level = |channel: usize, max: u8| ((scene.ambient[channel] + diffuse[channel]).min(1.0) * f32::from(max)) as u8;
    Rgb565::new(level(0, Rgb565::MAX_R), level(1, Rgb565::MAX_G), level(2, Rgb565::MAX_B))
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
