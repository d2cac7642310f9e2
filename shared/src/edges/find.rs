//! The outlines of a mesh: edges at which its visible surface ends, and edges at which its shading jumps.

use crate::{
    edges::{FeatureEdge, ScreenPoint, cut::Flat},
    features::TRANSPARENCY,
    geometry::{
        bin::Entry,
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

/// Triangles of a mesh, one bit each. A word is rotated by the number of a triangle, and the triangle's bit is the sign: this takes one instruction.
pub(crate) type Set = [u32];

/// A word whose sign tells whether a neighbour is in `set`; `None` if it is not.
#[inline]
fn sign(set: &Set, neighbour: u16) -> Option<u32> {
    set.get(usize::from((neighbour & OPEN) >> 5)).map(|word| word.rotate_right(neighbour.into()))
}

/// Adds the triangles of a mesh to `set`. Entries of the mesh, whose triangles begin with number `first`, come before others. Returns how many they
/// are.
#[inline(never)]
pub(crate) fn collect(set: &mut Set, entries: &[Entry], first: u32, triangles: u32) -> usize {
    let mut count = 0;
    for entry in entries {
        let triangle = entry.key.triangle().wrapping_sub(first);
        if triangle >= triangles {
            break;
        }
        if let Some(word) = set.get_mut((triangle >> 5) as usize) {
            *word |= (1u32 << 31).rotate_left(triangle);
        }
        count += 1;
    }
    count
}

impl Outlined<'_> {
    /// Calls `put` with the outlines of `entries`, which are all triangles of the mesh that face the viewer, and are in the set `facing`. They begin
    /// with number `first` in the frame.
    #[inline(never)]
    pub(crate) fn outlines(&self, entries: &[Entry], first: u32, facing: &Set, put: &mut dyn FnMut(&FeatureEdge)) {
        for entry in entries {
            let triangle = entry.key.triangle().wrapping_sub(first) as usize;
            let Some(&Neighbours([a, b, c])) = self.neighbours.get(triangle) else { continue };
            // Most have neighbours that face the viewer, and no crease. No triangle has the number `OPEN`.
            if let (Some(one), Some(two), Some(three)) = (sign(facing, a), sign(facing, b), sign(facing, c))
                && ((one & two & three & !(u32::from(a | b | c) << (31 - CREASE.ilog2()))) as i32) < 0
            {
                continue;
            }
            self.edges(triangle, |triangle| sign(facing, triangle).is_some_and(|word| (word as i32) < 0), put);
        }
    }

    /// Calls `put` with the outlines that belong to a triangle that faces the viewer. `faces` tells of each neighbour whether it does so, too.
    #[inline(never)]
    pub(crate) fn edges(&self, triangle: usize, faces: impl Fn(u16) -> bool, put: &mut dyn FnMut(&FeatureEdge)) {
        let Some(&Neighbours(neighbours)) = self.neighbours.get(triangle) else { return };
        for (k, neighbour) in neighbours.into_iter().enumerate() {
            let other = neighbour & OPEN;
            if !faces(other) {
                self.put(triangle, k, (other == OPEN).then_some(triangle), put);
            } else if neighbour & CREASE != 0 && usize::from(other) > triangle {
                self.put(triangle, k, Some(other.into()), put);
            }
        }
    }

    /// Calls `put` with edge `k` of a triangle. The triangle `other` is seen beyond the edge, if any is.
    #[inline(never)]
    fn put(&self, triangle: usize, k: usize, other: Option<usize>, put: &mut dyn FnMut(&FeatureEdge)) {
        let Some(triangle) = self.triangles.get(triangle) else { return };
        // Seen from the front, corners run counter-clockwise, and the surface lies to the left.
        let [a, b, c] = triangle.corners;
        let (from, to) = match k {
            0 => (b, a),
            1 => (c, b),
            _ => (a, c),
        };
        let third = a ^ b ^ c ^ from ^ to;
        let (from, to, range) = match (self.cached(from), self.cached(to), self.cached(third)) {
            (Some(from), Some(to), Some([.., depth])) => (from, to, self.range_of(triangle, [from[2], to[2], depth])),
            (from_place, to_place, _) => {
                let ends = from_place.zip(to_place).map_or_else(|| self.clipped([from, to]), |(from, to)| Some([from, to]));
                let Some([from, to]) = ends else { return };
                (from, to, self.range(triangle))
            }
        };
        // An object may stand on a surface. That surface is nearer than the object's lower edge, because it rises towards the viewer.
        let beyond = match other.and_then(|other| self.triangles.get(other)) {
            Some(other) => self.range(other),
            None => from[2].max(to[2]) >> RISE,
        };
        // The depth of a transparent surface is not known: whatever is seen beside its edge lies behind it, or the surface beyond is nearer.
        let range = if TRANSPARENCY && self.is_transparent { i32::MAX } else { range };
        if let Some(edge) = FeatureEdge::new([from, to], range, beyond) {
            put(&edge);
        }
    }

    /// The place of a corner on the screen, if it is cached and need not be clipped.
    #[inline]
    fn cached(&self, corner: u16) -> Option<ScreenPoint> {
        let vertex = self.cached.get(usize::from(corner)).filter(|vertex| vertex.state == State::READY)?;
        Some([vertex.x, vertex.y, vertex.depth])
    }

    /// The part of an edge that can be projected.
    #[cold]
    #[inline(never)]
    fn clipped(&self, ends: [u16; 2]) -> Option<[ScreenPoint; 2]> {
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
    fn projected(&self, corner: u16) -> Option<ScreenPoint> {
        let position = self.vertices.get(usize::from(corner))?.position;
        let (place, inside) = self.view.lens.project(self.view.to_eye(position));
        inside.then_some(place)
    }

    /// The range of inverse depth of a triangle. Where that is large, it is the range within a pixel.
    #[inline(never)]
    fn range(&self, triangle: &Triangle) -> i32 {
        let [a, b, c] = triangle.corners;
        let depths = match (self.cached(a), self.cached(b), self.cached(c)) {
            (Some([.., a]), Some([.., b]), Some([.., c])) => [a, b, c],
            _ => self.clipped_depths(triangle),
        };
        self.range_of(triangle, depths)
    }

    /// [`Self::range`] of a triangle whose corners have these inverse depths.
    #[inline]
    fn range_of(&self, triangle: &Triangle, [a, b, c]: [i32; 3]) -> i32 {
        let nearest = a.max(b).max(c);
        let range = nearest.wrapping_sub(a.min(b).min(c));
        if range <= nearest >> STEEP { range } else { self.range_in_pixel(triangle).unwrap_or(range) }
    }

    #[inline(never)]
    fn range_in_pixel(&self, triangle: &Triangle) -> Option<i32> {
        Some(self.flat_of(triangle)?.range())
    }

    /// The least and the largest inverse depth of what is left of a triangle after clipping, the latter twice.
    #[cold]
    #[inline(never)]
    fn clipped_depths(&self, triangle: &Triangle) -> [i32; 3] {
        let Some(vertices) = triangle.vertices(self.vertices) else { return [0; 3] };
        let polygon = clip(self.view, vertices);
        let depth = || polygon.iter().map(|cut| cut.place[2]);
        let (least, most) = (depth().min().unwrap_or(0), depth().max().unwrap_or(0));
        [least, most, most]
    }

    /// Whether a triangle faces the viewer and touches a pixel of `area`.
    #[inline(never)]
    pub(crate) fn faces(&self, triangle: u16, viewport: Viewport, area: Bounds) -> bool {
        let triangle = self.triangles.get(usize::from(triangle)).filter(|triangle| self.facing.may_face(triangle));
        let vertices = triangle.and_then(|triangle| triangle.vertices(self.vertices));
        vertices.is_some_and(|vertices| viewport.touches_by(self.view, vertices, area))
    }
}
