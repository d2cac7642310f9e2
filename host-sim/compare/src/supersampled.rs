//! Pictures of the oracle whose pixels are means of many samples: what smooth outlines come near to.

use anyhow::Result;
use microphong::Stream;
use microphong_oracle::{self as oracle, Facet, Frame, Levels};
use microphong_render::shader::Shader;
use rayon::prelude::*;

/// Samples along each side of a pixel.
pub const SAMPLES: u32 = 16;

/// A pixel whose samples differ by more in one channel, in 1/255, contains an edge.
pub const EDGE: f64 = 24.0;

/// A pixel of many samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mean {
    /// The mean light.
    pub levels: Levels,
    /// The largest difference of two samples in a channel.
    pub spread: f64,
}

/// One frame of a scene, with objects, perspective, lights, colours, textures, holes and transparency.
#[derive(Debug)]
pub struct Supersampled {
    size: (u32, u32),
    /// The objects, the nearest first.
    objects: Vec<Frame>,
}

/// What a sample shows.
#[derive(Clone, Copy)]
struct Sample {
    inv_depth: f64,
    /// Number of the opaque facet among all facets of the frame.
    facet: usize,
    light: Levels,
}

impl Supersampled {
    /// Frame `number` of a stream on a picture of `size` pixels.
    ///
    /// # Errors
    /// When `size` is out of range.
    pub fn new(stream: Stream<'_>, size: (u32, u32), number: u32, perspective_correct: bool) -> Result<Self> {
        Ok(Self { size, objects: Frame::objects(stream, size, number, perspective_correct)? })
    }

    /// Width and height of the picture.
    #[must_use]
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// The pixels row by row from the top, by a shading method in f64. `row_done` is called after each row. A method that chooses the formula of a triangle
    /// by an error budget is drawn by Phong shading.
    ///
    /// # Errors
    /// When the method cannot draw this frame.
    pub fn pixels(&self, shader: Shader, row_done: &(dyn Fn() + Sync)) -> Result<Vec<Mean>> {
        let rows = (0..self.size.1).into_par_iter().map(|row| {
            let means = self.row(row, shader.name());
            row_done();
            means
        });
        Ok(rows.collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// All facets of the frame in the order of drawing: opaque ones, and then transparent ones, the farthest object first.
    fn facets(&self) -> [Vec<(usize, &Frame, &Facet)>; 2] {
        let numbered = self.objects.iter().flat_map(|frame| frame.facets.iter().map(move |facet| (frame, facet)));
        let all = numbered.enumerate().map(|(number, (frame, facet))| (number, frame, facet));
        let (opaque, clear): (Vec<_>, Vec<_>) = all.partition(|(.., facet)| facet.transparency == 0.0);
        let of = |object: &Frame| clear.iter().filter(|(_, frame, _)| std::ptr::eq(*frame, object)).copied().collect::<Vec<_>>();
        let clear = self.objects.iter().rev().flat_map(of).collect();
        [opaque, clear]
    }

    fn row(&self, row: u32, method: &str) -> Result<Vec<Mean>, oracle::Unsupported> {
        let (width, first) = (self.size.0 * SAMPLES, row * SAMPLES);
        let background = self.objects.first().map_or([0.0; 3], |frame| frame.background(row));
        let mut samples = vec![Sample { inv_depth: 0.0, facet: usize::MAX, light: background }; (width * SAMPLES) as usize];
        let places = |facet: &Facet| {
            let place =
                move |[x, y]: [u32; 2]| (((y - first) * width + x) as usize, [x, y].map(|c| (f64::from(c) + 0.5) / f64::from(SAMPLES)));
            facet.samples(SAMPLES, [0..width, first..first + SAMPLES]).map(place)
        };
        let [opaque, clear] = self.facets();
        let mut reaches = Vec::new();
        for &(number, frame, facet) in &opaque {
            let mut is_seen = false;
            for (at, point) in places(facet) {
                let inv_depth = facet.inv_depth_at(point);
                if inv_depth > samples[at].inv_depth && !facet.has_hole(point) {
                    (samples[at].inv_depth, samples[at].facet, is_seen) = (inv_depth, number, true);
                }
            }
            reaches.extend(is_seen.then_some((number, frame, facet)));
        }
        for (number, frame, facet) in reaches {
            let shade = oracle::method(method, frame, facet)?;
            for (at, point) in places(facet) {
                if samples[at].facet == number {
                    samples[at].light = shade(point);
                }
            }
        }
        for (_, frame, facet) in clear {
            let mut visible = places(facet).filter(|(_, point)| !facet.has_hole(*point)).peekable();
            if visible.peek().is_none() {
                continue;
            }
            let shade = oracle::method(method, frame, facet)?;
            for (at, point) in visible {
                if facet.inv_depth_at(point) > samples[at].inv_depth {
                    samples[at].light = facet.over(shade(point), samples[at].light);
                }
            }
        }
        let pixel = |column: u32| {
            let of_pixel = (0..SAMPLES * SAMPLES).map(|k| (k / SAMPLES * width + column * SAMPLES + k % SAMPLES) as usize);
            Mean::of(of_pixel.map(|at| samples[at].light))
        };
        Ok((0..self.size.0).map(pixel).collect())
    }
}

impl Mean {
    /// The mean of the samples of a pixel.
    fn of(samples: impl Iterator<Item = Levels>) -> Self {
        let (mut sum, mut low, mut high) = ([0.0; 3], [f64::MAX; 3], [f64::MIN; 3]);
        for light in samples {
            for k in 0..3 {
                (sum[k], low[k], high[k]) = (sum[k] + light[k], low[k].min(light[k]), high[k].max(light[k]));
            }
        }
        let spread = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        Self { levels: sum.map(|sum| sum / f64::from(SAMPLES * SAMPLES)), spread }
    }

    /// Whether the pixel contains an edge.
    #[must_use]
    pub fn has_edge(&self) -> bool {
        self.spread > EDGE
    }
}
