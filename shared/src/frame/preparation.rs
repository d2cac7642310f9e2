//! Preparation of a frame before its rows are drawn, in one part or in two, so that two processors can work at the same time.
//!
//! Triangles and vertices of a frame are divided into two halves. Each vertex is transformed and lit by one processor. Most streams number vertices
//! by their first use, and objects have their vertices one after the other. The later half therefore owns all vertices from some number on. Some
//! later triangles use vertices of the earlier half: this is the seam. The places of these vertices on the screen are computed a second time, without
//! light. When both halves are done, their lists are joined, and a vertex that only triangles at the seam use is transformed. The result is the one
//! of a single processor.
//!
//! With partial redraw most triangles lie outside of the area that is drawn. Light is then computed last, for vertices that are needed: it takes
//! longer than all else at a vertex.

use crate::{
    features::ANTIALIAS,
    frame::{
        Frame,
        colours::Colours,
        context::{Context, PlacedMesh, Settings, meshes},
        part::{FrameRows, Stats},
        smoother::Smoother,
    },
    geometry::{
        bin::{Bins, Entry},
        cull::{Extent, Facing},
        depth_elision::DepthElision,
        projection::{ScreenVertex, State},
        region::Region,
        viewport::{Bounds, Viewport},
    },
    memory::{Memory, halves},
    mesh::vertices::{SeamPlace, UNUSED, VertexStage},
    method::VertexLight,
    pixel::Pixel,
    placement::Placements,
    raster::active::QueueState,
    scene::Scene,
    stream::record::{Triangle, Vertex},
};
use core::{hint::black_box, mem, ops::Range};
use zerocopy::{FromBytes, IntoBytes};

/// Places where the triangles of a frame can be divided.
const STEPS: usize = 32;

/// For the triangles before each of [`STEPS`] places, which share out all triangles equally, one past the last vertex that they use.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seams([u16; STEPS]);

impl Seams {
    /// `None` if the placed objects of `scene` have few triangles, or more than [`Bins::join`] can join, or `memory` has not room for all of
    /// them, for all vertices, and for any seam: what happens once a frame is then left to one processor.
    pub(crate) fn new(scene: &Scene<'_>, memory: &mut Memory<'_>) -> Option<Self> {
        let stream = &scene.stream;
        let placements = Placements::new(scene, memory.placements, memory.order);
        let (triangles, vertices) = (placements.drawn() as usize, scene.vertices() as usize);
        let fits = triangles <= memory.entries.len() && vertices <= memory.vertices.len() && seam(memory.depth, vertices).len() == vertices;
        if !fits || !(2 * STEPS..1 << 15).contains(&triangles) {
            return None;
        }
        let (mut seams, mut vertex, mut before) = ([0; STEPS], 0, 0);
        for placed in meshes(scene, placements) {
            let first = placed.first_vertex as u32;
            for triangle in stream.triangles_of(placed.mesh)? {
                before += 1;
                vertex = triangle.corners.map(|corner| first + u32::from(corner) + 1).into_iter().fold(vertex, u32::max);
                // The last of the triangles before a place remains.
                if let Some(seam) = seams.get_mut((before * STEPS).div_ceil(triangles.max(1))) {
                    *seam = u16::try_from(vertex).ok()?;
                }
            }
        }
        Some(Self(seams))
    }

    /// Returns the place before which `share / 2^16` of the triangles lie.
    pub(crate) fn division(&self, triangles: u32, share: u16) -> Division {
        let step = (usize::from(share) * STEPS + (1 << 15)) >> 16;
        let vertex = self.0.get(step).copied().map(usize::from);
        vertex.map(|vertex| Division { triangle: triangles as usize * step / STEPS, vertex }).unwrap_or_default()
    }
}

/// Where the later half begins. By default it has all triangles.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Division {
    triangle: usize,
    /// One past the last vertex that the earlier triangles use.
    vertex: usize,
}

/// Memory for the places of the seam's vertices. It is borrowed from the depth buffer, which is free until rows are drawn. Empty if it is too small.
fn seam(depth: &mut [u16], vertices: usize) -> &mut [SeamPlace] {
    <[SeamPlace]>::mut_from_prefix_with_elems(depth.as_mut_bytes(), vertices).map(|(seam, _)| seam).unwrap_or_default()
}

