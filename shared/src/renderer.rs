//! Renderers, which draw the frames of a scene.

use crate::{
    Stream,
    error::{MAX_SIDE, RenderError},
    features::{self, Feature},
    format::{ErrorBudget, LARGEST_BUDGET, LEAST_BUDGET, MAX_LIGHTS},
    frame::{ColourSettings, Colours, Frame, Halves, Preparation, Prepared, Seams, Settings},
    geometry::{lens::Lens, model_view::ModelView, region::Region},
    lighting::{highlight_tables, lights::Directions, material_tables::fill_ramps, reflectance::LitMaterial},
    memory::{Layout, Memory, take},
    method::{Facts, Method},
    pixel::{Channels, Output, Pixel, gamma::Gamma, ramps::Ramps},
    placement::{Placements, Placing},
    scene::{Limits, Scene, SceneError},
    shader::Shader,
    stream::record::{Camera, Light, Material, PERSPECTIVE, POINT},
};
use core::mem;
use embedded_graphics_core::geometry::Size;
use zerocopy::{FromZeros, IntoBytes};

/// A renderer, which draws the frames of a [`Scene`] in the pixel format `C`. It owns the scene and all settings, and works in memory that
/// the program lends it; nothing is allocated.
#[derive(Debug)]
pub struct Renderer<'a, C: Pixel> {
    settings: Settings,
    colours: ColourSettings<C>,
    scene: Scene<'a>,
    memory: Memory<'a>,
    /// Tables of colours, one for each material.
    ramps: &'a mut [C::Ramps],
    /// Whether the memory has tables of highlights. A stream may have no materials.
    has_highlight_tables: bool,
    /// See [`Self::prepare`].
    seams: Option<Seams>,
    /// Whether other triangles are drawn than when the seams were found.
    rearranged: bool,
    /// The pixels that the latest frame had, or that the next one will have at least.
    region: Region,
    /// Whether `region` is of the next frame, see [`Self::invalidate`].
    is_invalidated: bool,
}

impl<'a, C: Pixel> Renderer<'a, C> {
    /// Creates a renderer for pictures of `size` pixels.
    ///
    /// - `stream` is the mesh file. It has the meshes, materials, lights and camera, and the number of the shading method to use.
    /// - `layout` says how much memory there is. Its width is that of the picture.
    /// - `memory` is working memory of at least [`Layout::words`] words, with any contents.
    /// - `shaders` lists the shading methods that the program contains. The renderer uses the one that the stream asks for.
    ///
    /// # Errors
    /// - Returns [`RenderError::UnknownMethod`] if the stream asks for a method that is not in `shaders`.
    /// - Returns [`RenderError::Size`] if a side of the picture is 0 or longer than [`MAX_SIDE`].
    /// - Returns [`RenderError::Layout`] if `layout` has another width than `size`, or no rows.
    /// - Returns [`RenderError::Memory`], [`RenderError::Materials`] or [`RenderError::Objects`] if there is too little room.
    /// - Returns [`RenderError::Light`] or [`RenderError::Exponent`] if the method cannot shade this scene.
    /// - Returns [`RenderError::Feature`] if the stream needs a cargo feature that this crate is built without.
    /// - Returns [`RenderError::AntialiasMemory`] if the stream states lines along outlines and `layout` has no room for them.
    pub fn new(stream: Stream<'a>, size: Size, layout: &Layout, memory: &'a mut [u64], shaders: &[Shader<C>]) -> Result<Self, RenderError> {
        let method = stream.header.shader;
        let shader = shaders.iter().find(|shader| shader.facts().id == method).ok_or(RenderError::UnknownMethod { method })?;
        Self::with_shader(stream, size, layout, memory, *shader)
    }

