//! Draws frames on a board that QEMU emulates: all peers, one after the other.
#![no_std]
#![no_main]

extern crate alloc;

// The firmware's own; there is no picture here that a host would look at.
#[allow(dead_code)]
#[path = "../../../../firmware/src/semihosting.rs"]
mod semihosting;
// The host puts another stream in the place of the one that is built in.
#[path = "../../../../firmware/src/stream.rs"]
mod stream;

use core::{
    alloc::{GlobalAlloc, Layout},
    ptr::null_mut,
    sync::atomic::{AtomicUsize, Ordering::Relaxed},
};
use embedded_graphics_core::pixelcolor::{Rgb565, raw::RawU16};
use microphong::{Stream, pixel::PictureCrc};
use panic_probe as _;
use peers::{HEIGHT, Peer, Picture, WIDTH, scene::Scene};

/// Hands out memory and takes none back: the cheapest there is.
struct Bump;

const HEAP: usize = 3 << 20;
static mut MEMORY: [u64; HEAP / 8] = [0; HEAP / 8];
static USED: AtomicUsize = AtomicUsize::new(0);

#[global_allocator]
static ALLOCATOR: Bump = Bump;

// SAFETY: pieces are aligned, lie in memory that nothing else names, and do not overlap: there is one thread.
unsafe impl GlobalAlloc for Bump {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let start = USED.load(Relaxed).next_multiple_of(layout.align());
        let end = start + layout.size();
        if end > HEAP || layout.align() > 8 {
            return null_mut();
        }
        USED.store(end, Relaxed);
        (&raw mut MEMORY).cast::<u8>().wrapping_add(start)
    }

    unsafe fn dealloc(&self, _: *mut u8, _: Layout) {}
}

#[cortex_m_rt::entry]
fn main() -> ! {
    static mut PICTURE: Picture = [0; WIDTH * HEIGHT];
    let Some(scene) = Stream::parse(stream::bytes()).ok().and_then(|stream| Scene::new(&stream)) else {
        defmt::error!("error: no stream that other renderers can draw");
        semihosting::exit(1)
    };
    for peer in Peer::ALL {
        peer.draw(&scene, PICTURE);
        // The host reads these lines.
        defmt::info!("frame {=str} pixels {=usize} crc {=u32:08x}", peer.name(), peers::covered(PICTURE), checksum(PICTURE));
    }
    semihosting::exit(0)
}

/// A loop that takes long to watch: the host leaves it out by this name.
#[inline(never)]
fn checksum(picture: &Picture) -> u32 {
    let mut crc = PictureCrc::default();
    for &pixel in picture {
        crc.update(&[Rgb565::from(RawU16::new(pixel))]);
    }
    crc.finish()
}
