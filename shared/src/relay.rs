//! What a band hands on to the next: triangles that reach across its lower border, on the row where they left off.
//!
//! All that is walked is walked exactly, modulo 2^32: going on from there makes the same pixels as setting up anew. Bands draw
//! triangles in the order of the stream, so that what one hands on the next takes in the same order: a queue. A triangle that finds it
//! full is set up anew.

use crate::{
    poly::{Patch, plane::Plane},
    raster::sides::Rest,
};

/// Words of a quadratic in three channels.
const WORDS: usize = 18;

/// A triangle on its way to the next band.
#[derive(Clone, Copy, Debug)]
pub struct Leg {
    /// That of the triangle's entry in its list; 0 is of none.
    pub(crate) key: u32,
    pub(crate) rest: Rest,
    /// Standing on the next band's first row, if it is known.
    pub(crate) nearness: Option<Plane<1>>,
    /// What its patch keeps.
    words: [u32; WORDS],
}

impl Leg {
    /// Of no triangle; all zeros, as memory in a `static` should be.
    pub const EMPTY: Self = Self { key: 0, rest: Rest::NONE, nearness: None, words: [0; WORDS] };

    /// Keeps what has been walked to the end of a band; false if there is no way to.
    #[inline(always)]
    pub(crate) fn keep<D: Patch, P: Patch>(&mut self, (key, rest): (u32, Rest), depth: &D, patch: &P) -> bool {
        let mut plane = [0; 3];
        self.nearness = if D::WORDS > 0 && depth.keep(&mut plane) { Plane::kept(&plane) } else { None };
        (self.key, self.rest) = (key, rest);
        patch.keep(&mut self.words)
    }

    /// The patch as it was kept.
    #[inline(always)]
    pub(crate) fn patch<P: Patch>(&self) -> Option<P> {
        P::kept(&self.words)
    }
}

/// Where a queue stands between two bands.
#[derive(Clone, Copy, Debug, Default)]
pub struct Queued {
    first: usize,
    count: usize,
}

/// The queue of one frame.
#[derive(Debug, Default)]
pub struct Relay<'a> {
    legs: &'a mut [Leg],
    queued: Queued,
}

impl<'a> Relay<'a> {
    /// The queue that stands like this.
    #[must_use]
    pub fn new(legs: &'a mut [Leg], queued: Queued) -> Self {
        Self { legs, queued }
    }

    /// Where it stands.
    #[must_use]
    pub fn queued(&self) -> Queued {
        self.queued
    }

    /// Takes the first one, if it is the triangle with this `key`: the place of its leg, which stays as it is until another is put.
    #[inline(always)]
    pub(crate) fn take(&mut self, key: u32) -> Option<usize> {
        let Queued { first, count } = self.queued;
        if count == 0 || self.legs.get(first)?.key != key {
            return None;
        }
        self.queued = Queued { first: if first + 1 < self.legs.len() { first + 1 } else { 0 }, count: count - 1 };
        Some(first)
    }

    /// The leg at a place.
    #[inline(always)]
    pub(crate) fn leg(&self, place: usize) -> Option<&Leg> {
        self.legs.get(place)
    }

    /// Puts a leg at the end, if there is room and `fill` says so.
    #[inline(always)]
    pub(crate) fn put(&mut self, fill: impl FnOnce(&mut Leg) -> bool) {
        let (Queued { first, count }, length) = (self.queued, self.legs.len());
        let place = first.wrapping_add(count);
        let place = if place < length { place } else { place.wrapping_sub(length) };
        if count < length
            && let Some(leg) = self.legs.get_mut(place)
            && fill(leg)
        {
            self.queued.count = count + 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn legs_come_out_in_the_order_they_went_in() {
        let mut legs = [Leg::EMPTY; 3];
        let mut relay = Relay::new(&mut legs, Queued::default());
        let put = |relay: &mut Relay<'_>, key, fits| {
            relay.put(|leg| {
                leg.key = key;
                fits
            });
        };
        assert_eq!(relay.take(1), None, "nothing is there");
        // One cannot be kept, and the last one finds no room.
        for (key, fits) in [(1, true), (3, false), (5, true), (7, true), (9, true)] {
            put(&mut relay, key, fits);
        }
        assert_eq!(relay.take(5), None, "not its turn");
        assert_eq!(relay.take(1), Some(0));
        // The next band hands it on again: behind the others, around the end.
        put(&mut relay, 1, true);
        let queued = relay.queued();
        let mut relay = Relay::new(&mut legs, queued);
        assert_eq!([5, 7, 9, 1].map(|key| relay.take(key)), [Some(1), Some(2), None, Some(0)]);
        assert_eq!(relay.take(1), None, "it is empty again");
    }
}
