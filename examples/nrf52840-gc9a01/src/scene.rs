//! What the display shows. The test `examples` draws it on your computer.

use core::fmt::Write;
use embedded_graphics::{mono_font::MonoTextStyle, mono_font::ascii::FONT_10X20, pixelcolor::Rgb565};
use embedded_graphics::{prelude::*, primitives::Rectangle, text::Baseline, text::Text};
use microphong::{Layout, Picture, Pose, RenderError, Renderer, SceneError, Shader, Stats, Stream, format::Angle, include_stream};

/// Pictures 240 pixels wide, 24 rows at once, and all of the watch.
pub(crate) const LAYOUT: Layout = Layout::new(240, 24).vertices(1121).triangles(1174).materials(5).objects(3);
/// Made of `watch.toml`; read in place, so that the meshes stay in flash.
pub(crate) static MESH: &[u8] = include_stream!("../watch.tri");
/// Pixels of the time, which has eight characters.
const TIME: Rectangle = Rectangle::new(Point::new(80, 148), Size::new(80, 20));

pub(crate) fn renderer<'a>(stream: Stream<'a>, memory: &'a mut [u64]) -> Result<Renderer<'a, Rgb565>, RenderError> {
    let mut renderer = Renderer::new(stream, Size::new(240, 240), &LAYOUT, memory, &[Shader::AUTO_LINEAR])?;
    renderer.set_partial_redraw(true);
    Ok(renderer)
}

/// The watch lies as `tilt` says. Hands and light move once a minute. In other seconds only the time is drawn, unless `tilt` has changed.
pub(crate) fn set(renderer: &mut Renderer<'_, Rgb565>, tilt: &Pose, seconds: u32) -> Result<(), SceneError> {
    let minutes = seconds / 60;
    let hand = |period| Pose::about([0, 0, -1], Angle::from_bits(minutes % period * (u32::MAX / period)));
    // The objects of `watch.toml`: case, hour hand, minute hand.
    for (object, pose) in [Pose::IDENTITY, hand(720)?, hand(60)?].into_iter().enumerate() {
        renderer.scene().set_pose(object, pose.turned(tilt))?;
    }
    renderer.scene().play(minutes);
    renderer.invalidate(TIME);
    Ok(())
}

pub(crate) fn picture<'r>(
    renderer: &'r mut Renderer<'_, Rgb565>,
    band: &'r mut [Rgb565],
    seconds: u32,
) -> Result<impl Drawable<Color = Rgb565, Output = Stats>, RenderError> {
    let mut text = heapless::String::<8>::new();
    // Two digits each: there is room.
    let _ = write!(text, "{:02}:{:02}:{:02}", seconds / 3600 % 24, seconds / 60 % 60, seconds % 60);
    Ok(Picture::of_scene(renderer, band)?.over(move |band| {
        let Ok(_) = Text::with_baseline(&text, TIME.top_left, MonoTextStyle::new(&FONT_10X20, Rgb565::WHITE), Baseline::Top).draw(band);
    }))
}
