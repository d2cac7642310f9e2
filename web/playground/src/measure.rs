//! What a picture is worth, and what its scene takes: errors against Phong shading in 64-bit floating point, choices of `auto`, memory.

use crate::{
    boards::{self, Boards},
    estimate::{self, Counts},
    pixels, program,
};
use anyhow::{Context, Result};
use embedded_graphics_core::pixelcolor::Rgb888;
use microphong::Stream;
use microphong_compare::{Reference, figures::Spread};
use microphong_render::{
    choices::{self, Told, Way},
    program::layout_text,
    render::{Picture, Settings, Style},
    shader::Shader,
};
use serde::Serialize;

/// All figures of a picture.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Measured {
    /// Errors of pixels, in 1/255.
    errors: Result<Errors, String>,
    /// The ways that `auto` has chosen, if the method is `auto`.
    ways: Option<Vec<WayShare>>,
    /// The budget of the method, if it has one.
    budget: Option<f64>,
    layout: String,
    /// Bytes of the renderer's memory, and of a band of pixels.
    memory: [usize; 2],
    /// Cargo features of the core that a program needs.
    features: Vec<&'static str>,
    boards: Boards,
}

/// Errors of the pixels of a picture, in 1/255.
#[derive(Serialize)]
struct Errors {
    largest: f64,
    /// 99 in 100 pixels are not further off.
    most: f64,
    /// Root of the mean square.
    mean: f64,
}

/// What `auto` has drawn in one way.
#[derive(Serialize)]
struct WayShare {
    name: &'static str,
    colour: [u8; 3],
    triangles: u32,
    pixels: u32,
}

/// Measures a picture.
pub(crate) fn measured(stream: &Stream<'_>, settings: &Settings, number: u32) -> Result<Measured> {
    let shader = settings.style.shader;
    let told = if shader.keeps_budget() { Some(choices::painted_as::<Rgb888>(*stream, settings, number)?.1) } else { None };
    let counts = counts(stream, settings, number, told.as_ref())?;
    let share = |way: Way| {
        let count = told.as_ref()?.choices.count(way);
        Some(WayShare { name: way.name(), colour: way.colour(), triangles: count.triangles, pixels: count.pixels })
    };
    let errors = errors(stream, settings, number).and_then(|errors| {
        let drawn: Vec<_> = errors.into_iter().flatten().collect();
        let Spread { max, p99, rmse } = Spread::of(&drawn).context("no pixel shows a triangle")?;
        Ok(Errors { largest: max, most: p99, mean: rmse })
    });
    let layout = program::layout(stream, settings)?;
    Ok(Measured {
        errors: errors.map_err(|error| format!("{error:#}")),
        ways: Way::ALL.into_iter().map(share).collect(),
        budget: told.map(|told| told.budget),
        layout: layout_text(&layout),
        memory: settings.format.bytes(&layout),
        features: program::features(stream, settings),
        boards: boards::estimated(stream, settings, counts.as_ref())?,
    })
}

/// The counts of a picture with jagged outlines, whose method has `told` its choices if it keeps a budget; `None` if there are no costs for them.
fn counts(stream: &Stream<'_>, settings: &Settings, number: u32, told: Option<&Told>) -> Result<Option<Counts>> {
    if !estimate::holds_for(stream, settings.format) {
        return Ok(None);
    }
    let jagged = Settings { style: Style { antialias: false, ..settings.style }, ..*settings };
    let Picture { stats, .. } = pixels::picture(*stream, &jagged, number)?;
    let choices = match told {
        Some(told) => told.choices,
        None => {
            let by_auto = Settings { style: Style { shader: Shader::AUTO, ..jagged.style }, ..jagged };
            choices::painted_as::<Rgb888>(*stream, &by_auto, number)?.1.choices
        }
    };
    Ok(Counts::new(stream, settings.format, stats, choices))
}

/// The error of each pixel that shows a triangle, as `microphong compare` measures it.
fn errors(stream: &Stream<'_>, settings: &Settings, number: u32) -> Result<Vec<Option<f64>>> {
    let size = (settings.size.width, settings.size.height);
    Reference::of_objects(*stream, size, number)?.errors(settings.style.shader)
}

/// Draws the errors: the darkest pixels are right, and the brightest are off by 16 of 255 or more.
pub(crate) fn error_picture(stream: &Stream<'_>, settings: &Settings, number: u32) -> Result<Picture> {
    let errors = errors(stream, settings, number)?;
    let Picture { stats, .. } = pixels::picture(*stream, settings, number)?;
    let rgb: Vec<u8> = errors.into_iter().flat_map(|error| error.map_or(BACKGROUND, |error| colour(error.abs()))).collect();
    Ok(Picture { rgb, crc: 0, stats })
}

/// The colour of pixels that show no triangle.
const BACKGROUND: [u8; 3] = [0; 3];

/// Errors in 1/255 and their colours, which the colour-blind tell from each other by their brightness. Others lie in between.
pub(crate) const SCALE: [(f64, [u8; 3]); 6] = [
    (0.0, [40, 38, 66]),
    (1.0, [86, 50, 130]),
    (2.0, [160, 52, 118]),
    (4.0, [224, 92, 74]),
    (8.0, [251, 165, 60]),
    (16.0, [252, 253, 191]),
];

/// The colour of an error.
fn colour(error: f64) -> [u8; 3] {
    let above = SCALE.iter().position(|&(level, _)| level >= error);
    match above {
        None => SCALE[SCALE.len() - 1].1,
        Some(0) => SCALE[0].1,
        Some(above) => {
            let ((low, from), (high, to)) = (SCALE[above - 1], SCALE[above]);
            let share = (error - low) / (high - low);
            [0, 1, 2].map(|k| (f64::from(from[k]) + share * (f64::from(to[k]) - f64::from(from[k]))).round() as u8)
        }
    }
}