    /// Creates a renderer that uses the shading method `shader`, whatever method the stream (mesh file) asks for. All other arguments are
    /// as in [`Self::new`].
    ///
    /// # Errors
    /// Returns the errors of [`Self::new`] except [`RenderError::UnknownMethod`].
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
        let need = stream.instances.len().max(1);
        if layout.objects < need {
            return Err(RenderError::Objects { need });
        }
        let need = layout.words::<C>();
        let (ramps, memory) = take::<C::Ramps>(memory.as_mut_bytes(), layout.materials).ok_or(RenderError::Memory { need })?;
        let (memory, objects, materials) = Memory::new(layout, memory, size_of::<C::Stored>()).ok_or(RenderError::Memory { need })?;
        if let Some(feature) = Feature::missing(&stream, &Channels::of::<C>(), Feature::is_on) {
            return Err(RenderError::Feature { name: feature.name() });
        }
        check(&stream, shader.facts(), false)?;
        check_tables(shader.method(), layout.highlight_tables > 0)?;
        let settings = Settings {
            size,
            rows: (layout.rows * layout.processors).min(MAX_SIDE as usize) as u32,
            processors: layout.processors as u32,
            method: shader.method(),
            perspective_correct: false,
            antialias: false,
            outlines: None,
            lacking_tables: 0,
            budget: stream.header.budget().unwrap_or(C::BUDGET),
            #[cfg(feature = "skips")]
            skips: crate::frame::Skips::ALL,
            levels_of_detail: true,
            partial_redraw: false,
        };
        // No pixel is marked before the first band, and none behind one.
        if features::ANTIALIAS {
            memory.smoothing.marks.fill(0);
        }
        let has_edge_memory = features::ANTIALIAS && !memory.smoothing.marks.is_empty();
        let limits = limits(shader.facts(), false);
        let scene = Scene::new(stream, materials, objects, has_edge_memory, limits, Channels::of::<C>());
        // A checked stream that states lines has the neighbours of its triangles.
        if features::ANTIALIAS && scene.outlines().is_some() && !has_edge_memory {
            return Err(RenderError::AntialiasMemory);
        }
        let colours = ColourSettings { shader, output: Output { dither: true, gamma: None } };
        Ok(Self {
            settings,
            colours,
            scene,
            memory,
            ramps,
            has_highlight_tables: layout.highlight_tables > 0,
            seams: None,
            rearranged: true,
            region: Region::NONE,
            is_invalidated: false,
        })
    }

    /// Returns the scene, so that the program can change objects, materials, lights and the camera between frames.
    pub fn scene(&mut self) -> &mut Scene<'a> {
        &mut self.scene
    }

    /// Sets the shading method for the next frames. The next frame takes a little longer, because it computes the colour tables of all
    /// materials again.
    ///
    /// # Errors
    /// Returns [`RenderError::Light`], [`RenderError::Exponent`] or [`RenderError::Perspective`] if the method cannot shade the scene. The
    /// renderer then keeps its method.
    pub fn set_shader(&mut self, shader: Shader<C>) -> Result<(), RenderError> {
        let (facts, scene) = (shader.facts(), &self.scene);
        check_tables(shader.method(), self.has_highlight_tables)?;
        check_scene(scene.camera(), scene.lights(), scene.materials(), facts, self.settings.perspective_correct)?;
        (self.settings.method, self.colours.shader) = (shader.method(), shader);
        self.scene.limits = limits(facts, self.settings.perspective_correct);
        self.scene.set_stale();
        Ok(())
    }

    /// Computes the tables of materials that have changed.
    // A call that frames make only where something has.
    #[inline(never)]
    fn fill_tables(&mut self) {
        let Self { settings, colours, ramps, scene, memory: Memory { reflectances, tables, error_bounds, .. }, .. } = self;
        let (method, Output { dither, gamma }) = (settings.method, colours.output);
        let (facts, ambient, is_viewer_near) = (method.facts(), scene.ambient, features::NEAR_LIGHTS && scene.camera.has_local_viewer());
        let mut lights: heapless::Vec<Light, MAX_LIGHTS> = heapless::Vec::from_slice(scene.lights()).unwrap_or_default();
        if !features::LIGHTS && lights.is_empty() {
            // A black light takes the place of none.
            let _ = lights.push(Light::new_zeroed());
        }
        let reflectances = reflectances.get_mut(..scene.materials().len()).unwrap_or_default();
        for (index, material) in scene.stale_materials() {
            if let (Some(reflectance), Some(ramps)) = (reflectances.get_mut(index), ramps.get_mut(index)) {
                reflectance.fill(
                    Channels::of::<C>(),
                    ambient,
                    &material,
                    &lights,
                    (facts.highlight, facts.highlight_levels),
                    [scene.is_coloured(index), is_viewer_near],
                );
                fill_ramps::<C>(ramps, reflectance, dither, gamma);
            }
        }
        for (index, material) in scene.stale_materials() {
            highlight_tables::assign(reflectances, index, tables);
            let (Some(reflectance), Some(bounds)) = (reflectances.get_mut(index), error_bounds.get_mut(index)) else { continue };
            let table = reflectance.table(tables);
            *bounds = method.error_bounds(LitMaterial::new(reflectance, table), material.exponent, lights.len());
            if dither && C::Ramps::CHECKERED {
                reflectance.dither();
            }
            #[cfg(feature = "skips")]
            reflectance.leave_out(settings.skips.highlights, settings.skips.lights);
        }
        scene.set_fresh();
        settings.lacking_tables = if method.needs_highlight_tables() { highlight_tables::lacking(reflectances) } else { 0 };
    }

    /// Sets which invisible work a frame leaves out; by default this is all of it. The picture is the same with any choice, apart from two
    /// exceptions that [`Skips`](crate::Skips) names. Turning a switch off and counting time shows what it saves.
    #[cfg(feature = "skips")]
    pub fn set_skips(&mut self, skips: crate::frame::Skips) {
        self.settings.skips = skips;
        self.scene.set_stale();
    }

    /// Returns the shading method in use.
    #[must_use]
    pub fn shader(&self) -> Shader<C> {
        self.colours.shader
    }

    /// Turns perspective-correct interpolation of light on or off; the default is off. Without it, light is interpolated linearly on the
    /// screen, so the light on a large triangle that reaches from near to far is visibly distorted. Turning it on costs time, and changes
    /// nothing for an orthographic camera.
    ///
    /// # Errors
    /// Returns [`RenderError::Feature`] if this crate is built without the feature `perspective`, and [`RenderError::Perspective`] if the
    /// camera is perspective and the shading method cannot do this. The setting then stays.
    pub fn set_perspective_correct(&mut self, on: bool) -> Result<(), RenderError> {
        if on && !features::PERSPECTIVE {
            return Err(RenderError::Feature { name: "perspective" });
        }
        let scene = &self.scene;
        check_scene(scene.camera(), scene.lights(), scene.materials(), self.settings.method.facts(), on)?;
        self.settings.perspective_correct = on;
        self.scene.limits = limits(self.settings.method.facts(), on);
        self.scene.set_view_changed();
        Ok(())
    }

    /// Sets the error budget of [`Shader::AUTO`] and [`Shader::AUTO_LINEAR`]: the largest difference of a pixel from Phong shading, in
    /// units of 1/255 of full intensity, from 1/2 to 16. A larger budget is faster. The default is the budget that the stream (mesh file) states. If it
    /// states none, the default is [`Pixel::BUDGET`]. Other methods ignore it.
    ///
    /// # Errors
    /// Returns [`RenderError::Budget`] if the budget is less than [`LEAST_BUDGET`] or more than [`LARGEST_BUDGET`]. The budget then stays.
    pub fn set_budget(&mut self, budget: ErrorBudget) -> Result<(), RenderError> {
        if !(LEAST_BUDGET..=LARGEST_BUDGET).contains(&budget) {
            return Err(RenderError::Budget);
        }
        self.settings.budget = budget;
        self.scene.set_view_changed();
        Ok(())
    }

    /// Returns the error budget that [`Self::set_budget`] sets.
    #[must_use]
    pub fn budget(&self) -> ErrorBudget {
        self.settings.budget
    }

    /// Turns dither on or off; the default is on. Dither hides the visible steps between colours of few bits. The next frame computes the
    /// colour tables of all materials again.
    ///
    /// Pixels of five or six bits a channel, such as RGB565, are dithered by two thresholds in turn, [`Light`](crate::pixel::Light) and
    /// [`LightGray`](crate::pixel::LightGray) by 64 thresholds in squares of 8x8 pixels. Neither changes the time of a frame. Pixels of eight bits a
    /// channel need no dither.
    pub fn set_dither(&mut self, dither: bool) {
        self.colours.output.dither = dither;
        self.scene.set_stale();
    }

    /// Sets the curve that corrects all colours for the display, such as [`SRGB`](crate::pixel::SRGB). The default is `None`: light levels
    /// are sent unchanged, which suits colours that were chosen on a screen. The background is never corrected.
    ///
    /// For [`Light`](crate::pixel::Light) the pass over the finished band corrects all colours, which takes 21 instructions more for each pixel
    /// of the picture on a Cortex-M3. In pixels that are drawn directly, such as `Rgb565` or `Gray8`, the correction takes no time for greys, and
    /// for materials whose colours are multiples of one another; methods that look up highlights need one light for that. All else takes several times
    /// as long.
    pub fn set_gamma(&mut self, gamma: Option<&'static Gamma>) {
        self.colours.output.gamma = gamma;
        self.scene.set_stale();
    }

    /// Turns antialiasing on or off; the default is off. Each pixel on an outline, which is where a surface ends or its shading jumps, is mixed
    /// with the pixel beyond the outline.
    ///
    /// # Errors
    /// Antialiasing is then off:
    ///
    /// - Returns [`RenderError::Feature`] if this crate is built without the feature `antialias`.
    /// - Returns [`RenderError::AntialiasMemory`] if the memory has no room for it ([`Layout::antialias`]).
    /// - Returns [`RenderError::Neighbours`] if the stream (mesh file) was written without `--antialias`.
    pub fn set_antialias(&mut self, antialias: bool) -> Result<(), RenderError> {
        if antialias {
            self.scene.check_edges().map_err(|reason| match reason {
                SceneError::Feature { name } => RenderError::Feature { name },
                SceneError::Neighbours => RenderError::Neighbours,
                _ => RenderError::AntialiasMemory,
            })?;
        }
        self.settings.antialias = antialias;
        self.scene.set_view_changed();
        Ok(())
    }

    /// Turns levels of detail on or off; the default is on. Each mesh is then drawn with the fewest triangles that keep it within half a
    /// pixel of the full mesh. If `microphong convert` made no coarser levels of a mesh, this setting changes nothing.
    pub fn set_levels_of_detail(&mut self, on: bool) {
        self.settings.levels_of_detail = on;
        self.scene.set_view_changed();
    }

    /// Turns partial redraw on or off; the default is off. When it is on, a frame draws and sends only the areas that moving objects left
    /// or entered, so the display has to keep showing the previous picture. [`Frame::area`] is the rectangle around these areas. If
    /// colours, lights or the camera have changed, the whole picture is drawn.
    ///
    /// A text or image that the program itself draws under or over the picture is not watched. Call [`Self::invalidate`] with its area when
    /// it changes.
    #[cfg(feature = "redraw")]
    pub fn set_partial_redraw(&mut self, on: bool) {
        self.settings.partial_redraw = on;
    }

    /// Marks an area of the picture to be drawn and sent again by the next frame. With partial redraw ([`Self::set_partial_redraw`]), call
    /// it when something changes that the program itself draws over the picture, for example a clock. `area` is in pixels of the picture,
    /// and is clipped to it. Areas of several calls add up.
    #[cfg(feature = "redraw")]
    pub fn invalidate(&mut self, area: embedded_graphics_core::primitives::Rectangle) {
        let area = crate::geometry::pixel_rect::PixelRect::of(area, self.settings.size);
        if !area.is_empty() {
            if !mem::replace(&mut self.is_invalidated, true) {
                self.clear_region();
            }
            self.region.include(&area);
        }
    }

    fn clear_region(&mut self) {
        let Self { settings, region, .. } = self;
        region.clear(settings.size.height, settings.band_rows().checked_div(settings.processors).unwrap_or(0));
    }

    /// Returns the size of the picture in pixels.
    #[must_use]
    pub fn size(&self) -> Size {
        self.settings.size
    }

    /// Returns the number of rows of a band (group of rows drawn at once): the most that one call of [`Frame::next_band`] can draw. It is
    /// [`Layout::rows`] times [`Layout::processors`], or the height of the picture if this is less.
    #[must_use]
    pub fn band_rows(&self) -> u32 {
        self.settings.band_rows()
    }

    /// Checks that a pixel buffer is long enough for [`Frame::next_band`], which needs at least one row of the picture.
    ///
    /// # Errors
    /// Returns [`RenderError::Band`] if `pixels` is shorter than one row of the picture.
    pub fn check_band(&self, pixels: &[C]) -> Result<(), RenderError> {
        let need = self.settings.size.width as usize;
        if pixels.len() < need { Err(RenderError::Band { need }) } else { Ok(()) }
    }

    /// Returns `true` if frame `number` of the animation would equal the frame that was drawn last: the scene and the settings have not
    /// changed, no area is invalidated, and the animation is at the same place. A program can then skip drawing while the display still
    /// shows that frame.
    #[must_use]
    pub fn is_latest(&self, number: u32) -> bool {
        !self.is_invalidated && self.scene.is_latest(number)
    }

    /// Begins frame `number` of the animation in the stream (mesh file). A number beyond the last frame starts over. This is
    /// [`Scene::play`] followed by [`Self::draw`]; the pixels are drawn by [`Frame::next_band`].
    pub fn frame(&mut self, number: u32) -> Frame<'_, C> {
        self.scene.play(number);
        self.draw()
    }

    /// Begins a frame of the scene in its current state, for programs that move objects themselves. It transforms the vertices, and makes
    /// the list of visible triangles; the pixels are then drawn by [`Frame::next_band`].
    #[inline(never)]
    pub fn draw(&mut self) -> Frame<'_, C> {
        self.place();
        let Self { settings, colours, scene, memory, ramps, region, .. } = self;
        Frame::new(Prepared::new(settings, scene, memory, region), Colours { settings: colours, ramps })
    }

    /// Begins frame `number` as [`Self::frame`] does, and divides the work before the first pixel between two processors. The picture does
    /// not depend on `share`: about the first `share / 65,536` of all triangles form one part, and the rest form the other part.
    ///
    /// This needs a layout for two [`Layout::processors`] with room for all vertices and triangles, and a scene of 64 to 32,767 triangles.
    /// Otherwise, or if the bands are very small, one part does everything.
    pub fn prepare(&mut self, number: u32, share: u16) -> Preparation<'_, C> {
        self.scene.play(number);
        self.place();
        if mem::take(&mut self.rearranged) && self.settings.processors > 1 {
            self.seams = Seams::new(&self.scene, &mut self.memory);
        }
        let Self { settings, colours, scene, memory, ramps, region, seams, .. } = self;
        let halves = Halves::new(settings, scene, memory, region, seams.map(|seams| (seams, share)));
        Preparation::new(halves, Colours { settings: colours, ramps })
    }

    /// Places what has moved, and computes tables that are stale.
    fn place(&mut self) {
        if self.scene.repainted {
            self.fill_tables();
        }
        // Everything is drawn where colours have changed, or the view has.
        let is_partial = features::REDRAW && self.settings.partial_redraw && !self.scene.repainted;
        if !is_partial {
            self.region.fill(self.settings.size);
        } else if !self.is_invalidated {
            self.clear_region();
        }
        self.is_invalidated = false;
        let Self { settings, scene, memory, rearranged, region, .. } = self;
        if features::ANTIALIAS {
            settings.outlines = scene.outlines();
        }
        let world = ModelView::new(scene.camera(), scene.place);
        let how = Placing {
            lens: Lens::new(scene.camera(), settings.size),
            levels_of_detail: settings.levels_of_detail,
            leaves_out_back_faces: settings.skips().back_faces,
            directions: Directions::new(scene.lights(), &world),
            world,
        };
        let Memory { placements, order, .. } = memory;
        for (object, placement) in scene.objects().iter().zip(placements.iter_mut()) {
            if scene.view_changed || object.has_moved != 0 {
                region.include(&settings.touched(&placement.area));
                placement.update(scene, object, &how);
                region.include(&settings.touched(&placement.area));
            }
        }
        let order = order.get_mut(..scene.objects().len()).unwrap_or_default();
        if scene.rearranged {
            (0..).zip(order.iter_mut()).for_each(|(index, place)| *place = index);
        }
        *rearranged |= Placements::sort(placements, order) | scene.rearranged;
        let (mut triangles, mut vertices) = (0, 0);
        for index in order.iter().map(|&index| index as usize) {
            let (Some(placement), Some(object)) = (placements.get_mut(index), scene.objects().get(index)) else { continue };
            (placement.first_triangle, placement.first_vertex) = (triangles, vertices);
            (triangles, vertices) = (triangles.wrapping_add(object.span), vertices.wrapping_add(object.vertices));
            *rearranged |= placement.draw_within(region, &settings.touched(&placement.area));
        }
        scene.set_drawn();
    }
}

