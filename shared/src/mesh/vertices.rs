//! The vertices of one mesh, transformed to the screen and lit.

use crate::{
    features::ALWAYS_CONSTANT,
    format::UNIT,
    geometry::{
        projection::{ScreenVertex, State, View},
        viewport::{Bounds, Viewport},
    },
    lighting::{
        albedo::IfColoured,
        facing::Facing,
        lights::{Lighting, MeanNormal, point, vertex_cosine},
        reflectance::LitMaterial,
        summed,
    },
    math::vector::{map, wide},
    method::VertexLight,
    stream::record::{Triangle, Vertex},
};

/// Column and row, 1/16 pixel, of a vertex that another processor transforms and lights.
pub(crate) type SeamPlace = [i32; 2];

/// The place of a vertex that no front face has used. Real places are nearer.
pub(crate) const UNUSED: SeamPlace = [i32::MIN; 2];

/// The place of a vertex whose triangles are clipped.
const CLIPPED: SeamPlace = [i32::MAX; 2];

/// The vertex stage of one mesh in one frame.
pub(crate) struct VertexStage<'f> {
    pub(crate) view: &'f View,
    pub(crate) lighting: &'f Lighting,
    /// See [`Lighting::constant`].
    pub(crate) constant: Option<&'f [[i32; 3]; 2]>,
    pub(crate) reflectance: LitMaterial<'f>,
    /// The light that the method needs at vertices.
    pub(crate) light: VertexLight,
    /// Whether corners of triangles have colours.
    pub(crate) has_colours: IfColoured<bool>,
}

