//! Cycles of instructions on a Cortex-M0+ (technical reference manual, table 3-1) with the RP2040's fast multiplier.

/// Cycles of `instruction`, its first half-word. `taken`: it did not go on to the next one. `fast`: it accessed the single-cycle I/O
/// block. `wait`: what slow peripherals add.
pub(super) fn of(instruction: u16, taken: bool, fast: bool, wait: u64) -> u64 {
    let listed = |mask: u16| u64::from((instruction & mask).count_ones());
    let access = if fast { 1 } else { 2 } + wait;
    match instruction >> 12 {
        // Load from the literal pool.
        0x4 if instruction >> 11 == 0b0_1001 => access,
        // BX and BLX; ADD and MOV to the program counter.
        0x4 if instruction & 0xFF00 == 0x4700 => 2,
        0x4 if matches!(instruction >> 8, 0x44 | 0x46) && instruction & 0x87 == 0x87 => 2,
        // Loads and stores.
        0x5..=0x9 => access,
        // PUSH, POP, POP with return.
        0xB if instruction & 0xFE00 == 0xB400 => 1 + listed(0x1FF),
        0xB if instruction & 0xFF00 == 0xBD00 => 3 + listed(0x1FF),
        0xB if instruction & 0xFF00 == 0xBC00 => 1 + listed(0xFF),
        // WFE and WFI.
        0xB if matches!(instruction, 0xBF20 | 0xBF30) => 2,
        // LDM and STM.
        0xC => 1 + listed(0xFF) + wait,
        // Conditional branches.
        0xD if instruction >> 8 < 0xDE => 1 + u64::from(taken),
        0xE => 2,
        // BL, barriers, special registers.
        0xF => 3,
        _ => 1,
    }
}
