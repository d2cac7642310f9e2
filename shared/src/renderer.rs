//! Renderers, which draw the frames of a scene.

use crate::{
    Stream,
    error::{MAX_SIDE, RenderError},
    format::{ErrorBudget, LARGEST_BUDGET, LEAST_BUDGET, LEVEL, MAX_LIGHTS},
    frame::{ColourSettings, Colours, Frame, Preparation, Prepared, Seams, Settings},
    geometry::{area::Area, lens::Lens, model_view::ModelView, region::Region},
    lighting::{lights::Directions, material_tables::fill_ramps, reflectance::LitMaterial},
    memory::{Layout, Memory, take_ramps},
    method::{Facts, HighlightField},
    pixel::{Channels, Pixel, gamma::Gamma, ramps::Ramps},
    placement::{Placements, Placing},
    scene::{Limits, Scene},
    shader::Shader,
    stream::record::{Camera, DIRECTIONAL, Light, Material, PERSPECTIVE, VIEWER_LOCAL},
};
use core::mem;
use embedded_graphics_core::{geometry::Size, primitives::Rectangle};

/// Draws the frames of a scene.
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
    /// A renderer for pictures of `size` pixels. It draws by the method in `shaders` that the stream asks for. `memory` needs [`Layout::words`]
    /// words; its contents do not matter.
    ///
    /// # Errors
    /// When `size` is out of range, its width is not the layout's, `memory` is too small, the method is missing or cannot shade the scene, or
    /// the stream has labels and this build lacks the feature `text`.
    pub fn new(stream: Stream<'a>, size: Size, layout: &Layout, memory: &'a mut [u64], shaders: &[Shader<C>]) -> Result<Self, RenderError> {
        let method = stream.header.shader;
        let shader = shaders.iter().find(|shader| shader.facts().id == method).ok_or(RenderError::UnknownMethod { method })?;
        Self::with_shader(stream, size, layout, memory, *shader)
    }

    /// A renderer with the method `shader`, whatever method the stream asks for. All else is as in [`Self::new`].
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
        let need = stream.instances.len().max(1);
        if layout.objects < need {
            return Err(RenderError::Objects { need });
        }
        let need = layout.words::<C>();
        let (ramps, memory) = take_ramps::<C>(layout, memory).ok_or(RenderError::Memory { need })?;
        let (memory, objects, materials) = Memory::new(layout, memory).ok_or(RenderError::Memory { need })?;
        check(&stream, shader.facts(), false)?;
        check_tables(shader.facts(), layout.highlight_tables)?;
        if !cfg!(feature = "text") && !stream.labels.is_empty() {
            return Err(RenderError::Feature { name: "text" });
        }
        let settings = Settings {
            size,
            processors: layout.processors as u32,
            method: shader.method(),
            perspective_correct: false,
            antialias: false,
            budget: level(stream.header.budget()),
            #[cfg(feature = "skips")]
            skips: crate::frame::Skips::ALL,
            levels_of_detail: true,
            partial_redraw: false,
        };
        let scene = Scene::new(stream, materials, objects, limits(shader.facts(), false));
        let colours = ColourSettings { shader, dither: C::DITHERED, gamma: None };
        Ok(Self {
            settings,
            colours,
            scene,
            memory,
            ramps,
            has_highlight_tables: layout.highlight_tables,
            seams: None,
            rearranged: true,
            region: Region::NONE,
            is_invalidated: false,
        })
    }

    /// The scene. A program can change it between frames.
    pub fn scene(&mut self) -> &mut Scene<'a> {
        &mut self.scene
    }

    /// Changes the shading method. The next frame takes a little longer, because it computes the tables of all materials again.
    ///
    /// # Errors
    /// When the method cannot shade this scene; the method in use stays.
    pub fn set_shader(&mut self, shader: Shader<C>) -> Result<(), RenderError> {
        let (facts, scene) = (shader.facts(), &self.scene);
        check_tables(facts, self.has_highlight_tables)?;
        check_scene(scene.camera(), scene.lights(), scene.materials(), facts, self.settings.perspective_correct)?;
        (self.settings.method, self.colours.shader) = (shader.method(), shader);
        self.scene.set_limits(limits(facts, self.settings.perspective_correct));
        self.scene.set_stale();
        Ok(())
    }

    /// Computes the tables of materials that have changed.
    // A call that frames make only where something has.
    #[inline(never)]
    fn fill_tables(&mut self) {
        let Self { settings, colours, ramps, scene, memory: Memory { reflectances, tables, error_bounds, .. }, .. } = self;
        let (method, ColourSettings { dither, gamma, .. }) = (settings.method, colours);
        let (facts, ambient) = (method.facts(), scene.ambient);
        let lights: heapless::Vec<Light, MAX_LIGHTS> = heapless::Vec::from_slice(scene.lights()).unwrap_or_default();
        for (index, material) in scene.stale_materials() {
            let (Some(reflectance), Some(ramps), Some(bounds)) =
                (reflectances.get_mut(index), ramps.get_mut(index), error_bounds.get_mut(index))
            else {
                continue;
            };
            reflectance.fill(Channels::of::<C>(), ambient, &material, &lights, (facts.highlight, facts.highlight_levels));
            fill_ramps::<C>(ramps, reflectance, *dither, *gamma);
            let table = tables.get_mut(index).map(|table| {
                table.fill(&reflectance.highlights);
                &*table
            });
            *bounds = method.error_bounds(LitMaterial::new(reflectance, table), material.exponent, lights.len());
            if *dither && C::Ramps::CHECKERED {
                reflectance.dither();
            }
            #[cfg(feature = "skips")]
            reflectance.leave_out(settings.skips.highlights, settings.skips.lights);
        }
    }

    /// Selects work to leave out because nobody can see the result; by default all of it. The picture is the same.
    #[cfg(feature = "skips")]
    pub fn set_skips(&mut self, skips: crate::frame::Skips) {
        self.settings.skips = skips;
        self.scene.set_stale();
    }

    /// The method in use.
    #[must_use]
    pub fn shader(&self) -> Shader<C> {
        self.colours.shader
    }

    /// Turns interpolation in perspective on or off; by default it is off. Without it, light is interpolated linearly on the screen, and a triangle
    /// that reaches from near to far looks wrong. It makes no difference to orthographic cameras.
    ///
    /// # Errors
    /// When this build or the method in use cannot interpolate in perspective; nothing changes then.
    pub fn set_perspective_correct(&mut self, on: bool) -> Result<(), RenderError> {
        if on && !cfg!(feature = "perspective") {
            return Err(RenderError::Feature { name: "perspective" });
        }
        let scene = &self.scene;
        check_scene(scene.camera(), scene.lights(), scene.materials(), self.settings.method.facts(), on)?;
        self.settings.perspective_correct = on;
        self.scene.set_limits(limits(self.settings.method.facts(), on));
        self.scene.set_view_changed();
        Ok(())
    }

    /// Sets the error budget of the method [`Shader::AUTO`]: the largest error of a pixel against Phong shading, in 1/255 of full intensity. By
    /// default it is the stream's.
    ///
    /// # Errors
    /// When it is less than [`LEAST_BUDGET`] or more than [`LARGEST_BUDGET`]; nothing changes then.
    pub fn set_budget(&mut self, budget: ErrorBudget) -> Result<(), RenderError> {
        if !(LEAST_BUDGET..=LARGEST_BUDGET).contains(&budget) {
            return Err(RenderError::Budget);
        }
        self.settings.budget = level(budget);
        self.scene.set_view_changed();
        Ok(())
    }

    /// Turns ordered dither on or off. By default it is on in formats of less than eight bits a channel. The next frame computes the tables of all
    /// materials again.
    ///
    /// Channels of five to seven bits are dithered by two thresholds ([`crate::pixel::ramps`]), which take turns like the squares of a checkerboard,
    /// or by rows. This takes as many instructions as no dither.
    ///
    /// All other formats are dithered by 64 thresholds in squares of eight by eight pixels. Greys of one to four bits are drawn fastest with dither,
    /// and take several times as many instructions without it. Colours of one to four bits a channel, and formats of eight bits, take several times
    /// as many instructions with dither.
    pub fn set_dither(&mut self, dither: bool) {
        self.colours.dither = dither;
        self.scene.set_stale();
    }

    /// Corrects all colours for the curve of the display, such as [`crate::pixel::gamma::SRGB`]. By default nothing is corrected, and light levels
    /// are sent unchanged. The background is never corrected. Materials of one channel cost nothing more, because tables of colours hold the
    /// corrected values. Materials of three channels take several times as long.
    pub fn set_gamma(&mut self, gamma: Option<&'static Gamma>) {
        self.colours.gamma = gamma;
        self.scene.set_stale();
    }

    /// Turns antialiasing by exact areas on or off; it is off at first.
    ///
    /// # Errors
    /// When the memory has no room for it, or this build lacks the feature `antialias`; it stays off then.
    pub fn set_antialias(&mut self, antialias: bool) -> Result<(), RenderError> {
        self.settings.antialias = false;
        if antialias && !cfg!(feature = "antialias") {
            return Err(RenderError::Feature { name: "antialias" });
        }
        if antialias && self.memory.samples.is_empty() {
            return Err(RenderError::NoSamples);
        }
        self.settings.antialias = antialias;
        self.scene.set_view_changed();
        Ok(())
    }

    /// Turns levels of detail on or off; by default they are on. Each mesh is then drawn at its coarsest level that lies less than half a pixel from
    /// the full mesh on the screen. It makes no difference to streams without levels.
    pub fn set_levels_of_detail(&mut self, on: bool) {
        self.settings.levels_of_detail = on;
        self.scene.set_view_changed();
    }

    /// Turns partial redraw on or off; by default it is off. With it, a frame draws only areas that may differ from the frame before, which the
    /// display has to show still. Where single objects move, these are the areas that they leave and enter. [`Frame::area`] is the rectangle around
    /// them. If colours, lights or the camera have changed, the whole picture is drawn.
    ///
    /// What a program draws under or over the picture is sent in these areas only. [`Self::invalidate`] adds an area where it changes.
    pub fn set_partial_redraw(&mut self, on: bool) {
        self.settings.partial_redraw = on;
    }

    /// Adds `area` to the next frame, which draws and sends it again although nothing of the scene has changed there. A clock that a program draws
    /// over the picture needs this with partial redraw. `area` is in pixels of the picture; parts outside of the picture are ignored. Areas of several
    /// calls add up.
    pub fn invalidate(&mut self, area: Rectangle) {
        let area = Area::of(area, self.settings.size);
        if !area.is_empty() {
            if !mem::replace(&mut self.is_invalidated, true) {
                self.clear_region();
            }
            self.region.include(&area);
        }
    }

    fn clear_region(&mut self) {
        let Self { settings, memory, region, .. } = self;
        let band_rows = settings.band_rows(memory.depth.len(), memory.samples.len());
        region.clear(settings.size.height, band_rows.checked_div(settings.processors).unwrap_or(0));
    }

    /// The size of the picture, in pixels.
    #[must_use]
    pub fn size(&self) -> Size {
        self.settings.size
    }

    /// Rows of a band; the last band of a frame may have fewer.
    #[must_use]
    pub fn band_rows(&self) -> u32 {
        self.settings.band_rows(self.memory.depth.len(), self.memory.samples.len())
    }

    /// Checks that a slice of pixels is long enough for a band.
    ///
    /// # Errors
    /// When `pixels` does not hold one row of the picture.
    pub fn check_band(&self, pixels: &[C]) -> Result<(), RenderError> {
        let need = self.settings.size.width as usize;
        if pixels.len() < need { Err(RenderError::Band { need }) } else { Ok(()) }
    }

    /// Whether frame `number` is the picture that was drawn last: scene and settings have not changed, nothing is invalidated, and the camera stands
    /// still or has come round. It need be neither drawn nor sent if the display still shows it.
    #[must_use]
    pub fn is_latest(&self, number: u32) -> bool {
        !self.is_invalidated && self.scene.is_latest(number)
    }

    /// Begins frame `number` of the stream's animation. Numbers beyond the last frame start over. It is [`Scene::play`] and then [`Self::draw`].
    pub fn frame(&mut self, number: u32) -> Frame<'_, C> {
        self.scene.play(number);
        self.draw()
    }

    /// Begins a frame of the scene as the program has set it: places objects and lights, transforms vertices, and culls and sorts triangles.
    #[inline(never)]
    pub fn draw(&mut self) -> Frame<'_, C> {
        self.place();
        let Self { settings, colours, scene, memory, ramps, region, .. } = self;
        Frame::new(Prepared::new(settings, scene, memory, region), Colours { settings: colours, ramps })
    }

    /// Begins frame `number` as [`Self::frame`] does, and divides the preparation between two processors. The earlier triangles are a `share` of all,
    /// in units of 1/65,536. The picture does not depend on it. The layout has to be for two [`Layout::processors`], and to have room for all
    /// triangles and vertices; otherwise one part does everything.
    pub fn prepare(&mut self, number: u32, share: u16) -> Preparation<'_, C> {
        self.scene.play(number);
        self.place();
        if mem::take(&mut self.rearranged) && self.settings.processors > 1 {
            self.seams = Seams::new(&self.scene, &mut self.memory);
        }
        let Self { settings, colours, scene, memory, ramps, region, seams, .. } = self;
        let colours = Colours { settings: colours, ramps };
        Preparation::new(settings, scene, memory, region, seams.map(|seams| (seams, share)), colours)
    }

    /// Places what has moved, and computes tables that are stale.
    fn place(&mut self) {
        if !self.scene.is_unchanged() {
            self.fill_tables();
        }
        // Everything is drawn where colours have changed, or the view has.
        let is_partial = self.settings.partial_redraw && !self.scene.repainted;
        if !is_partial {
            self.region.fill(self.settings.size);
        } else if !self.is_invalidated {
            self.clear_region();
        }
        self.is_invalidated = false;
        let Self { settings, scene, memory, rearranged, region, .. } = self;
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
                region.include(&placement.area);
                placement.update(scene, object, &how);
                region.include(&placement.area);
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
            *rearranged |= placement.draw_within(region);
        }
        scene.set_drawn();
    }
}

/// An error budget as a level, Q9.7.
fn level(budget: ErrorBudget) -> u32 {
    u32::from(budget.to_bits()) << (LEVEL - ErrorBudget::FRAC_NBITS)
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

/// Checks that a method has the tables of highlights that it needs: it does if it computes highlights at pixels.
fn check_tables(facts: &Facts, has_tables: bool) -> Result<(), RenderError> {
    if has_tables || facts.highlight_field == HighlightField::Level {
        Ok(())
    } else {
        Err(RenderError::HighlightTables { shader: facts.name })
    }
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
    if !near_lights && (is_perspective && camera.viewer == VIEWER_LOCAL || lights.iter().any(|light| light.kind != DIRECTIONAL)) {
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
