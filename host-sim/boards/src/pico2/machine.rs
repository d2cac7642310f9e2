//! Processor and bus, from reset.

use super::{bus::Bus, missing};
use crate::{
    elf::Elf,
    parts::{
        flash::{FLASH, flashed, word},
        machine,
        panel::Panel,
        rtt::Rtt,
    },
};
use anyhow::{Result, bail, ensure};
use rp2350_emu::{Bus as Chip, core::CortexM33, threaded::CoreAtomics};
use std::sync::Arc;

const FLASH_SIZE: usize = 4 << 20;
/// The mask ROM looks for a description of the program in so many bytes, between these words.
const DESCRIBED: usize = 4 << 10;
const DESCRIPTION: [u32; 2] = [0xFFFF_DED3, 0xAB12_3579];

/// Width and height of the panel.
const SIZE: (u32, u32) = (240, 240);

/// The number of an exception that a program does not survive.
const HARD_FAULT: u32 = 3;
/// Cycles of a processor that waits for an event: it just looks again.
const SLEEP: u64 = 64;

/// An RP2350 whose second processor sleeps.
pub(crate) struct Machine {
    flash: Vec<u8>,
    core: CortexM33,
    atomics: Arc<CoreAtomics>,
    bus: Bus,
    rtt: Rtt,
}

impl Machine {
    /// Flashes `elf` and does what the mask ROM does: looks for the description of the program, and goes to it.
    pub(crate) fn new(elf: &Elf) -> Result<Self> {
        let flash = flashed(elf, FLASH_SIZE)?;
        let words: Vec<_> = (0..DESCRIBED).step_by(4).map(|at| word(&flash, at)).collect();
        for marker in DESCRIPTION {
            ensure!(
                words.contains(&marker),
                "the program begins without a description ({marker:08x} is missing): the chip would refuse it"
            );
        }
        let atomics = Arc::new(CoreAtomics::default());
        let mut chip = Chip::with_atomics(Arc::clone(&atomics));
        chip.load_flash(&flash);
        let mut core = CortexM33::new(0, Arc::clone(&atomics));
        core.ppb.vtor = FLASH;
        core.regs.msp = words[0];
        core.regs.r[13] = words[0];
        core.regs.set_pc(words[1] & !1);
        let rtt = Rtt(elf.symbol("_SEGGER_RTT")?.0);
        Ok(Self { flash, core, atomics, bus: Bus::new(chip, Panel::new(SIZE)), rtt })
    }

    /// The instruction at an address in flash or RAM, of which the second half counts if it has one.
    fn instruction(&self, address: u32) -> Option<[u16; 2]> {
        let half = |address: u32| match address >> 28 {
            1 => {
                let at = address.wrapping_sub(FLASH) as usize;
                self.flash.get(at..at + 2).map(|bytes| u16::from_le_bytes([bytes[0], bytes[1]]))
            }
            2 => Some(self.bus.chip.memory.sram_read16(address & 0xFF_FFFF)),
            _ => None,
        };
        Some([half(address)?, half(address + 2)?])
    }
}

impl machine::Machine for Machine {
    fn step(&mut self) -> Result<()> {
        let pc = self.core.regs.pc();
        let Some(instruction) = self.instruction(pc) else {
            bail!("the firmware jumps to {pc:#010x}, where there is neither flash nor RAM");
        };
        self.bus.wait = 0;
        let cycles = match missing::execute(&mut self.core, &mut self.bus, instruction)? {
            Some(cycles) => cycles,
            None => {
                let before = self.core.cycles();
                self.core.step(&mut self.bus);
                self.core.cycles() - before
            }
        };
        let sleeps = self.atomics.is_halted(0) || self.atomics.is_wfe_waiting(0);
        self.atomics.clear_halted(0);
        self.atomics.clear_wfe_waiting(0);
        self.bus.cycle += cycles + self.bus.wait + if sleeps { SLEEP } else { 0 };
        ensure!(
            self.core.regs.ipsr() != HARD_FAULT,
            "the firmware crashed (HardFault) at {pc:#010x}; look it up with `addr2line -e ELF {pc:#x}`"
        );
        let changed = &mut self.bus.chip.pending_cache_invalidations;
        if !changed.is_empty() {
            self.core.invalidate_decode_cache_entries(changed);
            changed.clear();
        }
        self.bus.tick();
        Ok(())
    }

    fn take_log(&mut self) -> Vec<u8> {
        self.rtt.drain(&mut self.bus.chip)
    }

    fn cycle(&self) -> u64 {
        self.bus.cycle
    }

    fn picture(&self) -> Result<Vec<u32>> {
        self.bus.picture()
    }
}
