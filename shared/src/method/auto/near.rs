//! Bounds of linear interpolation under near lights and for a near viewer, where directions change over a triangle as normals do.
//!
//! Light at a point is made of cosines between unit vectors: N over its length, L towards the light, H half-way between L and the viewer. The error
//! of linear interpolation follows from how much each of them turns over the triangle.
//!
//! - N and the vectors towards lights and viewer are linear over the triangle before they are made units. Along an edge such a vector v turns by at
//!   most s = |change of v| / least |v|. For normals this is e/ρ, as in [`super::error_bound`]. For lights it is the longest edge over the least
//!   distance.
//! - Let u be such a unit vector, u' its derivative, r' the relative derivative of its length, and w another unit vector. The second derivative of u,
//!   times w, is at most |2 r' u'·w| + |u'|² |u·w|, where |u'|² + r'² = s², and |u'·w| is at most |u'| times the sine between u and w. This is at
//!   most 1.155 s², by the largest eigenvalue. So the second derivative of N·L is at most 1.155 (s of N + s of L)².
//! - H is the sum of L and the direction to the viewer, made a unit. If these two are at most 90 degrees apart, the sum is at least √2 long. The same
//!   bound then holds for N·H, with 1.1 (s of L + s of the viewer) in place of s of L.
//! - Let D be the sum of the turns of N and H. The second derivative of (N·H)^n is at most n D² (1.155 c + 2 (n - 1)(1 - c)) c^(n - 2) at N·H = c.
//!   This is at most 1.335 n D², and less by [`FAR`] if N·H stays below a bound.
//! - A function whose second derivative along edges is at most M differs from linear interpolation by at most 2/9 M. It follows from Taylor's
//!   remainders towards the corners, weighted by barycentric coordinates b: the largest sum of b (1 - b)² / 2 is 2/9.
//! - A range R leaves (1 - d²/R²)² of a light at the distance d. Let q be d²/R² at the farthest corner. The first derivative of this is at most
//!   4 q (1 + s) s, the second (8 q² (1 + s)² + 4 q) s², where s is at most 1/3. So it counts as if the light turned 1 + 3.5 q + 1.86 √q times as
//!   far.
//! - Where N·L changes its sign, it changes by at most the turn. Interpolated light is then too bright by at most a quarter of that.

use crate::{
    format::COSINE,
    lighting::{
        albedo::{Albedo, Parts},
        facing::Facing,
        lights::{Source, Viewer, point},
    },
    math::vector::{dot, map, sub, zip},
    method::{
        Shading, TriangleSetup,
        auto::error_bound::{Curvature, Interval, MOST_LIGHT, of_product, rooted, share, times},
        largest_range,
        node::farthest,
    },
    stream::record::Vertex,
};

use super::way::{Choice, is_clamped, linear_raise};

/// 2/9 of 1.155, Q16.
const DIFFUSE: u32 = share(2.0 / 9.0 * 1.155);
/// 2/9, Q16.
const CORNERS: u32 = share(2.0 / 9.0);
/// The bound of the second derivative of a highlight of exponent n, divided by n and the squared turn; Q16. Entry number k is for 1 - N·H of at least
/// k/2 over n - 2. It is the largest value of (1.155 + 2.25 y) / e^y from y = k/2 on. Domain: n from 10 on.
const FAR: [u32; 17] = [
    share(1.384),
    share(1.384),
    share(1.2528),
    share(1.0109),
    share(0.7654),
    share(0.5567),
    share(0.3937),
    share(0.2728),
    share(0.1861),
    share(0.1254),
    share(0.0837),
    share(0.0555),
    share(0.0365),
    share(0.0239),
    share(0.0156),
    share(0.0101),
    share(0.0065),
];

/// A turn beyond which nothing is tried, Q0.16.
const MOST: u32 = 1 << 15;

/// One colour or linear interpolation under near lights or for a near viewer; `None` if no bound keeps to the budget.
#[inline(never)]
pub(super) fn choose(setup: &TriangleSetup<'_>, shading: &Shading<'_>) -> Option<Choice> {
    let Shading { lighting, budget, .. } = *shading;
    if setup.has_texture() || lighting.has_cone() {
        return None;
    }
    let curvature = Curvature::of(setup.triangle)?;
    let normals = curvature.turn(setup.triangle);
    // Most triangles that bend too much end here.
    if normals > MOST {
        return None;
    }
    let lights = setup.corners.map(|corner| corner.light);
    let (mixed, half) = Facing::of_corners(map(lights, |[.., facing]| facing));
    let vertices = setup.vertices();
    let edge = longest_edge(vertices);
    let viewer = match lighting.viewer() {
        Viewer::Infinite(_) => 0,
        Viewer::Local(eye) => turn_towards(eye, vertices, edge)?,
    };
    let mut interval = Interval { below: 4, above: 4 };
    for (light, source) in lighting.sources().iter().enumerate() {
        let [diffuse, specular] = shading.reflectance.largest_gains(light);
        let mut towards = match source.point() {
            Some(near) => turn_towards(near, vertices, edge)?,
            None => 0,
        };
        if let (Some((shape, _)), Some(near)) = (source.shape(), source.point()) {
            // The squared distance of the farthest corner as a part of the square of the range: above 0, at most 1, Q0.16.
            let part = (shape.nearness(farthest(vertices, near)).part(1 << COSINE) >> (COSINE - 16)).saturating_add(1).min(1 << 16);
            towards += times(towards, times(part, share(3.5)) + times(rooted(part), share(1.86)));
        }
        let turn = normals + towards;
        if turn > MOST {
            return None;
        }
        let bend = times(times(diffuse, (turn * turn) >> 16), DIFFUSE);
        let gap = if mixed >> light & 1 != 0 { times(diffuse, turn) >> 2 } else { 0 };
        interval = Interval { below: interval.below + bend, above: interval.above + bend + gap };
        if interval.half() > budget {
            return None;
        }
        if specular > 0 && !source.is_sky() {
            let beyond = highlight(setup, shading, source, [normals, towards, viewer], half)?;
            interval = interval.widened(times(specular, beyond));
        }
    }
    if interval.half() > budget {
        return None;
    }
    let levels = setup.levels();
    if is_clamped(&levels) {
        return None;
    }
    if let Some(albedos) = setup.albedos() {
        let [a, b, c] = map(lights, |light| Parts::unpacked(light).diffuse);
        let diffuse = largest_range([a, b, c]);
        if diffuse > MOST_LIGHT {
            return None;
        }
        interval = interval.widened(of_product(Albedo::range(albedos), diffuse));
    }
    let range = largest_range(levels);
    if interval.half() + (range >> 1) < budget {
        return Some(Choice::Solid(interval.middle()));
    }
    (interval.half() <= budget).then(|| linear_raise(setup, interval, budget, || range).map(Choice::Linear)).flatten()
}

