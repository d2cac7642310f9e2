//! One frame, drawn band by band.

use crate::{
    Stream,
    error::RenderError,
    geometry::{
        bin::{Bins, Walk},
        cull::{Extent, Facing},
        depth_elision::DepthElision,
        pose::Pose,
        projection::{State, View},
        viewport::{Bounds, Viewport},
    },
    lighting::{lights::Lighting, materials::MaterialTables},
    memory::Memory,
    mesh::{MeshPass, vertices::VertexStage},
    method::{Shading, Style},
    pixel::Pixel,
    raster::{
        active::{ActiveTriangles, QueueState},
        band::{Band, Blend},
    },
    shader::{Shader, TriangleLoops},
    stream::record::Mesh,
};
use core::ops::Range;
use embedded_graphics_core::{
    geometry::{Point, Size},
    primitives::Rectangle,
};

/// Counts of one frame: triangles, pixels, and what did not fit into memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Stats {
    /// Triangles in the stream.
    pub triangles: u32,
    /// Triangles that face away, or whose bounding box contains no pixel centre of the viewport.
    pub culled: u32,
    /// Triangles that are drawn: they face the camera, and their bounding box contains a pixel centre of the viewport.
    pub drawn: u32,
    /// Pixels of all drawn triangles, those hidden by depth included; stays at its largest value instead of overflowing.
    pub pixels: u32,
    /// Walks over the mesh: 1, or one per band when the bins overflow.
    pub passes: u32,
    /// Vertices that did not fit and were transformed by each triangle that uses them.
    pub uncached: u32,
    /// How often a triangle that reaches into the next band found no room among the active triangles, and was set up anew there.
    pub set_up_anew: u32,
}

/// What a renderer keeps from frame to frame.
#[derive(Debug)]
pub(crate) struct RenderState<'a, C: Pixel> {
    pub(crate) stream: Stream<'a>,
    pub(crate) size: Size,
    pub(crate) memory: Memory<'a, C>,
    pub(crate) shader: Shader<C>,
    pub(crate) dither: bool,
    pub(crate) perspective_correct: bool,
    pub(crate) antialias: bool,
    pub(crate) background: C,
}

impl<C: Pixel> RenderState<'_, C> {
    #[inline(always)]
    fn antialiased(&self) -> bool {
        cfg!(feature = "antialias") && self.antialias
    }

    fn viewport(&self) -> Viewport {
        Viewport { width: self.size.width as i32, height: self.size.height as i32, antialiased: self.antialiased() }
    }

    /// Rows of a band; the last one of a frame may have fewer.
    pub(crate) fn band_rows(&self) -> u32 {
        let Memory { depth, samples, .. } = &self.memory;
        let pixels = if self.antialiased() { depth.len().min(samples.len()) } else { depth.len() };
        (pixels as u32).checked_div(self.size.width).unwrap_or(0).min(self.size.height)
    }
}

/// One frame, drawn band by band from the top.
#[derive(Debug)]
pub struct Frame<'r, 'a, C: Pixel> {
    state: &'r mut RenderState<'a, C>,
    view: View,
    facing: Facing,
    lighting: Lighting,
    /// See [`Lighting::constant`].
    constant: Option<[[i32; 3]; 2]>,
    /// Where triangles may overlap; `None` if they may do so everywhere.
    depth_elision: Option<DepthElision>,
    bins: Bins,
    /// All triangles found room in the bins.
    binned: bool,
    /// Active triangles that the last band has saved.
    queue: QueueState,
    /// Rows that triangles may reach.
    rows: Range<u32>,
    /// First row of the next band.
    top: u32,
    /// One past the last row to be drawn.
    bottom: u32,
    stats: Stats,
}

impl<'r, 'a, C: Pixel> Frame<'r, 'a, C> {
    /// Frame `number` of a renderer.
    #[inline(never)]
    pub(crate) fn new(state: &'r mut RenderState<'a, C>, number: u32) -> Self {
        let camera = &state.stream.header.camera;
        let pose = Pose::new(camera, number);
        let lighting = Lighting::new(&state.stream, &pose);
        let constant = lighting.constant();
        let view = View::new(camera, &pose, state.size);
        let mut frame = Frame {
            facing: Facing::new(&view, state.stream.header.radius),
            view,
            lighting,
            constant,
            depth_elision: None,
            bins: Bins::new(state.size.height, state.band_rows()),
            binned: false,
            queue: QueueState::default(),
            rows: 0..state.size.height,
            top: 0,
            bottom: state.size.height,
            stats: Stats { triangles: state.stream.triangles.len() as u32, ..Stats::default() },
            state,
        };
        frame.prepare();
        frame
    }
}

