//! Measures the pictures of methods against Phong shading in f64.
//!
//! Two errors add up in a picture: the method's error, because it approximates, and the error of its arithmetic, which rounds. The oracle draws each
//! method in f64, so that the two can be separated.

pub mod document;
mod edges;
pub mod exponent;
pub mod figures;
pub mod level;
pub mod operations;
pub mod page;
mod samples;

use anyhow::{Context, Result, ensure};
use edges::Edges;
pub use edges::Jumps;
use embedded_graphics_core::{geometry::Size, pixelcolor::Rgb565};
use figures::Spread;
use microphong::{Stream, features::Feature, renderer::check};
use microphong_oracle::{self as oracle, Facet, Frame, Levels};
use microphong_render::{
    choices::{self, Choices},
    render::{self, Format, Settings, Style},
    shader::Shader,
};
use operations::Operations;
use samples::Samples;
use std::ops::Range;

/// A difference, in 1/255, beyond which a method that makes decisions is also compared with the results of other decisions.
pub const UNDECIDED: f64 = 0.25;

/// One frame of a scene and its Phong shading, against which methods are measured.
#[derive(Debug)]
pub struct Reference<'s> {
    stream: Stream<'s>,
    number: u32,
    perspective_correct: bool,
    frame: Frame,
    /// Per material: the core draws it in one channel.
    one_channel: Vec<bool>,
    /// Per pixel where its candidates start, and at last where they end.
    starts: Vec<usize>,
    /// The facet of each candidate.
    facets: Vec<usize>,
    /// All candidates of all pixels.
    samples: Samples,
    /// Phong's levels of each candidate.
    phong: Vec<Levels>,
    edges: Edges,
    window: Window,
    row: u32,
}

/// A part of the picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Window {
    /// Columns, from left to right.
    pub columns: Range<u32>,
    /// Rows, from top to bottom.
    pub rows: Range<u32>,
}

/// A method's picture of a frame, and how good it is. Errors are in LSB: 255 is full.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The method.
    pub shader: Shader,
    /// Errors of the integer picture, before an output format rounds it: against Phong in f64.
    pub total: Spread,
    /// Errors of the method in f64, against Phong in f64.
    pub method: Spread,
    /// Errors of the integer picture against the method in f64.
    pub arithmetic: Spread,
    /// Colour correctness of pixels rounded to 8 bits, see [`figures::colour_correctness`].
    pub colour_correctness: f64,
    /// Signal-to-noise ratio of pixels rounded to 8 bits, see [`figures::psnr`].
    pub psnr: f64,
    /// Similarity in the [`Reference::window`], rounded to 8 bits, see [`figures::similarity`].
    pub similarity: f64,
    /// Jumps at edges of the method in f64. For `auto`, each triangle is drawn by what `auto` chooses for it.
    pub jumps: Jumps,
    /// Numbers of operations in the formulas of the method.
    pub operations: Operations,
    /// Error budget of the method `auto`, in 1/255.
    pub budget: Option<f64>,
    /// The ways that the method `auto` chooses.
    pub choices: Option<Choices>,
    /// Pixels compared.
    pub pixels: usize,
    /// Pixels that only one of the pictures covers: where triangles had to be clipped.
    pub unmatched: usize,
    /// The picture in 8 bits per channel, row by row from the top.
    pub picture: Vec<[u8; 3]>,
    /// Per pixel the error against Phong with its sign; of the channel that is off most.
    pub errors: Vec<Option<f64>>,
    /// Per pixel the level of the brightest channel.
    pub levels: Vec<Option<f64>>,
}

impl<'s> Reference<'s> {
    /// Frame `number` on a picture of `size` pixels.
    ///
    /// # Errors
    /// When no pixel shows a triangle, or the scene has several objects.
    pub fn new(stream: Stream<'s>, size: (u32, u32), number: u32) -> Result<Self> {
        Self::of(stream, Frame::new(stream, size, number), number, false)
    }

    /// [`Self::new`], perspective-correct: Phong, and all that is compared with it.
    ///
    /// # Errors
    /// When no pixel shows a triangle.
    pub fn perspective_correct(stream: Stream<'s>, size: (u32, u32), number: u32) -> Result<Self> {
        Self::of(stream, Frame::perspective_correct(stream, size, number), number, true)
    }

