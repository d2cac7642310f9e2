//! The one loop nest: frame, band, triangle, row.

use crate::{
    Shader, Stream,
    band::{Band, Blend},
    bin::{Bins, Entry, Walk},
    clip,
    convex::Convex,
    cull::{Extent, Facing},
    draw::Drawing,
    format::{SUBPIXEL, UNIT},
    math::vector::wide,
    palette::Palette,
    pixel::Pixel,
    raster::{edge::COLUMNS, triangle::Bounds},
    relay::{Leg, Queued, Relay},
    sample::Sample,
    scene::{Direction, Lighting, Pose},
    shade::Shading,
    shader::VertexLight,
    stream::record::{Mesh, Triangle, Vertex},
    vertex::{ScreenVertex, State, View},
};
use core::{fmt, ops::Range};
use embedded_graphics_core::{
    geometry::{Point, Size},
    primitives::Rectangle,
};

/// The memory that rendering takes, borrowed from wherever a program keeps it.
#[derive(Debug)]
pub struct Memory<'a, C> {
    /// Transformed vertices; those that do not fit are transformed anew by each triangle.
    pub vertices: &'a mut [ScreenVertex],
    /// Triangles that face the camera; where they do not fit, each band walks the whole mesh.
    pub bins: &'a mut [Entry],
    /// Depth of one band; its length decides how many rows a band has.
    pub depth: &'a mut [u16],
    /// One per material.
    pub palettes: &'a mut [Palette<C>],
    /// For antialiasing as many as [`Self::depth`], or bands have fewer rows; none without it.
    pub samples: &'a mut [Sample],
    /// What bands hand on to the next: as many as triangles reach across a border. Those that do not fit are set up anew.
    pub legs: &'a mut [Leg],
}

/// [`Memory`] in one piece, for a `static`.
#[derive(Debug)]
pub struct Workspace<
    C,
    const VERTICES: usize,
    const TRIANGLES: usize,
    const DEPTH: usize,
    const MATERIALS: usize,
    const LEGS: usize = 0,
    const SAMPLES: usize = 0,
> {
    vertices: [ScreenVertex; VERTICES],
    bins: [Entry; TRIANGLES],
    depth: [u16; DEPTH],
    palettes: [Palette<C>; MATERIALS],
    samples: [Sample; SAMPLES],
    legs: [Leg; LEGS],
}

impl<
    C: Pixel,
    const VERTICES: usize,
    const TRIANGLES: usize,
    const DEPTH: usize,
    const MATERIALS: usize,
    const LEGS: usize,
    const SAMPLES: usize,
> Workspace<C, VERTICES, TRIANGLES, DEPTH, MATERIALS, LEGS, SAMPLES>
{
    /// Empty memory; `colour` is any colour. With black it is all zeros: a `static` then takes no flash.
    #[must_use]
    pub const fn new(colour: C) -> Self {
        Self {
            vertices: [ScreenVertex::EMPTY; VERTICES],
            bins: [Entry::EMPTY; TRIANGLES],
            depth: [0; DEPTH],
            palettes: [Palette::filled(colour); MATERIALS],
            samples: [Sample::EMPTY; SAMPLES],
            legs: [Leg::EMPTY; LEGS],
        }
    }

    /// Lends the memory to a [`Renderer`].
    pub fn memory(&mut self) -> Memory<'_, C> {
        Memory {
            vertices: &mut self.vertices,
            bins: &mut self.bins,
            depth: &mut self.depth,
            palettes: &mut self.palettes,
            samples: &mut self.samples,
            legs: &mut self.legs,
        }
    }
}

