//! Random numbers, equal on every machine and in every version.

use rand_chacha::{
    ChaCha8Rng,
    rand_core::{RngCore, SeedableRng},
};
use std::ops::Range;

/// A source of random numbers.
#[derive(Clone, Debug)]
pub struct Random(ChaCha8Rng);

impl Random {
    /// Case `number` of a run with this `seed`, whatever was drawn before.
    #[must_use]
    pub fn new(seed: u64, number: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(number);
        Self(random)
    }

    /// Another source, one for each `number`, whose numbers do not depend on this one's. This one goes on as if the other had never been made.
    #[must_use]
    pub fn aside(&self, number: u64) -> Self {
        let mut other = self.0.clone();
        other.set_stream(!other.get_stream() ^ number);
        Self(other)
    }

    /// A random number of 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// An integer in a range.
    pub fn pick(&mut self, range: Range<i32>) -> i32 {
        let width = (i64::from(range.end) - i64::from(range.start)).max(1) as u64;
        (i64::from(range.start) + (self.bits() % width) as i64) as i32
    }

    /// One of the choices.
    pub fn among<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.pick(0..choices.len() as i32) as usize]
    }

    /// True once in `n` times.
    pub fn once_in(&mut self, n: i32) -> bool {
        self.pick(0..n) == 0
    }

    /// Evenly between two numbers.
    pub fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number between two positive ones. Every octave is equally likely.
    pub fn octaves(&mut self, from: f64, to: f64) -> f64 {
        self.between(from.ln(), to.ln()).exp()
    }

    /// A point of the unit sphere.
    pub fn direction(&mut self) -> [f64; 3] {
        loop {
            let v = [(); 3].map(|()| self.between(-1.0, 1.0));
            let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
            if (1e-3..=1.0).contains(&length) {
                return v.map(|c| c / length);
            }
        }
    }
}
