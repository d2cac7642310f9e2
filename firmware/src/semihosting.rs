//! Talking to the host that emulates the board.

use defmt_semihosting as _;
use semihosting::{process, sys::arm_compat::sys_readc};

/// The exit code after a panic or a fault.
pub(crate) const CRASH: i32 = 101;

/// Blocks until the host sends a byte: it has looked at the display.
pub(crate) fn wait_for_host() {
    sys_readc();
}

/// Ends the emulation with this exit code.
pub(crate) fn exit(code: i32) -> ! {
    process::exit(code)
}

/// Faults end here, and panics, too. The emulator would run the default handler's loop for ever.
#[cfg(target_arch = "arm")]
#[cortex_m_rt::exception]
unsafe fn HardFault(_: &cortex_m_rt::ExceptionFrame) -> ! {
    exit(CRASH)
}

/// Faults end here. The emulator would run the default handler's loop for ever.
#[cfg(target_arch = "riscv32")]
#[unsafe(no_mangle)]
extern "C" fn ExceptionHandler(_: &riscv_rt::TrapFrame) -> ! {
    exit(CRASH)
}
