//! The firmware's log: compressed by defmt, readable only with the ELF's help.

use super::elf::Elf;
use anyhow::{Context, Result};
use defmt_decoder::{DecodeError, Table};

/// Turns bytes into lines.
pub(super) struct Decoder {
    table: Table,
    /// Bytes behind the last complete frame.
    pending: Vec<u8>,
}

impl Decoder {
    pub(super) fn new(elf: &Elf) -> Result<Self> {
        let table = Table::parse(elf.bytes())?.context("the ELF has no .defmt section: link the firmware with -Tdefmt.x")?;
        Ok(Self { table, pending: Vec::new() })
    }

    /// Adds `bytes`, calls `line` for every message that they complete. Damaged frames are reported as such: the encoding recovers.
    pub(super) fn push(&mut self, bytes: &[u8], mut line: impl FnMut(String)) {
        self.pending.extend_from_slice(bytes);
        // Every frame ends in a zero byte.
        let Some(end) = self.pending.iter().rposition(|&byte| byte == 0) else {
            return;
        };
        let mut decoder = self.table.new_stream_decoder();
        decoder.received(&self.pending[..=end]);
        loop {
            match decoder.decode() {
                Ok(frame) => line(frame.display_message().to_string()),
                Err(DecodeError::UnexpectedEof) => break,
                Err(DecodeError::Malformed) => line("(damaged log frame)".to_owned()),
            }
        }
        drop(decoder);
        self.pending.drain(..=end);
    }
}

/// The end of a log, for error messages.
pub(super) fn tail(log: &[String]) -> String {
    if log.is_empty() {
        return "it has logged nothing".to_owned();
    }
    let last = &log[log.len().saturating_sub(5)..];
    format!("the last lines of its log:\n  {}", last.join("\n  "))
}
