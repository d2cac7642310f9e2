//! Follows an edge pixel by pixel, and notes which share of each pixel lies beyond it.
//!
//! An edge is walked along its longer axis. In each column of that axis (a column or a row of the picture) whose centre it passes, it runs between
//! the centres of two pixels, or through one of them. The area of the pixel on the other side of the edge is exact for the straight line.

use crate::{
    arch::quotient::{fraction, inverse},
    edges::FeatureEdge,
    format::SUBPIXEL,
};
use core::ops::Range;

/// Direction of a neighbour, the lower bits of a mark. The opposite direction differs in the first bit.
pub(crate) const UP: u8 = 0;
/// See [`UP`].
pub(crate) const DOWN: u8 = 1;
/// See [`UP`]. The neighbour to the right is the fourth one.
pub(crate) const LEFT: u8 = 2;

/// Bits of a direction.
pub(crate) const DIRECTION: u32 = 2;

/// Fraction bits of the share of a neighbour in a mark. A share is less than a half.
const SHARE: u32 = 7;

const ONE: i32 = 1 << 16;
const HALF: i32 = ONE / 2;

/// The rows of a picture in which edges are walked.
pub(crate) struct Window<'w> {
    /// How edges are walked whose longer axis is y, and how the ones whose longer axis is x.
    axes: [Axis<'w>; 2],
    /// Whether edges are lines.
    lines: bool,
    notes: Notes<'w>,
}

/// The pixels of a window, as edges see them that are walked along an axis.
struct Axis<'w> {
    /// Whether it is x.
    is_flat: bool,
    /// The columns of this axis, half open.
    majors: [i32; 2],
    /// The first pixel of a column.
    first_minor: i32,
    /// The number of pairs of pixels in a column.
    pairs: u32,
    /// The steps to the next column, and to the next pixel of a column.
    strides: [i32; 2],
    /// The place that a pixel of column 0 would have.
    origin: i32,
    /// The direction to the pixel before in a column.
    backwards: i32,
    /// The depth of the first pixel of a pair, and that of the second one, by the place of the first one.
    pair: [&'w [u16]; 2],
}

/// The pixels that are noted.
struct Notes<'w> {
    /// How many pixels whose depth is known come before the first one that may be noted.
    earlier: i32,
    /// A share and a direction for each pixel, or 0. If edges are lines, it is a share of 255.
    marks: &'w mut [u8],
    places: &'w mut [u16],
    /// Number of pixels that are noted. If it exceeds the places, some found no room.
    count: usize,
}

/// What the pixels along an edge have in common.
struct Slant {
    /// The step from the first pixel of a pair to the second one.
    stride: i32,
    /// The direction from the second pixel to the first one; the other direction is [`DOWN`] more.
    backwards: i32,
    /// Half of how far the edge rises in a column, Q.16, and 2^24 over 1/16 of that, see [`per_corner`].
    half_step: i32,
    per_corner: i32,
}

impl Notes<'_> {
    /// Notes pixels of a pair between whose centres an edge passes. `first` is the place of the first one among those whose depth is known, and the
    /// edge passes so far `behind` the border between both. Out of line, so that the loop over columns has registers enough.
    #[inline(never)]
    fn note(&mut self, slant: &Slant, first: i32, behind: i32) {
        let pixel = first.wrapping_sub(self.earlier);
        let &Slant { stride, backwards, half_step, per_corner } = slant;
        let (near, far, distance, direction) = if behind < 0 {
            (pixel, pixel.wrapping_add(stride), behind.wrapping_neg(), backwards | i32::from(DOWN))
        } else {
            (pixel.wrapping_add(stride), pixel, behind, backwards)
        };
        let past = half_step - distance;
        let mut share = distance;
        if past > 0 {
            let small = (((past >> 4) * (past >> 4)) >> 8).wrapping_mul(per_corner) >> 14;
            share += small;
            if small > 256 {
                self.mark(far, share_of(small, direction ^ i32::from(DOWN)));
            }
        }
        self.mark(near, share_of(share, direction));
    }

    /// Marks both pixels of a line that passes between them.
    #[cold]
    #[inline(never)]
    fn line(&mut self, stride: i32, first: i32, behind: i32) {
        let pixel = first.wrapping_sub(self.earlier);
        let share = ((behind + HALF) >> 8).clamp(1, 254);
        self.mark(pixel, 255 - share);
        self.mark(pixel.wrapping_add(stride), share);
    }

    /// Marks a pixel, unless it has a larger mark. Domain: `mark` is 1 to 255.
    #[inline]
    fn mark(&mut self, pixel: i32, mark: i32) {
        let Some(own) = self.marks.get_mut(pixel as usize) else { return };
        let old = i32::from(*own);
        if old == 0 {
            *own = mark as u8;
            if let Some(place) = self.places.get_mut(self.count) {
                *place = pixel as u16;
            }
            self.count += 1;
        } else if old < mark {
            *own = mark as u8;
        }
    }
}

