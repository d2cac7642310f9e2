//! Distance between two surfaces.

use crate::vector::{V3, add, cross, dot, length, scale, sub};

/// The corners of a triangle.
pub type Corners = [V3; 3];

/// A result may be too large by this share of itself.
const SHARE: f64 = 1.0 / 128.0;

/// Upper bound of the Hausdorff distance between two surfaces: each point of one has a point of the other that is no farther. The result is at least
/// `least`, which must be above 0, because smaller distances take longer. `None` if the distance is more than `most`.
///
/// Points within triangles count as well as corners. Error: the bound is at most 1/128 too large. Source: branch and bound. The distance from a
/// triangle is a convex function, so on another triangle it is largest at a corner: if all corners lie near one triangle, so do all points between
/// them. Otherwise triangles are cut in four.
#[must_use]
pub fn hausdorff(one: &[Corners], other: &[Corners], [least, most]: [f64; 2]) -> Option<f64> {
    let mut search = Search { bound: least, most };
    for (from, to) in [(one, other), (other, one)] {
        search.raise(&mut from.to_vec(), &to.iter().collect::<Vec<_>>());
    }
    Some(search.bound).filter(|&bound| bound <= most)
}

/// Upper bound of the distance of all points of some triangles from a surface, with the error of [`hausdorff`]. The result is at least `least`, which
/// must be above 0.
#[must_use]
pub fn farthest(from: &[Corners], surface: &[Corners], least: f64) -> f64 {
    let mut search = Search { bound: least, most: f64::INFINITY };
    search.raise(&mut from.to_vec(), &surface.iter().collect::<Vec<_>>());
    search.bound
}

struct Search {
    /// No point that has been looked at is farther.
    bound: f64,
    most: f64,
}

impl Search {
    /// Raises the bound to the distance of all points of `from` from the nearest of `near`, or to more than `most`.
    fn raise(&mut self, from: &mut [Corners], near: &[&Corners]) {
        if self.bound > self.most {
            return;
        }
        let (centre, radius) = ball(from);
        let distances: Vec<f64> = near.iter().map(|triangle| distance(centre, triangle)).collect();
        let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
        if least + radius <= self.bound {
            return;
        }
        // No point of the ball lies farther than that plus its radius from what is nearest to it.
        let near: Vec<&Corners> =
            near.iter().zip(&distances).filter(|&(_, &d)| d <= least + 2.0 * radius).map(|(triangle, _)| *triangle).collect();
        if let [triangle] = from {
            let corners = triangle.map(|corner| near.iter().map(|other| distance(corner, other)).collect::<Vec<_>>());
            let nearest = corners.iter().map(|corner| corner.iter().copied().fold(f64::INFINITY, f64::min));
            let farthest = nearest.fold(0.0, f64::max);
            // Above it, so that what lies around a farthest point need not be cut for ever.
            self.bound = self.bound.max(farthest * (1.0 + SHARE));
            let all = (0..near.len()).map(|k| corners.iter().map(|corner| corner[k]).fold(0.0, f64::max)).fold(f64::INFINITY, f64::min);
            if all > self.bound {
                self.raise(&mut cut(triangle), &near);
            }
            return;
        }
        let [low, high] = corner_box(from);
        let across = sub(high, low);
        let axis = if across[0] >= across[1] && across[0] >= across[2] { 0 } else { 1 + usize::from(across[2] > across[1]) };
        let middle = from.len() / 2;
        let place = |triangle: &Corners| triangle.iter().map(|corner| corner[axis]).sum::<f64>();
        from.select_nth_unstable_by(middle, |a, b| place(a).total_cmp(&place(b)));
        let (below, above) = from.split_at_mut(middle);
        self.raise(below, &near);
        self.raise(above, &near);
    }
}

/// Least and largest coordinates of all corners.
fn corner_box(triangles: &[Corners]) -> [V3; 2] {
    let fold =
        |first: f64, pick: fn(f64, f64) -> f64| triangles.iter().flatten().fold([first; 3], |m, p| [0, 1, 2].map(|k| pick(m[k], p[k])));
    [fold(f64::INFINITY, f64::min), fold(f64::NEG_INFINITY, f64::max)]
}

