//! Polygons cut into triangles.
//!
//! Convex ones become fans around their first corner. All others are projected onto the plane whose normal Newell's formula gives, and
//! cut by ear clipping: David Eberly, Triangulation by Ear Clipping, 2002, as the library earcut has it.

use crate::vector::{V3, add, cross, dot, length, sub, unit};
use earcut::Earcut;
use std::f64::consts::PI;

/// Positions nearer than this share of the mesh's radius are one.
pub(crate) const WELD: f64 = 1e-6;

/// A polygon in triangles, which name its corners.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cut {
    /// Triangles, which wind as the polygon does. Together they have its area, unless it crosses itself.
    pub triangles: Vec<[usize; 3]>,
    /// The outline crosses itself, which areas have shown: the triangles are an attempt.
    pub crossed: bool,
}

/// Largest relative difference of areas that count as equal.
const SAME: f64 = 1e-6;
/// Smallest turn at a corner, in radians, for a fan. At smaller turns triangles might have no area.
const STRAIGHT: f64 = 1e-6;

/// Cuts a polygon of three corners or more. What has no area may become triangles without area.
#[must_use]
pub fn cut(points: &[V3]) -> Cut {
    let around = fan(points.len());
    if points.len() == 3 {
        return Cut { triangles: around, crossed: false };
    }
    // Seen from a corner, so that a small polygon far out is as exact as others.
    let seen: Vec<V3> = points.iter().map(|&p| sub(p, points[0])).collect();
    let normal = newell(&seen);
    let (area, least) = (length(normal), WELD * seen.iter().copied().map(length).fold(0.0, f64::max));
    let Some(flat) = unit(normal).filter(|_| area > least).map(|normal| project(&seen, normal)) else {
        // A line or a point, or halves that cancel, as those of a bow tie.
        let crossed = around.iter().any(|&[_, b, c]| length(cross(seen[b], seen[c])) > least);
        return Cut { triangles: around, crossed };
    };
    if is_convex(&flat) {
        return Cut { triangles: around, crossed: false };
    }
    let mut corners: Vec<usize> = Vec::new();
    Earcut::new().earcut(flat.iter().copied(), &[], &mut corners);
    let turned = |t: [usize; 3]| if twice_area(t.map(|k| flat[k])) < 0.0 { [t[0], t[2], t[1]] } else { t };
    let triangles: Vec<_> = corners.as_chunks().0.iter().copied().map(turned).collect();
    let sum: f64 = triangles.iter().map(|t| twice_area(t.map(|k| flat[k]))).sum();
    Cut { triangles, crossed: (sum - area).abs() > SAME * area }
}

/// Newell's formula: twice the area of a polygon, times its normal, exact for planar polygons and a mean for others.
#[must_use]
pub fn newell(points: &[V3]) -> V3 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).fold([0.0; 3], |sum, (&a, &b)| add(sum, cross(a, b)))
}

/// Triangles around the first corner.
fn fan(corners: usize) -> Vec<[usize; 3]> {
    (2..corners).map(|k| [0, k - 1, k]).collect()
}

/// Onto the plane through the origin that `normal` is square to, counter-clockwise seen against the normal.
fn project(points: &[V3], normal: V3) -> Vec<[f64; 2]> {
    // Of the axes the one that is most nearly in the plane: planes square to an axis keep their coordinates as they are.
    let least = (0..3).min_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let right = unit(cross(axis, normal)).unwrap_or(axis);
    let up = cross(normal, right);
    points.iter().map(|&p| [dot(p, right), dot(p, up)]).collect()
}

/// Whether the polygon turns left at every corner, and once around in all. Corners that coincide count as one.
fn is_convex(points: &[[f64; 2]]) -> bool {
    let edge = |a: [f64; 2], b: [f64; 2]| [b[0] - a[0], b[1] - a[1]];
    let next = points.iter().cycle().skip(1);
    let edges: Vec<_> = points.iter().zip(next).map(|(&a, &b)| edge(a, b)).filter(|&edge| edge != [0.0; 2]).collect();
    let turn = |([a, b], [c, d]): ([f64; 2], [f64; 2])| libm::atan2(a * d - b * c, a * c + b * d);
    let turns: Vec<_> = edges.iter().copied().zip(edges.iter().copied().cycle().skip(1)).map(turn).collect();
    turns.iter().all(|&turn| (STRAIGHT..PI - STRAIGHT).contains(&turn)) && turns.iter().sum::<f64>() < 3.0 * PI
}

