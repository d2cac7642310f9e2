//! Triangles of a frame, sorted once by the rows in which they start.
//!
//! Each triangle is stored once, in the list of the first bin that it touches. When drawing reaches a bin, the list of *active* triangles takes over
//! its list. A triangle is dropped below its last row. Lists are in the order of the stream, so the picture does not depend on the height of bands.

use core::{array, cell::Cell, num::NonZeroU32, ops::Range};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// Number of bins of a frame, which share its rows.
pub(crate) const BINS: usize = 64;

/// The end of a list. A link is one more than the index that it leads to, so that empty memory is all zeros.
const NONE: u16 = 0;

/// The end of a bin's list that other lists may follow, plus the number of the bin.
const OPEN: u16 = 1 << 15;

/// A triangle in a list: twice its index in the stream, plus 1 if it is word-sized. Each triangle has another key.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct TriangleKey(u32);

impl TriangleKey {
    #[inline]
    fn new(triangle: u32, word_sized: bool) -> Self {
        Self(triangle << 1 | u32::from(word_sized))
    }

    /// Index of the triangle in the stream.
    #[inline]
    pub(crate) fn triangle(self) -> u32 {
        self.0 >> 1
    }

    /// Whether the triangle was pushed as word-sized, see [`Bins::push`].
    #[inline]
    pub(crate) fn is_word_sized(self) -> bool {
        self.0 & 1 != 0
    }

    /// The key as a word, which is not 0 if the triangle is word-sized.
    #[inline]
    pub(crate) fn word(self) -> u32 {
        self.0
    }
}

/// An entry of a list. Entries of a list are in the order of their keys.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Entry {
    /// Key of the triangle.
    pub(crate) key: TriangleKey,
    /// One past the last row of the triangle.
    bottom: u16,
    /// Link to the next entry.
    next: u16,
}

#[cfg(test)]
impl Entry {
    /// An entry of zeros.
    pub(crate) const EMPTY: Self = Self { key: TriangleKey(0), bottom: 0, next: NONE };
}

/// The triangles of one frame: a list for each bin, and one of active triangles. Fields are ordered by use, because instructions of Armv6-M reach
/// little of a structure.
#[derive(Clone, Debug)]
#[repr(C)]
pub(crate) struct Bins {
    /// The reciprocal of the rows of a bin, Q1.20, rounded up.
    bins_per_row: u32,
    /// First row of the highest triangle, and one past the last row of the lowest.
    top: u32,
    bottom: u32,
    /// Number of bins whose lists `active` has taken over.
    reached: usize,
    /// One past the last row of the bands so far.
    drawn: u32,
    /// Entries in use.
    count: u16,
    active: u16,
    /// Whether some triangle found no room.
    overflow: bool,
    heads: [u16; BINS],
    /// Entries in use that are in no list.
    kept: u16,
}

impl Bins {
    /// Empty lists for a picture of `height` rows that is drawn `band_rows` rows at a time. A bin is at least as high as a band, so that each band
    /// merges one list.
    pub(crate) fn new(height: u32, band_rows: u32) -> Self {
        Self {
            heads: [NONE; BINS],
            active: NONE,
            count: 0,
            kept: 0,
            overflow: false,
            reached: 0,
            drawn: 0,
            top: height,
            bottom: 0,
            bins_per_row: (1 << 20) / NonZeroU32::new(height.div_ceil(BINS as u32).max(band_rows)).unwrap_or(NonZeroU32::MIN) + 1,
        }
    }

    /// The bin of a row below 2048, by a product, which is cheaper than a quotient. With bins of more than 512 rows the result may be one too high.
    /// This does no harm, because it is used both to store and to find triangles.
    #[inline]
    fn of(&self, row: u32) -> usize {
        (row.wrapping_mul(self.bins_per_row) >> 20) as usize
    }

    /// Puts a triangle that covers rows `top .. bottom` in front of its list, and remembers whether it is `word_sized`. Triangles are
    /// pushed from the last to the first.
    #[inline]
    pub(crate) fn push(&mut self, entries: &mut [Entry], triangle: u32, word_sized: bool, [top, bottom]: [u32; 2]) {
        let bin = self.of(top);
        let link = self.count.wrapping_add(1);
        match (self.heads.get_mut(bin), entries.get_mut(usize::from(self.count))) {
            (Some(head), Some(entry)) if link != NONE => {
                *entry = Entry { key: TriangleKey::new(triangle, word_sized), bottom: bottom as u16, next: *head };
                *head = link;
                self.count = link;
                self.top = self.top.min(top);
                self.bottom = self.bottom.max(bottom);
            }
            _ => self.overflow = true,
        }
    }

