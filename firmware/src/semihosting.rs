//! Talking to the host that emulates the board.

use cortex_m_semihosting::{nr, syscall, syscall1};
use defmt_semihosting as _;

/// Blocks until the host sends a byte: it has looked at the display.
pub(crate) fn wait_for_host() {
    // SAFETY: READC takes no argument and touches no memory of ours.
    unsafe { syscall1(nr::READC, 0) };
}

/// Ends the emulation with this exit code.
pub(crate) fn exit(code: u32) -> ! {
    /// Like EXIT, with a code.
    const EXIT_EXTENDED: usize = 0x20;
    /// The program ended by itself.
    const APPLICATION_EXIT: u32 = 0x2_0026;
    let arguments = [APPLICATION_EXIT, code];
    loop {
        // SAFETY: the call reads two words.
        unsafe { syscall(EXIT_EXTENDED, &arguments) };
    }
}

/// Panics and faults end here. The emulator would run the default handler's loop for ever.
#[cortex_m_rt::exception]
unsafe fn HardFault(_: &cortex_m_rt::ExceptionFrame) -> ! {
    exit(101)
}
