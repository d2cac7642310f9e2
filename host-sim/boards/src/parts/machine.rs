//! A board that executes the instructions of a program.

use super::peripherals::Peripherals;
use crate::Executed;
use anyhow::Result;

/// A board with a program in its flash, and a display.
pub(crate) trait Machine {
    /// Executes one instruction.
    fn step(&mut self) -> Result<Executed>;

    /// Takes what the program has logged.
    fn take_log(&mut self) -> Vec<u8>;

    /// Cycles since the start, that all processors have reached.
    fn cycle(&self) -> u64;

    /// The picture on the display, which must have been driven well.
    fn picture(&self) -> Result<Vec<u32>>;
}

/// A board with a panel and a light.
pub(crate) trait Panelled: Machine {
    /// The address of the first processor's next instruction.
    fn pc(&self) -> u32;

    /// Whether the panel shows a whole picture, and was driven well.
    fn check(&self) -> Result<()>;

    /// The panel, and what it hangs on.
    fn peripherals(&self) -> &Peripherals;

    /// The same, to break something.
    fn peripherals_mut(&mut self) -> &mut Peripherals;

    /// The light is on.
    fn led(&self) -> bool;

    /// Nobody speaks to the panel.
    fn quiet(&self) -> bool;

    /// The contents of all RAM.
    fn ram(&self) -> Vec<u8>;
}
