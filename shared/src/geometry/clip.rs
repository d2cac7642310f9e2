//! Clipping of triangles that cross the near plane or leave the guard band, in eye space.
//!
//! Clipping is rare, so it may be slow: vertices are transformed again and lit with the interpolated normal. An edge is cut from its inner to its
//! outer end, so both its triangles cut it at the same point, and no crack opens.

use crate::{
    arch::quotient::long,
    features::COLOURED,
    format::{HAVERSINE, INVERSE_SUM_LENGTH, UNIT},
    geometry::{lens::PLANES, projection::View},
    math::{
        rsqrt::rsqrt_wide,
        vector::{add, dot, normalise, wide, zip},
    },
    stream::record::{Triangle, Vertex},
};
use core::array::from_fn;
use heapless::Vec;

/// Largest number of corners of a triangle that five planes have cut.
const CORNERS: usize = 3 + PLANES;

/// What the colour of a surface depends on at a corner.
pub(crate) type Attributes = [[i32; 3]; COLOURED];

/// A corner of the cut polygon.
#[derive(Clone, Copy, Debug)]
struct Corner {
    eye: [i32; 3],
    position: [i32; 3],
    normal: [i32; 3],
    attributes: Attributes,
}

impl Corner {
    fn new(view: &View, &Vertex { position, normal }: &Vertex, attributes: Attributes) -> Self {
        Self { eye: view.to_eye(position), position: wide(position), normal: wide(normal), attributes }
    }
}

/// A corner after the cut: the object-space vertex and its place on the screen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    /// Position and unit normal.
    pub vertex: Vertex,
    /// `[x, y, inv_depth]`, see [`crate::geometry::lens::Lens::project`].
    pub place: [i32; 3],
    /// What the colour of the surface depends on, interpolated linearly.
    pub attributes: Attributes,
}

/// The part of a triangle that can be projected: a fan around its first corner; empty if there is none.
pub(crate) fn clip(view: &View, vertices: [&Vertex; 3]) -> Vec<Cut, CORNERS> {
    clip_painted(view, vertices, [[[0; 3]; 3]; COLOURED])
}

/// [`clip`], where the corners have these attributes.
pub(crate) fn clip_painted(view: &View, vertices: [&Vertex; 3], attributes: [[[i32; 3]; 3]; COLOURED]) -> Vec<Cut, CORNERS> {
    let mut polygon = Vec::<Corner, CORNERS>::new();
    for (k, v) in vertices.into_iter().enumerate() {
        let attributes = attributes.map(|attributes| attributes.get(k).copied().unwrap_or_default());
        let _ = polygon.push(Corner::new(view, v, attributes));
    }
    for plane in 0..PLANES {
        let mut cut = Vec::new();
        for (i, a) in polygon.iter().enumerate() {
            let b = polygon.get(i + 1).or(polygon.first()).unwrap_or(a);
            let (da, db) = (view.lens.distance(a.eye, plane), view.lens.distance(b.eye, plane));
            // A convex polygon gains at most one corner per plane: there is room.
            if da >= 0 {
                let _ = cut.push(*a);
            }
            if (da >= 0) != (db >= 0) {
                let _ = cut.push(if da >= 0 { between(a, b, da, db) } else { between(b, a, db, da) });
            }
        }
        polygon = cut;
    }
    let mut cuts = Vec::new();
    for corner in &polygon {
        let normal = normalise(corner.normal).map(|c| ((c + (1 << 15)) >> 16) as i16);
        let (place, _) = view.lens.project(corner.eye);
        let _ =
            cuts.push(Cut { vertex: Vertex { position: corner.position.map(|c| c as i16), normal }, place, attributes: corner.attributes });
    }
    cuts
}

/// The part of an edge that can be projected, as `[x, y, inv_depth]` of its ends; `None` if there is none.
pub(crate) fn clip_edge(view: &View, ends: [&Vertex; 2]) -> Option<[[i32; 3]; 2]> {
    let [mut a, mut b] = ends.map(|v| Corner::new(view, v, [[0; 3]; COLOURED]));
    for plane in 0..PLANES {
        let (da, db) = (view.lens.distance(a.eye, plane), view.lens.distance(b.eye, plane));
        match (da >= 0, db >= 0) {
            (true, true) => {}
            (true, false) => b = between(&a, &b, da, db),
            (false, true) => a = between(&b, &a, db, da),
            (false, false) => return None,
        }
    }
    let [(a, _), (b, _)] = [view.lens.project(a.eye), view.lens.project(b.eye)];
    Some([a, b])
}

/// The point where the line from `inner` (distance `di` >= 0) to `outer` (`d_o` < 0) meets the plane.
fn between(inner: &Corner, outer: &Corner, di: i64, d_o: i64) -> Corner {
    // The ratio with 22 fraction bits, without overflow.
    let whole = di.saturating_sub(d_o).max(1);
    let spare = 23u32.saturating_sub(whole.leading_zeros());
    let t = long(((di >> spare) << 22) as u64, (whole >> spare) as u64) as i64;
    Corner {
        eye: mix(inner.eye, outer.eye, t),
        position: mix(inner.position, outer.position, t),
        normal: mix(inner.normal, outer.normal, t),
        attributes: from_fn(|k| mix(inner.attributes[k], outer.attributes[k], t)),
    }
}

/// The vector at `t`, Q.22, on the way from `a` to `b`.
#[inline(never)]
fn mix(a: [i32; 3], b: [i32; 3], t: i64) -> [i32; 3] {
    zip(a, b, |a, b| (i64::from(a) + (((i64::from(b) - i64::from(a)) * t) >> 22)) as i32)
}

/// The record of one triangle of the fan, cut from `whole`: indices and edge constants are of the new `corners`, which turn
/// clockwise on the screen, against the order of a record.
pub(crate) fn record(whole: &Triangle, corners: &[Vertex; 3]) -> Triangle {
    let [a, b, c] = corners.map(|corner| wide(corner.normal));
    let edges = [edge(c, a), edge(b, c), edge(a, b)];
    Triangle {
        corners: [0, 2, 1],
        inverse_sum_length: edges.map(|(inverse, _)| inverse),
        haversine: edges.map(|(_, haversine)| haversine),
        ..*whole
    }
}

/// `inverse_sum_length` and `haversine` of the edge between two unit normals, see [`Triangle`].
fn edge(a: [i32; 3], b: [i32; 3]) -> (u16, u16) {
    let sum = add(a, b);
    let square = dot(sum, sum).max(1) as u64;
    let (mantissa, exponent) = rsqrt_wide(square);
    let inverse = ((u64::from(mantissa) << (UNIT + INVERSE_SUM_LENGTH)) >> exponent).saturating_sub(1 << (INVERSE_SUM_LENGTH - 1));
    let haversine = (1u64 << HAVERSINE).saturating_sub(square >> (2 * UNIT + 2 - HAVERSINE));
    (inverse.min(u64::from(u16::MAX)) as u16, haversine.min(u64::from(u16::MAX)) as u16)
}
