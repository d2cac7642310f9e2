//! The viewport, and the pixels of it that a triangle can touch.

use crate::{
    format::{CENTRE, SUBPIXEL},
    geometry::{
        clip,
        cull::Extent,
        pixel_rect::PixelRect,
        projection::{ScreenVertex, View},
    },
    stream::record::Vertex,
};

/// First row whose centre is not above `y`, or column whose centre is not left of it (1/16 pixel).
#[inline]
pub fn first_centre(y: i32) -> i32 {
    y.wrapping_add(CENTRE - 1) >> SUBPIXEL
}

/// Columns and rows that a triangle can touch, half open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bounds {
    /// First column.
    pub left: i32,
    /// First row.
    pub top: i32,
    /// One past the last column.
    pub right: i32,
    /// One past the last row.
    pub bottom: i32,
}

impl Bounds {
    /// The pixels whose centres the bounding box of a triangle contains.
    #[inline]
    pub fn new(extent: &Extent) -> Self {
        Self {
            left: first_centre(extent.left),
            top: first_centre(extent.top),
            right: first_centre(extent.right),
            bottom: first_centre(extent.bottom),
        }
    }

    /// The pixels that the bounding box of a triangle touches.
    #[inline]
    pub fn touched(extent: &Extent) -> Self {
        // A touched pixel's centre lies up to half a pixel beyond the box.
        Self {
            left: first_centre(extent.left - (CENTRE - 1)),
            top: first_centre(extent.top - (CENTRE - 1)),
            right: first_centre(extent.right + CENTRE),
            bottom: first_centre(extent.bottom + CENTRE),
        }
    }

    /// All pixels of a viewport of this size.
    #[inline]
    pub fn whole(width: i32, height: i32) -> Self {
        Self { left: 0, top: 0, right: width, bottom: height }
    }

    /// The part of the bounds that lies within `to`.
    #[inline]
    pub fn clipped(self, to: Self) -> Self {
        Self {
            left: self.left.max(to.left),
            top: self.top.max(to.top),
            right: self.right.min(to.right),
            bottom: self.bottom.min(to.bottom),
        }
    }

    /// The part of the bounds that lies within `to`, if it has a pixel.
    #[inline]
    pub fn visible(self, to: Self) -> Option<Self> {
        let bounds = self.clipped(to);
        (!bounds.is_empty()).then_some(bounds)
    }

    /// The bounds as `[left, top, right, bottom]`.
    #[inline]
    pub fn sides(self) -> [i32; 4] {
        [self.left, self.top, self.right, self.bottom]
    }

    /// Whether the bounds have no pixel.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.left >= self.right || self.top >= self.bottom
    }
}

impl From<&PixelRect> for Bounds {
    fn from(area: &PixelRect) -> Self {
        let ([left, right], [top, bottom]) = (area.columns.map(i32::from), area.rows.map(i32::from));
        Self { left, top, right, bottom }
    }
}

/// The size of the picture, and which pixels of it a triangle can touch.
#[derive(Clone, Copy)]
pub struct Viewport {
    /// Number of columns.
    pub width: i32,
    /// Number of rows.
    pub height: i32,
    /// Whether triangles are drawn that touch pixels and contain no centre of one.
    pub all_touched: bool,
}

impl Viewport {
    /// The bounds of the whole viewport.
    #[inline]
    pub fn whole(self) -> Bounds {
        Bounds::whole(self.width, self.height)
    }

    /// The visible bounding box of a triangle; `None` if it shows its back, or no pixel can belong to it.
    #[inline]
    pub fn bounds(self, extent: &Extent) -> Option<Bounds> {
        self.bounds_within(extent, self.whole())
    }

    /// The part of a triangle's bounding box that lies in a part of the viewport; `None` if the triangle shows its back, or no pixel there can belong
    /// to it.
    #[inline]
    pub fn bounds_within(self, extent: &Extent, part: Bounds) -> Option<Bounds> {
        if extent.area <= 0 {
            return None;
        }
        if self.all_touched { Bounds::touched(extent) } else { Bounds::new(extent) }.visible(part)
    }

    /// Whether a triangle shows its front and touches a pixel of `area`, even if it contains no centre of one.
    #[inline(never)]
    pub fn touches(self, extent: &Extent, area: Bounds) -> bool {
        extent.area > 0 && Bounds::touched(extent).visible(area).is_some()
    }

    /// [`Self::touches`] by vertices, for triangles with a corner that is not cached or needs clipping.
    #[cold]
    #[inline(never)]
    pub fn touches_by(self, view: &View, vertices: [&Vertex; 3], area: Bounds) -> bool {
        let places = vertices.map(|vertex| view.lens.project(view.to_eye(vertex.position)));
        let is_inside = places.iter().all(|&(_, inside)| inside);
        let extent = if is_inside { Some(Extent::new(places.map(|([x, y, _], _)| [x, y]))) } else { extent_of_clipped(view, vertices) };
        extent.is_some_and(|extent| self.touches(&extent, area))
    }

    /// [`Self::bounds`] by the corners, for rare triangles.
    #[inline(never)]
    pub fn bounds_of(self, corners: [&ScreenVertex; 3]) -> Option<Bounds> {
        self.bounds(&Extent::new(corners.map(|corner| [corner.x, corner.y])))
    }

    /// Whether a triangle with cached corners is word-sized and reaches into the viewport. It is then set up in words.
    #[inline]
    pub fn is_word_sized(self, extent: &Extent) -> bool {
        // Decision: word or exact.
        extent.left >= 0 && extent.right < self.width << SUBPIXEL && extent.fits_words()
    }

    /// The visible bounding box of the part that clipping leaves of a triangle.
    #[cold]
    #[inline(never)]
    pub fn clipped_bounds(self, view: &View, vertices: [&Vertex; 3]) -> Option<Bounds> {
        self.bounds(&extent_of_clipped(view, vertices)?)
    }

    /// The visible bounding box of a triangle.
    pub fn box_of(self, corners: [&ScreenVertex; 3]) -> [i32; 4] {
        let extent = Extent::new(corners.map(|corner| [corner.x, corner.y]));
        Bounds::new(&extent).clipped(self.whole()).sides()
    }
}

/// The extent of the part that clipping leaves of a triangle; `None` if it leaves none. Of its area only the sign has a meaning: the plane of the
/// triangle has decided that it shows its front.
#[cold]
#[inline(never)]
fn extent_of_clipped(view: &View, vertices: [&Vertex; 3]) -> Option<Extent> {
    let polygon = clip::clip(view, vertices);
    let places = || polygon.iter().map(|cut| cut.place);
    let (left, right) = (places().map(|[x, ..]| x).min()?, places().map(|[x, ..]| x).max()?);
    let (top, bottom) = (places().map(|[_, y, _]| y).min()?, places().map(|[_, y, _]| y).max()?);
    Some(Extent { left, right, top, bottom, area: 1 })
}
