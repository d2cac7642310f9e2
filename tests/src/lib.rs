//! Cross-checks of whole programs; see the files in `tests/`.

use microphong::stream::{
    record::{CLOSED_CONVEX, Header, Mesh},
    seal,
};
use microphong_sim::bytes::StreamBytes;
use std::mem::{offset_of, size_of};

/// The same stream, its first mesh not marked as closed and convex: all of it is drawn with depth.
#[must_use]
pub fn unmarked(stream: &StreamBytes) -> StreamBytes {
    let mut bytes = stream.as_bytes().to_vec();
    bytes[size_of::<Header>() + offset_of!(Mesh, flags)] &= !CLOSED_CONVEX as u8;
    seal(&mut bytes);
    StreamBytes::from(bytes.as_slice())
}
