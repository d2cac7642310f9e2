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
use peers::{HEIGHT, Peer, Picture, WIDTH, counted_frame, scene::Scene};

/// Hands out memory and takes none back while a frame is drawn: the cheapest there is.
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
    start_timer();
    let empty = ticks(&mut |_| (), PICTURE);
    let used = USED.load(Relaxed);
    for peer in Peer::ALL {
        let Some(mut drawing) = peer.prepare(&scene) else {
            defmt::error!("error: no shader for these lights and materials");
            semihosting::exit(1)
        };
        PICTURE.fill(0);
        let taken = ticks(&mut *drawing, PICTURE) - empty;
        // Nothing is left of what this peer has asked for.
        drop(drawing);
        USED.store(used, Relaxed);
        // The host reads these lines.
        let (pixels, crc) = (peers::covered(PICTURE), checksum(PICTURE));
        defmt::info!("frame {=str} ticks {=u32} pixels {=usize} crc {=u32:08x}", peer.name(), taken, pixels, crc);
    }
    semihosting::exit(0)
}

/// The board's timer 0, which counts down: control, value and reload.
const TIMER: [*mut u32; 3] = [0x4000_0000 as *mut u32, 0x4000_0004 as *mut u32, 0x4000_0008 as *mut u32];

fn start_timer() {
    let [control, value, reload] = TIMER;
    for (register, content) in [(reload, u32::MAX), (value, u32::MAX), (control, 1)] {
        // SAFETY: these are the timer's registers, and nothing else uses it.
        unsafe { register.write_volatile(content) };
    }
}

/// Ticks of the timer while a frame is drawn. The function is not inlined, so that each call takes as long as the call for an empty frame.
#[inline(never)]
fn ticks(draw: &mut dyn FnMut(&mut Picture), picture: &mut Picture) -> u32 {
    // SAFETY: reading the timer has no effect.
    let now = || unsafe { TIMER[1].read_volatile() };
    let start = now();
    counted_frame(draw, picture);
    start - now()
}

fn checksum(picture: &Picture) -> u32 {
    let mut crc = PictureCrc::default();
    for &pixel in picture {
        crc.update(&[Rgb565::from(RawU16::new(pixel))]);
    }
    crc.finish()
}