impl<C: Pixel> Frame<'_, '_, C> {
    /// Draws the next band into the front of `pixels`, row by row, and returns the area that it fills; `None` after the last.
    ///
    /// The first `area.size.width * area.size.height` entries of `pixels` are the band. A slice shorter than a band gets fewer rows.
    ///
    /// # Errors
    /// When `pixels` does not hold one row.
    pub fn next_band(&mut self, pixels: &mut [C]) -> Result<Option<Rectangle>, RenderError> {
        let size = self.state.size;
        let fit = u32::try_from(pixels.len()).unwrap_or(u32::MAX).checked_div(size.width).unwrap_or(0);
        if fit == 0 {
            return Err(RenderError::Band { need: size.width as usize });
        }
        // Bands end where bins end.
        let band_rows = self.state.band_rows();
        let into = self.top.checked_rem(band_rows).unwrap_or(0);
        let rows = band_rows.saturating_sub(into).min(self.bottom.saturating_sub(self.top)).min(fit);
        if rows == 0 {
            return Ok(None);
        }
        let area = Rectangle::new(Point::new(0, self.top as i32), Size::new(size.width, rows));
        self.draw(pixels.get_mut(..(rows * size.width) as usize).unwrap_or_default(), rows);
        self.top += rows;
        Ok(Some(area))
    }

    /// The rows that triangles can reach; all other rows are background.
    #[must_use]
    pub fn rows(&self) -> Range<u32> {
        self.rows.clone()
    }

    /// Draws only these `rows`; to be called before the first band. It is enough to draw and send the rows that triangles reach in this
    /// frame or reached in the frame before, see [`Self::rows`]: a display that shows the frame before has background in all others.
    pub fn limit(&mut self, rows: Range<u32>) {
        let height = self.state.size.height;
        (self.top, self.bottom) = (rows.start.min(height), rows.end.min(height));
    }

