//! The frames of one stream.

use crate::{
    Stream,
    error::{MAX_SIDE, RenderError},
    format::{ErrorBudget, GeometricError, LARGEST_BUDGET, LEAST_BUDGET, LEVEL},
    frame::{Frame, Preparation, Seams, Settings},
    geometry::detail::tolerance,
    lighting::material_tables::fill_ramp,
    memory::{Layout, Memory},
    method::Facts,
    pixel::Pixel,
    shader::Shader,
};
use embedded_graphics_core::geometry::Size;

/// Draws the frames of one stream.
#[derive(Debug)]
pub struct Renderer<'a, C: Pixel> {
    settings: Settings<'a, C>,
    memory: Memory<'a, C>,
    /// See [`Self::prepare`].
    seams: Option<Seams>,
    /// Where the camera was in the latest frame, unless a setting has changed since.
    latest: Option<u32>,
}

impl<'a, C: Pixel> Renderer<'a, C> {
    /// A renderer for a viewport of `size` pixels, with the one of `shaders` that the stream asks for. `memory` has as many words as
    /// [`Layout::words`] says; its contents do not matter.
    ///
    /// # Errors When `size` is out of range or not that of the layout, `memory` is too small, or the method is missing or cannot shade the
    /// scene.
    pub fn new(stream: Stream<'a>, size: Size, layout: &Layout, memory: &'a mut [u64], shaders: &[Shader<C>]) -> Result<Self, RenderError> {
        let method = stream.header.shader;
        let shader = shaders.iter().find(|shader| shader.facts().id == method).ok_or(RenderError::Missing { method })?;
        Self::with_shader(stream, size, layout, memory, *shader)
    }

    /// A renderer with the method `shader`, whatever method the stream asks for; otherwise as [`Self::new`].
    ///
    /// # Errors
    /// Those of [`Self::new`], except that no method can be missing.
    // Copies of it on the way stay off the stack of the frame loop.
    #[inline(never)]
    pub fn with_shader(
        stream: Stream<'a>,
        size: Size,
        layout: &Layout,
        memory: &'a mut [u64],
        shader: Shader<C>,
    ) -> Result<Self, RenderError> {
        let (width, height) = (size.width, size.height);
        if !(1..=MAX_SIDE).contains(&width) || !(1..=MAX_SIDE).contains(&height) {
            return Err(RenderError::Size { width, height });
        }
        if layout.width != width as usize || layout.rows == 0 || layout.processors == 0 {
            return Err(RenderError::Layout { width });
        }
        if layout.materials < stream.materials.len() {
            return Err(RenderError::Materials { need: stream.materials.len() });
        }
        let need = layout.words::<C>();
        let memory = Memory::new(layout, memory).ok_or(RenderError::Memory { need })?;
        let background = background(stream.header.background);
        let processors = layout.processors as u32;
        let settings = Settings {
            stream,
            size,
            processors,
            shader,
            dither: C::DITHERED,
            perspective_correct: false,
            antialias: false,
            budget: level(stream.header.budget()),
            background,
            #[cfg(feature = "skips")]
            skips: crate::frame::Skips::ALL,
            tolerance: GeometricError::ZERO,
            triangles: 0,
            closed_convex: false,
            simplified: 0,
        };
        let mut renderer = Self { settings, memory, seams: None, latest: None };
        renderer.set_levels_of_detail(true);
        renderer.set_shader(shader)?;
        Ok(renderer)
    }

    /// Changes the shading method. All tables of the materials are computed anew, so it takes a moment.
    ///
    /// # Errors
    /// When the method cannot shade this scene; the method in use stays.
    pub fn set_shader(&mut self, shader: Shader<C>) -> Result<(), RenderError> {
        let facts = shader.facts();
        check(&self.settings.stream, facts, self.settings.perspective_correct)?;
        (self.settings.shader, self.latest) = (shader, None);
        let (stream, Memory { reflectances, ramps, error_bounds, .. }) = (&self.settings.stream, &mut self.memory);
        let tables = reflectances.iter_mut().zip(ramps.iter_mut()).zip(error_bounds.iter_mut());
        for (((reflectance, ramp), bounds), material) in tables.zip(stream.materials) {
            let highlight = (facts.highlight, facts.highlight_levels);
            reflectance.fill::<C>(stream.header, material, stream.lights, highlight);
            fill_ramp::<C>(ramp, reflectance);
            *bounds = shader.method().error_bounds(reflectance, material.exponent, stream.lights.len());
        }
        #[cfg(feature = "skips")]
        self.set_skips(self.settings.skips);
        Ok(())
    }

    /// Changes what is left out because nobody can see it; at first, all that can be. The picture is the same.
    #[cfg(feature = "skips")]
    pub fn set_skips(&mut self, skips: crate::frame::Skips) {
        self.settings.skips = skips;
        self.memory.reflectances.iter_mut().for_each(|reflectance| reflectance.leave_out(skips.highlights, skips.lights));
    }

    /// The method in use.
    #[must_use]
    pub fn shader(&self) -> Shader<C> {
        self.settings.shader
    }

    /// Turns interpolation in perspective on or off; it is off at first. Without it, light is interpolated linearly on the screen, which
    /// shows where a triangle reaches from near to far. It makes no difference to orthographic cameras.
    ///
    /// # Errors When this build or the method in use cannot interpolate in perspective; nothing changes then.
    pub fn set_perspective_correct(&mut self, on: bool) -> Result<(), RenderError> {
        if on && !cfg!(feature = "perspective") {
            return Err(RenderError::NoPerspective);
        }
        check(&self.settings.stream, self.settings.shader.facts(), on)?;
        (self.settings.perspective_correct, self.latest) = (on, None);
        Ok(())
    }

