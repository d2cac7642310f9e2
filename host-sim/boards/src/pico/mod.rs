//! The Pico: an RP2040 with an ST7789 panel or an SSD1306 OLED, emulated down to the bytes on the display's wires.
//!
//! The processor core and most of the chip come from the `rp2040-emu` crate; serial ports, DMA and displays are ours, as the crate's do not
//! send. Time is counted with the Cortex-M0+ table of cycles, flash as if always in the cache: close to the truth, not exact.

mod bus;
mod cycles;
mod dma;
mod machine;
mod watchdog;

use super::{
    Board, Executed, Recording, Until,
    elf::{Elf, short_name},
    log, parts,
};
use anyhow::{Context, Result, bail, ensure};
use machine::Machine;

/// Cycles that a picture may take: 16 s of the board's time.
const PATIENCE: u64 = 2_000_000_000;

/// Faults that can be simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// DMA moves no more data, so no transfer ends.
    DmaStalls,
    /// The serial port is busy with a word for ever. A reset mends it.
    SpiHangs,
}

/// A Pico that runs its firmware from picture to picture.
pub struct Pico {
    machine: Machine,
    decoder: log::Decoder,
    log: Vec<String>,
    /// The board's light, which goes on when a picture is complete.
    lit: bool,
}

impl Pico {
    /// A board with `elf` in its flash, just switched on.
    ///
    /// # Errors
    /// When the program is not one for this board.
    pub fn new(elf: &Elf) -> Result<Self> {
        Ok(Self { machine: Machine::new(elf)?, decoder: log::Decoder::new(elf)?, log: Vec::new(), lit: false })
    }

    /// Runs until the panel shows its next picture, a frame or the message of a failure.
    ///
    /// # Errors
    /// When the program crashes, falls silent or drives its panel wrongly.
    pub fn next_picture(&mut self) -> Result<()> {
        let outcome = self.proceed(|_, _, completes| completes, &mut |_| ()).and_then(|()| self.machine.check_panel());
        outcome.with_context(|| format!("{} emulated; {}", Board::Pico, log::tail(&self.log)))
    }

    /// Runs until the first processor comes to `address`, and hands each instruction on the way to `visit`.
    fn come_to(&mut self, address: u32, visit: &mut dyn FnMut(Executed)) -> Result<()> {
        let outcome = self.proceed(|machine, executed, _| executed.core == 0 && machine.pc() == address, visit);
        outcome.with_context(|| format!("{} emulated; {}", Board::Pico, log::tail(&self.log)))
    }

    /// Executes instructions until one of them makes `ends` true, which is told whether it completes a picture.
    fn proceed(&mut self, ends: impl Fn(&Machine, Executed, bool) -> bool, visit: &mut dyn FnMut(Executed)) -> Result<()> {
        let deadline = self.machine.cycle() + PATIENCE;
        while self.machine.cycle() < deadline {
            let step = self.machine.step();
            let completes = !self.lit && self.machine.led();
            self.lit = self.machine.led();
            // Also after a crash: its cause is in the log.
            if step.is_err() || completes || self.machine.log_is_due() {
                self.decoder.push(&self.machine.take_log(), |line| self.log.push(line));
            }
            let executed = step?;
            visit(executed);
            if ends(&self.machine, executed, completes) {
                return Ok(());
            }
        }
        bail!("the firmware has not finished a picture in {PATIENCE} cycles (at {:#010x}): it hangs", self.machine.pc())
    }

    /// The picture on the panel.
    #[must_use]
    pub fn picture(&self) -> Vec<u32> {
        self.machine.picture()
    }

    /// Breaks something from now on.
    pub fn inject(&mut self, fault: Fault) {
        self.machine.inject(fault);
    }

    /// Whether nobody speaks to the panel: it is not selected, and neither port nor DMA has anything to do.
    #[must_use]
    pub fn quiet(&self) -> bool {
        self.machine.quiet()
    }

    /// Cycles since it was switched on.
    #[must_use]
    pub fn cycles(&self) -> u64 {
        self.machine.cycle()
    }