/// A ball that holds all corners: its centre and radius.
fn ball(triangles: &[Corners]) -> (V3, f64) {
    let [low, high] = corner_box(triangles);
    let centre = scale(add(low, high), 0.5);
    (centre, triangles.iter().flatten().map(|&corner| length(sub(corner, centre))).fold(0.0, f64::max))
}

/// The four triangles between the corners and the midpoints of the sides.
fn cut(&[a, b, c]: &Corners) -> [Corners; 4] {
    let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[p, q]| scale(add(p, q), 0.5));
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}

/// The distance of a point from the nearest point of a triangle, which may have no area.
#[must_use]
pub fn distance(point: V3, &[a, b, c]: &Corners) -> f64 {
    let normal = cross(sub(b, a), sub(c, a));
    let square = dot(normal, normal);
    let is_above = square > 0.0 && [[a, b], [b, c], [c, a]].iter().all(|&[p, q]| dot(cross(normal, sub(q, p)), sub(point, p)) >= 0.0);
    if is_above {
        return dot(normal, sub(point, a)).abs() / square.sqrt();
    }
    let from_side = |[p, q]: [V3; 2]| {
        let (along, to) = (sub(q, p), sub(point, p));
        let share = (dot(along, to) / dot(along, along).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        length(sub(to, scale(along, share)))
    };
    [[a, b], [b, c], [c, a]].map(from_side).into_iter().fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn corners() -> impl Strategy<Value = Corners> {
        prop::array::uniform3(prop::array::uniform3(-1.0f64..1.0))
    }

    /// Points of a triangle, on a grid.
    fn points(&[a, b, c]: &Corners, steps: u32) -> impl Iterator<Item = V3> {
        (0..=steps)
            .flat_map(move |i| (0..=steps - i).map(move |j| [f64::from(i), f64::from(j)].map(|k| k / f64::from(steps))))
            .map(move |[u, v]| add(scale(a, 1.0 - u - v), add(scale(b, u), scale(c, v))))
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

        /// No point of a triangle is nearer, and one of a grid is nearly as near.
        #[test]
        fn distance_is_that_of_the_nearest_point(point in prop::array::uniform3(-2.0f64..2.0), triangle in corners()) {
            let exact = distance(point, &triangle);
            let nearest = points(&triangle, 60).map(|p| length(sub(p, point))).fold(f64::INFINITY, f64::min);
            prop_assert!(exact <= nearest + 1e-12 && nearest < exact + 0.06, "{exact} {nearest}");
        }

        /// No point of a grid on either surface is farther, and one is nearly as far.
        #[test]
        fn hausdorff_is_that_of_the_farthest_point(one in prop::collection::vec(corners(), 1..5), other in prop::collection::vec(corners(), 1..5)) {
            let bound = hausdorff(&one, &other, [1e-4, f64::INFINITY]).unwrap();
            let sided = |from: &[Corners], to: &[Corners]| {
                let nearest = |p| to.iter().map(|triangle| distance(p, triangle)).fold(f64::INFINITY, f64::min);
                from.iter().flat_map(|triangle| points(triangle, 40)).map(nearest).fold(0.0, f64::max)
            };
            let sampled = sided(&one, &other).max(sided(&other, &one));
            prop_assert!(sampled <= bound && bound < sampled * 1.01 + 0.05, "{sampled} {bound}");
        }
    }

    /// The corners of both lie on the other, or near it; the middle of the roof does not.
    #[test]
    fn the_middle_of_a_triangle_counts() {
        let roof = [[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]];
        let bent = [[[-1.0, 0.0, 0.0], [0.0, 0.0, 0.5], [0.0, 1.0, 0.0]], [[0.0, 0.0, 0.5], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]];
        let bound = hausdorff(&roof, &bent, [1e-4, 1.0]).unwrap();
        assert!((0.4..0.505).contains(&bound), "{bound}");
        assert_eq!(hausdorff(&roof, &bent, [1e-4, bound * 0.99]), None);
        assert_eq!(hausdorff(&roof, &roof, [1e-4, 1.0]), Some(1e-4));
        // All of it as far as the least distance that counts, exactly.
        let raised = roof.map(|triangle| triangle.map(|[x, y, z]| [x, y, z + 0.25]));
        assert_eq!(hausdorff(&roof, &raised, [0.25, 1.0]), Some(0.25 * (1.0 + SHARE)));
    }
}
