//! Processor and bus, from reset.

use super::{bus::Bus, cycles};
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
use anyhow::{Result, ensure};
use rp2040_emu::{Bus as Chip, core::CortexM0Plus, memory::SRAM_SIZE};

const FLASH_SIZE: usize = 2 << 20;
/// Bytes of the second stage of the boot loader, its checksum included; the vector table follows.
const BOOT2: usize = 0x100;

/// A processor of the chip.
struct Core {
    core: CortexM0Plus,
    /// Processor cycles since the start.
    cycle: u64,
    /// Whether the program has started it.
    runs: bool,
}

/// An RP2040. The processor that is behind the other runs next, so that each soon reads what the other writes. Waiting for a bank of memory that the
/// other uses is not modelled.
pub(crate) struct Machine {
    flash: Vec<u8>,
    cores: [Core; 2],
    bus: Bus,
    rtt: Rtt,
}

impl Machine {
    /// Flashes `elf` and does what the mask ROM does: checks the boot loader's second stage and goes to the program.
    pub(crate) fn new(elf: &Elf) -> Result<Self> {
        let flash = flashed(elf, FLASH_SIZE)?;
        let (stored, computed) = (word(&flash, BOOT2 - 4), boot_checksum(&flash[..BOOT2 - 4]));
        ensure!(
            stored == computed,
            "the boot loader's second stage has checksum {stored:08x} instead of {computed:08x}: the chip would refuse it"
        );

        let (cores, chip) = booted(&flash, 0);
        let (rtt, _) = elf.symbol("_SEGGER_RTT")?;
        Ok(Self { flash, cores, bus: Bus::new(chip, Panel::new(Board::Pico.size())), rtt: Rtt(rtt) })
    }

    /// Lets the second processor begin or go on, if it is time.
    fn launch(&mut self) {
        let [first, second] = &mut self.cores;
        let chip = &mut self.bus.chip;
        if let Some(start) = chip.sio.take_pending_launch() {
            // As the mask ROM does that it waits in.
            chip.ppb[1].vtor = start.vtor;
            second.core.regs.msp = start.sp;
            second.core.regs.r[13] = start.sp;
            second.core.regs.set_pc(start.entry & !1);
            second.core.reset_control_for_launch();
            second.core.wake();
            chip.sio.set_handshake_armed(false);
            (chip.event_flag[1], chip.wfe_waiting[1]) = (false, false);
            (second.runs, second.cycle) = (true, first.cycle);
        }
        if chip.wfe_waiting[1] && chip.event_flag[1] {
            (chip.event_flag[1], chip.wfe_waiting[1]) = (false, false);
            second.cycle = second.cycle.max(first.cycle);
        }
    }

    /// The picture on the OLED, which must have been driven well.
    pub(super) fn oled(&self) -> Result<Vec<u32>> {
        self.bus.oled()
    }
}

impl machine::Machine for Machine {
    /// Executes one instruction of the processor that is behind.
    fn step(&mut self) -> Result<Executed> {
        self.launch();
        let [first, second] = &self.cores;
        let number = usize::from(second.runs && !self.bus.chip.wfe_waiting[1] && second.cycle < first.cycle);
        self.bus.chip.set_active_core(number);
        let Core { core, cycle, .. } = &mut self.cores[number];
        let pc = core.regs.pc();
        let memory = &self.bus.chip.memory;
        // The core fetches it again; this is to look up its time.
        let instruction = if pc >> 28 == 1 { memory.xip_read16(pc & 0xFF_FFFF) } else { memory.sram_read16(pc & 0xFF_FFFF) };
        self.bus.fast = false;
        self.bus.wait = 0;
        self.bus.cycle = *cycle;
        core.step(&mut self.bus);
        // Time goes on while the first processor waits for an event; here it just looks again. The second one sleeps.
        self.bus.chip.wfe_waiting[0] = false;
        let taken = core.regs.pc() != pc.wrapping_add(2);
        let cycles = cycles::of(instruction, taken, self.bus.fast, self.bus.wait);
        *cycle += cycles;
        ensure!(
            !core.is_in_hardfault(),
            "the firmware crashed (HardFault of processor {number}) at {pc:#010x}; look it up with `addr2line -e ELF {pc:#x}`"
        );
        self.bus.cycle = machine::Machine::cycle(self);
        // Nobody reads this list, which would grow for ever.
        self.bus.chip.pending_cache_invalidations.clear();
        self.bus.tick();
        if self.bus.hangs() {
            let (cores, chip) = booted(&self.flash, self.bus.cycle);
            self.cores = cores;
            self.bus.reset(chip);
        }
        Ok(Executed { core: number, address: pc, cycles })
    }

    fn take_log(&mut self) -> Vec<u8> {
        self.rtt.drain(&mut self.bus.chip)
    }

    fn cycle(&self) -> u64 {
        let [first, second] = &self.cores;
        if second.runs && !self.bus.chip.wfe_waiting[1] { first.cycle.min(second.cycle) } else { first.cycle }
    }

    fn picture(&self) -> Result<Vec<u32>> {
        machine::Panelled::check(self)?;
        Ok(self.bus.peripherals.panel.picture())
    }
}

impl machine::Panelled for Machine {
    fn pc(&self) -> u32 {
        self.cores[0].core.regs.pc()
    }

    fn check(&self) -> Result<()> {
        self.bus.peripherals.panel.check()
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

/// Processors and chip when the boot loader has gone to the program in `flash`, at this cycle. The second processor waits for the first.
fn booted(flash: &[u8], cycle: u64) -> ([Core; 2], Chip) {
    let mut chip = Chip::new();
    chip.load_flash(flash);
    chip.ppb[0].vtor = FLASH + BOOT2 as u32;
    let [mut core, second] = [0, 1].map(CortexM0Plus::with_id);
    core.regs.msp = word(flash, BOOT2);
    core.regs.r[13] = word(flash, BOOT2);
    core.regs.set_pc(word(flash, BOOT2 + 4) & !1);
    // Thumb state.
    core.regs.xpsr = 1 << 24;
    ([Core { core, cycle, runs: true }, Core { core: second, cycle, runs: false }], chip)
}

/// CRC-32/MPEG-2, bit by bit.
fn boot_checksum(bytes: &[u8]) -> u32 {
    bytes.iter().fold(!0, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte) << 24, |crc, _| if crc >> 31 == 1 { crc << 1 ^ 0x04C1_1DB7 } else { crc << 1 })
    })
}