impl VertexStage<'_> {
    /// Whether corners of triangles have colours.
    #[inline(always)]
    pub(crate) fn is_coloured(&self) -> bool {
        self.has_colours.first().is_some_and(|&has_colours| has_colours)
    }

    /// Whether vertices hold [`Parts`](crate::lighting::albedo::Parts) in place of levels, because the corners of triangles have colours. A reflection
    /// of one constant light says as much in fewer instructions.
    #[inline(always)]
    pub(crate) fn holds_parts(&self) -> bool {
        self.is_coloured() && self.has_levels() && (self.constant.is_none() || self.light != VertexLight::ReflectionOrLevels)
    }

    /// Whether vertices hold levels, or nothing, unless there is one constant light.
    #[inline(always)]
    fn has_levels(&self) -> bool {
        match self.light {
            VertexLight::Cosines => false,
            VertexLight::CosinesAndReflection => !(self.lighting.is_constant() || self.lighting.has_cone()),
            _ => true,
        }
    }

    /// The corners `[x, y]` on the screen, clockwise, which is against the order of the stream; `None` if one is not cached or needs
    /// clipping. The mesh is `cached` from its vertex `first` on.
    #[inline(always)]
    pub(crate) fn corners(
        &self,
        cached: &mut [ScreenVertex],
        first: usize,
        vertices: &[Vertex],
        triangle: &Triangle,
    ) -> Option<[[i32; 2]; 3]> {
        let [a, b, c] = triangle.corners;
        let mut place = |corner| self.place(cached, first, vertices, corner);
        Some([place(a)?, place(c)?, place(b)?])
    }

    /// Places of a triangle's corners where the other processor caches the vertices before `first`. This processor keeps the places of these in
    /// `seam`.
    #[inline(always)]
    pub(crate) fn corners_at_seam(
        &self,
        cached: &mut [ScreenVertex],
        seam: &mut [SeamPlace],
        vertices: &[Vertex],
        triangle: &Triangle,
    ) -> Option<[[i32; 2]; 3]> {
        let ([a, b, c], first) = (triangle.corners, seam.len());
        let mut place = |corner| match seam.get_mut(usize::from(corner)) {
            Some(place) => {
                if *place == UNUSED {
                    let ([x, y, _], inside) = self.view.lens.project(self.view.to_eye(vertices.get(usize::from(corner))?.position));
                    *place = if inside { [x, y] } else { CLIPPED };
                }
                (*place != CLIPPED).then_some(*place)
            }
            None => self.place(cached, first, vertices, corner),
        };
        Some([place(a)?, place(c)?, place(b)?])
    }

    /// Transforms vertices at the seam that are used here, but by no triangle of the processor that caches them, and lights vertices that are not
    /// lit.
    #[inline(never)]
    pub(crate) fn close_seam(&self, cached: &mut [ScreenVertex], seam: &[SeamPlace], vertices: &[Vertex]) {
        for ((screen, place), vertex) in cached.iter_mut().zip(seam).zip(vertices) {
            if *place != UNUSED {
                if screen.state == State::IDLE {
                    self.transform(vertex, screen);
                }
                self.light_up(screen, vertex);
            }
        }
    }

    /// Lights a vertex that was transformed without light. A vertex that no light reaches may be lit again, with the same result.
    #[inline(always)]
    pub(crate) fn light_up(&self, screen: &mut ScreenVertex, vertex: &Vertex) {
        if screen.state == State::READY && screen.light == [0; 4] {
            screen.light = self.late_light(vertex);
        }
    }

    #[inline(never)]
    fn late_light(&self, vertex: &Vertex) -> [i32; 4] {
        self.light_at(vertex)
    }

    /// The position of `corner` on the screen; it is transformed at its first use.
    #[inline(always)]
    fn place(&self, cached: &mut [ScreenVertex], first: usize, vertices: &[Vertex], corner: u16) -> Option<[i32; 2]> {
        let screen = cached.get_mut(usize::from(corner).wrapping_sub(first))?;
        if screen.state != State::READY {
            if screen.state == State::IDLE {
                self.transform(vertices.get(usize::from(corner))?, screen);
            }
            if screen.state != State::READY {
                return None;
            }
        }
        Some([screen.x, screen.y])
    }

    /// Transforms a vertex to `screen`, and lights it if the method needs that. It is not returned, because it would be copied.
    #[inline(never)]
    fn transform(&self, vertex: &Vertex, screen: &mut ScreenVertex) {
        let ([x, y, depth], inside) = self.view.lens.project(self.view.to_eye(vertex.position));
        (screen.x, screen.y, screen.depth) = (x, y, depth);
        screen.state = if inside { State::READY } else { State::OUTSIDE };
        screen.light = self.light_at(vertex);
    }

    /// A vertex that is not cached, transformed and lit.
    #[inline(never)]
    pub(crate) fn transformed(&self, vertex: &Vertex) -> ScreenVertex {
        let mut screen = ScreenVertex::IDLE;
        self.transform(vertex, &mut screen);
        screen
    }

    /// The light of a vertex, as [`ScreenVertex::light`] describes it.
    #[inline(always)]
    fn light_at(&self, vertex: &Vertex) -> [i32; 4] {
        match (self.light, self.constant) {
            (VertexLight::None, _) => [0; 4],
            // All scenes have one constant light then.
            (_, None) if ALWAYS_CONSTANT => [0; 4],
            (light, Some([towards, half])) if light != VertexLight::Levels || !self.reflectance.three_channels() => {
                let normal = wide(vertex.normal);
                self.under_one_light(light, [vertex_cosine(normal, *towards), vertex_cosine(normal, *half)])
            }
            _ => self.under_lights(vertex),
        }
    }

    /// The light of a vertex under any lights.
    #[inline(never)]
    fn under_lights(&self, vertex: &Vertex) -> [i32; 4] {
        let (normal, reflectance, lighting) = (wide(vertex.normal), &self.reflectance, self.lighting);
        let (has_levels, holds_parts) = (self.has_levels(), self.holds_parts());
        match lighting.is_constant() {
            true if holds_parts => reflectance.constant_parts(lighting.sources(), &MeanNormal::at(normal)).packed(),
            true if has_levels => of_levels(reflectance.constant_levels(lighting.sources(), &MeanNormal::at(normal))),
            true if reflectance.has_two_lights() => self.cosines_of_two_lights(normal),
            true if reflectance.sums_lights() => summed::at_vertex(reflectance, lighting.sources(), normal),
            false if has_levels => {
                let mut facing = Facing::default();
                let wanted = (self.light == VertexLight::CosinesAndReflection).then_some(&mut facing);
                let incident = lighting.incident(point(vertex.position), map(normal, |c| c << (30 - UNIT)), wanted);
                let levels = if holds_parts { reflectance.parts(incident).packed() } else { of_levels(reflectance.levels(incident)) };
                facing.beside(levels)
            }
            _ => [0; 4],
        }
    }

    /// The light of a vertex with these cosines of one constant light.
    #[inline(always)]
    fn under_one_light(&self, light: VertexLight, [towards, half]: [i32; 2]) -> [i32; 4] {
        match light {
            VertexLight::Cosines | VertexLight::CosinesOrLevels => [towards, half, 0, 0],
            VertexLight::Levels => [self.reflectance.level([towards, half]); 4],
            _ if self.reflectance.three_channels() || self.is_coloured() => [towards, half, self.reflectance.highlight(half) as i32, 0],
            _ => [towards, half, self.reflectance.level([towards, half]), 0],
        }
    }

    /// N·L and N·H of one light, then of the other, Q2.30.
    #[inline(always)]
    fn cosines_of_two_lights(&self, normal: [i32; 3]) -> [i32; 4] {
        let [one, other] = self.lighting.sources() else { return [0; 4] };
        let (Some([towards, half]), Some([other, other_half])) = (one.directional(), other.directional()) else { return [0; 4] };
        [vertex_cosine(normal, *towards), vertex_cosine(normal, *half), vertex_cosine(normal, *other), vertex_cosine(normal, *other_half)]
    }

    /// The visible bounding box of a triangle with a corner that is not cached or needs clipping.
    #[cold]
    #[inline(never)]
    pub(crate) fn bounds(&self, viewport: Viewport, vertices: &[Vertex], triangle: &Triangle) -> Option<Bounds> {
        let vertices = triangle.vertices(vertices)?;
        let corners = vertices.map(|vertex| self.transformed(vertex));
        if corners.iter().all(|corner| corner.state == State::READY) {
            viewport.bounds_of(corners.each_ref())
        } else {
            viewport.clipped_bounds(self.view, vertices)
        }
    }
}

/// The light of a vertex that has these levels of red, green and blue.
#[inline(always)]
fn of_levels([r, g, b]: [i32; 3]) -> [i32; 4] {
    [r, g, b, 0]
}
