//! Active triangles, which reach across the lower border of a band. They are saved at the row where the next band continues.
//!
//! Edges and polynomials are stepped exactly, modulo 2^32, so continuing them gives the same pixels as setting them up again. All bands draw
//! triangles in the order of the stream, so active triangles form a queue. If the queue is full, the next band sets up the triangle again.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::{
    interpolate::{Patch, plane::Plane},
    setup::edge_walker::EdgeState,
};

/// A triangle whose drawing the next band continues.
#[derive(FromBytes, IntoBytes, Immutable, KnownLayout, Clone, Copy, Debug)]
#[repr(C)]
pub struct ActiveTriangle {
    /// The triangle, [`crate::geometry::bin::TriangleKey::word`]; 0 if there is none.
    pub(crate) key: u32,
    pub(crate) edges: EdgeState,
    /// Not 0 if the depth has been saved.
    has_depth: u16,
    /// What `auto` has chosen for the triangle. It has a meaning only if `auto` has drawn it.
    pub(crate) choice: u16,
    /// The plane of depth, on the first row of the next band.
    depth: [u32; 3],
    /// The saved patch.
    words: [u32; Self::WORDS],
}

impl ActiveTriangle {
    /// No triangle; all zeros, which takes no flash in static memory.
    pub const EMPTY: Self = Self { key: 0, edges: EdgeState::NONE, has_depth: 0, choice: 0, depth: [0; 3], words: [0; Self::WORDS] };

    /// Words of a patch that can be saved: a quadratic in three channels.
    pub(crate) const WORDS: usize = 18;

    /// Saves a triangle that has been stepped to the end of a band. There is room for its patch.
    #[inline(always)]
    pub(crate) fn save<D: Patch, P: Patch>(&mut self, (key, edges): (u32, EdgeState), depth: &D, patch: &P) {
        self.has_depth = u16::from(D::WORDS > 0);
        depth.save(&mut self.depth);
        (self.key, self.edges) = (key, edges);
        patch.save(&mut self.words);
    }

    /// The plane of depth; `None` if the triangle is drawn without depth test.
    #[inline]
    pub(crate) fn inv_depth(&self) -> Option<Plane<1>> {
        if self.has_depth != 0 { Plane::load(&self.depth) } else { None }
    }

    /// The saved patch.
    pub(crate) fn patch<P: Patch>(&self) -> Option<P> {
        P::load(&self.words)
    }
}

/// First entry and length of the queue, between two bands.
#[derive(Clone, Copy, Debug, Default)]
pub struct QueueState {
    first: usize,
    count: usize,
}

/// The queue of active triangles.
#[derive(Debug, Default)]
pub struct ActiveTriangles<'a> {
    active_triangles: &'a mut [ActiveTriangle],
    /// The state of the queue.
    pub(crate) queue: QueueState,
    /// Number of triangles of this band that found the queue full.
    pub(crate) overflow: u32,
    /// What `auto` has chosen for the triangle that is drawn, for [`ActiveTriangle::choice`]. Other methods leave it as it is.
    pub(crate) choice: u16,
}

impl<'a> ActiveTriangles<'a> {
    /// The queue in this state.
    pub fn new(active_triangles: &'a mut [ActiveTriangle], queue: QueueState) -> Self {
        Self { active_triangles, queue, overflow: 0, choice: 0 }
    }

    /// Takes the first triangle off the queue if it has this `key`; returns its index. The entry stays valid until another triangle is put.
    #[inline(always)]
    pub(crate) fn take(&mut self, key: u32) -> Option<usize> {
        let QueueState { first, count } = self.queue;
        if count == 0 || self.active_triangles.get(first)?.key != key {
            return None;
        }
        self.queue = QueueState { first: if first + 1 < self.active_triangles.len() { first + 1 } else { 0 }, count: count - 1 };
        Some(first)
    }

    /// The active triangle at an index.
    #[inline]
    pub(crate) fn active_triangle(&self, place: usize) -> Option<&ActiveTriangle> {
        self.active_triangles.get(place)
    }

    /// Puts a triangle, which `fill` writes, at the end of the queue if there is room.
    #[inline(always)]
    pub(crate) fn put(&mut self, fill: impl FnOnce(&mut ActiveTriangle)) {
        let (QueueState { first, count }, length) = (self.queue, self.active_triangles.len());
        let place = first.wrapping_add(count);
        let place = if place < length { place } else { place.wrapping_sub(length) };
        if count >= length {
            self.overflow = self.overflow.saturating_add(1);
        } else if let Some(active_triangle) = self.active_triangles.get_mut(place) {
            fill(active_triangle);
            active_triangle.choice = self.choice;
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
        let put = |active: &mut ActiveTriangles<'_>, key| active.put(|active_triangle| active_triangle.key = key);
        assert_eq!(active.take(1), None, "nothing is there");
        // The last one finds no room.
        [1, 5, 7, 9].into_iter().for_each(|key| put(&mut active, key));
        assert_eq!(active.take(5), None, "not its turn");
        assert_eq!(active.take(1), Some(0));
        // The next band hands it on again: behind the others, around the end.
        put(&mut active, 1);
        let queue = active.queue;
        let mut active = ActiveTriangles::new(&mut active_triangles, queue);
        assert_eq!([5, 7, 9, 1].map(|key| active.take(key)), [Some(1), Some(2), None, Some(0)]);
        assert_eq!(active.take(1), None, "it is empty again");
    }
}