    /// Changes how far a pixel may be off from Phong shading by the method [`Shader::AUTO`], in 1/255 of full intensity; at first it is what
    /// the stream says.
    ///
    /// # Errors When it is less than [`LEAST_BUDGET`] or more than [`LARGEST_BUDGET`]; nothing changes then.
    pub fn set_budget(&mut self, budget: ErrorBudget) -> Result<(), RenderError> {
        if !(LEAST_BUDGET..=LARGEST_BUDGET).contains(&budget) {
            return Err(RenderError::Budget);
        }
        (self.settings.budget, self.latest) = (level(budget), None);
        Ok(())
    }

    /// Turns 8x8 ordered dither on or off; at first it is on in formats of one or two bits a channel.
    pub fn set_dither(&mut self, dither: bool) {
        (self.settings.dither, self.latest) = (dither, None);
    }

    /// Turns antialiasing by exact areas on or off; it is off at first.
    ///
    /// # Errors When the memory has no room for it, or this build lacks the feature `antialias`; it stays off then.
    pub fn set_antialias(&mut self, antialias: bool) -> Result<(), RenderError> {
        self.settings.antialias = false;
        if antialias && !cfg!(feature = "antialias") {
            return Err(RenderError::Antialias);
        }
        if antialias && self.memory.samples.is_empty() {
            return Err(RenderError::NoSamples);
        }
        (self.settings.antialias, self.latest) = (antialias, None);
        Ok(())
    }

    /// Turns coarser levels of meshes on or off; they are on at first, and each mesh is drawn at the coarsest level that lies less than half
    /// a pixel from it on the screen. Off, each is drawn as it is, which shows what they save. It makes no difference to streams without
    /// levels.
    pub fn set_levels_of_detail(&mut self, on: bool) {
        let Self { settings, memory, seams, latest } = self;
        *latest = None;
        // The eye is as far from a stream's meshes in all frames, so that they are chosen once.
        settings.set_tolerance(if on { tolerance(settings.stream.header, settings.size) } else { GeometricError::ZERO });
        *seams = if settings.processors > 1 { Seams::new(settings, memory) } else { None };
    }

    /// The size of the viewport.
    #[must_use]
    pub fn size(&self) -> Size {
        self.settings.size
    }

    /// Rows of a band; the last band of a frame may have fewer.
    #[must_use]
    pub fn band_rows(&self) -> u32 {
        self.settings.band_rows(self.memory.depth.len(), self.memory.samples.len())
    }

    /// Checks that a slice of pixels can be a band.
    ///
    /// # Errors When it does not hold one row of the picture.
    pub fn check_band(&self, pixels: &[C]) -> Result<(), RenderError> {
        let need = self.settings.size.width as usize;
        if pixels.len() < need { Err(RenderError::Band { need }) } else { Ok(()) }
    }

    /// Whether frame `number` is the same picture as the latest one, because the camera stands still or has come round, and no setting has
    /// changed. Where the display still shows that, it need be neither drawn nor sent.
    #[must_use]
    pub fn is_latest(&self, number: u32) -> bool {
        self.latest == Some(self.place(number))
    }

    /// Where the camera is in frame `number`: frames of one orbit differ.
    fn place(&self, number: u32) -> u32 {
        number.checked_rem(self.settings.stream.header.camera.period.into()).unwrap_or(0)
    }

    /// Places camera and lights, transforms vertices, culls and bins triangles for frame `number` (modulo the orbit).
    #[inline(never)]
    pub fn frame(&mut self, number: u32) -> Frame<'_, C> {
        self.latest = Some(self.place(number));
        Frame::new(&self.settings, &mut self.memory, number)
    }

    /// Begins frame `number` as [`Self::frame`] does, and leaves most of that to two processors: the part of the earlier triangles, which are
    /// a `share` of all, of 2^16, and that of the later ones. The picture does not depend on it. The layout has to be one for two
    /// [`Layout::processors`], and to have room for all triangles and vertices of the stream; else one part does everything.
    pub fn prepare(&mut self, number: u32, share: u16) -> Preparation<'_, C> {
        self.latest = Some(self.place(number));
        let division = self.seams.map(|seams| seams.division(&self.settings, share)).unwrap_or_default();
        Preparation::new(&self.settings, &mut self.memory, number, division)
    }
}

/// An error budget as a level, Q9.7.
fn level(budget: ErrorBudget) -> u32 {
    u32::from(budget.to_bits()) << (LEVEL - ErrorBudget::FRAC_NBITS)
}

/// Checks that a method can shade a stream, with interpolation in perspective or without.
///
/// # Errors
/// When it cannot.
pub fn check(stream: &Stream<'_>, facts: &Facts, perspective_correct: bool) -> Result<(), RenderError> {
    if !facts.near_lights && !stream.is_constant() {
        return Err(RenderError::Light { shader: facts.name });
    }
    let least = facts.highlight.least_exponent();
    if stream.materials.iter().any(|material| material.exponent < least) {
        return Err(RenderError::Exponent { shader: facts.name, least });
    }
    if perspective_correct && stream.is_perspective() && !facts.perspective {
        return Err(RenderError::Perspective { shader: facts.name });
    }
    Ok(())
}

/// A colour of 8 bits per channel in the pixel format; grey formats get its luma.
fn background<C: Pixel>([r, g, b]: [u8; 3]) -> C {
    let [r, g, b] = [u32::from(r), u32::from(g), u32::from(b)];
    let luma = (r * 77 + g * 150 + b * 29) >> 8;
    let [r, g, b] = if C::GRAY { [luma; 3] } else { [r, g, b] };
    let [dr, dg, db] = C::DEPTH;
    C::pack([r >> (8 - dr), g >> (8 - dg), b >> (8 - db)])
}
