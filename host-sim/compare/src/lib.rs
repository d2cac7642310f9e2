//! Measures the pictures of methods against Phong shading in f64.
//!
//! Two errors add up in a picture: the method's error, because it approximates, and the error of its arithmetic, which rounds. The oracle draws each
//! method in f64, so that the two can be separated.

pub mod antialias;
pub mod document;
mod edges;
pub mod exponent;
pub mod figures;
pub mod level;
pub mod operations;
pub mod page;
mod samples;
mod scenery;
pub mod supersampled;

use anyhow::{Context, Result, ensure};
use edges::Edges;
pub use edges::Jumps;
use embedded_graphics_core::geometry::Size;
use figures::Spread;
use level::Walked;
use microphong::{Stream, renderer::check};
use microphong_oracle::{self as oracle, Facet, Frame, Levels, Shade, Unsupported};
use microphong_render::{
    choices::{Choices, Chosen},
    render::{self, Format, Settings, Style},
    shader::Shader,
};
use operations::Operations;
use samples::Samples;
use scenery::Scenery;
use std::{collections::HashSet, ops::Range};

/// A difference, in 1/255, beyond which a method that makes decisions is also compared with the results of other decisions.
pub const UNDECIDED: f64 = 0.25;

/// One frame of a scene and its Phong shading, against which methods are measured.
#[derive(Debug)]
pub struct Reference<'s> {
    stream: Stream<'s>,
    number: u32,
    perspective_correct: bool,
    scenery: Scenery,
    /// Per pixel what may be seen there.
    sights: Vec<Vec<Sight>>,
    /// The facet of each sample.
    facets: Vec<u32>,
    /// All facets that may be seen in a pixel, for all pixels.
    samples: Samples,
    /// Phong's levels of each sample.
    phong: Vec<Levels>,
    edges: Edges,
    window: Window,
    row: u32,
}

/// The samples that are seen in a pixel, in the order of drawing; none where the background is seen.
type Sight = Vec<usize>;

