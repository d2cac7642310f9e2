//! What a user has chosen, as the page says it.

use crate::pixels::FORMATS;
use anyhow::{Context, Result, bail};
use microphong::format::ErrorBudget;
use microphong_models::{
    convert::{Finish, Options},
    look::Surface,
    mesh::Weld,
    vector::V3,
    view::Up,
};
use microphong_render::{render::Format, shader::Shader};
use serde::Deserialize;

/// How a file of a mesh is read: options of `microphong convert`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub(crate) struct Reading {
    /// The axis that points up, if it is not y.
    pub(crate) up: Option<String>,
    /// The surface is turned inside out.
    pub(crate) flip: bool,
    /// The largest number of triangles.
    pub(crate) simplify: Option<u32>,
}

impl Reading {
    /// The options of the converter.
    ///
    /// # Errors
    /// When the axis has no such name.
    pub(crate) fn options(&self) -> Result<Options> {
        let usual = Options::default();
        let mut options =
            Options { weld: Weld { turn: self.flip, ..usual.weld }, simplify: self.simplify.map(|most| most as usize), ..usual };
        if let Some(name) = &self.up {
            let up = Up::ALL.into_iter().find(|up| up.name() == name).with_context(|| format!("there is no axis {name:?}"))?;
            options = options.with_up(up);
        }
        Ok(options)
    }
}

/// The choices of a picture.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub(crate) struct Choices {
    /// The method's name; the scene's own method if there is none.
    pub(crate) method: Option<String>,
    /// The error budget in 1/255, if one is chosen.
    pub(crate) budget: Option<f64>,
    /// The pixel format's name.
    pub(crate) format: String,
    /// Width and height of the picture; those of the scene if there are none.
    pub(crate) size: Option<(u32, u32)>,
    /// The number of the frame.
    pub(crate) frame: u32,
    /// Degrees by which the mesh is turned: to the right about the axis of its orbit, and then towards the viewer.
    pub(crate) turn: [f64; 2],
    /// How many times as large as in the scene the mesh is shown.
    pub(crate) zoom: f64,
    /// Dither, in a format that has it.
    pub(crate) dither: bool,
    /// Smooth outlines.
    pub(crate) antialias: bool,
    /// Whether the display has the curve of sRGB.
    pub(crate) srgb: bool,
    /// The material of all surfaces; their own if there is none.
    pub(crate) material: Option<Material>,
    /// Lights in place of those of the scene.
    pub(crate) lights: Option<Lights>,
    /// The colour behind the mesh, if it is not that of the scene.
    pub(crate) background: Option<String>,
}

/// A material.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub(crate) struct Material {
    /// RRGGBB.
    colour: String,
    /// Whether highlights are white.
    plastic: bool,
    diffuse: f64,
    specular: f64,
    ambient: f64,
    exponent: u16,
}

/// Kinds of light to choose from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) enum LightKind {
    /// One far, white light.
    One,
    /// A warm light, and a weak, cold one from the other side.
    WarmAndCold,
    /// A light close to the mesh.
    Near,
    /// Light from the sky, and a weak sun.
    Sky,
}

/// Lights.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub(crate) struct Lights {
    pub(crate) kind: LightKind,
    /// Degrees of the main light to the right of the viewer.
    pub(crate) azimuth: f64,
    /// Degrees of the main light above the horizon.
    pub(crate) elevation: f64,
}

impl Choices {
    /// The method; `None` for that of the scene.
    pub(crate) fn shader(&self) -> Result<Option<Shader>> {
        let Some(name) = &self.method else { return Ok(None) };
        let shader = Shader::CORE.into_iter().find(|shader| shader.name() == name);
        shader.map(Some).with_context(|| format!("there is no method {name:?}"))
    }

    /// The error budget, if the method has one.
    pub(crate) fn budget(&self) -> Option<ErrorBudget> {
        self.budget.map(ErrorBudget::saturating_from_num)
    }

    /// The pixel format.
    pub(crate) fn format(&self) -> Result<Format> {
        let format = FORMATS.into_iter().find(|format| format.name() == self.format);
        format.with_context(|| format!("there is no pixel format {:?}", self.format))
    }
}

impl Material {
    /// The surface.
    pub(crate) fn surface(&self) -> Result<Surface> {
        let make = if self.plastic { Surface::plastic } else { Surface::metal };
        let shares = [self.ambient, self.diffuse, self.specular].map(|share| share.clamp(0.0, 2.0));
        Ok(make(colour(&self.colour)?, shares, self.exponent.clamp(1, 1024)))
    }

    /// The material of a mesh file without materials, which the page offers first.
    pub(crate) fn usual() -> serde_json::Value {
        let Finish { colour, shares: [ambient, diffuse, specular], exponent, .. } = Finish::of(Format::Rgb565);
        let colour = text_of(colour);
        serde_json::json!({ "colour": colour, "plastic": false, "diffuse": diffuse, "specular": specular, "ambient": ambient, "exponent": exponent })
    }
}

/// A colour as RRGGBB.
fn text_of(colour: V3) -> String {
    let [r, g, b] = colour.map(|c| (255.0 * c).round() as u8);
    format!("{r:02x}{g:02x}{b:02x}")
}

/// Eight bits of each channel of a colour, from RRGGBB.
pub(crate) fn bytes(text: &str) -> Result<[u8; 3]> {
    let digits = text.trim_start_matches('#');
    let Some(number) = u32::from_str_radix(digits, 16).ok().filter(|_| digits.len() == 6) else {
        bail!("{text:?} is no colour; write it as RRGGBB");
    };
    let [_, r, g, b] = number.to_be_bytes();
    Ok([r, g, b])
}

/// A colour from RRGGBB, where 1 is ff.
fn colour(text: &str) -> Result<V3> {
    Ok(bytes(text)?.map(|c| f64::from(c) / 255.0))
}
