//! Six-point, split such that neighbours still meet.
//!
//! An edge decides by its own colours whether it wants to be split, so the triangles on both of its sides agree. A
//! triangle is split if one of its edges is, or if its centre is not met; its parts on an edge that is not split take
//! their values from the edge's parabola, and so do all smaller ones. No crack opens.

use super::{
    Decide,
    six_point_centre::{CENTRE, DEPTH, distance},
};
use crate::{
    Facet, Frame, Levels, Shade,
    poly::{blend, quadratic, quarter},
    scanline::lerp,
};
use microphong_models::vector::V3;

/// Largest error of an edge's parabola at its quarters, in levels.
const EDGE: f64 = 1.0;

/// An edge of a part of the triangle.
#[derive(Clone, Copy, Debug)]
struct Edge {
    /// Affine coordinates of its two ends.
    ends: [V3; 2],
    /// Colours at start, middle and end.
    colours: [Levels; 3],
    /// Whether the edge belongs to a parabola that must not be split.
    locked: bool,
}

impl Edge {
    /// The edge with its ends exchanged.
    fn reversed(self) -> Self {
        let ([a, b], [x, y, z]) = (self.ends, self.colours);
        Self { ends: [b, a], colours: [z, y, x], ..self }
    }

    /// The parabola a share `u` of the way along.
    fn parabola(&self, u: f64) -> Levels {
        blend(&[(1.0 - u) * (1.0 - 2.0 * u), 4.0 * u * (1.0 - u), u * (2.0 * u - 1.0)], &self.colours)
    }
}

/// Colours of one triangle, and how it decides.
struct Builder<'f, C> {
    colour: C,
    /// The channel that decides alone.
    only: Option<usize>,
    decide: &'f Decide<'f>,
}

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet, decide: &'f Decide<'f>) -> Shade<'f> {
    let builder = Builder { colour: |weights| frame.node(facet, weights), only: frame.only_channel(facet), decide };
    let colours = Facet::CORNERS.map(&builder.colour);
    let edges = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| builder.edge([Facet::CORNERS[i], Facet::CORNERS[j]], [colours[i], colours[j]]));
    Box::new(move |p| builder.at(Facet::CORNERS, edges, DEPTH, facet.weights(p)).map(|level| level.clamp(0.0, 255.0)))
}

impl<C: Fn(V3) -> Levels> Builder<'_, C> {
    /// An edge that may be split, its middle seen for the first time.
    fn edge(&self, ends: [V3; 2], colours: [Levels; 2]) -> Edge {
        let middle = (self.colour)(lerp(ends[0], ends[1], 0.5));
        Edge { ends, colours: [colours[0], middle, colours[1]], locked: false }
    }

    /// Whether the edge wants to be split.
    fn bends(&self, edge: &Edge) -> bool {
        let misses = |u: f64| {
            let colour = (self.colour)(lerp(edge.ends[0], edge.ends[1], u));
            (self.decide)(distance(colour, edge.parabola(u), self.only) - EDGE)
        };
        !edge.locked && (misses(0.25) || misses(0.75))
    }

    /// The two halves of an edge.
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

    /// The colour at a point of the part between these corners, whose edges 0-1, 1-2 and 2-0 are given, split `depth` times at most.
    fn at(&self, corners: [V3; 3], edges: [Edge; 3], depth: u32, weights: V3) -> Levels {
        let [p, q, r] = edges.map(|edge| edge.colours[0]);
        let [pq, qr, rp] = edges.map(|edge| edge.colours[1]);
        let nodes = [p, q, r, pq, qr, rp];
        let whole = || blend(&quadratic(weights), &nodes);
        if depth == 0 {
            return whole();
        }
        let bends = edges.map(|edge| self.bends(&edge));
        let centre = || {
            let fitted = blend(&quadratic(Facet::CENTRE), &nodes);
            (self.decide)(distance(fitted, (self.colour)(blend(&Facet::CENTRE, &corners)), self.only) - CENTRE)
        };
        if !bends.contains(&true) && !centre() {
            return whole();
        }
        let [[p_pq, pq_q], [q_qr, qr_r], [r_rp, rp_p]] = [0, 1, 2].map(|k| self.halves(edges[k], bends[k]));
        let [a, b, c] = corners;
        let [ab, bc, ca] = [lerp(a, b, 0.5), lerp(b, c, 0.5), lerp(c, a, 0.5)];
        // Around the middle part; its neighbours run along them the other way.
        let inner = [self.edge([ab, bc], [pq, qr]), self.edge([bc, ca], [qr, rp]), self.edge([ca, ab], [rp, pq])];
        let [beside_b, beside_c, beside_a] = inner.map(Edge::reversed);
        let (which, weights) = quarter(weights);
        let (corners, edges) = match which {
            0 => ([a, ab, ca], [p_pq, beside_a, rp_p]),
            1 => ([ab, b, bc], [pq_q, q_qr, beside_b]),
            2 => ([ca, bc, c], [beside_c, qr_r, r_rp]),
            _ => ([ab, bc, ca], inner),
        };
        self.at(corners, edges, depth - 1, weights)
    }
}