    /// Puts a triangle that has no pixel among the entries, and into no list. Triangles are kept in the order of [`Self::push`].
    #[inline(never)]
    pub(crate) fn keep(&mut self, entries: &mut [Entry], triangle: u32) {
        match entries.get_mut(usize::from(self.count)) {
            Some(entry) if self.count < u16::MAX => {
                *entry = Entry { key: TriangleKey::new(triangle, false), bottom: 0, next: NONE };
                self.count += 1;
                self.kept += 1;
            }
            _ => self.overflow = true,
        }
    }

    /// Copies the bins without their triangles. Each list ends with the number of its bin, so that [`Self::join`] can append other lists. A frame has
    /// less than 2^15 triangles.
    pub(crate) fn open(&self) -> Self {
        Self { heads: array::from_fn(|bin| OPEN | bin as u16), ..self.clone() }
    }

    /// Puts the lists of `earlier` triangles before these. Their entries lie from index `first` on, where their links begin. They are moved next to
    /// the others, and have the larger links, as all entries that are pushed later.
    pub(crate) fn join(&mut self, entries: &mut [Entry], earlier: &Self, first: usize) {
        let Self { heads, count, .. } = *self;
        // The link of an entry that is in no list leads nowhere.
        let joined = |link| if link & OPEN == 0 { link + count } else { heads.get(usize::from(link & !OPEN)).copied().unwrap_or(NONE) };
        let entries = Cell::from_mut(entries).as_slice_of_cells();
        let (to, from) = (entries.get(count.into()..).unwrap_or_default(), entries.get(first..).unwrap_or_default());
        for (to, from) in to.iter().zip(from).take(earlier.count.into()) {
            let entry = from.get();
            to.set(Entry { next: joined(entry.next), ..entry });
        }
        self.heads = earlier.heads.map(joined);
        self.count = count + earlier.count;
        self.kept += earlier.kept;
        self.overflow |= earlier.overflow;
        (self.top, self.bottom) = (self.top.min(earlier.top), self.bottom.max(earlier.bottom));
    }

    /// Number of triangles in the lists.
    pub(crate) fn linked(&self) -> u16 {
        self.count.saturating_sub(self.kept)
    }

    /// Number of entries; `None` if some triangle found no room.
    pub(crate) fn count(&self) -> Option<u16> {
        (!self.overflow).then_some(self.count)
    }

    /// The rows from the top of the highest triangle to the bottom of the lowest.
    pub(crate) fn rows(&self) -> Range<u32> {
        self.top.min(self.bottom)..self.bottom
    }

    /// The row above which a `share` of the triangles end, in units of 1/65,536. Two processors share the work in about this proportion if the frame
    /// is divided there.
    pub(crate) fn row_at(&self, entries: &[Entry], share: u16) -> u32 {
        let Range { start, end } = self.rows();
        let step = NonZeroU32::new((end - start).div_ceil(BINS as u32)).unwrap_or(NonZeroU32::MIN);
        let steps_per_row = (1 << 20) / step + 1;
        let mut ends = [0u16; BINS];
        for entry in entries.iter().take(self.count.into()).filter(|entry| entry.bottom > 0) {
            let last = u32::from(entry.bottom).saturating_sub(start + 1);
            if let Some(ends) = ends.get_mut((last.wrapping_mul(steps_per_row) >> 20) as usize) {
                *ends += 1;
            }
        }
        let (mut wanted, mut row) = ((u32::from(self.linked()) * u32::from(share)) >> 16, start);
        for ends in ends.map(u32::from) {
            match NonZeroU32::new(ends) {
                Some(ends) if wanted < ends.get() => return row + wanted * step.get() / ends,
                _ => (wanted, row) = (wanted - ends, row + step.get()),
            }
        }
        end
    }

    /// The triangles of the band that ends at row `bottom`. Afterwards [`Self::take_over`] keeps those that reach into the next band.
    pub(crate) fn band<'e>(&mut self, entries: &'e mut [Entry], bottom: u32) -> Walk<'e> {
        let last = self.of(bottom.saturating_sub(1));
        let mut fresh = NONE;
        while self.reached <= last {
            if let Some(&head) = self.heads.get(self.reached) {
                fresh = if fresh == NONE { head } else { merge(entries, [fresh, head]) };
            }
            self.reached += 1;
        }
        self.drawn = bottom;
        Walk { entries, lists: [self.active.into(), fresh.into()], head: NONE.into(), tail: NONE.into(), bottom }
    }

    /// Leaves out the triangles that end above `row`, where the next band begins. If that is the end of the last band, nothing happens.
    pub(crate) fn skip(&mut self, entries: &mut [Entry], row: u32) {
        if row > self.drawn {
            let walk = self.band(entries, row);
            self.take_over(walk);
        }
    }

    /// Keeps the triangles of a band that reach into the next one.
    pub(crate) fn take_over(&mut self, walk: Walk<'_>) {
        self.active = walk.end();
    }
}

