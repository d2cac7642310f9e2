//! Processors and bus, from reset.

use super::{bus::Bus, launch::Launch, missing};
use crate::{
    Board, Executed,
    elf::Elf,
    parts::{
        flash::{FLASH, flashed, word},
        machine,
        panel::Panel,
        peripherals::Peripherals,
        rtt::Rtt,
    },
};
use anyhow::{Result, bail, ensure};
use rp2350_emu::{Bus as Chip, core::CortexM33, memory::SRAM_SIZE, threaded::CoreAtomics};
use std::sync::Arc;

const FLASH_SIZE: usize = 4 << 20;
/// The mask ROM looks for a description of the program in so many bytes, between these words.
const DESCRIBED: usize = 4 << 10;
const DESCRIPTION: [u32; 2] = [0xFFFF_DED3, 0xAB12_3579];

/// The number of an exception that a program does not survive.
const HARD_FAULT: u32 = 3;
/// Cycles of the first processor when it waits for an event: it just looks again.
const SLEEP: u64 = 64;

/// A processor of the chip.
struct Core {
    core: CortexM33,
    /// Processor cycles since the start.
    cycle: u64,
}

/// Both processors when the mask ROM has gone to the program in flash.
struct Booted {
    cores: [Core; 2],
    chip: Chip,
    atomics: Arc<CoreAtomics>,
}

/// An RP2350. The processor that is behind the other runs next, so that each soon reads what the other writes. Waiting for a bank of memory that the
/// other uses is not modelled.
pub(crate) struct Machine {
    flash: Vec<u8>,
    cores: [Core; 2],
    atomics: Arc<CoreAtomics>,
    /// The second processor waits in the mask ROM, unless it has been started.
    launch: Option<Launch>,
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
        let Booted { cores, chip, atomics } = booted(&flash, 0);
        let rtt = Rtt(elf.symbol("_SEGGER_RTT")?.0);
        Ok(Self { flash, cores, atomics, launch: Some(Launch::default()), bus: Bus::new(chip, Panel::new(Board::Pico2.size())), rtt })
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

    /// The second processor has been started and does not sleep.
    fn second_runs(&self) -> bool {
        self.launch.is_none() && !self.atomics.is_wfe_waiting(1)
    }

    /// Lets the second processor begin or go on, if it is time.
    fn wake_second(&mut self) {
        let [first, second] = &mut self.cores;
        match &mut self.launch {
            Some(launch) => {
                if let Some(start) = launch.answer(&mut self.bus.chip) {
                    second.core.ppb.vtor = start.vectors;
                    begin(&mut second.core, start.stack, start.entry);
                    (second.cycle, self.launch) = (first.cycle, None);
                }
            }
            None => {
                if self.atomics.is_wfe_waiting(1) && self.atomics.event_flag_consume(1) {
                    self.atomics.clear_wfe_waiting(1);
                    second.cycle = second.cycle.max(first.cycle);
                }
            }
        }
    }
}

impl machine::Machine for Machine {
    fn step(&mut self) -> Result<Executed> {
        self.wake_second();
        let number = usize::from(self.second_runs() && self.cores[1].cycle < self.cores[0].cycle);
        let pc = self.cores[number].core.regs.pc();
        let Some(instruction) = self.instruction(pc) else {
            bail!("the firmware jumps to {pc:#010x}, where there is neither flash nor RAM");
        };
        ensure!(
            self.launch.is_some() || !missing::is_exclusive(instruction),
            "an exclusive access at {pc:#010x} while both processors run is not modelled"
        );
        let Core { core, cycle } = &mut self.cores[number];
        (self.bus.wait, self.bus.cycle) = (0, *cycle);
        if pc >> 28 == 2 {
            // The core keeps instructions, and this one may have been written since.
            core.invalidate_decode_cache_entries(&[pc]);
        }
        let mut cycles = match missing::execute(core, &mut self.bus, instruction)? {
            Some(cycles) => cycles,
            None => {
                let before = core.cycles();
                core.step(&mut self.bus);
                core.cycles() - before
            }
        };
        cycles += self.bus.wait;
        // Time goes on while the first processor waits for an event; here it just looks again. The second one sleeps.
        if self.atomics.is_halted(number) || number == 0 && self.atomics.is_wfe_waiting(0) {
            self.atomics.clear_halted(number);
            self.atomics.clear_wfe_waiting(0);
            cycles += SLEEP;
        }
        *cycle += cycles;
        ensure!(
            core.regs.ipsr() != HARD_FAULT,
            "the firmware crashed (HardFault of processor {number}) at {pc:#010x}; look it up with `addr2line -e ELF {pc:#x}`"
        );
        // Nobody reads this list, which would grow for ever.
        self.bus.chip.pending_cache_invalidations.clear();
        self.bus.cycle = machine::Machine::cycle(self);
        self.bus.tick();
        if self.bus.hangs() {
            let Booted { cores, chip, atomics } = booted(&self.flash, self.bus.cycle);
            (self.cores, self.atomics, self.launch) = (cores, atomics, Some(Launch::default()));
            self.bus.reset(chip);
        }
        Ok(Executed { core: number, address: pc, cycles })
    }

    fn take_log(&mut self) -> Vec<u8> {
        self.rtt.drain(&mut self.bus.chip)
    }

    fn cycle(&self) -> u64 {
        let [first, second] = &self.cores;
        if self.second_runs() { first.cycle.min(second.cycle) } else { first.cycle }
    }

    fn picture(&self) -> Result<Vec<u32>> {
        self.bus.picture()
    }
}

impl machine::Panelled for Machine {
    fn pc(&self) -> u32 {
        self.cores[0].core.regs.pc()
    }

    fn check(&self) -> Result<()> {
        self.bus.check()
    }

    fn peripherals(&self) -> &Peripherals {
        &self.bus.peripherals
    }

    fn peripherals_mut(&mut self) -> &mut Peripherals {
        &mut self.bus.peripherals
    }

    fn led(&self) -> bool {
        Peripherals::led(&self.bus.chip)
    }

    fn quiet(&self) -> bool {
        self.bus.peripherals.quiet(&self.bus.chip)
    }

    fn ram(&self) -> Vec<u8> {
        (0..SRAM_SIZE as u32).map(|offset| self.bus.chip.memory.sram_read8(offset)).collect()
    }
}

/// Sends a processor to a program.
fn begin(core: &mut CortexM33, stack: u32, entry: u32) {
    core.regs.msp = stack;
    core.regs.r[13] = stack;
    core.regs.set_pc(entry & !1);
}

/// Processors and chip when the mask ROM has gone to the program in `flash`, at this cycle. The second processor waits for the first.
fn booted(flash: &[u8], cycle: u64) -> Booted {
    let atomics = Arc::new(CoreAtomics::default());
    let mut chip = Chip::with_atomics(Arc::clone(&atomics));
    chip.load_flash(flash);
    let mut cores = [0, 1].map(|number| Core { core: CortexM33::new(number, Arc::clone(&atomics)), cycle });
    cores[0].core.ppb.vtor = FLASH;
    begin(&mut cores[0].core, word(flash, 0), word(flash, 4));
    Booted { cores, chip, atomics }
}