/// The work of a frame before its first pixel (transforming vertices and listing visible triangles), divided into two parts for two
/// processors. [`Renderer::prepare`](crate::Renderer::prepare) creates it, and [`Self::frame`] ends it.
#[derive(Debug)]
pub struct Preparation<'r, C: Pixel> {
    colours: Colours<'r, C>,
    halves: Halves<'r>,
}

/// A frame that is prepared in two halves.
#[derive(Debug)]
pub(crate) struct Halves<'r> {
    /// The frame. Its lists hold the later triangles.
    prepared: Prepared<'r>,
    cache: &'r mut [ScreenVertex],
    division: Division,
    /// The lists of the earlier triangles.
    earlier: Bins,
    /// Depth tests to leave out, for the later triangles and for the earlier ones.
    depth_elisions: [Option<DepthElision>; 2],
    is_done: [bool; 2],
}

/// A frame, of which every part but the tables of colours is known.
#[derive(Debug)]
pub(crate) struct Prepared<'r> {
    pub(super) context: Context<'r>,
    pub(super) part: FrameRows<'r>,
}

/// A frame without triangles and vertices, room for vertices, and where triangles may overlap.
type Empty<'r> = (Prepared<'r>, &'r mut [ScreenVertex], Option<DepthElision>);

impl<'r> Prepared<'r> {
    /// Prepares a frame of a scene whose objects are placed, on one processor.
    #[inline(never)]
    pub(crate) fn new(settings: &'r Settings, scene: &'r Scene<'_>, memory: &'r mut Memory<'_>, region: &'r Region) -> Self {
        let (mut prepared, cache, mut depth_elision) = Self::empty(settings, scene, memory, region);
        let FrameRows { bins, entries, stats, .. } = &mut prepared.part;
        let whole = PreparationPart {
            context: &prepared.context,
            triangles: 0..stats.triangles as usize,
            cached: cache,
            seam: &mut [],
            entries,
            bins,
            depth_elision: &mut depth_elision,
            is_done: &mut false,
        };
        whole.bin::<false>();
        prepared.complete(cache, depth_elision);
        prepared
    }

    #[inline]
    fn empty(settings: &'r Settings, scene: &'r Scene<'_>, memory: &'r mut Memory<'_>, region: &'r Region) -> Empty<'r> {
        let Memory { vertices, entries, depth, placements, order, reflectances, tables, error_bounds, smoothing, active_triangles } =
            memory;
        let size = settings.size;
        let placements = Placements::new(scene, placements, order);
        // Bins as high as the bands of one processor.
        let band_rows = settings.band_rows().checked_div(settings.processors).unwrap_or(0);
        let bins = Bins::new(size.height, band_rows);
        let uncached = scene.vertices().saturating_sub(vertices.len() as u32);
        let triangles = placements.drawn();
        let visible = placements.objects(scene).filter(|(placement, _)| placement.drawn > 0);
        let as_they_are = visible.fold(0, |sum, (_, object)| sum + object.triangles);
        let context =
            Context { settings, scene, placements, region, depth_elision: None, vertices: &[], reflectances, tables, error_bounds };
        let elides = settings.skips().depth && !settings.has_edges();
        let depth_elision = if elides { context.convex().and_then(DepthElision::new) } else { None };
        let part = FrameRows {
            bins,
            entries,
            depth,
            smoother: Smoother::new(smoothing, settings.has_edges().then(|| Bins::new(size.height, band_rows))),
            active_triangles,
            queue: QueueState::default(),
            rows: region.hull().rows(),
            top: region.hull().rows().start,
            drawn: 0,
            band_rows: settings.band_rows(),
            bottom: region.hull().rows().end,
            stats: Stats { triangles, simplified: as_they_are - triangles, uncached, ..Stats::default() },
        };
        (Self { context, part }, vertices, depth_elision)
    }

    /// Completes the frame, once all triangles are in the bins and `cache` has the vertices.
    #[inline]
    fn complete(&mut self, cache: &'r [ScreenVertex], depth_elision: Option<DepthElision>) {
        let Self { context, part } = self;
        (context.vertices, context.depth_elision) = (cache, depth_elision);
        if part.bins.count().is_some() {
            (part.stats.passes, part.stats.drawn) = (1, part.bins.linked().into());
            part.rows = part.bins.rows();
        }
        if ANTIALIAS && context.settings.has_edges() {
            part.find_edges(context);
        }
    }
}

impl<'r, C: Pixel> Preparation<'r, C> {
    pub(crate) fn new(halves: Halves<'r>, colours: Colours<'r, C>) -> Self {
        Self { colours, halves }
    }

