//! Where a closed convex mesh needs no depth.
//!
//! The front faces of a convex body do not hide one another: seen exactly, no pixel belongs to two. But vertices are moved
//! a little, by rounding in the mesh, in eye space and on the screen, and a triangle that is thinner than they are moved may
//! turn over and let its neighbours overlap. Its corners are *contested*. A triangle without a contested corner is ringed by
//! triangles too thick for that, so that nothing beyond them reaches it, and within them all turn the right way: it is drawn
//! without depth. Where triangles may overlap, all of them are drawn with depth, and the picture is the same.

use crate::{
    cull::Extent,
    format::SUBPIXEL,
    stream::{
        Stream,
        record::{CLOSED_CONVEX, Mesh},
    },
    vertex::View,
};
use embedded_graphics_core::geometry::Size;

/// How far a coordinate in eye space may lie from that of a convex body, in units of its last place: two in the mesh, as
/// `microphong convert` sees to, one by rounding, and one to spare.
const MOVED: u32 = 4;

/// Thicker triangles than this are told from none, 1/16 pixel: everything is contested.
const THICKEST: u32 = 1 << 12;

/// What tells thin triangles of a convex mesh.
#[derive(Clone, Copy, Debug)]
pub struct Convex {
    /// Four times as far as a vertex in the viewport may be moved, 1/16 pixel.
    thickness: i32,
    /// Of the viewport, 1/16 pixel.
    size: [i32; 2],
}

impl Convex {
    /// For one frame; `None` if the scene is not just one closed convex mesh, or seen from too near.
    #[must_use]
    pub fn new(stream: &Stream<'_>, view: &View, size: Size) -> Option<Self> {
        let [Mesh { flags, .. }] = stream.meshes else { return None };
        let size = [size.width, size.height].map(|side| (side << SUBPIXEL) as i32);
        let thickness = view.magnified(MOVED, size).saturating_add(1).saturating_mul(4);
        (flags & CLOSED_CONVEX != 0 && thickness < THICKEST).then_some(Self { thickness: thickness as i32, size })
    }

    /// The triangle lies in the viewport and is thick, or surely shows its back: its corners are not contested.
    #[inline(always)]
    #[must_use]
    pub fn is_thick(&self, extent: &Extent) -> bool {
        let [width, height] = self.size;
        let inside = extent.left | extent.top | (width - extent.right) | (height - extent.bottom) >= 0;
        // Its thickness is at least twice the area over the size.
        inside && extent.area.unsigned_abs() > (self.thickness * extent.size()) as u32
    }
}
