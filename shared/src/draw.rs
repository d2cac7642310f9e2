//! The triangles of one mesh, each set up and shaded into a band.

use crate::{
    band::Band,
    clip,
    convex::Convex,
    cull::Extent,
    pixel::Pixel,
    poly::basis::Basis,
    raster::{
        smooth::{self, Part},
        triangle::{Bounds, Outline, turn},
    },
    render::{Stage, Viewport},
    shade::{Facet, Shading},
    stream::record::{Triangle, Vertex},
    vertex::{ScreenVertex, State},
};

/// What the triangles of one mesh have in common in one frame.
pub(crate) struct Drawing<'f, C> {
    pub(crate) shading: Shading<'f, C>,
    pub(crate) stage: Stage<'f, C>,
    /// Where triangles may overlap, if not everywhere.
    pub(crate) convex: Option<&'f Convex>,
    pub(crate) vertices: &'f [Vertex],
    /// Those on the screen, as far as they are kept.
    pub(crate) kept: &'f [ScreenVertex],
    pub(crate) viewport: Viewport,
    /// Interpolation in perspective, where it matters.
    #[cfg(feature = "all-shaders")]
    pub(crate) perspective: bool,
}

/// A triangle, its corners turning clockwise on the screen.
struct Face<'f> {
    corners: [&'f ScreenVertex; 3],
    vertices: [&'f Vertex; 3],
    triangle: &'f Triangle,
}

impl<C: Pixel> Drawing<'_, C> {
    /// Draws `triangle`; returns its pixels in `band`.
    #[inline(always)]
    pub(crate) fn draw(&self, triangle: &Triangle, band: &mut Band<'_, C>) -> u32 {
        let [a, b, c] = places(triangle);
        let (Some(p), Some(q), Some(r)) = (self.vertices.get(a), self.vertices.get(b), self.vertices.get(c)) else { return 0 };
        let vertices = [p, q, r];
        match self.corners([a, b, c]) {
            Some(corners) => self.face(&Face { corners, vertices, triangle }, band),
            None => self.other(vertices, triangle, band),
        }
    }

    /// Corners on the screen; `None` if one is not kept, or not on the screen.
    #[inline(always)]
    fn corners(&self, [a, b, c]: [usize; 3]) -> Option<[&ScreenVertex; 3]> {
        let corners = [self.kept.get(a)?, self.kept.get(b)?, self.kept.get(c)?];
        is_ready(corners).then_some(corners)
    }

    /// The visible box of `triangle`; `None` if it shows its back, or no pixel can belong to it.
    pub(crate) fn bounds(&self, triangle: &Triangle) -> Option<Bounds> {
        match self.corners(places(triangle)) {
            Some([a, b, c]) => self.viewport.bounds(&Extent::new([[a.x, a.y], [b.x, b.y], [c.x, c.y]])),
            None => self.stage.bounds(self.viewport, self.vertices, triangle),
        }
    }

    /// Draws a triangle whose corners are not kept, or not on the screen.
    #[cold]
    #[inline(never)]
    fn other(&self, vertices: [&Vertex; 3], triangle: &Triangle, band: &mut Band<'_, C>) -> u32 {
        let [a, b, c] = &vertices.map(|vertex| self.stage.transform(vertex));
        if is_ready([a, b, c]) {
            return self.face(&Face { corners: [a, b, c], vertices, triangle }, band);
        }
        // The fan that clipping leaves.
        let polygon = clip::clip(self.stage.view, vertices);
        let place = |cut: &clip::Cut| {
            let ([x, y, depth], _) = self.stage.view.project(cut.eye);
            ScreenVertex { x, y, depth, ..self.stage.transform(&cut.vertex) }
        };
        let Some((first, rest)) = polygon.split_first() else { return 0 };
        let mut pixels = 0;
        for pair in rest.windows(2) {
            if let [second, third] = pair {
                let vertices = [&first.vertex, &second.vertex, &third.vertex];
                let corners = [&place(first), &place(second), &place(third)];
                pixels += self.face(&Face { corners, vertices, triangle: &clip::record(triangle, vertices) }, band);
            }
        }
        pixels
    }

    fn face(&self, face: &Face<'_>, band: &mut Band<'_, C>) -> u32 {
        if self.viewport.antialiased { self.smooth(face, band) } else { self.part(Part::Centres, face, band) }
    }

    /// Draws the pixels wholly inside, then the others that it touches, with its corners on a finer grid.
    #[cold]
    #[inline(never)]
    fn smooth(&self, face: &Face<'_>, band: &mut Band<'_, C>) -> u32 {
        let finer = smooth::finer(face.corners);
        let [a, b, c] = &face.corners.map(|corner| smooth::refined(corner, finer));
        self.part(Part::Inner, face, band) + self.part(Part::Rim(finer), &Face { corners: [a, b, c], ..*face }, band)
    }

    /// Sets up a triangle and draws part of its pixels.
    fn part(&self, part: Part, face: &Face<'_>, band: &mut Band<'_, C>) -> u32 {
        let outline = Outline::new(face.corners, part);
        // Not one option or the other, which would be a copy.
        let (small, any);
        let basis = match Basis::small(outline.corners) {
            Some(basis) => {
                small = basis;
                &small
            }
            None => {
                any = Basis::any(outline.corners, self.viewport.box_of(face.corners, outline.finer()));
                let Some(basis) = &any else { return 0 };
                basis
            }
        };
        let by = outline.turned;
        let corners = turn(face.corners, by);
        let facet = Facet {
            outline: &outline,
            basis,
            corners,
            vertices: turn(face.vertices, by),
            triangle: face.triangle,
            convex: self.convex,
            #[cfg(feature = "all-shaders")]
            nearness: self.nearness(corners),
        };
        self.shading.draw(&facet, band)
    }

    /// Nearness of the corners of a triangle that is to be shaded in perspective.
    #[cfg(feature = "all-shaders")]
    #[inline(always)]
    fn nearness(&self, corners: [&ScreenVertex; 3]) -> Option<[i32; 3]> {
        let [a, b, c] = corners;
        let (a, b, c) = (a.depth, b.depth, c.depth);
        // All of it equally far is all of it flat on the screen.
        (self.perspective && !(a == b && b == c)).then_some([a, b, c])
    }
}

/// Where the corners are, against the stream's order. Written out: `map` is a loop through memory at opt-level "s".
#[inline(always)]
fn places(triangle: &Triangle) -> [usize; 3] {
    let [a, c, b] = triangle.corners;
    [a.into(), b.into(), c.into()]
}

#[inline(always)]
fn is_ready([a, b, c]: [&ScreenVertex; 3]) -> bool {
    a.state == State::Ready && b.state == State::Ready && c.state == State::Ready
}