    /// Returns the two parts. Call [`PreparationPart::run`] for each, one on each processor. The first one has the later triangles of the
    /// scene, the second one the earlier triangles. If the work cannot be divided, the first part does everything and the second one
    /// nothing.
    #[must_use]
    pub fn parts(&mut self) -> [PreparationPart<'_, 'r>; 2] {
        self.halves.parts()
    }

    /// Ends the preparation and returns the frame, ready to be drawn. A part that has not been run is run here.
    #[must_use]
    pub fn frame(self) -> Frame<'r, C> {
        Frame::new(self.halves.join(), self.colours)
    }
}

impl<'r> Halves<'r> {
    #[inline(never)]
    pub(crate) fn new(
        settings: &'r Settings,
        scene: &'r Scene<'_>,
        memory: &'r mut Memory<'_>,
        region: &'r Region,
        seams: Option<(Seams, u16)>,
    ) -> Self {
        let (prepared, cache, depth_elision) = Prepared::empty(settings, scene, memory, region);
        let division = seams.map(|(seams, share)| seams.division(prepared.part.stats.triangles, share)).unwrap_or_default();
        let earlier = prepared.part.bins.open();
        Self { prepared, cache, division, earlier, depth_elisions: [depth_elision.clone(), depth_elision], is_done: [false; 2] }
    }

    fn parts(&mut self) -> [PreparationPart<'_, 'r>; 2] {
        let Self { prepared, cache, division: Division { triangle, vertex }, earlier: earlier_bins, depth_elisions, is_done } = self;
        let ([later_elision, earlier_elision], [later_done, earlier_done]) = (depth_elisions, is_done);
        let Prepared { context, part: FrameRows { bins: later_bins, entries, depth, stats, .. } } = prepared;
        let all = stats.triangles as usize;
        let (earlier_cached, later_cached) = halves(cache, *vertex);
        // As many entries as triangles: none can be without.
        let (later_entries, earlier_entries) = halves(entries, entries.len().saturating_sub(*triangle));
        let later = PreparationPart {
            context,
            triangles: *triangle..all,
            cached: later_cached,
            seam: seam(depth, *vertex),
            entries: later_entries,
            bins: later_bins,
            depth_elision: later_elision,
            is_done: later_done,
        };
        let earlier = PreparationPart {
            context,
            triangles: 0..*triangle,
            cached: earlier_cached,
            seam: &mut [],
            entries: earlier_entries,
            bins: earlier_bins,
            depth_elision: earlier_elision,
            is_done: earlier_done,
        };
        [later, earlier]
    }

    /// Runs the parts that have not been run, and joins their lists.
    #[inline(never)]
    fn join(mut self) -> Prepared<'r> {
        self.parts().into_iter().for_each(PreparationPart::run);
        let Self { mut prepared, cache, division: Division { triangle, vertex }, earlier, depth_elisions: [later, before], .. } = self;
        let Prepared { context, part } = &mut prepared;
        if triangle > 0 {
            close(context, cache, seam(part.depth, vertex));
            part.bins.join(part.entries, &earlier, part.entries.len() - triangle);
        }
        prepared.complete(cache, later.zip(before).map(|(later, before)| later.and(&before)));
        prepared
    }
}

/// Transforms the vertices that triangles at the seam use and no earlier ones.
#[inline(never)]
fn close(context: &Context<'_>, cache: &mut [ScreenVertex], seam: &[SeamPlace]) {
    for placed in context.meshes() {
        let (first, vertices) = (placed.first_vertex, context.scene.stream.vertices_of(placed.mesh));
        if let (Some(seam), Some(cached), Some(vertices), Some(stage)) =
            (seam.get(first..), cache.get_mut(first..), vertices, context.stage(&placed))
        {
            stage.close_seam(cached, seam, vertices);
        }
    }
}

/// One of two parts of the work of a frame before its first pixel, for one processor. [`Preparation::parts`] returns both.
#[derive(Debug)]
pub struct PreparationPart<'f, 'r> {
    context: &'f Context<'r>,
    /// Its triangles, counted from the first of those that are drawn at this level of detail.
    triangles: Range<usize>,
    /// Its vertices, which follow those of the seam.
    cached: &'f mut [ScreenVertex],
    /// Places of vertices that belong to the other half.
    seam: &'f mut [SeamPlace],
    entries: &'f mut [Entry],
    bins: &'f mut Bins,
    depth_elision: &'f mut Option<DepthElision>,
    is_done: &'f mut bool,
}