/// Why a renderer cannot start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SetupError {
    /// The viewport is empty or larger than [`MAX_SIDE`] on a side.
    Size {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
    },
    /// `depth` does not hold one row.
    Depth {
        /// Entries needed at least.
        need: usize,
    },
    /// Fewer palettes than materials.
    Palettes {
        /// Palettes needed.
        need: usize,
    },
    /// `samples` does not hold one row, and antialiasing needs it.
    Samples {
        /// Samples needed at least.
        need: usize,
    },
    /// Antialiasing is not part of this build.
    Antialias,
    /// The method is not part of this build.
    Missing {
        /// The method's name.
        shader: &'static str,
    },
    /// The method cannot shade under near lights or for a near viewer.
    Light {
        /// The method's name.
        shader: &'static str,
    },
    /// The method cannot interpolate in perspective.
    Perspective {
        /// The method's name.
        shader: &'static str,
    },
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { width, height } => write!(f, "a picture of {width}x{height} pixels; each side must be 1 to {MAX_SIDE}"),
            Self::Depth { need } => write!(f, "the depth buffer needs {need} entries at least, one row"),
            Self::Palettes { need } => write!(f, "the stream has {need} materials, and each needs a palette"),
            Self::Samples { need } => write!(f, "antialiasing needs {need} samples at least, one row"),
            Self::Antialias => f.write_str("this build cannot antialias; build it with the feature antialias"),
            Self::Missing { shader } => write!(f, "this build has no {shader} shading; build it with the feature all-shaders"),
            Self::Light { shader } => {
                write!(f, "{shader} shading needs directional lights and an infinitely far viewer; this scene has near ones")
            }
            Self::Perspective { shader } => write!(f, "{shader} shading has no perspective-correct form"),
        }
    }
}

impl core::error::Error for SetupError {}

/// Largest width and height of a viewport.
pub const MAX_SIDE: u32 = COLUMNS - 1;

/// What a frame took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Stats {
    /// Triangles in the stream.
    pub triangles: u32,
    /// The others: they face away, or no pixel centre of the viewport lies in their box.
    pub culled: u32,
    /// Triangles that are handed to the rasterizer: their box contains a pixel centre of the viewport.
    pub drawn: u32,
    /// Pixels of all drawn triangles, those hidden by depth included; stays at its largest value instead of overflowing.
    pub pixels: u32,
    /// Walks over the mesh: 1, or one per band when the bins overflow.
    pub passes: u32,
    /// Vertices that did not fit and were transformed by each triangle that uses them.
    pub uncached: u32,
}

/// Draws the frames of one stream.
#[derive(Debug)]
pub struct Renderer<'a, C> {
    stream: Stream<'a>,
    size: Size,
    memory: Memory<'a, C>,
    shader: Shader,
    dither: bool,
    perspective_correct: bool,
    antialias: bool,
    background: C,
}

impl<'a, C: Pixel> Renderer<'a, C> {
    /// A renderer for a viewport of `size` pixels, with the method that the stream asks for.
    ///
    /// # Errors
    /// When `size` is out of range, `memory` too small for it, or the method cannot shade the scene here.
    pub fn new(stream: Stream<'a>, size: Size, memory: Memory<'a, C>) -> Result<Self, SetupError> {
        Self::with_shader(stream, size, memory, stream.shader())
    }

    /// As [`Self::new`], with another method than the stream's.
    ///
    /// # Errors
    /// Likewise.
    pub fn with_shader(stream: Stream<'a>, size: Size, memory: Memory<'a, C>, shader: Shader) -> Result<Self, SetupError> {
        let (width, height) = (size.width, size.height);
        if !(1..=MAX_SIDE).contains(&width) || !(1..=MAX_SIDE).contains(&height) {
            return Err(SetupError::Size { width, height });
        }
        if memory.depth.len() < width as usize {
            return Err(SetupError::Depth { need: width as usize });
        }
        if memory.palettes.len() < stream.materials.len() {
            return Err(SetupError::Palettes { need: stream.materials.len() });
        }
        let background = background(stream.header.background);
        let mut renderer = Self { stream, size, memory, shader, dither: false, perspective_correct: false, antialias: false, background };
        renderer.set_shader(shader)?;
        Ok(renderer)
    }

    /// Uses `shader` instead of the one that the stream asks for. Works out the materials, so it takes a moment.
    ///
    /// # Errors
    /// When this build has not got the method, or it cannot shade this scene; the method in use stays.
    pub fn set_shader(&mut self, shader: Shader) -> Result<(), SetupError> {
        check(&self.stream, shader, self.perspective_correct)?;
        self.shader = shader;
        for (palette, material) in self.memory.palettes.iter_mut().zip(self.stream.materials) {
            palette.fill(self.stream.header, material, self.stream.lights, shader.highlight(), shader.walks_levels());
        }
        Ok(())
    }

