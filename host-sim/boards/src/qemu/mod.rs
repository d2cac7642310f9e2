//! Boards that QEMU emulates. The host reads the display while the firmware waits for a byte: no sleeping, no guessing.

mod qmp;
mod screen;
mod trace;

pub use trace::{Blocks, trace};

use super::{
    Board, Recording, Until,
    child::{Scratch, bound},
    elf::Elf,
    log,
};
use anyhow::{Context, Result, anyhow, bail, ensure};
use qmp::Qmp;
use screen::Screen;
use std::{
    io::{self, ErrorKind, Read, Write},
    process::{Child, ChildStdin, ChildStdout, Command, Stdio},
    sync::mpsc::{self, Receiver, RecvTimeoutError},
    thread,
    time::{Duration, Instant},
};

/// Longest time without output of the firmware. A frame takes a second at most, and the machine may be busy.
const SILENCE: Duration = Duration::from_secs(120);
/// Longest time that QEMU may take to end after the firmware has ended.
const END: Duration = Duration::from_secs(20);
/// The exit code that the firmware's fault handler chooses.
const PANIC: i32 = 101;

/// A board as QEMU emulates it.
#[derive(Clone, Copy, Debug)]
struct Machine {
    /// The program that emulates it.
    emulator: &'static str,
    /// The package of Debian that has the program.
    package: &'static str,
    /// QEMU's name of it.
    name: &'static str,
    /// More arguments.
    arguments: &'static [&'static str],
}

/// Checks that the emulator of `board` is installed, before a program is compiled for it.
///
/// # Errors
/// Says what to install.
pub fn check(board: Board) -> Result<()> {
    let machine = Machine::of(board);
    let version = Command::new(machine.emulator).arg("--version").stdin(Stdio::null()).output();
    version.map(drop).map_err(|error| machine.missing(error))
}

impl Machine {
    const fn of(board: Board) -> Self {
        match board {
            Board::RiscvVirt => {
                Self { emulator: "qemu-system-riscv32", package: "qemu-system-misc", name: "virt", arguments: &["-bios", "none"] }
            }
            _ => Self { emulator: "qemu-system-arm", package: "qemu-system-arm", name: board.name(), arguments: &[] },
        }
    }

    /// The command that runs `program`, without anything that looks at it.
    fn command(self, program: &Scratch) -> Command {
        let mut command = Command::new(self.emulator);
        bound(&mut command)
            .args(["-M", self.name])
            .args(self.arguments)
            .args(["-display", "none", "-nodefaults", "-nic", "none", "-serial", "none", "-monitor", "none"])
            .args(["-chardev", "stdio,id=host,signal=off", "-semihosting-config", "enable=on,target=native,chardev=host"])
            .arg("-kernel")
            .arg(program.path());
        command
    }

    /// Why QEMU has not started.
    fn missing(self, error: io::Error) -> anyhow::Error {
        let Self { emulator, package, .. } = self;
        match error.kind() {
            ErrorKind::NotFound => anyhow!("{emulator} is not installed; `apt-get install -y --no-install-recommends {package}`"),
            _ => anyhow!("cannot start {emulator}: {error}"),
        }
    }
}

/// Finds lines in bytes that a program sends, and hands each over.
type Decode = Box<dyn FnMut(&[u8], &mut dyn FnMut(String)) + Send>;

/// A running emulator; ends with it.
struct Emulator {
    process: Child,
    input: ChildStdin,
    lines: Receiver<String>,
}

