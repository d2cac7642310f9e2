//! Measurement of the largest stack that was used.

use cortex_m_rt::STACK_PAINT_VALUE;

/// Bytes of stack used since the start. The start-up code has painted all of the stack; what has lost its paint has been used.
#[must_use]
pub(crate) fn used() -> usize {
    unsafe extern "C" {
        static _stack_end: u32;
        static _stack_start: u32;
    }
    let bottom = &raw const _stack_end;
    let top = &raw const _stack_start;
    let words = (top.addr() - bottom.addr()) / size_of::<u32>();
    // SAFETY: the linker places both symbols at the ends of the stack, aligned; it is readable RAM.
    unsafe { without_paint(bottom, words, STACK_PAINT_VALUE) }
}

/// Bytes of a stack, its lowest word at `bottom`, that have lost their paint.
///
/// # Safety
/// All `words` can be read.
pub(crate) unsafe fn without_paint(bottom: *const u32, words: usize, paint: u32) -> usize {
    // SAFETY: as above. Volatile, as the part above the stack pointer changes behind the compiler's back.
    let clean = (0..words).take_while(|&word| unsafe { bottom.add(word).read_volatile() } == paint).count();
    (words - clean) * size_of::<u32>()
}
