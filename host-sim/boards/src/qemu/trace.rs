//! Every instruction that a program executes, in order, from QEMU's execution log.
//!
//! QEMU translates blocks of instructions. It logs the instructions of a block when it translates it, and the block each time it
//! runs: far fewer lines than instructions, and as exact.

use super::{
    super::{
        Board, Recording,
        child::Scratch,
        elf::Elf,
        log::{Decoder, tail},
    },
    Machine,
};
use anyhow::{Context, Result, anyhow, bail, ensure};
use std::{
    collections::HashMap,
    fmt::Write as _,
    io::{self, BufRead, BufReader, Read, Write},
    ops::Range,
    process::Stdio,
    thread,
    time::Duration,
};

/// Size of the blocks that QEMU translates at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blocks {
    /// All instructions up to the next branch.
    Whole,
    /// Single instructions. This is slow, and simple enough to check the other way.
    Single,
}

/// Runs the firmware to its end and hands the address of each instruction that is executed in `ranges` to `visit`. Pictures are not
/// looked at.
///
/// # Errors
/// When QEMU cannot be started or its log cannot be read.
pub fn trace(board: Board, elf: &Elf, ranges: &[Range<u32>], blocks: Blocks, visit: &mut dyn FnMut(u32)) -> Result<Recording> {
    let mut decoder = Decoder::new(elf)?;
    let program = Scratch::new(&elf.without_symbols()?)?;
    let mut filter = String::new();
    for range in ranges {
        let separator = if filter.is_empty() { "" } else { "," };
        write!(filter, "{separator}{:#x}..{:#x}", range.start, range.end - 1)?;
    }
    let machine = Machine::of(board);
    let process = machine
        .command(&program)
        // The log goes to the standard error output. Blocks that lead to others by themselves would not be in it.
        .args(["-d", "in_asm,exec,nochain", "-dfilter", &filter])
        .args((blocks == Blocks::Single).then_some("-singlestep"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut process = process.map_err(|error| machine.missing(error))?;
    let pipes = (process.stdin.take(), process.stdout.take(), process.stderr.take());
    let (Some(mut input), Some(mut messages), Some(output)) = pipes else {
        bail!("QEMU started without pipes");
    };
    // The firmware waits for a byte after each frame; nobody looks at the display here.
    input.write_all(&[b'n'; 64]).context("QEMU has closed its input")?;
    // In a thread of its own, or QEMU would wait for a reader of the one while nobody reads the other.
    let messages = thread::spawn(move || {
        let mut bytes = Vec::new();
        messages.read_to_end(&mut bytes).map(|_| bytes)
    });
    let mut output = BufReader::with_capacity(1 << 20, Unhurried(output));
    let mut log = Log::default();
    let mut line = Vec::new();
    while output.read_until(b'\n', &mut line).context("cannot read QEMU's log")? > 0 {
        log.line(&line, visit)?;
        line.clear();
    }
    log.end(visit);
    let status = process.wait()?;
    let messages = messages.join().map_err(|_| anyhow!("the reader of the firmware's log panicked"))?.context("no log from QEMU")?;
    let mut recording = Recording::default();
    decoder.push(&messages, |line| recording.log.push(line));
    ensure!(status.success(), "the firmware did not run to its end in QEMU ({status}); {}", tail(&recording.log));
    Ok(recording)
}

/// Lets some lines gather before it reads: QEMU writes each by itself, and to wake a reader for each takes longer than all else.
struct Unhurried<R>(R);

/// A pipe has room for about a thousand lines, which take QEMU longer than this.
const REST: Duration = Duration::from_micros(300);

impl<R: Read> Read for Unhurried<R> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        thread::sleep(REST);
        self.0.read(bytes)
    }
}

/// What has been read of the log.
#[derive(Default)]
struct Log {
    /// Addresses of the instructions of each block.
    blocks: Vec<Vec<u32>>,
    /// Blocks by where QEMU keeps their translation.
    places: HashMap<u64, usize>,
    /// The block just translated, which the next line that names one is about.
    translated: Vec<u32>,
    /// The block last entered.
    entered: Option<usize>,
}

impl Log {
    fn line(&mut self, line: &[u8], visit: &mut dyn FnMut(u32)) -> Result<()> {
        match line {
            // An instruction of a block: `0x00001234:  4281       cmp      r1, r0`.
            [b'0', b'x', address @ ..] => self.translated.push(hexadecimal(address).0 as u32),
            // A block is entered: `Trace 0: 0x7f4d08000100 [00800400/00001234/00000110/ff000200] name`.
            [b'T', b'r', b'a', b'c', b'e', b' ', b'0', b':', b' ', b'0', b'x', rest @ ..] => {
                self.end(visit);
                let (place, rest) = hexadecimal(rest);
                if !self.translated.is_empty() {
                    self.places.insert(place, self.blocks.len());
                    self.blocks.push(std::mem::take(&mut self.translated));
                }
                let block = self.places.get(&place).copied();
                let address = rest.get(11..).map(|rest| hexadecimal(rest).0 as u32);
                let first = block.and_then(|block| self.blocks.get(block)?.first().copied());
                ensure!(first.is_some() && first == address, "QEMU's log is damaged: {}", String::from_utf8_lossy(line));
                self.entered = block;
            }
            // It was left again before its first instruction.
            _ if line.starts_with(b"Stopped execution of TB chain before") => self.entered = None,
            _ => {}
        }
        Ok(())
    }

    /// The block last entered has run.
    fn end(&mut self, visit: &mut dyn FnMut(u32)) {
        if let Some(block) = self.entered.take().and_then(|block| self.blocks.get(block)) {
            block.iter().for_each(|&address| visit(address));
        }
    }
}

/// The number at the start of `text`, and what follows it.
fn hexadecimal(text: &[u8]) -> (u64, &[u8]) {
    let digits = text.iter().take_while(|byte| byte.is_ascii_hexdigit()).count();
    let (number, rest) = text.split_at(digits);
    let digit = |byte: &u8| char::from(*byte).to_digit(16).unwrap_or(0);
    (number.iter().fold(0, |number, byte| number << 4 | u64::from(digit(byte))), rest)
}