impl<'r> PreparationPart<'_, 'r> {
    /// Returns the range of triangles that this part prepares, numbered consecutively across all meshes of the frame. It is empty if the other part does
    /// everything.
    #[must_use]
    pub fn triangles(&self) -> Range<usize> {
        self.triangles.clone()
    }

    /// Prepares the triangles of this part: transforms their vertices and lists the visible ones.
    pub fn run(self) {
        if !mem::replace(self.is_done, true) {
            self.bin::<true>();
        }
    }

    /// Culls triangles, transforms their vertices, and puts them into the bins of the rows that they start in. Triangles are taken from the
    /// last to the first, in the order that [`Bins::push`] needs. Unless the frame is `DIVIDED`, there is no seam.
    #[inline(never)]
    fn bin<const DIVIDED: bool>(mut self) {
        let context = self.context;
        self.cached
            .iter_mut()
            .take((context.scene.vertices() as usize).saturating_sub(self.seam.len()))
            .for_each(|vertex| vertex.state = State::IDLE);
        self.seam.fill(UNUSED);
        // Triangles of the meshes before.
        let mut earlier = context.placements.drawn() as usize;
        for placed in context.meshes().rev() {
            earlier = earlier.saturating_sub(placed.mesh.triangles as usize);
            self.bin_mesh::<DIVIDED>(&placed, earlier);
        }
        if context.lights_later() {
            self.light();
        }
    }

    /// Lights the vertices of the triangles that are in the bins, or all that are transformed if some triangle has found no room there.
    #[cold]
    #[inline(never)]
    fn light(&mut self) {
        let Self { context, cached, seam, entries, bins, .. } = self;
        // In the order in which they were put there.
        let mut rest = bins.count().and_then(|count| entries.get(..count.into()));
        for placed in context.meshes().rev() {
            let (stream, mesh, first) = (&context.scene.stream, placed.mesh, placed.first_vertex);
            let (Some(vertices), Some(triangles)) = (stream.vertices_of(mesh), stream.triangles_of(mesh)) else { continue };
            let Some(stage) = context.stage(&placed) else { continue };
            let cached = cached.get_mut(first.saturating_sub(seam.len())..).unwrap_or_default();
            // Those before are the other part's.
            let before = seam.len().saturating_sub(first);
            let Some(entries) = &mut rest else {
                let vertices = vertices.get(before..).unwrap_or_default();
                cached.iter_mut().zip(vertices).for_each(|(screen, vertex)| stage.light_up(screen, vertex));
                continue;
            };
            while let [entry, behind @ ..] = *entries
                && let Some(triangle) = triangles.get(entry.key.triangle().wrapping_sub(placed.first_triangle) as usize)
            {
                *entries = behind;
                for corner in triangle.corners.map(usize::from) {
                    if let (Some(screen), Some(vertex)) = (cached.get_mut(corner.wrapping_sub(before)), vertices.get(corner)) {
                        stage.light_up(screen, vertex);
                    }
                }
            }
        }
    }

    /// Puts the triangles of a mesh that belong to this half into the bins. `earlier` triangles belong to meshes before it.
    // A call, so that its loop has all registers.
    #[inline(never)]
    fn bin_mesh<const DIVIDED: bool>(&mut self, placed: &PlacedMesh<'r>, earlier: usize) {
        let Self { context, triangles: Range { start, end }, cached, seam, entries, bins, depth_elision, .. } = self;
        // A copy of which the compiler does not know where it is from: it stays in registers.
        let facing = black_box(placed.placement.facing);
        let (stream, mesh) = (&context.scene.stream, placed.mesh);
        let viewport = context.settings.viewport();
        let area = area_of(context, placed);
        let keeps_touched = context.settings.has_edges();
        // Reached by a pointer of its own, which is opaque to the compiler: instructions of Armv6-M reach little of a structure.
        let (bins, depth_elision, entries) = (black_box(&mut **bins), &mut **depth_elision, &mut **entries);
        let leaning = if depth_elision.is_some() { facing.leaning() } else { Facing::FRONT };
        let (vertices, triangles) = (stream.vertices_of(mesh).unwrap_or_default(), stream.triangles_of(mesh).unwrap_or_default());
        let Some(mut stage) = context.stage(placed) else { return };
        if context.lights_later() {
            stage.light = VertexLight::None;
        }
        let within = |index: usize| index.saturating_sub(earlier).min(triangles.len());
        let before = if DIVIDED { within(*start) } else { 0 };
        let mut rest = if DIVIDED { triangles.get(before..within(*end)).unwrap_or_default() } else { triangles };
        let (id, first_vertex) = (placed.first_triangle.wrapping_add(before as u32), placed.first_vertex);
        let cached = cached.get_mut(first_vertex.saturating_sub(seam.len())..).unwrap_or_default();
        let seam = seam.get_mut(first_vertex..).unwrap_or_default();
        let first_cached = if DIVIDED { seam.len() } else { 0 };
        while let [before @ .., triangle] = rest {
            rest = before;
            let height = facing.height(triangle);
            // Decision: facing.
            if height < leaning {
                continue;
            }
            let mut push = |bounds, word_sized| {
                if let Some(Bounds { top, bottom, .. }) = bounds
                    && height >= Facing::FRONT
                {
                    bins.push(entries, id + rest.len() as u32, word_sized, [top as u32, bottom as u32]);
                }
            };
            let mut word_sized = false;
            let bounds = match stage.corners(cached, first_cached, vertices, triangle) {
                Some(corners) => {
                    let extent = Extent::new(corners);
                    if let Some(elision) = depth_elision {
                        elision.include(&extent);
                    }
                    word_sized = viewport.is_word_sized(&extent);
                    viewport.bounds_within(&extent, area)
                }
                None if DIVIDED => {
                    let bounds;
                    (word_sized, bounds) = at_seam(&stage, (&mut *cached, &mut *seam), viewport, depth_elision, (vertices, triangle));
                    bounds.and_then(|bounds| bounds.visible(area))
                }
                None => {
                    *depth_elision = None;
                    stage.bounds(viewport, vertices, triangle).and_then(|bounds| bounds.visible(area))
                }
            };
            push(bounds, word_sized);
            if ANTIALIAS
                && keeps_touched
                && bounds.is_none()
                && touches(&stage, (&mut *cached, &mut *seam), viewport, (vertices, triangle), area)
            {
                // Its edges may be outlines.
                bins.keep(entries, id + rest.len() as u32);
            }
        }
    }
}