/// The mark for a share of the neighbour in a direction; `share` is Q.16 and less than a half.
#[inline]
fn share_of(share: i32, direction: i32) -> i32 {
    (share >> (16 - SHARE)).clamp(0, (1 << (SHARE - 1)) - 1) << DIRECTION | direction
}

impl<'w> Window<'w> {
    /// The rows of a picture of `width` columns. The depth is known in `known` rows. Pixels are noted in other `rows`, a part of these: each has a
    /// mark, which is 0, and the noted ones are listed in `places`.
    pub(crate) fn new(
        width: usize,
        (known, depth): (&Range<u32>, &'w [u16]),
        rows: &Range<u32>,
        lines: bool,
        marks: &'w mut [u8],
        places: &'w mut [u16],
    ) -> Self {
        let pair = |stride: usize| {
            let second = depth.get(stride..).unwrap_or_default();
            [depth.get(..second.len()).unwrap_or_default(), second]
        };
        let (first, end, columns) = (known.start as i32, known.end as i32, width as i32);
        let steep = Axis {
            is_flat: false,
            majors: [rows.start as i32, rows.end as i32],
            first_minor: 0,
            pairs: columns.saturating_sub(1) as u32,
            strides: [columns, 1],
            origin: first.wrapping_mul(columns).wrapping_neg(),
            backwards: LEFT.into(),
            pair: pair(1),
        };
        let flat = Axis {
            is_flat: true,
            majors: [0, columns],
            first_minor: first,
            pairs: (end - first).saturating_sub(1) as u32,
            strides: [1, columns],
            origin: 0,
            backwards: UP.into(),
            pair: pair(width),
        };
        let earlier = (rows.start as i32 - first).wrapping_mul(columns);
        Self { axes: [steep, flat], lines, notes: Notes { earlier, marks, places, count: 0 } }
    }

    /// The number of pixels that are noted, if they have found room.
    pub(crate) fn close(self) -> Option<usize> {
        let Notes { marks, places, count, .. } = self.notes;
        if count > places.len() {
            marks.fill(0);
            return None;
        }
        Some(count)
    }

    /// Walks an edge.
    #[inline(never)]
    pub(crate) fn walk(&mut self, edge: &FeatureEdge) {
        // One by one: `map` of arrays goes through memory at opt-level "s".
        let FeatureEdge { ends: [[ax, ay], [bx, by]], depth: [a, b], range, beyond } = *edge;
        let (ax, ay, bx, by) = (i32::from(ax), i32::from(ay), i32::from(bx), i32::from(by));
        let Self { axes: [steep, flat], lines, notes } = self;
        // The major coordinate grows from the first end to the second.
        let (axis, mut m0, mut n0, mut m1, mut n1) =
            if (bx - ax).abs() >= (by - ay).abs() { (flat, ax, ay, bx, by) } else { (steep, ay, ax, by, bx) };
        let (mut z0, mut z1) = (i32::from(a), i32::from(b));
        let turns = m0 > m1;
        if turns {
            (m0, n0, z0, m1, n1, z1) = (m1, n1, z1, m0, n0, z0);
        }
        let Axis {
            is_flat,
            majors: [first_major, end_major],
            first_minor,
            pairs,
            strides: [major_stride, minor_stride],
            origin,
            backwards,
            pair,
        } = *axis;
        // Columns whose centre it passes.
        let half = 1 << (SUBPIXEL - 1);
        let first = ((m0 + half - 1) >> SUBPIXEL).max(first_major);
        let end = ((m1 + half - 1) >> SUBPIXEL).min(end_major);
        if first >= end {
            return;
        }
        // A line needs no pixel of its surface beside it: a part thinner than a pixel has none in many columns.
        let range = i32::from(if *lines { u16::MAX } else { range });
        let length = (m1 - m0) as u32;
        // 2^32 / length, shifted right by `zeros`.
        let zeros = length.leading_zeros().wrapping_sub(16) & 15;
        let reciprocal = inverse(length << zeros);
        // A pixel whose centre lies on the edge is before a line that descends to the right, and behind all others, as where triangles are filled:
        // its row begins there, or ends before. So the step is rounded up where the line descends, and down elsewhere: such centres stay on their
        // side. The part of a step to the first column is rounded down everywhere: at such a centre the exact value and the sum are integers, so a
        // sum that is less than 1 too small is not too small. At a column n, another centre nearer than n/65536 of a pixel may be taken for one on
        // the other side.
        let rise = n1 - n0;
        let (slope, rest) = fraction(rise.unsigned_abs(), length, (reciprocal, zeros));
        let size = slope as i32 + i32::from(rest > 0 && (rise < 0 || is_flat));
        let step = if rise < 0 { size.wrapping_neg() } else { size };
        let growth = z1 - z0;
        let depth_step = (growth.unsigned_abs().wrapping_mul(reciprocal >> 2) >> (18 - zeros)) as i32;
        let depth_step = if growth < 0 { depth_step.wrapping_neg() } else { depth_step };
        // `minor` is how far the edge lies behind the centre of the first pixel of the minor axis, Q.16. `least` is the least depth of the pixel on
        // the surface, Q.12. Both are those of the first column.
        let from = (first << SUBPIXEL) + half - m0;
        let minor = (n0 << (16 - SUBPIXEL)) + step.wrapping_mul(from >> SUBPIXEL) + (step.wrapping_mul(from & 15) >> SUBPIXEL);
        let mut minor = minor.wrapping_sub(HALF + i32::from(!(is_flat && rise > 0)) + (first_minor << 16));
        let mut least = (z0.wrapping_sub(range) << 12).wrapping_add(depth_step.wrapping_mul(from));
        // The pixel beyond the edge may be nearer than that by as much.
        let nearer = range + i32::from(beyond);
        let depth_step = depth_step << SUBPIXEL;
        let half_step = size >> 1;
        let slant = Slant { stride: minor_stride, backwards, half_step, per_corner: per_corner(half_step) };
        let (mut base, mut left) = (first.wrapping_mul(major_stride).wrapping_add(origin), end - first);
        // The surface lies on the side of larger minor coordinates where an edge runs to the right, or up.
        let [first, second] = pair;
        let (outer, inner) = if is_flat == turns { (second, first) } else { (first, second) };
        loop {
            // The last pixel whose centre lies before the edge; its pair is the next one.
            let low = minor >> 16;
            if (low as u32) < pairs {
                let at = base.wrapping_add(low.wrapping_mul(minor_stride));
                if let (Some(&outer), Some(&inner)) = (outer.get(at as usize), inner.get(at as usize))
                    && i32::from(inner) >= least >> 12
                    && i32::from(outer) <= (least >> 12).wrapping_add(nearer)
                {
                    let behind = (minor & (ONE - 1)) - HALF;
                    if *lines {
                        notes.line(minor_stride, at, behind);
                    } else {
                        notes.note(&slant, at, behind);
                    }
                }
            }
            left -= 1;
            if left == 0 {
                return;
            }
            base = base.wrapping_add(major_stride);
            minor = minor.wrapping_add(step);
            least = least.wrapping_add(depth_step);
        }
    }
}

/// 2^24 over 1/16 of `half_step`, for areas of corners; 0 if there are none.
#[inline]
fn per_corner(half_step: i32) -> i32 {
    let size = (half_step >> 4) as u32;
    if size == 0 {
        return 0;
    }
    let zeros = size.leading_zeros().wrapping_sub(16) & 15;
    let inverse = inverse(size << zeros);
    (if zeros < 8 { inverse >> (8 - zeros) } else { inverse << (zeros - 8) }) as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edges::{FeatureEdge, ScreenPoint};

    const SIDE: i32 = 64;

    /// Each noted pixel is mixed with a pixel on the other side of the edge, also where an edge passes exactly through centres of pixels, as many do:
    /// corners have only 16 places in a pixel.
    #[test]
    fn pixels_are_mixed_across_the_edge() {
        let (mut state, mut through_centres) = (1u32, 0);
        let mut number = |end: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((state >> 8) % end) as i32
        };
        for round in 0..4_000 {
            // Short edges, as most are, and long ones.
            let longest = if round % 2 == 0 { 64 } else { 640 };
            let [ax, ay] = [192 + number(640), 192 + number(640)];
            let [bx, by] = [ax, ay].map(|from| (from + number(2 * longest + 1) - longest as i32).clamp(16, 1008));
            let length = (bx - ax).abs().max((by - ay).abs());
            let side = |at: i32| {
                let [x, y] = [at % SIDE, at / SIDE].map(|pixel| 16 * pixel + 8);
                (bx - ax) * (y - ay) - (by - ay) * (x - ax)
            };
            // Which centres the surface has, as triangles are filled.
            let depth: [u16; (SIDE * SIDE) as usize] = core::array::from_fn(|at| {
                let side = side(at as i32);
                through_centres += i32::from(side == 0);
                let is_covered = side > 0 || side == 0 && (by < ay || by == ay && bx > ax);
                if is_covered { 1000 } else { 0 }
            });
            let place = |x, y| -> ScreenPoint { [x, y, 1000 << 12] };
            let edge = FeatureEdge::new([place(ax, ay), place(bx, by)], 0, 0).unwrap();
            let (mut marks, mut places) = ([0; (SIDE * SIDE) as usize], [0; (SIDE * SIDE) as usize]);
            let mut window = Window::new(SIDE as usize, (&(0..SIDE as u32), &depth), &(0..SIDE as u32), false, &mut marks, &mut places);
            window.walk(&edge);
            for at in (0..SIDE * SIDE).filter(|at| marks[*at as usize] != 0) {
                let beyond = at + [-SIDE, SIDE, -1, 1][usize::from(marks[at as usize] & 3)];
                // The walker may err by 1/65536 of a pixel in each column.
                let is_close = |at| side(at) != 0 && i64::from(side(at).abs()) << 16 <= i64::from(length) * i64::from(length + 16);
                let is_right = depth[at as usize] != depth[beyond as usize];
                assert!(is_right || is_close(at) || is_close(beyond), "pixel {at} of the edge from {ax}, {ay} to {bx}, {by}");
            }
        }
        assert!(through_centres > 500, "{through_centres}");
    }

