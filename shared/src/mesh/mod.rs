//! Drawing of the triangles of one mesh into a band: set-up and shading of each.

pub(crate) mod vertices;

use crate::{
    antialias,
    antialias::PixelSet,
    format::SUBPIXEL,
    geometry::{
        bin::{Key, Walk},
        clip,
        cull::Extent,
        depth_elision::DepthElision,
        projection::{ScreenVertex, State},
        viewport::{Bounds, Viewport},
    },
    lighting::output::Output,
    mesh::vertices::VertexStage,
    method::{DrawTriangle, General, Loops, Method, Shading, TriangleSetup, tiles},
    pixel::Pixel,
    raster::{
        band::Band,
        canvas::BandCanvas,
        triangle::{ScreenTriangle, turn, turned},
    },
    setup::{
        edge::MAX_STEPPED_WIDTH,
        gradients::{Gradients, MAX_FINE_THINNESS},
        steepness::Steepness,
    },
    stream::record::{Triangle, Vertex},
};

/// Data of one mesh in one frame that all of its triangles use.
pub(crate) struct MeshPass<'f, C: Pixel> {
    pub(crate) method: &'static dyn Method,
    pub(crate) shading: Shading<'f>,
    /// How steeply light depends on the fitted fields.
    pub(crate) steepness: Steepness,
    pub(crate) output: Output<'f, C>,
    pub(crate) stage: VertexStage<'f>,
    /// Places where triangles may overlap; `None` if they may overlap everywhere.
    pub(crate) depth_elision: Option<&'f DepthElision>,
    /// Number of triangles in the frame before this mesh.
    pub(crate) first_triangle: u32,
    pub(crate) triangles: &'f [Triangle],
    pub(crate) vertices: &'f [Vertex],
    /// The cached vertices on the screen.
    pub(crate) cached: &'f [ScreenVertex],
    pub(crate) viewport: Viewport,
    /// The columns to which wide triangles are cut.
    pub(crate) columns: [i32; 2],
    /// Whether light is interpolated in perspective.
    pub(crate) perspective: bool,
}

/// Width of a triangle, in 1/16 pixel, from which it is faster to draw only the columns of a partial frame. Edges are then divided in each row.
const WIDE: i32 = 96 << SUBPIXEL;
const _: () = assert!(WIDE > MAX_STEPPED_WIDTH, "others are stepped from end to end");

/// A triangle whose corners run clockwise on the screen.
struct MeshTriangle<'f> {
    corners: [&'f ScreenVertex; 3],
    triangle: &'f Triangle,
    /// The vertices of the mesh, to which the triangle's indices point.
    vertices: &'f [Vertex],
}

