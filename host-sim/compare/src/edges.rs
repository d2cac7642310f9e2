//! Jumps across edges that two triangles share: cracks in the light, and Mach bands.

use super::samples::{Method, Samples};
use microphong_oracle::{Facet, Frame, Levels, Unsupported};
use std::collections::HashMap;

/// Points on each edge, evenly spread over its inner 92 %.
const POINTS: usize = 13;
/// The first point, a share of the edge's length.
const FIRST: f64 = 0.04;
/// Distance from the edge at which its two sides are compared, pixels.
const BESIDE: f64 = 1e-6;
/// Step over which the slope is taken, pixels.
const STEP: f64 = 0.05;
/// Shorter edges are left out, pixels.
const SHORTEST: f64 = 2.0;
/// Edges of triangles that are less high are left out, pixels: points beside the edge would leave them.
const LOWEST: f64 = 3.0;

/// The places where a method's jumps are looked for.
#[derive(Clone, Debug)]
pub(super) struct Edges {
    /// Four samples for each point of an edge: beside it and one step on in one triangle, then in the other.
    samples: Samples,
}

/// The largest jumps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jumps {
    /// Jump of the level, in 1/255: an edge that shows.
    pub level: f64,
    /// Jump of the level's slope across the edge, in 1/255 per pixel: a Mach band.
    pub slope: f64,
}

impl Edges {
    /// The edges that two facets share, both of them among the `shown`.
    #[must_use]
    pub(super) fn new(frame: &Frame, shown: impl Fn(usize) -> bool) -> Self {
        let mut sides: HashMap<[usize; 2], Vec<(usize, usize)>> = HashMap::new();
        // In the facets' order, so that equal streams are sampled equally.
        let mut edges = Vec::new();
        for (index, facet) in frame.facets.iter().enumerate().filter(|(index, _)| shown(*index)) {
            for k in 0..3 {
                let mut key = [facet.vertices[k], facet.vertices[(k + 1) % 3]];
                key.sort_unstable();
                let sides = sides.entry(key).or_default();
                if sides.is_empty() {
                    edges.push(key);
                }
                sides.push((index, k));
            }
        }
        let shared = edges.iter().filter_map(|key| match sides.get(key).map(Vec::as_slice) {
            Some(&[(one, k), (other, _)]) => Some((one, k, other)),
            _ => None,
        });
        let points = shared.flat_map(|(one, k, other)| beside(frame, one, k, other));
        Self { samples: Samples::new(frame, points) }
    }

    /// Measures the jumps of a method at edges.
    ///
    /// # Errors
    /// When the method cannot draw this frame.
    pub(super) fn jumps<'f>(&self, frame: &'f Frame, method: &Method<'f, '_>) -> Result<Jumps, Unsupported> {
        let levels = self.samples.shade(frame, method)?;
        let mut jumps = Jumps::default();
        for [near, on, far_near, far_on] in levels.as_chunks::<4>().0 {
            jumps.level = jumps.level.max(largest(|k| near[k] - far_near[k]));
            // Both slopes in one direction across the edge.
            jumps.slope = jumps.slope.max(largest(|k| ((on[k] - near[k]) - (far_near[k] - far_on[k])) / STEP));
        }
        Ok(jumps)
    }
}

fn largest(difference: impl Fn(usize) -> f64) -> f64 {
    let sizes: Levels = std::array::from_fn(|k| difference(k).abs());
    sizes.into_iter().fold(0.0, f64::max)
}

/// Points beside edge `k` of facet `one`, in it and in the `other`; none if the edge is too short or a triangle too thin.
fn beside(frame: &Frame, one: usize, k: usize, other: usize) -> Vec<(usize, [f64; 2])> {
    let facet = &frame.facets[one];
    let (a, b) = (facet.screen[k], facet.screen[(k + 1) % 3]);
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = along[0].hypot(along[1]);
    if length < SHORTEST || height(facet) < LOWEST || height(&frame.facets[other]) < LOWEST {
        return Vec::new();
    }
    // Corners run clockwise (y down): the inside is on the right.
    let inwards = [-along[1] / length, along[0] / length];
    let at = |u: f64, distance: f64| std::array::from_fn(|i| a[i] + along[i] * u + inwards[i] * distance);
    let step = (1.0 - 2.0 * FIRST) / (POINTS - 1) as f64;
    let points = (0..POINTS).map(|i| FIRST + step * i as f64);
    let four = |u| [(one, at(u, BESIDE)), (one, at(u, BESIDE + STEP)), (other, at(u, -BESIDE)), (other, at(u, -BESIDE - STEP))];
    points.flat_map(four).collect()
}

/// Height over the longest edge, pixels.
fn height(facet: &Facet) -> f64 {
    let edges = [0, 1, 2].map(|k| {
        let (a, b) = (facet.screen[k], facet.screen[(k + 1) % 3]);
        [b[0] - a[0], b[1] - a[1]]
    });
    let longest = edges.iter().fold(0.0f64, |longest, [x, y]| longest.max(x.hypot(*y)));
    let [[ax, ay], [bx, by], _] = edges;
    (ax * by - ay * bx).abs() / longest
}