/// A part of the picture.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
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
        ensure_one(&stream)?;
        Self::of(stream, size, number, false)
    }

    /// [`Self::new`] for [`Self::errors`] and [`Self::total`] alone, of a scene that may have several objects.
    ///
    /// # Errors
    /// When no pixel shows a triangle, or several objects have coarser levels of detail.
    pub fn of_objects(stream: Stream<'s>, size: (u32, u32), number: u32) -> Result<Self> {
        Self::of(stream, size, number, false)
    }

    /// [`Self::new`], perspective-correct: Phong, and all that is compared with it.
    ///
    /// # Errors
    /// Errors of [`Self::new`].
    pub fn perspective_correct(stream: Stream<'s>, size: (u32, u32), number: u32) -> Result<Self> {
        ensure_one(&stream)?;
        Self::of(stream, size, number, true)
    }

    fn of(stream: Stream<'s>, size: (u32, u32), number: u32, perspective_correct: bool) -> Result<Self> {
        let scenery = Scenery::new(stream, size, number, perspective_correct)?;
        let frame = &scenery.whole;
        let (mut sights, mut facets, mut points) = (Vec::new(), Vec::new(), Vec::new());
        for (pixel, visible) in (0..).zip(frame.visible()) {
            let centre = [pixel % frame.size.0, pixel / frame.size.0].map(|c| f64::from(c) + 0.5);
            let first = facets.len();
            let mut sample = |facet| {
                let known = facets[first..].iter().position(|&known| known == facet);
                known.map_or_else(
                    || {
                        facets.push(facet);
                        points.push((facet as usize, centre));
                        facets.len() - 1
                    },
                    |known| first + known,
                )
            };
            sights.push(visible.into_iter().map(|sight| sight.into_iter().map(&mut sample).collect()).collect());
        }
        let samples = Samples::new(frame, points);
        let phong = samples.shade(frame, &|index, facet| Ok(oracle::phong(scenery.lighting(index), facet)))?;
        let shown: HashSet<u32> = facets.iter().copied().collect();
        let edges = Edges::new(frame, |facet| shown.contains(&(facet as u32)));
        let (window, row) = (Window::default(), 0);
        let mut reference = Self { stream, number, perspective_correct, scenery, sights, facets, samples, phong, edges, window, row };
        let levels: Vec<_> = (0..reference.sights.len()).map(|pixel| reference.level_of(pixel)).collect();
        (reference.window, reference.row) = ends(&levels, reference.size()).context("no pixel shows a triangle")?;
        Ok(reference)
    }

    /// Width and height of the picture.
    #[must_use]
    pub fn size(&self) -> (u32, u32) {
        self.frame().size
    }

    /// All that may be seen.
    fn frame(&self) -> &Frame {
        &self.scenery.whole
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
        self.level_of(y as usize * self.frame().size.0 as usize + x as usize)
    }

    fn level_of(&self, pixel: usize) -> Option<f64> {
        let sight = self.sights.get(pixel)?.first().filter(|sight| !sight.is_empty())?;
        Some(brightest(self.light(pixel, sight, &self.phong, &Walked::default())))
    }

    /// Phong's picture in 8 bits per channel, row by row from the top.
    #[must_use]
    pub fn picture(&self) -> Vec<[u8; 3]> {
        self.sights.iter().enumerate().map(|(pixel, sights)| self.shown(pixel, &sights[0])).collect()
    }

    /// Phong shading of a sight of a pixel, in 8 bits per channel.
    fn shown(&self, pixel: usize, sight: &[usize]) -> [u8; 3] {
        let seen = sight.iter().map(|&sample| (self.facets[sample], self.phong[sample]));
        rounded(self.frame().mixed(self.row_of(pixel), seen))
    }

    fn row_of(&self, pixel: usize) -> u32 {
        pixel as u32 / self.frame().size.0
    }

    /// Every sight of a pixel in which a facet is seen, what is exactly seen first.
    fn drawn(&self, pixel: usize) -> impl Iterator<Item = &Sight> {
        self.sights[pixel].iter().filter(|sight| !sight.is_empty())
    }

    /// The facet of a sample.
    fn facet(&self, sample: usize) -> &Facet {
        &self.frame().facets[self.facets[sample] as usize]
    }

    /// The light of a sight of a pixel, as [`level::picture`] has it, if samples have these levels.
    fn light(&self, pixel: usize, sight: &[usize], levels: &[Levels], walked: &Walked) -> Levels {
        self.lights(pixel, sight, &|sample| vec![levels[sample]], walked)[0]
    }

    /// The lights that a sight of a pixel may have if each of its samples has one of several `outcomes`.
    fn lights(&self, pixel: usize, sight: &[usize], outcomes: &dyn Fn(usize) -> Vec<Levels>, walked: &Walked) -> Vec<Levels> {
        let seen = sight.iter().map(|&sample| {
            let lighting = self.scenery.lighting(self.facets[sample] as usize);
            let shown = |light| walked.shown(lighting, self.facet(sample), light);
            (self.facets[sample], outcomes(sample).into_iter().map(shown).collect())
        });
        self.frame().mixtures(self.row_of(pixel), seen)
    }

    /// The sight of a pixel whose Phong shading is closest to these levels, and the difference. Of triangles at equal depth the integers may show
    /// any.
    fn best(&self, pixel: usize, level: Levels, walked: &Walked) -> Option<(&Sight, f64)> {
        let errors = self.drawn(pixel).map(|sight| (sight, error(level, self.light(pixel, sight, &self.phong, walked))));
        errors.min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    }

    /// All results that a method may have for a sample of a pixel, see [`oracle::outcomes`].
    fn outcomes(&self, sample: usize, pixel: usize, name: &str) -> Vec<Levels> {
        let facet = self.facet(sample);
        oracle::outcomes(name, self.frame(), facet, self.centre(pixel), self.frame().undecided(facet)).unwrap_or_default()
    }

    /// The centre of a pixel on the screen.
    fn centre(&self, pixel: usize) -> [f64; 2] {
        let width = self.frame().size.0 as usize;
        [pixel % width, pixel / width].map(|c| c as f64 + 0.5)
    }

    /// [`Comparison::total`] only, which is quick.
    ///
    /// # Errors
    /// Errors of [`Self::compare`].
    pub fn total(&self, shader: Shader) -> Result<Spread> {
        let errors: Vec<_> = self.errors(shader)?.into_iter().flatten().collect();
        Spread::of(&errors).with_context(|| format!("{} has drawn nothing", shader.name()))
    }

    /// [`Comparison::errors`] only, which is quick.
    ///
    /// # Errors
    /// Errors of [`Self::compare`].
    pub fn errors(&self, shader: Shader) -> Result<Vec<Option<f64>>> {
        let (width, height) = self.size();
        let size = Size::new(width, height);
        let style = Style { perspective_correct: self.perspective_correct, ..shader.into() };
        let levels = level::picture(self.stream, size, style, self.number)?;
        let walked = Walked::of(&self.stream, shader.facts());
        Ok((0..).zip(levels).map(|(pixel, level)| Some(self.best(pixel, level?, &walked)?.1)).collect())
    }

    /// Draws the frame by a method and measures it.
    ///
    /// # Errors
    /// When the method cannot draw this scene, see [`microphong::renderer::check`], or draws none of its pixels, or the scene has several objects.
    pub fn compare(&self, shader: Shader) -> Result<Comparison> {
        ensure_one(&self.stream)?;
        let frame = self.frame();
        let perspective_correct = self.perspective_correct;
        check(&self.stream, shader.facts(), perspective_correct)?;
        let name = shader.name();
        let (width, height) = self.size();
        let size = Size::new(width, height);
        let style = Style { perspective_correct, ..Style::from(shader) };
        let integers = level::picture(self.stream, size, style, self.number)?;
        let settings = Settings { size, style, band_rows: size.height, format: Format::Rgb888 };
        let picture = render::picture(self.stream, &settings, self.number)?.rgb.as_chunks::<3>().0.to_vec();
        let told = level::choices(self.stream, size, style, self.number)?;
        // Of a method that chooses, what it has chosen for each triangle.
        let chosen = |facet: &Facet| told.as_ref()?.ways.get(facet.id as usize).copied().flatten();
        let shade = |_, facet| shaded(frame, facet, name, chosen(facet));
        let real = self.samples.shade(frame, &shade)?;
        let walked = Walked::of(&self.stream, shader.facts());

        let mut errors = vec![None; integers.len()];
        let (mut total, mut method, mut arithmetic) = (Vec::new(), Vec::new(), Vec::new());
        let mut target: Vec<_> = (0..integers.len()).map(|pixel| self.shown(pixel, &[])).collect();
        let (mut pairs, mut unmatched) = (Vec::new(), 0);
        for (pixel, &level) in integers.iter().enumerate() {
            let Some(level) = level else {
                unmatched += usize::from(!self.sights[pixel].iter().any(Vec::is_empty));
                continue;
            };
            let (Some(exact), Some((sight, difference))) = (self.drawn(pixel).next(), self.best(pixel, level, &walked)) else {
                unmatched += 1;
                continue;
            };
            errors[pixel] = Some(difference);
            total.push(difference);
            method.push(error(self.light(pixel, exact, &real, &walked), self.light(pixel, exact, &self.phong, &walked)));
            let same = |outcomes: &dyn Fn(usize) -> Vec<Levels>| {
                let lights = self.drawn(pixel).flat_map(|sight| self.lights(pixel, sight, outcomes, &walked));
                lights.map(|light| error(level, light).abs()).fold(f64::INFINITY, f64::min)
            };
            let mut off = same(&|sample| vec![real[sample]]);
            if off > UNDECIDED {
                // The place in a texture may be rounded to the texel beside.
                let beside = |sample: usize| -> Vec<Levels> {
                    let light = |facet: Facet| Some(shaded(frame, &facet, name, chosen(&facet)).ok()?(self.centre(pixel)));
                    [real[sample]].into_iter().chain(self.facet(sample).within(self.centre(pixel)).into_iter().filter_map(light)).collect()
                };
                off = same(&beside);
            }
            if off > UNDECIDED && oracle::decides(name) {
                off = off.min(same(&|sample| self.outcomes(sample, pixel, name)));
            }
            arithmetic.push(off);
            target[pixel] = self.shown(pixel, sight);
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
            jumps: self.edges.jumps(frame, &shade)?,
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

/// Refuses scenes of several objects.
fn ensure_one(stream: &Stream<'_>) -> Result<()> {
    ensure!(stream.instances.is_empty(), "the scene has several objects, and the reference draws one: compare their meshes one by one");
    Ok(())
}

/// The shading of a facet by a method in floating point, in the way that it has chosen if it chooses one.
fn shaded<'f>(frame: &'f Frame, facet: &'f Facet, name: &str, chosen: Option<Chosen>) -> Result<Shade<'f>, Unsupported> {
    chosen.map_or_else(|| oracle::method(name, frame, facet), |chosen| Ok(oracle::chosen(frame, facet, chosen)))
}

/// Number of pixels that stay free around the object.
const SPACE: u32 = 4;

/// The difference of levels from others, in the channel that differs most.
fn error(of: Levels, from: Levels) -> f64 {
    let errors: Levels = std::array::from_fn(|k| of[k] - from[k]);
    errors.into_iter().fold(0.0, |worst, error| if error.abs() <= f64::abs(worst) { worst } else { error })
}

/// The rectangle around all pixels that have a level, and the row through the middle of the brightest.
fn ends(levels: &[Option<f64>], (width, height): (u32, u32)) -> Option<(Window, u32)> {
    let shown: Vec<(u32, f64)> = (0..).zip(levels).filter_map(|(pixel, &level)| Some((pixel, level?))).collect();
    let most = shown.iter().map(|(_, level)| *level).fold(0.0, f64::max);
    let bright: Vec<_> = shown.iter().filter(|(_, level)| *level >= most - 0.5).collect();
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
