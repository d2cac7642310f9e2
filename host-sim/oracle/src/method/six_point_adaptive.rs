//! Six-point, split such that neighbours still meet.
//!
//! An edge decides by its own colours whether it wants to be split, so the triangles on both of its sides agree. A
//! triangle is split if one of its edges is, or if its centre is not met; its parts on an edge that is not split take
//! their values from the edge's parabola, and so do all smaller ones. No crack opens.

use super::six_point_centre::{CENTRE, DEPTH, Tree, distance};
use crate::{
    Facet, Frame, Levels, Shade,
    poly::{blend, quadratic},
    scanline::lerp,
};
use microphong_render::vector::V3;

/// What an edge's parabola may be wrong by at its quarters, in levels.
const EDGE: f64 = 1.0;

/// One edge of a part.
#[derive(Clone, Copy, Debug)]
struct Edge {
    /// Affine coordinates of its two ends.
    ends: [V3; 2],
    /// Colours at start, middle and end.
    colours: [Levels; 3],
    /// It belongs to a parabola that is not to be split.
    locked: bool,
}

impl Edge {
    /// The same, begun at the other end.
    fn reversed(self) -> Self {
        let ([a, b], [x, y, z]) = (self.ends, self.colours);
        Self { ends: [b, a], colours: [z, y, x], ..self }
    }

    /// The parabola a share `u` of the way along.
    fn parabola(&self, u: f64) -> Levels {
        blend(&[(1.0 - u) * (1.0 - 2.0 * u), 4.0 * u * (1.0 - u), u * (2.0 * u - 1.0)], &self.colours)
    }
}

/// Colours and thresholds of one triangle.
struct Builder<C> {
    colour: C,
    lean: f64,
}

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet, lean: f64) -> Shade<'f> {
    let builder = Builder { colour: |weights| frame.node(facet, weights), lean };
    let [a, b, c] = Facet::CORNERS;
    let colours = Facet::CORNERS.map(&builder.colour);
    let edge = |i: usize, j: usize| builder.edge([Facet::CORNERS[i], Facet::CORNERS[j]], [colours[i], colours[j]]);
    let tree = builder.build([a, b, c], [edge(0, 1), edge(1, 2), edge(2, 0)], DEPTH);
    Box::new(move |p| tree.at(facet.weights(p)).map(|level| level.clamp(0.0, 255.0)))
}

impl<C: Fn(V3) -> Levels> Builder<C> {
    /// An edge that may be split, its middle seen for the first time.
    fn edge(&self, ends: [V3; 2], colours: [Levels; 2]) -> Edge {
        let middle = (self.colour)(lerp(ends[0], ends[1], 0.5));
        Edge { ends, colours: [colours[0], middle, colours[1]], locked: false }
    }

    /// Whether the edge wants to be split.
    fn bends(&self, edge: &Edge) -> bool {
        let misses = |u: f64| distance((self.colour)(lerp(edge.ends[0], edge.ends[1], u)), edge.parabola(u)) > EDGE + self.lean;
        !edge.locked && (misses(0.25) || misses(0.75))
    }

    /// Both halves of an edge.
    fn halves(&self, edge: Edge, split: bool) -> [Edge; 2] {
        let ([a, b], [x, y, z]) = (edge.ends, edge.colours);
        let middle = lerp(a, b, 0.5);
        if split {
            [self.edge([a, middle], [x, y]), self.edge([middle, b], [y, z])]
        } else {
            let half = |ends, from, u, to| Edge { ends, colours: [from, edge.parabola(u), to], locked: true };
            [half([a, middle], x, 0.25, y), half([middle, b], y, 0.75, z)]
        }
    }

    /// The part between these corners, whose edges 0-1, 1-2 and 2-0 are given, split `depth` times at most.
    fn build(&self, corners: [V3; 3], edges: [Edge; 3], depth: u32) -> Tree {
        let [p, q, r] = edges.map(|edge| edge.colours[0]);
        let [pq, qr, rp] = edges.map(|edge| edge.colours[1]);
        let nodes = [p, q, r, pq, qr, rp];
        if depth == 0 {
            return Tree::Whole(nodes);
        }
        let bends = edges.map(|edge| self.bends(&edge));
        let centre = || {
            let fitted = blend(&quadratic(Facet::CENTRE), &nodes);
            distance(fitted, (self.colour)(blend(&Facet::CENTRE, &corners))) > CENTRE + self.lean
        };
        if !bends.contains(&true) && !centre() {
            return Tree::Whole(nodes);
        }
        let [[p_pq, pq_q], [q_qr, qr_r], [r_rp, rp_p]] = [0, 1, 2].map(|k| self.halves(edges[k], bends[k]));
        let [a, b, c] = corners;
        let [ab, bc, ca] = [lerp(a, b, 0.5), lerp(b, c, 0.5), lerp(c, a, 0.5)];
        // Around the middle part; its neighbours run along them the other way.
        let inner = [self.edge([ab, bc], [pq, qr]), self.edge([bc, ca], [qr, rp]), self.edge([ca, ab], [rp, pq])];
        let [beside_b, beside_c, beside_a] = inner.map(Edge::reversed);
        Tree::Split(Box::new([
            self.build([a, ab, ca], [p_pq, beside_a, rp_p], depth - 1),
            self.build([ab, b, bc], [pq_q, q_qr, beside_b], depth - 1),
            self.build([ca, bc, c], [beside_c, qr_r, r_rp], depth - 1),
            self.build([ab, bc, ca], inner, depth - 1),
        ]))
    }
}
