//! The scene on the display. The test `examples` draws it on your computer.

use embedded_graphics::{pixelcolor::Rgb565, prelude::*};
use microphong::format::{Angle, Gain};
use microphong::{Layout, Pose, RenderError, Renderer, Scene, SceneError, Shader, Stream, include_stream};

/// Pictures 240 pixels wide, 24 rows at once, and all objects of the stream: needle, rim, dial, hub and seven marks.
pub(crate) const LAYOUT: Layout = Layout::new(240, 24).vertices(836).triangles(1376).materials(5).objects(11);
/// Made of `gauge.toml`; read in place, so that the meshes stay in flash.
pub(crate) static MESH: &[u8] = include_stream!("../gauge.tri");
/// The needle is the first object there.
const NEEDLE: usize = 0;

pub(crate) fn renderer<'a>(stream: Stream<'a>, memory: &'a mut [u64]) -> Result<Renderer<'a, Rgb565>, RenderError> {
    Renderer::new(stream, Size::new(240, 240), &LAYOUT, memory, &[Shader::AUTO_LINEAR])
}

/// Shows a temperature: from 20 to 80 °C the needle goes two thirds of a turn clockwise, and the light turns from white to red.
pub(crate) fn set(scene: &mut Scene<'_>, celsius: f32) -> Result<(), SceneError> {
    let share = ((celsius - 20.0) / 60.0).clamp(0.0, 1.0);
    scene.set_pose(NEEDLE, Pose::about([0, 0, 1], Angle::wrapping_from_num((1.0 - 2.0 * share) / 3.0))?)?;
    if let Some(mut light) = scene.lights().first().copied() {
        light.colour = [1.0, 1.0 - share, 1.0 - share].map(|c| Gain::saturating_from_num(c).to_bits());
        scene.set_lights(&[light])?;
    }
    Ok(())
}