/// The triangles of a band in the order of the stream: the ones that reach down from above and the ones that start here, merged step by step.
/// Triangles that reach below the band are collected in a list for the next one.
#[derive(Debug)]
pub(crate) struct Walk<'e> {
    entries: &'e mut [Entry],
    lists: [u32; 2],
    /// Head of the list of triangles that reach below the band; `tail` is its last entry.
    head: u32,
    tail: u32,
    bottom: u32,
}

impl Iterator for Walk<'_> {
    type Item = TriangleKey;

    #[inline]
    fn next(&mut self) -> Option<TriangleKey> {
        // Entries are put in from the last triangle to the first: of two lists the later entry comes first in the stream. Which list is which
        // does not matter.
        let [one, other] = self.lists;
        let (link, rest) = (one.max(other), one.min(other));
        let entry = *linked(link).and_then(|index| self.entries.get(index))?;
        self.lists = [entry.next.into(), rest];
        if u32::from(entry.bottom) > self.bottom {
            append(self.entries, &mut self.head, self.tail, link);
            self.tail = link;
        }
        Some(entry.key)
    }
}

impl Walk<'_> {
    /// Walks to the end; returns the head of the list of triangles that reach below the band.
    fn end(mut self) -> u16 {
        while self.next().is_some() {}
        append(self.entries, &mut self.head, self.tail, NONE.into());
        self.head as u16
    }
}

/// The index that a link leads to.
#[inline]
fn linked(link: u32) -> Option<usize> {
    link.checked_sub(1).map(|index| index as usize)
}

/// Makes `link` follow `tail`, the last entry of the list that starts at `head`.
#[inline]
fn append(entries: &mut [Entry], head: &mut u32, tail: u32, link: u32) {
    match linked(tail).and_then(|index| entries.get_mut(index)) {
        Some(tail) => tail.next = link as u16,
        None => *head = link,
    }
}

/// Merges two lists in the order of the stream; returns the head of the merged list.
fn merge(entries: &mut [Entry], lists: [u16; 2]) -> u16 {
    Walk { entries, lists: lists.map(u32::from), head: NONE.into(), tail: NONE.into(), bottom: 0 }.end()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_triangle_is_active_on_its_rows_and_in_order() {
        const HEIGHT: u32 = 240;
        let mut entries = [Entry::EMPTY; 100];
        let rows = |i: u32| (i * 37 % 200, (i * 37 % 200 + 1 + i * 11 % 60).min(HEIGHT));
        for band in [1, 7, 10, 40, 240] {
            let mut bins = Bins::new(HEIGHT, band.min(10));
            for i in (0..100).rev() {
                let (top, bottom) = rows(i as u32);
                bins.push(&mut entries, i as u32, i % 3 == 0, [top, bottom]);
            }
            assert_eq!(bins.count(), Some(100));
            let mut top = 0;
            while top < HEIGHT {
                let bottom = (top + band).min(HEIGHT);
                let mut seen = [false; 100];
                let mut last = None;
                let mut walk = bins.band(&mut entries, bottom);
                for key in walk.by_ref() {
                    let triangle = key.triangle();
                    assert_eq!(key.is_word_sized(), triangle % 3 == 0);
                    assert!(last < Some(triangle));
                    assert!(rows(triangle).1 > top, "it has ended");
                    seen[triangle as usize] = true;
                    last = Some(triangle);
                }
                bins.take_over(walk);
                for i in 0..100 {
                    let (first, end) = rows(i);
                    assert!(seen[i as usize] || end <= top || first >= bottom, "band {band}, rows {top}..{bottom}, triangle {i}");
                }
                top = bottom;
            }
        }
    }

    /// The number of triangles that end above the row of a share is right, except for triangles that end in the same 1/64 of the frame's rows.
    #[test]
    fn a_share_of_the_triangles_ends_above_its_row() {
        let (mut entries, mut bins) = ([Entry::EMPTY; 400], Bins::new(240, 10));
        let bottoms: [u32; 400] = core::array::from_fn(|i| 41 + (i as u32 * i as u32) % 151);
        for (i, &bottom) in bottoms.iter().enumerate().rev() {
            bins.push(&mut entries, i as u32, true, [40.min(bottom - 1), bottom]);
        }
        let step = (191u32 - 40).div_ceil(64);
        for share in (0..=u16::MAX).step_by(1021) {
            let (row, wanted) = (bins.row_at(&entries, share), (400 * usize::from(share)) >> 16);
            let above = |row: u32| bottoms.iter().filter(|&&bottom| bottom <= row).count();
            assert!((above(row.saturating_sub(step))..=above(row + step)).contains(&wanted), "{share}: {row}, {wanted}");
        }
        assert_eq!(Bins::new(240, 10).row_at(&entries, 1 << 15), 0, "of no triangles");
    }
}