    /// Cycles of them in which bits went over the wire to the panel.
    #[must_use]
    pub fn wire_cycles(&self) -> u64 {
        self.machine.wire()
    }

    /// The log of the firmware.
    #[must_use]
    pub fn log(&self) -> &[String] {
        &self.log
    }

    /// All memory that programs can write.
    #[must_use]
    pub fn ram(&self) -> Vec<u8> {
        self.machine.ram()
    }
}

/// A Pico whose program uses the OLED.
pub(super) struct Oled(Machine);

impl Oled {
    /// A board with `elf` in its flash, just switched on.
    pub(super) fn new(elf: &Elf) -> Result<Self> {
        Machine::new(elf).map(Self)
    }
}

impl parts::machine::Machine for Oled {
    fn step(&mut self) -> Result<()> {
        self.0.step().map(drop)
    }

    fn take_log(&mut self) -> Vec<u8> {
        self.0.take_log()
    }

    fn cycle(&self) -> u64 {
        self.0.cycle()
    }

    fn picture(&self) -> Result<Vec<u32>> {
        self.0.oled()
    }
}

/// Runs the firmware until it has shown its first frame; or all frames, measured its stack and shown the first frame again.
pub(super) fn run(elf: &Elf, until: Until) -> Result<Recording> {
    let mut pico = Pico::new(elf)?;
    let mut recording = Recording::default();
    loop {
        pico.next_picture()?;
        recording.log = pico.log().to_vec();
        let picture = pico.picture();
        // All have been checked, and the first one has been drawn again at full speed: only where it changes.
        if until == Until::LastFrame(recording.pictures.len()) && recording.failure().is_none() {
            ensure!(recording.pictures.first() == Some(&picture), "the first picture is another one when it is drawn at full speed");
            return Ok(recording);
        }
        recording.pictures.push(picture);
        if until == Until::FirstFrame || recording.failure().is_some() {
            return Ok(recording);
        }
    }
}

/// Cycles of one frame; 125 of them are a microsecond.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameTime {
    /// Cycles from the beginning of the frame to the beginning of the next.
    pub all: u64,
    /// While bits went over the wire to the panel.
    pub wire: u64,
}

/// The function that begins a frame, in which both processors prepare it.
const BEGIN: &str = "TwoCores as microphong_firmware::painter::Painter::prepare";

/// Frames in which the shares of the two processors settle: each halves the difference between their times. After these a frame takes as long as
/// later ones do, to 1 %, which is how finely the processors are timed.
const SETTLING: usize = 8;

/// Runs the firmware until it has checked its two frames, and has drawn them at full speed until the processors have their shares. The instructions of
/// the first one, drawn once more, and their cycles go to `visit`.
pub(super) fn watch(elf: &Elf, visit: &mut dyn FnMut(Executed)) -> Result<(Recording, FrameTime)> {
    let begin = elf.functions()?.into_iter().find(|(name, _)| short_name(name).ends_with(BEGIN));
    let begin = begin.with_context(|| format!("the firmware has no function {BEGIN}"))?.1.start;
    let mut pico = Pico::new(elf)?;
    // Both are checked, and the first one is drawn at full speed: when that begins, nothing is on its way yet. It is complete while the second
    // one is drawn.
    for _ in 0..3 {
        pico.next_picture()?;
    }
    let recording = Recording { log: pico.log().to_vec(), ..Recording::default() };
    if let Some(failure) = recording.failure() {
        bail!("the firmware reports: {failure}");
    }
    // Not from picture to picture: a picture is complete when some of the next one has been drawn, more or less.
    pico.come_to(begin, &mut |_| ())?;
    for _ in 0..SETTLING {
        pico.come_to(begin, &mut |_| ())?;
    }
    let (cycle, wire) = (pico.machine.cycle(), pico.machine.wire());
    pico.come_to(begin, visit)?;
    Ok((recording, FrameTime { all: pico.machine.cycle() - cycle, wire: pico.machine.wire() - wire }))
}