    /// The method in use.
    #[must_use]
    pub fn shader(&self) -> Shader {
        self.shader
    }

    /// Interpolation in perspective on or off; off at first. Without it triangles are shaded as if they were flat on the
    /// screen, which shows where one of them reaches from near to far. Parallel rays make no difference.
    ///
    /// # Errors
    /// When this build, or the method in use, cannot do it; all stays as it was.
    pub fn set_perspective_correct(&mut self, on: bool) -> Result<(), SetupError> {
        check(&self.stream, self.shader, on)?;
        self.perspective_correct = on;
        Ok(())
    }

    /// 4x4 ordered dither on or off; off at first.
    pub fn set_dither(&mut self, dither: bool) {
        self.dither = dither;
    }

    /// Antialiasing by exact areas on or off, see [`crate::raster::smooth`]; off at first.
    ///
    /// # Errors
    /// When `samples` does not hold a row, or this build has not got the feature `antialias`; it stays off then.
    pub fn set_antialias(&mut self, antialias: bool) -> Result<(), SetupError> {
        let need = self.size.width as usize;
        self.antialias = false;
        if antialias && !cfg!(feature = "antialias") {
            return Err(SetupError::Antialias);
        }
        if antialias && self.memory.samples.len() < need {
            return Err(SetupError::Samples { need });
        }
        self.antialias = antialias;
        Ok(())
    }

    #[inline(always)]
    fn antialiased(&self) -> bool {
        cfg!(feature = "antialias") && self.antialias
    }

    fn viewport(&self) -> Viewport {
        Viewport { width: self.size.width as i32, height: self.size.height as i32, antialiased: self.antialiased() }
    }

    /// The viewport.
    #[must_use]
    pub fn size(&self) -> Size {
        self.size
    }

    /// Rows of a band; the last one of a frame may have fewer.
    #[must_use]
    pub fn band_rows(&self) -> u32 {
        let Memory { depth, samples, .. } = &self.memory;
        let pixels = if self.antialiased() { depth.len().min(samples.len()) } else { depth.len() };
        (pixels as u32).checked_div(self.size.width).unwrap_or(0).min(self.size.height)
    }

    /// Places camera and lights, transforms vertices, culls and bins triangles for frame `number` (modulo the orbit).
    #[inline(never)]
    pub fn frame(&mut self, number: u32) -> Frame<'_, 'a, C> {
        let camera = &self.stream.header.camera;
        let pose = Pose::new(camera, number);
        let lighting = Lighting::new(&self.stream, &pose);
        let constant = lighting.constant();
        let view = View::new(camera, &pose, self.size);
        let mut frame = Frame {
            facing: Facing::new(&view, self.stream.header.radius),
            view,
            lighting,
            constant,
            directions: constant.map(|constant| constant.map(Direction::new)),
            convex: None,
            bins: Bins::new(self.size.height, self.band_rows()),
            binned: false,
            queued: Queued::default(),
            rows: 0..self.size.height,
            top: 0,
            bottom: self.size.height,
            stats: Stats { triangles: self.stream.triangles.len() as u32, ..Stats::default() },
            renderer: self,
        };
        frame.prepare();
        frame
    }
}

/// Whether `shader` can shade a stream, in perspective or without.
///
/// # Errors
/// When this build has not got the method, or it cannot do it.
pub fn check(stream: &Stream<'_>, shader: Shader, perspective_correct: bool) -> Result<(), SetupError> {
    if !shader.is_built_in() {
        return Err(SetupError::Missing { shader: shader.name() });
    }
    if shader.needs_constant_light() && !stream.is_constant() {
        return Err(SetupError::Light { shader: shader.name() });
    }
    if perspective_correct && !cfg!(feature = "all-shaders") {
        return Err(SetupError::Missing { shader: "perspective-correct" });
    }
    if perspective_correct && stream.is_perspective() && !shader.has_perspective() {
        return Err(SetupError::Perspective { shader: shader.name() });
    }
    Ok(())
}

