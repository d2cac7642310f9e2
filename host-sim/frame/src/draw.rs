//! Draws one frame, or all of an animation, as a board draws it.

use embedded_graphics_core::{
    geometry::Size,
    pixelcolor::{Rgb565, RgbColor},
};
use microphong::{Layout, Outlines, Renderer, Shader, Skips, Stats, Stream};
use microphong_literature::ALL;
use std::{error::Error, fs, hint::black_box, ops::Range};
use zerocopy::IntoBytes;

/// Callgrind knows it by its name, and starts from zero where it begins.
#[inline(never)]
fn counted_frame(renderer: &mut Renderer<'_, Rgb565>, numbers: Range<u32>, band: &mut [Rgb565]) -> Stats {
    let mut stats = Stats::default();
    for number in numbers {
        let mut frame = renderer.frame(number);
        while let Ok(Some(_)) = frame.next_band(band) {}
        stats = frame.stats();
    }
    stats
}

/// Draws frames. Callgrind writes its counts when this function returns.
#[inline(never)]
fn dumped_frame(renderer: &mut Renderer<'_, Rgb565>, numbers: Range<u32>, band: &mut [Rgb565]) -> Stats {
    black_box(counted_frame(renderer, numbers, band))
}

/// A frame that is wanted, and how it is to be drawn.
pub(crate) struct Wanted<'w> {
    /// The file of the stream.
    path: &'w str,
    size: Size,
    /// Rows of a band.
    rows: u32,
    /// Name of the method.
    shader: &'w str,
    number: u32,
    /// Whether all frames of the animation after this one are drawn instead of this one.
    animation: bool,
    /// Only what has changed is drawn.
    redraw: bool,
    dither: bool,
    antialias: bool,
    outlines: bool,
    perspective_correct: bool,
    skips: Skips,
}

impl<'w> Wanted<'w> {
    /// Reads a request from words: a stream's file, the picture's size as `320x240`, the rows of a band, a method, and options.
    pub(crate) fn parse(words: &[&'w str]) -> Result<Self, Box<dyn Error>> {
        let [path, size, rows, shader, options @ ..] = words else { return Err("FILE WIDTHxHEIGHT ROWS METHOD are needed".into()) };
        let (width, height) = size.split_once('x').ok_or("a size is WIDTHxHEIGHT")?;
        let size = Size::new(width.parse()?, height.parse()?);
        let rows = rows.parse()?;
        let (animation, redraw, dither, antialias, outlines, perspective_correct) = (false, false, false, false, false, false);
        let skips = Skips::ALL;
        let mut wanted =
            Self { path, size, rows, shader, number: 0, animation, redraw, dither, antialias, outlines, perspective_correct, skips };
        for option in options {
            match option.split_once('=').unwrap_or((option, "")) {
                ("animation", "") => wanted.animation = true,
                ("redraw", "") => wanted.redraw = true,
                ("dither", "") => wanted.dither = true,
                ("antialias", "") => wanted.antialias = true,
                ("outlines", "") => wanted.outlines = true,
                ("perspective-correct", "") => wanted.perspective_correct = true,
                ("frame", number) => wanted.number = number.parse()?,
                ("with", name) => {
                    let named = Skips::ALL_BUT.iter().find(|(skip, _)| *skip == name);
                    wanted.skips = named.ok_or_else(|| format!("{name} is nothing that is left out"))?.1;
                }
                _ => return Err(format!("{option} is no option").into()),
            }
        }
        Ok(wanted)
    }

    /// Draws the request, and prints the numbers of triangles and pixels of the last frame.
    pub(crate) fn draw(&self) -> Result<(), Box<dyn Error>> {
        let bytes = fs::read(self.path)?;
        // Read in place, so the bytes must be aligned.
        let mut words = vec![0u32; bytes.len().div_ceil(4)];
        words.as_mut_bytes()[..bytes.len()].copy_from_slice(&bytes);
        let stream = Stream::parse(&words.as_bytes()[..bytes.len()])?;
        let literature = ALL.into_iter().map(Shader::new);
        let shader = Shader::ALL.into_iter().chain(literature).find(|method| method.facts().name == self.shader);
        let layout = Layout::new(self.size.width as usize, self.rows as usize).with_room_for(&stream);
        let layout = layout
            .active_triangles(layout.triangles)
            .antialias(layout.antialias || self.antialias || self.outlines)
            .edges(3 * layout.triangles);
        let mut memory = vec![0; layout.words::<Rgb565>()];
        let mut band = vec![Rgb565::BLACK; layout.band()];
        let mut renderer = Renderer::with_shader(stream, self.size, &layout, &mut memory, shader.ok_or("no such method")?)?;
        renderer.set_dither(self.dither);
        renderer.set_antialias(self.antialias)?;
        if self.outlines {
            renderer.scene().set_outlines(Some(Outlines::new([255; 3])))?;
        }
        renderer.set_perspective_correct(self.perspective_correct)?;
        #[cfg(feature = "styles")]
        renderer.set_skips(self.skips);
        renderer.check_band(&band)?;
        // Tables of materials are computed once, and not by the frames that are counted.
        let _ = renderer.frame(self.number);
        let numbers = if self.animation {
            self.number + 1..u32::from(stream.header.frames)
        } else {
            // Objects are placed by it.
            renderer.set_levels_of_detail(true);
            self.number..self.number + 1
        };
        renderer.set_partial_redraw(self.redraw);
        let Stats { drawn, pixels, .. } = dumped_frame(&mut renderer, numbers, &mut band);
        println!("{drawn} {pixels}");
        Ok(())
    }
}
