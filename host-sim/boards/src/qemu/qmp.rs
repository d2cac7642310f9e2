//! QEMU's control socket: one JSON object per line.

use crate::child::{Scratch, inherited};
use anyhow::{Context, Result, bail, ensure};
use serde_json::{Value, json};
use std::{
    io::{BufRead, BufReader, Write},
    os::unix::net::UnixStream,
    process::Command,
    time::Duration,
};

/// Longest time for an answer.
const LIMIT: Duration = Duration::from_secs(20);

/// A connection that commands can be sent over.
pub(super) struct Qmp {
    stream: BufReader<UnixStream>,
}

impl Qmp {
    /// Connects to the emulator that `machine` starts, by a pair of sockets that nobody else can find.
    pub(super) fn new(machine: &mut Command) -> Result<Self> {
        let (ours, theirs) = UnixStream::pair().context("cannot make QEMU's control socket")?;
        ours.set_read_timeout(Some(LIMIT))?;
        let descriptor = inherited(machine, theirs.into());
        machine.args(["-chardev", &format!("socket,id=control,fd={descriptor}"), "-mon", "chardev=control,mode=control"]);
        Ok(Self { stream: BufReader::new(ours) })
    }

    /// Waits until QEMU takes commands.
    pub(super) fn greet(&mut self) -> Result<()> {
        self.receive().context("no greeting from QEMU")?;
        self.command("qmp_capabilities", &json!({}))
    }

    fn receive(&mut self) -> Result<Value> {
        let mut line = String::new();
        if self.stream.read_line(&mut line)? == 0 {
            bail!("QEMU has closed its control socket");
        }
        Ok(serde_json::from_str(&line)?)
    }

    /// The `size` bytes of memory at `address`.
    pub(super) fn memory(&mut self, address: u32, size: u32) -> Result<Vec<u8>> {
        let file = Scratch::new(&[])?;
        self.command("pmemsave", &json!({ "val": address, "size": size, "filename": file.path().to_string_lossy() }))?;
        let bytes = file.read().context("QEMU's copy of memory")?;
        ensure!(bytes.len() == size as usize, "QEMU's copy of memory has {} bytes, not {size}", bytes.len());
        Ok(bytes)
    }

    /// Runs a command to its end.
    pub(super) fn command(&mut self, name: &str, arguments: &Value) -> Result<()> {
        let request = json!({ "execute": name, "arguments": arguments });
        writeln!(self.stream.get_mut(), "{request}").with_context(|| format!("QEMU command {name}"))?;
        loop {
            let answer = self.receive().with_context(|| format!("QEMU command {name}"))?;
            if let Some(error) = answer.get("error") {
                bail!("QEMU command {name}: {error}");
            }
            // Anything else is an event, which nobody waits for.
            if answer.get("return").is_some() {
                return Ok(());
            }
        }
    }
}
