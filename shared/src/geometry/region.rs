//! The part of a picture that is drawn: rectangles that objects have left and entered.
//!
//! A frame is drawn in bands, and each band is one rectangle, as narrow as the changes in its rows. So the picture is divided into at most 16 strips,
//! each as high as a band or a multiple of it, and the changes in a strip have one rectangle around them. Strips without changes are left out. No
//! band reaches into the next strip, because its rectangle would have pixels of neither strip's changes, and objects that reach into none of the
//! rectangles are not drawn.

use crate::{features::REDRAW, geometry::pixel_rect::PixelRect};
use core::slice;
use embedded_graphics_core::geometry::Size;

/// Largest number of strips of a picture.
const STRIPS: usize = 16;

/// Pixels of a picture: a rectangle of each strip.
#[derive(Clone, Debug)]
pub(crate) struct Region {
    /// The smallest rectangle that contains all of the pixels.
    hull: PixelRect,
    /// Whether the region is the whole picture; it is one strip then.
    is_whole: bool,
    /// Rows of a strip.
    rows: u16,
    strips: [PixelRect; STRIPS],
}

impl Region {
    /// The empty region.
    pub(crate) const NONE: Self = Self { hull: PixelRect::NONE, is_whole: false, rows: 0, strips: [PixelRect::NONE; STRIPS] };

    /// Takes all pixels of a picture of this `size`.
    pub(crate) fn fill(&mut self, size: Size) {
        (self.hull, self.is_whole) = (PixelRect::whole(size), true);
    }

    /// Drops all pixels, of a picture of this `height`, no larger than [`crate::MAX_SIDE`], which is drawn `band_rows` rows at a time.
    pub(crate) fn clear(&mut self, height: u32, band_rows: u32) {
        let band = band_rows.max(1);
        let rows = (height.div_ceil(STRIPS as u32).div_ceil(band) * band) as u16;
        *self = Self { rows, ..Self::NONE };
    }

    /// Whether the region is the whole picture.
    pub(crate) fn is_whole(&self) -> bool {
        !REDRAW || self.is_whole
    }

    /// The smallest rectangle that contains all pixels of the region.
    pub(crate) fn hull(&self) -> PixelRect {
        self.hull
    }

    /// Adds the pixels of `area`, which lies in the picture.
    #[inline(never)]
    pub(crate) fn include(&mut self, area: &PixelRect) {
        if self.is_whole() || area.is_empty() {
            return;
        }
        self.hull = self.hull.union(area);
        let mut rows = [0; 2];
        for strip in &mut self.strips {
            let [_, top] = rows;
            rows = [top, top + self.rows];
            *strip = strip.union(&area.within(&PixelRect { rows, ..*area }));
        }
    }

    /// The smallest rectangle that contains all pixels of both the region and `area`, which lies in the picture.
    #[inline]
    pub(crate) fn within(&self, area: &PixelRect) -> PixelRect {
        if self.is_whole() { *area } else { self.part_within(area) }
    }

    #[inline(never)]
    fn part_within(&self, area: &PixelRect) -> PixelRect {
        let area = area.within(&self.hull);
        if area.is_empty() {
            return area;
        }
        let meets = |strip: &&PixelRect| strip.rows[0] < area.rows[1] && area.rows[0] < strip.rows[1];
        self.strips.iter().filter(meets).fold(PixelRect::NONE, |hull, strip| hull.union(&strip.within(&area)))
    }

