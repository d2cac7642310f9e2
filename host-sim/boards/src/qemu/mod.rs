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

/// The command that runs `program` on the machine that QEMU knows by this name, without anything that looks at it.
fn machine(name: &str, program: &Scratch) -> Command {
    let mut machine = Command::new("qemu-system-arm");
    bound(&mut machine)
        .args(["-M", name, "-display", "none", "-nodefaults", "-nic", "none", "-serial", "none", "-monitor", "none"])
        .args(["-chardev", "stdio,id=host,signal=off", "-semihosting-config", "enable=on,target=native,chardev=host"])
        .arg("-kernel")
        .arg(program.path());
    machine
}

/// Why QEMU has not started.
fn missing(error: io::Error) -> anyhow::Error {
    match error.kind() {
        ErrorKind::NotFound => anyhow!("qemu-system-arm is not installed; `apt-get install -y --no-install-recommends qemu-system-arm`"),
        _ => anyhow!("cannot start qemu-system-arm: {error}"),
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
    /// Starts `machine`; `decode` finds the lines in the bytes that the program sends.
    fn start(mut machine: Command, decode: Decode) -> Result<Self> {
        let mut process = machine.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().map_err(missing)?;
        let pipes = (process.stdin.take(), process.stdout.take());
        let (Some(input), Some(output)) = pipes else {
            bail!("qemu-system-arm started without pipes");
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
    let mut machine = machine(board.name(), &program);
    let qmp = Qmp::new(&mut machine)?;
    let mut emulator = Emulator::start(machine, decoder(elf)?)?;
    let outcome = play(&mut emulator, qmp, &screen, until, &mut recording);
    outcome.with_context(|| format!("{board} in QEMU; {}", log::tail(&recording.log)))?;
    Ok(recording)
}

/// Instructions in a tick of the timers of the boards `mps2-*` while [`clocked`].
pub const INSTRUCTIONS_PER_TICK: f64 = 40.0 / 256.0;

/// Runs a program that looks at nothing but a timer, to its end, and returns its log. Time is what the processor executes, 256 ns an
/// instruction: exact, and far quicker than [`trace`].
///
/// # Errors
/// When the program crashes, falls silent or fails.
pub fn clocked(board: Board, elf: &Elf) -> Result<Vec<String>> {
    let program = Scratch::new(elf.bytes())?;
    let mut machine = machine(board.name(), &program);
    machine.args(["-icount", "shift=8,sleep=off"]);
    let mut emulator = Emulator::start(machine, decoder(elf)?)?;
    let mut lines = Vec::new();
    while let Some(line) = emulator.line()? {
        lines.push(line);
    }
    match emulator.wait()? {
        Some(0) => Ok(lines),
        _ => bail!("the program on {board} failed; {}", log::tail(&lines)),
    }
}

/// Bytes below the top of the stack that are looked at.
const DEEPEST: u32 = 1 << 18;
/// The word with which the start-up code fills the stack.
const PAINT: [u8; 4] = 0xCCCC_CCCC_u32.to_le_bytes();

/// Runs a program of the package `size` on the machine of this name until all frames are drawn, and returns the bytes of stack that have lost their
/// paint.
///
/// # Errors
/// When the program cannot draw its stream, crashes or falls silent.
pub fn stack(name: &str, elf: &Elf) -> Result<u64> {
    let program = Scratch::new(elf.bytes())?;
    let mut machine = machine(name, &program);
    let mut qmp = Qmp::new(&mut machine)?;
    let letters: Decode = Box::new(|bytes, line| bytes.iter().for_each(|&byte| line(char::from(byte).to_string())));
    let emulator = Emulator::start(machine, letters)?;
    qmp.greet()?;
    match emulator.line()?.as_deref() {
        Some("d") => {}
        Some(_) => bail!("the program on {name} cannot draw the scene"),
        None => bail!("QEMU has ended before the program on {name}"),
    }
    let [(bottom, _), (top, _)] = [elf.symbol("_stack_end")?, elf.symbol("_stack_start")?];
    let size = (top - bottom).min(DEEPEST);
    let bytes = qmp.memory(top - size, size)?;
    let clean = bytes.chunks_exact(PAINT.len()).take_while(|word| **word == PAINT).count() * PAINT.len();
    ensure!(clean > 0, "the stack of the program on {name} is deeper than {size} bytes");
    Ok(u64::from(size) - clean as u64)
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