/// What a method can draw, with interpolation in perspective or without.
fn limits(facts: &Facts, perspective_correct: bool) -> Limits {
    Limits {
        near_lights: facts.near_lights,
        perspective: facts.perspective || !perspective_correct,
        least_exponent: facts.highlight.least_exponent(),
    }
}

/// Checks that a method can shade a stream, with interpolation in perspective or without.
///
/// # Errors
/// When it cannot.
pub fn check(stream: &Stream<'_>, facts: &Facts, perspective_correct: bool) -> Result<(), RenderError> {
    check_scene(&stream.header.camera, stream.lights, stream.materials.iter(), facts, perspective_correct)
}

/// Checks that a method has the tables of highlights that it needs.
fn check_tables(method: &dyn Method, has_tables: bool) -> Result<(), RenderError> {
    if has_tables || !method.needs_highlight_tables() { Ok(()) } else { Err(RenderError::HighlightTables { shader: method.facts().name }) }
}

fn check_scene<'m>(
    camera: &Camera,
    lights: &[Light],
    mut materials: impl Iterator<Item = &'m Material>,
    facts: &Facts,
    perspective_correct: bool,
) -> Result<(), RenderError> {
    let Limits { near_lights, perspective, least_exponent: least } = limits(facts, perspective_correct);
    let is_perspective = camera.projection == PERSPECTIVE;
    if !near_lights && (camera.has_local_viewer() || lights.iter().any(|light| light.kind == POINT)) {
        return Err(RenderError::Light { shader: facts.name });
    }
    if materials.any(|material| material.exponent < least) {
        return Err(RenderError::Exponent { shader: facts.name, least });
    }
    if is_perspective && !perspective {
        return Err(RenderError::Perspective { shader: facts.name });
    }
    Ok(())
}
