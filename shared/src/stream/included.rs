//! Streams that are part of a program: the compiler checks them, so that the program need not.

use super::{Header, Stream, StreamError, checksum_by_table, record::MAGIC, record::VERSION};

/// Embeds a stream file (a mesh file written by `microphong convert`) in the program, like `include_bytes!`. The result is a
/// `&'static [u8]` that is aligned for [`Stream::parse`](crate::Stream::parse), so the file can be read in place from flash:
/// `include_stream!("teapot.tri")`.
///
/// If the file is damaged, or has another format version, the program does not compile. The checksum shows that the file is as `convert` wrote it, so
/// [`Stream::parse_included`](crate::Stream::parse_included) need not check indices and ranges.
#[macro_export]
macro_rules! include_stream {
    ($path:expr) => {{
        static STREAM: &$crate::stream::Aligned<[u8]> = &$crate::stream::Aligned(*include_bytes!($path));
        // The compiler takes a second for the checksum of a megabyte.
        #[allow(long_running_const_eval)]
        const _: () = $crate::stream::check_included(include_bytes!($path));
        &STREAM.0
    }};
}

/// Checks that `bytes` are a complete stream of this format version, and that their checksum is right.
///
/// # Panics
/// Panics if they are not.
#[doc(hidden)]
pub const fn check_included(bytes: &[u8]) {
    assert!(bytes.len() >= size_of::<Header>(), "this is not a stream; make one with `microphong convert`");
    let [m, t, r, i, v0, v1, _, _, l0, l1, l2, l3, c0, c1, c2, c3, ..] = bytes else { return };
    assert!(matches!([*m, *t, *r, *i], MAGIC), "this is not a stream; make one with `microphong convert`");
    assert!(u16::from_le_bytes([*v0, *v1]) == VERSION, "the stream has another version; convert the mesh again");
    let length = u32::from_le_bytes([*l0, *l1, *l2, *l3]) as usize;
    assert!(length <= bytes.len(), "the stream is truncated; copy or convert it again");
    let computed = checksum_by_table(bytes.split_at(length).0);
    assert!(computed == u32::from_le_bytes([*c0, *c1, *c2, *c3]), "the stream is damaged; copy or convert it again");
}

impl<'a> Stream<'a> {
    /// Returns a view of a stream (mesh file) that [`include_stream!`](crate::include_stream!) has embedded. The compiler has checked these bytes, so
    /// only the header is checked again. This takes 4 KB less flash than [`Self::parse`].
    ///
    /// Use [`Self::parse`] for bytes from elsewhere, such as a memory card. If this function reads bytes that `microphong convert` has not written,
    /// pictures can be wrong.
    ///
    /// # Errors
    /// Returns a [`StreamError`] if the bytes are misaligned or truncated, or if their header is not that of a stream of this version.
    // Copies of it on the way stay off the stack of the frame loop.
    #[inline(never)]
    pub fn parse_included(bytes: &'a [u8]) -> Result<Self, StreamError> {
        Self::read(bytes)
    }
}