/// A colour of 8 bits per channel in the output's format, grey by its luma.
fn background<C: Pixel>([r, g, b]: [u8; 3]) -> C {
    let luma = ((u32::from(r) * 77 + u32::from(g) * 150 + u32::from(b) * 29) >> 8) as u8;
    let [r, g, b] = if C::GRAY { [luma; 3] } else { [r, g, b] };
    let [dr, dg, db] = C::DEPTH;
    C::pack([r >> (8 - dr), g >> (8 - dg), b >> (8 - db)])
}

/// One frame, drawn band by band from the top.
#[derive(Debug)]
pub struct Frame<'r, 'a, C> {
    renderer: &'r mut Renderer<'a, C>,
    view: View,
    facing: Facing,
    lighting: Lighting,
    /// See [`Lighting::constant`].
    constant: Option<[[i32; 3]; 2]>,
    /// The same, for products with vertex normals.
    directions: Option<[Direction; 2]>,
    /// Where triangles may overlap, if not everywhere.
    convex: Option<Convex>,
    bins: Bins,
    /// All triangles found room in the bins.
    binned: bool,
    /// What the last band has handed on.
    queued: Queued,
    /// Those that triangles may reach.
    rows: Range<u32>,
    /// First row of the next band.
    top: u32,
    /// One past the last row to be drawn.
    bottom: u32,
    stats: Stats,
}

impl<C: Pixel> Frame<'_, '_, C> {
    /// Draws the next band into the front of `pixels`, row by row, and returns the area that it fills; `None` after the last.
    ///
    /// The first `area.size.width * area.size.height` entries of `pixels` are the band.
    /// A slice shorter than a band gets fewer rows; one shorter than a row of the viewport draws nothing, and `None` comes first.
    pub fn next_band(&mut self, pixels: &mut [C]) -> Option<Rectangle> {
        let size = self.renderer.size;
        let fit = u32::try_from(pixels.len()).unwrap_or(u32::MAX).checked_div(size.width)?;
        // Bands end where bins end.
        let band_rows = self.renderer.band_rows();
        let rows = band_rows.saturating_sub(self.top.checked_rem(band_rows)?).min(self.bottom.saturating_sub(self.top)).min(fit);
        if rows == 0 {
            return None;
        }
        let area = Rectangle::new(Point::new(0, self.top as i32), Size::new(size.width, rows));
        self.draw(pixels.get_mut(..(rows * size.width) as usize)?, rows);
        self.top += rows;
        Some(area)
    }

    /// Rows that have anything but background, and maybe some that have not.
    #[must_use]
    pub fn rows(&self) -> Range<u32> {
        self.rows.clone()
    }

    /// Draws no other than these `rows`; to be called before the first band. What a display shows of the frame before and what this one
    /// has, see [`Self::rows`], is all that must be drawn and sent: the rest is background already.
    pub fn limit(&mut self, rows: Range<u32>) {
        let height = self.renderer.size.height;
        (self.top, self.bottom) = (rows.start.min(height), rows.end.min(height));
    }

