//! Registers of chips of Raspberry Pi appear four times: for values, and for bits that are toggled, set or cleared.

/// Bits of an address that name a peripheral, and do not tell its registers apart.
pub(crate) const PERIPHERAL: u32 = !0x3FFF;
/// Bits of an address that name a register of a peripheral.
pub(crate) const REGISTER: u32 = 0xFFC;

/// The value that a write to `address` leaves in the register. Its `old` value is read only if it counts.
pub(crate) fn written(address: u32, value: u32, old: impl FnOnce() -> u32) -> u32 {
    match address >> 12 & 3 {
        0 => value,
        1 => old() ^ value,
        2 => old() | value,
        _ => old() & !value,
    }
}
