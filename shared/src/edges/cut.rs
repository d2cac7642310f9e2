//! The lines at which triangles cut each other.
//!
//! Inverse depth is linear over the screen. So a triangle is flat in the space of screen coordinates and inverse depth, as it is in the world, and two
//! triangles cut each other along a straight line there, too. One surface is seen on one side of the line, and the other surface on the other side.
//!
//! Source: Möller (1997), A fast triangle-triangle intersection test, for the part of the line that both triangles have in common.

use crate::{
    arch::{
        product::{product, rounded},
        quotient::long,
    },
    edges::{FeatureEdge, ScreenPoint, is_near},
    format::SUBPIXEL,
    math::vector::{cross, map, sub, zip},
};

/// A triangle on the screen.
pub(crate) struct Flat {
    corners: [ScreenPoint; 3],
    /// Its normal in the space of screen coordinates and inverse depth.
    normal: [i64; 3],
}

impl Flat {
    /// The triangle of these corners, clockwise on the screen. Returns `None` if its back or its rim is seen, or if a corner lies far outside of the
    /// picture.
    pub(crate) fn new(corners: [ScreenPoint; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        if !(is_near(a) && is_near(b) && is_near(c)) {
            return None;
        }
        let normal = cross(sub(b, a), sub(c, a));
        (normal[2] > 0).then_some(Self { corners, normal })
    }

    /// How far the corners of another triangle are in front of the plane of this one, times a positive factor. Coordinates differ by less than 2^16 and
    /// inverse depths by less than 2^28, so the sum of three products is below 3/4 of 2^63.
    fn distances(&self, other: &Self) -> [i64; 3] {
        let ([nx, ny, nz], [first, ..]) = (self.normal, self.corners);
        map(other.corners, |corner| {
            let [x, y, w] = sub(corner, first);
            nx * i64::from(x) + ny * i64::from(y) + nz * i64::from(w)
        })
    }

    /// The two points of the rim at which a plane, from which the corners have these distances, cuts it.
    fn cut(&self, [a, b, c]: [i64; 3]) -> Option<[ScreenPoint; 2]> {
        let [p, q, r] = self.corners;
        // The corner that is alone on its side, and then the others.
        let [(p, a), (q, b), (r, c)] = match (a >= 0, b >= 0, c >= 0) {
            (true, true, true) | (false, false, false) => return None,
            (_, y, z) if y == z => [(p, a), (q, b), (r, c)],
            (x, _, z) if x == z => [(q, b), (r, c), (p, a)],
            _ => [(r, c), (p, a), (q, b)],
        };
        Some([between(p, q, [a, b]), between(p, r, [a, c])])
    }

    /// The most by which the inverse depths of the surface and of a point on it at most a pixel away differ. Where large triangles cut each other, the
    /// range of a whole triangle would let a line be seen through what is in front of it.
    pub(crate) fn range(&self) -> i32 {
        let [[_, _, a], [_, _, b], [_, _, c]] = self.corners;
        let whole = a.max(b).max(c).wrapping_sub(a.min(b).min(c));
        let [x, y, z] = self.normal.map(i64::unsigned_abs);
        let pixel = long((x + y) << SUBPIXEL, z.max(1));
        if pixel < whole as u64 { pixel as i32 } else { whole }
    }

    /// The edge at which this triangle and another one cut each other, if they do.
    pub(crate) fn edge(&self, other: &Self) -> Option<FeatureEdge> {
        let distances = self.distances(other);
        let (one, two) = (self.cut(other.distances(self))?, other.cut(distances)?);
        let [from, to] = common(one, two)?;
        // The corner of the other triangle that is farthest from the plane, and whether it is in front of it: there the other surface is seen.
        let farthest =
            |farthest: (i64, ScreenPoint), corner: (i64, ScreenPoint)| if corner.0.abs() > farthest.0.abs() { corner } else { farthest };
        let (distance, corner) = distances.into_iter().zip(other.corners).fold((0, from), farthest);
        let ([dx, dy, _], [x, y, _]) = (sub(to, from), sub(corner, from));
        let is_right = i64::from(dx) * i64::from(y) > i64::from(dy) * i64::from(x);
        FeatureEdge::new(if is_right == (distance > 0) { [to, from] } else { [from, to] }, self.range(), other.range())
    }
}

/// The point between two corners where a distance is 0 that is `a` at the first and `b` at the second, which have opposite signs.
fn between(from: ScreenPoint, to: ScreenPoint, [a, b]: [i64; 2]) -> ScreenPoint {
    let (a, whole) = (a.unsigned_abs(), a.abs_diff(b));
    // To 16 bits: the point is off by 2^-15 of the distance between the corners.
    let less = 48u32.saturating_sub(whole.leading_zeros());
    let share = (((a >> less) as u32) << 16).checked_div((whole >> less) as u32).unwrap_or(0) as i32;
    zip(from, to, |from, to| from.wrapping_add(rounded(product(to.wrapping_sub(from), share), 16)))
}

/// The part that two parts of one line have in common.
fn common(one: [ScreenPoint; 2], two: [ScreenPoint; 2]) -> Option<[ScreenPoint; 2]> {
    let [dx, dy, _] = sub(one[1], one[0]).map(i32::abs);
    let along = |&[x, y, _]: &ScreenPoint| if dx >= dy { x } else { y };
    let ordered = |[from, to]: [ScreenPoint; 2]| if along(&from) <= along(&to) { [from, to] } else { [to, from] };
    let ([a, b], [c, d]) = (ordered(one), ordered(two));
    let from = if along(&a) >= along(&c) { a } else { c };
    let to = if along(&b) <= along(&d) { b } else { d };
    (along(&from) < along(&to)).then_some([from, to])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Random triangles: both have the same depth at both ends of their edge, which lie in both, and beside the edge the one is seen that it says.
    #[test]
    fn edges_are_where_depths_are_equal() {
        let (mut cuts, mut depths) = (0, 0f64);
        let mut state = 1u64;
        let mut random = |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % below) as i32
        };
        for seed in 1..100_000u32 {
            let mut triangle = || {
                let [a, b, c] = [(); 3].map(|()| [random(4000), random(4000), random(1 << 27)]);
                Flat::new([a, b, c]).or(Flat::new([a, c, b]))
            };
            let (Some(one), Some(other)) = (triangle(), triangle()) else { continue };
            let Some(edge) = one.edge(&other) else { continue };
            cuts += 1;
            let depth = |flat: &Flat, [x, y]: [f64; 2]| {
                let ([nx, ny, nz], [a, ..]) = (flat.normal.map(|n| n as f64), flat.corners);
                f64::from(a[2]) - (nx * (x - f64::from(a[0])) + ny * (y - f64::from(a[1]))) / nz
            };
            let [from, to] = edge.ends.map(|end| end.map(f64::from));
            let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
            let size = dx.hypot(dy);
            // Rounding of ends turns short edges, and decides about triangles of which hardly more than the rim is seen.
            if size < 16.0 || one.normal[2].min(other.normal[2]) < 100_000 {
                continue;
            }
            let middle = [f64::midpoint(from[0], to[0]), f64::midpoint(from[1], to[1])];
            // Two pixels to the right and to the left.
            let beside = |side: f64| [middle[0] - side * 32.0 * dy / size, middle[1] + side * 32.0 * dx / size];
            let nearer = |point| depth(&one, point) - depth(&other, point);
            let slope = (nearer(beside(1.0)) - nearer(beside(-1.0))) / 64.0;
            assert!(slope > 0.0, "{seed}: {slope}");
            // How far the middle is from where both have the same depth, in 1/16 pixel.
            if slope > 4000.0 {
                depths = depths.max((nearer(middle) / slope).abs());
            }
        }
        assert!(cuts > 10_000 && depths < 2.0, "{cuts} cuts, {depths} of 1/16 pixel");
    }
}