    fn of(stream: Stream<'s>, frame: Frame, number: u32, perspective_correct: bool) -> Result<Self> {
        ensure!(stream.instances.is_empty(), "the scene has several objects, and the reference draws one: compare their meshes one by one");
        let is_opaque = !Feature::Transparency.is_needed_by(&stream, &Format::Rgb888.channels());
        ensure!(is_opaque, "the scene has transparent surfaces or holes, and the reference draws neither: convert it by --opaque");
        let size = frame.size;
        let (mut starts, mut facets, mut points) = (vec![0], Vec::new(), Vec::new());
        let mut shown = vec![false; frame.facets.len()];
        for (pixel, candidates) in (0..).zip(frame.visible()) {
            let [x, y] = [pixel % size.0, pixel / size.0].map(|c| f64::from(c) + 0.5);
            for facet in candidates {
                let facet = facet as usize;
                facets.push(facet);
                points.push((facet, [x, y]));
                if let Some(shown) = shown.get_mut(facet) {
                    *shown = true;
                }
            }
            starts.push(facets.len());
        }
        let samples = Samples::new(&frame, points);
        let phong = samples.shade(&frame, &|facet| Ok(oracle::phong(&frame, facet)))?;
        let edges = Edges::new(&frame, |facet| shown.get(facet) == Some(&true));
        let one_channel = stream.materials.iter().map(|material| level::is_one_channel(&stream, material)).collect();
        let (window, row) = ends(&starts, &phong, size).context("no pixel shows a triangle")?;
        Ok(Self { stream, number, perspective_correct, frame, one_channel, starts, facets, samples, phong, edges, window, row })
    }

    /// Width and height of the picture.
    #[must_use]
    pub fn size(&self) -> (u32, u32) {
        self.frame.size
    }

    /// The rectangle around all that is drawn, with a little space.
    #[must_use]
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// The row through the highlight.
    #[must_use]
    pub fn row(&self) -> u32 {
        self.row
    }

    /// Phong's level of the brightest channel; `None` is background.
    #[must_use]
    pub fn level(&self, x: u32, y: u32) -> Option<f64> {
        self.nearest(y as usize * self.frame.size.0 as usize + x as usize).map(|sample| brightest(self.phong[sample]))
    }

    /// Phong's picture in 8 bits per channel, row by row from the top.
    #[must_use]
    pub fn picture(&self) -> Vec<[u8; 3]> {
        let pixels = 0..self.starts.len() - 1;
        pixels.map(|pixel| self.nearest(pixel).map_or(self.stream.header.background, |sample| rounded(self.phong[sample]))).collect()
    }

    fn candidates(&self, pixel: usize) -> Range<usize> {
        match self.starts.get(pixel..) {
            Some(&[start, end, ..]) => start..end,
            _ => 0..0,
        }
    }

    fn nearest(&self, pixel: usize) -> Option<usize> {
        self.candidates(pixel).next()
    }

    /// The difference of levels from candidate `sample`, in the channel that differs most.
    fn error(&self, sample: usize, of: Levels, from: Levels) -> f64 {
        let material = self.facets.get(sample).and_then(|&facet| self.frame.facets.get(facet)).map_or(0, |facet| facet.material);
        if self.one_channel.get(material) == Some(&true) {
            brightest(of) - brightest(from)
        } else {
            let errors: Levels = std::array::from_fn(|k| of[k] - from[k]);
            errors.into_iter().fold(0.0, |worst, error| if error.abs() <= f64::abs(worst) { worst } else { error })
        }
    }

    /// The candidate of a pixel that is closest to these levels, and its difference. Of triangles at equal depth the integers may show any.
    fn best(&self, pixel: usize, level: Levels) -> Option<(usize, f64)> {
        let errors = self.candidates(pixel).map(|sample| (sample, self.error(sample, level, self.phong[sample])));
        errors.min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    }

    /// All results that a method may have for a candidate of a pixel, see [`oracle::outcomes`].
    fn outcomes(&self, sample: usize, pixel: usize, name: &str) -> Vec<Levels> {
        let width = self.frame.size.0 as usize;
        let centre = [pixel % width, pixel / width].map(|c| c as f64 + 0.5);
        let facet = self.facets.get(sample).and_then(|&facet| self.frame.facets.get(facet));
        let outcomes = facet.and_then(|facet| oracle::outcomes(name, &self.frame, facet, centre, self.frame.undecided(facet)).ok());
        outcomes.unwrap_or_default()
    }

    /// [`Comparison::total`] only, which is quick.
    ///
    /// # Errors
    /// Errors of [`Self::compare`].
    pub fn total(&self, shader: Shader) -> Result<Spread> {
        let size = Size::new(self.frame.size.0, self.frame.size.1);
        let style = Style { perspective_correct: self.perspective_correct, ..shader.into() };
        let levels = level::picture(self.stream, size, style, self.number)?;
        let errors: Vec<_> = (0..).zip(levels).filter_map(|(pixel, level)| Some(self.best(pixel, level?)?.1)).collect();
        Spread::of(&errors).with_context(|| format!("{} has drawn nothing", shader.name()))
    }

