//! Start, stack and panics of Cortex-M processors.

use core::ops::Range;
pub(crate) use cortex_m_rt::STACK_PAINT_VALUE as PAINT;
pub use cortex_m_rt::entry;
use panic_probe as _;

/// The stack. The start-up code has painted all of it.
pub(crate) fn stack() -> Range<*const u32> {
    unsafe extern "C" {
        static _stack_end: u32;
        static _stack_start: u32;
    }
    &raw const _stack_end..&raw const _stack_start
}