    /// Whether the last band has been drawn.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.top >= self.bottom
    }

    /// The counts so far; they are complete after the last band.
    #[must_use]
    pub fn stats(&self) -> Stats {
        Stats { culled: self.stats.triangles.saturating_sub(self.stats.drawn), ..self.stats }
    }

    /// Does what happens once a frame: culls triangles, transforms their vertices, and puts them into the bins of the rows that they start
    /// in. Triangles are taken from the last to the first, in the order that [`Bins::push`] needs.
    #[inline(never)]
    fn prepare(&mut self) {
        // A copy, which stays in registers.
        let facing = self.facing;
        let Self { state, view, lighting, constant, depth_elision, bins, stats, rows, .. } = self;
        let viewport = state.viewport();
        let RenderState { stream, memory: Memory { vertices: cache, bins: entries, reflectances, .. }, shader, size, .. } = &mut **state;
        let entries = &mut **entries;
        if !viewport.antialiased {
            *depth_elision = DepthElision::new(stream, view, *size);
        }
        let leaning = if depth_elision.is_some() { facing.leaning() } else { Facing::FRONT };
        cache.iter_mut().take(stream.vertices.len()).for_each(|vertex| vertex.state = State::IDLE);
        for mesh in stream.meshes.iter().rev() {
            let (vertices, triangles) = (stream.vertices_of(mesh).unwrap_or_default(), stream.triangles_of(mesh).unwrap_or_default());
            let Some(reflectance) = reflectances.get(usize::from(mesh.material)) else { continue };
            let light = shader.facts().vertex_light;
            let stage = VertexStage { view, lighting, constant: constant.as_ref(), reflectance, light };
            let cached = cache.get_mut(mesh.first_vertex as usize..).unwrap_or_default();
            let (first, mut rest) = (mesh.first_triangle, triangles);
            while let [before @ .., triangle] = rest {
                rest = before;
                let height = facing.height(triangle);
                if height < leaning {
                    continue;
                }
                let mut word_sized = false;
                let bounds = match stage.corners(cached, vertices, triangle) {
                    Some(corners) => {
                        let extent = Extent::new(corners);
                        if let Some(elision) = depth_elision {
                            elision.include(&extent);
                        }
                        word_sized = viewport.is_word_sized(&extent);
                        viewport.bounds(&extent)
                    }
                    None => {
                        *depth_elision = None;
                        stage.bounds(viewport, vertices, triangle)
                    }
                };
                if let Some(Bounds { top, bottom, .. }) = bounds
                    && height >= Facing::FRONT
                {
                    bins.push(entries, first + rest.len() as u32, word_sized, [top as u32, bottom as u32]);
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

    /// The stage that transforms and lights the vertices of `mesh`.
    fn stage(&self, mesh: &Mesh) -> Option<VertexStage<'_>> {
        let Self { state, view, lighting, constant, .. } = self;
        let light = state.shader.facts().vertex_light;
        let reflectance = state.memory.reflectances.get(usize::from(mesh.material))?;
        Some(VertexStage { view, lighting, constant: constant.as_ref(), reflectance, light })
    }

    /// The mesh of triangle `id`.
    fn mesh(&self, id: u32) -> Option<&'_ Mesh> {
        // Meshes follow one another without a gap, so this is the last one that does not start behind the triangle. A stream may have
        // 65,535 meshes: they are searched by halves.
        let meshes = self.state.stream.meshes;
        meshes.get(meshes.partition_point(|mesh| mesh.first_triangle <= id).wrapping_sub(1))
    }

    /// Clears a band of `rows` rows and draws what falls into it.
    #[inline(never)]
    fn draw(&mut self, pixels: &mut [C], rows: u32) {
        let width = self.state.size.width as usize;
        let bottom = self.top + rows;
        // The depth buffer is lent to the band, the rest of the frame stays readable.
        let depth = core::mem::take(&mut self.state.memory.depth);
        let samples = core::mem::take(&mut self.state.memory.samples);
        let count = width * rows as usize;
        let active_triangles = core::mem::take(&mut self.state.memory.active_triangles);
        let lent = depth.get_mut(..count).unwrap_or_default();
        let active = ActiveTriangles::new(active_triangles, self.queue);
        let blend = self.state.antialiased().then(|| Blend { samples: samples.get_mut(..count).unwrap_or_default() });
        let mut band = Band { pixels, depth: lent, width, top: self.top as i32, rows: rows as i32, blend, active };
        band.clear(self.state.background, self.rows.clone());
        let (pixels, drawn) = if self.binned {
            let entries = core::mem::take(&mut self.state.memory.bins);
            let mut walk = self.bins.band(entries, bottom);
            let pixels = self.draw_binned(&mut walk, &mut band);
            self.bins.take_over(walk);
            self.state.memory.bins = entries;
            (pixels, 0)
        } else {
            self.stats.passes += 1;
            self.draw_all(&mut band)
        };
        self.stats.pixels = self.stats.pixels.saturating_add(pixels);
        self.stats.drawn += drawn;
        if self.state.antialiased() {
            band.resolve(self.state.background);
        }
        self.queue = band.active.queue();
        self.stats.set_up_anew = self.stats.set_up_anew.saturating_add(band.active.overflow());
        self.state.memory.active_triangles = active_triangles;
        self.state.memory.depth = depth;
        self.state.memory.samples = samples;
    }

    /// Draws the triangles of `band`; returns their pixels there.
    fn draw_binned(&self, walk: &mut Walk<'_>, band: &mut Band<'_, C>) -> u32 {
        let stream = &self.state.stream;
        let mut pixels = 0u32;
        let mut next = walk.next();
        while let Some(entry) = next {
            // A checked stream has both.
            let Some(mesh) = self.mesh(entry.triangle()) else { break };
            let Some((drawing, loops)) = self.drawing(mesh) else { break };
            let end = mesh.first_triangle.saturating_add(mesh.triangles);
            let (drawn, rest) = (loops.run)(&drawing, stream.triangles, entry, walk, end, band);
            pixels = pixels.saturating_add(drawn);
            next = rest;
        }
        pixels
    }

    /// Draws all triangles into `band`; returns their pixels there, and how many of them start there.
    #[cold]
    #[inline(never)]
    fn draw_all(&self, band: &mut Band<'_, C>) -> (u32, u32) {
        let stream = &self.state.stream;
        let (mut pixels, mut drawn) = (0u32, 0);
        for mesh in stream.meshes {
            let Some((drawing, loops)) = self.drawing(mesh) else { continue };
            for triangle in stream.triangles_of(mesh).unwrap_or_default().iter().filter(|triangle| self.facing.may_face(triangle)) {
                let Some(bounds) = drawing.bounds(triangle) else { continue };
                // A triangle is counted in the band where it starts.
                let bottom = band.top + band.rows;
                drawn += u32::from((band.top..bottom).contains(&bounds.top));
                if bounds.bottom > band.top && bounds.top < bottom {
                    pixels = pixels.saturating_add(drawing.draw(loops.draw, triangle, band));
                }
            }
        }
        (pixels, drawn)
    }

    /// What the triangles of `mesh` have in common, and the loops that draw them.
    #[inline(never)]
    fn drawing(&self, mesh: &Mesh) -> Option<(MeshPass<'_, C>, TriangleLoops<C>)> {
        let RenderState { stream, memory, shader, dither, .. } = &*self.state;
        let material = usize::from(mesh.material);
        let (reflectance, ramp) = (memory.reflectances.get(material)?, memory.ramps.get(material)?);
        let perspective = self.state.perspective_correct && stream.is_perspective();
        let style = Style {
            one_light: reflectance.has_one_light() && self.constant.is_some(),
            dithered_or_antialiased: *dither || self.state.antialiased(),
            perspective,
        };
        let drawing = MeshPass {
            method: shader.method(),
            shading: Shading {
                reflectance,
                lighting: &self.lighting,
                exponent: stream.materials.get(material)?.exponent,
                constant: self.constant,
            },
            tables: MaterialTables { ramp, reflectance },
            dither: *dither,
            stage: self.stage(mesh)?,
            depth_elision: self.depth_elision.as_ref(),
            vertices: stream.vertices_of(mesh)?,
            cached: memory.vertices.get(mesh.first_vertex as usize..).unwrap_or_default(),
            viewport: self.state.viewport(),
            perspective,
        };
        Some((drawing, shader.loops(style)))
    }
}
