//! The log buffer in RAM that a debug probe would read (SEGGER RTT), of which the firmware uses the first channel.

use rp2040_emu::Bus as Chip;

/// Offsets in the control block.
const BUFFER: u32 = 28;
const SIZE: u32 = 32;
const WRITE: u32 = 36;
const READ: u32 = 40;

/// The control block's address.
#[derive(Clone, Copy)]
pub(super) struct Rtt(pub(super) u32);

impl Rtt {
    /// Takes all bytes that have been written.
    pub(super) fn drain(self, chip: &mut Chip) -> Vec<u8> {
        let mut bytes = Vec::new();
        // Before start-up has filled in the block, its RAM is empty.
        if chip.peek32(self.0) != u32::from_le_bytes(*b"SEGG") {
            return bytes;
        }
        let [buffer, size, write, mut read] = [BUFFER, SIZE, WRITE, READ].map(|offset| chip.peek32(self.0 + offset));
        if write >= size || read >= size {
            return bytes;
        }
        while read != write {
            let address = buffer + read;
            bytes.push((chip.peek32(address & !3) >> (8 * (address & 3))) as u8);
            read = (read + 1) % size;
        }
        chip.poke32(self.0 + READ, read);
        bytes
    }
}
