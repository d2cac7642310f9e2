//! Set-up of the triangles of one mesh, whatever their size. It knows no pixel format.

use crate::{
    features::COLOURED,
    format::SUBPIXEL,
    geometry::{
        bin::TriangleKey,
        clip,
        depth_elision::DepthElision,
        projection::{ScreenVertex, State},
        viewport::{Bounds, Viewport},
    },
    mesh::{
        painting::{Paint, Painting},
        vertices::VertexStage,
    },
    method::{Method, Shading, TriangleSetup},
    raster::triangle::{ScreenTriangle, turned},
    setup::{
        edge::MAX_STEPPED_WIDTH,
        gradients::{Gradients, MAX_FINE_THINNESS},
        steepness::Steepness,
    },
    stream::record::{Triangle, Vertex},
};

/// Data of one mesh in one frame that all of its triangles use.
pub(crate) struct MeshPass<'f> {
    pub(crate) method: &'static dyn Method,
    pub(crate) shading: Shading<'f>,
    /// How steeply light depends on the fitted fields.
    pub(crate) steepness: Steepness,
    pub(crate) stage: VertexStage<'f>,
    /// Places where triangles may overlap; `None` if they may overlap everywhere.
    pub(crate) depth_elision: Option<&'f DepthElision>,
    /// Number of triangles in the frame before this mesh.
    pub(crate) first_triangle: u32,
    pub(crate) triangles: &'f [Triangle],
    pub(crate) vertices: &'f [Vertex],
    /// The colours of the triangles.
    pub(crate) painting: Painting<'f>,
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
    paint: Paint,
}

/// The rows of a band, and what draws a triangle there that is set up. It returns the number of its pixels.
struct Target<'t> {
    width: i32,
    rows: [i32; 2],
    draw: &'t mut dyn FnMut(&TriangleSetup<'_>) -> u32,
}

impl MeshPass<'_> {
    /// Index of a triangle in the mesh. It is beyond the mesh's end if the triangle belongs to a later mesh.
    #[inline]
    pub(super) fn index(&self, key: TriangleKey) -> usize {
        key.triangle().wrapping_sub(self.first_triangle) as usize
    }

    /// The colours of a triangle of the mesh, whose corners are turned by `by`.
    #[inline(always)]
    pub(super) fn paint(&self, triangle: &Triangle, by: usize) -> Paint {
        self.painting.corners(|| self.triangles.element_offset(triangle), by)
    }

    /// The cached corners on the screen; `None` if one is not cached.
    #[inline(always)]
    pub(super) fn corners(&self, triangle: &Triangle) -> Option<[&ScreenVertex; 3]> {
        let [a, c, b] = triangle.corners;
        Some([self.cached.get(usize::from(a))?, self.cached.get(usize::from(b))?, self.cached.get(usize::from(c))?])
    }

    /// Whether other triangles may overlap this one.
    #[inline(always)]
    pub(super) fn needs_depth_test(&self, screen: &ScreenTriangle<'_>) -> bool {
        let [[x0, top], [x1, y1], [x2, y2]] = screen.corners();
        // Decision: depth.
        self.depth_elision.is_none_or(|elision| elision.needs_depth_test([x0.min(x1).min(x2), x0.max(x1).max(x2)], [top, y1.max(y2)]))
    }

    /// The visible bounding box of `triangle`; `None` if it shows its back, or no pixel can belong to it.
    pub(crate) fn bounds(&self, triangle: &Triangle) -> Option<Bounds> {
        match self.corners(triangle).filter(is_ready) {
            Some(corners) => self.viewport.bounds_of(corners),
            None => self.stage.bounds(self.viewport, self.vertices, triangle),
        }
    }

    /// Sets up a triangle of any size, in parts where it is clipped, and calls `draw` for each part, which returns the number of its
    /// pixels. The band is `width` pixels wide, and `rows` are its first row and one past its last. Returns the sum.
    pub(super) fn set_up(&self, triangle: &Triangle, width: i32, rows: [i32; 2], draw: &mut dyn FnMut(&TriangleSetup<'_>) -> u32) -> u32 {
        let target = &mut Target { width, rows, draw };
        let paint = self.paint(triangle, 0);
        match self.corners(triangle).filter(is_ready) {
            Some(corners) => self.set_up_placed(&MeshTriangle { corners, triangle, vertices: self.vertices, paint }, target),
            None => self.transform_anew(triangle, paint, target),
        }
    }

    /// Sets up a triangle with a corner that is not cached or not on the screen: transforms all three corners, and clips the triangle if needed.
    #[cold]
    #[inline(never)]
    fn transform_anew(&self, triangle: &Triangle, paint: Paint, target: &mut Target<'_>) -> u32 {
        let Some(vertices) = triangle.vertices(self.vertices) else { return 0 };
        let [a, b, c] = &vertices.map(|vertex| self.stage.transformed(vertex));
        // Decision: clip.
        if is_ready(&[a, b, c]) {
            return self.set_up_placed(&MeshTriangle { corners: [a, b, c], triangle, vertices: self.vertices, paint }, target);
        }
        // The fan that clipping leaves.
        let polygon = clip::clip_painted(self.stage.view, vertices, paint.attributes());
        let place = |cut: &clip::Cut| {
            let [x, y, depth] = cut.place;
            ScreenVertex { x, y, depth, ..self.stage.transformed(&cut.vertex) }
        };
        let Some((first, rest)) = polygon.split_first() else { return 0 };
        let mut pixels = 0;
        for pair in rest.windows(2) {
            if let [second, third] = pair {
                let vertices = [first.vertex, second.vertex, third.vertex];
                let corners = [&place(first), &place(second), &place(third)];
                let triangle = &clip::record(triangle, &vertices);
                let paint = paint.of_part([first.attributes, second.attributes, third.attributes]);
                pixels += self.set_up_placed(&MeshTriangle { corners, triangle, vertices: &vertices, paint }, target);
            }
        }
        pixels
    }

    fn set_up_placed(&self, placed: &MeshTriangle<'_>, target: &mut Target<'_>) -> u32 {
        let [a, b, c] = placed.corners.map(|corner| corner.x);
        let is_wide = a.max(b).max(c).wrapping_sub(a.min(b).min(c)) >= WIDE;
        let (by, corners) = turned(placed.corners);
        let screen = ScreenTriangle::new(corners, if is_wide { self.columns } else { [0, target.width] }, target.rows);
        if screen.is_empty() {
            return 0;
        }
        let Some(gradients) = Gradients::new(screen.corners(), self.viewport.box_of(placed.corners)) else { return 0 };
        let gradients = gradients.steep(self.steepness);
        // Most of the slivers of a fine mesh lie between the centres of pixels.
        if gradients.is_thinner_than(MAX_FINE_THINNESS) && screen.covers_nothing() {
            return 0;
        }
        let paint = placed.paint.turned(by);
        let setup = TriangleSetup {
            screen: &screen,
            gradients: &gradients,
            corners,
            albedos: paint.lent(),
            nodes_of_colours: [None; COLOURED],
            texture: self.painting.texture(&paint),
            turned: by,
            triangle: placed.triangle,
            vertices: placed.vertices,
            needs_depth_test: self.needs_depth_test(&screen),
            perspective: self.perspective,
            place: None,
        };
        (target.draw)(&setup)
    }
}

#[inline]
fn is_ready([a, b, c]: &[&ScreenVertex; 3]) -> bool {
    a.state == State::READY && b.state == State::READY && c.state == State::READY
}