impl<C: Pixel> MeshPass<'_, C> {
    /// Draws the triangle `key` and all that follow in the same mesh, by the loops `L` where they can. Returns the number of pixels in `band`, and
    /// the first triangle of another mesh.
    #[inline(never)]
    pub(crate) fn run<L: Loops>(&self, mut key: Key, walk: &mut Walk<'_>, band: &mut Band<'_, C>) -> (u32, Option<Key>) {
        let mut pixels = 0u32;
        loop {
            // The mesh has every triangle of its entries.
            if let Some(triangle) = self.triangles.get(self.index(key)) {
                let drawn = if L::GENERAL || !key.is_word_sized() {
                    self.draw(L::draw, triangle, band)
                } else {
                    // A triangle that the loops decline is set up anew: if its set-up were passed on, that of all triangles would be kept
                    // in memory.
                    self.draw_word_sized::<L>(triangle, key.word(), band).unwrap_or_else(|| self.draw(General::draw, triangle, band))
                };
                pixels = pixels.saturating_add(drawn);
            }
            match walk.next() {
                Some(other) if self.index(other) < self.triangles.len() => key = other,
                other => return (pixels, other),
            }
        }
    }

    /// Index of a triangle in the mesh. It is beyond the mesh's end if the triangle belongs to a later mesh.
    #[inline(always)]
    fn index(&self, key: Key) -> usize {
        key.triangle().wrapping_sub(self.first_triangle) as usize
    }

    #[inline(never)]
    fn shade_generally(&self, setup: &TriangleSetup<'_>, band: &mut Band<'_, C>) -> u32 {
        tiles::shade(setup, &mut BandCanvas { band, output: &self.output }, |setup, canvas| self.method.shade(setup, &self.shading, canvas))
    }

    /// Draws a triangle of any size, by `loops` if possible. Returns the number of its pixels in `band`.
    #[inline(never)]
    pub(crate) fn draw(&self, loops: DrawTriangle<C>, triangle: &Triangle, band: &mut Band<'_, C>) -> u32 {
        match self.corners(triangle).filter(is_ready) {
            Some(corners) => self.draw_placed(loops, &MeshTriangle { corners, triangle, vertices: self.vertices }, band),
            None => self.draw_transformed_anew(loops, triangle, band),
        }
    }

    /// Draws a word-sized triangle, see [`Viewport::is_word_sized`]. `key` identifies it among active triangles. `None` if the loops cannot draw it.
    // Instructions of Armv6-M reach little of a large stack frame, so this is a call there.
    #[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
    #[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline(always))]
    fn draw_word_sized<L: Loops>(&self, triangle: &Triangle, key: u32, band: &mut Band<'_, C>) -> Option<u32> {
        let (by, corners) = turned(self.corners(triangle)?);
        let place = band.active.take(key);
        let (screen, gradients, needs_depth_test);
        if let Some(active_triangle) = place.and_then(|place| band.active.active_triangle(place)) {
            (screen, gradients) = (ScreenTriangle::resumed(active_triangle, by, band), Gradients::NONE);
            needs_depth_test = active_triangle.inv_depth().is_some();
        } else {
            let mut new = ScreenTriangle::word_sized((by, corners), key, band);
            if new.is_empty() {
                return Some(0);
            }
            gradients = Gradients::word_sized(new.corners, self.steepness);
            needs_depth_test = self.needs_depth_test(&new);
            if needs_depth_test {
                new.set_up_depth(&gradients);
            }
            screen = new;
        }
        let setup = TriangleSetup {
            screen: &screen,
            gradients: &gradients,
            corners,
            triangle,
            vertices: self.vertices,
            turned: by,
            needs_depth_test,
            perspective: self.perspective,
            pixels: PixelSet::Centres,
            place,
        };
        L::draw(&setup, &self.shading, self.output.tables, band)
    }

    /// The cached corners on the screen; `None` if one is not cached.
    #[inline(always)]
    fn corners(&self, triangle: &Triangle) -> Option<[&ScreenVertex; 3]> {
        let [a, c, b] = triangle.corners;
        Some([self.cached.get(usize::from(a))?, self.cached.get(usize::from(b))?, self.cached.get(usize::from(c))?])
    }

    /// Whether other triangles may overlap this one.
    #[inline(always)]
    fn needs_depth_test(&self, screen: &ScreenTriangle) -> bool {
        let [[x0, top], [x1, y1], [x2, y2]] = screen.corners;
        self.depth_elision.is_none_or(|elision| elision.needs_depth_test([x0.min(x1).min(x2), x0.max(x1).max(x2)], [top, y1.max(y2)]))
    }

    /// The visible bounding box of `triangle`; `None` if it shows its back, or no pixel can belong to it.
    pub(crate) fn bounds(&self, triangle: &Triangle) -> Option<Bounds> {
        match self.corners(triangle).filter(is_ready) {
            Some(corners) => self.viewport.bounds_of(corners),
            None => self.stage.bounds(self.viewport, self.vertices, triangle),
        }
    }

    /// Draws a triangle with a corner that is not cached or not on the screen: transforms all three corners, and clips the triangle if needed.
    #[cold]
    #[inline(never)]
    fn draw_transformed_anew(&self, loops: DrawTriangle<C>, triangle: &Triangle, band: &mut Band<'_, C>) -> u32 {
        let [a, c, b] = triangle.corners.map(|corner| self.vertices.get(usize::from(corner)));
        let (Some(a), Some(b), Some(c)) = (a, b, c) else { return 0 };
        let vertices = [a, b, c];
        let [a, b, c] = &vertices.map(|vertex| self.stage.transform(vertex));
        if is_ready(&[a, b, c]) {
            return self.draw_placed(loops, &MeshTriangle { corners: [a, b, c], triangle, vertices: self.vertices }, band);
        }
        // The fan that clipping leaves.
        let polygon = clip::clip(self.stage.view, vertices);
        let place = |cut: &clip::Cut| {
            let [x, y, depth] = cut.place;
            ScreenVertex { x, y, depth, ..self.stage.transform(&cut.vertex) }
        };
        let Some((first, rest)) = polygon.split_first() else { return 0 };
        let mut pixels = 0;
        for pair in rest.windows(2) {
            if let [second, third] = pair {
                let vertices = [first.vertex, second.vertex, third.vertex];
                let corners = [&place(first), &place(second), &place(third)];
                pixels += self.draw_placed(
                    loops,
                    &MeshTriangle { corners, triangle: &clip::record(triangle, &vertices), vertices: &vertices },
                    band,
                );
            }
        }
        pixels
    }

    fn draw_placed(&self, loops: DrawTriangle<C>, placed: &MeshTriangle<'_>, band: &mut Band<'_, C>) -> u32 {
        if cfg!(feature = "antialias") && self.viewport.antialiased {
            self.draw_antialiased(loops, placed, band)
        } else {
            self.draw_pixels(loops, PixelSet::Centres, placed, band)
        }
    }

    /// Draws the pixels wholly inside, then the edge pixels, with the corners on a finer grid.
    #[cold]
    #[inline(never)]
    fn draw_antialiased(&self, loops: DrawTriangle<C>, placed: &MeshTriangle<'_>, band: &mut Band<'_, C>) -> u32 {
        let finer = antialias::finer(placed.corners);
        let [a, b, c] = &placed.corners.map(|corner| antialias::refined(corner, finer));
        let is_narrow = Extent::new(placed.corners.map(|corner| [corner.x, corner.y])).contains_no_pixel();
        let inner = if is_narrow { 0 } else { self.draw_pixels(loops, PixelSet::Inner, placed, band) };
        inner + self.draw_pixels(loops, PixelSet::Edge(finer), &MeshTriangle { corners: [a, b, c], ..*placed }, band)
    }

    /// Sets up a triangle and draws the pixels of the set `pixels`.
    fn draw_pixels(&self, loops: DrawTriangle<C>, pixels: PixelSet, placed: &MeshTriangle<'_>, band: &mut Band<'_, C>) -> u32 {
        let by_rows = pixels == PixelSet::Centres;
        let screen = if by_rows {
            let [a, b, c] = placed.corners.map(|corner| corner.x);
            let is_wide = a.max(b).max(c).wrapping_sub(a.min(b).min(c)) >= WIDE;
            ScreenTriangle::new(placed.corners, if is_wide { self.columns } else { [0, band.width as i32] }, band.range())
        } else {
            ScreenTriangle::without_rows(placed.corners)
        };
        if by_rows && screen.is_empty() {
            return 0;
        }
        let Some(gradients) = Gradients::new(screen.corners, self.viewport.box_of(placed.corners, pixels.finer())) else { return 0 };
        let gradients = gradients.steep(self.steepness);
        // Most of the slivers of a fine mesh lie between the centres of pixels.
        if by_rows && gradients.is_thinner_than(MAX_FINE_THINNESS) && screen.covers_nothing() {
            return 0;
        }
        let setup = TriangleSetup {
            screen: &screen,
            gradients: &gradients,
            corners: turn(placed.corners, screen.turned),
            turned: screen.turned,
            triangle: placed.triangle,
            vertices: placed.vertices,
            needs_depth_test: self.needs_depth_test(&screen),
            perspective: self.perspective,
            pixels,
            place: None,
        };
        loops(&setup, &self.shading, self.output.tables, band).unwrap_or_else(|| self.shade_generally(&setup, band))
    }
}

#[inline(always)]
fn is_ready([a, b, c]: &[&ScreenVertex; 3]) -> bool {
    a.state == State::READY && b.state == State::READY && c.state == State::READY
}
