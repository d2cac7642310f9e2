//! Flash memory with a program in it.

use crate::elf::Elf;
use anyhow::{Context, Result};

/// The address of flash in chips of Raspberry Pi.
pub(crate) const FLASH: u32 = 0x1000_0000;

/// Flash of `size` bytes with the program `elf`; the rest is erased.
///
/// # Errors
/// When a part of the program lies elsewhere.
pub(crate) fn flashed(elf: &Elf, size: usize) -> Result<Vec<u8>> {
    let mut flash = vec![0xFF; size];
    for segment in elf.segments()? {
        let start = segment.address.wrapping_sub(FLASH) as usize;
        let place = flash.get_mut(start..).and_then(|rest| rest.get_mut(..segment.bytes.len()));
        let place = place.with_context(|| format!("the segment at {:#010x} does not lie in flash", segment.address))?;
        place.copy_from_slice(segment.bytes);
    }
    Ok(flash)
}

/// The word at an offset in flash.
pub(crate) fn word(flash: &[u8], at: usize) -> u32 {
    u32::from_le_bytes([flash[at], flash[at + 1], flash[at + 2], flash[at + 3]])
}
