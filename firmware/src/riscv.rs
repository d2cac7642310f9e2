//! Start, stack and panics of RISC-V processors.

use crate::semihosting;
use core::{arch::asm, ops::Range, panic::PanicInfo};
pub use riscv_rt::entry;

/// The value of words of the stack that were not used.
pub(crate) const PAINT: u32 = 0xCCCC_CCCC;

/// The stack. [`paint`] has painted what was free of it before `main`.
pub(crate) fn stack() -> Range<*const u32> {
    unsafe extern "C" {
        static __estack: u32;
        static _stack_start: u32;
    }
    &raw const __estack..&raw const _stack_start
}

/// Paints the free part of the stack, which the start-up code of this processor does not do.
#[riscv_rt::post_init]
fn paint() {
    let mut word = stack().start.cast_mut();
    let top: *mut u32;
    // SAFETY: reading the stack pointer has no effect.
    unsafe { asm!("mv {}, sp", out(reg) top, options(nomem, nostack, preserves_flags)) };
    while word < top {
        // SAFETY: the word lies in the stack, below all that is in use: this loop calls nothing.
        unsafe { word.write_volatile(PAINT) };
        word = word.wrapping_add(1);
    }
}

/// Logs the panic and ends the emulation.
#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    defmt::error!("{}", defmt::Display2Format(info));
    semihosting::exit(semihosting::CRASH)
}
