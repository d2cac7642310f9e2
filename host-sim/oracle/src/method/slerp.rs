//! Normals on great circles: along the edges, then along the rows (Shoemake 1985; Goldman, Fundamentals of computer graphics).

use crate::{
    Facet, Frame, Shade,
    scanline::{Span, slerp},
    scene::direction,
};
use microphong_models::vector::dot;

pub(super) fn shade<'f>(frame: &'f Frame, facet: &'f Facet) -> Shade<'f> {
    let normals = facet.normals.map(direction);
    let rays: Vec<_> = frame.lights.iter().map(|light| frame.rays(light, facet.positions[0])).collect();
    Box::new(move |[x, y]| {
        let span = Span::new(&facet.screen, y);
        let normal = slerp(span.left.slerp(&normals), span.right.slerp(&normals), span.along(x));
        frame.lit(facet, facet.at([x, y]), rays.iter().map(|rays| [rays.light, rays.half].map(|v| dot(normal, v))))
    })
}