    /// The first rectangle from `row` on that a band may fill. After the last one, an empty rectangle behind all rows.
    #[inline(never)]
    pub(crate) fn next(&self, row: u32) -> PixelRect {
        let row = row.min(u16::MAX.into()) as u16;
        let from = |area: &PixelRect| PixelRect { rows: [area.rows[0].max(row), area.rows[1]], ..*area };
        let mut all = if self.is_whole() { slice::from_ref(&self.hull) } else { &self.strips }.iter().map(from);
        all.find(|area| !area.is_empty()).unwrap_or(PixelRect { rows: [u16::MAX; 2], ..PixelRect::NONE })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SIDES: [u16; 2] = [30, 100];

    fn range(side: u16) -> impl Strategy<Value = [u16; 2]> {
        (0..side, 1..side / 4).prop_map(move |(start, length)| [start, (start + length).min(side)])
    }

    fn area() -> impl Strategy<Value = PixelRect> {
        (range(SIDES[0]), range(SIDES[1])).prop_map(|(columns, rows)| PixelRect { columns, rows })
    }

    fn has(area: &PixelRect, x: u16, y: u16) -> bool {
        let contains = |[start, end]: [u16; 2], place| (start..end).contains(&place);
        contains(area.columns, x) && contains(area.rows, y)
    }

    fn pixels() -> impl Iterator<Item = (u16, u16)> {
        (0..SIDES[1]).flat_map(|y| (0..SIDES[0]).map(move |x| (x, y)))
    }

    /// The smallest area that has these pixels.
    fn hull(pixels: impl Iterator<Item = (u16, u16)>) -> PixelRect {
        pixels.fold(PixelRect::NONE, |hull, (x, y)| hull.union(&PixelRect { columns: [x, x + 1], rows: [y, y + 1] }))
    }

    proptest! {
        /// Bands have all pixels of all areas and, but for those between two areas of the same strip, no other.
        #[test]
        fn all_areas_are_drawn_and_gaps_are_not(areas in prop::collection::vec(area(), 0..4), other in area(), band in 1u16..40) {
            let mut region = Region::NONE;
            region.clear(SIDES[1].into(), band.into());
            areas.iter().for_each(|area| region.include(area));
            let rows = region.rows;
            prop_assert!(rows.is_multiple_of(band) && SIDES[1] <= rows * STRIPS as u16);
            let (mut row, mut drawn) = (0, [[false; SIDES[0] as usize]; SIDES[1] as usize]);
            loop {
                let area = region.next(row);
                if area.is_empty() {
                    break;
                }
                let [start, end] = area.rows;
                prop_assert!(u32::from(start) >= row && start / rows == (end - 1) / rows, "{area:?} from {row}");
                // Not all of it at once.
                let bottom = end.min(start + band);
                row = bottom.into();
                pixels().filter(|&(x, y)| has(&PixelRect { rows: [start, bottom], ..area }, x, y)).for_each(|(x, y)| drawn[y as usize][x as usize] = true);
            }
            let wanted = |x, y| areas.iter().any(|area| has(area, x, y));
            for first in (0..SIDES[1]).step_by(rows.into()) {
                let strip = hull(pixels().filter(|&(x, y)| (first..first + rows).contains(&y) && wanted(x, y)));
                for (x, y) in pixels().filter(|&(_, y)| (first..first + rows).contains(&y)) {
                    prop_assert_eq!(drawn[y as usize][x as usize], has(&strip, x, y), "{} {}", x, y);
                }
            }
            let within = region.within(&other);
            prop_assert_eq!(if within.is_empty() { PixelRect::NONE } else { within }, hull(pixels().filter(|&(x, y)| drawn[y as usize][x as usize] && has(&other, x, y))));
            prop_assert_eq!(region.hull(), hull(pixels().filter(|&(x, y)| wanted(x, y))));
        }
    }

    #[test]
    fn a_whole_picture_is_one_strip() {
        let mut region = Region::NONE;
        region.fill(Size::new(30, 100));
        let area = PixelRect { columns: [4, 9], rows: [80, 90] };
        region.include(&area);
        assert!(region.is_whole() && region.next(0) == region.hull() && region.within(&area) == area);
        assert_eq!(region.next(40), PixelRect { columns: [0, 30], rows: [40, 100] });
        assert!(region.next(100).is_empty());
    }
}
