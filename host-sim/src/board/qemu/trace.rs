//! Every instruction that a program executes, in order, from QEMU's execution log.

use super::super::{Board, elf::Elf};
use anyhow::{Context, Result, anyhow, bail};
use std::{
    fmt::Write as _,
    fs,
    io::{BufRead, BufReader, Write},
    ops::Range,
    process::{Command, Stdio},
};

/// Runs the firmware to its end and hands the address of each executed instruction in `ranges` to `visit`.
///
/// # Errors
/// When QEMU cannot be started or its log cannot be read.
pub fn trace(board: Board, elf: &Elf, ranges: &[Range<u32>], mut visit: impl FnMut(u32)) -> Result<()> {
    let directory = tempfile::Builder::new().prefix("mphong").tempdir().context("cannot create a temporary directory")?;
    let program = directory.path().join("firmware.elf");
    fs::write(&program, elf.bytes()).with_context(|| format!("cannot write {}", program.display()))?;
    let mut filter = String::new();
    for range in ranges {
        let separator = if filter.is_empty() { "" } else { "," };
        write!(filter, "{separator}{:#x}..{:#x}", range.start, range.end - 1)?;
    }
    let mut process = Command::new("qemu-system-arm")
        .args(["-M", board.name(), "-display", "none", "-nodefaults", "-nic", "none", "-serial", "none", "-monitor", "none"])
        .args(["-chardev", "stdio,id=host,signal=off", "-semihosting-config", "enable=on,target=native,chardev=host"])
        // One instruction per block, and every block in the log, which goes to the standard error output.
        .args(["-singlestep", "-d", "exec,nochain", "-dfilter", &filter])
        .arg("-kernel")
        .arg(&program)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| anyhow!("cannot start qemu-system-arm: {error}; `apt-get install -y --no-install-recommends qemu-system-arm`"))?;
    let (Some(mut input), Some(log)) = (process.stdin.take(), process.stderr.take()) else {
        bail!("qemu-system-arm started without pipes");
    };
    // The firmware waits for a byte after each frame; nobody looks at the display here.
    input.write_all(&[b'n'; 64]).context("QEMU has closed its input")?;
    let mut log = BufReader::with_capacity(1 << 20, log);
    let mut line = Vec::new();
    while log.read_until(b'\n', &mut line).context("cannot read QEMU's log")? > 0 {
        if let Some(address) = address(&line) {
            visit(address);
        }
        line.clear();
    }
    process.wait()?;
    Ok(())
}

/// The address in `Trace 0: 0x7f.. [00000000/00001234/..] name`.
fn address(line: &[u8]) -> Option<u32> {
    let bracket = line.iter().position(|&byte| byte == b'[')?;
    let address = line.get(bracket + 10..bracket + 18)?;
    u32::from_str_radix(str::from_utf8(address).ok()?, 16).ok()
}
