//! A board that executes the instructions of a program.

use anyhow::Result;

/// A board with a program in its flash, and a display.
pub(crate) trait Machine {
    /// Executes one instruction.
    fn step(&mut self) -> Result<()>;

    /// Takes what the program has logged.
    fn take_log(&mut self) -> Vec<u8>;

    /// Cycles since the start.
    fn cycle(&self) -> u64;

    /// The picture on the display, which must have been driven well.
    fn picture(&self) -> Result<Vec<u32>>;
}