    /// No band follows.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.top >= self.bottom
    }

    /// Counts so far; complete after the last band.
    #[must_use]
    pub fn stats(&self) -> Stats {
        Stats { culled: self.stats.triangles.saturating_sub(self.stats.drawn), ..self.stats }
    }

    /// Everything that happens once: which triangles face the camera, where their vertices are, which rows they start in.
    /// From the last triangle to the first, as [`Bins::push`] wants it.
    #[inline(never)]
    fn prepare(&mut self) {
        // A copy, which stays in registers.
        let facing = self.facing;
        let Self { renderer, view, lighting, directions, convex, bins, stats, rows, .. } = self;
        let viewport = renderer.viewport();
        let Renderer { stream, memory: Memory { vertices: cache, bins: entries, palettes, .. }, shader, size, .. } = &mut **renderer;
        let entries = &mut **entries;
        if !viewport.antialiased {
            *convex = Convex::new(stream, view, *size);
        }
        let leaning = if convex.is_some() { facing.leaning() } else { Facing::FRONT };
        cache.iter_mut().take(stream.vertices.len()).for_each(|vertex| vertex.state = State::Idle);
        for mesh in stream.meshes.iter().rev() {
            let (vertices, triangles) = (stream.vertices_of(mesh).unwrap_or_default(), stream.triangles_of(mesh).unwrap_or_default());
            let Some(palette) = palettes.get(usize::from(mesh.material)) else { continue };
            let light = shader.vertex_light(directions.is_some());
            let stage = Stage { view, lighting, constant: directions.as_ref(), palette, light };
            let cached = cache.get_mut(mesh.first_vertex as usize..).unwrap_or_default();
            let (first, mut rest) = (mesh.first_triangle, triangles);
            while let [before @ .., triangle] = rest {
                rest = before;
                let height = facing.height(triangle);
                if height < leaning {
                    continue;
                }
                let mut simple = false;
                let bounds = match stage.corners(cached, vertices, triangle) {
                    Some(corners) => {
                        let extent = Extent::new(corners);
                        if let Some(convex) = convex {
                            convex.see(&extent);
                        }
                        simple = viewport.is_simple(&extent);
                        viewport.bounds(&extent)
                    }
                    None => {
                        *convex = None;
                        stage.bounds(viewport, vertices, triangle)
                    }
                };
                if let Some(Bounds { top, bottom, .. }) = bounds
                    && height >= Facing::FRONT
                {
                    bins.push(entries, first + rest.len() as u32, simple, [top as u32, bottom as u32]);
                }
            }
        }
        stats.uncached = stream.vertices.len().saturating_sub(cache.len()) as u32;
        if let Some(count) = bins.count() {
            self.binned = true;
            (stats.passes, stats.drawn) = (1, count.into());
            *rows = bins.rows();
        }
    }

    /// What takes vertices of `mesh` to the screen.
    fn stage(&self, mesh: &Mesh) -> Option<Stage<'_, C>> {
        let Self { renderer, view, lighting, directions, .. } = self;
        let light = renderer.shader.vertex_light(directions.is_some());
        let palette = renderer.memory.palettes.get(usize::from(mesh.material))?;
        Some(Stage { view, lighting, constant: directions.as_ref(), palette, light })
    }

    /// The mesh of triangle `id`.
    fn mesh(&self, id: u32) -> Option<&'_ Mesh> {
        // The meshes follow one another: the last one that does not start behind the triangle.
        self.renderer.stream.meshes.iter().rev().find(|mesh| mesh.first_triangle <= id && mesh.triangles > 0)
    }

    /// Clears a band of `rows` rows and draws what falls into it.
    #[inline(never)]
    fn draw(&mut self, pixels: &mut [C], rows: u32) {
        let width = self.renderer.size.width as usize;
        let bottom = self.top + rows;
        // The depth buffer is lent to the band, the rest of the frame stays readable.
        let depth = core::mem::take(&mut self.renderer.memory.depth);
        let samples = core::mem::take(&mut self.renderer.memory.samples);
        let count = width * rows as usize;
        let legs = core::mem::take(&mut self.renderer.memory.legs);
        let lent = depth.get_mut(..count).unwrap_or_default();
        let relay = Relay::new(legs, self.queued);
        let blend =
            self.renderer.antialiased().then(|| Blend { samples: samples.get_mut(..count).unwrap_or_default(), channels: C::channels });
        let mut band = Band { pixels, depth: lent, width, top: self.top as i32, rows: rows as i32, blend, relay };
        band.clear(self.renderer.background);
        let (pixels, drawn) = if self.binned {
            let entries = core::mem::take(&mut self.renderer.memory.bins);
            let mut walk = self.bins.band(entries, bottom);
            let pixels = self.draw_binned(&mut walk, &mut band);
            self.bins.take_over(walk);
            self.renderer.memory.bins = entries;
            (pixels, 0)
        } else {
            self.stats.passes += 1;
            self.draw_all(&mut band)
        };
        self.stats.pixels = self.stats.pixels.saturating_add(pixels);
        self.stats.drawn += drawn;
        if self.renderer.antialiased() {
            band.resolve(self.renderer.background);
        }
        self.queued = band.relay.queued();
        self.renderer.memory.legs = legs;
        self.renderer.memory.depth = depth;
        self.renderer.memory.samples = samples;
    }

    /// Draws the triangles of `band`; returns their pixels there.
    fn draw_binned(&self, walk: &mut Walk<'_>, band: &mut Band<'_, C>) -> u32 {
        let stream = &self.renderer.stream;
        let mut pixels = 0u32;
        let mut next = walk.next();
        while let Some(entry) = next {
            // A stream that has been checked has both.
            let Some(mesh) = self.mesh(entry.triangle()) else { break };
            let Some(drawing) = self.drawing(mesh) else { break };
            let end = mesh.first_triangle.saturating_add(mesh.triangles);
            let (drawn, rest) = drawing.run(stream.triangles, entry, walk, end, band);
            pixels = pixels.saturating_add(drawn);
            next = rest;
        }
        pixels
    }

    /// Draws all triangles into `band`; returns their pixels there, and how many of them start there.
    #[cold]
    #[inline(never)]
    fn draw_all(&self, band: &mut Band<'_, C>) -> (u32, u32) {
        let stream = &self.renderer.stream;
        let (mut pixels, mut drawn) = (0u32, 0);
        for mesh in stream.meshes {
            let Some(drawing) = self.drawing(mesh) else { continue };
            for triangle in stream.triangles_of(mesh).unwrap_or_default().iter().filter(|triangle| self.facing.may_face(triangle)) {
                let Some(bounds) = drawing.bounds(triangle) else { continue };
                // Counted in the band where it starts.
                let bottom = band.top + band.rows;
                drawn += u32::from((band.top..bottom).contains(&bounds.top));
                if bounds.bottom > band.top && bounds.top < bottom {
                    pixels = pixels.saturating_add(drawing.draw(triangle, band));
                }
            }
        }
        (pixels, drawn)
    }

    /// What it takes to draw the triangles of `mesh`.
    #[inline(never)]
    fn drawing(&self, mesh: &Mesh) -> Option<Drawing<'_, C>> {
        let Renderer { stream, memory, shader, dither, .. } = &*self.renderer;
        let shading = Shading {
            shader: *shader,
            dither: *dither,
            palette: memory.palettes.get(usize::from(mesh.material))?,
            lighting: &self.lighting,
            #[cfg(feature = "all-shaders")]
            exponent: stream.materials.get(usize::from(mesh.material))?.exponent,
            constant: self.constant,
            directions: self.directions,
        };
        Some(Drawing {
            shading,
            stage: self.stage(mesh)?,
            convex: self.convex.as_ref(),
            vertices: stream.vertices_of(mesh)?,
            kept: memory.vertices.get(mesh.first_vertex as usize..).unwrap_or_default(),
            viewport: self.renderer.viewport(),
            #[cfg(feature = "all-shaders")]
            perspective: self.renderer.perspective_correct && stream.is_perspective(),
        })
    }
}

