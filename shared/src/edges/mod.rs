//! Smooth outlines, by a pass over the edges of surfaces in a finished band.
//!
//! A band is drawn without antialiasing. Then three steps smooth its outlines, each in integers:
//!
//! 1. Once a frame, [`find`] lists the edges at which a surface that faces the viewer ends (silhouettes), and the edges at which its shading jumps
//!    (creases). The stream has the neighbours of each triangle, and culling knows which triangles face the viewer. It also has the triangles that cut
//!    each other, and [`mod@cut`] finds the lines between them.
//! 2. In each band, [`walk`] follows the edges pixel by pixel. It computes which share of a pixel lies beyond the edge, and notes the share, and the
//!    direction of the neighbour that is seen there, in one byte. The depth of both pixels tells whether the edge can be seen between them.
//! 3. [`mix`] adds that share of the neighbour's colour to each noted pixel.
//!
//! Instead of being mixed, edges can be drawn as lines of one colour ([`Outlines`](crate::Outlines)): then the share is the one that a line along the
//! edge, one pixel wide, covers of both pixels.
//!
//! A pixel keeps the largest share that any edge notes, so the order of edges changes nothing. A pixel is mixed with the colours that its neighbours
//! had before the pass, and with pixels of the rows above and below the band, so the height of bands changes nothing either.

mod cut;
pub(crate) mod find;
pub(crate) mod mix;
pub(crate) mod walk;

use crate::{
    format::{DEPTH, SUBPIXEL},
    geometry::pixel_rect::PixelRect,
    math::vector::zip,
};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// An edge of a mesh that is seen as a line on the screen: a silhouette, a border, a crease, or where two surfaces cut each other. The surface lies to
/// its right, seen along the edge from its first end to its second one. It is aligned, so that it is copied word by word.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C, align(4))]
pub(crate) struct FeatureEdge {
    /// The ends `[x, y]`, in 1/16 pixel.
    ends: [[i16; 2]; 2],
    /// The inverse depth at both ends, in the format of the depth buffer.
    depth: [u16; 2],
    /// How far the surface beside the edge may be from the edge's own depth in the pixels next to it.
    range: u16,
    /// How far the pixel beyond the edge may be in front of the edge: the range of the other surface, or a small share of the edge's depth where there
    /// is none, see [`find`].
    beyond: u16,
}

/// A point on the screen: `[x, y, inverse depth]`, as [`crate::geometry::lens::Lens::project`] returns it.
pub(crate) type ScreenPoint = [i32; 3];

/// The largest coordinate of an edge, in 1/16 pixel. It lies beyond the widest picture.
const FARTHEST: i32 = i16::MAX as i32;

impl FeatureEdge {
    /// The edge between two points of a surface whose corners span a `range` of depth, see [`Self::range`] and [`Self::beyond`]. Returns `None` if it
    /// lies far outside of the picture.
    #[inline]
    pub(crate) fn new([from, to]: [ScreenPoint; 2], range: i32, beyond: i32) -> Option<Self> {
        let [from, to] = if is_near(from) && is_near(to) { [from, to] } else { cut([from, to])? };
        let place = |[x, y, _]: ScreenPoint| [x as i16, y as i16];
        let at_least = |range| in_buffer(range).saturating_add(2);
        let (range, beyond) = (at_least(range), at_least(beyond));
        Some(Self { ends: [place(from), place(to)], depth: [in_buffer(from[2]), in_buffer(to[2])], range, beyond })
    }

    /// The rows in which the edge may note a pixel, half open.
    #[inline]
    pub(crate) fn rows(&self) -> [i32; 2] {
        let [[_, a], [_, b]] = self.ends;
        touched(a, b)
    }

    /// The rows of `area` in which the edge may note a pixel, half open. Returns `None` if it notes none.
    #[inline]
    pub(crate) fn rows_in(&self, area: &PixelRect) -> Option<[u32; 2]> {
        let [[ax, ay], [bx, by]] = self.ends;
        let within = |[first, end]: [i32; 2], [from, to]: [u16; 2]| [first.max(from.into()), end.min(to.into())];
        let ([left, right], [top, bottom]) = (within(touched(ax, bx), area.columns), within(touched(ay, by), area.rows));
        (left < right && top < bottom).then_some([top as u32, bottom as u32])
    }
}

/// The pixels along one axis that an edge between two coordinates may note, half open.
#[inline]
fn touched(a: i16, b: i16) -> [i32; 2] {
    let half = 1 << (SUBPIXEL - 1);
    [(i32::from(a.min(b)) - half - 1) >> SUBPIXEL, ((i32::from(a.max(b)) - half) >> SUBPIXEL) + 2]
}

/// Converts a depth to the format of the depth buffer.
#[inline]
fn in_buffer(depth: i32) -> u16 {
    (depth >> (DEPTH - 16)) as u16
}

#[inline]
fn is_near([x, y, _]: ScreenPoint) -> bool {
    (x.wrapping_add(FARTHEST) | y.wrapping_add(FARTHEST)) as u32 <= 2 * FARTHEST as u32
}

/// Cuts an edge to coordinates that fit 16 bits.
#[cold]
#[inline(never)]
fn cut(mut ends: [ScreenPoint; 2]) -> Option<[ScreenPoint; 2]> {
    for (is_row, sign) in [(false, 1), (false, -1), (true, 1), (true, -1)] {
        let distance = |[x, y, _]: ScreenPoint| i64::from(FARTHEST - sign * if is_row { y } else { x });
        // The point of the border between an inner end at the distance `d` and an outer one at the distance `e`.
        let border = |inner: ScreenPoint, outer: ScreenPoint, d: i64, e: i64| -> ScreenPoint {
            let mixed = |from: i32, to: i32| from + ((i64::from(to) - i64::from(from)) * d).checked_div(d - e).unwrap_or(0) as i32;
            let [x, y, depth] = zip(inner, outer, mixed);
            if is_row { [x, sign * FARTHEST, depth] } else { [sign * FARTHEST, y, depth] }
        };
        let [from, to] = ends;
        let (a, b) = (distance(from), distance(to));
        match (a < 0, b < 0) {
            (true, true) => return None,
            (true, false) => ends = [border(to, from, b, a), to],
            (false, true) => ends = [from, border(from, to, a, b)],
            (false, false) => {}
        }
    }
    Some(ends)
}
