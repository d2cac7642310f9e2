//! The log buffer in RAM that a debug probe would read (SEGGER RTT), of which the firmware uses the first channel.

/// Memory of a chip, which a debug probe reads and writes by words.
pub(crate) trait Memory {
    /// The word at an address.
    fn peek(&self, address: u32) -> u32;
    /// Changes the word at an address.
    fn poke(&mut self, address: u32, value: u32);
}

/// Offsets in the control block.
const BUFFER: u32 = 28;
const SIZE: u32 = 32;
const WRITE: u32 = 36;
const READ: u32 = 40;

/// The control block's address.
#[derive(Clone, Copy)]
pub(crate) struct Rtt(pub(crate) u32);

impl Rtt {
    /// Takes all bytes that have been written.
    pub(crate) fn drain(self, memory: &mut impl Memory) -> Vec<u8> {
        let mut bytes = Vec::new();
        // Before start-up has filled in the block, its RAM is empty.
        if memory.peek(self.0) != u32::from_le_bytes(*b"SEGG") {
            return bytes;
        }
        let [buffer, size, write, mut read] = [BUFFER, SIZE, WRITE, READ].map(|offset| memory.peek(self.0 + offset));
        if write >= size || read >= size {
            return bytes;
        }
        while read != write {
            let address = buffer + read;
            bytes.push((memory.peek(address & !3) >> (8 * (address & 3))) as u8);
            read = (read + 1) % size;
        }
        memory.poke(self.0 + READ, read);
        bytes
    }
}