/// A viewport, as culling sees it.
#[derive(Clone, Copy)]
pub(crate) struct Viewport {
    width: i32,
    height: i32,
    pub(crate) antialiased: bool,
}

impl Viewport {
    /// The visible box of a triangle; `None` if it shows its back, or no pixel can belong to it.
    #[inline(always)]
    pub(crate) fn bounds(self, extent: &Extent) -> Option<Bounds> {
        if extent.area <= 0 {
            return None;
        }
        self.visible(if self.antialiased {
            Bounds::touched([[extent.left, extent.top, 0], [extent.right, extent.bottom, 0]].into_iter())
        } else {
            Bounds::new(extent)
        })
    }

    /// A triangle whose corners are kept, small and not beside the viewport: there is a shorter way to draw it.
    #[inline(always)]
    pub(crate) fn is_simple(self, extent: &Extent) -> bool {
        !self.antialiased && extent.left >= 0 && extent.right < self.width << SUBPIXEL && extent.is_small()
    }

    /// The visible box of what clipping leaves of a triangle.
    #[cold]
    #[inline(never)]
    fn clipped_bounds(self, view: &View, vertices: [&Vertex; 3]) -> Option<Bounds> {
        let polygon = clip::clip(view, vertices);
        let mut corners = polygon.iter().map(|cut| view.project(cut.eye).0);
        if self.antialiased {
            return self.visible(Bounds::touched(corners));
        }
        let mut bounds = Bounds::at(corners.next()?);
        corners.for_each(|corner| bounds.include(corner));
        self.visible(bounds)
    }