    /// Draws the frame by a method and measures it.
    ///
    /// # Errors
    /// When the method cannot draw this scene, see [`microphong::renderer::check`], or draws none of its pixels.
    pub fn compare(&self, shader: Shader) -> Result<Comparison> {
        let perspective_correct = self.perspective_correct;
        check(&self.stream, shader.facts(), perspective_correct)?;
        let name = shader.name();
        let size = Size::new(self.frame.size.0, self.frame.size.1);
        let style = Style { perspective_correct, ..Style::from(shader) };
        let integers = level::picture(self.stream, size, style, self.number)?;
        let settings = Settings { size, style, band_rows: size.height, format: Format::Rgb888 };
        let picture = render::picture(self.stream, &settings, self.number)?.rgb.as_chunks::<3>().0.to_vec();
        // As most boards draw it.
        let told = choices::by::<Rgb565>(shader, self.stream, size, perspective_correct, self.number)?;
        // Of a method that chooses, what it has chosen for each triangle.
        let chosen = |facet: &Facet| told.as_ref()?.ways.get(facet.id as usize).copied().flatten();
        let shade = |facet| {
            chosen(facet).map_or_else(|| oracle::method(name, &self.frame, facet), |chosen| Ok(oracle::chosen(&self.frame, facet, chosen)))
        };
        let real = self.samples.shade(&self.frame, &shade)?;

        let mut errors = vec![None; integers.len()];
        let (mut total, mut method, mut arithmetic) = (Vec::new(), Vec::new(), Vec::new());
        let mut target = vec![self.stream.header.background; integers.len()];
        let (mut pairs, mut unmatched) = (Vec::new(), 0);
        for (pixel, &level) in integers.iter().enumerate() {
            let candidates = self.candidates(pixel);
            let (Some(level), Some(nearest)) = (level, self.nearest(pixel)) else {
                unmatched += usize::from(level.is_some() || !candidates.is_empty());
                continue;
            };
            let Some((sample, error)) = self.best(pixel, level) else { continue };
            errors[pixel] = Some(error);
            total.push(error);
            method.push(self.error(nearest, real[nearest], self.phong[nearest]));
            let same = |outcomes: &dyn Fn(usize) -> Vec<Levels>| {
                let errors = candidates.clone().map(|sample| {
                    let errors = outcomes(sample).into_iter().map(|real| self.error(sample, level, real).abs());
                    errors.fold(f64::INFINITY, f64::min)
                });
                errors.fold(f64::INFINITY, f64::min)
            };
            let mut error = same(&|sample| vec![real[sample]]);
            if error > UNDECIDED && oracle::decides(name) {
                error = same(&|sample| self.outcomes(sample, pixel, name));
            }
            arithmetic.push(error);
            target[pixel] = rounded(self.phong[sample]);
            pairs.push([picture[pixel], target[pixel]]);
        }
        let spread = |errors: &[f64]| Spread::of(errors).with_context(|| format!("{name} has drawn nothing"));
        let window = &self.window;
        let (drawn, wanted) = (window.cut(&picture, size.width), window.cut(&target, size.width));
        Ok(Comparison {
            shader,
            total: spread(&total)?,
            method: spread(&method)?,
            arithmetic: spread(&arithmetic)?,
            colour_correctness: figures::colour_correctness(&pairs),
            psnr: figures::psnr(&pairs),
            similarity: figures::similarity(window.width(), window.height(), [&drawn, &wanted])?,
            jumps: self.edges.jumps(&self.frame, &shade)?,
            operations: Operations::of(shader.name()),
            budget: told.as_ref().map(|told| told.budget),
            choices: told.as_ref().map(|told| told.choices),
            pixels: pairs.len(),
            unmatched,
            picture,
            errors,
            levels: integers.into_iter().map(|level| level.map(brightest)).collect(),
        })
    }
}

impl Window {
    /// Pixels from left to right.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.columns.end - self.columns.start
    }

    /// Pixels from top to bottom.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.rows.end - self.rows.start
    }

    /// The window's part of a picture that is `width` wide, row by row from the top.
    #[must_use]
    pub fn cut<T: Copy>(&self, picture: &[T], width: u32) -> Vec<T> {
        let columns = self.columns.start as usize..self.columns.end as usize;
        let rows = picture.chunks_exact(width as usize).skip(self.rows.start as usize).take(self.height() as usize);
        rows.flat_map(|row| row.get(columns.clone()).unwrap_or_default()).copied().collect()
    }
}

/// Number of pixels that stay free around the object.
const SPACE: u32 = 4;

/// The rectangle around all pixels that show something, and the row through the middle of the brightest.
fn ends(starts: &[usize], phong: &[Levels], (width, height): (u32, u32)) -> Option<(Window, u32)> {
    let shown: Vec<_> = (0..).zip(starts.array_windows()).filter(|(_, [start, end])| start < end).collect();
    let level = |&(_, [start, _]): &(u32, &[usize; 2])| phong.get(*start).copied().map_or(0.0, brightest);
    let most = shown.iter().map(level).fold(0.0, f64::max);
    let bright: Vec<_> = shown.iter().filter(|pixel| level(pixel) >= most - 0.5).collect();
    let row = bright.get(bright.len() / 2)?.0 / width;
    let range = |of: fn(u32, u32) -> u32, limit: u32| {
        let places = || shown.iter().map(|(pixel, _)| of(*pixel, width));
        Some(places().min()?.saturating_sub(SPACE)..(places().max()? + 1 + SPACE).min(limit))
    };
    Some((Window { columns: range(|pixel, width| pixel % width, width)?, rows: range(|pixel, width| pixel / width, height)? }, row))
}

fn brightest(levels: Levels) -> f64 {
    levels.into_iter().fold(0.0, f64::max)
}

fn rounded(levels: Levels) -> [u8; 3] {
    levels.map(|level| level.round() as u8)
}
