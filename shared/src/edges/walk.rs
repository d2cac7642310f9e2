//! Follows an edge pixel by pixel, and notes which share of each pixel lies beyond it.
//!
//! An edge is walked along its longer axis. In each column of that axis (a column or a row of the picture) whose centre it passes, it runs between
//! the centres of two pixels, or through one of them. The area of the pixel on the other side of the edge is exact for the straight line.

use crate::{arch::quotient::inverse, edges::Edge, format::SUBPIXEL};

/// Direction of a neighbour, the lower bits of a mark.
pub(crate) const UP: u8 = 0;
/// See [`UP`].
pub(crate) const DOWN: u8 = 1;
/// See [`UP`].
pub(crate) const LEFT: u8 = 2;
/// See [`UP`].
pub(crate) const RIGHT: u8 = 3;

/// Bits of a direction.
pub(crate) const DIRECTION: u32 = 2;

/// Fraction bits of the share of a neighbour in a mark. A share is less than a half.
pub(crate) const SHARE: u32 = 7;

/// The rows of a picture in which edges are walked.
pub(crate) struct Window<'w> {
    /// Number of columns.
    pub(crate) width: i32,
    /// The rows whose depth is known, half open.
    pub(crate) rows: [i32; 2],
    /// The depth in these rows.
    pub(crate) depth: &'w [u16],
    /// The first of the rows in which pixels are noted.
    pub(crate) top: i32,
    /// One past the last of them.
    pub(crate) bottom: i32,
    /// A share and a direction for each pixel of these rows, or 0. If edges are lines, it is a share of 255.
    pub(crate) marks: &'w mut [u8],
    /// Whether edges are lines.
    pub(crate) lines: bool,
    /// The pixels that are noted.
    pub(crate) places: &'w mut [u16],
    /// Number of pixels that are noted. If it exceeds the places, some found no room.
    pub(crate) count: usize,
}

const ONE: i32 = 1 << 16;
const HALF: i32 = ONE / 2;

