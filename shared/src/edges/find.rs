//! The outlines of a mesh: edges at which its visible surface ends, and edges at which its shading jumps.

use crate::{
    edges::{Edge, Place, cut::Flat},
    features::TRANSPARENCY,
    geometry::{
        clip::{clip, clip_edge},
        cull::Facing,
        projection::{ScreenVertex, State, View},
        viewport::{Bounds, Viewport},
    },
    stream::record::{CREASE, Neighbours, OPEN, Triangle, Vertex},
};

/// The surface beyond an edge may be nearer than the edge by 2^-`RISE` of its inverse depth. At 240x240, a floor that is seen under 45 degrees rises
/// by this within half a pixel.
const RISE: u32 = 9;

/// Where the inverse depth of a triangle changes by more than 2^-`STEEP` of itself, a line at its rim could be seen through what is in front of it.
const STEEP: u32 = 4;

/// A mesh in one frame, whose outlines are found.
pub(crate) struct Outlined<'f> {
    pub(crate) view: &'f View,
    pub(crate) facing: Facing,
    pub(crate) triangles: &'f [Triangle],
    pub(crate) neighbours: &'f [Neighbours],
    pub(crate) vertices: &'f [Vertex],
    /// The cached vertices on the screen.
    pub(crate) cached: &'f [ScreenVertex],
    /// Whether something is seen through it, so that the depth buffer does not have its depth.
    pub(crate) is_transparent: bool,
}

/// Triangles of a mesh, one bit each.
pub(crate) type Set = [u32];

/// Whether a triangle is in `set`.
#[inline]
pub(crate) fn has(set: &Set, triangle: u16) -> bool {
    set.get(usize::from(triangle >> 5)).is_some_and(|word| word >> (triangle & 31) & 1 != 0)
}

/// Adds a triangle to `set`.
#[inline]
pub(crate) fn add(set: &mut Set, triangle: usize) {
    if let Some(word) = set.get_mut(triangle >> 5) {
        *word |= 1 << (triangle & 31);
    }
}

