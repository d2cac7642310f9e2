//! Rectangles of pixels.

use core::ops::Range;
use embedded_graphics_core::{
    geometry::{Point, Size},
    primitives::Rectangle,
};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// A rectangle of pixels. It lies in the renderer's memory.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct PixelRect {
    /// The first column, and one past the last.
    pub columns: [u16; 2],
    /// The first row, and one past the last.
    pub rows: [u16; 2],
}

impl PixelRect {
    /// The empty rectangle.
    pub const NONE: Self = Self { columns: [0; 2], rows: [0; 2] };

    /// All pixels of a viewport of `size`, no larger than [`crate::MAX_SIDE`].
    pub fn whole(size: Size) -> Self {
        Self { columns: [0, size.width as u16], rows: [0, size.height as u16] }
    }

    /// The pixels of `rectangle` that belong to a viewport of `size`, no larger than [`crate::MAX_SIDE`].
    pub fn of(rectangle: Rectangle, size: Size) -> Self {
        let range = |start: i32, length: u32, side: u32| {
            // `clamp` would panic at a side that is negative as an `i32`.
            [start, start.saturating_add_unsigned(length)].map(|place| place.max(0).cast_unsigned().min(side) as u16)
        };
        let Rectangle { top_left, size: extent } = rectangle;
        Self { columns: range(top_left.x, extent.width, size.width), rows: range(top_left.y, extent.height, size.height) }
    }

    /// Whether the rectangle has no pixel.
    pub fn is_empty(&self) -> bool {
        let is_empty = |[start, end]: [u16; 2]| start >= end;
        is_empty(self.columns) || is_empty(self.rows)
    }

    /// The smallest rectangle that contains both. An empty one is left out.
    pub fn union(&self, other: &Self) -> Self {
        let hull = |[start, end]: [u16; 2], other: [u16; 2]| [start.min(other[0]), end.max(other[1])];
        match (self.is_empty(), other.is_empty()) {
            (_, true) => *self,
            (true, _) => *other,
            _ => Self { columns: hull(self.columns, other.columns), rows: hull(self.rows, other.rows) },
        }
    }

    /// The pixels that belong to both rectangles.
    pub fn within(&self, other: &Self) -> Self {
        let within = |[start, end]: [u16; 2], other: [u16; 2]| [start.max(other[0]), end.min(other[1])];
        Self { columns: within(self.columns, other.columns), rows: within(self.rows, other.rows) }
    }

    /// The pixels of the rectangle and those up to `reach` pixels away, in a picture of `size`. An empty rectangle stays empty.
    pub fn grown(&self, reach: u16, size: Size) -> Self {
        let grown = |[start, end]: [u16; 2]| [start.saturating_sub(reach), end.saturating_add(reach)];
        let Self { columns, rows } = *self;
        if self.is_empty() { *self } else { Self { columns: grown(columns), rows: grown(rows) }.within(&Self::whole(size)) }
    }

    /// The columns of the rectangle.
    pub fn columns(&self) -> Range<u32> {
        let [start, end] = self.columns;
        start.into()..end.into()
    }

    /// The rows of the rectangle.
    pub fn rows(&self) -> Range<u32> {
        let [start, end] = self.rows;
        start.into()..end.into()
    }

    /// Converts the area to a rectangle of embedded-graphics.
    pub fn rectangle(&self) -> Rectangle {
        let (columns, rows) = (self.columns(), self.rows());
        Rectangle::new(
            Point::new(columns.start as i32, rows.start as i32),
            Size::new(columns.end.saturating_sub(columns.start), rows.end.saturating_sub(rows.start)),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn area() -> impl Strategy<Value = PixelRect> {
        prop::array::uniform2(prop::array::uniform2(0u16..6)).prop_map(|[columns, rows]| PixelRect { columns, rows })
    }

    proptest! {
        #[test]
        fn areas_are_sets_of_pixels(one in area(), other in area()) {
            let has = |area: &PixelRect, x: u32, y: u32| area.columns().contains(&x) && area.rows().contains(&y);
            let pixels = || (0..6).flat_map(|x| (0..6).map(move |y| (x, y)));
            let both = one.union(&other);
            prop_assert_eq!(one.is_empty(), !pixels().any(|(x, y)| has(&one, x, y)));
            prop_assert_eq!(!one.within(&other).is_empty(), pixels().any(|(x, y)| has(&one, x, y) && has(&other, x, y)));
            prop_assert!(pixels().all(|(x, y)| has(&both, x, y) || !has(&one, x, y) && !has(&other, x, y)));
            prop_assert_eq!(embedded_graphics_core::primitives::PointsIter::points(&one.rectangle()).count(), pixels().filter(|&(x, y)| has(&one, x, y)).count());
        }
    }
}