fn twice_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    /// On a plane that leans.
    fn lift(points: &[[f64; 2]]) -> Vec<V3> {
        points.iter().map(|&[x, y]| [x * 0.5, y * 0.5, 0.25 * x - 0.375 * y]).collect()
    }

    #[test]
    fn convex_polygons_become_fans() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(cut(&lift(&square)), Cut { triangles: vec![[0, 1, 2], [0, 2, 3]], crossed: false });
        // As at the pole of a sphere.
        let doubled = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 1.0]];
        assert_eq!(cut(&lift(&doubled)).triangles, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn no_corner_is_left_on_an_edge() {
        let straight = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 2.0], [0.0, 2.0]];
        let all = cut(&lift(&straight));
        assert!(all.triangles.len() == 4 && !all.crossed, "{all:?}");
    }

    #[test]
    fn crossed_outlines_are_known() {
        let star: Vec<_> = (0..5).map(|k| libm::sincos(f64::from(k) * 2.0 * TAU / 5.0).into()).collect();
        let twice: Vec<_> = (0..7).map(|k| libm::sincos(f64::from(k) * 2.0 * TAU / 7.0).into()).collect();
        let bow_tie = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        let uneven = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 1.0]];
        for points in [&star[..], &twice, &bow_tie, &uneven] {
            assert!(cut(&lift(points)).crossed, "{points:?}");
        }
        let line = [[0.0, 0.0], [1.0, 1.0], [3.0, 3.0], [2.0, 2.0]];
        assert!(!cut(&lift(&line)).crossed);
    }

    /// Around a point, each corner in a direction and distance of its own: simple, and mostly concave. No two directions are
    /// half a turn apart.
    fn stars() -> impl Strategy<Value = Vec<[f64; 2]>> {
        prop::collection::vec((0.3..1.0, 0.01..1.0), 6..40).prop_map(|corners| {
            let all: f64 = corners.iter().map(|&(turn, _)| turn).sum();
            let mut angle: f64 = 0.0;
            let place = |(turn, distance): (f64, f64)| {
                angle += turn / all * TAU;
                [libm::cos(angle) * distance, libm::sin(angle) * distance]
            };
            corners.into_iter().map(place).collect()
        })
    }

    /// Steps to the right and back below: spikes that a fan would not stay within.
    fn combs() -> impl Strategy<Value = Vec<[f64; 2]>> {
        let side = || prop::collection::vec(0.01..1.0, 2..20);
        (side(), side()).prop_map(|(above, below)| {
            let low = below.iter().enumerate().map(|(k, y)| [k as f64 / (below.len() - 1) as f64, -y]);
            let high = above.iter().enumerate().map(|(k, y)| [k as f64 / (above.len() - 1) as f64, *y]).rev();
            low.chain(high).map(|[x, y]| [x, y - x]).collect()
        })
    }

    proptest! {
        /// A simple polygon becomes triangles that use each of its corners, wind as it does, have its area together, and do not overlap.
        #[test]
        fn simple_polygons_are_covered_once(flat in prop_oneof![stars(), combs()], first in 0usize..40) {
            let mut flat = flat;
            let count = flat.len();
            flat.rotate_left(first % count);
            let points = lift(&flat);
            let cut = cut(&points);
            prop_assert!(!cut.crossed);
            prop_assert_eq!(cut.triangles.len(), count - 2);
            let whole = newell(&flat.iter().map(|&[x, y]| [x, y, 0.0]).collect::<Vec<_>>())[2];
            let areas: Vec<_> = cut.triangles.iter().map(|t| twice_area(t.map(|k| flat[k]))).collect();
            prop_assert!(areas.iter().all(|&area| area > -1e-12), "{:?}", areas);
            prop_assert!((areas.iter().sum::<f64>() - whole).abs() < 1e-9 * whole, "{} of {}", areas.iter().sum::<f64>(), whole);
            // All that is not the outline has a triangle on either side: a point inside is in as many triangles as the outline goes around it.
            let mut edges: Vec<_> = cut.triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).collect();
            edges.extend((0..count).map(|k| ((k + 1) % count, k)));
            edges.sort_unstable();
            prop_assert!(edges.windows(2).all(|pair| pair[0] != pair[1]));
            prop_assert!(edges.iter().all(|&(a, b)| edges.binary_search(&(b, a)).is_ok()));
        }

        #[test]
        fn any_points_are_cut(points in prop::collection::vec(prop::array::uniform3(-1.0..1.0), 3..30)) {
            let cut = cut(&points);
            prop_assert!(cut.triangles.iter().flatten().all(|&k| k < points.len()));
        }
    }
}
