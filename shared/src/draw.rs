//! The triangles of one mesh, each set up and shaded into a band.

use crate::{
    band::Band,
    bin::{Entry, Walk},
    clip,
    convex::Convex,
    cull::Extent,
    pixel::Pixel,
    poly::basis::Basis,
    raster::{
        smooth::{self, Part},
        triangle::{Bounds, Outline, turn, turned},
    },
    render::{Stage, Viewport},
    shade::{Any, Facet, Method, Shading},
    stream::record::{Triangle, Vertex},
    vertex::{ScreenVertex, State},
};
#[cfg(feature = "fast-loops")]
use crate::{
    shade::{duff, flat, gouraud, six_point},
    shader::Shader,
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
    triangle: &'f Triangle,
    /// Those that its indices are of.
    vertices: &'f [Vertex],
}

impl<C: Pixel> Drawing<'_, C> {
    /// Draws the triangle of `entry` and those that follow it in the same mesh, up to `end`; returns their pixels in `band`, and the first
    /// entry of another mesh.
    pub(crate) fn run(
        &self,
        triangles: &[Triangle],
        entry: Entry,
        walk: &mut Walk<'_>,
        end: u32,
        band: &mut Band<'_, C>,
    ) -> (u32, Option<Entry>) {
        match self.shading.shader {
            #[cfg(feature = "fast-loops")]
            Shader::Flat if self.is_plain() => self.each::<flat::Plain>(triangles, entry, walk, end, band),
            #[cfg(feature = "fast-loops")]
            Shader::Gouraud if self.is_plain() => self.each::<gouraud::Plain>(triangles, entry, walk, end, band),
            #[cfg(feature = "fast-loops")]
            Shader::SixPoint if self.is_plain() => self.each::<six_point::Plain>(triangles, entry, walk, end, band),
            #[cfg(feature = "fast-loops")]
            Shader::Phong if self.is_plain() => self.each::<duff::Plain>(triangles, entry, walk, end, band),
            #[cfg(all(feature = "fast-loops", feature = "all-shaders"))]
            Shader::Sqrt6 if self.is_plain() => self.each::<crate::shade::sqrt6::Plain>(triangles, entry, walk, end, band),
            _ => self.each::<Any>(triangles, entry, walk, end, band),
        }
    }

    /// There is a shorter way for some methods: see [`Shading::is_plain`].
    #[cfg(feature = "fast-loops")]
    fn is_plain(&self) -> bool {
        #[cfg(feature = "all-shaders")]
        if self.perspective {
            return false;
        }
        self.shading.is_plain()
    }

    /// [`Self::run`] for one method, whose way through a simple triangle is compiled into the loop.
    #[inline(never)]
    fn each<M: Method>(
        &self,
        triangles: &[Triangle],
        mut entry: Entry,
        walk: &mut Walk<'_>,
        end: u32,
        band: &mut Band<'_, C>,
    ) -> (u32, Option<Entry>) {
        let mut pixels = 0u32;
        loop {
            // A stream that has been checked has it.
            if let Some(triangle) = triangles.get(entry.triangle() as usize) {
                let drawn = if !entry.is_simple() {
                    self.draw(triangle, band)
                } else if let Some(place) = band.relay.take(entry.key()) {
                    self.go_on::<M>(triangle, place, band)
                } else {
                    self.draw_simple::<M>(triangle, entry.key(), band).unwrap_or_else(|| self.draw(triangle, band))
                };
                pixels = pixels.saturating_add(drawn);
            }
            match walk.next() {
                Some(other) if other.triangle() < end => entry = other,
                other => return (pixels, other),
            }
        }
    }

    /// Draws `triangle`; returns its pixels in `band`.
    #[inline(never)]
    pub(crate) fn draw(&self, triangle: &Triangle, band: &mut Band<'_, C>) -> u32 {
        match self.corners(triangle).filter(is_ready) {
            Some(corners) => self.face(&Face { corners, triangle, vertices: self.vertices }, band),
            None => self.other(triangle, band),
        }
    }

    /// The same of a triangle that [`Viewport::is_simple`], by its `key` in [`crate::relay`].
    // Armv6-M reaches little of a large stack frame: a call of its own there.
    #[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
    #[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline(always))]
    fn draw_simple<M: Method>(&self, triangle: &Triangle, key: u32, band: &mut Band<'_, C>) -> Option<u32> {
        let corners = self.corners(triangle)?;
        let (by, corners) = turned(corners);
        let mut outline = Outline::simple((by, corners), key, band);
        if outline.is_empty() {
            return Some(0);
        }
        let basis = Basis::simple(outline.corners);
        let contested = self.contested(&outline);
        if contested {
            outline.see(&basis);
        }
        let facet = Facet {
            outline: &outline,
            basis: &basis,
            corners,
            triangle,
            vertices: self.vertices,
            contested,
            #[cfg(feature = "all-shaders")]
            perspective: M::ANY && self.perspective,
            place: None,
        };
        M::draw(&facet, &self.shading, band)
    }

    /// The same of a triangle that the band above handed on to `place`.
    #[inline(always)]
    fn go_on<M: Method>(&self, triangle: &Triangle, place: usize, band: &mut Band<'_, C>) -> u32 {
        let (Some(leg), Some(corners)) = (band.relay.leg(place), self.corners(triangle)) else { return 0 };
        let (by, corners) = turned(corners);
        let facet = Facet {
            outline: &Outline::handed_on(leg, by, band),
            basis: &Basis::NONE,
            corners,
            triangle,
            vertices: self.vertices,
            contested: leg.nearness.is_some(),
            #[cfg(feature = "all-shaders")]
            perspective: false,
            place: Some(place),
        };
        M::draw(&facet, &self.shading, band).unwrap_or_default()
    }

    /// Corners on the screen; `None` if one is not kept.
    #[inline(always)]
    fn corners(&self, triangle: &Triangle) -> Option<[&ScreenVertex; 3]> {
        let [a, c, b] = triangle.corners;
        Some([self.kept.get(usize::from(a))?, self.kept.get(usize::from(b))?, self.kept.get(usize::from(c))?])
    }

    /// Others may overlap a triangle.
    #[inline(always)]
    fn contested(&self, outline: &Outline) -> bool {
        let [[x0, top], [x1, y1], [x2, y2]] = outline.corners;
        self.convex.is_none_or(|convex| convex.contests([x0.min(x1).min(x2), x0.max(x1).max(x2)], [top, y1.max(y2)]))
    }

    /// The visible box of `triangle`; `None` if it shows its back, or no pixel can belong to it.
    pub(crate) fn bounds(&self, triangle: &Triangle) -> Option<Bounds> {
        match self.corners(triangle).filter(is_ready) {
            Some([a, b, c]) => self.viewport.bounds(&Extent::new([[a.x, a.y], [b.x, b.y], [c.x, c.y]])),
            None => self.stage.bounds(self.viewport, self.vertices, triangle),
        }
    }

    /// Draws a triangle whose corners are not kept, or not on the screen.
    #[cold]
    #[inline(never)]
    fn other(&self, triangle: &Triangle, band: &mut Band<'_, C>) -> u32 {
        let [a, c, b] = triangle.corners.map(|corner| self.vertices.get(usize::from(corner)));
        let (Some(a), Some(b), Some(c)) = (a, b, c) else { return 0 };
        let vertices = [a, b, c];
        let [a, b, c] = &vertices.map(|vertex| self.stage.transform(vertex));
        if is_ready(&[a, b, c]) {
            return self.face(&Face { corners: [a, b, c], triangle, vertices: self.vertices }, band);
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
                let vertices = [first.vertex, second.vertex, third.vertex];
                let corners = [&place(first), &place(second), &place(third)];
                pixels += self.face(&Face { corners, triangle: &clip::record(triangle, &vertices), vertices: &vertices }, band);
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
        let outline = Outline::new(face.corners, part, band);
        if outline.is_empty() {
            return 0;
        }
        let Some(basis) = Basis::new(outline.corners, self.viewport.box_of(face.corners, outline.finer())) else { return 0 };
        let facet = Facet {
            outline: &outline,
            basis: &basis,
            corners: turn(face.corners, outline.turned),
            triangle: face.triangle,
            vertices: face.vertices,
            contested: self.contested(&outline),
            #[cfg(feature = "all-shaders")]
            perspective: self.perspective,
            place: None,
        };
        self.shading.draw(&facet, band)
    }
}

#[inline(always)]
fn is_ready([a, b, c]: &[&ScreenVertex; 3]) -> bool {
    a.state == State::Ready && b.state == State::Ready && c.state == State::Ready
}
