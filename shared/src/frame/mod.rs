//! One frame: what happens before its rows are drawn, and how it is drawn in one part or in two.

mod part;
mod scene;

pub use part::Stats;
pub(crate) use scene::Settings;

use crate::{
    error::RenderError,
    geometry::{
        bin::Bins,
        cull::{Extent, Facing},
        depth_elision::DepthElision,
        pose::Pose,
        projection::{ScreenVertex, State, View},
        viewport::Bounds,
    },
    lighting::lights::Lighting,
    memory::Memory,
    mesh::vertices::VertexStage,
    pixel::Pixel,
    raster::active::QueueState,
};
use core::{hint::black_box, ops::Range};
use embedded_graphics_core::primitives::Rectangle;
use part::Part;
use scene::Scene;

/// One frame, drawn band by band from the top.
#[derive(Debug)]
pub struct Frame<'r, C: Pixel> {
    scene: Scene<'r, C>,
    part: Part<'r>,
}

impl<'r, C: Pixel> Frame<'r, C> {
    /// Frame `number` of a renderer.
    #[inline(never)]
    pub(crate) fn new(settings: &'r Settings<'r, C>, memory: &'r mut Memory<'_, C>, number: u32) -> Self {
        let Memory { vertices, bins: entries, depth, reflectances, ramps, samples, active_triangles } = memory;
        let (stream, size) = (&settings.stream, settings.size);
        let camera = &stream.header.camera;
        let pose = Pose::new(camera, number);
        let lighting = Lighting::new(stream, &pose);
        let constant = lighting.constant();
        let view = View::new(camera, &pose, size);
        let facing = Facing::new(&view, stream.header.radius);
        // Bins as high as the bands of one processor.
        let band_rows = settings.band_rows(depth.len(), samples.len()).checked_div(settings.processors).unwrap_or(0);
        let mut scene = Scene { settings, view, facing, lighting, constant, depth_elision: None, vertices: &[], reflectances, ramps };
        let mut part = Part {
            bins: Bins::new(size.height, band_rows),
            binned: false,
            entries,
            depth,
            samples,
            active_triangles,
            queue: QueueState::default(),
            rows: 0..size.height,
            top: 0,
            bottom: size.height,
            stats: Stats { triangles: stream.triangles.len() as u32, ..Stats::default() },
        };
        prepare(&mut scene, vertices, &mut part);
        scene.vertices = vertices;
        Self { scene, part }
    }

    /// Draws the next band into the front of `pixels`, row by row, and returns the area that it fills; `None` after the last.
    ///
    /// The first `area.size.width * area.size.height` entries of `pixels` are the band. A slice shorter than a band gets fewer rows.
    ///
    /// # Errors
    /// When `pixels` does not hold one row.
    pub fn next_band(&mut self, pixels: &mut [C]) -> Result<Option<Rectangle>, RenderError> {
        self.part.next_band(&self.scene, pixels)
    }

    /// The rows that triangles can reach; all other rows are background.
    #[must_use]
    pub fn rows(&self) -> Range<u32> {
        self.part.rows.clone()
    }

    /// The row above which a `share` of the triangles end, of 2^16: about where [`Self::in_two`] has to divide the frame for two processors
    /// to share the work so.
    #[must_use]
    pub fn row_at(&self, share: u16) -> u32 {
        self.part.bins.row_at(self.part.entries, share)
    }

    /// Draws only these `rows`; to be called before the first band. It is enough to draw and send the rows that triangles reach in this
    /// frame or reached in the frame before, see [`Self::rows`]: a display that shows the frame before has background in all others.
    pub fn limit(&mut self, rows: Range<u32>) {
        self.part.limit(rows, self.scene.settings.size.height);
    }

    /// Whether the last band has been drawn.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.part.is_complete()
    }

    /// The counts so far; they are complete after the last band.
    #[must_use]
    pub fn stats(&self) -> Stats {
        self.part.stats.culled()
    }

    /// Divides the frame, before its first band, into the rows above `row` and those from there on, for two processors to draw at the same
    /// time. The memory for bands is divided as well: that of a layout for two [`crate::Layout::processors`] gives each its bands. Where
    /// triangles take more than half of the room that there is for them, the first part has all rows.
    #[must_use]
    pub fn in_two(self, row: u32) -> FrameInTwo<'r, C> {
        let Self { scene, part } = self;
        FrameInTwo { parts: part.in_two(row, scene.settings.size.width as usize), scene }
    }
}

/// A frame in two parts, see [`Frame::in_two`].
#[derive(Debug)]
pub struct FrameInTwo<'r, C: Pixel> {
    scene: Scene<'r, C>,
    parts: [Part<'r>; 2],
}

impl<'r, C: Pixel> FrameInTwo<'r, C> {
    /// The upper part and the lower one.
    #[must_use]
    pub fn parts(&mut self) -> [FramePart<'_, 'r, C>; 2] {
        let Self { scene, parts } = self;
        parts.each_mut().map(|part| FramePart { scene, part })
    }

    /// The counts so far; they are complete after the last band of both parts.
    #[must_use]
    pub fn stats(&self) -> Stats {
        let [upper, lower] = self.parts.each_ref().map(|part| part.stats);
        upper.and(lower).culled()
    }
}

/// One part of a frame, drawn band by band from its top.
#[derive(Debug)]
pub struct FramePart<'f, 'r, C: Pixel> {
    scene: &'f Scene<'r, C>,
    part: &'f mut Part<'r>,
}

impl<C: Pixel> FramePart<'_, '_, C> {
    /// Draws the next band, see [`Frame::next_band`].
    ///
    /// # Errors
    /// When `pixels` does not hold one row.
    pub fn next_band(&mut self, pixels: &mut [C]) -> Result<Option<Rectangle>, RenderError> {
        self.part.next_band(self.scene, pixels)
    }
}

/// Does what happens once a frame: culls triangles, transforms their vertices, and puts them into the bins of the rows that they start
/// in. Triangles are taken from the last to the first, in the order that [`Bins::push`] needs.
#[inline(never)]
fn prepare<C: Pixel>(scene: &mut Scene<'_, C>, cache: &mut [ScreenVertex], part: &mut Part<'_>) {
    // A copy, which stays in registers.
    let facing = scene.facing;
    let Scene { settings, view, lighting, constant, depth_elision, reflectances, .. } = scene;
    let Settings { stream, size, shader, .. } = settings;
    let viewport = settings.viewport();
    let Part { bins, entries, stats, rows, binned, .. } = part;
    // Reached by a pointer of its own, which is opaque to the compiler: instructions of Armv6-M reach little of a structure.
    let (bins, entries) = (black_box(bins), &mut **entries);
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
        *binned = true;
        (stats.passes, stats.drawn) = (1, count.into());
        *rows = bins.rows();
    }
}