/// The pixels for which triangles of a mesh are kept.
#[inline]
fn area_of(context: &Context<'_>, placed: &PlacedMesh<'_>) -> Bounds {
    let (settings, region) = (context.settings, context.region);
    let mut area = Bounds::from(&settings.touched(&region.within(&settings.touched(&placed.placement.area))));
    // What lies beside it is left out, but not what lies below it: bands save triangles that go on, also where no strip below has pixels of the object,
    // and what they have saved is taken off by those that walk the triangle.
    area.bottom = area.bottom.max(settings.touched(&region.hull()).rows().end as i32);
    area
}

/// Whether a triangle that contains no pixel centre touches a pixel of `area`.
#[inline(never)]
fn touches(
    stage: &VertexStage<'_>,
    (cached, seam): (&mut [ScreenVertex], &mut [SeamPlace]),
    viewport: Viewport,
    (vertices, triangle): (&[Vertex], &Triangle),
    area: Bounds,
) -> bool {
    if let Some(corners) = stage.corners_at_seam(cached, seam, vertices, triangle) {
        return viewport.touches(&Extent::new(corners), area);
    }
    triangle.vertices(vertices).is_some_and(|vertices| viewport.touches_by(stage.view, vertices, area))
}

/// Whether a triangle is word-sized, and its visible bounding box, where a corner belongs to the other half or needs clipping.
#[cold]
#[inline(never)]
fn at_seam(
    stage: &VertexStage<'_>,
    (cached, seam): (&mut [ScreenVertex], &mut [SeamPlace]),
    viewport: Viewport,
    depth_elision: &mut Option<DepthElision>,
    (vertices, triangle): (&[Vertex], &Triangle),
) -> (bool, Option<Bounds>) {
    let Some(corners) = stage.corners_at_seam(cached, seam, vertices, triangle) else {
        *depth_elision = None;
        return (false, stage.bounds(viewport, vertices, triangle));
    };
    let extent = Extent::new(corners);
    if let Some(elision) = depth_elision {
        elision.include(&extent);
    }
    (viewport.is_word_sized(&extent), viewport.bounds(&extent))
}
