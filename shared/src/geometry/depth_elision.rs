//! Leaving out the depth test for triangles of a closed convex mesh.
//!
//! The front faces of a convex body do not hide one another: seen exactly, no pixel belongs to two. What is drawn is not that exact picture
//! `G` but `F`, whose corners are rounded, in the mesh, in eye space, and on the screen; each coordinate is moved by at most `d`
//! ([`crate::geometry::lens::Lens::moved`]). So a triangle that is thinner than it is moved may turn over, or let its neighbours overlap. A
//! triangle is *thick* if it lies in the viewport and is at least `3 d` thick in `F`. A triangle that is not thick, and may show its front
//! in `G`, *marks* the cells of a coarse grid that lie within `3 d` of its bounding box. A triangle whose box touches no marked cell is
//! drawn without depth test, all others are drawn with it, and the picture is the same:
//!
//! No pixel of a triangle `T` that is drawn without depth belongs to another one that is drawn. Suppose that the pixel `p` belongs to `T'`
//! as well. Neither marks its cell, so both are thick. On a thick triangle the displacement `G - F`, linear and no longer than √2 d at the
//! corners, has a slope below 1: 2 √2 d over 3 d. So it turns in `G` as it does in `F`, and both show their front in `G`. Let `q` and `q'`
//! be the points that `F` takes to `p` on `T` and `T'`, seen in `G`: each is within `d` of `p` along x and y. The outline of a convex body
//! is convex, so all of the segment from `q` to `q'` is covered by front faces. Each of them has in `F` a point within `2 d` of `p`, so it
//! is thick, or it would mark the cell of `p`. Along the segment therefore the way from `G` to `F` is continuous and, its slope differing
//! from one by less than one, never goes back: it takes `q` and `q'` to one `p` only if they are one point. This lies on an edge or corner
//! that `T` and `T'` share, of which the top-left rule gives `p` to one.
//!
//! The assumptions are what [`crate::stream::record::CLOSED_CONVEX`] promises: how near a convex body lies to the mesh, and how far planes
//! lean that were computed from rounded corners. An empty depth buffer also hides what is infinitely far: no pixel of the mesh is.

use crate::{
    format::{SUBPIXEL, UNIT},
    geometry::{cull::Extent, projection::View},
};
use core::ops::RangeInclusive;

/// Rows and columns of the grid.
const CELLS: u32 = u32::BITS;

/// Threshold of thickness, 1/16 pixel, from which every triangle is depth-tested.
const THICKEST: u32 = 1 << 12;

/// Least distance of the far plane behind the body, [`crate::format::Length`], so that no pixel is as far as an empty depth buffer.
const BEHIND: i32 = 1 << (UNIT - 6);

/// The cells of the screen where triangles may overlap.
#[derive(Clone, Debug)]
pub(crate) struct DepthElision {
    /// Least thickness of a thick triangle, 1/16 pixel.
    thickness: i32,
    /// Width and height of the viewport, 1/16 pixel.
    size: [i32; 2],
    /// Cells per 1/16 pixel, Q.16.
    scale: [i32; 2],
    /// Marked cells, a word for each row of the grid.
    marked: [u32; CELLS as usize],
}

impl DepthElision {
    /// A grid without marks for one frame of a single closed convex mesh; `None` if the mesh is too near.
    pub(crate) fn new(view: &View) -> Option<Self> {
        let (lens, size) = (&view.lens, view.lens.size());
        let thickness = lens.moved(3);
        // The body lies within one unit of its origin.
        let is_seen = lens.is_perspective() || view.origin[2] + (1 << UNIT) + BEHIND <= lens.far;
        let size = [size.width, size.height].map(|side| (side << SUBPIXEL) as i32);
        (is_seen && thickness < THICKEST).then_some(Self {
            thickness: thickness as i32,
            size,
            // The last coordinate lies in the last cell.
            scale: size.map(|side| ((CELLS << 16) as i32).checked_div(side + 1).unwrap_or(0)),
            marked: [0; CELLS as usize],
        })
    }

    /// Takes a triangle into account that may show its front: marks the cells around it unless it is thick.
    #[inline]
    pub(crate) fn include(&mut self, extent: &Extent) {
        let (columns, rows) = ([extent.left, extent.right], [extent.top, extent.bottom]);
        // The thickness is at least twice the area over the length.
        if !self.is_inside(columns, rows) || extent.area.unsigned_abs() < (self.thickness * extent.length()) as u32 {
            self.mark(columns, rows);
        }
    }

    // Not by an extent: if its address were taken, that of every triangle would lie in memory.
    #[inline(never)]
    fn mark(&mut self, [left, right]: [i32; 2], [top, bottom]: [i32; 2]) {
        let ([width, height], around) = (self.size, self.thickness);
        // `clamp` panics if the ends are in the wrong order.
        let columns = [left - around, right + around].map(|x| x.max(0).min(width));
        let rows = [top - around, bottom + around].map(|y| y.max(0).min(height));
        let (rows, columns) = self.cells(columns, rows);
        self.marked.get_mut(rows).unwrap_or_default().iter_mut().for_each(|row| *row |= columns);
    }

    /// Takes the triangles into account that `other` has included.
    pub(crate) fn and(mut self, other: &Self) -> Self {
        self.marked.iter_mut().zip(other.marked).for_each(|(row, columns)| *row |= columns);
        self
    }

    /// Whether other triangles may overlap one in these columns and rows. Call it once all triangles have been included.
    #[inline(never)]
    pub(crate) fn needs_depth_test(&self, columns: [i32; 2], rows: [i32; 2]) -> bool {
        if !self.is_inside(columns, rows) {
            return true;
        }
        let (rows, columns) = self.cells(columns, rows);
        self.marked.get(rows).is_none_or(|rows| rows.iter().any(|row| row & columns != 0))
    }

    #[inline]
    fn is_inside(&self, [left, right]: [i32; 2], [top, bottom]: [i32; 2]) -> bool {
        let [width, height] = self.size;
        left | top | (width - right) | (height - bottom) >= 0
    }

    /// Rows and columns of the grid that a box in the viewport touches.
    #[inline]
    fn cells(&self, [left, right]: [i32; 2], [top, bottom]: [i32; 2]) -> (RangeInclusive<usize>, u32) {
        let [across, down] = self.scale;
        // Written out, as the compiler makes loops of maps on Armv6-M.
        let (left, right) = ((left * across) as u32 >> 16, (right * across) as u32 >> 16);
        let (top, bottom) = ((top * down) as usize >> 16, (bottom * down) as usize >> 16);
        (top..=bottom, (u32::MAX << (left & 31)) & (u32::MAX >> ((CELLS - 1).wrapping_sub(right) & 31)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_halves_mark_what_the_whole_does() {
        let size = [320, 240].map(|side| side << SUBPIXEL);
        let none = DepthElision { thickness: 40, size, scale: size.map(|side| (CELLS << 16) as i32 / (side + 1)), marked: [0; 32] };
        let [mut whole, mut earlier, mut later] = [none.clone(), none.clone(), none];
        for k in 0..40 {
            let (left, top) = (k * 997 % 4900, k * 613 % 3700);
            let extent = Extent::new([[left, top], [left + 100, top], [left, top + 20 + k % 4 * 40]]);
            whole.include(&extent);
            if k < 17 { &mut earlier } else { &mut later }.include(&extent);
        }
        assert!(earlier.marked != whole.marked && later.marked != whole.marked);
        assert_eq!(later.and(&earlier).marked, whole.marked);
    }
}
