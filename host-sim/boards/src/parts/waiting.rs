//! Time passes faster while a program only waits: one that looks at the clock again and again waits for a time to come.

/// Cycles between two looks at the clock of a program that waits.
const LOOK: u64 = 200;
/// Cycles that a look costs otherwise.
const ACCESS: u64 = 2;

/// When a program last looked at the clock.
#[derive(Default)]
pub(crate) struct Waiting {
    looked: u64,
}

impl Waiting {
    /// The program looks at the clock at cycle `now`. Returns the cycles that pass: `step` if it waits.
    pub(crate) fn look(&mut self, now: u64, step: u64) -> u64 {
        let passed = if now.saturating_sub(self.looked) < LOOK { step } else { ACCESS };
        self.looked = now + passed;
        passed
    }
}
