//! A scene and the way it is drawn: all that is needed to see a failure again.

use anyhow::Result;
use embedded_graphics_core::geometry::Size;
use microphong::Outlines;
use microphong_models::bytes::StreamBytes;
use microphong_render::{
    render::{Format, Picture, Settings, Style, picture},
    shader::Shader,
};
use std::path::Path;

/// A frame of a scene, and how it is drawn.
#[derive(Clone, Debug)]
pub struct Case {
    /// The scene.
    pub stream: StreamBytes,
    /// Size of the picture, in pixels.
    pub size: [u32; 2],
    /// The frame of the orbit.
    pub frame: u32,
    /// Method and its options.
    pub style: Style,
    /// Pixel format.
    pub format: Format,
    /// Rows drawn at a time.
    pub band_rows: u32,
}

impl Case {
    /// A case that draws a stream in the ordinary way.
    #[must_use]
    pub fn new(stream: StreamBytes) -> Self {
        Self { stream, size: [64, 48], frame: 0, style: Shader::FLAT.into(), format: Format::Rgb888, band_rows: 16 }
    }

    /// Width and height as the core takes them.
    #[must_use]
    pub fn pixels(&self) -> Size {
        Size::new(self.size[0], self.size[1])
    }

    /// Draws it.
    ///
    /// # Errors
    /// When the stream is not valid, or the method cannot draw it in this style.
    pub fn draw(&self) -> Result<Picture> {
        let settings = Settings { size: self.pixels(), style: self.style, band_rows: self.band_rows, format: self.format };
        picture(self.stream.parse()?, &settings, self.frame)
    }

    /// The command that draws it, if its stream lies in `file`.
    #[must_use]
    pub fn command(&self, file: &Path) -> String {
        let [width, height] = self.size;
        let Self { style, format, band_rows, frame, .. } = self;
        let options = [
            (style.perspective_correct, " --perspective-correct"),
            (style.dither && !format.is_dithered(), " --dither"),
            (!style.dither && format.is_dithered(), " --no-dither"),
            (!style.has_edges(), " --no-antialias"),
            (style.srgb, " --gamma srgb"),
        ];
        let mut options: String = options.iter().filter(|(on, _)| *on).map(|(_, text)| *text).collect();
        if let Some(Outlines { colour: [r, g, b], alone, .. }) = style.outlines {
            options += &format!(" --outlines {r:02x}{g:02x}{b:02x}{}", if alone { " --outlines-alone" } else { "" });
        }
        format!(
            "microphong render {} --shader {} --size {width}x{height} --format {} --band-rows {band_rows} --first {frame}{options}",
            file.display(),
            style.shader.name(),
            format.name(),
        )
    }
}
