//! QEMU's control socket: one JSON object per line.

use anyhow::{Context, Result, bail};
use serde_json::{Value, json};
use std::{
    io::{BufRead, BufReader, ErrorKind, Write},
    os::unix::net::UnixStream,
    path::Path,
    thread::sleep,
    time::{Duration, Instant},
};

/// How long an answer may take.
const LIMIT: Duration = Duration::from_secs(20);

/// A connection that commands can be sent over.
pub(super) struct Qmp {
    stream: BufReader<UnixStream>,
}

impl Qmp {
    /// Waits until QEMU has made `socket`.
    pub(super) fn connect(socket: &Path) -> Result<Self> {
        let start = Instant::now();
        let stream = loop {
            match UnixStream::connect(socket) {
                Ok(stream) => break stream,
                Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::ConnectionRefused) && start.elapsed() < LIMIT => {
                    sleep(Duration::from_millis(2));
                }
                Err(error) => return Err(error).context("cannot reach QEMU's control socket"),
            }
        };
        stream.set_read_timeout(Some(LIMIT))?;
        let mut qmp = Self { stream: BufReader::new(stream) };
        qmp.receive().context("no greeting from QEMU")?;
        qmp.command("qmp_capabilities", &json!({}))?;
        Ok(qmp)
    }

    fn receive(&mut self) -> Result<Value> {
        let mut line = String::new();
        if self.stream.read_line(&mut line)? == 0 {
            bail!("QEMU has closed its control socket");
        }
        Ok(serde_json::from_str(&line)?)
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
