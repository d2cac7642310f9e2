//! How near smooth outlines come to means of many samples, and how near jagged ones are.

use super::{
    error,
    supersampled::{Mean, Supersampled},
};
use anyhow::{Context, Result};
use embedded_graphics_core::geometry::Size;
use microphong::Stream;
use microphong_render::render::{self, Format, Settings, Style};
use serde::Serialize;

/// Differences of a picture from means of samples, in 1/255, each of the channel that differs most.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Differences {
    /// Root of the mean square in pixels that contain an edge; 0 if none does.
    pub edges_rmse: f64,
    /// Root of the mean square in all other pixels.
    pub elsewhere_rmse: f64,
    /// The largest, without its sign.
    pub max: f64,
    /// Column and row of the largest.
    pub at: [u32; 2],
}

/// A frame with smooth outlines and without, and means of samples.
#[derive(Clone, Debug)]
pub struct Smoothing {
    /// Number of pixels that contain an edge.
    pub edges: usize,
    /// Differences of the picture with smooth outlines.
    pub smooth: Differences,
    /// Differences of the picture without.
    pub plain: Differences,
    /// The means.
    pub means: Vec<Mean>,
    /// The pictures with smooth outlines and without, in 8 bits per channel, row by row from the top.
    pub pictures: [Vec<[u8; 3]>; 2],
}

impl Differences {
    /// The differences of a picture that is `width` pixels wide, row by row from the top; `None` if it has no pixel.
    #[must_use]
    pub fn of(pixels: &[[u8; 3]], means: &[Mean], width: u32) -> Option<Self> {
        let differences =
            || pixels.iter().zip(means).map(|(pixel, mean)| (error(pixel.map(f64::from), mean.levels).abs(), mean.has_edge()));
        let rmse = |on_edges: bool| {
            let (squares, count) = differences()
                .filter(|&(_, has_edge)| has_edge == on_edges)
                .fold((0.0, 0usize), |(squares, count), (difference, _)| (squares + difference * difference, count + 1));
            (squares / count.max(1) as f64).sqrt()
        };
        let ((max, _), at) = differences().zip(0..).max_by(|(a, _), (b, _)| a.0.total_cmp(&b.0))?;
        Some(Self { edges_rmse: rmse(true), elsewhere_rmse: rmse(false), max, at: [at % width, at / width] })
    }
}

/// Draws frame `number` of a stream with smooth outlines and without, and measures both. `row_done` is called after each row of the samples.
///
/// # Errors
/// When the method cannot draw the scene.
pub fn compare(
    stream: Stream<'_>,
    samples: &Supersampled,
    style: impl Into<Style>,
    number: u32,
    row_done: &(dyn Fn() + Sync),
) -> Result<Smoothing> {
    let (style, (width, height)) = (style.into(), samples.size());
    let size = Size::new(width, height);
    let draw = |antialias| {
        let settings = Settings { size, style: Style { antialias, ..style }, band_rows: height, format: Format::Rgb888 };
        anyhow::Ok(render::picture(stream, &settings, number)?.rgb.as_chunks::<3>().0.to_vec())
    };
    let pictures = [draw(true)?, draw(false)?];
    let means = samples.pixels(style.shader, row_done)?;
    let of = |picture: &[[u8; 3]]| Differences::of(picture, &means, width).context("the picture has no pixel");
    let edges = means.iter().filter(|mean| mean.has_edge()).count();
    Ok(Smoothing { edges, smooth: of(&pictures[0])?, plain: of(&pictures[1])?, means, pictures })
}