impl Window<'_> {
    /// Notes a pixel of the window; `share` is Q.16 and less than a half.
    #[inline(always)]
    fn note(&mut self, pixel: i32, share: i32, direction: u8) {
        self.mark(pixel, ((share >> (16 - SHARE)).min((1 << (SHARE - 1)) - 1) << DIRECTION) as u8 | direction);
    }

    /// Marks a pixel of the window, unless it has a larger mark. Domain: `mark` is not 0.
    #[inline(always)]
    fn mark(&mut self, pixel: i32, mark: u8) {
        if let Some(old) = self.marks.get_mut(pixel as usize) {
            if *old == 0 {
                if let Some(place) = self.places.get_mut(self.count) {
                    *place = pixel as u16;
                }
                self.count += 1;
            }
            *old = mark.max(*old);
        }
    }

    /// Walks an edge.
    pub(crate) fn walk(&mut self, edge: &Edge) {
        // One by one: `map` of arrays goes through memory at opt-level "s".
        let Edge { ends: [[ax, ay], [bx, by]], depth: [a, b], range, beyond } = *edge;
        let (ax, ay, bx, by) = (i32::from(ax), i32::from(ay), i32::from(bx), i32::from(by));
        let (a, b, depth_bounds) = (i32::from(a), i32::from(b), [i32::from(range), i32::from(beyond)]);
        // The major coordinate grows from the first end to the second. The surface lies on the side of larger minor coordinates where an edge runs to
        // the right, or up.
        if (bx - ax).abs() >= (by - ay).abs() {
            let (from, to) = if ax <= bx { ([ax, ay, a], [bx, by, b]) } else { ([bx, by, b], [ax, ay, a]) };
            self.follow(true, [from, to], depth_bounds, ax <= bx);
        } else {
            let (from, to) = if ay <= by { ([ay, ax, a], [by, bx, b]) } else { ([by, bx, b], [ay, ax, a]) };
            self.follow(false, [from, to], depth_bounds, by < ay);
        }
    }

    /// Follows an edge whose ends are `[major coordinate, minor coordinate, depth]`. Its major axis is x if it `is_flat`, and y if not.
    #[inline(never)]
    fn follow(&mut self, is_flat: bool, [[m0, n0, z0], [m1, n1, z1]]: [[i32; 3]; 2], [range, beyond]: [i32; 2], is_below: bool) {
        let length = (m1 - m0) as u32;
        let width = self.width;
        let ([first_major, end_major], [first_minor, end_minor]) =
            if is_flat { ([0, width], self.rows) } else { ([self.top, self.bottom], [0, width]) };
        // Columns whose centre it passes.
        let half = 1 << (SUBPIXEL - 1);
        let first = ((m0 + half - 1) >> SUBPIXEL).max(first_major);
        let end = ((m1 + half - 1) >> SUBPIXEL).min(end_major);
        if first >= end {
            return;
        }
        // 2^32 / length, shifted right by `zeros`.
        let zeros = length.leading_zeros().wrapping_sub(16) & 15;
        let reciprocal = inverse(length << zeros);
        let signed = |size: u32, sign: i32| if sign < 0 { (size as i32).wrapping_neg() } else { size as i32 };
        // A pixel whose centre lies on the edge is before a line that descends to the right, and behind all others, as where triangles are filled:
        // its row begins there, or ends before. So `step` is rounded up where the line descends, and down elsewhere: such centres stay on their side.
        // The part of a step to the first column is rounded down everywhere: at such a centre the exact value and the sum are integers, so a sum that
        // is less than 1 too small is not too small. At a column n, another centre nearer than n/65536 of a pixel may be taken for one on the other
        // side.
        let is_before = is_flat && n1 > n0;
        let rise = (n1 - n0).unsigned_abs();
        // Too small by less than 2.
        let mut slope = rise.wrapping_mul(reciprocal) >> (16 - zeros);
        let mut rest = (rise << 16).wrapping_sub(slope.wrapping_mul(length));
        for _ in 0..2 {
            if rest >= length {
                (slope, rest) = (slope + 1, rest - length);
            }
        }
        let step = signed(slope + u32::from(rest > 0 && (is_before || n1 < n0)), n1 - n0);
        let depth_step = signed((z1 - z0).unsigned_abs().wrapping_mul(reciprocal >> 2) >> (18 - zeros), z1 - z0);
        // `minor` is how far the edge lies behind the centre of the first pixel of the minor axis, Q.16. `depth` is Q.12. Both are those of the first
        // column.
        let from = (first << SUBPIXEL) + half - m0;
        let minor = (n0 << (16 - SUBPIXEL)) + step.wrapping_mul(from >> SUBPIXEL) + (step.wrapping_mul(from & 15) >> SUBPIXEL);
        let mut minor = minor.wrapping_sub(HALF + i32::from(!is_before) + (first_minor << 16));
        let mut depth = (z0 << 12) + depth_step.wrapping_mul(from);
        let depth_step = depth_step << SUBPIXEL;
        let half_step = step.abs() >> 1;
        let corner = per_corner(half_step);
        let (major_stride, minor_stride) = if is_flat { (1, width) } else { (width, 1) };
        let [towards_low, towards_high] = if is_flat { [UP, DOWN] } else { [LEFT, RIGHT] };
        let mut base = if is_flat { first } else { (first - self.rows[0]) * width };
        let to_mark = (self.top - self.rows[0]) * width;
        let pairs = (end_minor - 1 - first_minor) as u32;
        // Lines need a surface beside them. Rows that no triangle reaches have no depth.
        let least = i32::from(self.lines);
        let known = self.depth;
        let inv_depth = |at: i32| known.get(at as usize).map_or(0, |depth| i32::from(*depth));
        let mut left = end - first;
        loop {
            // The last pixel whose centre lies before the edge; its pair is the next one.
            let low = minor >> 16;
            if (low as u32) < pairs {
                let at = base + low * minor_stride;
                let (low_depth, high_depth, own) = (inv_depth(at), inv_depth(at + minor_stride), depth >> 12);
                let (outer, inner) = if is_below { (low_depth, high_depth) } else { (high_depth, low_depth) };
                if outer <= own + beyond && inner >= (own - range).max(least) {
                    // The edge lies this far behind the centre of `low`.
                    let (behind, pixel) = (minor & (ONE - 1), at - to_mark);
                    if self.lines {
                        let share = (behind >> 8).clamp(1, 254) as u8;
                        self.mark(pixel, 255 - share);
                        self.mark(pixel + minor_stride, share);
                    } else {
                        let is_low = behind < HALF;
                        let distance = (behind - HALF).abs();
                        let past = half_step - distance;
                        let small = if past > 0 { (((past >> 4) * (past >> 4)) >> 8).wrapping_mul(corner) >> 14 } else { 0 };
                        let high = pixel + minor_stride;
                        let (near, to_far) = if is_low { (pixel, towards_high) } else { (high, towards_low) };
                        self.note(near, distance + small, to_far);
                        if small > 256 {
                            let (far, to_near) = if is_low { (high, towards_low) } else { (pixel, towards_high) };
                            self.note(far, small, to_near);
                        }
                    }
                }
            }
            left -= 1;
            if left == 0 {
                return;
            }
            minor = minor.wrapping_add(step);
            depth = depth.wrapping_add(depth_step);
            base += major_stride;
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
    use crate::edges::{Edge, Place};

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
            let place = |x, y| -> Place { [x, y, 1000 << 12] };
            let edge = Edge::new([place(ax, ay), place(bx, by)], 0, 0).unwrap();
            let (mut marks, mut places) = ([0; (SIDE * SIDE) as usize], [0; (SIDE * SIDE) as usize]);
            let mut window = Window {
                width: SIDE,
                rows: [0, SIDE],
                depth: &depth,
                top: 0,
                bottom: SIDE,
                marks: &mut marks,
                lines: false,
                places: &mut places,
                count: 0,
            };
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
}
