//! What a band hands on to the next: triangles that reach across its lower border, on the row where they left off.
//!
//! All that is walked is walked exactly, modulo 2^32: going on from there makes the same pixels as setting up anew. Bands draw
//! triangles in the order of the stream, so that what one hands on the next takes in the same order: a queue. A triangle that finds it
//! full is set up anew.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::{
    interpolate::{Patch, plane::Plane},
    setup::edge_walker::EdgeState,
};

/// Words of a quadratic in three channels.
const WORDS: usize = 18;

/// A triangle on its way to the next band.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub struct ActiveTriangle {
    /// That of the triangle's entry in its list; 0 is of none.
    pub(crate) key: u32,
    pub(crate) edges: EdgeState,
    /// Not 0: the depth is known.
    has_depth: u32,
    /// The depth, standing on the next band's first row.
    depth: [u32; 3],
    /// What its patch keeps.
    words: [u32; WORDS],
}

impl ActiveTriangle {
    /// Of no triangle; all zeros, as memory in a `static` should be.
    pub const EMPTY: Self = Self { key: 0, edges: EdgeState::NONE, has_depth: 0, depth: [0; 3], words: [0; WORDS] };

    /// Keeps what has been walked to the end of a band; false if there is no way to.
    #[inline(always)]
    pub(crate) fn save<D: Patch, P: Patch>(&mut self, (key, edges): (u32, EdgeState), depth: &D, patch: &P) -> bool {
        self.has_depth = u32::from(D::WORDS > 0 && depth.save(&mut self.depth));
        (self.key, self.edges) = (key, edges);
        patch.save(&mut self.words)
    }

    /// The depth, if it is known.
    #[inline(always)]
    pub(crate) fn inv_depth(&self) -> Option<Plane<1>> {
        if self.has_depth != 0 { Plane::load(&self.depth) } else { None }
    }

    /// The patch as it was kept.
    #[inline(always)]
    pub(crate) fn patch<P: Patch>(&self) -> Option<P> {
        P::load(&self.words)
    }
}

/// Where a queue stands between two bands.
#[derive(Clone, Copy, Debug, Default)]
pub struct QueueState {
    first: usize,
    count: usize,
}

/// The queue of one frame.
#[derive(Debug, Default)]
pub struct ActiveTriangles<'a> {
    active_triangles: &'a mut [ActiveTriangle],
    queue: QueueState,
    /// Triangles that have found it full.
    overflow: u32,
}

impl<'a> ActiveTriangles<'a> {
    /// The queue that stands like this.
    #[must_use]
    pub fn new(active_triangles: &'a mut [ActiveTriangle], queue: QueueState) -> Self {
        Self { active_triangles, queue, overflow: 0 }
    }

    /// Triangles of this band that have found it full.
    #[must_use]
    pub fn overflow(&self) -> u32 {
        self.overflow
    }

    /// Where it stands.
    #[must_use]
    pub fn queue(&self) -> QueueState {
        self.queue
    }

    /// Takes the first one, if it is the triangle with this `key`: the place of its leg, which stays as it is until another is put.
    #[inline(always)]
    pub(crate) fn take(&mut self, key: u32) -> Option<usize> {
        let QueueState { first, count } = self.queue;
        if count == 0 || self.active_triangles.get(first)?.key != key {
            return None;
        }
        self.queue = QueueState { first: if first + 1 < self.active_triangles.len() { first + 1 } else { 0 }, count: count - 1 };
        Some(first)
    }

    /// The leg at a place.
    #[inline(always)]
    pub(crate) fn active_triangle(&self, place: usize) -> Option<&ActiveTriangle> {
        self.active_triangles.get(place)
    }

    /// Puts a leg at the end, if there is room and `fill` says so.
    #[inline(always)]
    pub(crate) fn put(&mut self, fill: impl FnOnce(&mut ActiveTriangle) -> bool) {
        let (QueueState { first, count }, length) = (self.queue, self.active_triangles.len());
        let place = first.wrapping_add(count);
        let place = if place < length { place } else { place.wrapping_sub(length) };
        if count >= length {
            self.overflow = self.overflow.saturating_add(1);
        } else if let Some(active_triangle) = self.active_triangles.get_mut(place)
            && fill(active_triangle)
        {
            self.queue.count = count + 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn legs_come_out_in_the_order_they_went_in() {
        let mut active_triangles = [ActiveTriangle::EMPTY; 3];
        let mut active = ActiveTriangles::new(&mut active_triangles, QueueState::default());
        let put = |active: &mut ActiveTriangles<'_>, key, fits| {
            active.put(|active_triangle| {
                active_triangle.key = key;
                fits
            });
        };
        assert_eq!(active.take(1), None, "nothing is there");
        // One cannot be kept, and the last one finds no room.
        for (key, fits) in [(1, true), (3, false), (5, true), (7, true), (9, true)] {
            put(&mut active, key, fits);
        }
        assert_eq!(active.take(5), None, "not its turn");
        assert_eq!(active.take(1), Some(0));
        // The next band hands it on again: behind the others, around the end.
        put(&mut active, 1, true);
        let queue = active.queue();
        let mut active = ActiveTriangles::new(&mut active_triangles, queue);
        assert_eq!([5, 7, 9, 1].map(|key| active.take(key)), [Some(1), Some(2), None, Some(0)]);
        assert_eq!(active.take(1), None, "it is empty again");
    }
}