/// A bound of the error of the highlight of `source`, as a part of a whole one, Q16. The turns are those of normals, of the light and of the viewer,
/// Q0.16, and `half` is the largest N·H at the corners, Q1.15. `None` where L and the direction to the viewer may be more than 90 degrees apart.
#[inline(never)]
fn highlight(
    setup: &TriangleSetup<'_>,
    shading: &Shading<'_>,
    source: &Source,
    [normals, light, viewer]: [u32; 3],
    half: u32,
) -> Option<u32> {
    let exponent = u32::from(shading.exponent);
    // A power of 1 has a bend where it is clamped.
    if exponent < 2 {
        return None;
    }
    let turn = normals + (light + viewer) * 11 / 10;
    if turn > MOST || !is_before(setup, shading, source) {
        return None;
    }
    let square = ((turn * turn) >> 16) + 1;
    // Between the corners N·H is at most this much larger.
    let most = half + (times(square, DIFFUSE) >> 1) + 1;
    if (most << 15) as i32 <= shading.reflectance.highlight_threshold {
        return Some(0);
    }
    let factor = if exponent < 10 {
        share(1.335)
    } else {
        let place = ((1u32 << 15).saturating_sub(most) * (exponent - 2)) >> 14;
        FAR[(place as usize).min(FAR.len() - 1)]
    };
    // Normals of corners are unit vectors to 2^-15.
    Some(times(times(square * exponent, factor), CORNERS) + 2 * exponent)
}

/// Whether the directions to the light and to the viewer are at most 90 degrees apart all over the triangle.
fn is_before(setup: &TriangleSetup<'_>, shading: &Shading<'_>, source: &Source) -> bool {
    let ahead = |near: [i32; 3], direction: [i32; 3]| {
        setup.vertices().iter().all(|vertex| dot(map(sub(near, point(vertex.position)), |c| c >> 1), direction) >= 0)
    };
    match (shading.lighting.viewer(), source.directional(), source.point()) {
        (Viewer::Infinite(towards), None, Some(near)) => ahead(near, towards),
        (Viewer::Local(eye), Some([towards, _]), _) => ahead(eye, *towards),
        (Viewer::Infinite(towards), Some([light, _]), _) => dot(towards, *light) >= 0,
        _ => false,
    }
}

/// The squared length of the longest edge, Q4.28.
fn longest_edge([a, b, c]: [&Vertex; 3]) -> u32 {
    let square = |a: &Vertex, b: &Vertex| {
        let [x, y, z] = zip(a.position, b.position, |a, b| i32::from(a).wrapping_sub(i32::from(b)).unsigned_abs());
        x.wrapping_mul(x).saturating_add(y.wrapping_mul(y)).saturating_add(z.wrapping_mul(z))
    };
    square(a, b).max(square(b, c)).max(square(c, a))
}

/// The turn of the direction to `near`, Q7.25, over a triangle; it is Q0.16, and at most about 1/3. `edge` is the square of the longest edge, Q4.28.
/// `None` if that edge is more than a quarter of the way.
fn turn_towards(near: [i32; 3], [a, ..]: [&Vertex; 3], edge: u32) -> Option<u32> {
    // As edges, with 14 fraction bits. Shifted down, a distance is off by less than a unit of them.
    let way = map(sub(near, point(a.position)), |c| c >> 11);
    let square = dot(way, way) as u64;
    // The upper 16 bits of the square, rounded down, and the edge as finely, rounded up.
    let shift = 48u32.saturating_sub(square.leading_zeros());
    let (square, edge) = ((square >> shift) as u32, (u64::from(edge) >> shift) as u32 + 1);
    if edge >= square >> 4 {
        return None;
    }
    let part = rooted(((edge << 16) / square.max(1)) + 1);
    // The least distance is the way less the edge: x / (1 - x) is at most x (1 + 4/3 x) up to 1/4.
    Some(part + times(times(part, part), share(4.0 / 3.0)))
}
