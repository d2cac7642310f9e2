//! The second processor of an RP2040 or RP2350, which prepares one half of each frame and draws its lower part.

pub use crate::chip::STACK;
use crate::{Display, Failure, Painter, painter::rows, stack::without_paint};
use core::{
    cell::{Cell, RefCell},
    mem,
    sync::atomic::{AtomicBool, Ordering},
};
use cortex_m::asm::{sev, wfe};
use critical_section::Mutex;
use embassy_rp::{
    Peri,
    multicore::{Stack, spawn_core1},
    peripherals::CORE1,
};
use embassy_time::Instant;
use embedded_graphics::primitives::Rectangle;
use microphong::{
    Frame, FramePart, RenderError, Renderer, Stats,
    pixel::{PictureCrc, Pixel},
};

/// Work for the second processor.
struct Job(*mut (dyn FnMut() + Send));

// SAFETY: what it points to may be sent, and the processor that made it keeps away until the job is done.
unsafe impl Send for Job {}

static JOB: Mutex<Cell<Option<Job>>> = Mutex::new(Cell::new(None));
static DONE: AtomicBool = AtomicBool::new(false);

/// The second processor, waiting for something to do.
pub struct SecondCore {
    /// The lowest word of its stack.
    stack: *const u32,
}

impl SecondCore {
    /// Starts it.
    pub fn start(core: Peri<'static, CORE1>, stack: &'static mut Stack<STACK>) -> Self {
        let lowest = (&raw const stack.mem).cast();
        spawn_core1(core, stack, || {
            loop {
                match critical_section::with(|cs| JOB.borrow(cs).take()) {
                    Some(Job(job)) => {
                        // SAFETY: `join` lends it, and does not go on before it is done.
                        unsafe { (*job)() };
                        DONE.store(true, Ordering::Release);
                        sev();
                    }
                    None => wfe(),
                }
            }
        });
        Self { stack: lowest }
    }

    /// Runs `here` on this processor and `there` on the second one, at the same time. Returns when both are done.
    fn join<A, B: Send>(&mut self, here: impl FnOnce() -> A, there: impl FnOnce() -> B + Send) -> (A, Option<B>) {
        let (mut there, mut result) = (Some(there), None);
        let mut job = || result = there.take().map(|there| there());
        let job: *mut (dyn FnMut() + Send + '_) = &mut job;
        // SAFETY: only the lifetime changes. The job is done, and nobody has the pointer any more, when this function returns; a panic does
        // not unwind, it ends the program.
        let job = unsafe { mem::transmute::<*mut (dyn FnMut() + Send + '_), *mut (dyn FnMut() + Send + 'static)>(job) };
        DONE.store(false, Ordering::Relaxed);
        critical_section::with(|cs| JOB.borrow(cs).set(Some(Job(job))));
        sev();
        let outcome = here();
        wait();
        (outcome, result)
    }
}

/// A call of its own, so that its time can be told from the rest.
#[inline(never)]
fn wait() {
    while !DONE.load(Ordering::Acquire) {
        wfe();
    }
}

/// The word with which a stack is filled before it is used.
const PAINT: u32 = 0;

/// A painter in which both processors draw: one the upper rows, the other the lower ones. Each sends its own bands.
pub struct TwoCores<C: 'static> {
    /// The bands that they draw next.
    pub bands: [&'static mut [C]; 2],
    /// The second one.
    pub second: SecondCore,
    /// The share of the triangles that end in the upper part, of 2^16, such that both take equally long.
    pub share: u16,
    /// The share of the triangles that the second one prepares, of 2^16, such that both take equally long.
    pub earlier: u16,
}

impl<D> Painter<D> for TwoCores<D::Color>
where
    D: Display<Color: Pixel + Send + Sync> + Send,
{
    fn prepare<'r>(&mut self, renderer: &'r mut Renderer<'_, D::Color>, number: u32) -> Frame<'r, D::Color> {
        let mut preparation = renderer.prepare(number, self.earlier);
        let [here, there] = preparation.parts().map(|part| || timed(|| part.run()));
        let (((), later), earlier) = self.second.join(here, there);
        self.earlier = fair(self.earlier, [earlier.map_or(0, |((), time)| time), later]);
        preparation.frame()
    }

    fn draw(&mut self, display: &mut D, frame: Frame<'_, D::Color>, mut crc: Option<&mut PictureCrc>) -> Result<Stats, Failure> {
        let (row, output) = (frame.row_at(self.share), frame.output());
        let mut frame = frame.in_two(row);
        let [upper, lower] = frame.parts();
        let [above, below] = &mut self.bands;
        let display = Mutex::new(RefCell::new(display));
        let send = |area, band| critical_section::with(|cs| display.borrow_ref_mut(cs).send(area, band, output));
        let mut rest = crc.is_some().then(PictureCrc::of_rest);
        let (of_upper, of_lower) =
            self.second.join(|| draw(upper, above, send, crc.as_deref_mut()), || draw(lower, below, send, rest.as_mut()));
        let times = [of_upper?, of_lower.unwrap_or(Ok(0))?];
        if let (Some(crc), Some(rest)) = (crc, rest) {
            crc.append(rest);
        }
        self.share = fair(self.share, times);
        Ok(frame.stats())
    }

    fn report(&self) {
        // SAFETY: it is static, and readable RAM.
        let used = unsafe { without_paint(self.second.stack, STACK / size_of::<u32>(), PAINT) };
        defmt::info!("stack of the second processor {=usize} of {=usize} bytes", used, STACK);
    }
}

/// The share, of 2^16, by which both parts would take equally long: the one that took longer gives half of the difference to the other, where
/// each of its triangles takes as long as it took.
fn fair(share: u16, [upper, lower]: [u32; 2]) -> u16 {
    let given = |share: u32, time: u32, difference: u32| (u64::from(share) * u64::from(difference) / u64::from(2 * time.max(1))) as u32;
    let share = u32::from(share);
    let share = match upper.checked_sub(lower) {
        Some(longer) => share - given(share, upper, longer),
        None => share + given((1 << 16) - share, lower, lower - upper),
    };
    share.clamp(1 << 12, 15 << 12) as u16
}

/// Does `work`, and returns how many microseconds that took.
fn timed<T>(work: impl FnOnce() -> T) -> (T, u32) {
    let start = Instant::now();
    let result = work();
    (result, start.elapsed().as_micros() as u32)
}

/// Draws the rows of `part`, and returns how many microseconds that took.
fn draw<C: Pixel>(
    mut part: FramePart<'_, '_, C>,
    band: &mut &'static mut [C],
    send: impl FnMut(Rectangle, &'static mut [C]) -> &'static mut [C],
    crc: Option<&mut PictureCrc>,
) -> Result<u32, RenderError> {
    let (result, time) = timed(|| rows(|band| part.next_band(band), band, send, crc));
    result.map(|()| time)
}
