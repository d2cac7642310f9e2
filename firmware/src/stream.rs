//! The triangle stream in flash.

use microphong::stream::Aligned;

/// The stream that the program is built with; a tool may replace it in the ELF or in flash.
#[used]
#[unsafe(link_section = ".stream")]
static EMBEDDED: Aligned<[u8; include_bytes!(env!("STREAM_FILE")).len()]> = Aligned(*include_bytes!(env!("STREAM_FILE")));

/// Everything from the start of the stream to the end of its memory region; the header tells how much of it counts.
///
/// Taken from the linker, not from [`EMBEDDED`]: the compiler must not assume what the bytes are.
#[must_use]
pub(crate) fn bytes() -> &'static [u8] {
    unsafe extern "C" {
        static __stream_start: u8;
        static __stream_end: u8;
    }
    let start = &raw const __stream_start;
    let length = (&raw const __stream_end).addr() - start.addr();
    // SAFETY: the region is memory of its own, which nothing writes while the program runs.
    unsafe { core::slice::from_raw_parts(start, length) }
}
