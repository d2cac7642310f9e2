//! A Pico or a Pico 2 with its panel, which runs its firmware from picture to picture.

use crate::{
    Board, Executed, Recording, Until,
    elf::{Elf, short_name},
    log,
    parts::{machine::Panelled, peripherals::Fault},
    pico, pico2,
};
use anyhow::{Context, Result, bail, ensure};

/// Cycles that a picture may take: 16 s of the board's time.
const PATIENCE: u64 = 2_000_000_000;

/// Number of instructions between reads of the log. The log has room for more than these can write.
const LOG_INTERVAL: u64 = 1024;

/// What is known of a board from outside.
struct Observer {
    decoder: log::Decoder,
    log: Vec<String>,
    /// The board's light, which goes on when a picture is complete.
    lit: bool,
    steps: u64,
}

/// Told the address of the first processor's next instruction, the one that has been executed, and whether that completes a picture. True ends a run.
type Visit<'v> = &'v mut dyn FnMut(u32, Executed, bool) -> bool;

/// A board, compiled for each of them as a whole: it is called for each instruction.
trait Run: Panelled {
    /// Executes instructions until `visit` is true.
    fn proceed(&mut self, observer: &mut Observer, visit: Visit<'_>) -> Result<()>;
}

impl<M: Panelled> Run for M {
    fn proceed(&mut self, observer: &mut Observer, visit: Visit<'_>) -> Result<()> {
        let deadline = self.cycle() + PATIENCE;
        while self.cycle() < deadline {
            let step = self.step();
            let completes = !observer.lit && self.led();
            observer.lit = self.led();
            observer.steps += 1;
            // Also after a crash: its cause is in the log.
            if step.is_err() || completes || observer.steps.is_multiple_of(LOG_INTERVAL) {
                observer.decoder.push(&self.take_log(), |line| observer.log.push(line));
            }
            if visit(self.pc(), step?, completes) {
                return Ok(());
            }
        }
        bail!("the firmware has not finished a picture in {PATIENCE} cycles (at {:#010x}): it hangs", self.pc())
    }
}

/// A Pico or a Pico 2 that runs its firmware from picture to picture.
pub struct Pico {
    board: Board,
    machine: Box<dyn Run>,
    observer: Observer,
}

impl Pico {
    /// A board with `elf` in its flash, just switched on.
    ///
    /// # Errors
    /// When the program is not one for this board.
    pub fn new(board: Board, elf: &Elf) -> Result<Self> {
        let machine: Box<dyn Run> = match board {
            Board::Pico => Box::new(pico::Machine::new(elf)?),
            Board::Pico2 => Box::new(pico2::Machine::new(elf)?),
            _ => bail!("{board} has no panel"),
        };
        let observer = Observer { decoder: log::Decoder::new(elf)?, log: Vec::new(), lit: false, steps: 0 };
        Ok(Self { board, machine, observer })
    }

    /// Runs until the panel shows its next picture, a frame or the message of a failure.
    ///
    /// # Errors
    /// When the program crashes, falls silent or drives its panel wrongly.
    pub fn next_picture(&mut self) -> Result<()> {
        self.proceed(&mut |_, _, completes| completes)?;
        self.machine.check().with_context(|| self.context())
    }

    /// Runs until the first processor comes to `address`, and hands each instruction on the way to `visit`.
    fn come_to(&mut self, address: u32, visit: &mut dyn FnMut(Executed)) -> Result<()> {
        self.proceed(&mut |pc, executed, _| {
            visit(executed);
            executed.core == 0 && pc == address
        })
    }

    fn proceed(&mut self, visit: Visit<'_>) -> Result<()> {
        let outcome = self.machine.proceed(&mut self.observer, visit);
        outcome.with_context(|| self.context())
    }

    fn context(&self) -> String {
        format!("{} emulated; {}", self.board, log::tail(&self.observer.log))
    }

    /// Which of them it is.
    #[must_use]
    pub fn board(&self) -> Board {
        self.board
    }

    /// The picture on the panel.
    #[must_use]
    pub fn picture(&self) -> Vec<u32> {
        self.machine.peripherals().panel.picture()
    }

    /// Breaks something from now on.
    pub fn inject(&mut self, fault: Fault) {
        self.machine.peripherals_mut().inject(fault);
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
        self.machine.peripherals().spi.busy()
    }

    /// The log of the firmware.
    #[must_use]
    pub fn log(&self) -> &[String] {
        &self.observer.log
    }

    /// All memory that programs can write.
    #[must_use]
    pub fn ram(&self) -> Vec<u8> {
        self.machine.ram()
    }
}

/// Runs the firmware until it has shown its first frame; or all frames, measured its stack and shown the first frame again.
pub(super) fn run(board: Board, elf: &Elf, until: Until) -> Result<Recording> {
    let mut pico = Pico::new(board, elf)?;
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

/// Cycles of one frame.
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
pub(super) fn watch(board: Board, elf: &Elf, visit: &mut dyn FnMut(Executed)) -> Result<(Recording, FrameTime)> {
    let begin = elf.functions()?.into_iter().find(|(name, _)| short_name(name).ends_with(BEGIN));
    let begin = begin.with_context(|| format!("the firmware has no function {BEGIN}"))?.1.start;
    let mut pico = Pico::new(board, elf)?;
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
    let (cycle, wire) = (pico.cycles(), pico.wire_cycles());
    pico.come_to(begin, visit)?;
    Ok((recording, FrameTime { all: pico.cycles() - cycle, wire: pico.wire_cycles() - wire }))
}
