//! What the second processor does in the mask ROM: it waits for the first one to name a program, word by word.

use rp2350_emu::Bus as Chip;

/// Registers of the queue between the processors, as the second one sees them.
const STATUS: u32 = 0xD000_0050;
const WRITE: u32 = 0xD000_0054;
const READ: u32 = 0xD000_0058;
/// There is a word to read.
const VALID: u32 = 1;

/// The words that come before those that say something.
const BEGIN: [u32; 3] = [0, 0, 1];

/// The program that is named.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Start {
    pub(super) vectors: u32,
    pub(super) stack: u32,
    pub(super) entry: u32,
}

/// The words of a valid sequence that have come so far.
#[derive(Default)]
pub(super) struct Launch(Vec<u32>);

impl Launch {
    /// Answers each word by itself. A word that does not belong to the sequence begins it anew.
    pub(super) fn answer(&mut self, chip: &mut Chip) -> Option<Start> {
        while chip.read32(STATUS, 1) & VALID != 0 {
            let word = chip.read32(READ, 1);
            if BEGIN.get(self.0.len()).is_none_or(|&expected| expected == word) {
                self.0.push(word);
            } else {
                self.0.clear();
            }
            chip.write32(WRITE, word, 1);
            if let [_, _, _, vectors, stack, entry] = self.0[..] {
                self.0.clear();
                return Some(Start { vectors, stack, entry });
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rp2350_emu::threaded::CoreAtomics;
    use std::sync::Arc;

    #[test]
    fn a_program_is_named_word_by_word() {
        let mut chip = Chip::with_atomics(Arc::new(CoreAtomics::default()));
        let mut launch = Launch::default();
        // Another program's rest, and the sequence.
        let words = [7, 0, 0, 5, 0, 0, 1, 0x1000_0000, 0x2000_1000, 0x1000_0301];
        for (k, word) in words.into_iter().enumerate() {
            chip.write32(WRITE, word, 0);
            let start = launch.answer(&mut chip);
            assert_eq!(chip.read32(READ, 0), word);
            let expected = Start { vectors: 0x1000_0000, stack: 0x2000_1000, entry: 0x1000_0301 };
            assert_eq!(start, (k + 1 == words.len()).then_some(expected), "word {k}");
        }
    }
}
