//! Growth of a frame's cost with its contents, counted on x86-64, because no board has the memory.
//!
//! Triangles, pixels and lights are varied on a flat square with the normals of a cushion, seen by parallel rays. It covers the same pixels at every
//! fineness of its mesh. Bands are varied on `peer-sphere`.

use super::{Stages, callgrind};
use anyhow::Result;
use microphong_models::{
    bytes::StreamBytes,
    convert,
    look::{Lamp, Look, Surface},
    quantise::quantise,
    scene, shapes,
    view::View,
};
use microphong_render::shader::Shader;
use rayon::prelude::*;
use serde::{Serialize, Serializer};
use std::{fmt, path::Path};

/// A quantity that is varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Sweep {
    /// 100 to 100,000 triangles on 40,000 pixels.
    Triangles,
    /// 1,000 to 1,000,000 pixels of 512 triangles.
    Pixels,
    /// 1 to 8 directional lights on 968 triangles and 40,000 pixels.
    Lights,
    /// `peer-sphere` in 1 to 24 bands.
    Bands,
}

/// A counted frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    /// The varied quantity.
    pub sweep: Sweep,
    /// Its amount.
    pub amount: u64,
    /// The method.
    #[serde(serialize_with = "name")]
    pub shader: Shader,
    /// Instructions of the frame, without clearing.
    pub instructions: u64,
    /// Number of drawn triangles, whose bounding boxes contain a pixel's centre.
    pub triangles: u64,
    /// Rows of triangles.
    pub spans: u64,
    /// Pixels drawn.
    pub pixels: u64,
    /// Instructions of each stage.
    pub by_stage: Stages,
}

fn name<S: Serializer>(shader: &Shader, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(shader.name())
}

/// Methods that are swept unless others are asked for: one of each kind.
pub const SHADERS: [Shader; 4] = [Shader::GOURAUD, Shader::SIX_POINT, Shader::SQRT6, Shader::PHONG];

/// Cells along a side, for 100, 200, 500 and so on to 100,000 triangles.
const CELLS: [usize; 10] = [7, 10, 16, 22, 32, 50, 71, 100, 158, 223];
const PIXELS: [u32; 10] = [1_000, 2_000, 5_000, 10_000, 20_000, 50_000, 100_000, 200_000, 500_000, 1_000_000];
const LIGHTS: [usize; 8] = [1, 2, 3, 4, 5, 6, 7, 8];
/// Divisors of the picture's 240 rows.
const BANDS: [u32; 9] = [1, 2, 3, 4, 6, 8, 12, 16, 24];
/// Fineness and pixels of the square while another quantity is varied.
const MEDIUM: (usize, u32) = (22, 40_000);
/// Fineness of the square while pixels are varied.
const COARSE: usize = 16;
/// The square's turn on the screen, radians: no edge lies along rows or columns, and diagonals do not either.
const TURN: f64 = 0.3;
/// Pixels left free around it.
const BORDER: f64 = 4.0;

impl Sweep {
    /// All quantities.
    pub const ALL: [Self; 4] = [Self::Triangles, Self::Pixels, Self::Lights, Self::Bands];

    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Triangles => "triangles",
            Self::Pixels => "pixels",
            Self::Lights => "lights",
            Self::Bands => "bands",
        }
    }

    /// The scenes of the sweep.
    ///
    /// # Errors
    /// When a scene cannot be made.
    pub fn steps(self) -> Result<Vec<Step>> {
        let step = |amount, (cells, pixels), lights| Step::cushion(self, amount, cells, pixels, lights);
        match self {
            Self::Triangles => CELLS.into_iter().map(|cells| step(2 * (cells * cells) as u64, (cells, MEDIUM.1), 1)).collect(),
            Self::Pixels => PIXELS.into_iter().map(|pixels| step(pixels.into(), (COARSE, pixels), 1)).collect(),
            Self::Lights => LIGHTS.into_iter().map(|lights| step(lights as u64, MEDIUM, lights)).collect(),
            Self::Bands => {
                let sphere = scene::load("peer-sphere")?;
                let (_, height) = sphere.size;
                let step = |bands| Step {
                    sweep: self,
                    amount: u64::from(bands),
                    stream: sphere.stream.clone(),
                    size: sphere.size,
                    band_rows: height / bands,
                };
                Ok(BANDS.map(step).into())
            }
        }
    }
}

impl fmt::Display for Sweep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A scene with one amount of the varied quantity.
#[derive(Clone, Debug)]
pub struct Step {
    sweep: Sweep,
    amount: u64,
    stream: StreamBytes,
    size: (u32, u32),
    band_rows: u32,
}

impl Step {
    /// A square of `pixels` pixels.
    fn cushion(sweep: Sweep, amount: u64, cells: usize, pixels: u32, lights: usize) -> Result<Self> {
        let side = f64::from(pixels).sqrt();
        let picture = (side * (TURN.sin() + TURN.cos()) + BORDER).ceil();
        // Half a side is half the root of two in space.
        let focal = side / picture * 2f64.sqrt();
        let (s, c) = TURN.sin_cos();
        let view =
            View::facing([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]], convert::DISTANCE, [0.0, 0.0, 1.0], 0).parallel().focal(focal);
        let share = 1.0 / lights as f64;
        let mut look = Look::new(Surface::metal([1.0; 3], [0.1, 0.45, 0.45], 50), view);
        look.lamps = (0..lights)
            .map(|i| {
                let (y, x) = (std::f64::consts::TAU * i as f64 / LIGHTS.len() as f64).sin_cos();
                Lamp::distant([0.5 * x, 0.5 * y, -0.8], [share; 3])
            })
            .collect();
        let stream = look.stream(&quantise(&shapes::cushion(cells)).0)?;
        let picture = picture as u32;
        Ok(Self { sweep, amount, stream, size: (picture, picture), band_rows: picture })
    }

    /// Counts the frame by each method.
    ///
    /// # Errors
    /// Errors of [`callgrind::count`].
    pub fn count(&self, program: &Path, shaders: &[Shader]) -> Result<Vec<Point>> {
        let one = |&shader: &Shader| {
            let frame = callgrind::Frame { size: self.size, band_rows: self.band_rows, shader };
            let counts = callgrind::count(program, self.stream.as_bytes(), &[frame])?;
            let points = counts.into_iter().map(|count| Point {
                sweep: self.sweep,
                amount: self.amount,
                shader,
                instructions: count.stages.drawing(),
                triangles: count.triangles,
                spans: count.spans,
                pixels: count.pixels,
                by_stage: count.stages,
            });
            Ok(points.collect::<Vec<_>>())
        };
        Ok(shaders.par_iter().map(one).collect::<Result<Vec<_>>>()?.concat())
    }
}