impl Outlined<'_> {
    /// Calls `put` with the outlines that belong to a triangle that faces the viewer. `faces` tells of each neighbour whether it does so, too.
    #[inline(always)]
    pub(crate) fn edges(&self, triangle: usize, faces: impl Fn(u16) -> bool, put: &mut dyn FnMut(&Edge)) {
        let Some(Neighbours([a, b, c])) = self.neighbours.get(triangle).copied() else { return };
        // No triangle has the number `OPEN`.
        let surrounded = faces(a & OPEN) && faces(b & OPEN) && faces(c & OPEN);
        if !surrounded || (a | b | c) & CREASE != 0 {
            for (k, neighbour) in [a, b, c].into_iter().enumerate() {
                let other = neighbour & OPEN;
                if !faces(other) {
                    self.put(triangle, k, (other == OPEN).then_some(triangle), put);
                } else if neighbour & CREASE != 0 && usize::from(other) > triangle {
                    self.put(triangle, k, Some(other.into()), put);
                }
            }
        }
    }

    /// Calls `put` with edge `k` of a triangle. The triangle `other` is seen beyond the edge, if any is.
    #[inline(never)]
    fn put(&self, triangle: usize, k: usize, other: Option<usize>, put: &mut dyn FnMut(&Edge)) {
        let Some(triangle) = self.triangles.get(triangle) else { return };
        let beyond = other.and_then(|other| self.triangles.get(other)).map(|other| self.range(other));
        // Seen from the front, corners run counter-clockwise, and the surface lies to the left.
        let [a, b, c] = triangle.corners;
        let (from, to) = match k {
            0 => (b, a),
            1 => (c, b),
            _ => (a, c),
        };
        let ends = match (self.cached(from), self.cached(to)) {
            (Some(from), Some(to)) => Some([from, to]),
            _ => self.clipped([from, to]),
        };
        let Some([from, to]) = ends else { return };
        // An object may stand on a surface. That surface is nearer than the object's lower edge, because it rises towards the viewer.
        let beyond = beyond.unwrap_or(from[2].max(to[2]) >> RISE);
        // The depth of a transparent surface is not known: whatever is seen beside its edge lies behind it, or the surface beyond is nearer.
        let range = if TRANSPARENCY && self.is_transparent { i32::MAX } else { self.range(triangle) };
        if let Some(edge) = Edge::new([from, to], range, beyond) {
            put(&edge);
        }
    }

    /// The place of a corner on the screen, if it is cached and need not be clipped.
    #[inline]
    fn cached(&self, corner: u16) -> Option<Place> {
        let vertex = self.cached.get(usize::from(corner)).filter(|vertex| vertex.state == State::READY)?;
        Some([vertex.x, vertex.y, vertex.depth])
    }

    /// The part of an edge that can be projected.
    #[cold]
    #[inline(never)]
    fn clipped(&self, ends: [u16; 2]) -> Option<[Place; 2]> {
        let [from, to] = ends.map(|corner| self.vertices.get(usize::from(corner)));
        clip_edge(self.view, [from?, to?])
    }

    /// Whether a triangle may face the viewer.
    #[inline]
    pub(crate) fn may_face(&self, triangle: usize) -> bool {
        self.triangles.get(triangle).is_some_and(|triangle| self.facing.may_face(triangle))
    }

    /// A triangle that may cut others, if it faces the viewer and need not be clipped.
    pub(crate) fn flat(&self, triangle: usize) -> Option<Flat> {
        self.flat_of(self.triangles.get(triangle)?)
    }

    #[inline(never)]
    fn flat_of(&self, triangle: &Triangle) -> Option<Flat> {
        let place = |corner: u16| self.cached(corner).or_else(|| self.projected(corner));
        let [a, c, b] = triangle.corners;
        Flat::new([place(a)?, place(b)?, place(c)?])
    }

    /// The place of a corner that is not cached.
    #[cold]
    #[inline(never)]
    fn projected(&self, corner: u16) -> Option<Place> {
        let position = self.vertices.get(usize::from(corner))?.position;
        let (place, inside) = self.view.lens.project(self.view.to_eye(position));
        inside.then_some(place)
    }

    /// The range of inverse depth of a triangle. Where that is large, it is the range within a pixel.
    #[inline]
    fn range(&self, triangle: &Triangle) -> i32 {
        let [a, b, c] = triangle.corners;
        let [farthest, nearest] = match (self.cached(a), self.cached(b), self.cached(c)) {
            (Some([.., a]), Some([.., b]), Some([.., c])) => [a.min(b).min(c), a.max(b).max(c)],
            _ => self.clipped_depths(triangle),
        };
        let range = nearest.wrapping_sub(farthest);
        if range <= nearest >> STEEP { range } else { self.flat_of(triangle).map_or(range, |flat| flat.range()) }
    }

    /// The least and the largest inverse depth of what is left of a triangle after clipping.
    #[cold]
    #[inline(never)]
    fn clipped_depths(&self, triangle: &Triangle) -> [i32; 2] {
        let [a, c, b] = triangle.corners.map(|corner| self.vertices.get(usize::from(corner)));
        let (Some(a), Some(b), Some(c)) = (a, b, c) else { return [0; 2] };
        let polygon = clip(self.view, [a, b, c]);
        let depth = || polygon.iter().map(|cut| cut.place[2]);
        [depth().min().unwrap_or(0), depth().max().unwrap_or(0)]
    }

    /// Whether a triangle faces the viewer and touches a pixel of `area`.
    #[inline(never)]
    pub(crate) fn faces(&self, triangle: u16, viewport: Viewport, area: Bounds) -> bool {
        let triangle = self.triangles.get(usize::from(triangle)).filter(|triangle| self.facing.may_face(triangle));
        let Some([a, c, b]) = triangle.map(|triangle| triangle.corners) else { return false };
        let [a, b, c] = [a, b, c].map(|corner| self.vertices.get(usize::from(corner)));
        let (Some(a), Some(b), Some(c)) = (a, b, c) else { return false };
        viewport.touches_by(self.view, [a, b, c], area)
    }
}