impl Drop for Emulator {
    fn drop(&mut self) {
        // It may have ended already, which is all that can be wrong here.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

impl Emulator {
    /// Starts `machine` by its `command`; `decode` finds the lines in the bytes that the program sends.
    fn start(machine: Machine, mut command: Command, decode: Decode) -> Result<Self> {
        let process = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
        let mut process = process.map_err(|error| machine.missing(error))?;
        let pipes = (process.stdin.take(), process.stdout.take());
        let (Some(input), Some(output)) = pipes else {
            bail!("QEMU started without pipes");
        };
        Ok(Self { process, input, lines: read_lines(output, decode) })
    }

    /// The next line of the log; `None` when QEMU has ended.
    fn line(&self) -> Result<Option<String>> {
        match self.lines.recv_timeout(SILENCE) {
            Ok(line) => Ok(Some(line)),
            Err(RecvTimeoutError::Disconnected) => Ok(None),
            Err(RecvTimeoutError::Timeout) => bail!("the firmware has logged nothing for {} s: it hangs", SILENCE.as_secs()),
        }
    }

    /// Lets the firmware go on.
    fn release(&mut self) -> Result<()> {
        self.input.write_all(b"n").and_then(|()| self.input.flush()).context("QEMU has closed its input")
    }

    /// The exit code; QEMU has closed its output and should be about to end.
    fn wait(&mut self) -> Result<Option<i32>> {
        let start = Instant::now();
        while start.elapsed() < END {
            if let Some(status) = self.process.try_wait()? {
                return Ok(status.code());
            }
            thread::sleep(Duration::from_millis(2));
        }
        bail!("QEMU did not end within {} s", END.as_secs())
    }
}

/// Finds the lines of the log of `elf`.
fn decoder(elf: &Elf) -> Result<Decode> {
    let mut decoder = log::Decoder::new(elf)?;
    Ok(Box::new(move |bytes, line| decoder.push(bytes, line)))
}

/// Decodes in a thread of its own, as reading cannot time out.
fn read_lines(mut output: ChildStdout, mut decode: Decode) -> Receiver<String> {
    let (sender, lines) = mpsc::channel();
    thread::spawn(move || {
        let mut buffer = [0; 4096];
        // Ends with QEMU.
        while let Ok(count @ 1..) = output.read(&mut buffer) {
            decode(&buffer[..count], &mut |line| {
                // Nobody listens any more once the run is over.
                let _ = sender.send(line);
            });
        }
    });
    lines
}

/// Runs the firmware to its end, or to the end of its first frame.
pub(super) fn run(board: Board, elf: &Elf, until: Until) -> Result<Recording> {
    let program = Scratch::new(elf.bytes())?;
    let screen = Screen::of(board, elf)?;

    let mut recording = Recording::default();
    let machine = Machine::of(board);
    let mut command = machine.command(&program);
    let qmp = Qmp::new(&mut command)?;
    let mut emulator = Emulator::start(machine, command, decoder(elf)?)?;
    let outcome = play(&mut emulator, qmp, &screen, until, &mut recording);
    outcome.with_context(|| format!("{board} in QEMU; {}", log::tail(&recording.log)))?;
    Ok(recording)
}

/// Instructions in a tick of the timers of the boards `mps2-*` while [`clocked`].
pub const INSTRUCTIONS_PER_TICK: f64 = 40.0 / 256.0;

/// Runs a program that looks at nothing but a timer, to its end, and returns its log. Firmware that waits for the host after a frame may do so `pauses`
/// times, and goes on at once. Time is what the processor executes, 256 ns an instruction: exact, and far quicker than [`trace()`].
///
/// # Errors
/// When the program crashes, falls silent or fails.
pub fn clocked(board: Board, elf: &Elf, pauses: u16) -> Result<Vec<String>> {
    let program = Scratch::new(elf.bytes())?;
    let machine = Machine::of(board);
    let mut command = machine.command(&program);
    command.args(["-icount", "shift=8,sleep=off"]);
    let mut emulator = Emulator::start(machine, command, decoder(elf)?)?;
    for _ in 0..pauses {
        emulator.release()?;
    }
    let mut lines = Vec::new();
    while let Some(line) = emulator.line()? {
        lines.push(line);
    }
    match emulator.wait()? {
        Some(0) => Ok(lines),
        _ => bail!("the program on {board} failed; {}", log::tail(&lines)),
    }
}

/// Bytes below the top of the stack that are painted before the start, and looked at in the end.
const DEEPEST: u32 = 1 << 18;
/// The paint. Start-up code that paints the stack as well uses this value.
const PAINT: u8 = 0xCC;

/// Runs a program of the package `size` on a board until all frames are drawn, and returns the bytes of stack that have lost their paint.
///
/// # Errors
/// When the program cannot draw its stream, crashes or falls silent.
pub fn stack(board: Board, elf: &Elf) -> Result<u64> {
    let (program, paint) = (Scratch::new(elf.bytes())?, Scratch::new(&[PAINT; DEEPEST as usize])?);
    let bottom = elf.symbol("_stack_start")?.0 - DEEPEST;
    let machine = Machine::of(board);
    let mut command = machine.command(&program);
    command.args(["-device", &format!("loader,file={},addr={bottom:#x},force-raw=on", paint.path().display())]);
    let mut qmp = Qmp::new(&mut command)?;
    let letters: Decode = Box::new(|bytes, line| bytes.iter().for_each(|&byte| line(char::from(byte).to_string())));
    let emulator = Emulator::start(machine, command, letters)?;
    qmp.greet()?;
    match emulator.line()?.as_deref() {
        Some("d") => {}
        Some(_) => bail!("the program on {board} cannot draw the scene"),
        None => bail!("QEMU has ended before the program on {board}"),
    }
    let bytes = qmp.memory(bottom, DEEPEST)?;
    // A word that has lost only some of its paint counts as a whole.
    let clean = bytes.iter().take_while(|&&byte| byte == PAINT).count() / size_of::<u32>() * size_of::<u32>();
    ensure!(clean > 0, "the stack of the program on {board} is deeper than {DEEPEST} bytes");
    Ok(u64::from(DEEPEST) - clean as u64)
}

fn play(emulator: &mut Emulator, mut qmp: Qmp, screen: &Screen, until: Until, recording: &mut Recording) -> Result<()> {
    qmp.greet()?;
    while let Some(line) = emulator.line()? {
        let shown = line.starts_with("frame ") || line.starts_with("error: ");
        recording.log.push(line);
        if shown {
            // The picture is complete by now, and the firmware waits.
            recording.pictures.push(screen.picture(&mut qmp)?);
            if until == Until::FirstFrame && recording.failure().is_none() {
                return Ok(());
            }
            emulator.release()?;
        }
    }
    let expected = if recording.failure().is_some() { 1 } else { 0 };
    match emulator.wait()? {
        Some(code) if code == expected => {}
        Some(PANIC) => bail!("the firmware panicked or crashed (HardFault)"),
        Some(code) => bail!("QEMU ended with code {code} instead of {expected}"),
        None => bail!("QEMU was killed"),
    }
    Ok(())
}
