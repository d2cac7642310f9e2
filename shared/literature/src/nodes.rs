//! Points of a triangle where methods of the literature compute light.

use microphong::{
    format::{POSITION, UNIT},
    math::vector::{add, normalise, wide, zip},
    method::{Node, TriangleSetup, Vertex},
};

/// Fraction bits that the normal of a [`Node`] has beyond those of a vertex.
const FINER: u32 = 30 - UNIT;

/// The three corners and then the midpoints of the edges 0-1, 1-2 and 2-0. The normals at midpoints are means of two corners and are not
/// normalised.
pub fn six_linear_nodes(setup: &TriangleSetup<'_>) -> [Node; 6] {
    let [a, b, c] = setup.vertices();
    let middle = |a: &Vertex, b: &Vertex, weights| Node {
        position: add(wide(a.position), wide(b.position)).map(|c| c << (POSITION - UNIT - 1)),
        normal: add(wide(a.normal), wide(b.normal)).map(|c| c << (FINER - 1)),
        albedo: setup.colour_at(weights),
    };
    let [p, q, r] = setup.corner_nodes();
    [p, q, r, middle(a, b, [1, 1, 0]), middle(b, c, [0, 1, 1]), middle(c, a, [1, 0, 1])]
}

/// The point with the barycentric coordinates `weights / 2^bits`, and its unit normal. The weights belong to the corners 0, 1, 2, are not negative,
/// and add up to `2^bits`; `bits` is at most 11.
pub fn node(setup: &TriangleSetup<'_>, weights: [i32; 3], bits: u32) -> Node {
    Node { albedo: setup.colour_at(weights), ..between(setup.vertices(), weights, bits) }
}

/// [`node`] between three vertices.
#[inline(always)]
fn between([a, b, c]: [&Vertex; 3], [u, v, w]: [i32; 3], bits: u32) -> Node {
    let mean = |of: fn(&Vertex) -> [i16; 3]| {
        let (a, b, c) = (wide(of(a)), wide(of(b)), wide(of(c)));
        zip(zip(a, b, |a, b| a * u + b * v), c, |ab, c| ab + c * w)
    };
    let [x, y, z] = mean(|vertex| vertex.position);
    let up = POSITION - UNIT - bits;
    Node { position: [x << up, y << up, z << up], normal: normalise(mean(|vertex| vertex.normal)), albedo: Node::NO_COLOUR }
}

/// The point with the barycentric coordinates `weights / (3 · 2^bits)`, and its unit normal. The weights belong to the corners 0, 1, 2, are not
/// negative, and add up to `3 · 2^bits`.
pub fn third(setup: &TriangleSetup<'_>, weights: [i32; 3], bits: u32) -> Node {
    let node = node(setup, weights, bits);
    Node { position: node.position.map(|c| c / 3), ..node }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of an edge by the weights of its ends are the same, bit for bit, in both triangles that share it,
    /// whichever corners its ends are there and whatever lies opposite: so both light and split it alike.
    #[test]
    fn neighbours_agree_on_their_edge() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 48) as i16 / 2
        };
        for _ in 0..1_000 {
            let mut vertex = || Vertex { position: [random(), random(), random()], normal: [random(), random(), random()] };
            let [p, q, r, s] = &[vertex(), vertex(), vertex(), vertex()];
            let (one, others) = ([p, q, r], [[q, p, s], [s, q, p], [p, s, q]]);
            for (k, &other) in others.iter().enumerate() {
                for bits in 0..=5 {
                    for w in 0..=1 << bits {
                        let v = (1 << bits) - w;
                        let first = between(one, [v, w, 0], bits);
                        // Split once more or less, it is the same point.
                        let same = between(other, [[w, v, 0], [0, w, v], [v, 0, w]][k].map(|w| 2 * w), bits + 1);
                        assert_eq!((first.position, first.normal), (same.position, same.normal));
                    }
                }
            }
        }
    }
}