    /// The visible box of a triangle, on a grid finer by 2 to the power `finer`.
    pub(crate) fn box_of(self, corners: [&ScreenVertex; 3], finer: u32) -> [i32; 4] {
        let extent = Extent::new(corners.map(|corner| [corner.x, corner.y]));
        Bounds::new(&extent).clipped(self.width << finer, self.height << finer).sides()
    }

    #[inline(always)]
    fn visible(self, bounds: Bounds) -> Option<Bounds> {
        let bounds = bounds.clipped(self.width, self.height);
        (!bounds.is_empty()).then_some(bounds)
    }
}

/// What takes the vertices of one mesh to the screen in one frame.
pub(crate) struct Stage<'f, C> {
    pub(crate) view: &'f View,
    lighting: &'f Lighting,
    /// See [`Lighting::constant`].
    constant: Option<&'f [Direction; 2]>,
    palette: &'f Palette<C>,
    /// What the method wants to know of it at vertices.
    light: VertexLight,
}

impl<C: Pixel> Stage<'_, C> {
    /// The corners' `[x, y]` on the screen, turning clockwise, against the stream's order; `None` if one is not kept or off
    /// the screen.
    #[inline(always)]
    fn corners(&self, cached: &mut [ScreenVertex], vertices: &[Vertex], triangle: &Triangle) -> Option<[[i32; 2]; 3]> {
        let [a, b, c] = triangle.corners;
        let mut place = |corner| self.place(cached, vertices, corner);
        Some([place(a)?, place(c)?, place(b)?])
    }

    /// Where `corner` is on the screen; it is transformed when it is first asked for.
    #[inline(always)]
    fn place(&self, cached: &mut [ScreenVertex], vertices: &[Vertex], corner: u16) -> Option<[i32; 2]> {
        let screen = cached.get_mut(usize::from(corner))?;
        if screen.state != State::Ready {
            if screen.state == State::Idle {
                *screen = self.transform(vertices.get(usize::from(corner))?);
            }
            if screen.state != State::Ready {
                return None;
            }
        }
        Some([screen.x, screen.y])
    }

    /// Transforms a vertex, and lights it if the method needs that.
    #[inline(never)]
    pub(crate) fn transform(&self, vertex: &Vertex) -> ScreenVertex {
        let ([x, y, depth], inside) = self.view.project(self.view.to_eye(vertex.position));
        let normal = wide(vertex.normal);
        let light = match (self.light, self.constant) {
            (VertexLight::None, _) => [0; 3],
            (light, Some([towards, half])) => {
                let [diffuse, half] = [towards.cosine(normal), half.cosine(normal)];
                if light == VertexLight::Levels { self.palette.one_light([diffuse, half]) } else { [diffuse, half, 0] }
            }
            (_, None) => self.palette.levels(self.lighting.cosines(wide(vertex.position), normal.map(|c| c << (30 - UNIT)))),
        };
        ScreenVertex { x, y, depth, light, state: if inside { State::Ready } else { State::Outside } }
    }

    /// The visible box of a triangle that has a corner off the screen, or one that is not kept.
    #[cold]
    #[inline(never)]
    pub(crate) fn bounds(&self, viewport: Viewport, vertices: &[Vertex], triangle: &Triangle) -> Option<Bounds> {
        let [a, b, c] = triangle.corners.map(|corner| vertices.get(usize::from(corner)));
        // Against the stream's order.
        let vertices = [a?, c?, b?];
        let corners = vertices.map(|vertex| self.transform(vertex));
        if corners.iter().all(|corner| corner.state == State::Ready) {
            viewport.bounds(&Extent::new(corners.map(|corner| [corner.x, corner.y])))
        } else {
            viewport.clipped_bounds(self.view, vertices)
        }
    }
}
