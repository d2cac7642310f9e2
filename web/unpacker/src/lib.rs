//! The WebAssembly module that unpacks the playground's own: browsers cannot unpack LZMA, which takes three fifths of the bytes of gzip.
//!
//! The page asks for a place with [`place`], writes the packed bytes there, and calls [`unpack`].

use lzma_rust2::{Action, LzmaStream, StreamResult};
use std::cell::RefCell;

thread_local! {
    /// The packed bytes.
    static PACKED: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    /// The bytes that were packed.
    static UNPACKED: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// A place for this many packed bytes.
#[unsafe(no_mangle)]
pub extern "C" fn place(length: usize) -> usize {
    PACKED.with_borrow_mut(|packed| {
        packed.resize(length, 0);
        packed.as_mut_ptr().expose_provenance()
    })
}

/// The place of the `length` bytes that were packed; 0 if they are damaged.
#[unsafe(no_mangle)]
pub extern "C" fn unpack(length: usize) -> usize {
    UNPACKED.with_borrow_mut(|unpacked| {
        unpacked.resize(length, 0);
        let done = PACKED.with_borrow(|packed| fill(unpacked, packed));
        done.map_or(0, |()| unpacked.as_ptr().expose_provenance())
    })
}

/// Fills a place by what was packed; `None` if it is damaged.
fn fill(mut place: &mut [u8], mut packed: &[u8]) -> Option<()> {
    let mut stream = LzmaStream::new_mem_limit(u32::MAX, None);
    while !place.is_empty() {
        let StreamResult { bytes_consumed, bytes_produced, .. } = stream.process(packed, place, Action::Finish).ok()?;
        if (bytes_consumed, bytes_produced) == (0, 0) {
            return None;
        }
        (packed, place) = (&packed[bytes_consumed..], &mut place[bytes_produced..]);
    }
    Some(())
}