    /// A line is drawn in all columns whose centre its edge passes, whether a surface is beside it or not, unless something in front hides it.
    #[test]
    fn lines_have_no_gaps_where_no_surface_is_drawn() {
        for (bx, by) in [(900, 300), (300, 900), (120, 700), (720, 90), (500, 500), (880, 497)] {
            let place = |x, y| -> ScreenPoint { [x, y, 1000 << 12] };
            let edge = FeatureEdge::new([place(500, 497), place(bx, by)], 0, 0).unwrap();
            for nearest in [0u16, 900, 1100] {
                let depth = [nearest; (SIDE * SIDE) as usize];
                let (mut marks, mut places) = ([0u8; (SIDE * SIDE) as usize], [0; (SIDE * SIDE) as usize]);
                let mut window = Window::new(SIDE as usize, (&(0..SIDE as u32), &depth), &(0..SIDE as u32), true, &mut marks, &mut places);
                window.walk(&edge);
                let is_flat = (bx - 500i32).abs() >= (by - 497i32).abs();
                let (from, to) = if is_flat { (500.min(bx), 500.max(bx)) } else { (497.min(by), 497.max(by)) };
                for major in 0..SIDE {
                    let column = (0..SIDE).map(|minor| if is_flat { minor * SIDE + major } else { major * SIDE + minor });
                    let light: u32 = column.map(|at| u32::from(marks[at as usize])).sum();
                    let passes = from < 16 * major + 8 && 16 * major + 8 < to;
                    let at_end = from == 16 * major + 8 || 16 * major + 8 == to;
                    let expected = if passes && nearest < 1000 { 255 } else { 0 };
                    assert!(at_end || light == expected, "to {bx}, {by}, depth {nearest}, column {major}: {light}");
                }
            }
        }
    }
}
