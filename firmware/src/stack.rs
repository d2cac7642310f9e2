//! Measurement of the largest stack that was used.

use crate::processor::{PAINT, stack};

/// Bytes of stack used since the start. The start-up code has painted all of the stack; what has lost its paint has been used.
#[must_use]
pub(crate) fn used() -> usize {
    let stack = stack();
    let words = (stack.end.addr() - stack.start.addr()) / size_of::<u32>();
    // SAFETY: the linker places both ends of the stack, aligned; it is readable RAM.
    unsafe { without_paint(stack.start, words, PAINT) }
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
